"""Error of each element against unknowns, time and memory."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from ..picture import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, plain_ticks, save_picture

STYLES = {"tet4": (GREY, "v", "--"), "tet10": (VERMILION, "v", "-"), "wedge6": (SKY, "<", "--"), "wedge15": (PURPLE, "<", "-"),
          "hex8 full": (INK, "s", ":"), "hex8 QM6": (BLUE, "s", "--"), "hex20": (GREEN, "o", "-"), "hex27": (ORANGE, "D", "-")}
COSTS = {"unknowns": "unknowns", "seconds": "processor time, s", "megabytes": "peak memory, MB"}


def draw_errors(path, problems, asked):
    """One row for each problem: name -> element -> [(Result, error)]; a line at the error that is asked."""
    figure, panels = plt.subplots(len(problems), len(COSTS), figsize=(9, 2.4 * len(problems)), sharey="row", squeeze=False,
                                  layout="constrained")
    for row, (name, series) in zip(panels, problems.items()):
        for axes, (cost, label) in zip(row, COSTS.items()):
            for element, points in series.items():
                color, marker, line = STYLES[element]
                axes.loglog([getattr(result, cost) for result, _ in points], [100 * error for _, error in points], line,
                            color=color, marker=marker, markersize=4, linewidth=1.2, label=element)
            axes.axhline(100 * asked, color=INK, linewidth=0.7)
            axes.grid(True, which="major", linewidth=0.3)
            plain_ticks(axes.xaxis, "258")
            axes.set_xlabel(label)
        row[0].set_ylabel("worst error, %")
        row[0].set_ylim(bottom=0.005)
        row[1].set_title(name, fontsize=10)
    panels[0][0].legend(loc="lower left", fontsize=7, ncols=2)
    save_picture(figure, path)
