"""Table 1 of the seed paper: frequencies (Hz) of the disc's modes, pad of 25.1 GPa, by a linear model (Ansys) and by
the spectrum of a nonlinear one in time (Plast3), and what stands beside them. The one place of these numbers."""

import math
from typing import NamedTuple

from ..tables import read_table

YOUNG = 25.1e9  # Pa, of the pad
COLUMNS = "ansys", "plast3"
# Hz: all frequencies of the second column are multiples of it, to the integers that are printed: lines of a transform
# of 19.27 ms. Hence each is known to half of it.
RESOLUTION = 51.884

ASKED = 0.007  # rms of (0,m+) relative to a column, at most


class Line(NamedTuple):
    """A mode: the paper's name, its frequencies, our labels of both where they differ from that name. The paper's
    (0,7+) at 8594 Hz has twelve changes of sign on its rim, hence our label (0,6+). An impulse at the contact excites
    modes with an antinode there only: the (0,7) of the second column is (0,7+)."""
    name: str
    ansys: float
    plast3: float | None = None
    labels: tuple | None = None

    def label(self, column):
        """Ours, of a mode of that column."""
        return self.labels[COLUMNS.index(column)] if self.labels else self.name

    def is_plus(self):
        """Whether it is a (0,m+)."""
        return self.name.startswith("(0,") and self.name.endswith("+)")


TABLE = (
    Line("(0,4+)", 3495, 3424), Line("(0,4)", 3918), Line("(0,5+)", 4992, 4877), Line("(0,5)", 5736),
    Line("(0,6+)", 6659, 6486), Line("(0,6)", 7956), Line("(0,7+)", 8594, 8353, ("(0,6+)", "(0,6+)")),
    Line("(1,0)", 10126, 10014), Line("(1,1+)", 10358), Line("(0,7)", 10523, 10636, ("(0,7)", "(0,7+)")),
    Line("(1,2+)", 11144, 11155), Line("(1,3+)", 12494, 12348), Line("(0,8)", 13401), Line("(0,8+)", 13700, 13179),
    Line("(1,4)", 14437), Line("(1,4+)", 14475, 14216), Line("(0,9)", 16565), Line("(0,9+)", 16724, 15980),
    Line("(1,5)", 16970), Line("(1,5+)", 17036, 16603), Line("(0,10)", 19989), Line("(0,10+)", 20018, 18938),
)  # fmt: skip


class Beside(NamedTuple):
    """A line, the paper's frequency, our label, ours (Hz; nan where no mode has the label), relative difference."""
    line: Line
    paper: float
    label: str
    ours: float

    @property
    def error(self):
        return self.ours / self.paper - 1


def read_modes(folder):
    """(label, Hz) of modes.csv."""
    rows = read_table(folder / "modes.csv", {"freq_hz": float, "label": str})
    return [(row["label"], row["freq_hz"]) for row in rows]


def read_peaks(folder):
    """(label, Hz) of the modes that make the peaks of peaks.csv, those that have a label."""
    rows = read_table(folder / "peaks.csv", {"mode_freq_hz": float, "label": str})
    return [(row["label"], row["mode_freq_hz"]) for row in rows if row["label"]]


def beside(modes, column):
    """A Beside for each line of a column. Each mode, (label, Hz), serves once: the nearest of that label."""
    left, found = list(modes), []
    for line in TABLE:
        paper, label = getattr(line, column), line.label(column)
        if paper is None:
            continue
        same = [mode for mode in left if mode[0] == label]
        best = min(same, key=lambda mode: abs(mode[1] - paper), default=None)
        if best:
            left.remove(best)
        found.append(Beside(line, paper, label, best[1] if best else math.nan))
    return found


def rms(found):
    """Root mean square of the relative differences of those that were found; nan where none was."""
    errors = [pair.error for pair in found if not math.isnan(pair.ours)]
    return math.sqrt(sum(error**2 for error in errors) / len(errors)) if errors else math.nan


def groups(found):
    """By what makes them: modes (0,m+), which the pad raises, and modes (1,m), which it hardly does."""
    return {"(0,m+)": [pair for pair in found if pair.line.is_plus()],
            "(1,m)": [pair for pair in found if pair.line.name.startswith("(1,")]}
