#!/usr/bin/env python3
"""A sweep of the model of tests/affine.py over its speed beside LAPACK on the companion form: every eigenvalue of every point,
and every onset where the growth that LAPACK has crosses zero.

    affine.py RESULTS N [BAND]   of N unknowns; modes below BAND (Hz) only"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import numpy
import scipy.optimize

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from affine import eigenvalue_near, eigenvalues, model

EIGENVALUE, ONSET = 1e-9, 1e-8  # relative; relative to the speed


def rows(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def compare_points(found, matrices, band):
    """The largest relative distance of any eigenvalue, and how many there are."""
    worst, n = 0, 0
    for w, values in found.items():
        exact = eigenvalues(matrices, w)
        exact = exact[(exact.imag > 0) & (exact.imag < 2 * numpy.pi * band)]
        if len(exact) != len(values):
            sys.exit(f"speed {w}: {len(values)} eigenvalues, LAPACK has {len(exact)}")
        distance = abs(numpy.array(values)[:, None] - exact[None, :])
        rank, place = scipy.optimize.linear_sum_assignment(distance)
        worst, n = max(worst, (distance[rank, place] / abs(exact[place])).max()), n + len(exact)
    return worst, n


def growth(matrices, w, omega):
    """Of the eigenvalue nearest to i omega."""
    return eigenvalue_near(matrices, w, 1j * omega).real


def compare_onsets(onsets, matrices):
    """The largest distance of an onset from the zero of its growth, relative."""
    worst = 0
    for row in onsets:
        w, omega = float(row["critical_value"]), 2 * numpy.pi * float(row["freq_hz"])
        zero = scipy.optimize.brentq(lambda v: growth(matrices, v, omega), w * (1 - 1e-5), w * (1 + 1e-5), xtol=1e-14 * w)
        worst = max(worst, abs(zero / w - 1))
    return worst


def main():
    results, matrices = Path(sys.argv[1]), model(int(sys.argv[2]))
    band = float(sys.argv[3]) if len(sys.argv) > 3 else numpy.inf
    found, unstable = defaultdict(list), {}
    for row in rows(results / "sweep.csv"):
        found[float(row["value"])].append(complex(float(row["growth_rad_s"]), 2 * numpy.pi * float(row["freq_hz"])))
    worst, n = compare_points(found, matrices, band)
    print(f"{n} eigenvalues of {len(found)} points within {worst:.1e} of LAPACK's")
    onsets = rows(results / "onsets.csv")
    for w, values in found.items():
        unstable[w] = sum(value.real > 0 for value in values)
        passed = [row["kind"] for row in onsets if float(row["critical_value"]) < w]
        expected = unstable[min(found)] + sum(kind in ("lock_in", "negative_damping") for kind in passed)
        expected -= sum(kind in ("lock_out", "positive_damping") for kind in passed)
        if expected != unstable[w]:
            sys.exit(f"speed {w}: {unstable[w]} unstable, the onsets before it make {expected}")
    off = compare_onsets(onsets, matrices)
    print(f"{len(onsets)} onsets within {off:.1e} of LAPACK's")
    if not onsets or n < 100 or not worst < EIGENVALUE or not off < ONSET:
        sys.exit("FAILED")


if __name__ == "__main__":
    main()
