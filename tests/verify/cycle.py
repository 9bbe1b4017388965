#!/usr/bin/python3
"""A limit cycle of cycle.csv beside the end of the transient that it was found from: frequency by the times at which the
normal force rises through its mean, rms and largest force of whole periods; rms and peaks of probes where there are any.

    cycle.py FOLDER FREQUENCY FORCE [PROBE]   largest relative differences
    cycle.py errors COARSE FINER LATER PART   what COARSE states beside its differences to FINER, of twice the steps, 4/3 of them, and to
                                        LATER, whose steps lie elsewhere: the rest is 3/4 to 3 times those; of multipliers twice the
                                        former at least
    cycle.py cutoff LOWER HIGHER VALUE LEAST MOST   errors of the cut-off that LOWER states beside its differences to HIGHER at a value of
                                        the parameter, LEAST to MOST times them: frequency, rms, largest force, multiplier
    cycle.py fold COARSE FINE MOST      whether COARSE finds the fold of FINE to the error that it states, and that is MOST times
                                        the truth at most
    cycle.py within COARSE FINE VALUE MOST   whether COARSE is FINE to the error that FINE or COARSE states, at a value of the
                                        parameter, and that error at most MOST of the result
    cycle.py same BRANCH VALUE SINGLE FREQUENCY FORCE   the cycle of a branch at a value of its parameter beside the one that SINGLE
                                        found without a branch: largest relative differences"""

import csv
import sys
from pathlib import Path

import numpy

PERIODS = 40


def read(folder, name):
    """Columns of a table."""
    return numpy.atleast_1d(numpy.genfromtxt(Path(folder) / name, delimiter=",", names=True))


STATED = ("freq_hz", "freq_error_hz"), ("force_rms_n", "force_rms_error_n"), ("force_peak_n", "force_peak_error_n")


def errors(coarse, finer, later, part):
    """Whether a stated error is off."""
    a, b, c = (read(folder, "cycle.csv")[0] for folder in (coarse, finer, later))
    twice = 2 * abs(a["multiplier_abs"] - b["multiplier_abs"])
    faults = not (1 - float(part)) * twice <= a["multiplier_error"] <= 3 * twice
    print(f"multiplier_error {a['multiplier_error']:.6g}, by the difference {twice:.6g}")
    for value, error in STATED:
        finer, place = 4 / 3 * abs(a[value] - b[value]), abs(a[value] - c[value])
        rest = a[error] - finer
        faults += not 0.75 * place <= rest <= 3 * place
        print(f"{error} {a[error]:.6g}, by twice the steps {finer:.6g}, rest {rest:.6g}, to other steps {place:.6g}")
    return faults > 0


CUTOFF = (("freq_hz", "freq_cutoff_error_hz"), ("force_rms_n", "force_rms_cutoff_error_n"), ("force_peak_n", "force_peak_cutoff_error_n"),
          ("multiplier_abs", "multiplier_cutoff_error"))


def cutoff(lower, higher, value, least, most):
    """Whether a stated error of the reduction is off."""
    rows, faults = [], 0
    for folder in (lower, higher):
        table = read(folder, "cycle.csv")
        rows.append(table[numpy.argmin(abs(table["value"] - float(value)))])
        faults += not abs(rows[-1]["value"] / float(value) - 1) < 1e-12
    for name, error in CUTOFF:
        known, stated = abs(rows[1][name] - rows[0][name]), rows[0][error]
        faults += not float(least) * known <= stated <= float(most) * known
        print(f"{error} at {value}: {stated:.6g}, by the difference {known:.6g}, {least} to {most} times that")
    return faults > 0


def fold(coarse, fine, most):
    """Whether a stated error of a fold is off, or so large that it says nothing."""
    rows = []
    for folder in (coarse, fine):
        with open(Path(folder) / "cycle.csv", encoding="utf-8", newline="") as file:
            rows.append([row for row in csv.DictReader(file) if row["kind"] == "fold"])
    if [len(found) for found in rows] != [1, 1]:
        print(f"folds: {[len(found) for found in rows]}, must be one each")
        return 1
    known, stated = abs(float(rows[0][0]["value"]) - float(rows[1][0]["value"])), float(rows[0][0]["value_error"])
    print(f"fold {rows[0][0]['value']} +- {stated:.3g}, finer {rows[1][0]['value']}, apart by {known:.3g}, allowed {most} times that")
    return not known <= stated <= float(most) * known


def within(coarse, fine, value, most):
    """Whether two cycles are further apart than the errors that are stated, or these are too large to say so."""
    faults, pair = 0, []
    for folder in (coarse, fine):
        rows = read(folder, "cycle.csv")
        pair.append(rows[0] if len(rows) == 1 else rows[numpy.argmin(abs(rows["value"] - float(value)))])
    for name, error in STATED:
        apart, stated = abs(pair[0][name] - pair[1][name]), sum(row[error] for row in pair if row[error] > 0)
        faults += not 0 < apart <= stated <= float(most) * pair[1][name]
        print(f"{name}: {pair[0][name]:.9g} and {pair[1][name]:.9g}, apart by {apart:.3g}, stated {stated:.3g}, at most {most} of it")
    return faults > 0


def same(branch, value, single, frequency, force):
    """Whether a cycle of a branch is another one than that of its own scene."""
    rows, alone = read(branch, "cycle.csv"), read(single, "cycle.csv")[0]
    row = rows[numpy.argmin(abs(rows["value"] - float(value)))]
    faults = not abs(row["value"] / float(value) - 1) < 1e-12
    for name, most in (("freq_hz", frequency), ("force_rms_n", force), ("force_peak_n", force)):
        apart = abs(row[name] / alone[name] - 1)
        faults += not apart <= float(most)
        print(f"{name} at {value}: branch {row[name]:.12g}, alone {alone[name]:.12g}, apart by {apart:.1e}, at most {most}")
    return faults > 0


def probes(folder, record, at, most):
    """How many numbers of cycle_probes.csv are not those of the transient's own columns about their mean, in periods that
    begin at those times. Pairs open and close at other parts of a step in each period, in the cycle in the same: they are apart by
    something of first order in the step. Peaks are the mean of those of the periods; all is over the largest of the directions."""
    path, faults = Path(folder) / "cycle_probes.csv", 0
    if not path.exists():
        return 0
    inside = (record["time_s"] >= at[0]) & (record["time_s"] < at[-1])
    period = numpy.searchsorted(at, record["time_s"][inside], side="right")
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for what, column, unit in (("displacement", "", "m"), ("velocity", "v", "m_s")):
            name = f"{row['probe']}_{column}{row['direction']}_{unit}"
            moves = record[name][inside] - record[name][inside].mean()
            for kind, value in (("rms", moves.std()),
                                ("peak", numpy.mean([abs(moves[period == k]).max() for k in range(1, len(at))]))):
                size = max(float(other[f"{what}_{kind}_{unit}"]) for other in rows if other["probe"] == row["probe"])
                wrong = abs(value - float(row[f"{what}_{kind}_{unit}"])) / size
                faults += not wrong <= most
                print(f"{kind} of {name}: transient {value:.9g}, apart by {wrong:.1e}, at most {most:.0e}")
    return faults if rows else 1


def main():
    parts = {"errors": errors, "same": same, "within": within, "cutoff": cutoff, "fold": fold}
    if sys.argv[1] in parts:
        return parts[sys.argv[1]](*sys.argv[2:])
    folder, frequency, force = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    cycle, record = read(folder, "cycle.csv")[0], read(folder, "transient.csv")
    time, normal = record["time_s"], record["normal_force_n"]
    above = normal - cycle["force_mean_n"]
    rise = numpy.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
    at = time[rise] - above[rise] * (time[rise + 1] - time[rise]) / (above[rise + 1] - above[rise])
    keep = numpy.concatenate([numpy.diff(at) > 0.5 / cycle["freq_hz"], [True]])  # one in each period
    at = at[keep][-PERIODS - 1:]
    inside = (time >= at[0]) & (time < at[-1])
    found = (len(at) - 1) / (at[-1] - at[0]), normal[inside].std(), normal[inside].max()
    faults = probes(folder, record, at, float(sys.argv[4])) if sys.argv[4:] else 0
    for what, value, known, most in zip(("frequency", "rms of the force", "largest force"), found,
                                        (cycle["freq_hz"], cycle["force_rms_n"], cycle["force_peak_n"]),
                                        (frequency, force, force)):
        wrong = abs(value / known - 1)
        faults += not wrong <= most
        print(f"{what}: transient {value:.9g}, cycle {known:.9g}, apart by {wrong:.1e}, at most {most:.0e}")
    return faults > 0


if __name__ == "__main__":
    sys.exit(main())
