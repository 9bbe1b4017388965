"""Runs of `squeal -analysis sweep` for the studies: the tables of each, by the names of their columns, and its times.
Eigenvalues are complex numbers sigma + i omega (rad/s), growth in 1/s, frequencies in Hz."""

import math
import re
import tempfile
from pathlib import Path

import numpy

from ..run.program import measured_run, scene
from ..tables import flag, optional, read_table

SWEEP = {"value": float, "branch": optional, "freq_hz": float, "growth_rad_s": float, "error_estimate": optional,
         "unstable": flag, "label": str}
ONSETS = {"critical_value": float, "freq_hz": float, "kind": str, "label": str, "confirmed": flag}
VERIFY = {"modes_full": int, "modes_reduced": int, "unstable_full": int, "unstable_reduced": int, "true_error": float,
          "error_estimate": optional}
DEFAULT = "massi2005", "massi2005_sweep"  # options files
PAIRED = 0.01  # two unstable eigenvalues are the same one within this, relative


def with_values(values, *more):
    """Option with a list of values, Pa, to a relative 1e-11."""
    return "-sweep_values " + ",".join(f"{value:.11g}" for value in sorted({*values, *more}))


class SweepRun:
    """One sweep: rows of sweep.csv, onsets.csv, verify.csv (none where it was not asked for), seconds by
    part, and those of processor of the process.

    The options files of options/ are named without their ending and stack in their order.
    """

    def __init__(self, program, ranks, files, options):
        with tempfile.TemporaryDirectory() as folder:
            words = ["-squeal_view", "-squeal_progress", 0, *scene(*files), "-output_dir", folder, *options.split()]
            self.options = options
            self.text, self.cpu, _ = measured_run(program, ranks, words, f"{', '.join(files)}, options {options}")
            self.rows = read_table(Path(folder) / "sweep.csv", SWEEP)
            self.onsets = self.read_if_there(Path(folder) / "onsets.csv", ONSETS)
            self.checks = self.read_if_there(Path(folder) / "verify.csv", VERIFY)
        self.seconds = {part: float(s) for part, s in re.findall(r"(\w+) ([\d.]+) s", self.only(r"^time: (.*)$"))}
        self.unknowns = int(self.only(r"^operators: (\d+) unknowns"))

    @staticmethod
    def read_if_there(path, kinds):
        """Rows of a table that only some runs write."""
        return read_table(path, kinds) if path.exists() else []

    def only(self, pattern):
        """The one place of the output that a pattern finds."""
        found = re.findall(pattern, self.text, re.MULTILINE)
        if len(found) != 1:
            raise SystemExit(f"options {self.options}: the output should match {pattern} once, not {len(found)} times")
        return found[0]

    @property
    def basis(self):
        """Number of vectors of the basis."""
        return int(self.only(r"^basis of (\d+) vectors"))

    @property
    def sweep_seconds(self):
        """All points, without onsets and checks."""
        return self.seconds["basis"] + self.seconds["points"]

    @property
    def values(self):
        """The swept values, ascending."""
        return sorted({row["value"] for row in self.rows})

    def near(self, value):
        """Rows at a value of the sweep."""
        rows = [row for row in self.rows if math.isclose(row["value"], value, rel_tol=1e-9)]
        if not rows:
            raise SystemExit(f"options {self.options}: the sweep has no value {value:g}")
        return rows

    def within(self, low, high):
        """Rows of a window of frequencies."""
        return [row for row in self.rows if low <= row["freq_hz"] <= high]


def eigenvalues(rows):
    """sigma + i omega of rows of sweep.csv."""
    return numpy.array([complex(row["growth_rad_s"], 2 * math.pi * row["freq_hz"]) for row in rows])


def distances(of, to):
    """Relative distance of each eigenvalue of one set from the nearest of the other."""
    if not len(to):
        return numpy.full(len(of), math.inf)
    return numpy.abs(of[:, None] - to[None, :]).min(axis=1) / numpy.abs(of) if len(of) else numpy.zeros(0)


def count_without_partner(of, to):
    """Unstable eigenvalues of one set that have no unstable one of the other for themselves."""
    free = list(eigenvalues([row for row in to if row["unstable"]]))
    alone = 0
    for value in eigenvalues([row for row in of if row["unstable"]]):
        nearest = min(free, key=lambda other, value=value: abs(other - value), default=math.inf)
        if abs(nearest - value) <= PAIRED * abs(value):
            free.remove(nearest)
        else:
            alone += 1
    return alone


def compare(run, full):
    """Against a sweep in full at some of the values: largest error, and counts of unstable ones missed, of those
    invented, and of modes too many or too few."""
    error, missed, invented, modes = 0.0, 0, 0, 0
    for value in full.values:
        true, own = full.near(value), run.near(value)
        error = max(error, distances(eigenvalues(true), eigenvalues(own)).max(initial=0))
        missed += count_without_partner(true, own)
        invented += count_without_partner(own, true)
        modes += abs(len(true) - len(own))
    return error, missed, invented, modes


def require_same_sweep(first, other, tolerance):
    """Two runs of one sweep agree at every value."""
    if first.values != other.values:
        raise SystemExit(f"options {first.options}: two runs have different values")
    worst, *_, modes = compare(first, other)
    if modes or worst > tolerance:
        raise SystemExit(f"options {first.options}: two runs differ by {worst:.1e} in eigenvalues, {modes} in number")
