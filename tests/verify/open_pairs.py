#!/usr/bin/env python3
"""Frictionless pairs on a held base against non-negative least squares on exported matrices.

    open_pairs.py FOLDER SAVED STIFFER GAP CROWN

static.csv of FOLDER; SAVED has K.bin and F.bin with kn_per_area 1e12 N/m^3 and all pairs closed, STIFFER K.bin with 2e12, whose
difference tells the slaves' normal unknowns. Gaps of the mesh are GAP + CROWN (2 y / 100 mm)^2, m. The bodies are condensed to the
gaps g: forces S (g - g0) - f >= 0, g >= 0 and one of both zero are the conditions of the least 1/2 (g - g0)'S (g - g0) - f'g, which
with S = L L' is the non-negative least squares problem of L'g = L'g0 + L^-1 f. It needs springs that hold the body without contact.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls

from dense import matrix
from pressure import STIFFNESS, read, vector

TOLERANCE = 1e-10  # of forces, of gaps, of areas, beside the largest


def require(what, found, expected):
    worst = np.max(np.abs(found - expected)) / np.max(np.abs(expected))
    print(f"{what}: worst difference {worst:.2g}, allowed {TOLERANCE:g}")
    if not worst <= TOLERANCE:
        raise SystemExit(1)


def main():
    folder, saved, stiffer = (Path(name) for name in sys.argv[1:4])
    gap, crown = (float(number) for number in sys.argv[4:])
    K, F = matrix(saved / "K.bin"), vector(saved / "F.bin")
    normal = matrix(stiffer / "K.bin") - K
    slave = np.diag(normal) > 1e-9 * np.diag(normal).max()
    bodies, pairs = K - normal, read(folder)
    with (folder / "static.csv").open(newline="") as file:
        x, y = np.array([[float(row["x_m"]), float(row["y_m"])] for row in csv.DictReader(file)]).T
    order = np.lexsort([x.round(6), y.round(6)])  # of the mesh, which unknowns have too
    pairs = {name: column[order] for name, column in pairs.items()}
    require("areas", pairs["area_m2"], np.diag(normal)[slave] / STIFFNESS)
    g0 = gap + crown * (2 * y[order] / 0.1)**2
    inner = np.linalg.solve(bodies[np.ix_(~slave, ~slave)], np.column_stack([bodies[np.ix_(~slave, slave)], F[~slave]]))
    outer = bodies[np.ix_(slave, ~slave)] @ inner
    S, f = bodies[np.ix_(slave, slave)] - outer[:, :-1], F[slave] - outer[:, -1]
    L = cholesky((S + S.T) / 2, lower=True)
    g, _ = nnls(L.T, L.T @ g0 + solve_triangular(L, f, lower=True))
    forces = S @ (g - g0) - f
    print(f"{np.sum(g == 0)} of {len(g)} pairs press")
    require("forces", pairs["lambda_n_n"], forces)
    require("gaps", pairs["gap_m"], g)


if __name__ == "__main__":
    main()
