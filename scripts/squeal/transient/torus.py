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
GOLDEN = (5**0.5 - 1) / 2
STEPS = 45      # of the golden section: to 4e-10 of two bins
LEAST = 20      # periods of the strongest line


class Line(NamedTuple):
    """Hz, its error, amplitude, and how often it has the two basic frequencies (None: not explained)."""
    freq: float
    error: float
    amplitude: float
    sums: tuple | None


def strength(weights, values, times, freq):
    """Of a line at a frequency."""
    return abs(numpy.sum(weights * values * numpy.exp(-2j * numpy.pi * freq * times)))


def refine(weights, values, times, freq, width):
    """The frequency of the largest strength within a width about another, by golden sections."""
    low, high = freq - width, freq + width
    inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)]
    found = [strength(weights, values, times, f) for f in inner]
    for _ in range(STEPS):
        if found[0] > found[1]:
            high, inner[1], found[1] = inner[1], inner[0], found[0]
            inner[0] = high - GOLDEN * (high - low)
            found[0] = strength(weights, values, times, inner[0])
        else:
            low, inner[0], found[0] = inner[0], inner[1], found[1]
            inner[1] = low + GOLDEN * (high - low)
            found[1] = strength(weights, values, times, inner[1])
    return 0.5 * (low + high)


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
