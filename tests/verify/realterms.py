#!/usr/bin/env python3
"""Real modes of matrices of -terms against scipy:

    realterms.py write FOLDER                              random M.bin, K.bin, F.bin (unsymmetric), D.bin of 24 unknowns
    realterms.py check RUN N symmetrised|frictionless      sweep.csv of -sweep_method real over w, where K + w F, D, M are the terms

The N real modes of (K + w F), made symmetric, or of K alone span V; the eigenvalues of the table are all those of
V' (s^2 M + s D + K + w F) V."""

import csv
import math
import sys
from pathlib import Path

import numpy
import scipy.linalg
import scipy.sparse

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.mesh.petsc_matrix import write_matrix # noqa: E402

SAME = 1e-12  # of the largest eigenvalue


def model(n=24):
    """Name -> matrix: a chain with random stiffness, coupled at random without symmetry."""
    random = numpy.random.default_rng(8)
    square, any_pair = random.standard_normal((n, n)), random.standard_normal((n, n))
    return {"M": numpy.diag(1 + random.random(n)), "K": square @ square.T + 20 * numpy.eye(n), "F": 3 * any_pair,
            "D": 0.01 * (square + square.T) + 0.2 * numpy.eye(n)}


def projected(w, n, symmetrised):
    """Eigenvalues of positive frequency, rad/s."""
    M, K, F, D = model().values()
    whole = K + w * F
    V = scipy.linalg.eigh((whole + whole.T) / 2 if symmetrised else K, M)[1][:, :n]
    m, d, k = (V.T @ A @ V for A in (M, D, whole))
    inverse = numpy.linalg.inv(m)
    values = numpy.linalg.eigvals(numpy.block([[numpy.zeros((n, n)), numpy.eye(n)], [-inverse @ k, -inverse @ d]]))
    return values[values.imag > 0]


def main():
    if sys.argv[1] == "write":
        Path(sys.argv[2]).mkdir(parents=True, exist_ok=True)
        for name, matrix in model().items():
            write_matrix(Path(sys.argv[2]) / f"{name}.bin", scipy.sparse.csr_matrix(matrix))
        return
    _, _, run, n, kind = sys.argv
    with (Path(run) / "sweep.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    worst = 0
    for w in sorted({float(row["value"]) for row in rows}):
        found = [complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in rows if float(row["value"]) == w]
        exact = projected(w, int(n), kind == "symmetrised")
        if len(found) != len(exact):
            sys.exit(f"w {w}: {len(found)} eigenvalues, must be {len(exact)}")
        worst = max(worst, max(abs(exact - value).min() for value in found) / abs(exact).max(),
                    max(min(abs(value - numpy.array(found))) for value in exact) / abs(exact).max())
    print(f"{len(rows)} eigenvalues, worst {worst:.1e} of the largest")
    if not worst <= SAME:
        sys.exit(1)


if __name__ == "__main__":
    main()
