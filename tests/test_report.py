#!/usr/bin/env python3
"""The page of scripts/report, without a browser: every number that it shows is the one of the table, shapes are those
of the fields, nothing outside of the file is named, and folders that are empty, half-written or damaged give one line
or a section that says so. Numbers are compared with the files that squeal wrote, read here on their own.

    test_report.py SQUEAL MPIRUN"""

import base64
import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path

import h5py
import numpy
from brake_results import SOURCE, make_results

LARGEST = 10e6  # bytes


class Page(HTMLParser):
    """Elements of a page in their order, as dictionaries: tag, attributes, and the text within."""

    def __init__(self, path):
        super().__init__()
        self.elements, self.open = [], []
        self.source = path.read_text()
        self.feed(self.source)
        self.close()

    def handle_starttag(self, tag, attributes):
        element = {"tag": tag, "text": "", "inside": [other.get("id") for other in self.open], **dict(attributes)}
        self.elements.append(element)
        if tag not in ("meta", "link", "img", "br", "input"):
            self.open.append(element)

    def handle_endtag(self, tag):
        while self.open and self.open.pop()["tag"] != tag:
            pass

    def handle_data(self, data):
        for element in self.open:
            element["text"] += data

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
        return subprocess.run(["/usr/bin/python3", SOURCE / "scripts" / name, *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True, check=False)

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
        self.check(done.returncode == 1 and done.stderr.count("\n") == 1 and expected in done.stderr and not done.stdout,
                   f"{script} {' '.join(map(str, words))} says '{expected}': {done.stderr!r}")


def rows_of(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def close(found, expected, tolerance):
    """Whether all numbers agree within an absolute tolerance."""
    found, expected = (numpy.asarray(list(values), float) for values in (found, expected))
    return found.shape == expected.shape and bool((abs(found - expected) <= tolerance).all())


def same_numbers(page, table, title, rows, column, factor=1.0):
    """Whether a column of the page is one of the file, to its last digit but one."""
    found = [float(row[title]) for row in page.table(table)]
    return len(found) == len(rows) > 0 and close(found, [factor * float(row[column]) for row in rows],
                                                 1e-14 * max(abs(float(row[column]) * factor) for row in rows))


def straight(pixels, values):
    """Whether places on the screen are a straight line of values, within the rounding to a tenth."""
    pixels, values = (numpy.array(list(v), float) for v in (pixels, values))
    line = numpy.polyfit(values, pixels, 1)
    return len(values) > 2 and abs(line[0]) > 0 and abs(numpy.polyval(line, values) - pixels).max() < 0.11


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
        picture = [e for e in page.elements if figure["id"] in e["inside"] and e["tag"] in ("svg", "canvas")]
        commands = [e["text"] for e in page.find("code", inside=figure["id"])]
        scripts = [SOURCE / command.split()[0] for command in commands]
        t.check(picture and len(commands) == 1 and scripts[0].exists(), f"{figure['id']} has a picture and its command")


def check_modes(t, page, key, folder):
    """Table, chart and shares: breaks when a row, a unit or a column is mixed up."""
    rows = rows_of(folder / "modes.csv")
    for title, column, factor in (("mode", "mode", 1), ("freq, Hz", "freq_hz", 1), ("growth, 1/s", "growth_rad_s", 1),
                                  ("damping, %", "damping_ratio", 100), ("error, Hz", "error_hz", 1),
                                  ("condition", "condition", 1), ("backward error", "backward_error", 1),
                                  ("beam, %", "part_beam_percent", 1)):
        t.check(same_numbers(page, f"{key}-table", title, rows, column, factor), f"{key}: {title} of the table")
    t.check([row["label"] for row in page.table(f"{key}-table")] == [row["label"] for row in rows], f"{key}: labels")
    by_mode = {row["mode"]: row for row in rows}
    for kind in ("wide", "narrow"):
        svg = page.find("svg", inside=f"{key}-eigenvalues", class_=f"chart {kind}")
        t.check(len(svg) == 1, f"{key}: one {kind} chart")
    dots = page.find("circle", inside=f"{key}-eigenvalues")
    wide = dots[:len(dots) // 2]
    t.check(sorted(int(e["data-shape"]) for e in wide) == sorted(int(mode) for mode in by_mode), f"{key}: a dot a mode")
    chosen = [by_mode[e["data-shape"]] for e in wide]
    t.check(straight((e["cx"] for e in wide), (row["freq_hz"] for row in chosen)), f"{key}: dots over frequency")
    if any(float(row["growth_rad_s"]) for row in rows):
        t.check(straight((e["cy"] for e in wide), (row["growth_rad_s"] for row in chosen)), f"{key}: dots over growth")
    told = all(f"{float(row['freq_hz']):.3f} Hz" in e["text"] and ("UNSTABLE" in e["text"]) == (row["unstable"] == "1")
               for e, row in zip(wide, chosen))
    t.check(told, f"{key}: each dot tells its frequency and whether it grows")
    boxes = page.find("rect", inside=f"{key}-parts", class_="box green")
    shares = [float(row["part_beam_percent"]) for row in rows]
    seen = [(e["height"], share) for e, share in zip(boxes, shares) if share > 1]
    t.check(len(boxes) == 2 * len(rows) and straight(*zip(*seen)), f"{key}: shares of the beam")


def numbers(text, kind):
    return numpy.frombuffer(base64.b64decode(text), kind)


def check_shapes(t, page, key, folder):
    """Places and displacements that the viewer gets against the field, node by node: breaks when axes, nodes, phase or
    modes are mixed up. The frame of this brake is y, x, z; 16 bits leave 2e-5."""
    data = json.loads(page.find("script", id=f"{key}-data")[0]["text"])
    with h5py.File(folder / "modes.h5") as file:
        points = file["VTKHDF/Points"][:][:, [1, 0, 2]]
        middle, half = (points.max(axis=0) + points.min(axis=0)) / 2, numpy.ptp(points, axis=0).max() / 2
        place = middle + half * numbers(data["points"], "<f4").reshape(-1, 3)
        node, before = [], -1
        for here in place:  # nodes keep their order; pad and disc have some at one place
            near = numpy.flatnonzero(numpy.linalg.norm(points - here, axis=1) < 1e-7)
            before = next((int(i) for i in near if i > before), -1)
            node.append(before)
        t.check(min(node) >= 0 and len(node) > len(points) / 3, f"{key}: places of the surface")
        for shape in data["shapes"]:
            name = f"VTKHDF/PointData/mode_{shape['number']:03d}"
            field = (file[f"{name}_re"][:] + 1j * file[f"{name}_im"][:])[:, [1, 0, 2]][node].ravel()
            moved = numbers(shape["re"], "<i2").astype(complex)
            moved += 1j * numbers(shape["im"], "<i2") if shape["im"] else 0
            factor = numpy.vdot(moved, field) / numpy.vdot(moved, moved)
            left = abs(factor * moved - field).max() / abs(field).max()
            if left > (2e-3 if shape["im"] is None else 1e-4):
                t.check(False, f"{key}: shape {shape['number']} is off by {left:.1e}")
    n_modes = len(rows_of(folder / "modes.csv"))
    t.check(len(data["shapes"]) == n_modes, f"{key}: {len(data['shapes'])} shapes of {n_modes}")


def check_origin(t, page, key, folder):
    """All options in force, and the command."""
    text = (folder / "scene.yaml").read_text()
    given = dict(re.findall(r'^([\w-]+): "(.*)"$', text, re.MULTILINE))
    shown = {row["option"]: row["value"] for row in page.table(f"{key}-options") if row[""] == "given"}
    t.check(shown == given and len(given) > 20, f"{key}: the options that were given")
    repeat = re.search(r"# repeat: (.*)", text)[1]
    t.check(repeat in [e["text"] for e in page.find("code", inside=f"{key}-origin")], f"{key}: the command that repeats")


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
    t.check(any("empty: holds no result" in e["text"] for e in page.find("p", class_="missing")), "a section for what is empty")
    for said, *words in (("was the file cut off?", "cut"), ("modes.h5: cannot be read", "torn"),
                         ("--modes 99: no such mode", "modes", "--modes", "99")):
        page = t.page(*words, told=said)
        t.check(any(said in e["text"] for e in page.find("p", class_="missing")), f"{words[0]}: a section says '{said}'")
    page = t.page("cut", told="cut/scene.yaml: no such file")
    t.check("scene.yaml: no such file" in page.source, "what a folder without scene.yaml lacks is said")


def main():
    squeal, mpirun = (Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        t = Test(Path(name))
        make_results(squeal, mpirun, t.folder, ("modes", "modes_quiet"))
        page = t.page("modes", "modes_quiet")
        check_alone(t, page)
        for key, folder in (("r1", "modes"), ("r2", "modes_quiet")):
            check_modes(t, page, key, t.folder / folder)
            check_shapes(t, page, key, t.folder / folder)
            check_origin(t, page, key, t.folder / folder)
        check_bad(t)
    print("\n".join(t.faults) or "all as it should be")
    return 1 if t.faults else 0


if __name__ == "__main__":
    sys.exit(main())
