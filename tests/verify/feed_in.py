#!/usr/bin/env python3
"""modes_feed_in.csv and its field, where friction feeds a mode, beside numbers from shapes and matrices alone:

    feed_in.py RESULTS [--matrices FOLDER MU] [--pairs KN MU SLOPE FORCE SPEED] [--limit OTHER TOL]

Always: the pairs of a contact add up to power_w of modes_causes.csv, 2 E growth; the field has the same at the slave nodes and nothing
elsewhere. MATRICES: energy and friction by the matrices of -operators_save. PAIRS: each pair by the shape at its two nodes, for a pad
on a disc with z along the normal and y along the slip. LIMIT: exact contact beside a stiff penalty."""

import argparse
import csv
import math
import sys
from collections import defaultdict
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.mesh.petsc_matrix import read_matrix # noqa: E402

KINDS = {"friction": "friction_w", "friction damping": "friction_damping_w", "falling friction": "falling_friction_w"}
SUMS = 1e-10  # of the power of a contact
MATRICES = 1e-9  # of the largest pair's or contact's power: shapes are written with all digits


def read(folder, name):
    with (folder / name).open(newline="") as table:
        return list(csv.DictReader(table))


def near(what, found, expected, tolerance, scale=None):
    off = abs(found - expected) / (abs(expected) if scale is None else scale)
    if not off <= tolerance:
        sys.exit(f"{what}: {found}, must be {expected}, off by {off:.1e}")
    return off


def check_sums(rows, causes):
    """Over the pairs of each contact, by kind."""
    sums, count = defaultdict(float), 0
    for row in rows:
        for kind, column in KINDS.items():
            sums[row["mode"], row["contact"], kind] += float(row[column])
    for row in causes:
        key = row["mode"], row["cause"], row["kind"]
        if key in sums:
            near(f"sum of the pairs {key}", sums.pop(key), float(row["power_w"]), SUMS)
            count += 1
    if not count or any(sums.values()):
        sys.exit(f"{count} causes have pairs, without a cause {dict(sums)}")


class Shapes:
    """Shapes, frequencies and densities of a modes.h5, with its nodes."""

    def __init__(self, folder):
        with h5py.File(folder / "modes.h5") as file:
            grid = file["VTKHDF"]
            self.places, data = grid["Points"][()], grid["PointData"]
            self.x = {int(key[5:8]): data[key][()] + 1j * data[key[:-2] + "im"][()] for key in data if key.endswith("_re")}
            self.density = {int(key[5:8]): data[key][()] for key in data if key.endswith("_feed_in_w_m2")}
            part = numpy.repeat(grid["CellData/part"][()], numpy.diff(grid["Offsets"][()]))
            self.of_pad = numpy.zeros(len(self.places), bool)
            self.of_pad[grid["Connectivity"][()][part == 1]] = True
        free = sum(abs(shape) for shape in self.x.values()).ravel() > 0
        self.unknown = numpy.flatnonzero(free)

    def at(self, place, of_pad):
        return int(numpy.argmin(((self.places - place)**2).sum(1) + (self.of_pad != of_pad)))


def check_field(shapes, rows):
    """All of a mode's field: the table's density at the slaves, zero at all other nodes."""
    if set(shapes.density) != set(shapes.x):
        sys.exit("every mode must have a field")
    for mode in {row["mode"] for row in rows}:
        own, field = [row for row in rows if row["mode"] == mode], shapes.density[int(mode)].copy()
        scale = abs(field).max()
        for row in own:
            node = shapes.at([float(row[f"{a}_m"]) for a in "xyz"], True)
            near(f"field of mode {mode}", field[node], float(row["power_w_m2"]), 1e-12, scale)
            near("density", float(row["power_w_m2"]), sum(float(row[c]) for c in KINDS.values()) / float(row["area_m2"]), 1e-12, scale)
            field[node] = 0
        if field.any():
            sys.exit(f"mode {mode}: the field has more than the pairs")


def check_matrices(shapes, causes, values, folder, mu):
    """Energy, and friction of the whole contact."""
    def matrix(name):
        rows, columns, row, column, value = read_matrix(folder / f"{name}.bin")
        dense = numpy.zeros((rows, columns))
        numpy.add.at(dense, (row, column), value)
        return dense

    M, C, H = (matrix(name) for name in "MCH")
    for mode, shape in shapes.x.items():
        x, omega = shape.ravel()[shapes.unknown], values[mode].imag
        near(f"norm of mode {mode}", (x.conj() @ (M @ x)).real, 1, MATRICES)
        energy = omega * (2 * omega * (x.conj() @ (M @ x)).real + (x.conj() @ (C @ x)).imag) / 4
        friction = -omega / 2 * mu * (x.conj() @ (H @ x)).imag
        own = [row for row in causes if int(row["mode"]) == mode]
        largest = max(abs(float(row["power_w"])) for row in own)
        for row in own:
            near(f"power of mode {mode}", float(row["power_w"]), 2 * energy * float(row["growth_rad_s"]), MATRICES, largest)
            if row["kind"] == "friction":
                near(f"friction of mode {mode}", float(row["power_w"]), friction, MATRICES, largest)


def check_pairs(shapes, rows, values, kn, mu, slope, force, speed):
    """Pair by pair: friction mu k_n on the closing of the gap, damping by the normal force, which the area shares out."""
    area = sum(float(row["area_m2"]) for row in rows if row["mode"] == rows[0]["mode"])
    largest = max(abs(float(row[column])) for row in rows for column in KINDS.values())
    for row in rows:
        x, omega, place = shapes.x[int(row["mode"])], values[int(row["mode"])].imag, [float(row[f"{a}_m"]) for a in "xyz"]
        across, along, gap = x[shapes.at(place, False)] - x[shapes.at(place, True)]  # master less slave
        normal = force * float(row["area_m2"]) / area
        expected = {"friction_w": omega / 2 * mu * kn * (along.conjugate() * gap).imag,
                    "friction_damping_w": -omega**2 / 2 * mu * normal / speed * abs(across)**2,
                    "falling_friction_w": -omega**2 / 2 * slope * normal * abs(along)**2}
        for column, power in expected.items():
            near(f"{column} of {row}", float(row[column]), power, MATRICES, largest)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path)
    parser.add_argument("--matrices", nargs=2)
    parser.add_argument("--pairs", nargs=5, type=float)
    parser.add_argument("--limit", nargs=2)
    args = parser.parse_args()
    rows, causes = read(args.results, "modes_feed_in.csv"), read(args.results, "modes_causes.csv")
    values = {int(row["mode"]): complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
              for row in read(args.results, "modes.csv")}
    check_sums(rows, causes)
    shapes = Shapes(args.results)
    check_field(shapes, rows)
    if args.matrices:
        check_matrices(shapes, causes, values, Path(args.matrices[0]), float(args.matrices[1]))
    if args.pairs:
        check_pairs(shapes, rows, values, *args.pairs)
    if args.limit:
        others = {(row["mode"], row["pair"]): row for row in read(Path(args.limit[0]), "modes_feed_in.csv")}
        largest = max(abs(float(row[column])) for row in rows for column in KINDS.values())
        if set(others) != {(row["mode"], row["pair"]) for row in rows}:
            sys.exit("both must have the same pairs")
        worst = max(near(f"{column} of {row}", float(row[column]), float(others[row["mode"], row["pair"]][column]), float(args.limit[1]),
                         largest) for row in rows for column in KINDS.values())
        print(f"worst {worst:.1e} of the largest")
    print(f"{len(rows)} pairs of modes")


if __name__ == "__main__":
    main()
