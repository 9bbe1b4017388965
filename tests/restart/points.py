#!/usr/bin/env python3
"""A sweep in full, or on real modes, or a direct response, that is killed goes on with the points that it has kept, and ends with the
tables of one that nobody disturbed: sweeps to the last byte on one rank, with the same rows and 1e-9 of the frequencies on more, where
sums have another order. A signal is answered with what is kept. Another scene, another method and a damaged file are named, and the
sweep begins anew. Breaks when something that the next point depends on is not kept, when a killed run leaves no scene.yaml, or when
points of another sweep are taken.

    points.py SQUEAL LAUNCHER [--ranks 1] [--case line]"""

import argparse
import csv
import math
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from runs import SOURCE, fail, killed_at, outcome_of, starter
from served import OPEN, WRITE, plan, preloading

SMALL = 'rig: {disc: {elements: "5,18,1"}, pad: {elements: "3,3,1"}, beam: {elements: 4}}\nmodes: {band: "100,6000"}\n'
CASES = {  # options, and after how many points it is killed
    "direct": ("-analysis frf -frf_method direct -probes tip -tip_at 0.11,0,0.11 -tip_part beam -frf_force tip,z"
               " -frf_frequencies 500:6000:6 -pad_beta 1e-7", 3),
    "line": ("-sweep_method full -sweep_parameter contact_mu -sweep_values 0,0.2,0.4,0.6 -pad_beta 1e-7", 2),
    "real": ("-sweep_method real -sweep_parameter pad_young -sweep_values 6.5e9:80e9:4 -sweep_verify 1", 2),
    "grid": ("-sweep_method full -sweep_parameter contact_mu,pad_young -sweep_values 0,0.3,0.6"
             " -sweep_values_2 6.5e9,20e9,60e9 -pad_beta 1e-7", 5),
    "static": ("-sweep_method full -modes_contact static -sweep_parameter contact_mu -sweep_values 0.05,0.06,0.3,0.6"
               " -pad_beta 1e-7", 2),
}
TABLES = "sweep.csv", "onsets.csv", "parameters.csv", "verify.csv", "frf.csv", "peaks.csv"


def alike(one, other):
    """Whether two rows of a response agree to 1e-9 of the largest number but the frequency: the last digit of an error depends on how
    memory is aligned, hence on the process."""
    pairs = [(float(one[key]), float(other[key])) for key in one if not key.startswith(("freq", "mode", "damping", "label"))]
    largest = max(abs(a) for a, _ in pairs)
    return one["freq_hz"] == other["freq_hz"] and all(abs(a - b) <= 1e-9 * largest for a, b in pairs)


class Sweep:
    """A sweep of one case, in folders of its own."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.options, self.n = CASES[arguments.case]
        self.kept = "frf_restart" if arguments.case == "direct" else "sweep_restart_000"
        self.program = starter(arguments.squeal)

    def command(self, output, *options):
        (self.folder / "small.yaml").write_text(SMALL)
        return [self.arguments.launcher, "-n", str(self.arguments.ranks), self.arguments.squeal, "-options_file",
                SOURCE / "options/massi2005.yaml", "-options_file", self.folder / "small.yaml", "-analysis", "sweep",
                *self.options.split(), "-output_dir", self.folder / output, *options]

    def complete(self, output, *options):
        """Runs to the end; what it says."""
        outcome = outcome_of(self.program, self.folder, self.command(output, *options)[4:], self.arguments.ranks)
        if outcome.status:
            fail(outcome.stderr)
        return outcome.stdout + outcome.stderr

    def stop(self, output):
        """Kills it as it begins to keep the point after the n-th; the folder then holds the scene, and points."""
        killed = killed_at(self.command(output), self.folder / output / self.kept, calls=OPEN, at=self.n + 1)
        left = sorted(path.name for path in (self.folder / output).iterdir() if not path.name.startswith("."))
        if not killed or left != sorted(["scene.yaml", self.kept]):
            fail(f"a killed sweep leaves {left}")

    def same(self, output):
        """Tables beside those of the undisturbed one."""
        for table in TABLES:
            one, other = (self.folder / name / table for name in ("whole", output))
            if one.exists() != other.exists():
                fail(f"{table} is missing")
            if not one.exists() or one.read_bytes() == other.read_bytes():
                continue
            rows = [list(csv.DictReader(path.open(newline=""))) for path in (one, other)]
            if self.kept == "frf_restart" and len(rows[0]) == len(rows[1]) and all(map(alike, *rows)):
                continue
            near = all(math.isclose(float(a["freq_hz"]), float(b["freq_hz"]), rel_tol=1e-9, abs_tol=1e-3) and
                       [a[key] for key in ("point", "branch", "unstable", "label")] ==
                       [b[key] for key in ("point", "branch", "unstable", "label")] for a, b in zip(*rows)) \
                if table == "sweep.csv" else True
            if self.arguments.ranks == 1 or len(rows[0]) != len(rows[1]) or not near:
                fail(f"{table} differs")
        if list((self.folder / output).glob("*_restart*")):
            fail("points are still kept after the end")

    def goes_on(self, said):
        if f"going on with {self.n} of " not in said or "warning" in said:
            fail(f"it did not go on: {said}")


def check_signal(sweep):
    """SIGTERM, before the file of the third point is written."""
    report = sweep.folder / "report"
    stop = plan(sweep.folder / "asked" / sweep.kept, report, WRITE, 5, signal=int(signal.SIGTERM))
    _, _, _, program, *words = map(str, sweep.command("asked"))
    library = Path(program).resolve().parent / "tests/libfault.so"
    done = subprocess.run(preloading(program, library, words, stop, 1), capture_output=True, text=True, check=False)
    if done.returncode != -signal.SIGTERM or "squeal: error: stopped by SIGTERM; " not in done.stderr or \
            "points are kept, with which the same command goes on\n" not in done.stderr:
        fail(f"SIGTERM: {done.returncode} {done.stderr}")
    if "going on with" not in sweep.complete("asked"):
        fail("it does not go on after SIGTERM")
    sweep.same("asked")


def check_refused(sweep):
    """Another scene, another method, a file with a bit turned."""
    changes = (("the sweep begins anew", "materials", "-beam_poisson", "0.29"), ("the sweep begins anew", "the sweep",
               "-sweep_method", "reduced", "-sweep_onsets", "0"), ("the sweep begins anew", "is damaged"))
    for number, (then, what, *options) in enumerate(changes):
        output = f"other{number}"
        shutil.copytree(sweep.folder / "killed copy", sweep.folder / output)
        if not options:
            file = sweep.folder / output / sweep.kept
            data = bytearray(file.read_bytes())
            data[-800] ^= 4
            file.write_bytes(data)
        said = sweep.complete(output, *options)
        line = [line for line in said.splitlines() if line.startswith("squeal: warning: ")]
        if len(line) != 1 or sweep.kept not in line[0] or what not in line[0] or not line[0].endswith(then) or "going on" in said:
            fail(f"{what}: {said}")
        if not options:
            sweep.same(output)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--case", choices=CASES, default="line")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        sweep = Sweep(arguments, Path(folder))
        sweep.complete("whole")
        sweep.stop("killed")
        shutil.copytree(sweep.folder / "killed", sweep.folder / "killed copy")
        sweep.goes_on(sweep.complete("killed"))
        sweep.same("killed")
        if arguments.case == "line" and arguments.ranks == 1:
            check_signal(sweep)
            check_refused(sweep)
        sweep.program.end()
    print("gone on with the points kept, the same tables")
    return 0


if __name__ == "__main__":
    sys.exit(main())
