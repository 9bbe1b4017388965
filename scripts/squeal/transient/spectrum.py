"""Spectra of a vibration: lines, harmonics, power density, and the content of a circle. Pure functions of times (s,
equally spaced) and values."""

import numpy

from .signal import LEAST, TWO_PI, interval

ROUNDING = 1e-13  # of the largest value: lines below it are none


def hann_spectrum(times, values, padding=8):
    """Frequencies and amplitudes of the lines of a signal without its mean."""
    weights = numpy.hanning(len(values) + 1)[:-1]
    n = padding * len(values)
    lines = numpy.fft.rfft(weights * (values - values.mean()), n)
    return numpy.fft.rfftfreq(n, interval(times)), 2 * abs(lines) / weights.sum()


def peak_of(times, values, band):
    """Frequency and amplitude of the largest line in a band, through three points of the logarithm; None without
    one."""
    frequency, height = hann_spectrum(times, values)
    inside = numpy.flatnonzero((frequency >= band[0]) & (frequency <= band[1]))
    inside = inside[(inside > 0) & (inside < len(height) - 1)]
    if not len(inside) or not height[inside].max() > ROUNDING * abs(values).max():
        return None
    i = inside[height[inside].argmax()]
    a, b, c = numpy.log(numpy.maximum(height[i - 1:i + 2], 1e-300))
    shift = 0.5 * (a - c) / (a - 2 * b + c) if b > max(a, c) else 0.0
    return frequency[i] + shift * frequency[1], numpy.exp(b - 0.25 * (a - c) * shift)


def main_line(times, values, band):
    """Frequency (Hz), its error and amplitude of the largest line; the error is half the difference of the two halves
    of the signal, or what the interpolation of the spectrum leaves. None without a line."""
    found = peak_of(times, values, band)
    if found is None or len(times) < 2 * LEAST:
        return None
    half = len(times) // 2
    near = found[0] - 4 / (half * interval(times)), found[0] + 4 / (half * interval(times))
    parts = [peak_of(times[cut], values[cut], near) for cut in (slice(half), slice(-half, None))]
    apart = 0.5 * abs(parts[0][0] - parts[1][0]) if all(parts) else numpy.inf
    return found[0], max(apart, 0.002 / (times[-1] - times[0])), found[1]


def power_density(times, values, resolution):
    """Welch's one-sided power spectral density: frequencies (Hz), unit^2/Hz. Segments of 2 / resolution (s) that
    overlap by half, without their means, Hann's window; the whole signal where it is shorter. Its integral is the mean
    square."""
    step = interval(times)
    n = min(int(2 / (resolution * step)), len(values))
    weights = numpy.hanning(n + 1)[:-1]
    pieces = [values[i:i + n] for i in range(0, len(values) - n + 1, max(n // 2, 1))]
    lines = [abs(numpy.fft.rfft(weights * (piece - weights @ piece / weights.sum())))**2 for piece in pieces]
    density = 2 * step * numpy.mean(lines, axis=0) / (weights**2).sum()
    density[0] /= 2
    if n % 2 == 0:
        density[-1] /= 2
    return numpy.fft.rfftfreq(n, step), density


def decibels(ratio):
    """Of amplitudes."""
    return 20 * numpy.log10(max(ratio, 1e-15))


def harmonic_levels(times, values, line, numbers=range(2, 7)):
    """Amplitudes of the multiples of a line relative to it, dB, by number; those beyond the largest frequency are left
    out. Each is the largest value within half the resolution, so that near lines that are no multiples do not count."""
    frequency, height = hann_spectrum(times, values)
    reach = 0.5 / (times[-1] - times[0])

    def largest(place):
        return height[abs(frequency - place) <= reach].max()

    return {k: decibels(largest(k * line) / largest(line)) for k in numbers if k * line < frequency[-1] - reach}


def other_line(times, values, line, lowest, least=-40.0):
    """Frequency (Hz) and level (dB relative to a line) of the largest line above `lowest` that is no multiple of it;
    None below `least`. A multiple takes two widths of the spectrum's resolution on both sides, the line itself six."""
    frequency, height = hann_spectrum(times, values)
    number = numpy.maximum(numpy.rint(frequency / line), 1)
    width = numpy.where(number == 1, 6, 2) / (times[-1] - times[0])
    free = (abs(frequency - number * line) > width) & (frequency >= lowest)
    peak = numpy.append(height[:-1] > height[1:], False) & numpy.append(True, height[1:] > height[:-1])
    places = numpy.flatnonzero(free & peak)
    if not len(places):
        return None
    best = places[height[places].argmax()]
    level = decibels(height[best] / height[abs(frequency - line).argmin()])
    return (frequency[best], level) if level >= least else None


def circle_content(angles, values):
    """Mean squares of the parts of a function on a circle that vary as cos and sin of n times the angle, n = 0, 1, ...
    Places need not be equally spaced: each stands for half the distance of its neighbours."""
    order = numpy.argsort(angles)
    angle, value = numpy.asarray(angles)[order], numpy.asarray(values)[order]
    width = numpy.diff(angle, append=angle[0] + TWO_PI)
    width = (width + numpy.roll(width, 1)) / (2 * TWO_PI)
    numbers = numpy.arange(min((len(angle) - 1) // 2, 24) + 1)
    parts = abs(numpy.exp(-1j * numpy.outer(numbers, angle)) @ (width * value))**2
    return numpy.where(numbers == 0, parts, 2 * parts)


def spectrogram(times, values, resolution, most=240):
    """Power spectral density over time: middles of the segments (s), frequencies (Hz), unit^2/Hz [frequency][segment].
    Segments of 2 / resolution (s), at most `most` of them, Hann's window."""
    step = interval(times)
    n = max(min(int(2 / (resolution * step)), len(values)), 2)
    starts = numpy.unique(numpy.linspace(0, len(values) - n, min(most, max(1, 8 * len(values) // n))).astype(int))
    weights = numpy.hanning(n + 1)[:-1]
    pieces = numpy.stack([values[i:i + n] for i in starts])
    pieces = weights * (pieces - (pieces @ weights / weights.sum())[:, None])
    density = 2 * step * abs(numpy.fft.rfft(pieces, axis=1))**2 / (weights**2).sum()
    return times[starts] + 0.5 * n * step, numpy.fft.rfftfreq(n, step), density.T
