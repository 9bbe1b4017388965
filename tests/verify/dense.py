#!/usr/bin/env python3
"""All modes of a run against the eigenvalues of its own matrices by LAPACK's dense QR iteration, which shares nothing with
the sparse solvers: verify/dense.py RUN MU RTOL [TOP]. RUN has modes.csv and, of -operators_save, K.bin, M.bin and, with friction,
H.bin; without damping (K + MU H) x = omega^2 M x, whose 1 / (omega^2 - s) are the eigenvalues of (K + MU H - s M)^-1 M, s < 0 since rigid
motions may make K singular. With damping, where C.bin is there and TOP (Hz) is the band's upper end, Q(lambda) x =
(lambda^2 M + lambda C + K + MU H) x = 0, whose mu = 1 / (lambda - s) are those of mu^2 Q(s) + mu Q'(s) + M; all modes
with growth or decay below a tenth of TOP's angular frequency must be there. Frequencies and growth
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


def damped(stiffness, damping, mass, top):
    """Eigenvalues of the quadratic problem, shifted and inverted about a real s, from 1 Hz to the top."""
    s = 2 * np.pi * top
    derivative = (2 * s * mass + damping) / s
    inverse = np.linalg.inv(stiffness + s * damping + s**2 * mass)
    n = len(mass)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-s**2 * inverse @ mass, -s**2 * inverse @ derivative]])
    found = s + s / np.linalg.eigvals(companion)
    return found[(found.imag > 2 * np.pi) & (found.imag <= s)]


def judge(modes, found, must, tolerance):
    """Each mode against its own nearest eigenvalue; what must be there and is not ends it."""
    worst, left = 0, list(found)
    for mode in modes:
        nearest = min(range(len(left)), key=lambda i: abs(left[i] - mode))
        worst = max(worst, abs(left.pop(nearest) - mode) / abs(mode))
    missing = sum(must(value) for value in left)
    print(f"{len(modes)} modes, {missing} missing: worst difference {worst:.2g}, allowed {tolerance:g}")
    if missing or worst > tolerance or not len(modes):
        raise SystemExit(1)


def main():
    folder, mu, tolerance = Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    stiffness = matrix(folder / "K.bin")
    if (folder / "H.bin").exists():
        stiffness = stiffness + mu * matrix(folder / "H.bin")
    mass = matrix(folder / "M.bin")
    if len(sys.argv) > 4:
        top = float(sys.argv[4])
        with (folder / "modes.csv").open(newline="") as file:
            rows = [row for row in csv.DictReader(file) if float(row["freq_hz"]) > 1]
        modes = [float(row["growth_rad_s"]) + 2j * np.pi * float(row["freq_hz"]) for row in rows]
        found = damped(stiffness, matrix(folder / "C.bin"), mass, top)
        judge(modes, found, lambda value: abs(value.real) < 0.1 * 2 * np.pi * top, tolerance)
        return
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
