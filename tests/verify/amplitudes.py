#!/usr/bin/env python3
"""Compares amplitudes of modes in time, by their modal filters, with their eigenvalues.

    verify/amplitudes.py MODES TRANSIENT [--from 2e-5] [--growth 1e-2] [--frequency 1e-4]

MODES and TRANSIENT are output folders, the latter with amplitudes.csv. Each column c must obey c' = lambda c from that
time (s) on: the slope of ln |c| is the growth, that of the phase the angular frequency, to relative tolerances. No pair
changes between open and closed.
"""

import argparse
import csv
import math
import re
import sys
from pathlib import Path

import numpy


def rows(path):
    with Path(path).open(newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modes", type=Path)
    parser.add_argument("transient", type=Path)
    for name, default in (("from", 2e-5), ("growth", 1e-2), ("frequency", 1e-4)):
        parser.add_argument(f"--{name}", type=float, default=default)
    args = vars(parser.parse_args())
    eigenvalues = {int(row["mode"]): row for row in rows(args["modes"] / "modes.csv")}
    table = rows(args["transient"] / "amplitudes.csv")
    time = numpy.array([float(row["time_s"]) for row in table])
    late = time > args["from"]
    modes = sorted({int(m[1]) for m in (re.fullmatch(r"mode_(\d+)_re_m", name) for name in table[0]) if m})
    good = bool(modes)
    for mode in modes:
        growth = float(eigenvalues[mode]["growth_rad_s"])
        omega = 2 * math.pi * float(eigenvalues[mode]["freq_hz"])
        c = numpy.array([complex(float(row[f"mode_{mode}_re_m"]), float(row[f"mode_{mode}_im_m"])) for row in table])
        found = (numpy.polyfit(time[late], numpy.log(abs(c[late])), 1)[0],
                 numpy.polyfit(time[late], numpy.unwrap(numpy.angle(c[late])), 1)[0])
        good &= abs(found[0] / growth - 1) < args["growth"] and abs(found[1] / omega - 1) < args["frequency"]
        print(f"mode {mode}: growth {found[0]:.6g} 1/s, eigenvalue {growth:.6g}; {found[1] / 2 / math.pi:.6f} Hz, "
              f"eigenvalue {omega / 2 / math.pi:.6f}; from {abs(c[late][0]):.1e} m")
    closed = {row["n_closed"] for row in rows(args["transient"] / "transient.csv")}
    print(f"closed pairs {' '.join(sorted(closed))}")
    return 0 if good and len(closed) == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
