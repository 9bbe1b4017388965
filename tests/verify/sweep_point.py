#!/usr/bin/env python3
"""Eigenvalues of a sweep at one value beside those of a run of modes with that value: verify/sweep_point.py SWEEP VALUE[,VALUE_2]
MODES LOW HIGH RTOL, all those from LOW to HIGH Hz, in order."""

import csv
import sys
from pathlib import Path

import numpy


def eigenvalues(table, keep):
    """Growth and angular frequency of the rows to keep, in order of frequency and growth."""
    with Path(table).open(newline="") as file:
        rows = [(float(row["freq_hz"]), float(row["growth_rad_s"])) for row in csv.DictReader(file) if keep(row)]
    return numpy.array([complex(growth, 2 * numpy.pi * frequency) for frequency, growth in sorted(rows)
                        if low <= frequency <= high])


sweep, value, modes = sys.argv[1:4]
low, high, tolerance = map(float, sys.argv[4:])
asked = dict(zip(("value", "value_2"), map(float, value.split(","))))
one = eigenvalues(f"{sweep}/sweep.csv", lambda row: all(float(row[name]) == number for name, number in asked.items()))
other = eigenvalues(f"{modes}/modes.csv", lambda row: True)
print(f"{len(one)} and {len(other)} eigenvalues from {low:g} to {high:g} Hz: {one}, {other}")
if not len(one) or len(one) != len(other) or not (abs(one - other) <= tolerance * abs(other)).all():
    raise SystemExit(1)
