#!/usr/bin/env python3
"""Maxwell's reciprocity of two runs, one with the force on probe A, the other on probe B, in two columns of frf.csv:

    reciprocity.py A/frf.csv B_z B/frf.csv A_z --rtol 1e-9      H_BA = H_AB at every frequency
    ... --violated 0.1                                          or: they differ by at least this much somewhere

The difference is relative to the larger of both. Exit status: 0, or 1.
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
    limits = parser.add_mutually_exclusive_group(required=True)
    limits.add_argument("--rtol", type=float)
    limits.add_argument("--violated", type=float)
    args = parser.parse_args()
    pairs = list(zip(column(args.first, args.first_column), column(args.second, args.second_column), strict=True))
    worst = max(abs(a - b) / max(abs(a), abs(b)) for a, b in pairs)
    print(f"{len(pairs)} frequencies, largest difference {worst:.2e}")
    return 0 if (worst <= args.rtol if args.rtol else worst >= args.violated) else 1


if __name__ == "__main__":
    sys.exit(main())
