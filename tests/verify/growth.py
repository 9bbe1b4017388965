#!/usr/bin/env python3
"""Compares a mode's eigenvalue with growth and frequency in time.

    verify/growth.py MODES MODE TRANSIENT PROBE [--band 0.1] [--growth 1e-3] [--frequency 1e-4] [--halved HALF QUARTER]

MODES and TRANSIENT are output folders, of `-analysis modes` and of a transient that starts from the sliding state with
a little of that mode; PROBE names the column of transient.csv, less its mean. The status must be that of the modes all
the time: no pair changes between open and closed. The tolerances are relative. With --halved transients of half and of
a quarter of the step are given too, and the changes of the eigenvalue in time fall by 4 to 2 %, as of second order.
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


def in_time(folder, probe, band, at):
    """The motion's mode nearest to an eigenvalue, and the counts of closed pairs; None without a line in the band."""
    table = numpy.genfromtxt(Path(folder) / "transient.csv", delimiter=",", names=True)
    found = fit_modes(table["time_s"], table[probe] - table[probe].mean(), band, 2)
    return min(found, key=lambda mode: abs(complex_of(mode) - at), default=None), set(table["n_closed"])


def complex_of(mode):
    return complex(mode.growth, 2 * numpy.pi * mode.freq)


def is_second_order(eigenvalues):
    whole, half, quarter = eigenvalues
    ratio = (whole - half) / (half - quarter)
    print(f"changes with the step fall by {ratio:.4f}")
    return abs(ratio / 4 - 1) < 0.02


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("modes", "mode", "transient", "probe"):
        parser.add_argument(name)
    parser.add_argument("--band", type=float, default=0.1)
    parser.add_argument("--growth", type=float, default=1e-3)
    parser.add_argument("--frequency", type=float, default=1e-4)
    parser.add_argument("--halved", nargs=2, default=[])
    args = parser.parse_args()
    growth, frequency = eigenvalue(args.modes, args.mode)
    band = (frequency * (1 - args.band), frequency * (1 + args.band))
    at = complex(growth, 2 * numpy.pi * frequency)
    nearest, closed = in_time(args.transient, args.probe, band, at)
    if nearest is None:
        print(f"no line in {band} Hz")
        return 1
    errors = nearest.growth / growth - 1, nearest.freq / frequency - 1
    print(f"eigenvalue {growth:.6g} 1/s {frequency:.6f} Hz; in time {nearest.growth:.6g} +- {nearest.error:.1g} 1/s "
          f"{nearest.freq:.6f} Hz: {errors[0]:.1e}, {errors[1]:.1e}; closed pairs {sorted(closed)}")
    if args.halved and not is_second_order(
            [complex_of(nearest)] + [complex_of(in_time(run, args.probe, band, at)[0]) for run in args.halved]):
        return 1
    return 0 if len(closed) == 1 and abs(errors[0]) < args.growth and abs(errors[1]) < args.frequency else 1


if __name__ == "__main__":
    sys.exit(main())
