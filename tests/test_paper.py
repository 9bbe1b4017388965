#!/usr/bin/env python3
"""scripts/paper --coarse from end to end: stopped by ^C, killed, and started again, it makes what is not complete and
nothing else, leaves no run of its own behind, and its page shows the numbers of the tables, read here on their own. A
run that fails is a section that says so. Breaks when a complete run is made again, a half-written one is taken for
complete, other options or another program are taken for the same, or the page misses a figure.

    test_paper.py SQUEAL"""

import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from browser import Browser, find_browser
from processes import processes_naming
from test_report import Page
from test_report_browser import Test, check_window

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.provenance import Provenance # noqa: E402
N_RUNS = len(re.findall(r"^    (?:Planned|in_time)\(", (SOURCE / "scripts/squeal/paper/plan.py").read_text(), re.M))
SECTIONS = ["table1", *(f"fig{i}" for i in range(3, 12)), "kn", "cost"]
BELIEVED = 300  # s that anything may take
# Fails where it should make the run of 16 GPa
FAILS = """#!/bin/bash
case "$*" in *time-16*) echo "squeal: error: no such luck" >&2; exit 1; esac
exec {squeal} "$@"
"""


class Paper:
    """A folder, and what is wrong."""

    def __init__(self, squeal, root):
        self.squeal, self.root, self.folder, self.faults = squeal, root, root / "paper", []

    def check(self, holds, what):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)

    def command(self, *words, program=None):
        return list(map(str, ["/usr/bin/python3", SOURCE / "scripts/paper", "--coarse", "--program",
                              program or self.squeal, "-o", self.folder, *words]))

    def run(self, *words, program=None):
        return subprocess.run(self.command(*words, program=program), capture_output=True, text=True, cwd=self.root,
                              check=False)

    def complete(self):
        """Time of the log of each complete run."""
        return {path.parent.name: path.stat().st_mtime_ns for path in self.folder.glob("*/log.txt")}

    def under_way(self):
        """Folders of runs that have begun and not ended."""
        return [path.parent for path in self.folder.glob("*/out.part") if not (path.parent / "log.txt").exists()]

    def processes(self):
        """Those that work in the folder."""
        return processes_naming(self.folder)

    def made(self, done, n, n_kept, what):
        """So many runs were made and kept."""
        self.check(done.returncode == 0 and f"{n} run{'s' * (n != 1)} made, {n_kept} kept" in done.stdout,
                   f"{what}: {n} made, {n_kept} kept {done.stdout[:60]!r} {done.stderr[-200:]!r}")


def rows_of(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def interrupted(p, sign, n):
    """Sends a signal when n more runs are complete and others under way; returns the complete ones, status and
    what was said."""
    wanted = len(p.complete()) + n
    with (p.root / "said").open("w") as said:
        process = subprocess.Popen(p.command("--jobs", "2"), stderr=said, stdout=said, cwd=p.root)
        begun = time.monotonic()
        while ((len(p.complete()) < wanted or not p.under_way()) and process.poll() is None and
               time.monotonic() - begun < BELIEVED):
            time.sleep(0.01)
        process.send_signal(sign)
        process.wait(BELIEVED)
    begun = time.monotonic()
    while p.processes() and time.monotonic() - begun < BELIEVED:
        time.sleep(0.05)
    begun = p.under_way()
    ended = [folder.name for folder in begun if any(Provenance(scene).ended() for scene in folder.glob("scene.yaml"))]
    p.check(len(ended) < len(begun) and not p.processes(),  # one may end by itself just then
            f"{sign.name} ends the {len(begun)} runs that were under way {ended} {p.processes()}")
    p.check(not (p.folder / "paper.html").exists(), f"{sign.name}: no page of half the runs")
    return p.complete(), process.returncode, (p.root / "said").read_text()


def check_resume(p):
    """Stopped twice, then to the end, then nothing."""
    listed = p.run("--list")
    p.check(f"{N_RUNS} of {N_RUNS} runs to be made" in listed.stdout and not p.complete(), "the list makes nothing")
    first, status, said = interrupted(p, signal.SIGINT, 2)
    p.check(status == 130 and re.search(rf"paper: stopped; {len(first)} of {N_RUNS} runs are complete", said) and
            "Traceback" not in said, f"^C: status {status} {said[-200:]!r}")
    p.check(re.search(rf"^0 of {N_RUNS} runs, about .* left: ", said, re.M), "the time left is told")
    second, *_ = interrupted(p, signal.SIGKILL, 2)
    p.check(2 <= len(first) < len(second) < N_RUNS, f"{len(first)}, then {len(second)} of {N_RUNS} runs are complete")
    p.made(p.run(), N_RUNS - len(second), len(second), "the same command")
    last = p.complete()
    p.check(all(last[name] == stamp for name, stamp in (first | second).items()), "complete runs are as they were")
    p.made(p.run(), 0, N_RUNS, "once more")


def check_half_written(p):
    """A run without its log, another program, other options: made again, and nothing else."""
    (p.folder / "disc-2412/log.txt").unlink()
    (p.folder / "disc-2412/modes.csv").write_text("mode,freq_hz\n1,")
    p.made(p.run(), 1, N_RUNS - 1, "a run without its end")
    p.check(len(rows_of(p.folder / "disc-2412/modes.csv")) > 3, "its table is whole again")
    p.made(p.run("--only", "kn", "--fresh"), 1, 0, "--fresh")
    other = p.root / "other"
    shutil.copy(p.squeal, other)
    with other.open("ab") as file:
        file.write(b"\0")
    p.made(p.run("--only", "kn", program=other), 1, 0, "another program")
    p.made(p.run("--only", "kn"), 1, 0, "and back")


def claims_of(page, name):
    """Texts of a figure's claims: (what, paper, here, verdict)."""
    rows = [e for e in page.find("li", inside=f"paper-{name}-claims") if e.get("class") != "head"]
    cells = [e["text"] for e in page.elements if e["tag"] in ("b", "span", "i")
             and f"paper-{name}-claims" in e["inside"]][4:]
    return [cells[4 * i:4 * i + 4] for i in range(len(rows))]


def number(text, pattern):
    """What the pattern finds in a text with proper minus signs."""
    found = re.search(pattern, text.replace("\N{MINUS SIGN}", "-"))
    return float(found[1]) if found else float("nan")


def check_numbers(p, page):
    """Numbers of the page, computed here from the tables."""
    lumped = {row["label"]: float(row["freq_hz"]) for row in rows_of(p.folder / "modes-lumped/modes.csv")[::-1]}
    row = page.table("paper-table1-frequencies")[0]
    p.check(row["mode"] == "(0,4+)" and float(row["Plast3"]) == 3424 and
            float(row["lumped mass, Hz"]) == lumped["(0,4+)"], f"Table 1: {row}")
    fine, coarse = ([float(row["freq_hz"]) for row in rows_of(p.folder / name / "modes.csv")]
                    for name in ("disc-10240", "disc-2412"))
    worst = 100 * max(abs(b / a - 1) for a, b in zip(fine, coarse) if a < 10e3)
    p.check(abs(number(claims_of(page, "fig3")[0][2], r"([\d.]+) %") - worst) < 0.006, f"Figure 3: {worst:.2f} %")
    found = claims_of(page, "kn")
    told = (p.folder / "pressing/log.txt").read_text()
    total = float(re.search(r"per pair, (\S+) N/m in total", told)[1])
    p.check(abs(number(found[1][2], r"^([\d.]+) × 10") * 10**(len(f"{total:.0f}") - 1) / total - 1) < 1e-4,
            f"k_n: {found[1][2]} of {total:g}")
    peak = next(row for row in rows_of(p.folder / "response/peaks.csv") if row["label"] == "(0,4+)")
    p.check(float(row["in time, Hz"]) == float(peak["mode_freq_hz"]) and
            f"{float(peak['mode_freq_hz']):.0f} Hz" in claims_of(page, "fig4")[1][2], f"in time: {peak}")
    rows = rows_of(p.folder / "time-39.8/transient.csv")
    most = max(float(row["normal_force_n"]) for row in rows[len(rows) // 2:])
    p.check(abs(number(claims_of(page, "fig10")[1][2], r"at most ([\d.]+) N") / most - 1) < 0.01,
            f"Figure 10: {claims_of(page, 'fig10')[1]}, {most:.2f} N")


def check_lines(p, text):
    """No line has many more points than two for each point of the screen: breaks when a page of long records is too
    large to be opened."""
    most = 0.0
    for kind, width in (("wide", 1120), ("half", 540), ("narrow", 372)):
        for picture in re.findall(rf'<svg class="chart {kind}".*?</svg>', text, re.DOTALL):
            counts = [d.count("L") for d in re.findall(r' d="(M[^"]*)"', picture)]
            most = max([most, *(n / width for n in counts)])
    p.check(0.5 < most < 2.5, f"{most:.2f} points of a line for a point of the screen at most")


def check_page(p):
    """Every figure, its claims and pictures, one file of a sensible size."""
    text = (p.folder / "paper.html").read_text()
    page = Page(p.folder / "paper.html")
    names = [e["id"] for e in page.elements if e.get("id")]
    p.check(len(names) == len(set(names)), "no name stands twice")
    p.check(all(f"paper-{name}" in names for name in SECTIONS), "all sections are there")
    empty = [name for name in SECTIONS[:-1] if not claims_of(page, name)]
    p.check(not empty and not page.find("p", class_="missing", inside="first")[1:], f"every figure has claims {empty}")
    p.check(len(text) < 10e6 and not re.search(r'(src|href)="https?:', text), f"one file of {len(text)} bytes")
    how = (p.folder / "response/response.txt").read_text().splitlines()
    p.check(len(how) > 3 and all(f"<li>{line}</li>" in text for line in how), "it is said how the response was made")
    check_lines(p, text)
    took = [float(row["time, s"]) for row in page.table("paper-cost-table")]
    p.check(len(took) == N_RUNS and min(took) >= 0 and max(took) > 0, f"the time of every run {took}")
    check_numbers(p, page)


def check_failure(p):
    """A run that fails."""
    program = p.root / "fails"
    program.write_text(FAILS.format(squeal=p.squeal))
    program.chmod(0o755)
    p.folder = p.root / "failing"
    done = p.run("--only", "fig7,kn", program=program)
    p.check(done.returncode == 1 and "time-16: FAILED, squeal: error: no such luck" in done.stderr and
            "Traceback" not in done.stderr, f"a failed run is said {done.stderr[-300:]!r}")
    page = Page(p.folder / "paper.html")
    p.check(page.find("p", class_="missing", inside="paper-fig7") and len(claims_of(page, "kn")) == 2,
            "its figure says so, the others are there")
    (p.root / "blocked").mkdir()
    (p.root / "blocked/pressing").touch()
    (p.folder / "pressing/static.csv").unlink()
    for words, said in ((["--only", "kn", "-o", p.root / "blocked"], "blocked/pressing: no folder for a run can be"),
                        (["--only", "fig3,kn", "--program", program], "--fresh makes every run again"),
                        (["--only", "fig2"], "--only: fig2: must be some of table1,fig3"), (["--jobs", "0"], "--jobs"),
                        (["-o", p.squeal], "cannot be made"), (["--program", "nowhere"], "no such file")):
        done = p.run(*words)
        p.check(done.returncode and said in done.stderr and "Traceback" not in done.stderr,
                f"{' '.join(map(str, words))}: {done.stderr[-120:]!r}")


def check_browser(p):
    """In Chromium, where there is one."""
    program = find_browser()
    if not program:
        print("not looked at in a browser: no Chromium")
        return
    with Browser(program) as browser:
        t = Test(browser)
        for width, scheme in ((1280, "light"), (400, "dark"), (1280, "dark"), (400, "light")):
            check_window(t, (p.folder / "paper.html").as_uri(), width, scheme)
        p.faults += t.faults


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # else what nohup and & ignore, the runs ignore too
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory(prefix="squeal-paper-") as root:
        p = Paper(Path(sys.argv[1]).resolve(), Path(root))
        for check in (check_resume, check_page, check_browser, check_half_written, check_failure):
            check(p)
    print("\n".join(p.faults) or "all as it should be")
    return 1 if p.faults else 0


if __name__ == "__main__":
    sys.exit(main())
