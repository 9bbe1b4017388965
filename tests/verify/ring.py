#!/usr/bin/env python3
"""In-plane modes of free rings in plane stress: names and frequencies.

    verify/ring.py thin RESULTS     against closed forms of a thin ring (A. E. H. Love, Mathematical Theory of Elasticity, sec. 293)
    verify/ring.py plate RESULTS    against the equations of each harmonic n along the radius, u_r = a(r) cos n theta,
                                    u_theta = b(r) sin n theta, solved by 60 elements of second order

RESULTS is a folder of modes of a ring of steel whose one face is held along the axis: the upper half of one twice as thick, without
bending. Modes with n > 0 come twice. Each name must also explain the shape."""

import csv
import math
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

SPEED, POISSON = math.sqrt(210e9 / 7800), 0.3  # of waves in a bar, m/s
THIN, WIDTH = 0.1, 0.004  # mean radius and width, m
PLATE = 0.06, 0.12
FREQUENCY = 0.01  # relative, thin: shear in flexure takes 0.6 %, the mesh adds 0.6 % for n = 6
EXPLAINED = 99.9  # per cent


def thin():
    """Name, Hz."""
    flexure = {f"IP-R({n})": WIDTH / THIN / math.sqrt(12) * n * (n * n - 1) / math.sqrt(n * n + 1) for n in range(2, 7)}
    extension = {f"IP-C({n})" if n else "IP-R(0)": math.sqrt(1 + n * n) for n in range(7)}
    return {name: value * SPEED / THIN / (2 * math.pi) for name, value in (flexure | extension).items()}


def harmonic(n):
    """Modes of harmonic n: frequency (Hz), share of the energy along the radius, vector of a and b."""
    r = np.linspace(*PLATE, 121)
    stiffness, mass = np.zeros((2, 242, 242))
    plane = np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]]) / (1 - POISSON**2)
    for first in range(0, 120, 2):
        h = r[first + 2] - r[first]
        at = slice(2 * first, 2 * first + 6)
        for x, weight in zip(*np.polynomial.legendre.leggauss(4)):
            shape, slope = np.array([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2]), np.array([x - 0.5, -2 * x, x + 0.5]) * 2 / h
            radius = shape @ r[first:first + 3]
            a, b = np.zeros((2, 2, 6))  # value and derivative
            a[:, 0::2] = b[:, 1::2] = shape, slope
            strain = np.array([a[1], (a[0] + n * b[0]) / radius, b[1] - (b[0] + n * a[0]) / radius])
            stiffness[at, at] += strain.T @ plane @ strain * radius * weight * h / 2
            mass[at, at] += (np.outer(a[0], a[0]) + np.outer(b[0], b[0])) * radius * weight * h / 2
    values, vectors = eigh(stiffness, mass)
    radial = mass.copy()
    radial[1::2] = 0
    return [(SPEED * math.sqrt(value) / (2 * math.pi), x @ radial @ x, x) for value, x in zip(values[:6], vectors.T) if value > 1]


def circles(profile):
    """Sign changes; values below a twentieth of the largest count as zero."""
    signs = np.sign(profile[abs(profile) > 0.05 * abs(profile).max()])
    return int(np.sum(signs[1:] != signs[:-1]))


def plate(highest):
    """The same, with nodal circles, below a frequency; for n = 1 the stretched ring has half of its energy in each direction."""
    found = {}
    for n in range(9):
        for frequency, share, x in harmonic(n):
            count = circles(x[0 if share > 0.5 else 1::2])
            name = f"IP-{'R' if share > 0.5 else 'C'}({f'{count},' * (count > 0)}{n})"
            if frequency < highest:
                if name in found:
                    raise SystemExit(f"two modes {name}")
                found[name] = frequency
    return found


def main():
    with (Path(sys.argv[2]) / "modes.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if "rigid" not in row["label"]]
    top = max(float(row["freq_hz"]) for row in rows)
    expected = thin() if sys.argv[1] == "thin" else plate(1.01 * top)
    failed = []
    for name, frequency in sorted(expected.items(), key=lambda item: item[1]):
        same = [row for row in rows if row["label"] == name]
        count = 1 if name.endswith(("(0)", ",0)")) else 2
        off = max((abs(float(row["freq_hz"]) / frequency - 1) for row in same), default=math.inf)
        explained = min((float(row["label_percent"]) for row in same), default=0)
        bad = len(same) != count or not off < FREQUENCY or not EXPLAINED < explained <= 100
        print(f"{name}: {len(same)} modes, {frequency:.2f} Hz, off by {off:.1e}, {explained:.4f} % explained{'  FAILED' * bad}")
        failed += [name] * bad
    others = [row["label"] for row in rows if row["label"] not in expected and sys.argv[1] == "plate"]
    print("; ".join(failed + others) or f"{len(expected)} names as expected")
    return 1 if failed or others or len(expected) < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
