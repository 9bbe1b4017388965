#!/usr/bin/env python3
"""Pressure of a cylinder or a sphere on a flat against Hertz's, over meshes that are finer and finer.

    verify/hertz.py RUN [RUN ...] --width W [W ...] --radius R --modulus E [--sphere] [--rate 0.8] [--error 0.05]

Runs of statics on half of the contact (x >= 0), each of a slice of that width along the axis, m. With F the force of
both halves per length, the half width is a = sqrt(4 F R / (pi E)), E (Pa) the reduced modulus, and the pressure p0
sqrt(1 - x^2 / a^2), p0 = 2 F / (pi a). The error is the root mean square over the pairs' areas, over that of the
pressure. Faces are of first order and p ends in a root at x = a, hence an error in proportion to their size, a rate of
1. With --sphere the runs are of a quarter (x, y >= 0), W is the size of a face: a^3 = 3 F R / (4 E), p0 = 3 F / (2 pi a^2),
with r^2 = x^2 + y^2 for x^2, F the force of all quarters. The last must be below --error, and from the last run but one
fall by the rate at least. Exit status: 0, or 1.
"""

import argparse
import csv
import math
import sys
from pathlib import Path


def error(folder, width, radius, modulus, sphere):
    """Relative error of the pressures of one run."""
    with (folder / "static.csv").open(newline="") as lines:
        pairs = [[float(row[name]) for name in ("x_m", "y_m", "area_m2", "lambda_n_n")] for row in csv.DictReader(lines)]
    normal = sum(pair[3] for pair in pairs)
    if sphere:
        half = (3 * 4 * normal * radius / (4 * modulus))**(1 / 3)
        most = 3 * 4 * normal / (2 * math.pi * half**2)
    else:
        half = math.sqrt(4 * 2 * normal / width * radius / (math.pi * modulus))
        most = 2 * 2 * normal / width / (math.pi * half)
    exact = [most * math.sqrt(max(0, 1 - (x**2 + (y**2 if sphere else 0)) / half**2)) for x, y, _, _ in pairs]
    off = sum(area * (force / area - p)**2 for (_, _, area, force), p in zip(pairs, exact))
    return math.sqrt(off / sum(area * p**2 for (_, _, area, _), p in zip(pairs, exact)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", type=Path)
    parser.add_argument("--width", type=float, nargs="+", required=True)
    parser.add_argument("--radius", type=float, required=True)
    parser.add_argument("--modulus", type=float, required=True)
    parser.add_argument("--sphere", action="store_true")
    parser.add_argument("--rate", type=float, default=0.8)
    parser.add_argument("--error", type=float, default=0.05)
    args = parser.parse_args()
    errors = [error(run, width, args.radius, args.modulus, args.sphere) for run, width in zip(args.runs, args.width, strict=True)]
    rate = math.log(errors[-2] / errors[-1]) / math.log(args.width[-2] / args.width[-1]) if len(errors) > 1 else 0
    print(", ".join(f"width {width:g} m: {off:.4f}" for width, off in zip(args.width, errors)), f"rate {rate:.2f}")
    return 0 if errors[-1] < args.error and (len(errors) < 2 or rate >= args.rate) else 1


if __name__ == "__main__":
    sys.exit(main())
