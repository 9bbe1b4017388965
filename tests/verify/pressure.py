#!/usr/bin/env python3
"""Pressure laws of a contact on a held base against the curves and against Newton's method on exported matrices.

    pressure.py even FOLDER PRESSURE LAW NUMBERS  static.csv: every pair has PRESSURE (Pa), the closing at which the law has it, and
                                                  the law's slope there times its area for stiffness
    pressure.py curve FOLDER LAW NUMBERS          static.csv: pressures are on the curve, relative to the largest
    pressure.py points SWEEP FOLDER [FOLDER ...]  the points of sweep.csv have the frequencies of these modes.csv
    pressure.py newton FOLDER MODES SAVED STIFFER MU LAW NUMBERS
                                                  static.csv of FOLDER, modes.csv of MODES: the equilibrium and the modes about it.
                                                  SAVED has K.bin, H.bin, F.bin, M.bin with kn_per_area 1e12 N/m^3 and the same MU,
                                                  STIFFER K.bin with 2e12, whose difference tells unknowns and areas of the slaves

LAW: exponential c0 p0, power k m, table c p c p ..., or lining h E e p e p ...: a table with h (e - p / E) for c. The curves are
written down here once more; their inverses are found by bisection, the equilibrium by damped Newton steps in the displacements, the
eigenvalues by LAPACK.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

from dense import matrix, judge

TOLERANCE = 1e-10  # of a pressure, a closing, a stiffness on the curve; of forces beside the largest
STIFFNESS = 1e12  # N/m^3, of SAVED


class Law:
    def __init__(self, kind, numbers):
        numbers = [float(n) for n in numbers]
        if kind == "lining":
            thickness, modulus, *numbers = numbers
            kind, strains = "table", list(zip(numbers[::2], numbers[1::2]))
            numbers = [n for strain, p in strains for n in (thickness * (strain - p / modulus), p)]
        self.kind, self.numbers = kind, numbers
        self.onset = {"exponential": lambda: -self.numbers[0], "power": lambda: 0.0, "table": lambda: self.numbers[0]}[kind]()

    def both(self, c):
        """Pressure and slope at closings."""
        c = np.asarray(c, float)
        if self.kind == "exponential":
            c0, p0 = self.numbers
            x = np.maximum(c / c0 + 1, 0)
            scale = p0 / (math.e - 1)
            return scale * x * np.expm1(x), np.where(x > 0, scale / c0 * (np.expm1(x) + x * np.exp(x)), 0)
        if self.kind == "power":
            k, m = self.numbers
            return k * np.maximum(c, 0)**m, k * m * np.maximum(c, 0)**(m - 1)
        at, p = np.array(self.numbers[::2]), np.array(self.numbers[1::2])
        i = np.clip(np.searchsorted(at, c, side="right") - 1, 0, len(at) - 2)
        slope = np.where(c >= at[0], (p[i + 1] - p[i]) / (at[i + 1] - at[i]), 0)
        return np.where(c >= at[0], p[i] + slope * (c - at[i]), 0), slope

    def closing(self, pressure):
        low, high = self.onset, self.onset + 1e-12
        while self.both(high)[0] < pressure:
            high = self.onset + 2 * (high - self.onset)
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if self.both(middle)[0] < pressure else (low, middle)
        return (low + high) / 2


def read(folder):
    with (Path(folder) / "static.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in ("gap_m", "lambda_n_n", "area_m2", "pressure_pa",
                                                                            "stiffness_n_m")}


def require(what, found, expected, scale):
    worst = np.max(np.abs(np.asarray(found) - expected)) / scale
    print(f"{what}: worst difference {worst:.2g}, allowed {TOLERANCE:g}")
    if not worst <= TOLERANCE:
        raise SystemExit(1)


def even(folder, pressure, law):
    pairs, pressure = read(folder), float(pressure)
    closing = law.closing(pressure)
    require("pressure", pairs["pressure_pa"], pressure, pressure)
    require("closing", -pairs["gap_m"], closing, closing - law.onset)
    slope = law.both(closing)[1]
    require("stiffness per area", pairs["stiffness_n_m"] / pairs["area_m2"], slope, slope)


def curve(folder, law):
    pairs = read(folder)
    require("pressure", pairs["pressure_pa"], law.both(-pairs["gap_m"])[0], pairs["pressure_pa"].max())


def points(folder, references):
    with (Path(folder) / "sweep.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for k, reference in enumerate(references):
        with (Path(reference) / "modes.csv").open(newline="") as file:
            expected = np.sort([float(row["freq_hz"]) for row in csv.DictReader(file)])
        found = np.sort([float(row["freq_hz"]) for row in rows if int(row["point"]) == k + 1])
        if len(found) != len(expected):
            raise SystemExit(f"point {k + 1}: {len(found)} modes for {len(expected)}")
        require(f"point {k + 1}", found / expected, 1, 1)


def vector(path):
    data = path.read_bytes()
    n = int(np.frombuffer(data, ">i4", 2)[1])
    return np.frombuffer(data, ">f8", n, 8).astype(float)


def equilibrium(bodies, load, slave, area, push, law):
    """Displacements for which bodies u + push A P(-u_slave) = load, a column of push for each pair."""
    u = np.zeros(len(load))

    def left(u):
        pressure, slope = law.both(-u[slave])
        return bodies @ u + push @ (area * pressure) - load, slope

    # soft at first, so that the law comes in by degrees: its argument is damped until the residual falls
    u = np.linalg.solve(bodies + push * STIFFNESS @ np.eye(len(load))[slave] * -area.max(), load)
    for _ in range(500):
        rest, slope = left(u)
        jacobian = bodies.copy()
        jacobian[:, slave] -= push * (area * slope)
        step, part = np.linalg.solve(jacobian, -rest), 1.0
        while part > 1e-9 and not np.linalg.norm(left(u + part * step)[0]) < np.linalg.norm(rest):
            part /= 2
        if np.abs(step).max() <= 1e-14 * np.abs(u).max() or part <= 1e-9:
            return u
        u += part * step
    raise SystemExit("Newton's method on the matrices did not end")


def newton(folder, modes, saved, stiffer, mu, law):
    saved = Path(saved)
    K, H = matrix(saved / "K.bin"), matrix(saved / "H.bin")
    normal = matrix(Path(stiffer) / "K.bin") - K  # 1e12 N'A N, diagonal: the base is held, and n is an axis
    slave = np.flatnonzero(np.diag(normal) > 1e-9 * np.diag(normal).max())
    area = np.diag(normal)[slave] / STIFFNESS
    bodies = K - normal
    push = (float(mu) * H[:, slave]) / (STIFFNESS * area)  # H = -1e12 T'A N, N = -1 at a slave
    push[slave, np.arange(len(slave))] += 1
    push *= -1  # internal forces N' - mu T'
    u = equilibrium(bodies, vector(saved / "F.bin"), slave, area, push, law)
    pressure, slope = law.both(-u[slave])
    pairs = read(folder)
    if len(pairs["gap_m"]) != len(slave):
        raise SystemExit("other pairs")
    require("forces", np.sort(pairs["lambda_n_n"]), np.sort(area * pressure), (area * pressure).max())
    require("gaps", np.sort(pairs["gap_m"]), np.sort(u[slave]), np.abs(u[slave]).max())
    require("stiffness", np.sort(pairs["stiffness_n_m"]), np.sort(area * slope), (area * slope).max())
    K = bodies.copy()
    K[:, slave] -= push * (area * slope)
    modes_of(Path(modes), K, matrix(saved / "M.bin"))


def modes_of(folder, K, M):
    with (folder / "modes.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    modes = [float(row["growth_rad_s"]) + 2j * np.pi * float(row["freq_hz"]) for row in rows]
    found = 1j * np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)) + 0j)
    found = np.concatenate([found, -found])
    found = found[(found.imag > 2 * np.pi) & (found.imag <= 1.0001 * max(mode.imag for mode in modes))]
    print(f"largest growth {max(mode.real for mode in modes):.9g} 1/s")
    judge(modes, found, lambda value: True, 1e-9)


if __name__ == "__main__":
    {"even": lambda a: even(a[0], a[1], Law(a[2], a[3:])),
     "curve": lambda a: curve(a[0], Law(a[1], a[2:])),
     "points": lambda a: points(a[0], a[1:]),
     "newton": lambda a: newton(*a[:5], Law(a[5], a[6:]))}[sys.argv[1]](sys.argv[2:])
