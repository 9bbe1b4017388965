#!/usr/bin/env python3
"""All modes of a run against the eigenvalues of its own matrices by LAPACK's dense QR iteration, which shares nothing with
the sparse solvers: verify/dense.py RUN MU RTOL. RUN has modes.csv and, of -operators_save, K.bin, M.bin and H.bin; without
damping (K + MU H) x = omega^2 M x, whose 1 / (omega^2 - s) are the eigenvalues of (K + MU H - s M)^-1 M, s < 0 since rigid
motions may make K singular. Frequencies and growth
rates of modes above 1 Hz must agree within RTOL of the frequency, one to one."""

import csv
import sys
from pathlib import Path

import numpy as np

MAT = 1211216  # first word of a PETSc matrix; all big-endian: rows, columns, nonzeros, row lengths, columns, values
SHIFT = -(2 * np.pi * 1000) ** 2  # (rad/s)^2


def matrix(path):
    data = path.read_bytes()
    head = np.frombuffer(data, ">i4", 4)
    assert head[0] == MAT, path
    rows, columns, nonzeros = (int(number) for number in head[1:])
    lengths = np.frombuffer(data, ">i4", rows, 16)
    at = 16 + 4 * rows
    column = np.frombuffer(data, ">i4", nonzeros, at)
    full = np.zeros((rows, columns))
    full[np.repeat(np.arange(rows), lengths), column] = np.frombuffer(data, ">f8", nonzeros, at + 4 * nonzeros)
    return full


def main():
    folder, mu, tolerance = Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    stiffness = matrix(folder / "K.bin") + mu * matrix(folder / "H.bin")
    mass = matrix(folder / "M.bin")
    found = 1j * np.sqrt(SHIFT + 1 / np.linalg.eigvals(np.linalg.solve(stiffness - SHIFT * mass, mass)) + 0j)
    found = np.concatenate([found, -found])
    with (folder / "modes.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if float(row["freq_hz"]) > 1]
    modes = np.array([float(row["growth_rad_s"]) + 2j * np.pi * float(row["freq_hz"]) for row in rows])
    top = modes.imag.max() * (1 + tolerance)
    found = found[(found.imag > 2 * np.pi) & (found.imag <= top)]
    if len(found) != len(modes):
        raise SystemExit(f"{len(modes)} modes, but {len(found)} eigenvalues below {top / 2 / np.pi:g} Hz")
    worst, left = 0, list(found)
    for mode in modes:
        nearest = min(range(len(left)), key=lambda i: abs(left[i] - mode))
        worst = max(worst, abs(left.pop(nearest) - mode) / mode.imag)
    unstable = modes.real.max()
    print(f"{len(modes)} modes, largest growth {unstable:.9g} 1/s: worst difference {worst:.2g}, allowed {tolerance:g}")
    if worst > tolerance:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
