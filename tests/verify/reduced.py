#!/usr/bin/env python3
"""Compares transients of one scene by two models.

    verify/reduced.py agree FULL REDUCED COLUMN TOLERANCE
    verify/reduced.py lift FIELDS SNAPSHOT TOLERANCE

FULL and REDUCED are output folders whose rows need not stand at the same times; the largest difference of the column over the
time that both have, the second interpolated linearly to the times of the first, is relative to the largest value.

FIELDS and SNAPSHOT are files with displacements of one mesh; the largest difference is relative to the largest displacement."""

import sys
from pathlib import Path

import h5py
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


def lift(fields, snapshot, tolerance):
    one, other = (h5py.File(path)["VTKHDF/PointData/displacement_m"][()] for path in (fields, snapshot))
    miss, largest = numpy.abs(one - other).max(), numpy.abs(one).max()
    print(f"displacements of {len(one)} nodes: off by {miss:.3g} of {largest:.6g} m: {miss / largest:.1e}, may be {tolerance}")
    return not 0 < miss < float(tolerance) * largest


if __name__ == "__main__":
    sys.exit({"agree": agree, "lift": lift}[sys.argv[1]](*sys.argv[2:]))
