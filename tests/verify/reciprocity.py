#!/usr/bin/env python3
"""Maxwell's reciprocity of two runs, one with the force on probe A, the other on probe B, in two columns of frf.csv:

    reciprocity.py A/frf.csv B_z B/frf.csv A_z --rtol 1e-9      H_BA = H_AB at every frequency
    ... --violated 0.1                                          or: they differ by at least this much somewhere
    ... --as C/frf.csv B_z D/frf.csv A_z --rtol 1e-8            or: they differ as two other runs do

The difference is relative to the larger of both; what is compared of two differences too. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path


def column(path, name):
    """One complex column."""
    with path.open(newline="") as lines:
        return [complex(float(row[f"{name}_re_m_n"]), float(row[f"{name}_im_m_n"])) for row in csv.DictReader(lines)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("first", "second"):
        parser.add_argument(name, type=Path)
        parser.add_argument(f"{name}_column")
    parser.add_argument("--as", dest="other", nargs=4, help="the other runs, by files and columns")
    limits = parser.add_mutually_exclusive_group(required=True)
    limits.add_argument("--rtol", type=float)
    limits.add_argument("--violated", type=float)
    args = parser.parse_args()
    pairs = list(zip(column(args.first, args.first_column), column(args.second, args.second_column), strict=True))
    other = [(0, 0)] * len(pairs)
    if args.other:
        first, first_column, second, second_column = args.other
        other = list(zip(column(Path(first), first_column), column(Path(second), second_column), strict=True))
    worst = max(abs((a - b) - (c - d)) / max(abs(a), abs(b)) for (a, b), (c, d) in zip(pairs, other, strict=True))
    print(f"{len(pairs)} frequencies, largest difference {worst:.2e}")
    return 0 if (worst <= args.rtol if args.rtol else worst >= args.violated) else 1


if __name__ == "__main__":
    sys.exit(main())
