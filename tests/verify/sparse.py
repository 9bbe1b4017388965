#!/usr/bin/env python3
"""Eigenvalues next to a frequency of a run's own matrices by SciPy (SuperLU, ARPACK), for meshes that are too fine for dense.py:

    tests/verify/sparse.py RUN MU FREQUENCY_HZ

RUN has, of -operators_save, K.bin, M.bin and H.bin. No test runs it, since its meshes take long; the
numbers that a case has from it say so."""

import sys
from pathlib import Path

import numpy as np
import scipy.sparse.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.modes.exact import sparse

BESIDE = 1.02  # the shift beside the frequency, squared
COUNT = 6


def main():
    folder, mu, frequency = Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    shift = BESIDE * (2 * np.pi * frequency) ** 2
    mass = sparse(folder / "M.bin").tocsc()
    factors = scipy.sparse.linalg.splu((sparse(folder / "K.bin") + mu * sparse(folder / "H.bin") - shift * mass).tocsc(),
                                       permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    inverse = scipy.sparse.linalg.LinearOperator(mass.shape, matvec=lambda x: factors.solve(mass @ x))
    found = shift + 1 / scipy.sparse.linalg.eigs(inverse, k=COUNT, return_eigenvectors=False, tol=1e-13)
    values = 1j * np.sqrt(found + 0j)
    for value in sorted(np.where(values.imag < 0, -values, values), key=lambda value: value.imag):
        print(f"{value.imag / 2 / np.pi:.9f} Hz {value.real:.9f} 1/s")


if __name__ == "__main__":
    main()
