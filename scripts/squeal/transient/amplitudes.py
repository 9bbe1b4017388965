"""Amplitudes of modes in a transient, from amplitudes.csv, beside what the eigenvalues say. Used by plot/amplitudes and
study/ranking."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy

from ..provenance import Provenance, Units
from .signal import LEAST
from ..tables import BadInput, read_table
from .history import open_table, read_columns

MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "label": str}
PARTED = numpy.log(1.1)  # of the logarithm: an amplitude that is 10 % off its exponential has left it
LINEAR = 0.5  # least change of the logarithm from which a growth is found


class Amplitude(NamedTuple):
    """Of one mode: c at each time (m), its eigenvalue (Hz, 1/s; nan where it is not known)."""
    mode: int
    values: numpy.ndarray
    freq: float = numpy.nan
    growth: float = numpy.nan
    label: str = ""

    @property
    def name(self):
        """Number, label, frequency; the number alone where no more is known."""
        return f"{self.mode}  {self.label}  {self.freq:.0f} Hz" if self.label else f"mode {self.mode}"


class Straight(NamedTuple):
    """While an amplitude follows its eigenvalue: from (s), |c| there (m), until (s), growth found there (1/s, nan where
    it changes too little)."""
    first: float
    size: float
    last: float
    growth: float


def last_event(scene):
    """Time after which nothing acts but the sliding: the end of the ramps, the last blow, s."""
    blows = [scene.number(f"{name}_time") for name in scene.names("impulses")]
    ramps = [scene.number(f"{name}_delay") + scene.number(f"{name}_ramp")
             for kind in ("loads", "motions", "contacts") for name in scene.names(kind)]
    return max([0.0, *blows, *(ramps if scene.value("dynamics_start") != "static" else [])])


def folder_of_modes(folder, scene):
    """That of -dynamics_filters, relative to where the run was started; None where it is not there."""
    given = scene.value("dynamics_filters") if scene else ""
    places = [Path(scene.facts.get("in", ".")) / given, Path(given), folder.parent / Path(given).name] if given else []
    return next((place for place in places if (place / "modes.csv").exists()), None)


class Amplitudes:
    """`time` (s), `modes`: an Amplitude each, `start`: after the last_event(); `source`: folder of the eigenvalues, or
    None. `modes_folder`: where the caller knows it."""

    def __init__(self, folder, modes_folder=None):
        self.path, self.under_way = open_table(folder, "amplitudes.csv")
        if not self.path.exists():
            raise BadInput(f"{self.path}: no such file; run squeal -analysis transient with -dynamics_filters, the "
                           "folder of a run of modes with -modes_filters")
        columns = read_columns(self.path, self.under_way, ("time_s",))
        try:
            scene = Provenance(folder / "scene.yaml")
        except BadInput:
            scene = None
        self.time, self.scale = columns["time_s"], Units(folder).factor("m")
        self.start = last_event(scene) if scene else 0.0
        self.source = modes_folder or folder_of_modes(folder, scene)
        known = {row["mode"]: row for row in read_table(self.source / "modes.csv", MODES)} if self.source else {}
        numbers = [int(found[1]) for found in (re.fullmatch(r"mode_(\d+)_re_m", name) for name in columns) if found]
        if not numbers or any(f"mode_{number}_im_m" not in columns for number in numbers):
            raise BadInput(f"{self.path}: no pair of columns mode_<number>_re_m and mode_<number>_im_m")
        self.modes = [self.amplitude(number, columns, known) for number in numbers]

    def amplitude(self, number, columns, known):
        """One mode."""
        values = self.scale * (columns[f"mode_{number}_re_m"] + 1j * columns[f"mode_{number}_im_m"])
        if not known:
            return Amplitude(number, values)
        if number not in known:
            raise BadInput(f"{self.source / 'modes.csv'}: no mode {number}, which {self.path} has")
        row = known[number]
        return Amplitude(number, values, row["freq_hz"], row["growth_rad_s"], row["label"])

    def straight(self, mode):
        """The part after the last event in which ln|c| follows the eigenvalue; None where it is not known, or nothing
        is left."""
        size = abs(mode.values)
        after = numpy.flatnonzero((self.time > self.start) & (size > 0))
        if len(after) < LEAST or not numpy.isfinite(mode.growth):
            return None
        time, logarithm = self.time[after], numpy.log(size[after])
        off = abs(logarithm - logarithm[0] - mode.growth * (time - time[0])) > PARTED
        n = off.argmax() if off.any() else len(after)
        found = numpy.nan
        if n >= LEAST and abs(mode.growth) * (time[n - 1] - time[0]) >= LINEAR:
            found = numpy.polyfit(time[:n], logarithm[:n], 1)[0]
        return Straight(time[0], size[after[0]], time[max(n - 1, 0)], found)

    def line(self, mode):
        """Ends (s) and sizes (m) of the exponential of the eigenvalue: from the last event until it reaches the largest
        amplitude of all; None without straight()."""
        part = self.straight(mode)
        if not part:
            return None
        last = self.time[-1]
        largest = max(abs(other.values).max() for other in self.modes)
        if mode.growth > 0:
            last = min(last, part.first + numpy.log(max(largest / part.size, 1.0)) / mode.growth)
        times = numpy.array([part.first, max(last, part.first)])
        return times, part.size * numpy.exp(mode.growth * (times - part.first))

    def leads_from(self, mode):
        """Time from which this mode has the largest amplitude until the end, s; None where another one has it."""
        other = numpy.max([abs(m.values) for m in self.modes if m is not mode] or [0 * self.time], axis=0)
        behind = numpy.flatnonzero(abs(mode.values) <= other)
        at = behind[-1] + 1 if len(behind) else 0
        return self.time[at] if at < len(self.time) else None
