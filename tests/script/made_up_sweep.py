#!/usr/bin/env python3
"""Writes the tables of a made-up sweep: pairs of modes that friction couples, among modes that it leaves alone.

A pair has the squared frequencies a and b(E) and is coupled by the unsymmetric block mu c [0 1; -1 0], so that
lambda^2 = -(a + b)/2 +- sqrt((a - b)^2/4 - mu^2 c^2): it flutters where |a - b| < 2 mu c. Which modes are unstable, and
between which values, is therefore known exactly.

usage: made_up_sweep.py FOLDER [mu [damping]], or made_up_sweep.py FOLDER map
"""

import csv
import sys
from pathlib import Path

import numpy

TWO_PI = 2 * numpy.pi
FIRST, LAST, POINTS = 6.5e9, 80e9, 75  # Pa
# Frequency of the disc's mode (Hz), of the pad's (Hz) where E is LAST, E where both meet (Pa), c (Hz^2), label
PAIRS = [(3480, 3550, 40e9, 9.5e5, "(0,4+)"), (5060, 5110, 26e9, 6e5, "(0,5+)"), (13800, 13880, 31e9, 1.2e6, "(0,8+)")]


def pad_frequency(young, disc, last, meet):
    """Rises with E, equals `disc` at E = `meet` and `last` at E = LAST."""
    fall = (last - disc) / (1 / meet - 1 / LAST)
    return disc + fall * (1 / meet - 1 / numpy.asarray(young))


def pair_lambda(young, mu, pair):
    """Eigenvalues [2] of a pair, 1/s."""
    disc, last, meet, coupling, _ = pair
    a, b = disc**2, pad_frequency(young, disc, last, meet)**2
    root = numpy.sqrt(complex((a - b)**2 / 4 - (mu * coupling)**2))
    return [1j * TWO_PI * numpy.sqrt((a + b) / 2 + sign * root) for sign in (-1, 1)]


def onsets(mu, pair):
    """Values of E between which the pair flutters, if they lie in the sweep: sorted by kind lock_in, lock_out."""
    disc, last, meet, coupling, _ = pair
    fine = numpy.geomspace(FIRST, LAST, 200001)
    inside = abs(disc**2 - pad_frequency(fine, disc, last, meet)**2) < 2 * mu * coupling
    change = numpy.flatnonzero(inside[1:] != inside[:-1])
    return [(fine[i], "lock_out" if inside[i] else "lock_in") for i in change]


def quiet_modes(n=46):
    """Frequencies, Hz, and labels of modes without friction, between 0.9 and 20 kHz."""
    frequency = 900 + 19000 * (numpy.arange(n) / n)**1.1 + 90 * numpy.sin(7 * numpy.arange(n))
    near = [disc for disc, *_ in PAIRS]
    return [(f, f"(0,{k})") for k, f in enumerate(frequency, 3) if min(abs(f - near)) > 60]


def eigenvalues(young, mu):
    """(branch, lambda, label) of all modes at one value; the first branch of a pair is the one that can be unstable."""
    modes = [(1 + 2 * p + k, value, ("pad", pair[-1])[k == 0]) for p, pair in enumerate(PAIRS)
             for k, value in enumerate(pair_lambda(young, mu, pair))]
    for k, (frequency, label) in enumerate(quiet_modes(), 1 + 2 * len(PAIRS)):
        modes.append((k, 1j * TWO_PI * frequency * (1 + 0.004 * (1 - (young / LAST)**-0.3)), label))
    return modes


def sweep_row(point, young, second, mode, damping, error_hz, jump):
    """One row of sweep.csv."""
    branch, value, label = mode
    value -= damping * abs(value) / TWO_PI
    error = error_hz.get(branch, 1e-8)
    kind = "stable" if value.real <= 1e-9 * abs(value) else "numerical" if value.real < TWO_PI * error else "unstable"
    return (point, young, branch, value.imag / TWO_PI, value.real, TWO_PI * error / abs(value), int(kind == "unstable"),
            label, second, kind, error, 1.5, "", 99, int(jump))


def onset_rows(mu, second):
    """Rows of onsets.csv for one value of mu."""
    return [("pad_young", young, abs(pair_lambda(young, mu, pair)[0].imag) / TWO_PI, kind, pair[-1], 1e-9, 1 + 2 * p,
             2 + 2 * p, 1, second) for p, pair in enumerate(PAIRS) for young, kind in onsets(mu, pair)]


def write_table(path, header, rows):
    """Comma-separated values."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header.split(","))
        writer.writerows(rows)


def write_sweep(folder, mu=0.5, damping=0.0, second=None, error_hz=None, values=None, jumps=()):
    """The three tables. Second: values of mu, the second parameter; error_hz: errors by branch, Hz; else 1e-8; jumps:
    values after a change of contact status, and [critical value] of the onset there if there is one."""
    folder.mkdir(parents=True, exist_ok=True)
    values = numpy.linspace(FIRST, LAST, POINTS) if values is None else values
    others = [""] if second is None else second
    grid = [(young, other) for other in others for young in values]
    rows = [sweep_row(point, young, other, mode, damping, error_hz or {}, young in dict(jumps))
            for point, (young, other) in enumerate(grid, 1)
            for mode in eigenvalues(young, mu if other == "" else other)]
    write_table(folder / "sweep.csv", "point,value,branch,freq_hz,growth_rad_s,error_estimate,unstable,label,value_2,"
                "class,error_hz,condition,onset_distance,n_closed,jump", rows)
    found = [row for other in others for row in onset_rows(mu if other == "" else other, other)]
    found += [("pad_young", value, PAIRS[0][0], "jump", PAIRS[0][-1], 1e6, 1, 2, 0, "") for _, there in jumps
              for value in there]
    write_table(folder / "onsets.csv", "parameter,critical_value,freq_hz,kind,label,error_estimate,branch,partner,"
                "confirmed,value_2", [] if damping else found)
    write_table(folder / "parameters.csv", "parameter,value,unit,swept,link",
                [("disc_young", 210e9, "Pa", 0, ""), ("pad_young", 25.1e9, "Pa", 1, ""),
                 ("contact_mu", mu, "-", 0 if second is None else 2, ""), ("contact_kn", 2.5895e8, "N/m", 0, "")])


if __name__ == "__main__":
    if sys.argv[2:] == ["map"]:
        write_sweep(Path(sys.argv[1]), second=numpy.linspace(0, 1, 21), values=numpy.linspace(FIRST, LAST, 40))
    else:
        write_sweep(Path(sys.argv[1]), *map(float, sys.argv[2:]))
