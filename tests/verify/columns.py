#!/usr/bin/env python3
"""A column of one table beside that of another, row by row: |a - b| <= atol + rtol |b|.

    columns.py A.csv COLUMN B.csv COLUMN RTOL [ATOL]"""

import csv
import sys


def column(path, name):
    with open(path, newline="", encoding="utf-8") as rows:
        return [float(row[name]) for row in csv.DictReader(rows)]


def main():
    a, b = column(*sys.argv[1:3]), column(*sys.argv[3:5])
    rtol, atol = float(sys.argv[5]), float(sys.argv[6]) if len(sys.argv) > 6 else 0.0
    worst = max((abs(x - y) / (atol + rtol * abs(y)) for x, y in zip(a, b)), default=float("inf"))
    print(f"{len(a)} and {len(b)} rows, worst {worst:.2g} of what is allowed")
    return 0 if len(a) == len(b) > 0 and worst <= 1 else 1


if __name__ == "__main__":
    sys.exit(main())
