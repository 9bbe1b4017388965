#!/usr/bin/env python3
"""Steady harmonic answers in time beside the frequency response and closed forms.

    harmonic.py response FRF HZ DEGREES FOLDER..   frf.csv: 1 N along z on `tip`, recorded at tip, b, c, d; transient.csv of a force
                                                   (10, 0, 30) N spread over these four, steps halved from run to run
    harmonic.py force HZ DEGREES FOLDER..          tip_y_m of 1 kg on 1e4 N/m and 60 N s/m under 40 N, 1 / (k - m w^2 + i w c)
    harmonic.py base HZ DEGREES FOLDER..           its base moved by 1 mm, (k + i w c) / (k - m w^2 + i w c); displacement, velocity,
                                                   acceleration

By reciprocity the first is the sum of H of the four times a quarter of the force. Amplitude and phase are fitted to the last cycles.
Steps of the mesh have errors of first order in their length, since damping is half a step late, those of the reduced model of second;
both go with three runs (Richardson). What is left must be below 1e-6."""

import csv
import sys
from pathlib import Path

import numpy as np

CYCLES = 3
TOLERANCE = 1e-6
CORNERS, FORCE = ("tip", "b", "c", "d"), {"x": 10.0, "z": 30.0}
STIFFNESS, VISCOSITY, PUSH, WAY = 1e4, 60.0, 40.0, 1e-3


def columns(folder, table="transient.csv"):
    with (Path(folder) / table).open(newline="", encoding="utf-8") as file:
        names, *rows = list(csv.reader(file))
    return dict(zip(names, np.array(rows, float).T))


def amplitude(folder, hertz, column):
    """A of Re(A exp(i w t))."""
    found = columns(folder)
    t, w = found["time_s"], 2 * np.pi * hertz
    last = t > t[-1] - CYCLES / hertz
    shapes = np.column_stack([np.cos(w * t[last]), -np.sin(w * t[last]), np.ones(last.sum())])
    x, *_ = np.linalg.lstsq(shapes, found[column][last], rcond=None)
    return complex(x[0], x[1])


def extrapolate(values):
    """To a step of 0, of steps that are halved: errors of first and second order go."""
    values = list(values)
    for order in range(1, len(values)):
        values = [(2**order * b - a) / (2**order - 1) for a, b in zip(values, values[1:])]
    return values[0]


def judge(hertz, column, asked, folders):
    found = [amplitude(folder, hertz, column) for folder in folders]
    off = abs(extrapolate(found) / asked - 1)
    each = ", ".join(f"{abs(a / asked - 1):.1e}" for a in found)
    print(f"{column}: {abs(asked):.6e}; off by {each}; without the steps' {off:.1e} of {TOLERANCE:g}")
    return off <= TOLERANCE


def main():
    what, *rest = sys.argv[1:]
    row = columns(rest.pop(0), "frf.csv") if what == "response" else {}
    hertz, degrees, *folders = float(rest[0]), float(rest[1]), *rest[2:]
    turn, w = np.exp(1j * np.radians(degrees)), 2 * np.pi * hertz
    one = 1 / (STIFFNESS - w * w + 1j * w * VISCOSITY)
    if what == "response":
        asked = sum(complex(row[f"{p}_{d}_re_m_n"][0], row[f"{p}_{d}_im_m_n"][0]) * f / 4 for p in CORNERS for d, f in FORCE.items())
        good = judge(hertz, "tip_z_m", asked * turn, folders)
    elif what == "force":
        good = judge(hertz, "tip_y_m", PUSH * one * turn, folders)
    else:
        u = WAY * (STIFFNESS + 1j * w * VISCOSITY) * one * turn
        good = all([judge(hertz, f"tip_{name}", a, folders) for name, a in (("y_m", u), ("vy_m_s", 1j * w * u), ("ay_m_s2", -w * w * u))])
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
