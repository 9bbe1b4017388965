#!/usr/bin/env python3
"""The page of scripts/report, without a browser: every number that it shows is the one of the table, shapes are those
of the fields, nothing outside of the file is named, and folders that are empty, half-written or damaged give one line
or a section that says so. Numbers are compared with the files that squeal wrote, read here on their own.

    test_report.py SQUEAL MPIRUN"""

import random
import re
import shutil
import sys
import tempfile
import warnings
from html.parser import HTMLParser
from pathlib import Path

from brake_results import SOURCE, make_results
from forked import run_script
from fuzz.damage import BYTES, LINES
from report_checks import (check_cost, check_frf, check_map, check_modes, check_shapes, check_static, check_sweep,
                           check_together, check_transient, check_turned, check_words)
from report_vibrations import check_vibrations
from served import sooner

LARGEST = 10e6  # bytes


class Page(HTMLParser):
    """Elements of a page in their order, as dictionaries: tag, attributes, and the text within."""

    def __init__(self, path):
        super().__init__()
        self.elements, self.open, self.pieces = [], [], []
        self.source = path.read_text()
        self.feed(self.source)
        self.close()
        self.handle_endtag("")

    def handle_starttag(self, tag, attributes):
        element = {"tag": tag, "text": "", "inside": [other.get("id") for other, _ in self.open], **dict(attributes)}
        self.elements.append(element)
        if tag not in ("meta", "link", "img", "br", "input"):
            self.open.append((element, len(self.pieces)))

    def handle_endtag(self, tag):
        while self.open:
            element, first = self.open.pop()
            element["text"] = "".join(self.pieces[first:])
            if element["tag"] == tag:
                break

    def handle_data(self, data):
        self.pieces.append(data)

    def find(self, tag, inside=None, **attributes):
        """Elements of a tag with these attributes within the element of an id."""
        return [e for e in self.elements if e["tag"] == tag and (inside is None or inside in e["inside"]) and
                all(e.get(name.rstrip("_").replace("_", "-")) == value for name, value in attributes.items())]

    def table(self, name):
        """Rows of a sortable table: values as they sort, by heading."""
        heads = [e["text"] for e in self.find("th", inside=name)]
        cells = [e.get("data-value", e["text"]) for e in self.find("td", inside=name)]
        return [dict(zip(heads, cells[i:i + len(heads)])) for i in range(0, len(cells), len(heads))]


class Test:
    """Keeps what is wrong."""

    def __init__(self, folder):
        self.folder, self.faults = folder, []

    def check(self, holds, what):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)

    def script(self, name, *words):
        return run_script(SOURCE / "scripts" / name, words, self.folder)

    def page(self, *words, told=None):
        """The page of some folders; told: what a line on stderr must hold, without it there is none."""
        done = self.script("report", *words, "-o", "page.html")
        good = any(told in line for line in done.stderr.splitlines()) if told else not done.stderr
        self.check(done.returncode == 0 and good and "Traceback" not in done.stderr,
                   f"report {' '.join(map(str, words))}: {done.stderr.strip()}")
        return Page(self.folder / "page.html")

    def refuses(self, expected, *words, script="report"):
        """One line, no trace."""
        done = self.script(script, *words)
        self.check(done.returncode == 1 and done.stderr.count("\n") == 1 and expected in done.stderr
                   and not done.stdout,
                   f"{script} {' '.join(map(str, words))} says '{expected}': {done.stderr!r}")


def check_alone(t, page):
    """One file: breaks when a script, a picture or a letter comes from elsewhere, or a text is not escaped."""
    outside = [e for e in page.elements for name in ("src", "href", "xlink:href") if e.get(name) and
               not e[name].startswith(("#", "data:"))]
    t.check(not outside and "http" not in page.source and "url(" not in re.sub(r"url\(#", "", page.source) and
            "@import" not in page.source, f"nothing outside of the file: {outside[:2]}")
    t.check(len(page.source.encode()) < LARGEST, f"{len(page.source.encode())} bytes")
    ids = [e["id"] for e in page.elements if e.get("id")]
    t.check(len(ids) == len(set(ids)), "each id stands once")
    for figure in page.find("figure"):
        picture = [e for e in page.elements if figure["id"] in e["inside"] and e["tag"] in ("svg", "canvas", "img")]
        commands = [e["text"] for e in page.find("code", inside=figure["id"])]
        scripts = [SOURCE / command.split()[0] for command in commands]
        t.check(picture and len(commands) == 1 and scripts[0].exists(), f"{figure['id']} has a picture and its command")


def check_origin(t, page, key, folder):
    """All options in force, and the command."""
    text = (folder / "scene.yaml").read_text()
    given = dict(re.findall(r'^([\w-]+): "(.*)"$', text, re.MULTILINE))
    shown = {row["option"]: row["value"] for row in page.table(f"{key}-options") if row[""] == "given"}
    t.check(shown == given and len(given) > 20, f"{key}: the options that were given")
    repeat = re.search(r"# repeat: (.*)", text)[1]
    t.check(repeat in [e["text"] for e in page.find("code", inside=f"{key}-origin")],
            f"{key}: the command that repeats")


def check_bad(t):
    """What is empty, half-written or damaged."""
    for name in ("empty", "half", "cut", "torn"):
        shutil.rmtree(t.folder / name, ignore_errors=True)
        (t.folder / name).mkdir()
    (t.folder / "half/modes.csv.part").write_text("mode,freq_hz\n1,")
    for name in ("cut", "torn"):
        for file in ("modes.csv", "modes.h5"):
            shutil.copy(t.folder / "modes" / file, t.folder / name)
    table = (t.folder / "cut/modes.csv").read_text()
    (t.folder / "cut/modes.csv").write_text(table[:table.index("\n", len(table) // 2) + 10])
    field = (t.folder / "torn/modes.h5").read_bytes()
    (t.folder / "torn/modes.h5").write_bytes(field[:len(field) // 2])
    t.refuses("none: no such folder", "none")
    t.refuses("empty: holds no result", "empty")
    t.refuses("half: half-written, only modes.csv.part is there", "half")
    t.refuses("cannot write none/page.html", "modes", "-o", "none/page.html")
    page = t.page("empty", "modes", told="report: empty: holds no result")
    t.check(any("empty: holds no result" in e["text"] for e in page.find("p", class_="missing")),
            "a section for what is empty")
    for said, *words in (("was the file cut off?", "cut"), ("modes.h5: cannot be read", "torn"),
                         ("--modes 99: no such mode", "modes", "--modes", "99")):
        page = t.page(*words, told=said)
        t.check(any(said in e["text"] for e in page.find("p", class_="missing")),
                f"{words[0]}: a section says '{said}'")
    shutil.copytree(t.folder / "transient", t.folder / "going")
    for name in ("transient.csv", "amplitudes.csv"):
        (t.folder / "going" / name).rename(t.folder / "going" / f"{name}.part")
    scene = t.folder / "going/scene.yaml"
    scene.write_text(re.sub(r"^# end: .*", "# end: not yet; the run goes on, was stopped, or failed", scene.read_text(), flags=re.M))
    page = t.page("going")
    said = page.find("p", class_="quiet")[0]["text"]
    t.check("1 run not ended" in said and "computed" not in said and "cost until the first table" in page.source,
            f"a run that has not ended: its date and cost are not told as if it had: {said}")
    scene.unlink()
    page = t.page("going", told="going/scene.yaml: no such file; a run writes it with its first table")
    t.check("the run is still under way" in page.source and page.find("figure", id="r1-amplitudes"),
            "a run under way: what it has so far, amplitudes too")
    page = t.page("cut", told="cut/scene.yaml: no such file")
    t.check("scene.yaml: no such file" in page.source, "what a folder without scene.yaml lacks is said")


def column_out(random, data):
    """A table without one of its columns."""
    rows = [line.split(b",") for line in data.split(b"\n")]
    at = random.randrange(len(rows[0]))
    return b"\n".join(b",".join(row[:at] + row[at + 1:]) for row in rows), False


def check_damages(t, names, n=15):
    """Files of a folder damaged at random, from a fixed seed: a page or one line, never a trace or a warning."""
    sys.path.insert(0, str(SOURCE / "scripts"))
    from squeal.report.folders import Options
    from squeal.report.page import write_page
    from squeal.tables import BadInput
    warnings.simplefilter("error", RuntimeWarning)
    generator, written = random.Random(7), 0
    for _ in range(n):
        folder = t.folder / "damaged"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(t.folder / generator.choice(names), folder)
        files = sorted(path for path in folder.iterdir() if path.suffix in (".csv", ".h5", ".yaml"))
        path = generator.choice(files)
        damage = generator.choice(BYTES if path.suffix == ".h5" else (column_out, *LINES))
        path.write_bytes(damage(generator, path.read_bytes())[0])
        try:
            write_page([folder], t.folder / "damaged.html", "damaged", Options())
            written += 1
        except BadInput as error:
            t.check("\n" not in str(error), f"{path.name}, {damage.__name__}: {error}")
        except Exception as error:  # what a user would see as a trace
            t.check(False, f"{path.name}, {damage.__name__}: {error!r}")
    t.check(written > n // 2, f"{written} pages of {n} damaged folders")


def main():
    with tempfile.TemporaryDirectory(prefix="squeal-") as name, sooner(sys.argv[1]) as squeal:
        t = Test(Path(name))
        make_results(squeal, Path(sys.argv[2]).resolve(), t.folder)
        names = ("modes", "modes_quiet", "static", "sweep", "transient", "frf", "map", "vibration", "cycle")
        page = t.page(*names)
        check_alone(t, page)
        for key, folder in (("r1", "modes"), ("r2", "modes_quiet")):
            check_modes(t, page, key, t.folder / folder)
            check_shapes(t, page, key, t.folder / folder)
        check_static(t, page, "r3", t.folder / "static")
        check_sweep(t, page, "r4", t.folder / "sweep")
        check_transient(t, page, "r5", t.folder / "transient")
        check_frf(t, page, "r6", t.folder / "frf")
        check_map(t, page, "r7", t.folder / "map")
        check_vibrations(t, page, ("r8", "r9"), [t.folder / name for name in names[-2:]])
        check_words(t, page, "r3", ("press: −100 N along z in total on beam_top.",
                                    "hub: disc_inner is held in x, y and z."))
        check_turned(t, t.folder / "static")
        check_together(t, page, [t.folder / name for name in names])
        for number, name in enumerate(names, 1):
            check_origin(t, page, f"r{number}", t.folder / name)
            check_cost(t, page, f"r{number}", t.folder / name)
        check_bad(t)
        check_damages(t, names)
    print("\n".join(t.faults) or "all as it should be")
    return 1 if t.faults else 0


if __name__ == "__main__":
    sys.exit(main())
