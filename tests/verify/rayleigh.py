#!/usr/bin/env python3
"""Compares the modes of two runs, without damping and with the same Rayleigh factors on all parts (C = alpha M + beta
K).

Each undamped omega must turn into lambda = -c/2 + i sqrt(omega^2 - c^2/4), c = alpha + beta omega^2, to `--tolerance`
relative to |lambda|; rigid modes are left out. With `--growth` only those with c/2 below it must be there, and what else
is there must be right too. Exact only without friction, and for beta only without springs and
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


def exact_value(omega, args):
    """The damped eigenvalue of an undamped one."""
    c = args.alpha + args.beta * omega**2
    return complex(-c / 2, math.sqrt(max(0, omega**2 - c**2 / 4)))


def farthest(values, among):
    """Largest relative distance of a value from its own nearest among others, each of which serves once."""
    left, worst = list(among), 0
    for value in values:
        nearest = min(left, key=lambda other: abs(other - value))
        left.remove(nearest)
        worst = max(worst, abs(nearest - value) / abs(value))
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("undamped", type=Path, help="modes.csv")
    parser.add_argument("damped", type=Path, help="modes.csv")
    parser.add_argument("--alpha", type=float, default=0, help="1/s")
    parser.add_argument("--beta", type=float, default=0, help="s")
    parser.add_argument("--growth", type=float, help="1/s; heavily damped modes beyond it may be missing")
    parser.add_argument("--tolerance", type=float, default=1e-9)
    args = parser.parse_args()
    undamped, damped = eigenvalues(args.undamped), eigenvalues(args.damped)
    exact = [exact_value(value.imag, args) for value in undamped]
    asked = [value for value in exact if args.growth is None or -value.real <= args.growth]
    if not asked or not len(asked) <= len(damped) <= len(exact):
        print(f"{len(asked)} of {len(exact)} undamped modes must be there, {len(damped)} damped ones", file=sys.stderr)
        return 1
    worst = max(farthest(asked, damped), farthest(damped, exact))
    print(f"{len(damped)} modes, {len(asked)} asked for, worst error {worst:.1e}, allowed {args.tolerance:.1e}")
    return 0 if worst <= args.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
