#!/usr/bin/env python3
"""Writes K.bin, M.bin and C.bin (PETSc binary) of the problem damped_beam of NLEVP (T. Betcke, N. J. Higham, V. Mehrmann, C. Schroeder,
F. Tisseur, ACM Trans. Math. Softw. 39, 2013), from N. J. Higham, D. S. Mackey, F. Tisseur, S. D. Garvey (Int. J. Numer. Meth. Engng 73,
2008).

    damped_beam.py [--elements 100] [--damper 5] FOLDER

A beam of 1 m x 50 mm x 5 mm, 0.674 kg, 70 GPa, simply supported, in cubic elements with displacement and rotation at each node, and
a damper (N s/m) in its middle."""

import argparse
import struct
from pathlib import Path

import numpy as np

LENGTH, WIDTH, HEIGHT, MASS, YOUNG = 1, 0.05, 0.005, 0.674, 7e10


def element(length):
    """Stiffness and mass of a cubic element."""
    s, bending = length, YOUNG * WIDTH * HEIGHT**3 / 12
    size = np.outer([1, s, 1, s], [1, s, 1, s])
    stiffness = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
    mass = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    return bending / s**3 * size * stiffness, MASS / LENGTH * s / 420 * size * mass


def matrices(elements, damper):
    k, m, c = np.zeros((3, 2 * elements + 2, 2 * elements + 2))
    ke, me = element(LENGTH / elements)
    for first in range(0, 2 * elements, 2):
        k[first:first + 4, first:first + 4] += ke
        m[first:first + 4, first:first + 4] += me
    c[elements, elements] = damper
    free = np.delete(np.arange(2 * elements + 2), [0, 2 * elements])
    return [a[np.ix_(free, free)] for a in (k, m, c)]


def write(a, path):
    rows, columns = np.nonzero(a)
    counts = np.bincount(rows, minlength=len(a))
    head = struct.pack(">4i", 1211216, *a.shape, len(rows))
    path.write_bytes(head + counts.astype(">i4").tobytes() + columns.astype(">i4").tobytes()
                     + a[rows, columns].astype(">f8").tobytes())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", type=int, default=100)
    parser.add_argument("--damper", type=float, default=5)
    parser.add_argument("folder", type=Path)
    arguments = parser.parse_args()
    arguments.folder.mkdir(exist_ok=True)
    for name, full in zip("KMC", matrices(arguments.elements, arguments.damper)):
        write(full, arguments.folder / f"{name}.bin")
