#!/usr/bin/env python3
"""Tables of -analysis design beside closed forms and scipy's SLSQP.

    design.py spin RESULTS          growth begins at k = w^2 (n^2 / c^2 - g n / c - e): k and c are changed, w and n uncertain
    design.py hidden RESULTS        the same with n / b, b uncertain: no scenario has the worst corner, which corners in full find
    design.py oscillator RESULTS    two modes lock in at ((a - b) / 2)^2 + 1 - 4/3 mu = 0: a and b are changed, mu is uncertain
    design.py share RESULTS         the same, where a fifth of the scenarios may stay unstable
    design.py state RESULTS MODES.. about a sliding state: corners in full, and the largest growth of all scenarios, beside -analysis modes
                                    of the scene with the values of each, first the scene's own, then the corners in their order"""

import csv
import sys
from pathlib import Path

import numpy
from scipy.optimize import minimize

N_RANDOM = 20000
FAULTS = []
# design and uncertain parameters: own value and half width; what is positive where it is stable; the worst corner
SCENES = {
    "spin": ({"k": (1, 0.5), "c": (0.25, 0.125)}, {"speed": (2, 0.6), "n": (0.1, 0.03)},
             lambda k, c, speed, n: k - speed**2 * (n**2 / c**2 - 0.1 * n / c - 0.01)),
    "hidden": ({"k": (1, 0.5), "c": (0.25, 0.2375)}, {"speed": (2, 0.6), "n": (0.1, 0.03), "b": (1, -0.2)},
               lambda k, c, speed, n, b: k - speed**2 * (n**2 / (b * c)**2 - 0.1 * n / (b * c) - 0.01)),
    "oscillator": ({"a": (2.1, 1.05), "b": (2, 1)}, {"mu": (0.75, 0.15)}, lambda a, b, mu: ((a - b) / 2)**2 + 1 - 4 / 3 * mu)}


def check(what, holds, value):
    print(f"{'ok  ' if holds else 'FAIL'} {what}: {value}")
    if not holds:
        FAULTS.append(what)


def read(path):
    """Rows."""
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def state(folder, modes):
    """The same brake, solved elsewhere."""
    growth = []
    for name in modes:
        worst = max(read(Path(name, "modes.csv")), key=lambda row: float(row["growth_rad_s"]))
        growth.append((float(worst["growth_rad_s"]), float(worst["freq_hz"])))
    for row, (sigma, freq) in zip(read(folder / "design_corners.csv"), growth[1:], strict=True):
        check("corner", abs(float(row["growth_rad_s"]) - sigma) <= 1e-6 * freq and abs(float(row["freq_hz"]) - freq) <= 1e-7 * freq,
              (row["closed_pairs"], row["growth_rad_s"], sigma, row["freq_hz"], freq))
    first = read(folder / "design.csv")[0]
    sigma, freq = max(growth)
    corner = read(folder / "design_corners.csv")[0]
    found = float(first["excess_rad_s"]) - float(corner["excess_rad_s"]) + float(corner["growth_rad_s"])  # limit and all
    near = abs(found - sigma) <= 1e-4 * 2 * numpy.pi * freq and abs(float(first["freq_hz"]) - freq) <= 1e-4 * freq
    check("largest of all scenarios", near, (found, sigma))
    check("statuses differ", int(first["statuses"]) > 1 and first["other_statuses"] == "0", first["statuses"])
    return 1 if FAULTS else 0


def main(which, folder, *others):
    if which == "state":
        return state(Path(folder), others)
    design, uncertain, margin = SCENES[which.replace("share", "oscillator")]
    with Path(folder, "design.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    last = next(row for row in rows if row["found"] == "1")
    own, half = (numpy.array([pair[i] for pair in design.values()]) for i in (0, 1))
    found = numpy.array([float(last[name]) for name in design])
    centre, width = (numpy.array([pair[i] for pair in uncertain.values()]) for i in (0, 1))
    random = numpy.random.default_rng(1)
    points = random.uniform(centre - abs(width), centre + abs(width), (N_RANDOM, len(centre))).T
    check("the scene is unstable somewhere", (margin(*own, *points) < 0).any(), int(rows[0]["unstable_scenarios"]))
    change = numpy.sqrt((((found - own) / half)**2).mean())
    check("change as stated", abs(change - float(last["change"])) < 1e-9, change)
    unstable = (margin(*found, *points) < 0).mean()
    if which == "share":
        check("a share of what is uncertain stays unstable", 0 < unstable < 0.25, unstable)
        return 1 if FAULTS else 0
    check("no random point of the box is unstable", unstable == 0, unstable)
    worst = centre + width
    best = min((minimize(lambda z: (z**2).sum(), start, constraints={"type": "ineq", "fun": lambda z: margin(*(own + half * z), *worst)},
                         bounds=[(-1, 1)] * len(own), method="SLSQP") for start in random.uniform(-1, 1, (20, len(own)))),
               key=lambda result: result.fun if result.success else numpy.inf)
    least = numpy.sqrt(best.fun / len(own))
    check("change beside the least", least * 0.999 <= change <= 1.15 * least, f"{change:.4f} and {least:.4f}")
    check("the full solution says so",
          last["solved"] == "1" and float(last["full_excess_rad_s"]) <= 0, last["full_excess_rad_s"])
    with Path(folder, "design_corners.csv").open(newline="") as table:
        corners = list(csv.DictReader(table))
    check("in full at corners and points", len(corners) == 20 and all(row["unstable"] == "0" for row in corners), len(corners))
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
