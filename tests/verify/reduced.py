#!/usr/bin/env python3
"""Compares transients of one scene by two models.

    verify/reduced.py agree FULL REDUCED COLUMN TOLERANCE
    verify/reduced.py lift FIELDS SNAPSHOT TOLERANCE
    verify/reduced.py verified RUN FINER HIGHER
    verify/reduced.py accelerates RUN PROBE TOLERANCE

FULL and REDUCED are output folders whose rows need not stand at the same times; the largest difference of the column over the
time that both have, the second interpolated linearly to the times of the first, is relative to the largest value.

RUN has said in RUN.log beside its folder what half the step and a higher cut-off change in the last half of its time: the rms of
the force, relative, and the share of the time without contact. FINER and HIGHER are such runs, all with rows at the steps of RUN.

The mean acceleration of PROBE in the last half of RUN is the change of its velocity over that time, in each direction to TOLERANCE, m/s^2.

FIELDS and SNAPSHOT are files with displacements of one mesh; the largest difference is relative to the largest displacement."""

import re
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


def measured(folder):
    """Rms of the force about its mean and share of the steps without one, in the last half of the steps."""
    force = history(folder)["normal_force_n"][1:]
    last = force[len(force) // 2:]
    return last.std(), (last <= 0).mean()


def verified(*folders):
    text = (Path(folders[0]).parent / (Path(folders[0]).name.rpartition("-")[0] + ".log")).read_text()
    said = re.findall(r"its rms by (\S+) \+- \S+, the time without contact by (\S+) \+-", text)
    one, *others = map(measured, folders)
    found = [(rms / one[0] - 1, share - one[1]) for rms, share in others]
    print(f"shares of the time without contact {one[1]:.3g}, {', '.join(f'{share:.3g}' for _, share in others)}; rms and share change by "
          f"{found}, said {said}")
    near = all(abs(float(word) - value) <= 0.006 * abs(float(word)) + 1e-9  # of three digits
               for words, values in zip(said, found) for word, value in zip(words, values))
    return not (len(said) == 2 and near and 0 < one[1] < 1 and any(share for _, share in found))


def accelerates(run, probe, tolerance):
    rows = history(run)
    last = rows[len(rows) // 2:]
    step, miss = numpy.diff(last["time_s"]), []
    for d in "xyz":
        v, a = last[f"{probe}_v{d}_m_s"], last[f"{probe}_a{d}_m_s2"]
        miss.append(abs((step * (a[1:] + a[:-1]) / 2).sum() - (v[-1] - v[0])) / step.sum())
    print(f"mean acceleration beside the change of velocity: off by {', '.join(f'{x:.2e}' for x in miss)} m/s^2, may be {tolerance}")
    return not (len(last) > 100 and 0 < max(miss) < float(tolerance))


if __name__ == "__main__":
    sys.exit({"agree": agree, "lift": lift, "verified": verified, "accelerates": accelerates}[sys.argv[1]](*sys.argv[2:]))
