"""A branch of limit cycles as a bifurcation diagram. Used by plot/cycle."""

import math

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

from ..picture import BLUE, GREY, INK, VERMILION
from ..provenance import Units
from ..tables import BadInput, optional, read_table

COLUMNS = {"point": int, "parameter": str, "value": optional, "value_error": optional, "kind": str, "freq_hz": float,
           "freq_error_hz": optional, "force_rms_n": float, "force_rms_error_n": optional, "force_peak_n": float,
           "force_peak_error_n": optional, "multiplier_abs": float, "multiplier_error": optional, "class": str}
PROBES = {"point": int, "probe": str, "direction": str, "velocity_rms_m_s": float, "velocity_rms_error_m_s": optional,
          "velocity_peak_m_s": float, "velocity_peak_error_m_s": optional}
COLOURS = {"stable": BLUE, "unstable": VERMILION, "numerical": GREY, "unverified": GREY}
TOLD = {"numerical": "stability within its error", "unverified": "stability not verified"}


class Branch:
    """Rows of cycle.csv in their order along the branch."""

    def __init__(self, folder):
        self.folder = folder
        self.rows = read_table(folder / "cycle.csv", COLUMNS)
        if not self.rows:
            raise BadInput(f"{folder / 'cycle.csv'}: has no rows")
        self.parameter = self.rows[0]["parameter"]
        if not self.parameter:
            raise BadInput(f"{folder / 'cycle.csv'}: holds one cycle and no branch; -cycle_parameter follows one")

    def column(self, name):
        """Its values in order."""
        return [row[name] for row in self.rows]

    def folds(self):
        """Values of the parameter at which it turns back, and their errors."""
        return [(row["value"], row["value_error"]) for row in self.rows if row["kind"] == "fold"]

    def take_probe(self, text):
        """Adds what a probe does to the rows: of `name,direction`, or the direction in which `name` moves fastest."""
        path = self.folder / "cycle_probes.csv"
        name, _, direction = text.partition(",")
        rows = read_table(path, PROBES)
        names = sorted({row["probe"] for row in rows})
        if name not in names:
            raise BadInput(f"--probe {name}: {path} has {', '.join(names)}")
        chosen = [row for row in rows if row["probe"] == name]
        if direction not in ("", "x", "y", "z"):
            raise BadInput(f"--probe {text}: the direction must be x, y or z")
        if not direction:
            direction = max(chosen, key=lambda row: row["velocity_peak_m_s"])["direction"]
        found = {row["point"]: row for row in chosen if row["direction"] == direction}
        for row in self.rows:
            row.update({column: found[row["point"]][column] for column in PROBES if column.startswith("velocity")})
        return f"velocity of {name} along {direction}, {Units(self.folder).name('m/s')}"


def draw_line(axes, branch, name, error=None):
    """A column over the parameter: pieces that are not stable are dashed, and their points hollow; bars where there is
    an error."""
    x, y = branch.column("value"), branch.column(name)
    kinds = branch.column("class")
    bars = [0 if math.isnan(e) else e for e in branch.column(error)] if error else [0] * len(x)
    for k in range(len(x) - 1):
        kind = next((one for one in ("stable", "unstable") if one in kinds[k:k + 2]), kinds[k])
        axes.plot(x[k:k + 2], y[k:k + 2], color=COLOURS[kind], linestyle="-" if kind == "stable" else "--", lw=1.4)
    for kind, colour in COLOURS.items():
        chosen = [k for k in range(len(x)) if kinds[k] == kind]
        axes.errorbar([x[k] for k in chosen], [y[k] for k in chosen], [bars[k] for k in chosen], fmt="o", ms=4.5,
                      color=colour, mfc=colour if kind == "stable" else "white", ecolor=INK, elinewidth=1, capsize=2.5,
                      zorder=3)


def inwards(branch, value, distance):
    """How a text beside a value stands towards the middle of the range: offset in points, and alignment."""
    values = branch.column("value")
    right = value > (min(values) + max(values)) / 2
    return (-distance, "right") if right else (distance, "left")


def draw_amplitude(axes, branch, columns, label):
    """Largest value and rms of what vibrates."""
    last = branch.rows[-1]
    offset, side = inwards(branch, last["value"], 6)
    for name, text in zip(columns, ("largest", "rms about the mean")):
        draw_line(axes, branch, name, name.replace("_n", "_error_n").replace("_m_s", "_error_m_s"))
        axes.annotate(text, (last["value"], last[name]), (offset, -18), ha=side, textcoords="offset points")
    axes.set_ylabel(label)
    axes.set_ylim(bottom=0)


def fold_text(value, error):
    """Where a fold is, with its error."""
    return f" {value:.6g}" + ("" if math.isnan(error) else f" \u00b1 {error:.1g}")


def draw_branch(branch, probe=None):
    """Amplitude, frequency and the largest multiplier over the parameter; the amplitude is that of the normal force, or the
    velocity of a probe."""
    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(8, 9.5), layout="constrained",
                                  height_ratios=(1.4, 1, 1))
    if probe:
        draw_amplitude(panels[0], branch, ("velocity_peak_m_s", "velocity_rms_m_s"), branch.take_probe(probe))
    else:
        draw_amplitude(panels[0], branch, ("force_peak_n", "force_rms_n"), "normal force, N")
    draw_line(panels[1], branch, "freq_hz", "freq_error_hz")
    panels[1].set_ylabel("frequency, Hz")
    draw_line(panels[2], branch, "multiplier_abs", "multiplier_error")
    panels[2].axhline(1, color=INK, lw=0.8)
    panels[2].set_ylabel("largest Floquet multiplier")
    panels[2].set_xlabel(branch.parameter)
    for value, error in branch.folds():
        for axes in panels[:2]:
            axes.axvline(value, color=INK, lw=0.8, ls=":")
        offset, side = inwards(branch, value, 4)
        panels[1].annotate(f"fold{fold_text(value, error)}", (value, 0.04), (offset, 0), ha=side, fontsize="small",
                           xycoords=("data", "axes fraction"), textcoords="offset points")
    marks = [Line2D([], [], color=COLOURS[kind], marker="o", ls="-" if kind == "stable" else "--",
                    mfc=COLOURS[kind] if kind == "stable" else "white",
                    label=TOLD.get(kind, kind))
             for kind in COLOURS if kind in branch.column("class")]
    panels[0].legend(handles=[*marks, Line2D([], [], color=INK, marker="_", ls="", label="error of the steps")],
                     loc="best")
    panels[0].set_title(f"limit cycles over {branch.parameter}")
    return figure
