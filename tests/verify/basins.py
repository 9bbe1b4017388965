#!/usr/bin/env python3
"""Judges disturbed runs of a map.

    verify/basins.py squeal MAP BRANCH       beside the branch of limit cycles (cycle.csv of -analysis cycle) over the same
                                             parameter: none squeals below its fold, all above its onset, some and not all
                                             between; rms of the stable cycles to 2 % and their main line to 2e-3, of SETTLED
                                             runs at least, within the branch; probabilities and intervals by scipy; each row
                                             of map_basins.csv is that of its runs
    verify/basins.py seeds MAP OTHER ENERGY  another seed has other runs, each of that energy (J)"""

import csv
import sys
from pathlib import Path

import numpy

REST = "stable"
SETTLED = 5  # runs whose loudness and main line are compared, at least


def rows(folder, name):
    with (Path(folder) / name).open(newline="") as file:
        return list(csv.DictReader(file))


def interval(k, n):
    """By the quantiles of the beta distribution."""
    from scipy.stats import beta
    return (beta.ppf(0.025, k, n - k + 1) if k else 0, beta.ppf(0.975, k + 1, n - k) if k < n else 1)


def stable_cycle(branch, value):
    """rms and main line of the stable cycle at a value, straight between its neighbours on the branch; none beyond its ends."""
    found = sorted((float(row["value"]), float(row["force_rms_n"]), float(row["freq_hz"])) for row in branch
                   if row["kind"] == "cycle" and float(row["multiplier_abs"]) < 1)
    x, level, line = map(numpy.array, zip(*found))
    return [numpy.interp(value, x, y, left=numpy.nan, right=numpy.nan) for y in (level, line)]


def told(runs, basins):
    """Rows of map_basins.csv that are not those of the runs of map_disturbed.csv, or whose interval is another one."""
    wrong = []
    for row in basins:
        own = [run for run in runs if run["point"] == row["point"] and run["regime"] == row["regime"]]
        both = [other for other in basins if other["point"] == row["point"] and other["regime"] == row["regime"]]
        k, n = int(row["runs"]), int(row["of"])
        low, high = interval(k, n)
        good = sum(int(other["runs"]) for other in both) == len(own) and n == sum(run["point"] == row["point"] for run in runs)
        good = good and abs(float(row["probability"]) - k / n) < 1e-12
        good = good and abs(float(row["probability_low"]) - low) < 1e-9 and abs(float(row["probability_high"]) - high) < 1e-9
        if len(both) == 1:
            good = good and abs(float(row["force_rms_n"]) / numpy.mean([float(run["force_rms_n"]) for run in own]) - 1) < 1e-9
        wrong += [row] * (not good)
    return wrong


def squeal(folder, branch):
    runs, basins, branch = rows(folder, "map_disturbed.csv"), rows(folder, "map_basins.csv"), rows(branch, "cycle.csv")
    fold = min(float(row["value"]) for row in branch if row["kind"] == "fold")
    onset = float(branch[0]["value"])
    below, between, above = [], [], []
    for run in runs:
        value = float(run["value"])
        (below if value < fold else above if value > onset else between).append(run)
    loud = [[run for run in group if run["regime"] != REST] for group in (below, between, above)]
    print(f"fold {fold:.6g}, onset {onset:.6g}: " + ", ".join(f"{len(some)} of {len(group)} squeal {where}" for some, group, where in
          zip(loud, (below, between, above), ("below the fold", "between", "above the onset"))))
    good = below and above and not loud[0] and len(loud[2]) == len(above) and 0 < len(loud[1]) < len(between)
    settled = [run for group in loud for run in group if run["status"] == "settled"]
    print(f"{len(settled)} settled runs beside the stable cycles")
    good = good and len(settled) >= SETTLED
    for run in settled:
        level, line = stable_cycle(branch, float(run["value"]))
        off = float(run["force_rms_n"]) / level - 1, float(run["freq_hz"]) / line - 1
        if not (abs(off[0]) < 0.02 and abs(off[1]) < 2e-3):
            print(f"at {run['value']} run {run['run']}: rms off by {off[0]:.1e}, main line by {off[1]:.1e}")
            good = False
    wrong = told(runs, basins)
    print(f"{len(basins)} kinds, {len(wrong)} told wrongly")
    energy = numpy.log10([float(run["energy_j"]) for run in runs])
    print(f"energies 10^{energy.min():.3f} to 10^{energy.max():.3f} J, mean {energy.mean():.3f}")
    return bool(good) and not wrong and energy.min() >= -5 and energy.max() <= -1 and abs(energy.mean() + 3) < 0.6


def seeds(folder, other, energy):
    one, two = rows(folder, "map_disturbed.csv"), rows(other, "map_disturbed.csv")
    alike = sum(a["force_rms_n"] == b["force_rms_n"] for a, b in zip(one, two))
    repeated = len(one) - len({run["force_rms_n"] for run in one})
    print(f"{len(one)} and {len(two)} runs, {alike} the same with another seed, {repeated} repeated")
    return len(one) == len(two) > 0 == alike == repeated and all(abs(float(run["energy_j"]) / float(energy) - 1) < 1e-12 for run in one)


if __name__ == "__main__":
    sys.exit(not {"squeal": squeal, "seeds": seeds}[sys.argv[1]](*sys.argv[2:]))
