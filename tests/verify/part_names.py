#!/usr/bin/env python3
"""Names of the modes of free bodies of steel: kinds, numbers and frequencies.

    verify/part_names.py beam RESULTS     0.3 x 0.012 x 0.006 m, against closed forms
    verify/part_names.py plate RESULTS    0.15 x 0.1 x 0.001 m, against Kirchhoff's plate by Ritz with Legendre polynomials, itself
                                          held against the table of A. W. Leissa (J. Sound Vib. 31, 1973) for a/b = 1.5
    verify/part_names.py both RESULTS     both, side by side
    verify/part_names.py young RESULTS    both, in a sweep over the plate's modulus, at each point; density: over its density

Closed forms of a beam of length l, w = 2 pi f: bending (b_n / l)^2 sqrt(E I / rho A), cos b cosh b = 1, each way, r^2 = I / A, without
shear and rotation, which lower it by about 2 (b_n r / l)^2 (S. Timoshenko); torsion n pi / l sqrt(G J / rho I_p), J by B. de
Saint-Venant; longitudinal n pi / l sqrt(E / rho).

A mode of the plate that is none of the kinds is called elastic n, the n-th of all."""

import csv
import math
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

YOUNG, POISSON, DENSITY = 210e9, 0.3, 7800
BEAM, PLATE = (0.3, 0.012, 0.006), (0.15, 0.1, 0.001)
TOLERANCE = {"bending": 0.03, "in-plane bending": 0.08, "torsion": 0.04, "longitudinal": 0.01, "plate": 0.04}  # shear; the mesh
EXPLAINED = 99.9
SWEPT = {"young": lambda value: value / YOUNG, "density": lambda value: DENSITY / value}  # of the plate's frequencies, squared
LEISSA = [20.128, 21.603, 46.654, 50.293, 58.201, 67.494]  # w a^2 sqrt(rho h / D) of a free plate, a/b = 1.5, nu = 0.3


def bending(length, gyration, count):
    roots = [brentq(lambda b: math.cos(b) - 1 / math.cosh(b), (n + 0.4) * math.pi, (n + 0.6) * math.pi) for n in range(1, count + 1)]
    return [(b / length)**2 * gyration * math.sqrt(YOUNG / DENSITY) / (2 * math.pi) for b in roots]


def torsion_constant(broad, thin):
    series = sum(math.tanh(n * math.pi * broad / (2 * thin)) / n**5 for n in range(1, 40, 2))
    return broad * thin**3 * (1 / 3 - 64 / math.pi**5 * thin / broad * series)


def beam(highest):
    length, broad, thin = BEAM
    polar = broad * thin * (broad**2 + thin**2) / 12
    shear = math.sqrt(YOUNG / (2 * (1 + POISSON)) * torsion_constant(broad, thin) / (DENSITY * polar))
    found = {f"bending {n + 1}": f for n, f in enumerate(bending(length, thin / math.sqrt(12), 12))}
    found |= {f"in-plane bending {n + 1}": f for n, f in enumerate(bending(length, broad / math.sqrt(12), 8))}
    found |= {f"torsion {n}": n * shear / (2 * length) for n in range(1, 6)}
    found |= {f"longitudinal {n}": n * math.sqrt(YOUNG / DENSITY) / (2 * length) for n in range(1, 6)}
    return {name: f for name, f in found.items() if f < highest}


def legendre(n):
    """Values, slopes, curvatures of P_0 .. P_n-1 at Gauss points, and weights."""
    x, weights = np.polynomial.legendre.leggauss(n + 4)
    series = [np.polynomial.legendre.Legendre.basis(k) for k in range(n)]
    return [np.array([s.deriv(order)(x) if order else s(x) for s in series]) for order in range(3)], weights


def kirchhoff(n=12):
    """w a^2 sqrt(rho h / D), and of each mode the share of each product of polynomials in x and y, [modes][n][n]."""
    a, b = PLATE[:2]
    p, weights = legendre(n)
    one = [[np.einsum("ik,jk,k->ij", p[i], p[j], weights) for j in range(3)] for i in range(3)]
    x = [[m * (2 / a)**(i + j) * a / 2 for j, m in enumerate(row)] for i, row in enumerate(one)]
    y = [[m * (2 / b)**(i + j) * b / 2 for j, m in enumerate(row)] for i, row in enumerate(one)]
    stiffness = (np.kron(x[2][2], y[0][0]) + np.kron(x[0][0], y[2][2])
                 + POISSON * (np.kron(x[2][0], y[0][2]) + np.kron(x[0][2], y[2][0])) + 2 * (1 - POISSON) * np.kron(x[1][1], y[1][1]))
    mass = np.kron(x[0][0], y[0][0])
    values, vectors = eigh((stiffness + stiffness.T) / 2, mass)
    shares = vectors.T**2 * np.diag(mass)
    return np.sqrt(np.abs(values[3:])) * a**2, shares[3:].reshape(-1, n, n)


def plate(highest):
    """Kinds as the table of fields says: bending has no dependence on y, torsion a linear one, cross bending none on x."""
    numbers, shares = kirchhoff()
    if not np.all((numbers[:6] < LEISSA) & (numbers[:6] > 0.99 * np.array(LEISSA))):  # his are bounds from above, with fewer terms
        raise SystemExit(f"Ritz gives {numbers[:6]}, Leissa {LEISSA}")
    stiffness = YOUNG * PLATE[2]**2 / (12 * (1 - POISSON**2) * DENSITY)
    found, counts = {}, {}
    for k, (number, share) in enumerate(zip(numbers, shares)):
        kinds = {"bending": share[:, 0].sum(), "torsion": share[:, 1].sum(), "cross bending": share[0, 2:].sum()}
        kind = max(kinds, key=kinds.get)
        name = f"elastic {k + 1}"
        if kinds[kind] > 0.5:
            counts[kind] = counts.get(kind, 0) + 1
            name = f"{kind} {counts[kind]}"
        found[name] = number / PLATE[0]**2 * math.sqrt(stiffness) / (2 * math.pi)
    return {name: f for name, f in found.items() if f < highest}


def judge(rows, bodies, lowest, scale):
    """How many names are as expected, None where one is not: of the bodies, the plate's frequencies times scale."""
    top, expected = max(float(row["freq_hz"]) for row in rows), {}
    if bodies != "plate":
        expected |= {f"bar {name}": (f, TOLERANCE[name.rpartition(" ")[0]]) for name, f in beam(1.2 * top).items()}
    if bodies != "beam":
        expected |= {f"plate {name}": (f * scale, TOLERANCE["plate"]) for name, f in plate(1.02 * top / scale).items()}
    failed, seen = [], set()
    for row in rows:
        name, frequency, explained = row["label"], float(row["freq_hz"]), float(row.get("label_percent", 100))
        wanted, tolerance = expected.get(name, (math.nan, 0))
        off = abs(frequency / wanted - 1)
        bad = not off < tolerance or not EXPLAINED < explained < 100 + 1e-9 or name in seen
        print(f"{name}: {frequency:.2f} Hz, off by {off:.1e}, {explained:.4f} % explained{'  FAILED' * bad}")
        failed += [name] * bad
        seen.add(name)
    missing = [name for name, (f, tolerance) in expected.items()
               if f * (1 - tolerance) > lowest and f * (1 + tolerance) < top and name not in seen]
    print("; ".join(failed + missing) or f"{len(seen)} names as expected")
    return 1 if failed or missing or len(seen) < 8 else 0


def main():
    what, folder = sys.argv[1], Path(sys.argv[2])
    table = folder / ("sweep.csv" if what in SWEPT else "modes.csv")
    with table.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if float(row["freq_hz"]) > 0]
    if what not in SWEPT:
        return judge(rows, what, 0, 1)
    points = {}
    for row in rows:
        points.setdefault(float(row["value"]), []).append(row)
    lowest = min(float(row["freq_hz"]) for row in rows)
    wrong = sum(judge(own, "both", lowest, math.sqrt(SWEPT[what](value))) for value, own in points.items())
    return 1 if wrong or len(points) < 3 else 0


if __name__ == "__main__":
    sys.exit(main())
