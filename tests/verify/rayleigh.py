#!/usr/bin/env python3
"""Compares the modes of two runs, without damping and with the same Rayleigh factors on all parts (C = alpha M + beta
K).

Each undamped omega must turn into lambda = -c/2 + i sqrt(omega^2 - c^2/4), c = alpha + beta omega^2, to `--tolerance`
relative to |lambda|; rigid modes are left out. Exact only without friction, and for beta only without springs and
contact, which have no beta. Exit status: 0, or 1.
"""

import argparse
import csv
import math
import sys
from pathlib import Path


def eigenvalues(table):
    """Complex eigenvalues (1/s) of modes.csv other than zero frequencies."""
    with table.open(newline="") as lines:
        rows = [(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in csv.DictReader(lines)]
    return [complex(*row) for row in rows if row[1] > 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("undamped", type=Path, help="modes.csv")
    parser.add_argument("damped", type=Path, help="modes.csv")
    parser.add_argument("--alpha", type=float, default=0, help="1/s")
    parser.add_argument("--beta", type=float, default=0, help="s")
    parser.add_argument("--tolerance", type=float, default=1e-9)
    args = parser.parse_args()
    undamped, damped = eigenvalues(args.undamped), eigenvalues(args.damped)
    if not undamped or len(undamped) != len(damped):
        print(f"{len(undamped)} undamped modes, {len(damped)} damped ones", file=sys.stderr)
        return 1
    worst = 0
    for omega in (value.imag for value in undamped):
        c = args.alpha + args.beta * omega**2
        exact = complex(-c / 2, math.sqrt(omega**2 - c**2 / 4))
        nearest = min(damped, key=lambda value: abs(value - exact))
        damped.remove(nearest)
        worst = max(worst, abs(nearest - exact) / abs(exact))
    print(f"{len(undamped)} modes, worst error {worst:.1e}, allowed {args.tolerance:.1e}")
    return 0 if worst <= args.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
