#!/usr/bin/env python3
"""What one expects of a program on PETSc: -X_view shows an object in a file (VIEWS) as on stdout, -log_view knows the
hot functions (EVENTS), -squeal_traceback shows where an error arose, and how many options and names a scene may have.
Breaks when an object is shown elsewhere, not at all or twice, an event is not begun or not ended, an error with its
traceback no longer fails on all ranks, or names of a long list are dropped.

    test_petsc.py SQUEAL MPIRUN"""

import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from served import own_words

OPTIONS = Path(__file__).resolve().parents[1] / "options"
COARSE = "-rig_disc_elements 6,12,1 -rig_pad_elements 3,3,2 -rig_beam_elements 4"
# Options files and what goes with them, for a second or so
RUNS = {
    "modes": "oscillator",
    "sweep": "oscillator -sweep_parameter contact_mu -sweep_values 0:1:5",
    "static": f"massi2005 {COARSE}",
    "transient": f"massi2005_transient {COARSE} -tap_impulse 0,0,0 -ts_max_time 2e-6",
}
# Analysis: its views, each with words of it
VIEWS = {
    "modes": {"operators": "unknowns", "modes": "mode"},
    "sweep": {"operators": "unknowns", "sweep": "points"},
    "static": {"model": "part", "contact": "pairs", "static": "equilibrium"},
    "transient": {"model": "part", "dynamics": "step"},
}
EVENTS = {
    "modes": "Assemble ShiftInvFactor ShiftInvSolve",
    "sweep": "BasisCorrect BasisOrthonorm ReducedEigen TrackLine",
    "static": "ContactPair StaticsSolve",
    "transient": "ContactSearch ContactProject BodiesAdvance External KickAndDrift HistoryRecord",
}


class Runner:
    """Runs squeal in a folder of its own and keeps what is wrong."""

    def __init__(self, squeal, mpirun, folder):
        self.squeal, self.mpirun, self.folder, self.faults = squeal, mpirun, folder, []

    def run(self, analysis, *more, ranks=1):
        name, *options = RUNS[analysis].split()
        command = [self.mpirun, "-n", str(ranks), self.squeal, "-options_file", OPTIONS / f"{name}.yaml", "-analysis",
                   analysis, "-output_dir", self.folder / "out", *options, *more]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.folder)

    def check(self, holds, what, done):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)
            print(done.stdout + done.stderr)


def check_views(r):
    for analysis, views in VIEWS.items():
        asked = [word for room in views for word in (f"-{room}_view", f"ascii:{room}.txt")]
        done = r.run(analysis, "-squeal_view", *asked)
        for room, words in views.items():
            path = r.folder / f"{room}.txt"
            text = path.read_text() if path.exists() else ""
            r.check(not done.returncode and words in text, f"{analysis}: -{room}_view has '{words}'", done)
            lines = [line for line in text.splitlines() if not line.startswith("time")]
            r.check(all(line in done.stdout for line in lines), f"{analysis}: -{room}_view as on stdout", done)
            path.unlink(missing_ok=True)
        r.check(done.stderr == "", f"{analysis}: nothing on stderr", done)


def check_where(r):
    once = r.run("modes")
    done = r.run("modes", "-modes_view")
    r.check(once.stdout.count("\n") == done.stdout.count("\n"), "-modes_view on stdout is no second time", done)
    for _ in range(2):
        done = r.run("modes", "-modes_view", "ascii:all.txt::append")
    text = (r.folder / "all.txt").read_text()
    r.check(len(text) > 10 and text[:len(text) // 2] == text[len(text) // 2:], "-modes_view appends", done)
    done = r.run("modes", "-modes_view", "binary:modes.bin")
    said = "squeal: error: -modes_view shows text"
    r.check(done.returncode == 1 and re.fullmatch(f"{said}.*\n", done.stderr), "a viewer of text only", done)
    done = r.run("modes", "-sweep_view")
    said = "squeal: error: -sweep_view: not used by -analysis modes: it has nothing to show there\n"
    r.check(done.returncode == 1 and done.stderr == said, "a view of what is not there", done)


def check_events(r):
    for analysis, names in EVENTS.items():
        done = r.run(analysis, "-log_view")
        for name in names.split():
            counted = re.search(rf"^{name} +([0-9]+) ", done.stdout, re.MULTILINE)
            r.check(not done.returncode and counted and int(counted[1]) > 0, f"{analysis}: event {name}", done)


def check_traceback(r):
    for ranks in (1, 2):
        plain = r.run("modes", "-contact_mu", "abc", ranks=ranks)
        said = own_words(plain.stderr).strip()
        r.check(plain.returncode == 1 and said and "\n" not in said, f"{ranks} ranks: one line", plain)
        done = r.run("modes", "-contact_mu", "abc", "-squeal_traceback", ranks=ranks)
        traced = all(f"[{rank}]PETSC ERROR: " in done.stderr for rank in range(ranks))  # lines of ranks may mix
        r.check(traced and "OperatorsSetFromOptions() at " in done.stderr, f"{ranks} ranks: tracebacks", done)
        alone = re.sub(r"\[[0-9]+\]PETSC ERROR: .*\n", "", done.stderr)  # tracebacks may stand amid the line
        r.check(done.returncode == 1 and said in alone, f"{ranks} ranks: line and status stay", done)


def check_many(r):
    """So many springs that are one together have its frequencies; PETSc 3.18 takes 512 options, which is said."""
    stiffness, found = 8.422e6, {}
    for count in (1, 150, 300):
        names = [f"rows{i}" for i in range(count)]
        rows = [f"{name}: {{set: beam_rows, stiffness: \"0,{stiffness / count!r},0\"}}" for name in names]
        scene = r.folder / f"springs{count}.yaml"
        scene.write_text("\n".join([f"springs: {','.join(names)}", "modes_band: 500,3000", *rows]) + "\n")
        before = (OPTIONS / "massi2005.yaml").read_text()
        scene.write_text(re.sub(r"^(springs|rows|modes):.*\n", "", before, flags=re.MULTILINE) + scene.read_text())
        out = r.folder / f"springs{count}"
        done = subprocess.run([r.squeal, "-options_file", scene, *COARSE.split(), "-output_dir", out], capture_output=True, text=True,
                              cwd=r.folder, check=False)
        if done.returncode == 0:
            found[count] = [float(row["freq_hz"]) for row in csv.DictReader((out / "modes.csv").open())]
            worst = max(abs(a / b - 1) for a, b in zip(found[count], found[1]))
            r.check(len(found[count]) == len(found[1]) > 3 and worst < 1e-9, f"{count} springs as one: {worst:.1e}", done)
        else:
            said = rf"squeal: error: {re.escape(str(scene))} gives \d+ options; PETSc 3\.\d+ takes 512 options of all files and .*\n"
            r.check(count == 300 and re.fullmatch(said, done.stderr), f"{count} springs are refused with file, count and limit", done)


def main():
    squeal, mpirun = (Path(name).resolve() for name in sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        r = Runner(squeal, mpirun, Path(folder))
        for check in (check_views, check_where, check_events, check_traceback, check_many):
            check(r)
    return 1 if r.faults else 0


if __name__ == "__main__":
    sys.exit(main())
