"""Picture of the surface in contact: map of the pressure with the status of the pairs, and profile of its rows. Used by
plot/static and study/static."""

import matplotlib
import matplotlib.patheffects
import numpy
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from ..picture import BLUE, GREEN, INK, SOFT
from .pairs import MM, SAME, STATUS, grid_cells, profile, triangles

EMPTY = "#F4F4F4"
# Dots remain visible on the darkest
COLOURS = ListedColormap(matplotlib.colormaps["YlOrBr"](numpy.linspace(0.03, 0.78, 256)))
HALO = [matplotlib.patheffects.withStroke(linewidth=3, foreground="white")]


def draw_pressure(axes, surface, largest=None, markers=True):
    """The map: cells about the pairs, or a continuous field where they form no grid. Returns what is coloured."""
    style = {"cmap": COLOURS, "vmin": 0, "vmax": largest or surface.value.max() or 1, "rasterized": True}
    cells = grid_cells(surface)
    axes.set_facecolor("white")
    if cells is not None:
        x, y, values = cells
        axes.fill_between([x[0], x[-1]], y[0], y[-1], color=EMPTY, lw=0)
        colours = axes.pcolormesh(x, y, values, edgecolors="white", linewidth=0.4, **style)
    elif min(surface.size) > SAME * max(surface.size):
        colours = axes.tripcolor(triangles(surface), surface.value, shading="gouraud", **style)
    else:
        colours = axes.scatter(*surface.place.T, c=surface.value, s=160, marker="s", **style)
    if markers:
        draw_status(axes, surface)
    axes.set_aspect("equal")
    low, high = surface.limits()
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    return colours


def marker_size(surface):
    """Area of a marker, points squared: smaller where there are many pairs."""
    return min(46.0, max(3.0, 46 * 121 / len(surface.status)))


def draw_status(axes, surface):
    """Open pairs as circles, sticking ones as squares, sliding ones as dots."""
    size = marker_size(surface)
    for name, style in (("open", {"marker": "o", "s": size, "facecolors": "white", "edgecolors": INK, "lw": 1.1}),
                        ("stick", {"marker": "s", "s": size, "facecolors": BLUE, "edgecolors": "white", "lw": 0.6}),
                        ("slip", {"marker": "o", "s": 0.4 * size, "facecolors": INK, "edgecolors": "none"})):
        chosen = surface.status == name
        axes.scatter(*surface.place[chosen].T, zorder=4, clip_on=False, **style)


def draw_centre(axes, surface):
    """Middle of the surface as two thin lines, centre of force as a cross."""
    middle = MM * surface.middle @ surface.axes.T
    axes.axvline(middle[0], color=SOFT, lw=0.8, ls=(0, (6, 4)), zorder=3)
    axes.axhline(middle[1], color=SOFT, lw=0.8, ls=(0, (6, 4)), zorder=3)
    if surface.centre is not None:
        axes.plot(*surface.centre, marker="x", ms=15, mew=3.2, color=GREEN, zorder=6, path_effects=HALO)


def draw_direction(axes, surface):
    """One arrow beside the surface, or small ones where the direction varies."""
    if surface.direction is not None:
        tail, head = surface.arrow()
        axes.annotate("", head, tail, arrowprops={"arrowstyle": "-|>,head_width=0.45,head_length=0.9", "color": BLUE,
                                                  "lw": 2.6, "shrinkA": 0, "shrinkB": 0})
    elif surface.sliding is not None and surface.sliding.any():
        moving = numpy.flatnonzero(surface.sliding.any(axis=1))
        moving = moving[::max(1, len(moving) // 48)]
        arrows = surface.sliding[moving] @ surface.axes.T
        axes.quiver(*surface.place[moving].T, *arrows.T, color=BLUE, width=0.004, scale=18, zorder=5)


def draw_profile(axes, surface):
    """Mean pressure of each row, or its force where areas are not known; rows with open pairs are named."""
    borders, value, closed, pairs = profile(surface)
    middle, width = (borders[1:] + borders[:-1]) / 2, numpy.diff(borders)
    upright = surface.profile_axis == 0
    style = {"facecolor": "#F3C88B", "edgecolor": "white", "linewidth": 0.8}
    (axes.bar if upright else axes.barh)(middle, value, width, **style)
    most = value.max() or 1
    title = (f"mean {surface.quantity} of a row, {surface.unit}" if surface.area is not None else
             "normal force of a row, N")
    (axes.set_ylabel if upright else axes.set_xlabel)(title)
    (axes.set_ylim if upright else axes.set_xlim)(0, 1.08 * most)
    (axes.axhline if upright else axes.axvline)(0, color=INK, lw=0.8)
    for at, level, n, of in zip(middle, value, closed, pairs):
        if n < of and len(value) <= 25:
            text = "open" if n == 0 else f"{n} of {of} closed"
            place = (at, level + 0.02 * most) if upright else (level + 0.02 * most, at)
            axes.text(*place, text, fontsize=9, color=SOFT, rotation=90 if upright else 0, path_effects=HALO,
                      ha="center" if upright else "left", va="bottom" if upright else "center")
    axes.grid(color="#EDEDED", lw=0.7, axis="y" if upright else "x")
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    edges(axes, surface)


def edges(axes, surface):
    """Names of the leading and the trailing edge in the profile."""
    if surface.direction is None:
        return
    i = surface.profile_axis
    for at in (0, 1):
        name = "leading edge" if (surface.direction[i] > 0) == at else "trailing edge"
        if i == 1:
            axes.text(0.99, at, name, transform=axes.transAxes, ha="right", va="top" if at else "bottom", color=BLUE)
        else:
            axes.text(at, 0.99, name, transform=axes.transAxes, ha="right" if at else "left", va="top", color=BLUE)


def legend_handles(surface):
    """Of what there is on the map."""
    counts = {name: int((surface.status == name).sum()) for name in STATUS}
    handles = []
    if counts["open"]:
        handles.append(Line2D([], [], ls="", marker="o", ms=7, mfc="white", mec=INK, mew=1.1,
                              label=f"open ({counts['open']})"))
    if counts["slip"]:
        handles.append(Line2D([], [], ls="", marker="o", ms=4.5, color=INK, mec="none",
                              label=f"sliding ({counts['slip']})"))
    if counts["stick"]:
        handles.append(Line2D([], [], ls="", marker="s", ms=7, color=BLUE, mec="white",
                              label=f"sticking ({counts['stick']})"))
    if surface.centre is not None:
        handles.append(Line2D([], [], ls="", marker="x", ms=10, mew=2.6, color=GREEN, label="centre of force"))
    handles.append(Line2D([], [], color=SOFT, lw=0.8, ls=(0, (6, 4)), label="middle of the surface"))
    if surface.sliding is not None and surface.sliding.any():
        handles.append(Line2D([], [], color=BLUE, lw=2.6, marker=">", ms=7, label="sliding direction"))
    return handles
