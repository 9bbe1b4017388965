#!/usr/bin/env python3
"""modes_sensitivities.csv beside central differences of other runs:

    derivatives.py RESULTS PARAMETER LOWER VALUE UPPER VALUE [--tolerance 1e-6]

LOWER and UPPER are folders of runs with other values of the parameter, one on each side, as near as their modes.csv still tells. An error
is compared with the largest relative derivative of its mode, |p d lambda / d p| over all parameters."""

import argparse
import csv
import math
import sys
from pathlib import Path


def read(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def eigenvalues(folder):
    return [complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in read(folder / "modes.csv")]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("results", type=Path)
    parser.add_argument("parameter")
    parser.add_argument("lower", type=Path)
    parser.add_argument("low", type=float)
    parser.add_argument("upper", type=Path)
    parser.add_argument("high", type=float)
    parser.add_argument("--tolerance", type=float, default=1e-6)
    given = parser.parse_args()
    own, low, high = (eigenvalues(folder) for folder in (given.results, given.lower, given.upper))
    rows = read(given.results / "modes_sensitivities.csv")
    worst, compared = 0.0, 0
    for row in rows:
        if row["parameter"] != given.parameter:
            continue
        mode = int(row["mode"]) - 1
        of_mode = [other for other in rows if other["mode"] == row["mode"]]
        scale = max(abs(float(other["value"])) * abs(complex(float(other["growth_rad_s_per_unit"]),
                                                             2 * math.pi * float(other["freq_hz_per_unit"]))) for other in of_mode)
        ends = [min(found, key=lambda value: abs(value - own[mode])) for found in (low, high)]
        difference = (ends[1] - ends[0]) / (given.high - given.low)
        stated = complex(float(row["growth_rad_s_per_unit"]), 2 * math.pi * float(row["freq_hz_per_unit"]))
        percent = complex(float(row["growth_rad_s_per_percent"]), 2 * math.pi * float(row["freq_hz_per_percent"]))
        error = max(abs(stated - difference), abs(percent - 0.01 * float(row["value"]) * stated) / max(abs(float(row["value"])), 1e-300))
        size = max(abs(float(row["value"])), abs(given.high - given.low))
        worst, compared = max(worst, error * size / scale), compared + 1
    print(f"{compared} modes, {given.parameter}: worst {worst:.1e} of the mode's largest derivative")
    return 0 if compared and worst <= given.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
