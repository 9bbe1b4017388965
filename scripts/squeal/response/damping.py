"""Damping of the peaks of a frequency response, and what it says of the materials.

Near a mode with hysteretic damping, c = omega_r^2 (1 + i eta), the receptance of each output is a + b / (c - omega^2): in the
complex plane a circle, which its frequencies run along; a is what all other modes do, here linear in omega^2. All outputs have one c.
It follows from

    c H_j - p_j - q_j omega^2 - r_j omega^4 = omega^2 H_j,    p_j ... r_j from a_j and b_j,

by least squares, weighted by 1 / |c - omega^2| of the round before. By half power |H|^2 summed over the outputs is half of the
peak's at f_1 and f_2, and eta = (f_2^2 - f_1^2) / (2 f_r^2); other modes near by change that, and the circle less. Viscous damping
with the ratio zeta has eta = 2 zeta at its frequency.

Where e_kp is the share of part p in the strain energy of mode k, eta_k = sum_p e_kp eta_p: the loss factors of the materials are the
nonnegative least squares of that over the modes. e_kp = 2 (d f_k / d E_p) E_p / f_k, from modes_sensitivities.csv of an undamped run.
"""

import csv
from typing import NamedTuple

import numpy
import scipy.optimize

from ..tables import BadInput, read_table
from .frf_tables import Responses

ROUNDS = 5
WIDE = 1.0  # half-power widths on each side of a peak, at most, that its circle has
LEAST = 7  # frequencies of a circle
MISFIT = 0.02  # of circles, above which a peak is no single mode and says nothing of materials
SENSITIVITIES = {"mode": int, "parameter": str, "freq_hz_per_percent": float}
MODES = {"mode": int, "freq_hz": float, "label": str}


class Peak(NamedTuple):
    """A mode that a response shows; NaN where nothing is known."""
    freq: float  # Hz
    loss: float  # by circles
    half_power: float
    points: int
    misfit: float  # of the circles, relative


def crossing(freq, power, peak, step, half):
    """Frequency at which the power falls to half, going from the peak by steps; NaN where it rises before."""
    i = peak
    while 0 <= i + step < len(freq) and power[i + step] <= power[i]:
        i += step
        if power[i] <= half:
            share = (power[i - step] - half) / (power[i - step] - power[i])
            return freq[i - step] + share * (freq[i] - freq[i - step])
    return numpy.nan


def circle(omega, values):
    """c and the relative misfit of all outputs, values [frequency][output]."""
    square, n = omega**2, values.shape[1]
    unit, weight = square.mean(), numpy.ones(len(omega))
    x = square / unit
    powers = ((x - 1) / abs(x - 1).max())[:, None]**numpy.arange(3)
    for _ in range(ROUNDS):
        rows, right = [], []
        for j in range(n):
            block = numpy.zeros((len(x), 1 + 3 * n), complex)
            block[:, 0], block[:, 1 + 3 * j:4 + 3 * j] = values[:, j], -powers
            rows.append(weight[:, None] * block)
            right.append(weight * x * values[:, j])
        found = numpy.linalg.lstsq(numpy.vstack(rows), numpy.concatenate(right), rcond=None)[0]
        c = found[0]
        weight = 1 / abs(c - x)
    fitted = powers @ found[1:].reshape(n, 3).T / (c - x)[:, None]
    return c * unit, numpy.linalg.norm(fitted - values) / numpy.linalg.norm(values)


def peaks_of(response):
    """Modes at the peaks of all outputs together, each once: of those within half a half-power width of each other the best fit."""
    kept = []
    for peak in sorted(all_peaks(response), key=lambda one: (numpy.isnan(one.misfit), one.misfit)):
        if all(abs(peak.freq / other.freq - 1) > abs(other.loss) / 2 for other in kept if numpy.isfinite(other.loss)):
            kept.append(peak)
    return sorted(kept)


def all_peaks(response):
    """A mode at each maximum that falls to half its power on one side at least."""
    freq, values = response.freq, numpy.array(list(response.outputs.values())).T
    power = (abs(values)**2).sum(1)
    values = values / numpy.sqrt(power.max())
    for i in range(1, len(freq) - 1):
        if not power[i - 1] < power[i] >= power[i + 1]:
            continue
        ends = [crossing(freq, power, i, step, power[i] / 2) for step in (-1, 1)]
        half = (ends[1]**2 - ends[0]**2) / (2 * freq[i]**2)
        reach = [WIDE * abs(end - freq[i]) for end in ends]
        if not any(numpy.isfinite(reach)):
            continue
        reach = numpy.nanmax(reach)
        near = abs(freq - freq[i]) <= reach
        if near.sum() < LEAST:
            yield Peak(freq[i], numpy.nan, half, int(near.sum()), numpy.nan)
            continue
        c, misfit = circle(2 * numpy.pi * freq[near], values[near])
        yield Peak(numpy.sqrt(abs(c.real)) / 2 / numpy.pi, c.imag / c.real, half, int(near.sum()), misfit)


def shares_of(folder):
    """Modes' frequencies and labels, and their strain energy shares by part, {mode: {part: share}}."""
    modes = {row["mode"]: row for row in read_table(folder / "modes.csv", MODES)}
    path, shares = folder / "modes_sensitivities.csv", {}
    if not path.exists():
        raise BadInput(f"{path} is missing: shares of energy need a run with -modes_sensitivities")
    for row in read_table(path, SENSITIVITIES):
        if row["parameter"].endswith("_young") and row["mode"] in modes and modes[row["mode"]]["freq_hz"] > 0:
            share = 200 * row["freq_hz_per_percent"] / modes[row["mode"]]["freq_hz"]
            shares.setdefault(row["mode"], {})[row["parameter"].removesuffix("_young")] = share
    return modes, shares


def paired(peaks, modes, within):
    """Mode number of each peak: the nearest frequency, or None beyond `within` of it."""
    for peak in peaks:
        number = min(modes, key=lambda k: abs(modes[k]["freq_hz"] - peak.freq))
        yield number if abs(modes[number]["freq_hz"] / peak.freq - 1) <= within else None


def materials(peaks, numbers, shares):
    """Loss factor and standard deviation of each part, and the largest difference of a peak from what they make."""
    used = [(peak, shares[number]) for peak, number in zip(peaks, numbers)
            if number in shares and peak.misfit <= MISFIT and peak.loss > 0]
    if not used:
        raise BadInput(f"no peak with a misfit of {MISFIT:g} at most is near a mode with shares of energy: do both runs have the same "
                       "band, and are the frequencies fine enough?")
    parts = sorted({part for _, row in used for part in row})
    matrix = numpy.array([[row.get(part, 0) for part in parts] for _, row in used])
    right = numpy.array([peak.loss for peak, _ in used])
    found, rest = scipy.optimize.nnls(matrix, right)
    freedom = len(used) - len(parts)
    spread = rest / numpy.sqrt(freedom) if freedom > 0 else numpy.nan
    deviation = spread * numpy.sqrt(numpy.diag(numpy.linalg.pinv(matrix.T @ matrix)))
    return list(zip(parts, found, deviation)), abs(matrix @ found - right).max()


def write(path, columns, rows):
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows([["" if isinstance(v, float) and numpy.isnan(v) else f"{v:.15g}" if isinstance(v, float) else v for v in row]
                         for row in rows])


def identify_damping(folder, modes_folder, output, within):
    """Writes damping.csv, and damping_parts.csv with modes; prints both, returns the first."""
    peaks = peaks_of(Responses(folder))
    if not peaks:
        raise BadInput(f"{folder / 'frf.csv'}: no peak; give finer frequencies about the modes")
    modes, shares = shares_of(modes_folder) if modes_folder else ({}, {})
    numbers = list(paired(peaks, modes, within)) if modes else [None] * len(peaks)
    output.mkdir(parents=True, exist_ok=True)
    rows = []
    for peak, number in zip(peaks, numbers):
        mode = ("", "") if number is None else (number, modes[number]["label"])
        rows.append((float(peak.freq), float(peak.loss), float(peak.half_power), peak.points, float(peak.misfit), *mode))
        print(f"{peak.freq:.6g} Hz: loss factor {peak.loss:.4g} by circles, misfit {peak.misfit:.2g}, {peak.half_power:.4g} by half power"
              + ("" if number is None else f"; mode {number} {mode[1]}"))
    write(output / "damping.csv", ("freq_hz", "loss_factor", "loss_factor_half_power", "points", "misfit", "mode", "label"), rows)
    if modes:
        found, worst = materials(peaks, numbers, shares)
        for part, loss, deviation in found:
            print(f"{part}: loss factor {loss:.4g} +- {deviation:.2g}")
        print(f"they make each peak's loss factor to {worst:.2g}")
        write(output / "damping_parts.csv", ("part", "loss_factor", "standard_deviation"),
              [(part, float(loss), float(deviation)) for part, loss, deviation in found])
    return output / "damping.csv"
