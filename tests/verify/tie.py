#!/usr/bin/env python3
"""Frequencies of two boxes that a tie joins, from the matrices of the boxes apart.

    verify/tie.py APART MODES TOLERANCE SLAVE MASTER

APART has K.bin and M.bin of -operators_save and the nodes in modes.h5, of free boxes on one rank; SLAVE and MASTER are
"z/x0,y0,x1,y1/nx,ny", the planes that touch, or with a gap, z in m, with the corners and the numbers of cells of their even grids of
hexahedra of first order. u_s = sum w_i u_i + omega x g is put together here anew: w bilinear on the grid, omega the turning of the
surface, (u_z,y; -u_z,x; (u_y,x - u_x,y) / 2) by differences of the same bilinear functions. Then the eigenvalues of
T'K T x = kappa T'M T x by LAPACK beside those of the table.
"""

import csv
import sys
from pathlib import Path

import h5py
import numpy as np
import scipy.linalg

from patch import Matrix


def grid(text):
    z, corners, counts = text.split("/")
    x0, y0, x1, y1 = map(float, corners.split(","))
    return float(z), np.array([x0, y0]), np.array([x1, y1]), np.array([int(n) for n in counts.split(",")])


def dense(path):
    read = Matrix(path)
    full = np.zeros((read.rows, read.rows))
    full[read.row, read.column] = read.value
    return full


def on_plane(x, boxes, plane):
    """Nodes of a box on a plane."""
    z, low, high, _ = plane
    return [i for i in boxes if abs(x[i, 2] - z) < 1e-9 and (x[i, :2] > low - 1e-9).all() and (x[i, :2] < high + 1e-9).all()]


def row(place, master, node_at, n):
    """Rows [3][n] of the slave at a place."""
    z, low, high, counts = master
    size = (high - low) / counts
    cell = np.minimum(((place[:2] - low) / size + 1e-9).astype(int), counts - 1)
    s = (place[:2] - low) / size - cell
    rows = np.zeros((3, n))
    gap = place[2] - z
    for a in (0, 1):
        for b in (0, 1):
            at = 3 * node_at[tuple(cell + (a, b))]
            w = (s[0] if a else 1 - s[0]) * (s[1] if b else 1 - s[1])
            wx = (1 if a else -1) / size[0] * (s[1] if b else 1 - s[1])
            wy = (1 if b else -1) / size[1] * (s[0] if a else 1 - s[0])
            for d in range(3):
                rows[d, at + d] += w
            rows[0, at + 2] -= wx * gap  # omega_y g with omega_y = -u_z,x
            rows[1, at + 2] -= wy * gap  # -omega_x g with omega_x = u_z,y
    return rows


def main():
    apart, modes = (Path(a) for a in sys.argv[1:3])
    tolerance, slave, master = float(sys.argv[3]), grid(sys.argv[4]), grid(sys.argv[5])
    K, M = (dense(apart / f"{name}.bin") for name in "KM")
    with h5py.File(apart / "modes.h5") as file:
        x = file["VTKHDF/Points"][:]
    turn = np.cross([0.3, -0.5, 0.7], x).ravel()
    assert np.abs(K @ turn).max() < 1e-9 * np.abs(K).max() * np.abs(turn).max(), "nodes and unknowns are not in one order"
    upper = (np.abs(M[::3, ::3]) > 0)  # nodes of one box hang together
    body = np.zeros(len(x), bool)
    body[0] = True
    for _ in range(200):
        body = upper[:, body].any(1)
    groups = [np.flatnonzero(body), np.flatnonzero(~body)]
    top = max(groups, key=lambda g: x[g, 2].max())
    low = min(groups, key=lambda g: x[g, 2].max())
    slaves = on_plane(x, top, slave)
    _, start, end, counts = master
    node_at = {tuple(np.rint((x[i, :2] - start) / (end - start) * counts).astype(int)): i for i in on_plane(x, low, master)}
    full = np.eye(len(K))
    for i in slaves:
        full[3 * i:3 * i + 3] = row(x[i], master, node_at, len(K))
    kept = np.setdiff1d(np.arange(len(K)), [3 * i + d for i in slaves for d in range(3)])
    T = full[:, kept]
    kappa = scipy.linalg.eigh(T.T @ K @ T, T.T @ M @ T, eigvals_only=True)
    wanted = np.sqrt(np.maximum(kappa[6:], 0)) / (2 * np.pi)
    with open(modes / "modes.csv") as file:
        found = [float(line["freq_hz"]) for line in csv.DictReader(file)]
    assert found[:6] == [0] * 6 and found[6] > 0, f"not six rigid modes: {found[:8]}"
    error = max(abs(f / w - 1) for f, w in zip(found[6:], wanted))
    print(f"{len(slaves)} nodes follow, {len(found) - 6} elastic modes, largest difference {error:.2g}")
    sys.exit(len(found) < 10 or not error <= tolerance)


if __name__ == "__main__":
    main()
