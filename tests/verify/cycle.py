#!/usr/bin/python3
"""A limit cycle of cycle.csv beside the end of the transient that it was found from: frequency by the times at which the
normal force rises through its mean, rms and largest force of whole periods.

    cycle.py FOLDER FREQUENCY FORCE     largest relative differences"""

import sys
from pathlib import Path

import numpy

PERIODS = 40


def read(folder, name):
    """Columns of a table."""
    return numpy.atleast_1d(numpy.genfromtxt(Path(folder) / name, delimiter=",", names=True))


def main():
    folder, frequency, force = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
    cycle, record = read(folder, "cycle.csv")[0], read(folder, "transient.csv")
    time, normal = record["time_s"], record["normal_force_n"]
    above = normal - cycle["force_mean_n"]
    rise = numpy.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
    at = time[rise] - above[rise] * (time[rise + 1] - time[rise]) / (above[rise + 1] - above[rise])
    keep = numpy.concatenate([numpy.diff(at) > 0.5 / cycle["freq_hz"], [True]])  # one in each period
    at = at[keep][-PERIODS - 1:]
    inside = normal[(time >= at[0]) & (time < at[-1])]
    found = (len(at) - 1) / (at[-1] - at[0]), inside.std(), inside.max()
    faults = 0
    for what, value, known, most in zip(("frequency", "rms of the force", "largest force"), found,
                                        (cycle["freq_hz"], cycle["force_rms_n"], cycle["force_peak_n"]),
                                        (frequency, force, force)):
        wrong = abs(value / known - 1)
        faults += not wrong <= most
        print(f"{what}: transient {value:.9g}, cycle {known:.9g}, apart by {wrong:.1e}, at most {most:.0e}")
    return faults > 0


if __name__ == "__main__":
    sys.exit(main())
