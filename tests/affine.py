#!/usr/bin/env python3
"""Writes the matrices of a small brake model of the form

    M q'' + (D1 + DR / w + w DG) q' + (K1 + KR + w^2 KGEO) q = 0,

masses on a ring that turns: KR circulatory (of friction), KGEO geometric, DR friction damping, DG gyroscopic.

    affine.py FOLDER [N]     writes M.bin, K1.bin, KR.bin, KGEO.bin, D1.bin, DR.bin, DG.bin with N unknowns (100)"""

import sys
from pathlib import Path

import numpy
import scipy.linalg
import scipy.sparse

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.petsc_matrix import write_matrix


def model(n=100):
    """Name -> matrix."""
    random = numpy.random.default_rng(3)
    one = scipy.sparse.identity(n, format="csr")
    ring = scipy.sparse.diags([numpy.ones(n - 1), [1]], [1, -(n - 1)], format="csr")  # the next mass
    spring = 2 * one - ring - ring.T
    turn = (ring - ring.T) / 2
    far = scipy.sparse.random(n, n, 2 / n, random_state=3, format="csr")
    return {
        "M": scipy.sparse.diags(1 + 0.02 * random.random(n)) + 0.05 * (ring + ring.T),
        "K1": scipy.sparse.diags(1 + 0.05 * random.random(n)) + 400 * spring,
        "KR": 0.22 * turn * 2 + 0.01 * (far - far.T),
        "KGEO": 0.05 * spring + 0.002 * one,
        "D1": 0.01 * one + 0.003 * spring,
        "DR": 0.06 * scipy.sparse.diags(random.random(n)),
        "DG": 0.15 * turn,
    }


def companion(matrices, w):
    """The first companion form at a speed."""
    dense = {name: matrix.toarray() for name, matrix in matrices.items()}
    M = dense["M"]
    C = dense["D1"] + dense["DR"] / w + w * dense["DG"]
    K = dense["K1"] + dense["KR"] + w**2 * dense["KGEO"]
    n = len(M)
    lu = scipy.linalg.lu_factor(M)
    return numpy.block([[numpy.zeros((n, n)), numpy.eye(n)], [-scipy.linalg.lu_solve(lu, K), -scipy.linalg.lu_solve(lu, C)]])


def eigenvalues(matrices, w):
    """All of them by LAPACK."""
    return numpy.linalg.eigvals(companion(matrices, w))


def eigenvalue_near(matrices, w, place):
    """The one nearest to a place beside which all others are far: inverse iteration with LAPACK's factors."""
    A = companion(matrices, w)
    lu = scipy.linalg.lu_factor(A - place * numpy.eye(len(A)))
    x, value = numpy.random.default_rng(5).random(len(A)) + 0j, numpy.inf
    for _ in range(40):
        x /= numpy.linalg.norm(x)
        y = scipy.linalg.lu_solve(lu, x)
        before, value, x = value, place + 1 / (x.conj() @ y), y
        if abs(value - before) < 1e-14 * abs(place):
            return value
    raise SystemExit(f"speed {w}: no eigenvalue stands alone near {place}")


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, matrix in model(int(sys.argv[2]) if len(sys.argv) > 2 else 100).items():
        write_matrix(folder / f"{name}.bin", matrix)


if __name__ == "__main__":
    main()
