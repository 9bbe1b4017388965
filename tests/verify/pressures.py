#!/usr/bin/env python3
"""Pressures of single pairs beside those of another mesh of the master: pressures.py FOLDER REFERENCE LIMIT

At slave nodes in the same place, of each interface: rms of the differences of static.csv over the rms of the reference. Exit
status: 0 where each is at most LIMIT and a third of the nodes of an interface at least are in the same place, or 1.
"""

import csv
import sys
from pathlib import Path

import numpy as np


def pressures(folder):
    """(interface, place to 0.1 um) -> Pa."""
    with (Path(folder) / "static.csv").open(newline="") as lines:
        return {(row["interface"], *(round(1e7 * float(row[c])) for c in ("x_m", "y_m", "z_m"))): float(row["pressure_pa"])
                for row in csv.DictReader(lines)}


def main(folder, reference, limit):
    found, true = pressures(folder), pressures(reference)
    good = True
    for name in sorted({key[0] for key in true}):
        keys = [key for key in true if key[0] == name]
        common = [key for key in keys if key in found]
        off = np.array([found[key] - true[key] for key in common])
        rms = np.sqrt((off**2).mean() / np.mean([true[key]**2 for key in common])) if common else np.inf
        print(f"{name}: {len(common)} of {len(keys)} nodes in the same place, rms of pressures off by {rms:.3g}")
        good = good and rms <= float(limit) and 3 * len(common) >= len(keys)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
