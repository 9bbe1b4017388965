#!/usr/bin/env python3
"""Second paths of transients, NAME=FOLDER each, at most LIMIT off, in the last row of transient.csv: stiffness, friction and momentum.
At least five steps must have been looked at, with friction that works. Prints measured and allowed.

    laws.py LIMIT NAME=FOLDER..."""

import csv
import sys
from pathlib import Path

ERRORS = ("stiffness_error", "friction_error", "momentum_error")


def main():
    limit, failed = float(sys.argv[1]), False
    for name, folder in (word.split("=") for word in sys.argv[2:]):
        with (Path(folder) / "transient.csv").open() as file:
            last = [{key: float(cell) for key, cell in row.items()} for row in csv.DictReader(file)][-1]
        print(f"{name}: {last['looks']:.0f} looks,", ", ".join(f"{key} {last[key]:.1e}" for key in ERRORS), f"allowed {limit:.0e}")
        failed |= last["looks"] < 5 or not last["friction_heat_j"] > 0
        failed |= not all(0 <= last[key] <= limit for key in ERRORS)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
