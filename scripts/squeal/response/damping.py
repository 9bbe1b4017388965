"""Damping of the peaks of a frequency response, and what it says of the materials.

Near a mode with hysteretic damping, c = omega_r^2 (1 + i eta), the receptance of each output is a + b / (c - omega^2): in the
complex plane a circle, which its frequencies run along; a is what all other modes do, here linear in omega^2. All outputs have one c.
It follows from

    c H_j - p_j - q_j omega^2 - r_j omega^4 = omega^2 H_j,    p_j ... r_j from a_j and b_j,

by least squares, weighted by 1 / |c - omega^2| of the round before. The same with a polynomial of two poles tells two modes in one
peak, whose circle is up to twice too wide. Noise makes circles smaller: of 2 % of the peak their loss factors are up to 15 % low, and say
nothing of materials. By half power |H|^2 summed over the outputs is half of the
peak's at f_1 and f_2, and eta = (f_2^2 - f_1^2) / (2 f_r^2); other modes near by change that, and the circle less. Viscous damping
with the ratio zeta has eta = 2 zeta at its frequency.

Where e_kp is the share of part p in the strain energy of mode k, eta_k = sum_p e_kp eta_p: the loss factors of the materials are the
nonnegative least squares of that over the modes. e_kp = 2 (d f_k / d E_p) E_p / f_k, from modes_sensitivities.csv of an undamped run.
"""

from typing import NamedTuple

import numpy
import scipy.optimize
import scipy.signal

from ..tables import BadInput, read_table, write_table
from .frf_tables import Responses

ROUNDS = 5
WIDE = 1.0  # half-power widths on each side of a peak, at most, that its circle has
LEAST = 7  # frequencies of a circle
MISFIT = 1e-3  # of circles, above which a peak says nothing of materials: two modes may be in it, or noise
NONE = 0.2  # above which it is no circle
BETTER = 0.1  # of the misfit, at most, that two poles leave of two modes
STANDS = 0.3  # share of its power by which a peak stands above what is about it
ABOVE = 12  # deviations of noise by which its power does
LEAST_SHARE = 1e-3  # of the largest singular value of shares: directions below are not told
LEAST_PART = 1e-2  # of a part in such a direction
SENSITIVITIES = {"mode": int, "parameter": str, "freq_hz_per_percent": float}
MODES = {"mode": int, "freq_hz": float, "label": str}


class Peak(NamedTuple):
    """A mode that a response shows; NaN where nothing is known."""
    freq: float  # Hz
    loss: float  # by circles
    half_power: float
    points: int
    misfit: float  # of the circles, relative
    modes: int  # 2 where two poles fit better by far


def crossing(freq, power, peak, step, stop):
    """Frequency at which the power first falls to half, going from a peak by steps; NaN where another one, `stop`, comes before."""
    half = power[peak] / 2
    for i in range(peak + step, stop, step):
        if power[i] <= half:
            share = (power[i - step] - half) / (power[i - step] - power[i])
            return freq[i - step] + share * (freq[i] - freq[i - step])
    return numpy.nan


def circle(omega, values, poles=1):
    """The poles c and the relative misfit of all outputs, values [frequency][output]."""
    square, n = omega**2, values.shape[1]
    unit, half, weight = square.mean(), numpy.ptp(square) / 2, numpy.ones(len(omega))
    x = (square - unit) / half
    powers = x[:, None]**numpy.arange(poles + 2)
    for _ in range(ROUNDS):
        rows, right = [], []
        for j in range(n):
            block = numpy.zeros((len(x), poles + len(powers[0]) * n), complex)
            block[:, :poles] = values[:, j, None] * powers[:, :poles]
            block[:, poles + len(powers[0]) * j:poles + len(powers[0]) * (j + 1)] = -powers
            rows.append(weight[:, None] * block)
            right.append(-weight * powers[:, poles] * values[:, j])
        found = numpy.linalg.lstsq(numpy.vstack(rows), numpy.concatenate(right), rcond=None)[0]
        below = powers[:, :poles + 1] @ [*found[:poles], 1]
        weight = 1 / abs(below)
    fitted = powers @ found[poles:].reshape(n, -1).T / below[:, None]
    roots = numpy.roots([1, *found[poles - 1::-1]])
    return unit + half * roots, numpy.linalg.norm(fitted - values) / numpy.linalg.norm(values)


def is_merged(omega, values, misfit):
    """Whether a fit of two poles is better by far, and both lie within the frequencies and twice as wide a loss."""
    square = omega**2
    poles, less = circle(omega, values, 2)
    inside = abs(poles - square.mean()) < numpy.ptp(square)
    return bool(less < BETTER * misfit and inside.all())


def peaks_of(response):
    """Modes at the peaks of all outputs together, each once: of those within half a half-power width of each other the best fit."""
    kept = []
    for peak in sorted(all_peaks(response), key=lambda one: (numpy.isnan(one.misfit), one.misfit)):
        if all(abs(peak.freq / other.freq - 1) > abs(other.loss) / 2 for other in kept if numpy.isfinite(other.loss)):
            kept.append(peak)
    return sorted(kept)


def maxima(values, power):
    """Maxima that stand above what is about them by a share of their power, and by what noise does not reach: its deviation in each of the
    parts of a value is that of second differences, sqrt(6) of it, of which half are above 1.18 of their deviation."""
    differences = numpy.sqrt((abs(numpy.diff(values, 2, axis=0))**2).sum(1) / values.shape[1])
    noise = numpy.median(differences) / (1.18 * numpy.sqrt(6))
    found, about = scipy.signal.find_peaks(power, prominence=0)
    return [int(i) for i, above in zip(found, about["prominences"])
            if above > max(STANDS * power[i], ABOVE * noise * numpy.sqrt(power[i]))]


def all_peaks(response):
    """A mode at each maximum that falls to half its power on one side at least."""
    freq, values = response.freq, numpy.array(list(response.outputs.values())).T
    largest = abs(values).max()
    if not 0 < largest < numpy.inf or len(freq) < LEAST:
        raise BadInput(f"the response has {len(freq)} frequencies and is at most {largest:g} m/N: there must be {LEAST} at least, "
                       "with values that are finite and not all 0")
    values = values / largest
    power = (abs(values)**2).sum(1)
    tops = maxima(values, power)
    for before, i, after in zip([-1, *tops], tops, [*tops[1:], len(freq)]):
        ends = [crossing(freq, power, i, *way) for way in ((-1, before), (1, after))]
        half = (ends[1]**2 - ends[0]**2) / (2 * freq[i]**2)
        reach = [WIDE * abs(end - freq[i]) for end in ends]
        if numpy.isfinite(reach).any():
            yield fitted_peak(freq, values, i, half, numpy.nanmax(reach))


def fitted_peak(freq, values, i, half, reach):
    """The mode of a maximum."""
    near = abs(freq - freq[i]) <= reach
    n = int(near.sum())
    if n < LEAST:
        return Peak(float(freq[i]), numpy.nan, half, n, numpy.nan, 1)
    omega = 2 * numpy.pi * freq[near]
    (c,), misfit = circle(omega, values[near])
    loss = c.imag / c.real
    if misfit > NONE or c.real <= 0:
        return Peak(float(freq[i]), numpy.nan, half, n, misfit, 1)
    if loss <= 0:
        raise BadInput(f"the peak at {freq[i]:.6g} Hz has the loss factor {loss:.3g}: its mode grows, or the response is that of "
                       "exp(-i omega t): give its conjugate")
    return Peak(numpy.sqrt(c.real) / 2 / numpy.pi, loss, half, n, misfit, 1 + is_merged(omega, values[near], misfit))


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


def told(matrix):
    """Which columns the rows tell: those without a part in a direction that they do not have."""
    _, sizes, directions = numpy.linalg.svd(matrix)
    rank = int((sizes > LEAST_SHARE * sizes.max(initial=0)).sum())
    return numpy.linalg.norm(directions[rank:], axis=0) < LEAST_PART


def materials(peaks, numbers, shares):
    """Loss factor and standard deviation of each part, NaN where the peaks do not tell it, and the largest difference of a peak from what
    they make. A loss factor at its bound 0 has no deviation."""
    used = [(peak, shares[number]) for peak, number in zip(peaks, numbers)
            if number in shares and peak.misfit <= MISFIT and peak.modes == 1 and peak.loss > 0]
    if not used:
        raise BadInput(f"no peak of one mode with a misfit of {MISFIT:g} at most is near a mode with shares of energy: do both runs have "
                       "the same band, are the frequencies fine enough, and is the response without noise?")
    parts = sorted({part for _, row in used for part in row})
    matrix = numpy.array([[row.get(part, 0) for part in parts] for _, row in used])
    right = numpy.array([peak.loss for peak, _ in used])
    found, rest = scipy.optimize.nnls(matrix, right)
    known, freedom = told(matrix), len(used) - len(parts)
    spread = rest / numpy.sqrt(freedom) if freedom > 0 else numpy.nan
    deviation = spread * numpy.sqrt(numpy.diag(numpy.linalg.pinv(matrix.T @ matrix)))
    return (list(zip(parts, numpy.where(known, found, numpy.nan), numpy.where(known & (found > 0), deviation, numpy.nan))), len(used),
            abs(matrix @ found - right).max())


def tell_materials(found, count, worst):
    """Prints the loss factors of parts."""
    for part, loss, deviation in found:
        if numpy.isnan(loss):
            print(f"{part}: not told by {count} peaks of one mode: give more, or parts together")
        elif loss == 0 or deviation >= loss:
            print(f"{part}: loss factor {loss:.4g}, not told from 0")
        else:
            print(f"{part}: loss factor {loss:.4g} " + (f"+- {deviation:.2g}" if deviation >= 0 else "with as many peaks as parts"))
    print(f"they make the loss factor of each of {count} peaks to {worst:.2g}")


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
        rows.append((float(peak.freq), float(peak.loss), float(peak.half_power), peak.points, float(peak.misfit), peak.modes,
                     *mode))
        print(f"{peak.freq:.6g} Hz: loss factor {peak.loss:.4g} by circles, misfit {peak.misfit:.2g}, {peak.half_power:.4g} by half power"
              + (", TWO MODES in one peak" if peak.modes > 1 else "") + ("" if number is None else f"; mode {number} {mode[1]}"))
    write_table(output / "damping.csv",
                ("freq_hz", "loss_factor", "loss_factor_half_power", "points", "misfit", "modes", "mode", "label"), rows)
    if modes:
        found, count, worst = materials(peaks, numbers, shares)
        tell_materials(found, count, worst)
        write_table(output / "damping_parts.csv", ("part", "loss_factor", "standard_deviation"),
              [(part, float(loss), float(deviation)) for part, loss, deviation in found])
    return output / "damping.csv"
