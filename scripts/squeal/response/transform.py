"""Frequency response from the record of an impulse, and its peaks. Used by scripts/response.

H(f) = integral of y(t) w(t) exp(-2 pi i f t) dt, y the displacement per N s, from the impulse on. The window w is 1
where the record has decayed. Else it is exp(-a t), which adds a to the decay of every mode: identified modes have it
taken off again, and so has the response by what it does to the parts of these modes, r / (i omega - lambda).
"""

import math
from typing import NamedTuple

import numpy

from ..modes.disc_names import name_shape
from .identify import LEFT, Modal, decay_of_window, identify, transform
from ..transient.signal import TWO_PI, interval
from ..tables import BadInput

DECAYED = 1e-3  # part of the largest motion at which a record is over
TAIL = 0.02  # of the record, where this is looked at
WIDTH = 3000.0  # Hz, of the bands in which modes are identified
PERIODS = 4  # of the lowest frequency in a record, at least
SEEN = 0.05  # part of the response at its frequency that makes a mode a peak


class Window(NamedTuple):
    """Added decay (1/s), 0 for none, and words."""
    decay: float
    words: str


class Peak(NamedTuple):
    """Frequency of the maximum (Hz), response there (m/N), the mode and its label."""
    freq: float
    magnitude: float
    mode: Modal
    label: str


def choose_window(time, values, kind):
    """The window that was asked for, or that the record needs."""
    size = numpy.linalg.norm(values, axis=1)
    left = numpy.sqrt((size[-max(int(TAIL * len(size)), 1):]**2).mean()) / max(size.max(), 1e-300)
    if kind == "rectangular" and left > DECAYED:
        raise BadInput(f"--window rectangular: at the end of the record {left:.1e} of the largest motion is left, must "
                       f"be {DECAYED:g} at most; use a longer one, or --window exponential")
    if kind == "rectangular" or (kind == "auto" and left <= DECAYED):
        return Window(0.0, f"rectangular window of {time[-1]:.6g} s, at whose end {left:.1e} of the largest motion is "
                           "left")
    decay = decay_of_window(time)
    return Window(decay, f"exponential window of {time[-1]:.6g} s, from 1 to {LEFT:g}; the decay of {decay:.6g} 1/s "
                         "that it adds is taken off all modes")


def modal_sum(modes, freq, shift=0.0):
    """Parts of modes in the response at i omega + shift."""
    s = 1j * TWO_PI * freq[:, None] + shift
    parts = [mode.residue / (s - mode.exponent) + mode.residue.conj() / (s - numpy.conj(mode.exponent))
             for mode in modes]
    return sum(parts) if parts else 0


def limits(time):
    """Least and largest frequency that a record can tell, Hz."""
    return PERIODS / time[-1], 0.25 / interval(time)


def usual_frequencies(time):
    """Each 10 Hz from 500 to 20000 Hz, as far as the record can tell them."""
    lowest, highest = limits(time)
    return numpy.arange(max(50, math.ceil(lowest / 10)), min(2000, int(highest / 10)) + 1) * 10.0


class Response:
    """`freq` (Hz), `values` [frequency][output] (m/N), `error` (m/N, estimate, of all outputs together), `modes`,
    `peaks`, `window`."""

    def __init__(self, record, freq, kind="auto"):
        time = record.time
        self.check(time, freq)
        self.record, self.freq = record, freq
        self.window = choose_window(time, record.values, kind)
        windowed = record.values * numpy.exp(-self.window.decay * time)[:, None]
        self.modes = identify(time, record.values, (0, min(freq[-1] + 2 * WIDTH, 0.4 / interval(time))), WIDTH)
        self.values = transform(time, windowed, freq)
        self.error = self.estimate(time, windowed)
        if self.window.decay:
            self.values += modal_sum(self.modes, freq) - modal_sum(self.modes, freq, self.window.decay)
        self.magnitude = numpy.linalg.norm(self.values, axis=1)
        self.peaks = self.find_peaks()

    @staticmethod
    def check(time, freq):
        """Raises an error for frequencies that the record cannot tell."""
        lowest, highest = limits(time)
        if highest - lowest < 1 / time[-1]:
            raise BadInput(f"the record of {time[-1]:.6g} s after the impulse is too short: it can tell frequencies "
                           f"from {lowest:.6g} Hz, {PERIODS} periods, to {highest:.6g} Hz, four rows to a period; give a "
                           "larger --length, or let the run go on")
        if len(freq) < 3 or freq[-1] > highest or freq[0] < lowest:
            asked = f"{freq[0]:.6g} to {freq[-1]:.6g} Hz" if len(freq) else "(none fits)"
            raise BadInput(f"--frequencies {asked} must lie between {lowest:.6g} Hz, "
                           f"{PERIODS} periods in the record, and {highest:.6g} Hz, four rows to a period")

    def estimate(self, time, windowed):
        """Of the rule of integration, a third of what every second row would change, since its error goes with the
        square of the interval; of the end, what the last tenth of the record changes."""
        half = transform(time[::2], windowed[::2], self.freq)
        n = int(0.9 * len(time))
        short = transform(time[:n], windowed[:n], self.freq)
        return numpy.hypot(numpy.linalg.norm(self.values - half, axis=1) / 3,
                           numpy.linalg.norm(self.values - short, axis=1))

    def label(self, mode):
        """(n,m+) of the operating shape on the circles; empty without circles."""
        circles, from_contact = {}, False
        for name, value in zip(self.record.names, mode.residue):
            node = self.record.nodes.get(name)
            if node:
                circles.setdefault(node["circle"], []).append((node["radius_m"], node["angle_rad"], value))
                from_contact = bool(node["from_contact"])
        columns = [[numpy.array(column) for column in zip(*rows)] for rows in circles.values()]
        return name_shape([(r.real.mean(), a.real, v) for r, a, v in columns], from_contact) if columns else ""

    def find_peaks(self):
        """Modes that make at least some of the response at their frequency."""
        peaks, m = [], self.magnitude
        tops = 1 + numpy.flatnonzero((m[1:-1] > m[:-2]) & (m[1:-1] >= m[2:]))
        for mode in self.modes:
            if not self.freq[0] <= mode.freq <= self.freq[-1]:
                continue
            at = abs(self.freq - mode.freq).argmin()
            near = tops[abs(self.freq[tops] - mode.freq) <= max(2 * (self.freq[1] - self.freq[0]),
                                                               mode.damping * mode.freq)]
            if len(near):
                at = near[abs(self.freq[near] - mode.freq).argmin()]
            if mode.exponent.real < 0 and mode.height >= SEEN * m[at]:
                peaks.append(Peak(self.freq[at] if len(near) else mode.freq, m[at], mode, self.label(mode)))
        if not peaks:
            raise BadInput(f"--frequencies {self.freq[0]:.6g} to {self.freq[-1]:.6g} Hz: no peak of a mode in the "
                           "response there; choose others, or a node that the modes move")
        return peaks
