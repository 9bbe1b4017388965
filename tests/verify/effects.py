#!/usr/bin/env python3
"""modes_effects.csv and its fields beside changed matrices solved again by scipy:

    effects.py RESULTS MATRICES MU [--tolerance 1e-6]

A mass, springs and dashpots at nodes, and between two, are added to the matrices of -operators_save, with either sign; the
central difference of the eigenvalue is the rate. The nodes are those of the table and some others; the rows of the table
must be the best of each part."""

import argparse
import csv
import itertools
import math
import sys
from pathlib import Path

import h5py
import numpy
import scipy.sparse
import scipy.sparse.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.mesh.petsc_matrix import read_matrix # noqa: E402
from squeal.provenance import Provenance # noqa: E402

MOVES = 1e-4  # of the eigenvalue, by a change: smaller ones drown in the rounding of the kernels of some processors
SMALL, MASS = 1e-2, 0.2  # of the stiffness of the node against the other modes: the fourth power is below the tolerance
SHIFT = 1e-6  # of the factors from the eigenvalue
NOISE = 1e-13  # of the eigenvalue, by rounding
OTHERS = 1  # further nodes of each mode
BEST = 1e-5  # of the largest rate: nodes that are alike within the table's rounding


def read(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def matrix(path):
    rows, columns, row, column, value = read_matrix(path)
    return scipy.sparse.csc_matrix((value.astype(complex), (row, column)), (rows, columns))


class Problem:
    """Q(s) = s^2 M + s C + K, with factors about one eigenvalue."""

    def __init__(self, folder, mu):
        stiffness, friction = matrix(folder / "K.bin"), matrix(folder / "H.bin")
        self.K, self.C, self.M = stiffness + mu * friction, matrix(folder / "C.bin"), matrix(folder / "M.bin")

    def about(self, value):
        self.value = value
        self.factors = scipy.sparse.linalg.splu(((value * (1 + SHIFT))**2 * self.M + value * (1 + SHIFT) * self.C + self.K).tocsc())
        start = numpy.random.default_rng(1).standard_normal(self.M.shape[0]).astype(complex)
        self.x, self.y = start, start
        for _ in range(3):
            self.x, self.y = self.factors.solve(self.x), self.factors.solve(self.y, "T")
            self.x, self.y = self.x / numpy.linalg.norm(self.x), self.y / numpy.linalg.norm(self.y)
        for _ in range(4):  # those are vectors of Q at the shift
            exact = self.value - (self.y @ self.times(self.value, self.x, None, 0, "")[0]) / (
                self.y @ self.times(self.value, self.x, None, 0, "")[1])
            self.x = self.x - self.factors.solve(self.times(exact, self.x, None, 0, "")[0])
            transposed = exact * (exact * (self.M.T @ self.y) + self.C.T @ self.y) + self.K.T @ self.y
            self.y = self.y - self.factors.solve(transposed, "T")
        return exact

    def times(self, s, x, unit, change, kind):
        """Q(s) x and Q'(s) x of the changed system: the change is along a vector, or of all three directions of a mass."""
        q, slope = s * (s * (self.M @ x) + self.C @ x) + self.K @ x, 2 * s * (self.M @ x) + self.C @ x
        if unit is not None:
            power = {"mass": 2, "dashpot": 1, "spring": 0}[kind]
            along = unit @ (unit.T @ x) * change
            q, slope = q + s**power * along, slope + power * s**max(power - 1, 0) * along
        return q, slope

    def solve(self, unit, change, kind=""):
        """The eigenvalue near that of the factors, by residual inverse iteration with the Rayleigh functional of y."""
        s, x = self.value, self.x
        for _ in range(12):
            for _ in range(2):
                q, slope = self.times(s, x, unit, change, kind)
                s -= (self.y @ q) / (self.y @ slope)
            step = self.factors.solve(self.times(s, x, unit, change, kind)[0])
            x = x - step
            if numpy.linalg.norm(step) < 1e-11 * numpy.linalg.norm(x):
                break
        return s

    def rate(self, unit, kind):
        """By central differences, less their error of second order, with a change that moves the eigenvalue by at most MOVES of it."""
        power = {"mass": 2, "dashpot": 1, "spring": 0}[kind]
        most = numpy.linalg.norm(unit.T @ self.x) * numpy.linalg.norm(unit.T @ self.y) * abs(self.value)**power
        slope = self.y @ self.times(self.value, self.x, None, 0, kind)[1]
        at_shift = numpy.array([self.factors.solve(column.astype(complex)) for column in unit.T])
        own = numpy.outer(unit.T @ self.x, unit.T @ self.y) / (slope * self.value * SHIFT)
        compliance = abs(at_shift @ unit - own).max() * abs(self.value)**power
        size = min(MOVES * abs(self.value) * abs(slope) / most, (MASS if kind == "mass" else SMALL) / compliance)
        noise = NOISE * abs(self.value) / size
        half, whole = ((self.solve(unit, h, kind) - self.solve(unit, -h, kind)) / (2 * h) for h in (size / 2, size))
        return (4 * half - whole) / 3, noise


def fields(path, mode):
    """Names of the kinds -> rates at the nodes, of a mode."""
    names = {"mass": "kg", "spring": "N_m", "dashpot": "N_s_m"}
    with h5py.File(path) as file:
        return {kind: file[f"VTKHDF/PointData/mode_{mode:03d}_growth_rad_s_per_{unit}"][()] for kind, unit in names.items()}


def nodes_of(path):
    """Places of the nodes, and which parts have them, [parts][nodes]: bodies in contact have nodes at one place."""
    with h5py.File(path) as file:
        grid = file["VTKHDF"]
        part = numpy.repeat(grid["CellData/part"][()], numpy.diff(grid["Offsets"][()]))
        of = numpy.zeros((part.max() + 1, len(grid["Points"])), bool)
        of[part, grid["Connectivity"][()]] = True
        return grid["Points"][()], of


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path)
    parser.add_argument("matrices", type=Path)
    parser.add_argument("mu", type=float)
    parser.add_argument("--tolerance", type=float, default=1e-6)
    args = parser.parse_args()
    (places, of), rows = nodes_of(args.results / "modes_effects.h5"), read(args.results / "modes_effects.csv")
    parts = Provenance(args.results / "scene.yaml").names("parts")
    values = {int(row["mode"]): complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
              for row in read(args.results / "modes.csv") if row["unstable"] == "1"}
    problem, worst, count = Problem(args.matrices, args.mu), 0, 0
    if not values or {int(row["mode"]) for row in rows} != set(values):
        sys.exit("the table must have the unstable modes")
    with h5py.File(args.results / "modes.h5") as file:
        free = numpy.flatnonzero(sum(abs(shape[()]).reshape(-1) for name, shape in file["VTKHDF/PointData"].items()
                                  if name[-3:] in ("_re", "_im")) > 0)
    number = numpy.full(3 * len(places), -1)
    number[free] = numpy.arange(len(free))
    for mode, value in values.items():
        exact = problem.about(value)
        if len(free) != problem.M.shape[0] or abs(exact - value) > 1e-7 * abs(value):
            sys.exit(f"mode {mode}: {value}, of the matrices {exact}, {len(free)} unknowns of {problem.M.shape[0]}")
        rates = fields(args.results / "modes_effects.h5", mode)

        def difference(ends, kind, direction):
            """Rate by the central difference, of a node alone or with another end."""
            axes = numpy.eye(3) if kind == "mass" else numpy.array([direction]).T
            unit = numpy.zeros((len(free), axes.shape[1]))
            for (sign, node), a in itertools.product(zip((1, -1), ends), range(3)):
                if number[3 * node + a] >= 0:
                    unit[number[3 * node + a]] += sign * axes[a]
            return problem.rate(unit, kind)

        def node_at(row, to):
            """The node of a part at a place."""
            at = [float(row[f"{to}{x}_m"]) for x in "xyz"]
            return int(numpy.argmin(((places - at)**2).sum(1) + ~of[parts.index(row[f"{to}part"])]))

        for row in rows:
            if int(row["mode"]) != mode:
                continue
            kind = row["change"].removeprefix("relative_")
            if (kind != row["change"]) != bool(row["to_part"]):
                sys.exit(f"{row}: its other end")
            direction = numpy.array([float(row[f"direction_{x}"]) for x in "xyz"])
            ends = [node_at(row, to) for to in ("", "to_")[:1 + (kind != row["change"])]]
            guess = complex(float(row["growth_rad_s_per_unit"]), 2 * math.pi * float(row["freq_hz_per_unit"]))
            found, noise = difference(ends, kind, direction)
            off = (abs(found - guess) - noise) / abs(guess)
            worst, count = max(worst, off), count + 1
        for kind, rate in rates.items():
            width = 1 if rate.ndim == 1 or rate.shape[1] == 1 else 3
            rate = rate.reshape(len(places), width)
            scale = abs(rate).max()
            best = min(float(row["growth_rad_s_per_unit"]) for row in rows if int(row["mode"]) == mode and row["change"] == kind)
            if best > rate.min() + BEST * scale:
                sys.exit(f"mode {mode}, {kind}: {best} is not the best, {rate.min()} of the field is")
            for node in numpy.random.default_rng(mode).choice(len(places), OTHERS, replace=False):
                for axis in range(width):
                    guess = max(abs(rate[node, axis]), 1e-3 * scale)
                    found, noise = difference([node], kind, numpy.eye(3)[axis])
                    worst, count = max(worst, (abs(found.real - rate[node, axis]) - noise) / guess), count + 1
    print(f"{count} rates, off by {worst:.1e} at most")
    if not worst <= args.tolerance:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
