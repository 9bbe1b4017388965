"""Whether a vibration has one basic frequency or two, and which. Pure functions of times (s, equally spaced) and values.

Lines are found one after the other (J. Laskar, Icarus 88, 1990): the frequency that maximises |sum w x exp(-2 pi i f t)|, w Hann's window,
what all lines so far leave of x being searched next; then each is sought again with the others taken away. Lines far apart, T long, are
so found to T^-4. A vibration is quasi-periodic where its lines are k f_1 + l f_2, k and l small, and f_2 / f_1 is no ratio of small
numbers: f_1 is the strongest line, f_2 the strongest that is no multiple of it. Any k f_1 + l f_2 that make the same sums serve as well."""

from typing import NamedTuple

import numpy

from ..tables import write_table
from .signal import equal_steps

N_LINES = 12
FAINT = 1e-3    # of the strongest line: fainter ones need no explanation
ORDER = 8       # |k| + |l| at most; numbers of a ratio
NEAR = 0.02     # over the time: lines that are nearer are one
ROUNDS = 3
STEPS = 60      # of false position
CLOSE = 1e-10   # of half a bin, to which a frequency is sought
LEAST = 20      # periods of the strongest line


class Line(NamedTuple):
    """Hz, its error, amplitude, and how often it has the two basic frequencies (None: not explained)."""
    freq: float
    error: float
    amplitude: float
    sums: tuple | None


def rise(mixed, times, freq):
    """Of the squared strength |S|^2 of a line over its frequency, S = sum w x exp(-2 pi i f t), divided by 4 pi."""
    wave = mixed * numpy.exp(-2j * numpy.pi * freq * times)
    return (numpy.conj(wave.sum()) * (times @ wave)).imag


def refine(weights, values, times, freq, width):
    """The frequency of the largest strength within a width about another: where its rise is 0, by the method of false position (of
    Illinois); the end towards which it rises where there is none."""
    mixed, ends = weights * values, [freq - width, freq + width]
    rises = [rise(mixed, times, end) for end in ends]
    if rises[0] <= 0 or rises[1] >= 0:
        return ends[0] if rises[0] + rises[1] < 0 else ends[1]
    last = None
    for _ in range(STEPS):
        found = (ends[0] * rises[1] - ends[1] * rises[0]) / (rises[1] - rises[0])
        own = rise(mixed, times, found)
        side = 0 if own > 0 else 1
        if own == 0 or abs(found - ends[side]) <= CLOSE * width:
            return found
        if side == last:
            rises[1 - side] *= 0.5
        ends[side], rises[side], last = found, own, side
    return found


def waves(times, freqs):
    """Cosines and sines of lines, and a constant, [times][2 n + 1]."""
    phase = 2 * numpy.pi * numpy.outer(times, freqs)
    return numpy.hstack([numpy.cos(phase), numpy.sin(phase), numpy.ones((len(times), 1))])


def fit(weights, values, times, freqs):
    """Coefficients of the waves, by least squares with the window."""
    root = numpy.sqrt(weights)[:, None]
    return numpy.linalg.lstsq(root * waves(times, freqs), root[:, 0] * values, rcond=None)[0]


def sought(weights, values, times, freqs, width):
    """The same lines, each sought again with the others taken away."""
    freqs = list(freqs)
    for _ in range(ROUNDS):
        for i in range(len(freqs)):
            factors, n = fit(weights, values, times, freqs), len(freqs)
            factors[[i, n + i]] = 0
            freqs[i] = refine(weights, values - waves(times, freqs) @ factors, times, freqs[i], width)
    return freqs


def find_lines(times, values):
    """Frequencies (Hz), their errors and amplitudes, the strongest first; errors are half the difference of two halves."""
    times = times - times.mean()
    span, n = times[-1] - times[0], len(times)
    weights = numpy.hanning(n + 2)[1:-1]
    grid, freqs, rest = numpy.fft.rfftfreq(4 * n, span / (n - 1)), [], values - values.mean()
    for _ in range(N_LINES):
        spectrum = abs(numpy.fft.rfft(weights * rest, 4 * n))
        spectrum[grid < 3 / span] = 0
        freqs.append(refine(weights, rest, times, grid[spectrum.argmax()], 0.5 / span))
        rest = values - waves(times, freqs) @ fit(weights, values, times, freqs)
        if len(freqs) > 1 and min(abs(freqs[-1] - f) for f in freqs[:-1]) < 1 / span:
            freqs.pop()
            break
    freqs = sought(weights, values, times, freqs, 0.5 / span)
    halves = [sought(numpy.hanning(n // 2 + 2)[1:-1], values[cut], times[cut], freqs, 0.5 / span)
              for cut in (slice(n // 2), slice(-(n // 2), None))]
    factors = fit(weights, values, times, freqs)
    sizes = numpy.hypot(factors[:len(freqs)], factors[len(freqs):-1])
    order = numpy.argsort(-sizes)
    return [(freqs[i], 0.5 * abs(halves[0][i] - halves[1][i]), sizes[i]) for i in order]


def sums_of(freq, basis, near):
    """The smallest k, l with freq = k f_1 + l f_2, or None; one basic frequency has l = 0."""
    pairs = sorted(((k, l) for k in range(-ORDER, ORDER + 1) for l in (range(-ORDER, ORDER + 1) if len(basis) > 1 else (0,))
                    if 0 < abs(k) + abs(l) <= ORDER), key=lambda pair: abs(pair[0]) + abs(pair[1]))
    return next(((k, l) for k, l in pairs if abs(k * basis[0] + (l * basis[1] if l else 0) - freq) <= near), None)


def is_ratio(basis, near):
    """Whether f_2 / f_1 is one of small numbers."""
    return any(abs(q * basis[1] - p * basis[0]) <= q * near for q in range(1, ORDER + 1) for p in range(1, 4 * ORDER))


def analyse(times, values):
    """"periodic", "quasi-periodic" or "neither", and the lines, the basic ones first."""
    found = find_lines(*equal_steps(times, numpy.asarray(values, float)))
    found = [line for line in found if line[2] >= FAINT * found[0][2]]
    near = max(NEAR / (times[-1] - times[0]), *(3 * error for _, error, _ in found[:2]))
    if found[0][0] * (times[-1] - times[0]) < LEAST:
        return "neither", [Line(*line, None) for line in found]
    basis = [found[0][0]]
    other = next((line for line in found[1:] if sums_of(line[0], basis, near) is None), None)
    if other:
        basis.append(other[0])
    lines = [Line(*line, sums_of(line[0], basis, near)) for line in found]
    lines.sort(key=lambda line: (line.sums not in ((1, 0), (0, 1)), line.sums != (1, 0), -line.amplitude))
    if any(line.sums is None for line in lines):
        return "neither", lines
    return ("periodic" if other is None or is_ratio(basis, near) else "quasi-periodic"), lines


def write_lines(path, lines):
    """The table of the lines."""
    write_table(path, ["k", "l", "freq_hz", "error_hz", "amplitude"], [(*(line.sums or ("nan", "nan")), *line[:3]) for line in lines])
