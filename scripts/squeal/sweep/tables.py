"""Tables of a sweep as its pictures need them: rows, onsets, and the swept parameters as axes."""

from ..provenance import Units
from ..tables import BadInput, flag, optional, prefixed, read_table

SWEEP = {"value": float, "branch": optional, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str,
         "value_2": optional, "class": str, "error_hz": optional, "jump": flag}
ONSETS = {"critical_value": float, "freq_hz": float, "kind": str, "label": str, "branch": int, "partner": optional,
          "confirmed": flag, "value_2": optional}
LINE = 90  # characters of a title
FONTS = {"font.size": 11, "axes.titlesize": 13, "axes.labelsize": 12, "legend.fontsize": 11, "figure.dpi": 150}
PARAMETERS = {"parameter": str, "value": float, "unit": str, "swept": int, "link": str}


class Axis:
    """A parameter: name, unit for people, and the factor from SI to it."""

    def __init__(self, name, unit, values):
        self.name = name
        self.logarithmic = is_logarithmic(values)
        largest = max((abs(value) for value in values), default=0)
        smallest = min((abs(value) for value in values), default=0)
        wide = self.logarithmic and largest > 1e4 * smallest
        self.factor, named = prefixed(largest, unit) if unit in ("Pa", "N/m", "Hz") and not wide else (1.0, unit)
        self.unit = "" if unit == "-" else named
        self.first, self.last = min(values) * self.factor, max(values) * self.factor

    def title(self):
        return f"{self.name}, {self.unit}" if self.unit else self.name

    def range(self):
        values = dict.fromkeys(f"{value:.4g}" for value in (self.first, self.last))
        return f"{self.name} {' to '.join(values)} {self.unit}".rstrip()


def is_logarithmic(values):
    """Whether equal ratios describe the distinct values better than equal steps."""
    values = sorted(set(values))
    if len(values) < 3 or values[0] <= 0 or values[-1] < 5 * values[0]:
        return False
    steps = [b - a for a, b in zip(values, values[1:])]
    ratios = [b / a for a, b in zip(values, values[1:])]
    return max(ratios) / min(ratios) < max(steps) / min(steps)


class Study:
    """The tables of one folder, with the parameters of the axes."""

    def __init__(self, folder, band, at):
        path = folder / "sweep.csv"
        self.rows = read_table(path, SWEEP)
        labels = list(dict.fromkeys(row["label"] for row in self.rows))
        for row in self.rows:  # no branches without left vectors: modes of a label are drawn alike, below 0
            row["branch"] = -1 - labels.index(row["label"]) if row["branch"] != row["branch"] else int(row["branch"])
        self.parameters = read_table(folder / "parameters.csv", PARAMETERS)
        onsets = folder / "onsets.csv"
        self.onsets = read_table(onsets, ONSETS) if onsets.exists() else []
        if not self.rows:
            raise BadInput(f"{path}: has no rows; the sweep found no mode in its band")
        self.restrict_frequency(band)
        self.axes = [self.axis(folder, swept, column) for swept, column in ((1, "value"), (2, "value_2"))
                     if self.rows[0][column] == self.rows[0][column]]
        self.is_map = len(self.axes) == 2
        self.where = ""
        if at is not None:
            self.cut(at)

    def restrict_frequency(self, band):
        """Rows of the band only."""
        first, last = (function(row["freq_hz"] for row in self.rows) for function in (min, max))
        self.band = band
        if band:
            self.rows = [row for row in self.rows if band[0] <= row["freq_hz"] <= band[1]]
            self.onsets = [row for row in self.onsets if band[0] <= row["freq_hz"] <= band[1]]
        if not self.rows:
            raise BadInput(f"--band {band[0]:g},{band[1]:g}: no mode there; the table has {first:.6g} to {last:.6g} Hz")

    def axis(self, folder, swept, column):
        """The parameter of an axis."""
        found = [row for row in self.parameters if row["swept"] == swept]
        if len(found) != 1:
            raise BadInput(f"{folder / 'parameters.csv'}: {len(found)} rows with swept = {swept}, must be one")
        return Axis(found[0]["parameter"], Units(folder).name(found[0]["unit"]), [row[column] for row in self.rows])

    def cut(self, at):
        """One line of the map, at the nearest value of the second parameter."""
        if not self.is_map:
            raise BadInput(f"--at {at:g}: the sweep has one parameter only")
        value = min((row["value_2"] for row in self.rows), key=lambda v: abs(v - at))
        self.rows = [row for row in self.rows if row["value_2"] == value]
        self.onsets = [row for row in self.onsets if row["value_2"] == value]
        axis = self.axes.pop()
        self.where, self.is_map = f"{axis.name} {value * axis.factor:.4g} {axis.unit}".rstrip(), False

    def title(self):
        """Ranges, and of the friction coefficients that do not vary those that a line has room for, three at most."""
        fixed = [f"{row['parameter']} {row['value']:.4g}" for row in self.parameters
                 if row["swept"] == 0 and not row["link"] and row["parameter"].endswith(("_mu", "_mu_static", "_mu_kinetic"))]
        linked = [[row["parameter"] for row in self.parameters if row["link"] == axis.name] for axis in self.axes]
        ranges = [" and ".join([axis.name, *names]) + axis.range().removeprefix(axis.name) for axis, names in zip(self.axes, linked)]
        words = [*ranges, *filter(None, [self.where])]
        for word in fixed[:3]:
            words += [word] if len(", ".join([*words, word])) <= LINE else []
        return ", ".join(words)
