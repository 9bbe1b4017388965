#!/usr/bin/env python3
"""Compares the frequency responses of two runs, frf.csv, at the frequencies of the second.

The root of the sum of squares of all differences beside that of the response must be at most `--rtol`. With
`--estimate` the error that the first run states must be within that factor of the true one, wherever this is above
`--floor`, and there must be at least `--count` such frequencies; below, it may not be more than the factor times the
floor. Exit status: 0, or 1.
"""

import argparse
import csv
import math
import sys
from pathlib import Path


def response(path):
    """Frequency -> (response of each output by name, stated error)."""
    with path.open(newline="") as lines:
        rows = [{key: float(cell) for key, cell in row.items()} for row in csv.DictReader(lines)]
    names = [key.removesuffix("_re_m_n") for key in rows[0] if key.endswith("_re_m_n")]
    return {row["freq_hz"]: ({name: complex(row[f"{name}_re_m_n"], row[f"{name}_im_m_n"]) for name in names},
                             row["error_m_n"]) for row in rows}


def length(values):
    return math.sqrt(sum(abs(value)**2 for value in values))


def compare(first, second):
    """For each frequency of the second: itself, true error and stated error beside the response."""
    for freq, (truth, _) in second.items():
        found, stated = first[min(first, key=lambda other: abs(other - freq))]
        size = length(truth.values())
        yield freq, length(found[name] - truth[name] for name in truth) / size, stated / size


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path)
    parser.add_argument("--rtol", type=float, required=True)
    parser.add_argument("--estimate", type=float)
    parser.add_argument("--floor", type=float, default=1e-9)
    parser.add_argument("--count", type=int, default=1)
    args = parser.parse_args()
    rows = list(compare(response(args.first), response(args.second)))
    faults = [f"{freq:.6g} Hz: error {true:.2e}" for freq, true, _ in rows if not true <= args.rtol]
    if args.estimate:
        told = [(freq, true, stated) for freq, true, stated in rows if true > args.floor]
        faults += [f"{freq:.6g} Hz: error {true:.2e}, stated {stated:.2e}" for freq, true, stated in told
                   if not true / args.estimate <= stated <= true * args.estimate]
        faults += [f"{freq:.6g} Hz: error {true:.2e}, stated {stated:.2e}" for freq, true, stated in rows
                   if true <= args.floor and stated > args.floor * args.estimate]
        faults += [f"only {len(told)} errors above {args.floor}"] if len(told) < args.count else []
    print("\n".join(faults) or f"{len(rows)} frequencies, largest error {max(row[1] for row in rows):.1e}")
    return 1 if faults or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
