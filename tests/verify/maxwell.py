#!/usr/bin/env python3
"""A transient of a body of one Prony series that starts at rest from the shape of an undamped mode, against the exact motion of
that mode with its branches at rest, and the decay of it against the eigenvalue of a run of modes.

    verify/maxwell.py ELASTIC MODE VISCOUS TRANSIENT COLUMN SERIES [--tolerance 1e-5] [--growth 1e-4] [--frequency 1e-6]

ELASTIC and VISCOUS are output folders of modes with lumped masses, without and with the series; MODE is that of the first, COLUMN of
transient.csv. SERIES: prony,E_1/E,..,tau_1,.. as of verify/viscoelastic.py. With one law for all of the stiffness,
K (1 + sum_j (E_j / E) lambda / (lambda + 1 / tau_j)), each undamped mode moves by itself, a'' = -w^2 a - sum_j q_j,
q_j' = (E_j / E) w^2 a' - q_j / tau_j. The largest difference is relative to the largest motion. The fit of two conjugate exponentials
beside those of the branches has no other input."""

import argparse
import csv
import math
import sys
from pathlib import Path

import numpy
import scipy.linalg


def rows(path):
    with path.open(newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def system(omega, series):
    """d/dt of (a, a', q_1, ..)."""
    n = len(series) // 2
    matrix = numpy.zeros((2 + n, 2 + n))
    matrix[0, 1], matrix[1, 0], matrix[1, 2:] = 1, -omega**2, -1
    for j in range(n):
        matrix[2 + j, 1], matrix[2 + j, 2 + j] = series[j] * omega**2, -1 / series[n + j]
    return matrix


def exact(matrix, times):
    """a at these times, from a = 1 at rest."""
    values, vectors = scipy.linalg.eig(matrix)
    start = numpy.linalg.solve(vectors, numpy.eye(len(matrix))[:, 0])
    return ((vectors[0] * start) @ numpy.exp(numpy.outer(values, times))).real


def decay(times, motion, guess, others):
    """The eigenvalue nearest to the guess whose motion, with decays `others`, fits best, by Gauss and Newton."""
    value = guess
    for _ in range(30):
        basis = numpy.column_stack([numpy.exp(value.real * times) * numpy.cos(value.imag * times),
                                    numpy.exp(value.real * times) * numpy.sin(value.imag * times),
                                    *(numpy.exp(rate * times) for rate in others)])
        c = numpy.linalg.lstsq(basis, motion, rcond=None)[0]
        wave = (c[0] - 1j * c[1]) * numpy.exp(value * times)
        slopes = numpy.column_stack([(times * wave).real, -(times * wave).imag, basis])
        step = numpy.linalg.lstsq(slopes, motion - basis @ c, rcond=None)[0]
        value += complex(step[0], step[1])
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("elastic", "viscous", "transient"):
        parser.add_argument(name, type=Path)
    parser.add_argument("mode")
    parser.add_argument("column")
    parser.add_argument("series")
    for name, default in (("tolerance", 1e-5), ("growth", 1e-4), ("frequency", 1e-6)):
        parser.add_argument(f"--{name}", type=float, default=default)
    args = parser.parse_args()
    omega = 2 * math.pi * next(float(row["freq_hz"]) for row in rows(args.elastic / "modes.csv") if row["mode"] == args.mode)
    matrix = system(omega, [float(number) for number in args.series.split(",")[1:]])
    table = rows(args.transient / "transient.csv")
    times, motion = (numpy.array([float(row[name]) for row in table]) for name in ("time_s", args.column))
    motion = motion / motion[0]
    worst = abs(motion - exact(matrix, times)).max()
    values = numpy.linalg.eigvals(matrix)
    found = decay(times, motion, values[values.imag.argmax()], values[values.imag == 0].real)
    listed = (complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in rows(args.viscous / "modes.csv"))
    mode = min(listed, key=lambda value: abs(value - found))
    growth, frequency = abs(found.real / mode.real - 1), abs(found.imag / mode.imag - 1)
    print(f"{len(table)} rows: {worst:.2g} of the motion, allowed {args.tolerance:g}; decay {found.real:.8g} 1/s, eigenvalue "
          f"{mode.real:.8g}: {growth:.2g}, allowed {args.growth:g}; {found.imag / 2 / math.pi:.8g} Hz, eigenvalue "
          f"{mode.imag / 2 / math.pi:.8g}: {frequency:.2g}, allowed {args.frequency:g}")
    sys.exit(0 if worst <= args.tolerance and growth <= args.growth and frequency <= args.frequency else 1)


if __name__ == "__main__":
    main()
