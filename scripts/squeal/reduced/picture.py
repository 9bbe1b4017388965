"""Picture of study/reduced: time of a run over its error."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from ..picture import BLUE, GREY, VERMILION, save_picture

LEAST = 1e-8  # errors below it are drawn there


def draw_panel(axes, points, unit, names):
    """One error of each colour, cut-off (kHz) and step (us) beside the first one."""
    for values, name, colour, marker in (([p.growth for p in points], names[0], BLUE, "o"),
                                         ([p.frequency for p in points], names[1], VERMILION, "s")):
        axes.loglog([max(value, LEAST) for value in values], [p.seconds / unit for p in points], marker, color=colour,
                    label=name)
    for p in points:
        axes.annotate(f"{1e-3 * p.cutoff:g} kHz, {1e6 * p.step:g} \u00b5s", (max(p.growth, LEAST), p.seconds / unit),
                      (6, 4), textcoords="offset points", fontsize=7, color=GREY)
    axes.set_xlabel("relative error")
    axes.legend(fontsize=8)
    axes.margins(0.25, 0.1)


def draw_speed(path, growth, cycles, unit):
    """Growth against the eigenvalue of the mesh, and the limit cycle against the finest run."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
    draw_panel(panels[0], growth, unit, ("growth", "frequency"))
    draw_panel(panels[1], cycles, unit, ("rms of the force", "frequency"))
    panels[0].set_title("growth in time, against the eigenvalue of the mesh", fontsize=10)
    panels[1].set_title("limit cycle, against the finest run", fontsize=10)
    panels[0].set_ylabel("time of 50 ms, of the mesh's by the general kernel")
    save_picture(figure, path, dpi=100)
    plt.close(figure)
    print(f"\n{path}")
