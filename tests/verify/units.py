#!/usr/bin/env python3
"""Units of parameters in a table: verify/units.py parameters.csv NAME=UNIT ..."""

import csv
import sys
from pathlib import Path


def main():
    with Path(sys.argv[1]).open(newline="") as file:
        found = {row["parameter"]: row["unit"] for row in csv.DictReader(file)}
    wrong = [text for text in sys.argv[2:] if found.get(text.partition("=")[0]) != text.partition("=")[2]]
    if wrong:
        raise SystemExit(f"not so: {wrong}, found {found}")


if __name__ == "__main__":
    main()
