#!/usr/bin/env python3
"""Judges transient_lines.csv of scripts/plot/transient.

    torus.py two FOLDER    of two masses of 1 kg on 1e4 and 1.9e4 N/m, 1000 N/m between them, on belts of 0.1 m/s that press with 50 N and
                           rub with mu = 0.2 + 0.2 exp(-(s / 0.1)^2) + 1.3 s: by solve_ivp (DOP853, rtol 1e-11), whose velocity sums of
                           k f_1 + l f_2, |k| + |l| <= 5, are fitted to by least squares in f_1 and f_2; each line to 1e-4
    torus.py one FOLDER    all lines are multiples of the first
    torus.py map FOLDER    the same two lines in the first row of map.csv, with stated errors below 1e-4; its second
                           row, where friction of the first mass grows by 4 s, has one
    torus.py made          signals with known lines"""

import csv
import sys
from pathlib import Path

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.transient.torus import analyse  # noqa: E402

ONE, TWO, LINK, BELT, PRESS = 1e4, 1.9e4, 1000.0, 0.1, 50.0
SETTLED, END, STEP, ORDER, TOLERANCE = 2.0, 6.0, 2e-3, 5, 1e-4


def friction(rate):
    w = rate + BELT
    return PRESS * numpy.sign(w) * (0.2 + 0.2 * numpy.exp(-(w / 0.1)**2) + 1.3 * abs(w))


def slopes(_, state):
    x, y, u, v = state
    return [u, v, -ONE * x - LINK * (x - y) - friction(u), -TWO * y - LINK * (y - x) - friction(v)]


def reference(near):
    """f_1 and f_2, Hz, of the first mass, and what the fit leaves of its velocity."""
    times = numpy.arange(SETTLED, END, STEP)
    rest = numpy.linalg.solve([[ONE + LINK, -LINK], [-LINK, TWO + LINK]], [-friction(0)] * 2)
    found = solve_ivp(slopes, (0, END), [*rest, 0.02, -0.03], "DOP853", t_eval=times, rtol=1e-11, atol=1e-14)
    rate = found.y[2] / abs(found.y[2]).max()
    pairs = [(k, l) for k in range(ORDER + 1) for l in range(-ORDER, ORDER + 1) if k + abs(l) <= ORDER and (k, l) > (0, 0)]

    def left(basis):
        phases = 2 * numpy.pi * numpy.outer(times - times.mean(), [k * basis[0] + l * basis[1] for k, l in pairs])
        waves = numpy.hstack([numpy.cos(phases), numpy.sin(phases), numpy.ones((len(times), 1))])
        return rate - waves @ numpy.linalg.lstsq(waves, rate, rcond=None)[0]

    fitted = least_squares(left, near, x_scale=1e-3, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return fitted.x, numpy.sqrt(numpy.mean(fitted.fun**2))


def lines(folder):
    with (Path(folder) / "transient_lines.csv").open(newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def two(folder):
    with (Path(folder) / "transient_summary.csv").open(newline="") as file:
        told = {row["quantity"]: float(row["value"]) for row in csv.DictReader(file)}
    found = lines(folder)
    asked, left = reference([found[0]["freq_hz"], found[1]["freq_hz"]])
    off = [line["freq_hz"] / f - 1 for line, f in zip(found, asked)]
    third = next(line["freq_hz"] for line in found if (line["k"], line["l"]) == (2, -1)) / (2 * asked[0] - asked[1]) - 1
    print(f"lines {asked[0]:.7f} and {asked[1]:.7f} Hz, of which {left:.1e} of the motion is left; off by {off[0]:.1e}, {off[1]:.1e}, "
          f"2 f_1 - f_2 by {third:.1e}; stated errors {found[0]['error_hz']:.1e}, {found[1]['error_hz']:.1e} Hz")
    return max(map(abs, off)) <= TOLERANCE and abs(third) <= 5 * TOLERANCE and left < 1e-3 and \
        all(abs(told[f"quasi_periodic_{i + 1}"] - found[i]["freq_hz"]) < 1e-6 for i in range(2))


def map_rows(folder):
    with (Path(folder) / "map.csv").open(newline="") as file:
        first, second = csv.DictReader(file)
    found = [float(first[name]) for name in ("freq_hz", "freq_2_hz", "freq_error_hz", "freq_2_error_hz")]
    asked, left = reference(found[:2])
    off = [abs(f - right) for f, right in zip(found, asked)]
    print(f"{first['regime']}: {found[0]:.7f} and {found[1]:.7f} Hz, off by {off[0]:.1e} and {off[1]:.1e}, stated {found[2]:.1e} and "
          f"{found[3]:.1e}, {left:.1e} of the reference left; then {second['regime']}, {second['freq_2_hz']}")
    return first["regime"] == "quasi_periodic" and all(o <= TOLERANCE * f for o, f in zip(off, asked)) and left < 1e-3 and \
        all(0 < stated <= TOLERANCE * f for stated, f in zip(found[2:], asked)) and \
        (second["regime"], second["freq_2_hz"]) == ("cycle", "nan")


def one(folder):
    found = lines(folder)
    print(f"{len(found)} lines, multiples {[line['k'] for line in found]} of {found[0]['freq_hz']:.7f} Hz")
    return len(found) > 1 and all(line["l"] == 0 and abs(line["freq_hz"] / found[0]["freq_hz"] - line["k"]) < 1e-4 for line in found)


def made():
    t = numpy.arange(4000) * 1e-3

    def wave(freq, size=1.0, phase=0.3):
        return size * numpy.cos(2 * numpy.pi * freq * t + phase)

    f = 16.583217, 22.45771
    kind, found = analyse(t, wave(f[0]) + wave(f[1], 0.1) + wave(2 * f[0], 0.05) + wave(2 * f[0] - f[1], 0.01) + 0.3)
    off = [line.freq / asked - 1 for line, asked in zip(found, f)]
    other = analyse(t, wave(12) + wave(18, 0.2))[0], analyse(t, numpy.random.default_rng(1).normal(size=len(t)))[0]
    print(f"{kind}, off by {off[0]:.1e} and {off[1]:.1e}, sums {[line.sums for line in found]}; 12 and 18 Hz, noise: {other}")
    return kind == "quasi-periodic" and max(map(abs, off)) < 1e-8 and [line.sums for line in found] == [(1, 0), (0, 1), (2, 0), (2, -1)] \
        and other == ("periodic", "neither")


if __name__ == "__main__":
    sys.exit(not {"two": two, "one": one, "map": map_rows, "made": made}[sys.argv[1]](*sys.argv[2:]))
