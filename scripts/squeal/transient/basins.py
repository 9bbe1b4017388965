"""Which motion the disturbed runs of a map end in, as a picture. Used by plot/map."""

import math

import matplotlib.pyplot as plt

from ..picture import BLUE, GREEN, INK, VERMILION
from ..tables import BadInput, optional, read_table
from .vibration_map import unit_of

RUNS = {"value": float, "value_2": optional, "energy_j": float, "regime": str}
BASINS = {"value": float, "value_2": optional, "regime": str, "runs": int, "of": int, "probability": float,
          "probability_low": float, "probability_high": float}
LOOKS = {"stable": ("comes to rest", BLUE, "o"), "growth": ("still grows", GREEN, "^"), "cycle": ("squeals", VERMILION, "s"),
         "sticking": ("squeals, and sticks", "#CC79A7", "D"),
         "quasi_periodic": ("squeals on two lines", "#E69F00", "v"), "unknown": ("unknown", INK, "x")}


def draw_probabilities(axes, rows):
    """Of each regime over the parameter, with their intervals."""
    for regime in (name for name in LOOKS if any(row["regime"] == name for row in rows)):
        name, colour, marker = LOOKS[regime]
        own = [row for row in rows if row["regime"] == regime]
        values = [row["probability"] for row in own]
        bars = [[p - row["probability_low"] for p, row in zip(values, own)], [row["probability_high"] - p for p, row in zip(values, own)]]
        axes.errorbar([row["value"] for row in own], values, bars, ls="", marker=marker, color=colour, capsize=3, ms=6, label=name)
    axes.set_ylabel("probability, 95 %")
    axes.set_ylim(-0.03, 1.03)


def draw_energies(axes, runs):
    """Each run by its parameter and its energy."""
    for regime, (name, colour, marker) in LOOKS.items():
        own = [run for run in runs if run["regime"] == regime]
        axes.plot([run["value"] for run in own], [run["energy_j"] for run in own], ls="", marker=marker, ms=5, color=colour, label=name)
    axes.set_yscale("log")
    axes.set_ylabel("energy of the disturbance, J")


def draw_basins(folder, parameter):
    """A column of panels for each value of the second parameter: probabilities, and runs by energy."""
    runs, rows = read_table(folder / "map_disturbed.csv", RUNS), read_table(folder / "map_basins.csv", BASINS)
    if not runs or not rows:
        raise BadInput(f"{folder / 'map_basins.csv'}: has no rows")
    seconds = sorted({row["value_2"] for row in rows}, key=lambda value: (math.isnan(value), value))
    if any(math.isnan(value) for value in seconds):
        seconds = [None]
    figure, panels = plt.subplots(2, len(seconds), figsize=(1.5 + 5.5 * len(seconds), 7.5), sharex=True, sharey="row", squeeze=False,
                                  layout="constrained")
    for column, second in zip(panels.T, seconds):
        draw_probabilities(column[0], [row for row in rows if second is None or row["value_2"] == second])
        draw_energies(column[1], [run for run in runs if second is None or run["value_2"] == second])
        column[0].set_title(f"{rows[0]['of']} disturbed runs of each point" if second is None else f"{second:g}", loc="left")
        column[1].set_xlabel(f"{parameter}, {unit_of(parameter)}")
    handles = {}
    for axes in panels.flat:
        handles.update({label: handle for handle, label in zip(*axes.get_legend_handles_labels())
                        if any(LOOKS[row["regime"]][0] == label for row in rows)})
    figure.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))  # room for the legend
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=len(handles), frameon=False)
    return figure
