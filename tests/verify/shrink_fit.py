#!/usr/bin/env python3
"""Pressure of a ring that is shrunk on another one, in plane strain, against G. Lame's, over meshes that are finer and finer.

    verify/shrink_fit.py RUN [RUN ...] --radii A B C --modulus E --poisson NU --interference D [--rate 2] [--error 1e-3]

static.csv of rings of one material from A to B and from B to C, m, with the interference D:

    p = D E / (1 - NU^2) / (B ((C^2 + B^2) / (C^2 - B^2) + (B^2 + A^2) / (B^2 - A^2))).

The error is the root mean square of the pressures over the pairs' areas, relative. Meshes have half the size from run to run: the last
error must be below --error, and fall by 2^rate at least from that before. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np


def error(folder, exact):
    """Relative error of the pressures of one run."""
    with (folder / "static.csv").open(newline="") as lines:
        p, area = np.array([[float(row["pressure_pa"]), float(row["area_m2"])] for row in csv.DictReader(lines)]).T
    return np.sqrt(np.sum(area * (p / exact - 1)**2) / np.sum(area))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=Path)
    parser.add_argument("--radii", type=float, nargs=3, required=True)
    for name in ("modulus", "poisson", "interference"):
        parser.add_argument(f"--{name}", type=float, required=True)
    parser.add_argument("--rate", type=float, default=2)
    parser.add_argument("--error", type=float, default=1e-3)
    args = parser.parse_args()
    a, b, c = args.radii
    yields = b * ((c**2 + b**2) / (c**2 - b**2) + (b**2 + a**2) / (b**2 - a**2)) * (1 - args.poisson**2) / args.modulus
    errors = [error(run, args.interference / yields) for run in args.runs]
    rate = np.log2(errors[-2] / errors[-1]) if len(errors) > 1 else np.inf
    print(f"pressure {args.interference / yields:.7g} Pa, off by " + ", ".join(f"{off:.3g}" for off in errors) + f"; rate {rate:.2f}")
    return 0 if errors[-1] < args.error and rate >= args.rate else 1


if __name__ == "__main__":
    sys.exit(main())
