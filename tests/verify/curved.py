#!/usr/bin/env python3
"""Order of the normals of pairs on a cylinder: curved.py RADIUS MINIMUM FOLDER FOLDER [...], each mesh twice as fine.

tests/boxes.py --cylinder bends planes; slaves slide along its y. A pair's direction of slip t in static.csv is across its
normal, so that its distance from (0, cos, -sin) of the angle of the slave is the error of the normal. The largest error
falls at least with the order MINIMUM from each mesh to the next. Exit status: 0, or 1.
"""

import csv
import math
import sys
from pathlib import Path


def error(folder, radius):
    with (Path(folder) / "static.csv").open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    worst = 0
    for row in rows:
        angle = math.asin(float(row["y_m"]) / radius)
        t = [float(row[f"t_{axis}"]) for axis in "xyz"]
        worst = max(worst, math.dist(t, (0, math.cos(angle), -math.sin(angle))))
    return worst


def main():
    radius, minimum = float(sys.argv[1]), float(sys.argv[2])
    errors = [error(folder, radius) for folder in sys.argv[3:]]
    orders = [math.log2(coarse / fine) for coarse, fine in zip(errors, errors[1:])]
    print("errors of the normals", *(f"{e:.2e}" for e in errors), "orders", *(f"{o:.2f}" for o in orders))
    return 0 if orders and min(orders) > minimum else 1


if __name__ == "__main__":
    sys.exit(main())
