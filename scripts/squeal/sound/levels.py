"""Levels of a sound pressure: A-weighting, third octaves, lines of its spectrum.

IEC 61672-1, equation (E.6), gives the A-weighting; IEC 61260-1 the exact middles 1000 * 10^(n / 10) Hz of third octaves, whose ends are
10^(1/20) away. Levels are those of mean squares, to 20 uPa.
"""

import numpy

REFERENCE = 20e-6  # Pa
LINES = 3  # a third octave with fewer lines of the spectrum is left out
BANDS = range(-16, 14)  # 25 Hz to 20 kHz


def weighting(f):
    """A-weighting as a factor of the pressure, 1 at 1 kHz."""
    f2 = numpy.square(numpy.asarray(f, float))
    return _response(f2) / _response(1e6)


def _response(f2):
    return 12194.217**2 * f2**2 / ((f2 + 20.598997**2) * numpy.sqrt((f2 + 107.65265**2) * (f2 + 737.86223**2)) * (f2 + 12194.217**2))


def decibel(mean_square):
    """Level of a mean square, Pa^2; -inf of silence."""
    with numpy.errstate(divide="ignore"):
        return 10 * numpy.log10(mean_square / REFERENCE**2)


def shares(pressure, step, window=False):
    """Frequencies, Hz, and what each adds to the mean square, Pa^2, of a record without its mean; by a Hann window, which keeps a tone
    out of other bands."""
    n = len(pressure)
    weight = numpy.hanning(n + 1)[:n] * numpy.sqrt(8 / 3) if window else 1
    square = numpy.abs(numpy.fft.rfft((pressure - pressure.mean()) * weight))**2 / n**2
    square[1:(n + 1) // 2] *= 2
    return numpy.fft.rfftfreq(n, step), square


def level(pressure, step, weighted=True):
    """dB, or dB(A)."""
    f, square = shares(pressure, step)
    return decibel(numpy.sum(square * weighting(f)**2 if weighted else square))


def third_octaves(pressure, step):
    """(middle, Hz; dB; dB(A)) of the bands that the record tells."""
    f, square = shares(pressure, step, True)
    rows = []
    for n in BANDS:
        middle = 1000 * 10**(n / 10)
        inside = (f >= middle * 10**-0.05) & (f < middle * 10**0.05)
        if inside.sum() >= LINES and middle * 10**0.05 <= f[-1]:
            rows.append((middle, decibel(square[inside].sum()), decibel((square * weighting(f)**2)[inside].sum())))
    return rows


def main_line(pressure, step):
    """Frequency, Hz, and level, dB(A), of the largest line, by a Hann window and a parabola through its logarithms."""
    n = len(pressure)
    window = numpy.hanning(n + 1)[:n]
    size = numpy.abs(numpy.fft.rfft((pressure - pressure.mean()) * window)) * 2 / window.sum()
    f = numpy.fft.rfftfreq(n, step)
    k = int(numpy.clip(numpy.argmax(size * weighting(f)), 1, len(size) - 2))
    a, b, c = numpy.log(numpy.maximum(size[k - 1:k + 2], 1e-30))
    shift = (a - c) / (2 * (a - 2 * b + c)) if b > max(a, c) else 0
    frequency = f[k] + shift / (n * step)
    peak = numpy.exp(b - (a - c) * shift / 4) if size[k] > 0 else 0
    return frequency, decibel((peak * weighting(frequency))**2 / 2)


def frames(count, step, frame):
    """Where frames of some length, s, begin and end; the last one has the rest."""
    n = max(16, min(int(round(frame / step)), count))
    return [(begin, begin + n if begin + 2 * n <= count else count) for begin in range(0, count - n + 1, n)]


def course(pressure, step, frame):
    """Loudness over time: (begin, end, s; dB; dB(A); main line, Hz) of frames."""
    return [(begin * step, end * step, level(pressure[begin:end], step, False), level(pressure[begin:end], step),
             main_line(pressure[begin:end], step)[0]) for begin, end in frames(len(pressure), step, frame)]


def events(pressure, step, threshold, frame):
    """Noises as dynamometers count them: (begin, end, s; frequency, Hz; level, dB(A)) of runs of frames whose main line exceeds the
    threshold, with frequencies within 5 % of each other."""
    found = []
    for begin, end in frames(len(pressure), step, frame):
        frequency, size = main_line(pressure[begin:end], step)
        if size < threshold:
            continue
        last = found[-1] if found else None
        if last and last[1] == begin and abs(frequency / last[2] - 1) < 0.05:
            found[-1] = [last[0], end, *((frequency, size) if size > last[3] else last[2:])]
        else:
            found.append([begin, end, frequency, size])
    return [(begin * step, end * step, frequency, size) for begin, end, frequency, size in found]
