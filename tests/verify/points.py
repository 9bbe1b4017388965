#!/usr/bin/env python3
"""Eigenvalues of a sweep against single runs of -analysis modes.

    verify/points.py SWEEP RTOL VALUE[,VALUE_2]=FOLDER ...

Every point of the sweep must be named. Each eigenvalue of a point is compared with the nearest one of the run, which
must have as many; RTOL is relative to |lambda|.
"""

import csv
import math
import sys
from pathlib import Path

from convergence import Judge


def eigenvalues(path):
    """Value of the parameters as numbers -> eigenvalues; the one of a table of modes is ()."""
    points = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            point = tuple(float(row[key]) for key in ("value", "value_2") if row.get(key))
            eigenvalue = complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
            points.setdefault(point, []).append(eigenvalue)
    return points


def distance(values, references):
    """Largest relative distance of eigenvalues from the nearest of the references, each of which serves once."""
    if len(values) != len(references):
        return math.inf
    free, worst = list(references), 0
    for value in values:
        reference = min(free, key=lambda other: abs(other - value))
        free.remove(reference)
        worst = max(worst, abs(value - reference) / abs(reference))
    return worst


def main(sweep, rtol, *runs):
    judge = Judge()
    points = eigenvalues(Path(sweep) / "sweep.csv")
    runs = {tuple(map(float, text.split("=")[0].split(","))): Path(text.split("=")[1]) for text in runs}
    print(f"{len(points)} points, {len(runs)} runs{judge.within(len(points), len(runs), len(runs))}")
    for point, folder in runs.items():
        alone = eigenvalues(folder / "modes.csv")[()]
        apart = distance(points.get(point, []), alone)
        print(f"{point}: {len(alone)} eigenvalues, farthest {apart:.3g}{judge.within(apart, 0, float(rtol))}")
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
