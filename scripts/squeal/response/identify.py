"""Modes in the decay after an impulse, from all its signals together: y(t) = sum of 2 Re(r_k exp(lambda_k t)), t > 0.

The signals are shifted band by band by its middle and filtered (signal.py), which keeps every exponential; then the
matrix pencil of all of them gives lambda_k. Modes that are close in frequency differ by their shapes, hence many
signals tell them apart. What noise makes has an exponent that depends on the window of time: only exponents that a later window
repeats count. The residues r_k are fitted to the transform of the signals, which knows their first moments too, with a
polynomial for what lies beyond the band.
"""

from typing import NamedTuple

import numpy

from ..transient.signal import TWO_PI, convolve, interval, is_moderate, low_pass, pencil

STOP = 100  # dB, by which the filter damps what is half a band beside it
SHARE = 0.25  # of the record that the filter may take
MOST = 60  # exponentials in a band and beside it
KEPT = 12  # signals into which all are combined
RANK = 1e-10  # of the largest: combinations that are noise
LATER = 0.25  # where the second window begins, of the first one's samples
REPEATED = 3e-3  # relative difference of exponents that are the same
BEYOND = 4  # terms of the polynomial
FINE = 1e-6  # of the largest: combinations of a band's terms that noise would decide
LEFT = 1e-3  # of a record at the end of the window that its transform has
ROWS = 64  # frequencies that are transformed together


class Modal(NamedTuple):
    """Exponent lambda (1/s) and residues of the signals (their unit)."""
    exponent: complex
    residue: numpy.ndarray

    @property
    def freq(self):
        """Hz."""
        return self.exponent.imag / TWO_PI

    @property
    def damping(self):
        """Damping ratio."""
        return -self.exponent.real / abs(self.exponent)

    @property
    def height(self):
        """Its part of the response at its frequency, root of the sum of squares."""
        return numpy.linalg.norm(self.residue) / max(abs(self.exponent.real), 1e-300)


def transform(time, values, freq):
    """Integral of values(t) exp(-2 pi i f t) dt, [frequency][signal]; trapezoidal rule on equal steps, and from time 0,
    where all is still at rest, to the first of them."""
    weights = numpy.full(len(time), interval(time))
    weights[0], weights[-1] = (weights[0] + time[0]) / 2, weights[-1] / 2
    weighted = values * weights[:, None]
    return numpy.concatenate([numpy.exp(-1j * TWO_PI * numpy.outer(part, time)) @ weighted
                              for part in numpy.array_split(freq, -(-len(freq) // ROWS))])


def decay_of_window(time):
    """Decay (1/s) with which a record falls to LEFT at its end."""
    return -numpy.log(LEFT) / time[-1]


def band_signals(times, values, band):
    """Signals of a band, shifted by its middle, at fewer times: times, values [time][signal]."""
    step, middle, half = interval(times), sum(band) / 2, (band[1] - band[0]) / 2
    weights = low_pass(step, half, SHARE * (times[-1] - times[0]), STOP)
    every = max(int(1 / (4 * half * step)), 1)
    shift = numpy.exp(-1j * TWO_PI * middle * (times - times[0]))
    reach = len(weights) // 2
    return times[reach:len(times) - reach:every], numpy.array(
        [convolve(column * shift, weights)[::every] for column in values.T]).T


def combined(values):
    """The combinations of the signals with most energy."""
    _, singular, right = numpy.linalg.svd(values, full_matrices=False)
    n = min(int((singular > RANK * singular[0]).sum()), KEPT)
    return values @ right[:max(n, 1)].conj().T


def exponents_of(times, values):
    """Exponents (1/s, from the band's middle) of some signals together."""
    ratios = pencil(values, MOST)
    found = numpy.log(ratios[abs(ratios) > 0].astype(complex)) / interval(times)
    return found[is_moderate(times - times[0], found)]


def band_exponents(times, values, band, inner):
    """Exponents with frequencies in `inner`, within the band, that a later window gives too."""
    middle = sum(band) / 2
    place, shifted = band_signals(times, values, band)
    start = int(LATER * len(place))
    if len(place) - start < 16 or not numpy.any(shifted):
        return []
    few = combined(shifted)
    later, limit = exponents_of(place[start:], few[start:]), REPEATED * TWO_PI * middle
    good = [value + 1j * TWO_PI * middle for value in exponents_of(place, few)
            if len(later) and abs(later - value).min() < limit]
    return [value for value in good if inner[0] <= value.imag / TWO_PI < inner[1]]


def band_residues(times, values, band, exponents):
    """Residues [exponent][signal] by least squares in the transform over a band."""
    decay, place = decay_of_window(times), numpy.linspace(-1, 1, max(int(2 * (band[1] - band[0]) * times[-1]), 32))
    freq = (band[0] + band[1]) / 2 + (band[1] - band[0]) / 2 * place
    s = 1j * TWO_PI * freq[:, None] + decay
    one, other = 1 / (s - exponents), 1 / (s - numpy.conj(exponents))
    powers = place[:, None]**numpy.arange(BEYOND)
    columns = numpy.hstack([one + other, 1j * (one - other), powers, 1j * powers])
    lengths = numpy.linalg.norm(columns, axis=0)
    lengths[lengths == 0] = 1  # the imaginary part of a decay that does not vibrate does nothing
    right = transform(times, values * numpy.exp(-decay * times)[:, None], freq)
    found = numpy.linalg.lstsq(numpy.vstack([(columns / lengths).real, (columns / lengths).imag]),
                               numpy.vstack([right.real, right.imag]), rcond=FINE)[0] / lengths[:, None]
    n = len(exponents)
    return found[:n] + 1j * found[n:2 * n]


def identify(times, values, band, width):
    """Modes of a band (Hz) by frequency, from values [time][signal]; residues are those at time 0, the impulse. `width`
    is that of the bands into which it is cut."""
    edges = numpy.linspace(*band, max(int(round((band[1] - band[0]) / width)), 1) + 1)
    bands = list(zip(edges[:-1], edges[1:]))
    every = numpy.array(sorted((value for low, high in bands for value in
                                band_exponents(times, values, (low - width / 2, high + width / 2), (low, high))),
                               key=lambda value: value.imag), complex)
    freq, modes = every.imag / TWO_PI, []
    for low, high in bands:
        near = (freq >= low - width) & (freq < high + width)
        own = (freq[near] >= low) & (freq[near] < high)
        if own.any():
            found = band_residues(times, values, (max(low - width / 4, 0), high + width / 4), every[near])
            modes += [Modal(*pair) for pair in zip(every[near][own], found[own])]
    return modes
