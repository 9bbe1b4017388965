#!/usr/bin/env python3
"""A growth rate of one run beside that of another: verify/ratio.py ONE WHICH OTHER WHICH RATIO RTOL, that is ONE / OTHER =
RATIO; WHICH is the "first" mode in modes.csv, the one that grows "most", or "least"."""

import csv
import sys
from pathlib import Path


def growth(folder, which):
    with (Path(folder) / "modes.csv").open(newline="") as file:
        rates = [float(row["growth_rad_s"]) for row in csv.DictReader(file)]
    return {"first": rates[0], "most": max(rates), "least": min(rates)}[which]


one, other = growth(*sys.argv[1:3]), growth(*sys.argv[3:5])
ratio, tolerance = float(sys.argv[5]), float(sys.argv[6])
print(f"growth {one:g} and {other:g} 1/s: {one / other:.9g}, expected {ratio:g} within {tolerance:g}")
if not abs(one / other / ratio - 1) <= tolerance:
    raise SystemExit(1)
