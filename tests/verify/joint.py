#!/usr/bin/env python3
"""Modes of bodies on bushings and with points, against bodies that are rigid, or bars of elements in one dimension.

    verify/joint.py bodies MODES TOLERANCE A/B/PLACE/STIFFNESS ...
    verify/joint.py beam MODES TOLERANCE MASS INERTIA OFFSET
    verify/joint.py bar MODES TOLERANCE MASS ELEMENTS

Two rigid bars as of mesh.py bars (100 x 10 x 10 mm, the second behind a gap of 20 mm), 7800 and 3900 kg/m^3, and joints
"side a/side b/place/three stiffnesses and three about the axes[/axis 1/axis 2[/place of b]]", sides left, right, ground;
points are joints of mass:
"left/mass/place/mass and six of inertia". Every frequency but the zeros must be there.

The first bar clamped at its start, 200 GPa, no lateral strain, with a mass at its end: bending by Timoshenko's equations,
mass at OFFSET behind the end with its inertia about the axis of bending; or stretched, as a chain of elements. Each of
the lowest two (three) frequencies must be one of the table."""

import csv
import sys
from pathlib import Path

import numpy as np

SIZE = np.array([0.1, 0.01, 0.01])
CENTRES = {"left": np.array([-0.05, 0, 0]), "right": np.array([0.07, 0, 0])}
DENSITY = {"left": 7800, "right": 3900}
SIDES = list(CENTRES)


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def motion(side, place):
    """Motion at a place from the 12 motions of the two centres."""
    q = np.zeros((6, 12))
    if side != "ground":
        at = 6 * SIDES.index(side)
        q[:, at:at + 6] = np.eye(6)
        q[:3, at + 3:at + 6] = -skew(place - CENTRES[side])
    return q


def frame(first="1,0,0", second="0,1,0"):
    """Rows: the axes of a joint, the second by Gram-Schmidt."""
    x, y = (np.array([float(v) for v in text.split(",")]) for text in (first, second))
    x /= np.linalg.norm(x)
    y -= x * (x @ y)
    y /= np.linalg.norm(y)
    return np.array([x, y, np.cross(x, y)])


def bodies(joints):
    """Frequencies, Hz."""
    K, M = np.zeros((12, 12)), np.zeros((12, 12))
    for i, side in enumerate(SIDES):
        mass = DENSITY[side] * SIZE.prod()
        M[6 * i:6 * i + 6, 6 * i:6 * i + 6] = np.diag([mass] * 3 + list(mass / 12 * ((SIZE**2).sum() - SIZE**2)))
    for joint in joints:
        a, b, place, values, *more = joint.split("/")
        place, values = (np.array([float(x) for x in text.split(",")]) for text in (place, values))
        if b == "mass":
            q = motion(a, place)
            m, xx, yy, zz, xy, xz, yz = values
            W = np.zeros((6, 6))
            W[:3, :3], W[3:, 3:] = m * np.eye(3), [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
            M += q.T @ W @ q
        else:
            axes, other = frame(*more[:2]), np.array([float(x) for x in more[2].split(",")]) if more[2:] else place
            q = motion(a, place) - motion(b, other)
            K += q.T @ np.kron(np.eye(2), axes).T @ np.diag(values) @ np.kron(np.eye(2), axes) @ q
    L = np.linalg.cholesky(M)
    eigenvalues = np.linalg.eigvalsh(np.linalg.solve(L, np.linalg.solve(L, K).T))
    return np.sqrt(np.maximum(0, eigenvalues)) / (2 * np.pi)


def beam(mass, inertia, offset):
    """Bending frequencies, Hz: zeros of the determinant at the end of y' = A y, y = (w, turn, moment, shear)."""
    side, young, density = SIZE[1], 2e11, 7800
    area, second, shear = side**2, side**4 / 12, 5 / 6 * young / 2 * side**2

    def residual(f):
        w2 = (2 * np.pi * f)**2
        A = np.array([[0, 1, 0, 1 / shear], [0, 0, 1 / (young * second), 0], [0, -density * second * w2, 0, -1],
                      [-density * area * w2, 0, 0, 0]])
        values, vectors = np.linalg.eig(A)
        end = (vectors @ np.diag(np.exp(values * SIZE[0])) @ np.linalg.inv(vectors)).real[:, 2:]
        w = end[0] + offset * end[1]
        return np.linalg.det([end[3] - mass * w2 * w, end[2] - w2 * (inertia * end[1] + offset * mass * w)])

    return zeros(residual, np.linspace(50, 60000, 6000))


def zeros(function, grid):
    found = []
    for a, b in zip(grid, grid[1:]):
        if function(a) * function(b) < 0:
            for _ in range(60):
                middle = (a + b) / 2
                a, b = (middle, b) if function(a) * function(middle) > 0 else (a, middle)
            found.append((a + b) / 2)
    return np.array(found)


def bar(mass, elements):
    """Frequencies of stretching, Hz, of linear elements with consistent mass."""
    h, area, young, density = SIZE[0] / elements, SIZE[1] * SIZE[2], 2e11, 7800
    K, M = np.zeros((elements + 1, elements + 1)), np.zeros((elements + 1, elements + 1))
    for e in range(elements):
        K[e:e + 2, e:e + 2] += young * area / h * np.array([[1, -1], [-1, 1]])
        M[e:e + 2, e:e + 2] += density * area * h / 6 * np.array([[2, 1], [1, 2]])
    M[-1, -1] += mass
    L = np.linalg.cholesky(M[1:, 1:])
    return np.sqrt(np.linalg.eigvalsh(np.linalg.solve(L, np.linalg.solve(L, K[1:, 1:]).T))) / (2 * np.pi)


def main():
    kind, folder, tolerance, *rest = sys.argv[1:]
    with (Path(folder) / "modes.csv").open(newline="") as file:
        found = np.array(sorted(float(row["freq_hz"]) for row in csv.DictReader(file)))
    if kind == "bodies":
        expected = bodies(rest)
        expected = expected[expected > 1e-4 * expected[-1]]
        found = found[found > 1e-4 * expected[-1]]
        if len(found) != len(expected):
            raise SystemExit(f"{len(found)} modes, must be {len(expected)}: {found}, {expected}")
        error = np.abs(found / expected - 1).max()
    else:
        expected = beam(*map(float, rest))[:2] if kind == "beam" else bar(float(rest[0]), int(rest[1]))[:3]
        error = max(np.abs(found / f - 1).min() for f in expected)
    print(f"{len(expected)} modes, worst error {error:.1e}")
    if not error <= float(tolerance):
        raise SystemExit(f"{found} for {expected}")


if __name__ == "__main__":
    main()
