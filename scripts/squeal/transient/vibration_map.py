"""Maps of vibration over one or two parameters as pictures. Used by plot/map."""

import math

import matplotlib.pyplot as plt
import numpy
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator

from ..picture import BLUE, GREEN, INK, VERMILION
from ..sweep.map import draw_cells
from ..sweep.tables import Axis
from ..tables import BadInput, optional, read_table

COLUMNS = {"parameter": str, "value": float, "parameter_2": str, "value_2": optional, "direction": str, "regime": str,
           "freq_hz": float, "freq_error_hz": optional, "force_rms_n": float, "force_mean_n": float,
           "open_share": float, "growth_rad_s": optional, "error_estimate": optional, "status": str}
ERRORS = {"value": float, "value_2": optional, "run": str, "regime": str, "freq_error_hz": optional,
          "force_rms_error": optional}
UNITS = {"young": "Pa", "pressure": "Pa", "force": "N", "speed": "m/s", "density": "kg/m^3", "stiffness": "N/m",
         "mu": "-", "alpha": "1/s", "beta": "s", "mu_slope": "s/m"}
VIBRATES = "cycle", "sticking", "growth", "quasi_periodic", "bistable"
STABLE, UNKNOWN = "#F1F1F1", "white"
FEW = 6  # values of a parameter that are ticks of their own
TOLD = "\u00b1: what another step, laws, cut-off change"
HALO = [withStroke(linewidth=2.6, foreground="white")]
WAYS = {"up": ("upwards", BLUE, "^"), "down": ("downwards", VERMILION, "v"),
        "apart": ("each point apart", BLUE, "o")}


def unit_of(name):
    """Of a parameter, by how its name ends."""
    return next((unit for ending, unit in UNITS.items() if name.endswith(f"_{ending}")), "-")


class Table:
    """Rows of map.csv by direction, and the parameters as axes."""

    def __init__(self, folder):
        self.rows = read_table(folder / "map.csv", COLUMNS)
        if not self.rows:
            raise BadInput(f"{folder / 'map.csv'}: has no rows")
        self.is_map = len({row["value_2"] for row in self.rows}) > 1
        self.axes = [Axis(self.rows[0][name], unit_of(self.rows[0][name]), [row[value] for row in self.rows])
                     for name, value in (("parameter", "value"), ("parameter_2", "value_2"))
                     if self.rows[0][name] and not math.isnan(self.rows[0][value])]
        self.ways = [way for way in WAYS if any(row["direction"] == way for row in self.rows)]
        self.bistable = self.find_bistable()
        path = folder / "map_errors.csv"
        self.errors = self.find_errors(read_table(path, ERRORS)) if path.exists() else {}

    @staticmethod
    def find_errors(rows):
        """Of the points of -map_verify: largest differences of the rms (relative) and the frequency (Hz) of the other runs from
        that of the map; None where one is of another regime, no entry where nothing vibrates."""
        found = {}
        for row in rows:
            found.setdefault((row["value"], row["value_2"]), []).append(row)
        result = {}
        for point, runs in found.items():
            first, others = next(row for row in runs if row["run"] == "map"), [row for row in runs if row["run"] != "map"]
            if any(row["regime"] != first["regime"] for row in others):
                result[point] = None
            elif first["regime"] in VIBRATES:
                result[point] = tuple(max(abs(row[name]) for row in others) for name in ("force_rms_error", "freq_error_hz"))
        return result

    def find_both_ways(self):
        """Values of the points that vibrate one way and are stable the other."""
        return [point for point, seen in self.regimes().items() if "stable" in seen and seen & set(VIBRATES)]

    def regimes(self):
        """Those of each point, of all its rows."""
        found = {}
        for row in self.rows:
            found.setdefault((row["value"], row["value_2"]), set()).add(row["regime"])
        return found

    def find_bistable(self):
        """Values of the points that vibrate one way and are stable the other, or of which rounding decides it."""
        return [point for point, seen in self.regimes().items() if "bistable" in seen or ("stable" in seen and seen & set(VIBRATES))]


class Grid:
    """Values of one direction on the grid; `known` is what sweep_map.draw_cells() masks by."""

    def __init__(self, table, way):
        self.values = [sorted({row[name] for row in table.rows}) for name in ("value", "value_2")]
        shape = len(self.values[1]), len(self.values[0])
        self.known, self.vibrates = numpy.zeros(shape, bool), numpy.zeros(shape, bool)
        self.level, self.freq, self.growth = (numpy.full(shape, numpy.nan) for _ in range(3))
        for row in table.rows:
            if row["direction"] != way or row["regime"] == "unknown":
                continue
            at = self.values[1].index(row["value_2"]), self.values[0].index(row["value"])
            self.known[at], self.vibrates[at] = True, row["regime"] in VIBRATES
            self.level[at] = row["force_rms_n"] / row["force_mean_n"]
            self.freq[at], self.growth[at] = row["freq_hz"], row["growth_rad_s"]


def draw_field(figure, axes, table, grid, field, **style):
    """Cells that vibrate by colour, the others grey, and the border of linear stability."""
    draw_cells(axes, table, grid, numpy.zeros_like(field), cmap=ListedColormap([STABLE]))
    mesh = draw_cells(axes, table, grid, field, **style)
    mesh.set_array(numpy.ma.array(field, mask=~(grid.known & grid.vibrates)))
    growth = numpy.ma.masked_invalid(grid.growth)
    if growth.count() and growth.min() < 0 < growth.max():
        x, y = (numpy.array(values) * axis.factor for values, axis in zip(grid.values, table.axes))
        for colour, width in (("white", 3.6), (INK, 1.6)):
            axes.contour(x, y, growth, levels=[0], colors=colour, linewidths=width)
    return mesh


def write_errors(axes, table):
    """What -map_verify tells of points, in their cells."""
    for (x, y), error in table.errors.items():
        text = "?" if error is None else f"\u00b1{100 * error[0]:.2g} %"
        axes.text(x * table.axes[0].factor, y * table.axes[1].factor, text, ha="center", va="center", fontsize=7.5,
                  color=INK, zorder=5, path_effects=HALO)


def draw_grid(table):
    """Two parameters: amplitude in each direction, then the frequency."""
    grids = {way: Grid(table, way) for way in table.ways}
    last = table.ways[-1]
    most = max((numpy.nanmax(grid.level[grid.vibrates]) for grid in grids.values() if grid.vibrates.any()), default=1)
    figure, panels = plt.subplots(1, len(grids) + 1, figsize=(4.4 * len(grids) + 4.8, 4.9), sharey=True,
                                  layout="constrained")
    for axes, (way, grid) in zip(panels, grids.items()):
        mesh = draw_field(figure, axes, table, grid, grid.level, cmap="YlOrRd", vmin=0, vmax=most)
        axes.set_title(f"{table.axes[0].name} {WAYS[way][0]}", loc="left")
    figure.colorbar(mesh, ax=panels[len(grids) - 1], pad=0.02).set_label("rms of the force over its mean")
    shown = grids[last].freq[grids[last].vibrates] * 1e-3
    mesh = draw_field(figure, panels[-1], table, grids[last], grids[last].freq * 1e-3, cmap="viridis",
                      vmin=shown.min() if len(shown) else 0, vmax=shown.max() if len(shown) else 1)
    figure.colorbar(mesh, ax=panels[-1], pad=0.02).set_label("main line, kHz")
    panels[-1].set_title(f"Frequency, {WAYS[last][0]}", loc="left")
    panels[0].set_ylabel(table.axes[1].title())
    for axis, k in ((panels[0].yaxis, 1), *((axes.xaxis, 0) for axes in panels)):
        values = sorted({row[("value", "value_2")[k]] * table.axes[k].factor for row in table.rows})
        if len(values) <= FEW and not table.axes[k].logarithmic:
            axis.set_major_locator(FixedLocator(values))
    write_errors(panels[0], table)
    for axes in panels:
        for x, y in table.bistable:
            axes.plot(x * table.axes[0].factor, y * table.axes[1].factor, "o", ms=8, mfc="none", mec=GREEN, mew=2, path_effects=HALO)
    figure.get_layout_engine().set(rect=(0.005, 0.08, 0.99, 0.915))  # the layout leaves no room for it
    handles = [Patch(facecolor=STABLE, edgecolor="#BBBBBB", label="stable"),
               Line2D([], [], color=INK, lw=1.6, label="border of linear stability")]
    handles += [Line2D([], [], ls="", marker="o", ms=8, mfc="none", mec=GREEN, mew=2,
                      label="vibrates one way, stable the other; or by chance")] if table.bistable else []
    handles += [Line2D([], [], ls="", label=TOLD + (", ?: the regime" if None in table.errors.values() else ""))] if table.errors else []
    figure.legend(handles=handles, loc="lower center", ncol=len(handles), frameon=False)
    return figure


def draw_told(panels, table):
    """What -map_verify tells of points, as bars at those of the first direction: of the rms and of the frequency."""
    rows = [row for row in table.rows if row["direction"] == table.ways[0] and table.errors.get((row["value"], row["value_2"]))]
    x = [row["value"] * table.axes[0].factor for row in rows]
    told = [table.errors[row["value"], row["value_2"]] for row in rows]
    style = {"ls": "", "color": INK, "elinewidth": 2.2, "capsize": 6, "zorder": 3}
    panels[0].errorbar(x, [row["force_rms_n"] for row in rows],
                       [row["force_rms_n"] * error[0] for row, error in zip(rows, told)], label=TOLD, **style)
    panels[1].errorbar(x, [row["freq_hz"] * 1e-3 for row in rows], [error[1] * 1e-3 for error in told], **style)


def draw_line(table):
    """One parameter: amplitude with error bars, time without contact, frequency."""
    figure, panels = plt.subplots(3, 1, figsize=(8, 8.5), sharex=True, layout="constrained")
    factor = table.axes[0].factor
    for way in table.ways:
        rows = sorted((row for row in table.rows if row["direction"] == way and row["regime"] != "unknown"),
                      key=lambda row: row["value"])
        x, level = [row["value"] * factor for row in rows], [row["force_rms_n"] for row in rows]
        error = [row["force_rms_n"] * (0 if math.isnan(row["error_estimate"]) else row["error_estimate"])
                 for row in rows]
        name, colour, marker = WAYS[way]
        panels[0].errorbar(x, level, error, color=colour, marker=marker, ms=5, capsize=3, label=name)
        panels[1].plot(x, [100 * row["open_share"] for row in rows], color=colour, marker=marker, ms=5)
        loud = [row for row in rows if row["regime"] in VIBRATES]
        panels[2].errorbar([row["value"] * factor for row in loud], [row["freq_hz"] * 1e-3 for row in loud],
                           [row["freq_error_hz"] * 1e-3 for row in loud], color=colour, marker=marker, ms=5, capsize=3)
    if any(table.errors.values()):
        draw_told((panels[0], panels[2]), table)
    growing = sorted({row["value"] * factor for row in table.rows if row["growth_rad_s"] > 0})
    for axes in panels:
        if growing:
            axes.axvspan(growing[0], growing[-1], color="#EEEEEE", zorder=0)
    panels[0].set_ylabel("rms of the force, N")
    panels[0].set_title("Grey: the sliding state is unstable", loc="left")
    panels[0].legend(frameon=False)
    panels[1].set_ylabel("time without force, %")
    panels[2].set_ylabel("main line, kHz")
    panels[2].set_xlabel(table.axes[0].title())
    return figure


def draw_table(table):
    """The picture."""
    return draw_grid(table) if table.is_map and len({row["value"] for row in table.rows}) > 1 else draw_line(table)
