#!/usr/bin/env python3
"""Derivatives of a sweep against central differences of full solutions: verify/sensitivities.py SWEEP POINT PARAMETER
LESS MORE. LESS and MORE are folders of modes at half a percent to both sides, so that the differences err by some 1e-5
of a change; modes within a percent of each other are left out, since their frequencies are no smooth functions of a
parameter alone."""

import csv
import math
import sys
from pathlib import Path

LARGEST, OWN = 2e-3, 1e-2  # of the largest derivative, and of each: curvature over half a percent to both sides, most of it
FLOOR = 0.05  # where another mode is near; smaller ones are compared as if they were this part of the largest
STEP = 0.005


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def modes_of(folder):
    return sorted(float(row["freq_hz"]) for row in read(Path(folder) / "modes.csv"))


def main():
    sweep, point, parameter, less, more = sys.argv[1:]
    rows = [row for row in read(Path(sweep) / "sensitivities.csv")
            if row["point"] == point and row["parameter"] == parameter]
    rows.sort(key=lambda row: float(row["freq_hz"]))
    low, high = modes_of(less), modes_of(more)
    if not rows or not len(rows) == len(low) == len(high):
        raise SystemExit(f"{len(rows)} derivatives, {len(low)} and {len(high)} modes")
    frequencies = [float(row["freq_hz"]) for row in rows]
    derivatives = [100 * float(row["freq_hz_per_percent"]) for row in rows]
    differences = [(b - a) / (2 * STEP) for a, b in zip(low, high)]
    largest = max(map(abs, derivatives))
    checked = 0
    for i, frequency in enumerate(frequencies):
        gap = min((abs(other - frequency) for j, other in enumerate(frequencies) if j != i), default=math.inf)
        if gap < 0.01 * frequency:
            continue
        checked += 1
        allowed = min(LARGEST * largest, OWN * max(abs(differences[i]), FLOOR * largest))
        if abs(derivatives[i] - differences[i]) > allowed:
            raise SystemExit(f"{frequency:g} Hz: derivative {derivatives[i]:g} Hz, difference {differences[i]:g} Hz")
    if checked < len(rows) // 2:
        raise SystemExit(f"only {checked} of {len(rows)} modes are simple")
    print(f"{checked} derivatives by {parameter} agree with differences")


if __name__ == "__main__":
    main()
