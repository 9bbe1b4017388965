"""Picture of two sweeps over the pad's Young modulus, about full contact and about the sliding state: number of closed
pairs, growth of the families of unstable modes, and the pressure on the pad. Used by study/static."""

import collections

import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D

from ..picture import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, SOFT, VERMILION, save_picture
from .map import draw_centre, draw_direction, draw_pressure, legend_handles
from ..tables import flag, optional, read_table

SWEEP = {"value": float, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str, "n_closed": optional}
PALETTE = [VERMILION, BLUE, GREEN, PURPLE, ORANGE, SKY]
GAP = 1.03  # frequencies of two families differ by more than this factor
NEGLIGIBLE = 0.01  # families that never grow by more than this part of the largest growth are left out
GPA = 1e-9
WIDTH, HEIGHT = 15.0, 6.6  # inches
FONTS = {"font.size": 11, "axes.titlesize": 12, "axes.labelsize": 12, "figure.dpi": 110}


class Family:
    """Unstable modes of neighbouring frequencies, of all sweeps; window in Hz."""

    def __init__(self, rows):
        self.low, self.high = rows[0]["freq_hz"], rows[-1]["freq_hz"]
        labels = collections.Counter(row["label"] for row in rows)
        on_disc = {label: n for label, n in labels.items() if label.startswith("(")}
        middle = numpy.median([row["freq_hz"] for row in rows])
        self.label = max(on_disc or labels, key=labels.get)
        self.name = f"{self.label}, {1e-3 * middle:.1f} kHz"

    def growth(self, sweep):
        """Largest growth of the family at every value of a sweep, 1/s; 0 where none is unstable."""
        return numpy.array([max((row["growth_rad_s"] for row in rows if row["unstable"] and
                                 self.low <= row["freq_hz"] <= self.high), default=0.0) for rows in sweep.points])


class Sweep:
    """Rows of sweep.csv by value, Pa."""

    def __init__(self, folder):
        rows = read_table(folder / "sweep.csv", SWEEP)
        self.values = sorted({row["value"] for row in rows})
        by_value = collections.defaultdict(list)
        for row in rows:
            by_value[row["value"]].append(row)
        self.points = [by_value[value] for value in self.values]
        self.rows = rows

    def closed(self, everything):
        """Number of closed pairs at each value; `everything` where the table does not say it."""
        n = numpy.array([rows[0]["n_closed"] for rows in self.points])
        return numpy.where(numpy.isnan(n), everything, n)


def families_of(sweeps):
    """The families of all sweeps together, by frequency."""
    rows = sorted((row for sweep in sweeps for row in sweep.rows if row["unstable"]), key=lambda row: row["freq_hz"])
    groups = []
    for row in rows:
        if not groups or row["freq_hz"] > GAP * groups[-1][-1]["freq_hz"]:
            groups.append([])
        groups[-1].append(row)
    largest = [max(row["growth_rad_s"] for row in group) for group in groups]
    return [Family(group) for group, most in zip(groups, largest) if most > NEGLIGIBLE * max(largest)]


def draw_closed(axes, sweep, everything):
    """Closed pairs over the modulus."""
    x, n = GPA * numpy.array(sweep.values), sweep.closed(everything)
    axes.step(x, n, where="post", color=INK, lw=1.8)
    axes.set_ylim(0, 1.12 * everything)
    axes.set_yticks([0, everything])
    axes.tick_params(labelbottom=False)
    first, last = int(n[0]), int(n[-1])
    text = f"{first} pairs closed" if n.min() == n.max() else f"{first} to {last} pairs closed"
    axes.text(0.99, 0.12, text, transform=axes.transAxes, ha="right", color=SOFT)


def beside(chosen):
    """The chosen places and their neighbours."""
    wide = numpy.pad(chosen, 1)
    return wide[:-2] | wide[1:-1] | wide[2:]


def draw_growth(axes, sweep, families, colours):
    """Growth of each family over the modulus."""
    for family, colour in zip(families, colours):
        growth = family.growth(sweep)
        axes.plot(GPA * numpy.array(sweep.values), numpy.where(beside(growth > 0), growth, numpy.nan), color=colour,
                  lw=2.4, zorder=3)


def axes_grid(figure):
    """Axes of closed pairs and of growth for both sweeps, of the pad and of its colour bar."""
    grid = figure.add_gridspec(2, 2, height_ratios=[1, 5.2], left=0.055, right=0.62, bottom=0.16, top=0.82, hspace=0.08,
                               wspace=0.06)
    closed = [figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])]
    growth = [figure.add_subplot(grid[1, i], sharex=closed[i]) for i in (0, 1)]
    for axes in (closed[1], growth[1]):
        axes.tick_params(labelleft=False)
    return closed, growth, figure.add_axes([0.68, 0.16, 0.25, 0.66]), figure.add_axes([0.95, 0.16, 0.01, 0.66])


def draw_sweeps(closed, growth, sweeps, everything):
    """Both columns, with the same axes."""
    families = families_of(sweeps)
    colours = [PALETTE[i % len(PALETTE)] for i in range(len(families))]
    top = max((family.growth(sweep).max() for family in families for sweep in sweeps), default=1.0)
    titles = "all pairs closed", "pairs closed in the sliding state"
    for i, (sweep, title) in enumerate(zip(sweeps, titles)):
        draw_closed(closed[i], sweep, everything)
        closed[i].set_title(title, loc="left", weight="bold")
        growth[i].set_xlim(GPA * sweep.values[0], GPA * sweep.values[-1])
        growth[i].set_ylim(0, 1.12 * top)
        growth[i].grid(color="#EDEDED", lw=0.7)
        growth[i].set_xlabel("pad_young, GPa")
        draw_growth(growth[i], sweep, families, colours)
    closed[0].set_ylabel("pairs")
    growth[0].set_ylabel("growth rate, 1/s")
    handles = [Line2D([], [], color=colour, lw=2.4, label=family.name) for family, colour in zip(families, colours)]
    growth[0].figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.055, 0.015), ncol=len(handles) or 1,
                            frameon=False, borderaxespad=0, borderpad=0, columnspacing=1.6)
    return families


def hidden(families, sweeps, value):
    """Families that grow in the second sweep only at its value nearest to this one (Pa), and that value."""
    nearest = min(sweeps[1].values, key=lambda other: abs(other - value))
    growth = [[family.growth(sweep)[sweep.values.index(nearest)] if nearest in sweep.values else 0 for sweep in sweeps]
              for family in families]
    return [family.name for family, (full, own) in zip(families, growth) if own > full == 0], nearest


def headline(surface, value):
    """What the pad does, from its pairs."""
    n_open = int((~surface.closed).sum())
    if not n_open:
        return f"The sliding pad of {GPA * value:g} GPa is in contact everywhere"
    lead = surface.lead()
    behind = lead is not None and lead > 0
    return (f"The sliding pad lifts{' at its trailing edge' if behind else ''}: {n_open} of {len(surface.closed)} "
            f"pairs are open at {GPA * value:g} GPa")


def summary(families, sweeps, value):
    """Largest growth of both sweeps, and what full contact hides at a value, Pa."""
    largest = [max((family.growth(sweep).max() for family in families), default=0) for sweep in sweeps]
    text = (f"largest growth {largest[0]:.0f} 1/s with all pairs closed, {largest[1]:.0f} 1/s with those of the "
            "sliding state")
    names, nearest = hidden(families, sweeps, value)
    return text + (f"; at {GPA * nearest:.3g} GPa full contact hides {' and '.join(names)}" if names else "")


def draw_picture(full, sliding, surface, value, output):
    """Folders of both sweeps; the surface at a value of the modulus, Pa."""
    sweeps = Sweep(full), Sweep(sliding)
    with plt.rc_context(FONTS):
        figure = plt.figure(figsize=(WIDTH, HEIGHT))
        closed, growth, pad, bar = axes_grid(figure)
        families = draw_sweeps(closed, growth, sweeps, len(surface.closed))
        colours = draw_pressure(pad, surface)
        draw_centre(pad, surface)
        draw_direction(pad, surface)
        pad.set_title(f"pressure on the pad, {GPA * value:g} GPa", loc="left", weight="bold")
        pad.set_xlabel(surface.axis_title(0))
        pad.set_ylabel(surface.axis_title(1))
        figure.canvas.draw()
        place = pad.get_position()
        bar.set_position([place.x1 + 0.008, place.y0, 0.01, place.height])
        figure.colorbar(colours, cax=bar).set_label(f"{surface.quantity}, {surface.unit}")
        pad.legend(handles=legend_handles(surface), loc="upper left", bbox_to_anchor=(0, -0.13), ncol=2, frameon=False,
                   fontsize=9.5, borderaxespad=0)
        figure.text(0.055, 0.95, headline(surface, value), weight="bold", fontsize=16, va="center")
        figure.text(0.055, 0.9, summary(families, sweeps, value), color=SOFT, va="center")
        save_picture(figure, output)
