"""Stability map of a sweep over two parameters: growth and the modes that are unstable. Used by plot/sweep."""

import collections
import math

import matplotlib.pyplot as plt
import numpy
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ..picture import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION
from ..tables import BadInput

FAMILIES = [BLUE, ORANGE, GREEN, PURPLE, SKY, "#8C510A", VERMILION]
STABLE = "#F1F1F1"
SIZE = 12, 6.4  # inches
GROWTH = "YlOrRd"


class Grid:
    """Largest growth of the unstable modes at every pair of values, and the label of that mode."""

    def __init__(self, study):
        self.values = [sorted({row[name] for row in study.rows}) for name in ("value", "value_2")]
        place = [{value: i for i, value in enumerate(values)} for values in self.values]
        shape = len(self.values[1]), len(self.values[0])
        self.known, self.numerical = numpy.zeros(shape, bool), numpy.zeros(shape, bool)
        self.growth, self.stable = numpy.zeros(shape), numpy.full(shape, -math.inf)
        self.label = numpy.full(shape, None, dtype=object)
        self.families, self.frequencies = {}, collections.defaultdict(list)
        for row in study.rows:
            self.add(row, (place[1][row["value_2"]], place[0][row["value"]]))
        self.numerical &= self.growth == 0

    def add(self, row, at):
        """One mode."""
        self.known[at] = True
        if row["class"] != "unstable":
            self.numerical[at] |= row["class"] == "numerical"
            self.stable[at] = max(self.stable[at], row["growth_rad_s"])
            return
        self.families.setdefault(row["label"], numpy.zeros(self.known.shape, bool))[at] = True
        self.frequencies[row["label"]].append(row["freq_hz"])
        if row["growth_rad_s"] > self.growth[at]:
            self.growth[at], self.label[at] = row["growth_rad_s"], row["label"]

    def border(self):
        """A field that changes sign at the border: growth where decay is known too, else (without damping it is zero
        on the stable side, and linear interpolation has no meaning) halfway between the points."""
        unstable = self.growth > 0
        stable = self.stable[self.known & ~unstable]
        if len(stable) and stable.max() < -1e-6 * self.growth.max():
            return numpy.where(unstable, self.growth, self.stable)
        return numpy.where(unstable, 1.0, -1.0)


def edges(values, logarithmic):
    """Limits of the cells about the values, half a step beyond the first and the last; of one value a tenth of it to either side."""
    x = numpy.log(values) if logarithmic else numpy.asarray(values)
    if len(x) == 1:
        return values[0] + (abs(values[0]) or 1) * numpy.array([-0.1, 0.1])
    middle = (x[1:] + x[:-1]) / 2
    limits = numpy.concatenate([[2 * x[0] - middle[0]], middle, [2 * x[-1] - middle[-1]]])
    if logarithmic:
        return numpy.exp(limits)
    return numpy.maximum(limits, 0) if min(values) >= 0 else limits  # what is never negative is not drawn so


def draw_cells(axes, study, grid, field, **style):
    """The field on the grid, axes named."""
    first, second = study.axes
    x, y = (edges(numpy.array(v) * axis.factor, axis.logarithmic) for v, axis in zip(grid.values, study.axes))
    mesh = axes.pcolormesh(x, y, numpy.ma.array(field, mask=~grid.known), rasterized=True, **style)
    for axis, scale, ticks in ((first, axes.set_xscale, axes.xaxis), (second, axes.set_yscale, axes.yaxis)):
        if axis.logarithmic:
            scale("log")
        if axis.logarithmic and axis.last < 1e4 * axis.first:
            ticks.set_major_locator(LogLocator(subs=(1, 2, 5)))
            ticks.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            ticks.set_minor_formatter(NullFormatter())
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    axes.set_xlabel(first.title())
    if not grid.known.all():
        axes.patch.set(hatch="////", edgecolor="#BBBBBB")
    return mesh


def contour(axes, study, grid, field, **style):
    """Lines where the field changes sign."""
    if (field > 0).any() and (field < 0).any():
        x, y = (numpy.array(v) * axis.factor for v, axis in zip(grid.values, study.axes))
        axes.contour(x, y, numpy.ma.array(field, mask=~grid.known), levels=[0], **style)


def mark_onsets(axes, study, colours):
    """The critical values, which are more accurate than the contour, as points."""
    x, y = ([row[name] * axis.factor for row in study.onsets] for name, axis in
            zip(("critical_value", "value_2"), study.axes))
    colour = [colours.get(row["label"], INK) for row in study.onsets]
    axes.scatter(x, y, s=13, c=colour, edgecolors="white", linewidths=0.6, zorder=5)


def draw_growth(figure, axes, study, grid):
    """Left: the largest growth."""
    growth = numpy.ma.array(grid.growth, mask=~(grid.known & (grid.growth > 0)))
    draw_cells(axes, study, grid, numpy.zeros_like(grid.growth), cmap=ListedColormap([STABLE]))
    if growth.count():
        mesh = draw_cells(axes, study, grid, grid.growth, cmap=GROWTH, vmin=0, vmax=growth.max())
        mesh.set_array(growth.ravel())
        figure.colorbar(mesh, ax=axes, pad=0.02).set_label("largest growth rate, 1/s")
    contour(axes, study, grid, grid.border(), colors=INK, linewidths=1.4)
    axes.set_ylabel(study.axes[1].title())
    axes.set_title("How fast the worst mode grows", loc="left")


def family_colours(grid):
    """The labels by the size of their regions; those beyond the palette share a grey."""
    names = sorted(grid.families, key=lambda name: -grid.families[name].sum())
    return {name: FAMILIES[i] if i < len(FAMILIES) else GREY for i, name in enumerate(names)}


def lighter(colour, share=0.45):
    """Mixed with white, so that borders and points show on it."""
    rgb = numpy.array(to_rgb(colour))
    return tuple(rgb + (1 - rgb) * share)


def draw_families(axes, study, grid, colours):
    """Right: the mode of largest growth by colour, borders of every family by lines of the same colour."""
    names = list(colours)
    index = numpy.zeros(grid.label.shape)
    for i, name in enumerate(names, 1):
        index[grid.label == name] = i
    shades = [STABLE] + [lighter(colours[name]) for name in names]
    draw_cells(axes, study, grid, index, cmap=ListedColormap(shades), vmin=-0.5, vmax=len(shades) - 0.5)
    for name in names:
        contour(axes, study, grid, numpy.where(grid.families[name], 1.0, -1.0), colors=[colours[name]], linewidths=1.8)
    axes.set_title("Which mode it is, and the border of each", loc="left")


def handles(study, grid, colours):
    """Legend: families with their frequencies, and what else there is."""
    entries = [Patch(facecolor=STABLE, edgecolor="#BBBBBB", label="stable")]
    for name, colour in list(colours.items())[:2 * len(FAMILIES)]:
        low, high = min(grid.frequencies[name]), max(grid.frequencies[name])
        unit, scale = ("kHz", 1e-3) if high >= 1000 else ("Hz", 1)
        texts = dict.fromkeys(f"{f * scale:.3g}" for f in (low, high))
        entries.append(Patch(facecolor=lighter(colour), edgecolor=colour, lw=1.8,
                             label=f"{name or 'unnamed'}, {' to '.join(texts)} {unit}"))
    marks = [(bool(study.onsets), "critical values", {"marker": "o", "ms": 4.5, "color": INK, "mec": "white"}),
             (grid.numerical.any(), "numerical only", {"marker": "o", "ms": 6, "mfc": "none", "mec": VERMILION})]
    entries += [plt.Line2D([], [], ls="", label=label, **style) for shown, label, style in marks if shown]
    if not grid.known.all():
        entries.append(Patch(facecolor="white", hatch="////", edgecolor="#BBBBBB", label="no mode, or not computed"))
    return entries


def draw_map(study):
    """The picture."""
    grid = Grid(study)
    if min(map(len, grid.values)) < 2:
        raise BadInput("a map needs two values or more of both parameters; --at draws a line of it")
    colours = family_colours(grid)
    figure = plt.figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True, gridspec_kw={"width_ratios": [1.13, 1]})
    draw_growth(figure, left, study, grid)
    draw_families(right, study, grid, colours)
    y, x = numpy.nonzero(grid.numerical)
    mark_onsets(right, study, colours)
    for axes in (left, right):
        axes.scatter(numpy.array(grid.values[0])[x] * study.axes[0].factor,
                     numpy.array(grid.values[1])[y] * study.axes[1].factor, s=22, facecolors="none",
                     edgecolors=VERMILION, zorder=4)
    figure.text(0.012, 0.985, study.title(), va="top", weight="bold", size=13)
    entries = handles(study, grid, colours)
    below = 0.05 * math.ceil(len(entries) / 5) + 0.01  # the layout leaves no room for texts and legends of the figure
    figure.get_layout_engine().set(rect=(0.005, below, 0.99, 0.945 - below))
    figure.legend(handles=entries, loc="lower center", ncol=min(5, len(entries)), frameon=False)
    return figure
