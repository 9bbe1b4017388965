"""What a transient does: growth or decay of its main line, limit cycle, and the list of its quantities. Used by
plot/transient."""

import csv
from typing import NamedTuple

import numpy

from .signal import LEAST, demodulate, find_growth, fit_modes
from .spectrum import harmonic_levels, main_line, other_line, power_density
from ..tables import BadInput

LOWEST = 200.0  # Hz, of what is taken as the main line without --band
PERIODS = 10  # in a record without which no line is sought
WIDTH = 0.2  # of the band about the main line, relative to its frequency
DETACHED = 1e-6  # of the mean normal force: below it the surfaces are apart
N_MODES = 3  # fitted at most in the window of growth
LISTED = 3e-3  # a mode with less than this part of the strongest amplitude in the window is not listed,
RETURNS = 0.1  # of its size, how near a motion comes to itself that is a limit cycle
STEADY = 0.05  # largest relative change of the root mean square between two halves of what is called steady
KNOWN = 30.0  # 1/s, and none of a larger error, except the strongest


class Quantity(NamedTuple):
    """A line of the summary; error None: not known."""
    name: str
    value: float
    error: float | None
    unit: str


def part(times, first, last):
    """Slice of the samples between two times."""
    return slice(int(numpy.searchsorted(times, first)), int(numpy.searchsorted(times, last, side="right")))


def nearest_return(values):
    """Least |x(t + lag) - x(t)| over sqrt(2) |x| for lags from a quarter to half of the record, between samples by a parabola."""
    values = values - values.mean()
    n, least = len(values), max(2, len(values) // 4)
    spectrum = numpy.fft.rfft(values, 2 * n)
    lags = numpy.arange(n // 2)
    squares = numpy.concatenate(([0], numpy.cumsum(values**2)))
    size = (squares[n - lags] + squares[n] - squares[lags]) / 2
    alike = numpy.fft.irfft(abs(spectrum)**2)[:n // 2] / numpy.where(size > 0, size, 1)
    before, here, after = alike[least - 1:-2], alike[least:-1], alike[least + 1:]
    if not len(here) or not size[-1] > 0:
        return 1.0
    bend = numpy.minimum(before - 2 * here + after, 0)
    top = (here >= before) & (here >= after) & (bend < 0)
    rise = numpy.where(top, (after - before)**2 / (8 * numpy.where(top, -bend, 1)), 0)
    return float(numpy.sqrt(max(0, 1 - (here + rise).max())))


class Vibration:
    """Main line of a signal (m/s^2) after `start` (s), its growth within a window and its limit cycle. `line` is None
    where there is no vibration, `growth` None where it neither grows nor decays."""

    def __init__(self, time, signal, start, band=None, window=None):
        self.time, self.signal, self.start = time, signal, start
        self.line = self.growth = self.fit = None
        self.modes, self.why = [], ""
        self.steady = part(time, max(start, (time[0] + time[-1]) / 2), time[-1])
        self.find_line(band)
        if self.line:
            self.band = band or ((1 - WIDTH) * self.line[0], (1 + WIDTH) * self.line[0])
            self.follow_line()
            self.find_window(window)
            self.fit_window()
        self.find_cycle(band)

    def find_line(self, band):
        """The largest line of the second half."""
        time, signal = self.time[self.steady], self.signal[self.steady]
        if len(time) < 2 * LEAST or not numpy.ptp(signal) > 0:
            self.why = "the signal is too short" if len(time) < 2 * LEAST else "the signal is constant"
            return
        lowest = max(LOWEST, 2 / length_of(self))
        highest = 0.5 * (len(time) - 1) / length_of(self)
        if band and band[0] >= highest:
            raise BadInput(f"--band {band[0]:g},{band[1]:g}: the rows of the table resolve up to {highest:.6g} Hz")
        self.line = main_line(time, signal, band or (lowest, highest))
        if not self.line:
            self.why = "no line in the band" if band else f"no line above {lowest:.0f} Hz"
        elif self.line[0] * length_of(self) < PERIODS:
            self.why = (f"{PERIODS} periods of the largest line, {self.line[0]:.0f} Hz, are needed after the ramp and "
                        f"in the second half, and {self.line[0] * length_of(self):.1f} are there")
            self.line = None

    def follow_line(self):
        """Amplitude and frequency (Hz) of the line over time."""
        self.line_time, shifted, _ = demodulate(self.time, self.signal, self.band)
        self.amplitude = 2 * abs(shifted)
        turn = numpy.gradient(numpy.unwrap(numpy.angle(shifted)), self.line_time) / (2 * numpy.pi)
        self.frequency = sum(self.band) / 2 + turn

    def find_window(self, window):
        """The window asked for, or the straight part of the amplitude's logarithm."""
        after = self.line_time >= min(self.start, self.line_time[-LEAST])
        self.growth = find_growth(self.line_time[after], self.amplitude[after], self.line[0])
        if window and self.growth:
            self.growth = self.growth._replace(window=window)
        self.window = window or (self.growth.window if self.growth else None)

    def fit_window(self):
        """Exponentials in the window."""
        if not self.window:
            return
        cut = part(self.time, *self.window)
        if len(self.time[cut]) < LEAST:
            raise BadInput(f"--window {self.window[0]:g},{self.window[1]:g}: {len(self.time[cut])} rows there, {LEAST} "
                           f"are needed; the run has {self.time[0]:.6g} to {self.time[-1]:.6g} s")
        modes = fit_modes(self.time[cut], self.signal[cut], self.band, N_MODES)
        least = LISTED * max((mode.amplitude for mode in modes), default=0)
        self.modes = modes[:1] + [mode for mode in modes[1:] if mode.amplitude >= least and mode.error <= KNOWN]
        self.fit_start = self.time[cut][0]
        if modes:
            self.fit = self.modes[0] = modes[0]._replace(error=max(modes[0].error, self.shorter_differs(cut, modes[0])))

    def shorter_differs(self, cut, mode):
        """By how much the growth differs in the first three quarters of the window, 1/s: a window that is not linear to
        its end is seen by this, not by the standard error."""
        first = slice(cut.start, cut.start + 3 * (cut.stop - cut.start) // 4)
        modes = fit_modes(self.time[first], self.signal[first], self.band, 1)
        return abs(modes[0].growth - mode.growth) if modes else 0.0

    def regime(self):
        """A word for it."""
        if not self.line:
            return "at rest" if not numpy.ptp(self.signal[self.steady]) > 0 else "too short to tell"
        if not self.growth:
            change = self.change_of_rms()
            return "steady" if abs(change) <= STEADY else "grows" if change > 0 else "decays"
        if self.growth.slope < 0:
            return "decays"
        if not self.saturated():
            return "grows"
        return "limit cycle" if self.misses_itself() <= RETURNS else "bounded vibration"

    def saturated(self):
        """Whether it grew up to a bound: to a limit cycle where it repeats itself."""
        return bool(self.growth and self.growth.slope >= 0 and self.growth.saturation is not None)

    def misses_itself(self):
        """How far the part that is looked at is from itself a quarter to half of its length later, at the nearest, relative to its size: 0
        where it is periodic, 1 where the two have nothing in common."""
        return nearest_return(self.signal[self.steady])

    def change_of_rms(self):
        """Relative change of the root mean square from the first half of the part that is looked at to its second."""
        values = self.signal[self.steady] - self.signal[self.steady].mean()
        halves = [values[:len(values) // 2].std(), values[len(values) // 2:].std()]
        return halves[1] / halves[0] - 1 if halves[0] > 0 else 0.0

    def find_cycle(self, band):
        """The part after saturation, else the second half; spectrum and main line of this part."""
        if self.saturated() and self.time[-1] - self.growth.saturation > PERIODS / self.line[0]:
            later = part(self.time, self.growth.saturation, self.time[-1])
            line = main_line(self.time[later], self.signal[later], band or self.band)
            self.steady, self.line = (later, line) if line else (self.steady, self.line)
        if self.line:
            length = length_of(self)
            resolution = max(3 / length, self.line[0] / 100)
            self.density = power_density(self.time[self.steady], self.signal[self.steady], resolution)
            self.harmonics = {}  # of what repeats itself; a spectrum of a decay has no such lines
            if self.saturated() or self.regime() == "steady":
                self.harmonics = harmonic_levels(self.time[self.steady], self.signal[self.steady], self.line[0])
            self.other = other_line(self.time[self.steady], self.signal[self.steady], self.line[0], LOWEST)


def vibration_quantities(vibration, unit):
    """Growth, line, amplitudes and harmonics."""
    if vibration.fit:
        yield Quantity("growth_window_start", vibration.window[0], None, "s")
        yield Quantity("growth_window_end", vibration.window[1], None, "s")
        yield Quantity("growth", vibration.fit.growth, vibration.fit.error, "1/s")
        yield Quantity("growth_frequency", vibration.fit.freq, vibration.fit.error / (2 * numpy.pi), "Hz")
        for i, mode in enumerate(vibration.modes[1:], 2):
            yield Quantity(f"growth_{i}", mode.growth, mode.error, "1/s")
            yield Quantity(f"growth_frequency_{i}", mode.freq, mode.error / (2 * numpy.pi), "Hz")
    if vibration.saturated():
        yield Quantity("saturation", vibration.growth.saturation, None, "s")
    if vibration.line:
        values = vibration.signal[vibration.steady]
        values = values - values.mean()
        halves = [values[:len(values) // 2].std(), values[len(values) // 2:].std()]
        apart = 0.5 * abs(halves[1] - halves[0])
        yield Quantity("main_frequency", vibration.line[0], vibration.line[1], "Hz")
        yield Quantity("main_amplitude", vibration.line[2], None, unit)
        yield Quantity("rms", values.std(), apart, unit)
        yield Quantity("peak", abs(values).max(), None, unit)
        yield Quantity("change_of_rms", vibration.change_of_rms(), None, "-")
        if vibration.saturated():
            yield Quantity("misses_itself", vibration.misses_itself(), None, "-")
        for number, level in vibration.harmonics.items():
            yield Quantity(f"harmonic_{number}", level, None, "dB")
        if vibration.other:
            yield Quantity("other_frequency", vibration.other[0], 0.5 / length_of(vibration), "Hz")
            yield Quantity("other_level", vibration.other[1], None, "dB")


def length_of(vibration):
    """Length of the part that is looked at, s."""
    times = vibration.time[vibration.steady]
    return times[-1] - times[0]


def contact_quantities(run, steady):
    """Forces and status in the part that is looked at, and the ledger."""
    normal, friction = run.normal[steady], run.friction[steady]
    yield Quantity("normal_force_mean", normal.mean(), None, "N")
    yield Quantity("normal_force_least", normal.min(), None, "N")
    yield Quantity("normal_force_largest", normal.max(), None, "N")
    yield Quantity("friction_force_mean", friction.mean(), None, "N")
    yield Quantity("detached_share", detached_share(normal), 1 / len(normal), "-")
    status = run.status()
    if status:
        for name, pairs in zip(("open", "stick", "slip"), status):
            yield Quantity(f"pairs_{name}_mean", pairs[steady].mean(), None, "-")
    error = run.ledger_error()
    if error is not None:
        yield Quantity("ledger_error", error.max(), None, "-")


def detached_share(normal):
    """Share of the samples without normal force."""
    return float((normal <= DETACHED * abs(normal).mean()).mean())


def figures(value, error):
    """A number with the digits that its error leaves."""
    if error is None or not numpy.isfinite(error) or not error > 0:
        return f"{value:.6g}"
    digits = max(0, min(12, 1 - int(numpy.floor(numpy.log10(error)))))
    return f"{value:.{digits}f} +- {error:.2g}"


def print_summary(head, quantities):
    """Plain lines."""
    width = max(len(q.name) for q in quantities)
    lines = [f"  {q.name:<{width}}  {figures(q.value, q.error)} {q.unit}".removesuffix(" -") for q in quantities]
    print("\n".join([*head, *lines]))


def write_summary(path, quantities):
    """The table transient_summary.csv."""
    try:
        with path.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("quantity", "value", "error", "unit"))
            for q in quantities:
                error = "" if q.error is None or not numpy.isfinite(q.error) else f"{q.error:.15g}"
                writer.writerow((q.name, f"{q.value:.15g}", error, q.unit))
    except OSError as error:
        raise BadInput(f"cannot write {path}: {error.strerror}") from None
