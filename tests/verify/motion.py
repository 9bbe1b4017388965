#!/usr/bin/env python3
"""Displacements of two bars in a row, 100 mm each, whose far end is moved by d while the other is held: with Poisson's ratio 0
and moduli E_l, E_r the force is one, so that the left bar takes the share E_r / (E_l + E_r) of d, linear along each.

    verify/motion.py FOLDER E_LEFT E_RIGHT D        output folder of tests/cases/static_motions.toml, Pa, m
"""

import sys
from pathlib import Path

import h5py
import numpy

LENGTH, RTOL = 0.1, 1e-10


def main():
    folder, left, right, d = Path(sys.argv[1]), *map(float, sys.argv[2:])
    with h5py.File(folder / "static.h5") as file:
        x, u = file["VTKHDF/Points"][:], file["VTKHDF/PointData/displacement_m"][:]
    between = d * right / (left + right)
    expected = numpy.interp(x[:, 0], [-LENGTH, 0, LENGTH], [0, between, d])
    error = numpy.abs(u - numpy.outer(expected, [1, 0, 0])).max() / abs(d)
    print(f"{len(x)} nodes, largest displacement {numpy.abs(u).max():.6g} m, largest error {error:.2g} of {d:g} m")
    sys.exit(0 if len(x) and error <= RTOL else 1)


main()
