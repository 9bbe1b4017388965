"""Signals of a vibration that grows or decays: exponentials within a band, amplitude of a line, window of its growth.
Pure functions of times (s, equally spaced) and values.

A linear vibration is x(t) = sum of Re(A_k exp(s_k t)), s_k = growth + 2 pi i frequency. Shifted by the middle of a band
and passed through a finite filter, without its ends, each exponential keeps its exponent exactly; those outside the
band are damped. What is left is sampled coarsely and fitted: exponents by the matrix pencil (Hua and Sarkar, IEEE
Trans. ASSP 38, 1990), which also takes up what leaks into the band, then least squares in amplitudes and exponents.
"""

from typing import NamedTuple

import numpy

TWO_PI = 2 * numpy.pi
UNEQUAL = 1e-6  # intervals that differ by more than this part are made equal
LEAST = 16  # rows without which nothing can be said
STOP = 80  # dB, by which the filter of the fit damps what is a bandwidth away
EXTRA = 8  # exponentials more than asked for, for what leaks into the band
LONGEST_PENCIL = 400  # samples in a row of the matrix
SLOW = 0.15  # least change of the logarithm that counts as a slow growth or decay
NEGLIGIBLE = 1e-10  # share of the energy, below which an exponential may be one that the filter damped


class Mode(NamedTuple):
    """Hz, 1/s, unit of the signal at the first time, 1/s: standard error of the growth and of 2 pi times the
    frequency"""
    freq: float
    growth: float
    amplitude: float
    error: float


def equal_steps(times, *columns):
    """Times and columns at equal steps, interpolated linearly where they are not."""
    times = numpy.asarray(times, float)
    step = (times[-1] - times[0]) / (len(times) - 1)
    even = times[0] + step * numpy.arange(len(times))
    if abs(numpy.diff(times) / step - 1).max() <= UNEQUAL:
        return even, *columns
    return even, *(numpy.interp(even, times, column) for column in columns)


def interval(times):
    """Distance of two samples, s."""
    return (times[-1] - times[0]) / (len(times) - 1)


def low_pass(step, half, longest, stop):
    """Kaiser's window of a sinc: passes -half to half Hz, damps by `stop` dB beyond twice that, if it may be as long
    (s). Reference: Kaiser, IEEE ISCAS, 1974."""
    length = min((stop - 8) / (2.285 * TWO_PI * half), longest)
    n = max(int(length / step), 1) | 1
    beta = 0.1102 * (stop - 8.7) if stop > 50 else 0.5842 * (stop - 21)**0.4 + 0.07886 * (stop - 21)
    place = step * (numpy.arange(n) - n // 2)
    weights = numpy.kaiser(n, beta) * numpy.sinc(3 * half * place)
    return weights / weights.sum()


def convolve(values, weights):
    """Part of the convolution in which all weights are used."""
    size = 1 << int(len(values) + len(weights) - 1).bit_length()
    whole = numpy.fft.ifft(numpy.fft.fft(values, size) * numpy.fft.fft(weights, size))
    return whole[len(weights) - 1:len(values)]


def demodulate(times, values, band, stop=40, share=0.25):
    """Line in a band, shifted by the band's middle: times, complex values (their modulus is half the amplitude),
    weights of the filter. It takes at most this share of the signal."""
    step, middle, half = interval(times), sum(band) / 2, (band[1] - band[0]) / 2
    weights = low_pass(step, half, share * (times[-1] - times[0]), stop)
    shifted = values * numpy.exp(-1j * TWO_PI * middle * (times - times[0]))
    reach = len(weights) // 2
    return times[reach:len(times) - reach], convolve(shifted, weights), weights


def pencil(values, most):
    """Ratios per sample of the exponentials in a series, or in several [sample][series] together, those above the
    noise, `most` of them at most. Threshold: 4/2.858 of that of Gavish and Donoho, IEEE Trans. Inf. Theory 60, 2014, since
    rows of the matrix repeat their noise."""
    row = min(len(values) // 2, LONGEST_PENCIL)
    values = values.reshape(len(values), -1)
    hankel = numpy.lib.stride_tricks.sliding_window_view(values, row, axis=0).transpose(0, 2, 1)
    _, singular, right = numpy.linalg.svd(hankel.reshape(len(hankel), -1), full_matrices=False)
    noise = max(4 * numpy.median(singular), 1e-13 * singular[0])
    order = max(1, min(int((singular > noise).sum()), most, row - 1, len(values) // 4))
    basis, n = right[:order].T, values.shape[1]
    return numpy.linalg.eigvals(numpy.linalg.lstsq(basis[:-n], basis[n:], rcond=None)[0])


def amplitudes(times, values, exponents):
    """Least-squares amplitudes, and what is left."""
    basis = numpy.exp(times[:, None] * exponents)
    factors = numpy.linalg.lstsq(basis, values, rcond=None)[0]
    return factors, values - basis @ factors


def derivatives(times, exponents, factors):
    """Columns: derivatives with respect to amplitudes and exponents, and their lengths."""
    basis = numpy.exp(times[:, None] * exponents)
    columns = numpy.hstack([basis, times[:, None] * basis * factors])
    return columns, numpy.linalg.norm(columns, axis=0) + 1e-300


def is_moderate(times, exponents):
    """Which exponentials change by less than e^50 over the times: the others describe noise at one end."""
    return abs(exponents.real) * (times[-1] - times[0]) < 50


def refine(times, values, exponents):
    """Gauss-Newton steps, halved until they help, in amplitudes and exponents together."""
    n = len(exponents)
    factors, left = amplitudes(times, values, exponents)
    for _ in range(40):
        columns, lengths = derivatives(times, exponents, factors)
        change = (numpy.linalg.lstsq(columns / lengths, left, rcond=None)[0] / lengths)[n:]
        change *= min(1, 2 / (abs(change).max() * times[-1] + 1e-300))
        for part in 0.5**numpy.arange(8):
            if not is_moderate(times, exponents + part * change).all():
                continue
            factors_new, left_new = amplitudes(times, values, exponents + part * change)
            if numpy.linalg.norm(left_new) < numpy.linalg.norm(left):
                break
        else:
            break
        exponents, factors, left = exponents + part * change, factors_new, left_new
        if abs(change).max() < 1e-12 * abs(exponents).max():
            break
    return exponents, factors, left


def standard_errors(times, exponents, factors, left):
    """Of the real parts of the exponents, from the residual."""
    n = len(exponents)
    columns, lengths = derivatives(times, exponents, factors)
    inverse = numpy.linalg.pinv(columns / lengths)
    variance = numpy.vdot(left, left).real / max(len(times) - 2 * n, 1)
    return numpy.sqrt(0.5 * variance) * numpy.linalg.norm(inverse[n:], axis=1) / lengths[n:]


def fit_exponents(times, values, n_modes):
    """Exponents (1/s), amplitudes at the first time, errors (1/s), shares of the energy, of a complex series."""
    step, start = interval(times), times - times[0]
    ratios = pencil(values, n_modes + EXTRA)
    exponents = numpy.log(ratios[abs(ratios) > 0].astype(complex)) / step
    exponents = exponents[is_moderate(start, exponents)]
    if not len(exponents):
        return 4 * [numpy.zeros(0)]
    exponents, factors, left = refine(start, values, exponents)
    energy = (abs(numpy.exp(start[:, None] * exponents) * factors)**2).sum(axis=0)
    return exponents, factors, standard_errors(start, exponents, factors, left), energy


def fit_modes(times, values, band, n_modes=1):
    """The exponentials of most energy with frequencies in a band (Hz), the strongest first: a list of Mode. It may be
    shorter than asked for; signals of less than ten periods, or without anything in the band, give none."""
    times, values = equal_steps(times, numpy.asarray(values, float))
    middle, half = sum(band) / 2, (band[1] - band[0]) / 2
    if len(times) < LEAST or (times[-1] - times[0]) * middle < 10 or not values.any():
        return []
    step = interval(times)
    place, shifted, weights = demodulate(times, values, band, STOP, 1 / 3)
    every = max(int(1 / (3 * half * step)), 1)
    if len(place[::every]) < LEAST:
        every = max(len(place) // (4 * LEAST), 1)
    exponents, factors, errors, energy = fit_exponents(place[::every], shifted[::every], n_modes)
    lag = place[0] - times[0] + step * (numpy.arange(len(weights)) - len(weights) // 2)
    gain = weights @ numpy.exp(numpy.outer(lag[::-1], exponents))
    modes = [Mode(middle + s.imag / TWO_PI, s.real, 2 * abs(c / g), e)
             for s, c, e, g in zip(exponents, factors, errors, gain)]
    order = [i for i in numpy.argsort(-energy) if band[0] <= modes[i].freq <= band[1] and
             energy[i] > NEGLIGIBLE * energy.max()]
    return [modes[i] for i in order[:n_modes]]


def nodes_of(times, n=81):
    """Samples at which windows may begin and end."""
    return numpy.unique(numpy.linspace(0, len(times) - 1, n).astype(int))


def straight_lines(times, values):
    """Between all pairs of nodes: slope of the least-squares line and rms distance from it."""
    t = (times - times[0]) / (times[-1] - times[0])
    v = values - values.mean()
    at = nodes_of(times)
    sums = [numpy.concatenate([[0], numpy.cumsum(q)]) for q in (numpy.ones_like(t), t, v, t * t, t * v, v * v)]
    n, st, sv, stt, stv, svv = (s[at[None, :] + 1] - s[at[:, None]] for s in sums)
    n = numpy.maximum(n, 1)
    spread = stt - st**2 / n
    slope = numpy.where(at[None, :] > at[:, None], stv - st * sv / n, 0) / numpy.where(spread > 0, spread, 1)
    rms = numpy.sqrt(numpy.maximum(svv - sv**2 / n - slope**2 * spread, 0) / n)
    return at, slope / (times[-1] - times[0]), rms


class Growth(NamedTuple):
    """Window (s) in which the logarithm of an amplitude is straight, its slope (1/s); time from which the amplitude
    keeps its level (None: never), and this level."""
    window: tuple
    slope: float
    saturation: float | None
    level: float


def tail_of(times, logarithm):
    """Slope of the last fifth, 1/s, and the mean of the last quarter."""
    last = times >= times[-1] - 0.2 * (times[-1] - times[0])
    slope = numpy.polyfit(times[last], logarithm[last], 1)[0]
    return slope, numpy.exp(logarithm[3 * len(times) // 4:]).mean()


def straight_window(times, logarithm, sign, shortest):
    """The window of at least this length (s), by rise and straightness, in which the amplitude rises (sign 1) or falls
    (-1) by a factor of e at least, and its slope; None where there is none."""
    at, slope, rms = straight_lines(times, logarithm)
    length = times[at][None, :] - times[at][:, None]
    rise = numpy.where(length >= shortest, sign * slope * length, 0)
    score = rise * numpy.sqrt(abs(length)) / (1 + (rms / 0.05)**2)
    return best_window(times[at], slope, numpy.where(rise >= 1, score, 0))


def slow_window(times, logarithm):
    """The longest window, of half the times at least, whose slow rise or fall is straight; None where there is none."""
    at, slope, rms = straight_lines(times, logarithm)
    length = times[at][None, :] - times[at][:, None]
    change = abs(slope * length)
    good = (length >= 0.5 * (times[-1] - times[0])) & (change >= SLOW) & (rms <= 0.1 * change)
    return best_window(times[at], slope, numpy.where(good, length, 0))


def best_window(nodes, slope, score):
    """Ends and slope of the window of the largest score; None where all are zero."""
    if not score.max() > 0:
        return None
    i, j = numpy.unravel_index(score.argmax(), score.shape)
    return (nodes[i], nodes[j]), slope[i, j]


def find_growth(times, amplitude, frequency):
    """Growth of the amplitude of a line (Hz): by a factor of e along a straight line, or slowly; or its decay; or
    None."""
    logarithm = numpy.log(numpy.maximum(amplitude, 1e-12 * amplitude.max() + 1e-300))
    shortest = max(20 / frequency, 0.05 * (times[-1] - times[0]))
    tail, level = tail_of(times, logarithm)
    below = numpy.append(times[amplitude >= 0.5 * level], times[-1])[0]
    early = times <= below
    found = straight_window(times[early], logarithm[early], 1, shortest) if early.sum() > LEAST else None
    if found is None or tail > 0.5 * found[1]:
        found = straight_window(times, logarithm, 1, shortest) or found
    if found is None:
        other = slow_window(times, logarithm) or straight_window(times, logarithm, -1, shortest)
        return other and Growth(*other, None, level)
    if tail > 0.5 * found[1]:
        return Growth(*found, None, level)
    reached = times[(amplitude >= 0.9 * level) & (times >= found[0][1])]
    return Growth(*found, reached[0] if len(reached) else None, level)
