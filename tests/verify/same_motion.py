#!/usr/bin/env python3
"""Two transients, in folders, are the same one: each column of transient.csv and contact_pairs.csv agrees to a part of its largest value,
works and energies to that of the largest energy; numbers of pairs and statuses are the same.

    same_motion.py FOLDER OTHER --tolerance 1e-9"""

import argparse
import csv
import sys
from pathlib import Path

PATHS = ("projector_residual", "projector_sweeps", "projector_routes")  # how the laws were solved, not what they say


def rows_of(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def values(rows, name):
    """Numbers of a column, None where it has words."""
    try:
        return [float(row[name]) for row in rows]
    except ValueError:
        return None


def compare(table, first, other, tolerance):
    """Names of the columns that differ, with by how much."""
    energy = max((abs(value) for name in first[0] if name.endswith("_j") for value in values(first, name)), default=0)
    wrong = []
    for name in first[0]:
        if name in PATHS:
            continue
        a, b = values(first, name), values(other, name)
        if a is None or name.startswith("n_"):
            if [row[name] for row in first] != [row[name] for row in other]:
                wrong.append(f"{table}: {name} differs")
            continue
        scale = energy if name.endswith("_j") else max(map(abs, a))
        off = max(abs(x - y) for x, y in zip(a, b))
        if not off <= tolerance * scale:
            wrong.append(f"{table}: {name} off by {off:.2e} of {scale:.2e}, more than {tolerance:g} of it")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=Path)
    parser.add_argument("other", type=Path)
    parser.add_argument("--tolerance", type=float, required=True)
    args = parser.parse_args()
    wrong = []
    for table in ("transient.csv", "contact_pairs.csv"):
        if not (args.first / table).exists():
            continue
        first, other = rows_of(args.first / table), rows_of(args.other / table)
        if len(first) != len(other) or not first:
            sys.exit(f"{table}: {len(first)} and {len(other)} rows")
        wrong += compare(table, first, other, args.tolerance)
    if wrong:
        sys.exit("\n".join(wrong))
    statuses = {row["n_stick"] + "/" + row["n_open"] for row in rows_of(args.first / "transient.csv")}
    print(f"{len(statuses)} numbers of sticking and open pairs on the way: the same")


if __name__ == "__main__":
    main()
