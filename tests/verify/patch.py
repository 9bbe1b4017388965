#!/usr/bin/env python3
"""Patch test of a mesh on the matrices of a free body: K.bin and M.bin of -operators_save, nodes from modes.h5.

    verify/patch.py FOLDER DENSITY VOLUME      kg/m^3, m^3

For each of nine displacement gradients G, u = G x is exact: K u must vanish at all nodes inside (on no side of the box of
the nodes), and everywhere where G is a rotation, as it must for translations. The energy u'Ku / 2 of a strain must be
that of the uniform stress, and the mass t'M t that of the volume. To 1e-10 of the largest force, energy and mass.
"""

import itertools
import sys
from pathlib import Path

import h5py
import numpy as np

YOUNG, POISSON = 210e9, 0.3
TOLERANCE = 1e-10


class Matrix:
    """PETSc's binary format: big-endian class, rows, columns, entries; entries of each row, columns, values."""

    def __init__(self, path):
        raw = path.read_bytes()
        _, self.rows, _, n = np.frombuffer(raw, ">i4", 4)
        counts = np.frombuffer(raw, ">i4", self.rows, 16)
        self.row = np.repeat(np.arange(self.rows), counts)
        self.column = np.frombuffer(raw, ">i4", n, 16 + 4 * self.rows)
        self.value = np.frombuffer(raw, ">f8", n, 16 + 4 * (self.rows + n)).astype(float)

    def __matmul__(self, x):
        return np.bincount(self.row, self.value * x[self.column], self.rows)


def read_nodes(path):
    with h5py.File(path) as file:
        return file["VTKHDF/Points"][:]


def energy(gradient, volume):
    """u'Ku of u = G x."""
    shear = YOUNG / (2 * (1 + POISSON))
    first = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    strain = (gradient + gradient.T) / 2
    return volume * (first * np.trace(strain)**2 + 2 * shear * (strain**2).sum())


def main(folder, density, volume):
    stiffness, mass = (Matrix(Path(folder) / f"{name}.bin") for name in "KM")
    x = read_nodes(Path(folder) / "modes.h5")
    on_box = ((x == x.min(0)) | (x == x.max(0))).any(1)
    failed = []

    def check(what, error):
        print(f"{what:50s} {error:.3g}")
        if not error <= TOLERANCE:
            failed.append(what)

    check("unknowns: three per node", abs(int(stiffness.rows) - 3 * len(x)))
    size = abs(stiffness.value).max() * abs(x).max()
    for i, j in itertools.product(range(3), repeat=2):
        gradient = np.zeros((3, 3))
        gradient[i, j] = 1
        force = (stiffness @ (x @ gradient.T).ravel()).reshape(-1, 3)
        check(f"forces inside of du_{'xyz'[i]}/d{'xyz'[j]}", abs(force[~on_box]).max(initial=0) / size)
        exact = energy(gradient, volume)
        check("  energy", abs((x @ gradient.T * force).sum() / exact - 1))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        turn = np.zeros((3, 3))
        turn[i, j], turn[j, i] = 1, -1
        check("forces of a rotation", abs(stiffness @ (x @ turn.T).ravel()).max() / size)
    for d in range(3):
        one = np.zeros_like(x)
        one[:, d] = 1
        check("forces of a translation", abs(stiffness @ one.ravel()).max() / size)
        check("mass", abs(one.ravel() @ (mass @ one.ravel()) / (density * volume) - 1))
    sys.exit(f"patch test failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]))
