#!/usr/bin/env python3
"""Compares contact forces in time with those of statics, pair by pair.

    contact.py STATIC TRANSIENT [--which all|last] [--tolerance 1e-9]

STATIC and TRANSIENT are output folders of `-analysis static` and of a transient with -dynamics_pairs_interval. Pairs are
found by interface and the place of the slave. Normal force, size of friction and status are compared at all recorded times
or at the last; the tolerance is relative to the largest normal force. No pair, or no force, is a failure.
"""

import argparse
import csv
import math
import sys
from pathlib import Path


def rows(path):
    with open(path, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def place(row):
    return row["interface"], *(round(float(row[c]), 12) + 0.0 for c in ("x_m", "y_m", "z_m"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("static", type=Path)
    parser.add_argument("transient", type=Path)
    parser.add_argument("--which", choices=("all", "last"), default="all")
    parser.add_argument("--tolerance", type=float, default=1e-9)
    args = parser.parse_args()
    static = {place(row): row for row in rows(args.static / "static.csv")}
    found = rows(args.transient / "contact_pairs.csv")
    times = sorted({float(row["time_s"]) for row in found})
    if args.which == "last":
        found = [row for row in found if float(row["time_s"]) == times[-1]]
        times = times[-1:]
    largest = max(float(row["lambda_n_n"]) for row in static.values())
    worst, other, good = {"lambda_n_n": 0, "lambda_t_n": 0}, 0, True
    for row in found:
        mate = static[place(row)]
        friction = math.hypot(float(mate["lambda_t_n"]), float(mate["lambda_b_n"]))
        for column, value in ("lambda_n_n", float(mate["lambda_n_n"])), ("lambda_t_n", friction):
            apart = abs(float(row[column]) - value) / largest
            worst[column] = worst[column] if apart <= worst[column] else apart
            good = good and apart <= args.tolerance
        other += row["status"] != mate["status"]
    print(f"{len(static)} pairs, {len(times)} times, largest {largest:.6g} N: normal forces differ by "
          f"{worst['lambda_n_n']:.1e} of it, friction by {worst['lambda_t_n']:.1e}, {other} of another status")
    good = good and len(found) == len(static) * len(times) and largest > 0 and other == 0
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
