#!/usr/bin/env python3
"""Compares transients of one scene by two models.

    verify/reduced.py agree FULL REDUCED COLUMN TOLERANCE

FULL and REDUCED are output folders whose rows need not stand at the same times; the largest difference of the column over the
time that both have, the second interpolated linearly to the times of the first, is relative to the largest value."""

import sys
from pathlib import Path

import numpy


def history(folder):
    return numpy.genfromtxt(Path(folder) / "transient.csv", delimiter=",", names=True)


def agree(full, reduced, column, tolerance):
    one, other = history(full), history(reduced)
    one = one[one["time_s"] <= other["time_s"][-1]]
    miss = numpy.abs(numpy.interp(one["time_s"], other["time_s"], other[column]) - one[column]).max()
    largest = numpy.abs(one[column]).max()
    print(f"{column}: off by {miss:.3g} of {largest:.6g} at most: {miss / largest:.1e}, may be {tolerance}")
    return not (len(one) > 10 and miss < float(tolerance) * largest)


if __name__ == "__main__":
    sys.exit({"agree": agree}[sys.argv[1]](*sys.argv[2:]))
