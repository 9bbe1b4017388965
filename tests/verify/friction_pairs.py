#!/usr/bin/env python3
"""Friction over normal force of each pair of static.csv where the master turns with 0.5 rad/s about x = -0.2 m, against
0.3 + 0.2 exp(-v / 0.05) at the speed v of the pair: verify/friction_pairs.py FOLDER. To 1e-12."""

import csv
import math
import sys
from pathlib import Path


def main():
    with (Path(sys.argv[1]) / "static.csv").open(newline="", encoding="utf-8") as file:
        rows = [{name: float(row[name]) for name in ("x_m", "y_m", "lambda_n_n", "lambda_t_n")} for row in csv.DictReader(file)
                if row["status"] != "open"]
    speed = [0.5 * math.hypot(row["x_m"] + 0.2, row["y_m"]) for row in rows]
    off = max(abs(row["lambda_t_n"] / row["lambda_n_n"] - 0.3 - 0.2 * math.exp(-v / 0.05)) for row, v in zip(rows, speed))
    print(f"{len(rows)} pairs at {min(speed):.3g} to {max(speed):.3g} m/s, off by {off:.1e}")
    if len(rows) < 9 or not off <= 1e-12:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
