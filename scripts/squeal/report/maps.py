"""The stability map of a sweep over two parameters: growth of the worst mode, and which mode it is."""

import numpy
from matplotlib import colormaps
from matplotlib.colors import to_hex

from ..sweep.map import GROWTH, Grid, edges
from .charts import Axis, Chart, Panel
from .markup import figure, figures, legend, scale, tag

FAMILIES = ("sky", "orange", "green", "purple", "blue", "steel", "vermilion")  # classes of page.css
TITLES = {"growth": "How fast the worst mode grows", "family": "Which mode it is"}


def families_of(grid):
    """Classes of the labels, by the size of their regions; those beyond the palette share one."""
    names = sorted(grid.families, key=lambda name: -grid.families[name].sum())
    return {name: FAMILIES[i] if i < len(FAMILIES) else "grey" for i, name in enumerate(names)}


def place_text(study, at):
    """Values of both parameters at a cell."""
    return ", ".join(f"{axis.name} {figures(value * axis.factor, 4)} {axis.unit}".rstrip()
                     for axis, value in zip(study.axes, at))


def add_cells(panel, study, grid, limits, colour_of):
    """Rectangles of all points that were computed, and what each tells."""
    rows = [(limits[0][i:i + 2], limits[1][j:j + 2], grid.growth[j, i], grid.label[j, i],
             (grid.values[0][i], grid.values[1][j])) for j, i in zip(*numpy.nonzero(grid.known))]
    tips = [f"{place_text(study, at)}: " + (f"{label or 'a mode'} grows with {figures(growth, 4)} 1/s" if growth > 0
                                            else "stable") for *_, growth, label, at in rows]
    panel.boxes([row[0] for row in rows], [row[1] for row in rows],
                [colour_of(growth, label) if growth > 0 else "stable" for *_, growth, label, _ in rows], tips)


def add_marks(panel, study, grid):
    """Critical values, and points whose growth is within its error."""
    j, i = numpy.nonzero(grid.numerical)
    at = [(grid.values[0][a], grid.values[1][b]) for a, b in zip(i, j)]
    panel.points(*([values[k] * axis.factor for values in at] for k, axis in enumerate(study.axes)), "vermilion hollow",
                 [f"{place_text(study, values)}: numerical, the error bar covers zero" for values in at], 4)
    panel.points(*([row[key] * axis.factor for row in study.onsets] for key, axis in
                   zip(("critical_value", "value_2"), study.axes)), "dark",
                 [f"{row['kind'].replace('_', '-')} at {place_text(study, (row['critical_value'], row['value_2']))}, "
                  f"{row['label']}, {figures(row['freq_hz'], 5)} Hz" for row in study.onsets], 2.5)


def keys_of(study, grid, families):
    """Legend: stable, families with their frequencies, marks."""
    entries = [("stable", "", "stable")]
    for name, colour in families.items():
        low, high = min(grid.frequencies[name]), max(grid.frequencies[name])
        factor, unit = (1e-3, "kHz") if high >= 1000 else (1.0, "Hz")
        texts = dict.fromkeys(figures(value * factor, 3) for value in (low, high))
        entries.append((colour, "", f"{name or 'unnamed'}, {' to '.join(texts)} {unit}"))
    entries += [("dark", "dot", "critical values")] * bool(study.onsets)
    entries += [("vermilion", "hollow", "numerical only")] * bool(grid.numerical.any())
    return legend(entries)


def map_figures(folder, study):
    """Both maps side by side, with what their colours are."""
    grid, (first, second) = Grid(study), study.axes
    limits = [edges(numpy.array(v) * axis.factor, axis.logarithmic) for v, axis in zip(grid.values, study.axes)]
    most, families, pieces = grid.growth.max() or 1.0, families_of(grid), []
    colours = {"growth": lambda growth, _: to_hex(colormaps[GROWTH](growth / most)),
               "family": lambda _, label: families[label]}
    keys = {"growth": scale(lambda share: to_hex(colormaps[GROWTH](share)), f"{figures(grid.growth.max(), 4)} 1/s"),
            "family": keys_of(study, grid, families)}
    for name, title in TITLES.items():
        panel = Panel(Axis(second.title(), *limits[1][[0, -1]], second.logarithmic), 380)
        add_cells(panel, study, grid, limits, colours[name])
        add_marks(panel, study, grid)
        chart = Chart(title, Axis(first.title(), *limits[0][[0, -1]], first.logarithmic), [panel])
        pieces.append(figure(f"{folder.key}-map-{name}", title,
                             [chart.markup(f"{folder.key}-{name}", "half"), keys[name]], "",
                             folder.command("plot/sweep")))
    unknown = (~grid.known).sum()
    said = tag("p", f"{study.title()}. Each cell and each critical value tells its numbers."
               + (f" {unknown} points without a mode are left blank." if unknown else ""), class_="note")
    return [said, tag("div", pieces, class_="pair")]
