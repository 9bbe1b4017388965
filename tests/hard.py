#!/usr/bin/env python3
"""Writes pencils whose eigenvalues are known exactly: K + mu H = Q B Q', M = I or Q D Q', with Q a Hadamard matrix over a power of two, so
that no entry is rounded, and C = M / 4.

    hard.py FOLDER    folders defective, three, doublets, equal, stiff, each with K.bin, M.bin, H.bin, and exact.csv of growth_rad_s,
                      omega_rad_s of those eigenvalues that oscillate

defective  lock-in at mu = 16: kappa = 4096 -+ 16 meet, one eigenvector
three      kappa = 4096 three times, one eigenvector
doublets   two doublets, 4096 -+ 16, locked in with each other at mu = 32: kappa = 4096 -+ 16 i sqrt(3), each twice
equal      200 eigenvalues kappa = 4096
stiff      kappa from 4 to 4^20, stiffness ratio 2.7e11"""

import cmath
import csv
import sys
from pathlib import Path

import numpy
import scipy.linalg
import scipy.sparse

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.petsc_matrix import write_matrix

K0, D = 4096, 16


def far(n):
    """Other eigenvalues, above and far from those at 4096."""
    return [16384.0 + 1024 * i for i in range(n)]


def pencils():
    """Name: diagonal of B without friction, its entries with friction (place: value), and the eigenvalues kappa at `mu`."""
    root = D * cmath.sqrt(-3)
    yield ("defective", [K0 - D, K0 + D, *far(62)], {(0, 1): 1, (1, 0): -1}, [K0, K0, *far(62)])
    yield "three", [K0, K0, K0, *far(61)], {(0, 1): 1, (1, 2): 1}, [K0, K0, K0, *far(61)]
    yield ("doublets", [K0 - D, K0 - D, K0 + D, K0 + D, *far(60)], {(0, 2): 1, (2, 0): -1, (1, 3): 1, (3, 1): -1},
           [K0 + root, K0 - root, K0 + root, K0 - root, *far(60)])
    yield "equal", [K0] * 200 + far(56), {}, [K0] * 200 + far(56)
    values = [4.0**(1 + i % 20) for i in range(64)]
    yield "stiff", values, {}, values


def main():
    for name, diagonal, friction, kappa in pencils():
        folder, n = Path(sys.argv[1]) / name, len(diagonal)
        folder.mkdir()
        Q = scipy.linalg.hadamard(n) / numpy.sqrt(n)
        N = numpy.zeros((n, n))
        for place, value in friction.items():
            N[place] = value
        for file, matrix in (("K", Q @ numpy.diag(diagonal) @ Q.T), ("M", numpy.eye(n)), ("H", Q @ N @ Q.T), ("C", numpy.eye(n) / 4)):
            write_matrix(folder / f"{file}.bin", scipy.sparse.csr_matrix(matrix))
        with (folder / "exact.csv").open("w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["growth_rad_s", "omega_rad_s"])
            for value in kappa:  # lambda = i sqrt(kappa), the one above the real axis
                root = 1j * cmath.sqrt(value)
                table.writerow([repr(root.real), repr(root.imag)])


if __name__ == "__main__":
    main()
