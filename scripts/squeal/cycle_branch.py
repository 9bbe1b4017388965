"""A branch of limit cycles as a bifurcation diagram. Used by plot/cycle."""

import math

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

from .picture import BLUE, INK, VERMILION
from .tables import BadInput, flag, optional, read_table

COLUMNS = {"point": int, "parameter": str, "value": optional, "freq_hz": float, "freq_error_hz": optional,
           "force_mean_n": float, "force_rms_n": float, "force_rms_error_n": optional, "force_peak_n": float,
           "force_peak_error_n": optional, "open_share": float, "multiplier_abs": float, "unstable": flag}


class Branch:
    """Rows of cycle.csv in their order along the branch."""

    def __init__(self, folder):
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
        """Rows at which the parameter turns back."""
        at = self.column("value")
        return [k for k in range(1, len(at) - 1) if (at[k] - at[k - 1]) * (at[k + 1] - at[k]) < 0]


def draw_line(axes, branch, name, error=None):
    """A column over the parameter: unstable pieces are dashed, and their points hollow; bars where there is an error."""
    x, y = branch.column("value"), branch.column(name)
    unstable = branch.column("unstable")
    bars = [0 if math.isnan(e) else e for e in branch.column(error)] if error else [0] * len(x)
    for k in range(len(x) - 1):
        bad = unstable[k] and unstable[k + 1]
        axes.plot(x[k:k + 2], y[k:k + 2], color=VERMILION if bad else BLUE, linestyle="--" if bad else "-", lw=1.4)
    for bad, colour in ((False, BLUE), (True, VERMILION)):
        chosen = [k for k in range(len(x)) if unstable[k] == bad]
        axes.errorbar([x[k] for k in chosen], [y[k] for k in chosen], [bars[k] for k in chosen], fmt="o", ms=4.5,
                      color=colour, mfc="white" if bad else colour, ecolor=INK, elinewidth=1, capsize=2.5, zorder=3)


def draw_branch(branch):
    """Amplitude, frequency and the largest multiplier over the parameter."""
    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(8, 9.5), layout="constrained",
                                  height_ratios=(1.4, 1, 1))
    draw_line(panels[0], branch, "force_peak_n", "force_peak_error_n")
    draw_line(panels[0], branch, "force_rms_n", "force_rms_error_n")
    for name, text in (("force_peak_n", "largest"), ("force_rms_n", "rms about the mean")):
        panels[0].annotate(text, (branch.rows[-1]["value"], branch.rows[-1][name]), (-6, -18), ha="right",
                           textcoords="offset points")
    panels[0].set_ylabel("normal force, N")
    panels[0].set_ylim(bottom=0)
    draw_line(panels[1], branch, "freq_hz", "freq_error_hz")
    panels[1].set_ylabel("frequency, Hz")
    draw_line(panels[2], branch, "multiplier_abs")
    panels[2].axhline(1, color=INK, lw=0.8)
    panels[2].set_ylabel("largest Floquet multiplier")
    panels[2].set_xlabel(branch.parameter)
    for k in branch.folds():
        for axes in panels[:2]:
            axes.axvline(branch.rows[k]["value"], color=INK, lw=0.8, ls=":")
    panels[0].legend(handles=[Line2D([], [], color=BLUE, marker="o", label="stable"),
                              Line2D([], [], color=VERMILION, ls="--", marker="o", mfc="white", label="unstable"),
                              Line2D([], [], color=INK, marker="_", ls="", label="error, twice the steps")],
                     loc="upper left")
    panels[0].set_title(f"limit cycles over {branch.parameter}")
    return figure
