#!/usr/bin/python3
"""Draws a sweep that squeal computed.

One parameter: above, frequency against the parameter; below, growth rate (1/s; above zero a mode grows). Modes that are
unstable somewhere, or that meet another one, are coloured and named, the others are grey. Unstable points are large
and red; hollow ones are `numerical`: their error bar covers zero. Triangles are the onsets with their critical values.
Error bars are drawn where they can be seen.

Two parameters: the stability map. Left, the largest growth rate of all modes and the border of stability; right, which
mode it is.

Reads sweep.csv and parameters.csv, and onsets.csv where there is one.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import squeal_tables as tables
from squeal_tables import BadInput, flag, optional
from sweep_lines import draw_lines
from sweep_map import draw_map

SWEEP = {"value": float, "branch": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str,
         "value_2": optional, "class": str, "error_hz": optional, "jump": flag}
ONSETS = {"critical_value": float, "freq_hz": float, "kind": str, "label": str, "branch": int, "partner": optional,
          "confirmed": flag, "value_2": optional}
PARAMETERS = {"parameter": str, "value": float, "unit": str, "swept": int}
DPI = 150
FONTS = {"font.size": 11, "axes.titlesize": 13, "axes.labelsize": 12, "legend.fontsize": 11, "figure.dpi": DPI}


class Axis:
    """A parameter: name, unit for people, and the factor from SI to it."""

    def __init__(self, name, unit, values):
        self.name = name
        self.logarithmic = is_logarithmic(values)
        largest = max((abs(value) for value in values), default=0)
        smallest = min((abs(value) for value in values), default=0)
        prefix, self.factor = "", 1.0
        if unit in ("Pa", "N/m", "Hz") and not (self.logarithmic and largest > 1e4 * smallest):
            prefix, self.factor = next(((p, f) for p, f in (("G", 1e-9), ("M", 1e-6), ("k", 1e-3))
                                        if largest * f >= 1), ("", 1.0))
        self.unit = prefix + unit if unit not in ("-", "") else ""
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
        self.rows = tables.read_table(path, SWEEP)
        self.parameters = tables.read_table(folder / "parameters.csv", PARAMETERS)
        onsets = folder / "onsets.csv"
        self.onsets = tables.read_table(onsets, ONSETS) if onsets.exists() else []
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
        return Axis(found[0]["parameter"], found[0]["unit"], [row[column] for row in self.rows])

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
        """Ranges, and the friction coefficients that do not vary."""
        fixed = [f"{row['parameter']} {row['value']:.4g}" for row in self.parameters
                 if row["swept"] == 0 and row["parameter"].endswith("_mu")]
        return ", ".join([*(axis.range() for axis in self.axes), *filter(None, [self.where]), *fixed[:3]])


def frequencies(text):
    """The band of the command line."""
    try:
        first, last = map(float, text.split(","))
    except ValueError:
        first, last = 0, 0
    if not first < last:
        raise argparse.ArgumentTypeError(f"{text}: must be two frequencies in Hz, the smaller one first: 2500,6000")
    return first, last


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("results"),
                        help="folder that squeal wrote, default: results")
    parser.add_argument("-o", "--output", type=Path, help="picture to write, default: sweep.png in that folder")
    parser.add_argument("--band", type=frequencies, metavar="F1,F2", help="only modes between these frequencies, Hz")
    parser.add_argument("--labels", choices=("auto", "all", "none"), default="auto",
                        help="which modes to name, default: the coloured ones")
    parser.add_argument("--at", type=float, metavar="VALUE",
                        help="two parameters: one line only, at this value (SI) of the second one, or the nearest")
    panels = parser.add_mutually_exclusive_group()
    panels.add_argument("--frequency-only", action="store_true", help="one parameter: the upper part only")
    panels.add_argument("--growth-only", action="store_true", help="one parameter: the lower part only")
    return parser.parse_args()


def draw(args):
    """Reads and draws; returns the picture's name."""
    study = Study(args.folder, args.band, args.at)
    output = args.output or args.folder / "sweep.png"
    with plt.rc_context(FONTS):
        if study.is_map:
            figure = draw_map(study)
        else:
            panels = [name for name, other in (("frequency", args.growth_only), ("growth", args.frequency_only))
                      if not other]
            figure = draw_lines(study, panels, args.labels)
        tables.save_picture(figure, output)
    return output


if __name__ == "__main__":
    sys.exit(tables.run("plot_sweep", lambda: draw(arguments())))
