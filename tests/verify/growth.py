#!/usr/bin/env python3
"""Compares a mode's eigenvalue with growth and frequency in time.

    verify/growth.py MODES MODE TRANSIENT PROBE [--band 0.1] [--growth 1e-3] [--frequency 1e-4]

MODES and TRANSIENT are output folders, of `-analysis modes` and of a transient that starts from the sliding state with
a little of that mode; PROBE names the column of transient.csv, less its mean. The status must be that of the modes all
the time: no pair changes between open and closed. The tolerances are relative.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.transient.signal import fit_modes # noqa: E402


def eigenvalue(folder, mode):
    with open(Path(folder) / "modes.csv", newline="", encoding="utf-8") as table:
        row = next(row for row in csv.DictReader(table) if row["mode"] == mode)
    return float(row["growth_rad_s"]), float(row["freq_hz"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("modes", "mode", "transient", "probe"):
        parser.add_argument(name)
    parser.add_argument("--band", type=float, default=0.1)
    parser.add_argument("--growth", type=float, default=1e-3)
    parser.add_argument("--frequency", type=float, default=1e-4)
    args = parser.parse_args()
    growth, frequency = eigenvalue(args.modes, args.mode)
    table = numpy.genfromtxt(Path(args.transient) / "transient.csv", delimiter=",", names=True)
    band = (frequency * (1 - args.band), frequency * (1 + args.band))
    found = fit_modes(table["time_s"], table[args.probe] - table[args.probe].mean(), band, 2)
    nearest = min(found, key=lambda mode: abs(complex(mode.growth - growth, 2 * numpy.pi * (mode.freq - frequency))), default=None)
    closed = set(table["n_closed"])
    if nearest is None:
        print(f"no line in {band} Hz")
        return 1
    errors = nearest.growth / growth - 1, nearest.freq / frequency - 1
    print(f"eigenvalue {growth:.6g} 1/s {frequency:.6f} Hz; in time {nearest.growth:.6g} +- {nearest.error:.1g} 1/s "
          f"{nearest.freq:.6f} Hz: {errors[0]:.1e}, {errors[1]:.1e}; closed pairs {sorted(closed)}")
    return 0 if len(closed) == 1 and abs(errors[0]) < args.growth and abs(errors[1]) < args.frequency else 1


if __name__ == "__main__":
    sys.exit(main())
