#!/usr/bin/env python3
"""Normal law of a contact with a stiffness per area, from static.csv: at each closed pair lambda_n = -kn area gap, and
all lambda_n add up to the force. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=Path, help="static.csv")
    parser.add_argument("--kn", type=float, required=True, help="N/m^3")
    parser.add_argument("--force", type=float, required=True, help="N")
    parser.add_argument("--rtol", type=float, default=1e-9)
    args = parser.parse_args()
    with args.table.open(newline="") as lines:
        rows = [row for row in csv.DictReader(lines) if row["status"] != "open"]
    force = [float(row["lambda_n_n"]) for row in rows]
    law = [-args.kn * float(row["area_m2"]) * float(row["gap_m"]) for row in rows]
    worst = max(abs(a - b) for a, b in zip(force, law)) / max(force)
    print(f"{len(rows)} closed pairs, the law to {worst:.1e}, {sum(force)!r} N in all")
    return 0 if worst < args.rtol and abs(sum(force) / args.force - 1) < args.rtol else 1


if __name__ == "__main__":
    sys.exit(main())
