"""Picture of a sweep over one parameter: frequency and growth of every branch. Used by plot/sweep."""

import collections
import math

import matplotlib.patheffects
import matplotlib.pyplot as plt
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import Bbox

from ..picture import (BLUE, GREEN, INK, MINUS, ORANGE, PURPLE, SKY, SOFT, VERMILION, boxes_about, place_texts)

PALETTE = [BLUE, ORANGE, GREEN, PURPLE, SKY]
QUIET, LEADER = "#C4C4C4", "#9A9A9A"
WIDTH, HEIGHTS = 12, {"frequency": 5.6, "growth": 3.6}  # inches
MARKERS = {"lock_in": ("^", "lock-in"), "lock_out": ("v", "lock-out"), "divergence": ("D", "divergence"),
           "negative_damping": (">", "negative damping"), "positive_damping": ("<", "damping positive again"),
           "restabilisation": ("s", "restabilisation"), "jump": ("X", "jump of growth")}
TEXT = {"path_effects": [matplotlib.patheffects.withStroke(linewidth=3, foreground="white")], "zorder": 8}
# Places of a text about its point, tried in this order, points
ACROSS = (0, 30, -30, 60, -60, 90, -90)
BELOW = [(x, y) for y in (-16, 16, -32, 32, -48, 48, -64, 64, 0) for x in ACROSS]
ABOVE = [(x, -y) for x, y in BELOW]


class Branch:
    """One mode over the parameter, or points of a label that are no branch (number below 0); x in the unit of the axis,
    nan where the branch leaves the band."""

    def __init__(self, number, rows, place, axis, scale):
        self.number, self.colour, self.n_rows = number, QUIET, len(rows)
        size = len(place) if number >= 0 else len(rows)
        self.x, self.frequency, self.growth, self.error = (numpy.full(size, math.nan) for _ in range(4))
        self.kind = numpy.full(size, "stable", dtype=object)
        for i, row in enumerate(sorted(rows, key=lambda row: row["value"])):
            at = place[row["value"]] if number >= 0 else i
            self.x[at], self.frequency[at] = row["value"] * axis.factor, row["freq_hz"] * scale
            self.growth[at], self.error[at], self.kind[at] = row["growth_rad_s"], row["error_hz"], row["class"]
        self.kind[self.kind == "neutral"] = "stable"  # growth that is no instability
        self.label = collections.Counter(row["label"] for row in rows).most_common(1)[0][0]
        self.last = numpy.flatnonzero(~numpy.isnan(self.x))[-1]

    def errors(self, quantity, scale):
        """In the unit of the quantity's axis: an error of lambda / 2 pi (Hz) is 2 pi times as much in growth (1/s)."""
        return self.error * (scale if quantity == "frequency" else 2 * math.pi)


def n_modes(branches):
    """How many: a branch is one, points that are none are as many."""
    return sum(1 if branch.number >= 0 else branch.n_rows for branch in branches)


def branches_of(study, scale):
    """All branches by frequency; those that are unstable or interact are coloured, neighbours differently."""
    place = {value: i for i, value in enumerate(sorted({row["value"] for row in study.rows}))}
    rows = collections.defaultdict(list)
    for row in study.rows:
        rows[row["branch"]].append(row)
    branches = [Branch(number, group, place, study.axes[0], scale) for number, group in rows.items()]
    branches.sort(key=lambda branch: numpy.nanmean(branch.frequency))
    active = {row[key] for row in study.onsets for key in ("branch", "partner")}
    loud = [b for b in branches if b.number in active or (b.kind != "stable").any()]
    for i, branch in enumerate(loud):
        branch.colour = PALETTE[i % len(PALETTE)]
    return branches, loud


def through_onsets(branch, quantity, onsets):
    """Points of a branch with those of its onsets among them, and which of these its unstable parts reach: between two points of a
    sweep growth begins at the onset."""
    own = [(x, y) for (x, y), row in onsets if branch.number in (row["branch"], row["partner"]) and row["kind"] != "jump"]
    inner = sorted((x, y) for x, y in own if branch.x[0] < x < branch.x[-1] and not numpy.isnan(branch.x).any())
    at = numpy.searchsorted(branch.x, [x for x, _ in inner])
    bad = branch.kind == "unstable"
    return (numpy.insert(branch.x, at, [x for x, _ in inner]), numpy.insert(getattr(branch, quantity), at, [y for _, y in inner]),
            numpy.insert(bad, at, bad[at - 1] | bad[numpy.minimum(at, len(bad) - 1)] if len(at) else []))


def draw_branches(axes, branches, quantity, scale, onsets=()):
    """Lines through the onsets, unstable parts, and error bars of more than a point (the limits of the axes are set), without those of the
    growth of stable modes, which would hide the rest; returns whether there are such bars."""
    per_unit = axes.bbox.height / axes.figure.dpi * 72 / numpy.ptp(axes.get_ylim())
    shown = False
    for branch in branches:
        y, loud = getattr(branch, quantity), branch.colour != QUIET
        line = "-" if branch.number >= 0 else "none"
        x, through, grows = through_onsets(branch, quantity, onsets) if line == "-" else (branch.x, y, branch.kind == "unstable")
        given = numpy.isin(x, branch.x)  # onsets have markers of their own
        axes.plot(x, through, ls=line, marker="o", markevery=given, ms=2.6 if loud or line == "none" else 1.2, color=branch.colour,
                  lw=1.6 if loud else 0.8, zorder=3 if loud else 2)
        axes.plot(numpy.where(grows, x, math.nan), through, ls=line, marker="o", markevery=given, ms=5.5, color=VERMILION, lw=3,
                  zorder=4)
        axes.plot(branch.x[branch.kind == "numerical"], y[branch.kind == "numerical"], "o", ms=6, mfc="white",
                  mec=VERMILION, mew=1.2, zorder=5)
        error = branch.errors(quantity, scale)
        wide = (numpy.nan_to_num(error) * per_unit > 1) & ((branch.kind != "stable") | (quantity == "frequency"))
        if wide.any():
            axes.errorbar(branch.x[wide], y[wide], error[wide], fmt="none", ecolor=branch.colour if loud else LEADER,
                          elinewidth=1, capsize=2.5, zorder=2.7)
            shown = True
    return shown


def set_limits(axes, study, branches, loud, quantity, scale):
    """Frequencies: the band; growth: all of the coloured branches, decay only as far as growth."""
    if quantity == "frequency" and study.band:
        axes.set_ylim(study.band[0] * scale, study.band[1] * scale)
        return
    shown = branches if quantity == "frequency" else loud or branches
    values = numpy.concatenate([getattr(branch, quantity) for branch in shown])
    low, high = numpy.nanmin(values), numpy.nanmax(values)
    if quantity == "growth":
        low, high = min(0, low if high <= 0 else max(low, -1.2 * high)), max(0, high)
    pad = 0.05 * (high - low) or 0.05 * abs(high) or 1
    axes.set_ylim(low - pad, high + pad * (3 if quantity == "growth" and high > 0 else 1))


def draw_onsets(axes, study, quantity, scale):
    """A marker on the branch and a thin line through both panels."""
    for (x, y), row in zip(onset_points(study, quantity, scale), study.onsets):
        marker, _ = MARKERS.get(row["kind"], ("P", ""))
        if row["kind"] != "jump":
            axes.axvline(x, color=LEADER, lw=0.7, ls=(0, (4, 3)), zorder=1)
        axes.plot([x], [y], marker, ms=8, zorder=7, mew=1.2, color=INK, mfc=INK if row["confirmed"] else "white",
                  mec="white" if row["confirmed"] else INK)


def jump_places(study):
    """Where the contact status changes: at the onset of kind jump between two points, else half way between them."""
    values = list(dict.fromkeys(row["value"] for row in study.rows))
    after = {row["value"] for row in study.rows if row["jump"]}
    known = [row["critical_value"] for row in study.onsets if row["kind"] == "jump"]
    places = []
    for a, b in zip(values, values[1:]):
        if b in after:
            between = [value for value in known if min(a, b) <= value <= max(a, b)]
            places += [value * study.axes[0].factor for value in dict.fromkeys(between) or [(a + b) / 2]]
    return places


def onset_points(study, quantity, scale):
    """Places of the onsets in a panel."""
    return [(row["critical_value"] * study.axes[0].factor, row["freq_hz"] * scale if quantity == "frequency" else 0)
            for row in study.onsets]


def boxes_along(axes, x, y):
    """Boxes that cover a line."""
    points = axes.transData.transform(numpy.c_[x, y])
    at = numpy.arange(0, len(points) - 0.9, 0.2)
    points = numpy.c_[[numpy.interp(at, numpy.arange(len(points)), column) for column in points.T]].T
    return [Bbox.from_bounds(x - 6, y - 6, 12, 12) for x, y in points]


def name_onsets(axes, study, quantity, scale):
    """Critical values beside their markers; returns the places that are taken then."""
    if not study.onsets:
        return []
    points = onset_points(study, quantity, scale)
    taken = boxes_about(axes, points, 9)
    texts = [f"{point[0]:.4g} {study.axes[0].unit}".rstrip()
             + ("" if row["confirmed"] or row["kind"] == "jump" else " (not confirmed)")
             for point, row in zip(points, study.onsets)]
    place_texts(axes, zip(points, texts), BELOW, taken, color=INK, **TEXT)
    return taken


def name_peaks(axes, branches, taken):
    """Labels above the largest growth of the unstable branches, the largest first."""
    peaks = []
    for branch in branches:
        growth = numpy.where(branch.kind == "unstable", branch.growth, -math.inf)
        if growth.max() > 0:
            peaks.append(((branch.x[growth.argmax()], growth.max()), branch.label))
            taken += boxes_along(axes, branch.x[growth > 0], growth[growth > 0])
    place_texts(axes, sorted(peaks, key=lambda peak: -peak[0][1]), ABOVE, taken, color=VERMILION, weight="bold", **TEXT)


def spread(wanted, height, low, high):
    """Places nearest to the wanted ones (ascending) that keep `height` from each other, between low and high."""
    groups = []  # [sum of wanted places less own offset, number] of texts that touch, and so move as one
    for y in wanted:
        groups.append([y, 1])
        while len(groups) > 1 and first_place(groups[-2]) + height * groups[-2][1] > first_place(groups[-1]):
            total, n = groups.pop()
            groups[-1][0] += total - height * groups[-1][1] * n
            groups[-1][1] += n
    places = [first_place(group) + height * i for group in groups for i in range(group[1])]
    for i in reversed(range(len(places))):
        places[i] = min(places[i], high - height * (len(places) - 1 - i))
    return [max(place, low + height * i) for i, place in enumerate(places)]


def first_place(group):
    """Of the lowest text of a group."""
    return group[0] / group[1]


def thin_out(ends, room):
    """At most `room` of the branch ends: the coloured ones, and evenly chosen grey ones."""
    loud = [end for end in ends if end[1].colour != QUIET][:room]
    quiet = [end for end in ends if end[1].colour == QUIET]
    free = min(room - len(loud), len(quiet))
    chosen = {id(quiet[i * len(quiet) // free]) for i in range(free)} | {id(end) for end in loud}
    return [end for end in ends if id(end) in chosen]


def name_branches(axes, branches):
    """Labels beside the right frame, in the order of the branch ends, tied to them by thin lines; what finds no room is
    left out among the grey branches, evenly."""
    height, right, scale = 13 * axes.figure.dpi / 72, axes.bbox.x1, 72 / axes.figure.dpi
    low, high = axes.bbox.y0, axes.bbox.y1
    ends = [(axes.transData.transform((b.x[b.last], b.frequency[b.last]))[1], b) for b in branches]
    ends = sorted((end for end in ends if low - 1 <= end[0] <= high + 1), key=lambda end: (end[0], end[1].label))
    ends = thin_out(ends, int((high - low) / height))
    places = spread([y for y, _ in ends], height, low + height / 2, high - height / 2)
    for (y, branch), place in zip(ends, places):
        quiet = branch.colour == QUIET
        axes.annotate(branch.label, (right, y), (22, (place - y) * scale), xycoords="figure pixels",
                      textcoords="offset points", va="center", ha="left", fontsize=9 if quiet else 11,
                      color="#6A6A6A" if quiet else branch.colour, weight="normal" if quiet else "bold",
                      annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": LEADER, "lw": 0.7, "shrinkA": 2, "shrinkB": 0,
                                  "relpos": (0, 0.5)})


def name_short(axes, branches, taken):
    """Labels of the branches that leave the band before the last value, at their last points."""
    for branch in branches:
        end = branch.x[branch.last], branch.frequency[branch.last]
        place_texts(axes, [(end, branch.label)], ABOVE, taken, fontsize=9 if branch.colour == QUIET else 11,
                    color="#6A6A6A" if branch.colour == QUIET else branch.colour, **TEXT)


def legend(axes, study, branches, loud, bars):
    """One line below the lowest panel, of what there is."""
    kinds = {kind for branch in branches for kind in branch.kind}
    handles = []
    if "unstable" in kinds:
        handles.append(Line2D([], [], color=VERMILION, lw=3, marker="o", ms=5.5, label="unstable"))
    if "numerical" in kinds:
        handles.append(Line2D([], [], ls="", marker="o", ms=6, mfc="white", mec=VERMILION, mew=1.2,
                              label="numerical: error bar covers zero"))
    for kind, (marker, name) in MARKERS.items():
        if any(row["kind"] == kind for row in study.onsets):
            handles.append(Line2D([], [], ls="", marker=marker, ms=8, color=INK, mec="white", label=name))
    if bars:
        handles.append(Line2D([], [], ls="", marker="|", ms=10, color=INK, label="estimated error"))
    if jump_places(study):
        handles.append(Line2D([], [], color=LEADER, ls="", marker="|", ms=14, label="contact status changes"))
    others = n_modes(branches) - n_modes(loud)
    if others:
        handles.append(Line2D([], [], color=QUIET, lw=1.2, label=f"{others} other mode{'s' if others > 1 else ''}"))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.62 / axes.get_position().height /
                axes.figure.get_figheight()), ncol=len(handles), frameon=False, borderaxespad=0, columnspacing=1.6)


def set_parameter_axis(axes, axis):
    """Scale and limits."""
    if axis.logarithmic:
        axes.set_xscale("log")
        if axis.last < 1e4 * axis.first:
            wide = axis.last > 30 * axis.first
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if wide else (1, 2, 3, 4, 5, 6, 8)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlim(axis.first, axis.last) if axis.last > axis.first else axes.margins(x=0.1)


def draw_panel(axes, study, branches, loud, quantity, scale):
    """One of the panels; returns whether error bars were drawn."""
    set_parameter_axis(axes, study.axes[0])
    set_limits(axes, study, branches, loud, quantity, scale)
    axes.set_ylabel("frequency, " + ("kHz" if scale < 1 else "Hz") if quantity == "frequency" else "growth rate, 1/s")
    axes.grid(color="#EDEDED", lw=0.7)
    axes.set_axisbelow(True)
    if quantity == "growth":
        axes.axhline(0, color="black", lw=0.8, zorder=2.5)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", MINUS)))
    bars = draw_branches(axes, branches, quantity, scale, list(zip(onset_points(study, quantity, scale), study.onsets)))
    draw_onsets(axes, study, quantity, scale)
    for x in jump_places(study):
        axes.axvline(x, color=LEADER, lw=0.7, zorder=1)
    return bars


def make_panels(panels, longest):
    """Figure and axes of fixed margins, in inches; the right one is for labels of up to `longest` letters."""
    left, right, top, bottom, between = 1.05, max(1.05, 0.4 + 0.1 * longest), 0.75, 1.05, 0.2
    height = sum(HEIGHTS[name] for name in panels) + top + bottom + between * (len(panels) - 1)
    figure = plt.figure(figsize=(WIDTH, height))
    axes, above = {}, height - top
    for name in panels:
        above -= HEIGHTS[name]
        place = left / WIDTH, above / height, (WIDTH - left - right) / WIDTH, HEIGHTS[name] / height
        axes[name] = figure.add_axes(place, sharex=next(iter(axes.values()), None))
        axes[name].tick_params(labelbottom=name == panels[-1])
        above -= between
    return figure, axes


def draw_lines(study, panels, labels):
    """The picture; labels: auto, all or none."""
    scale = 1e-3 if max(row["freq_hz"] for row in study.rows) >= 1000 else 1.0
    branches, loud = branches_of(study, scale)
    figure, axes = make_panels(panels, max((len(branch.label) for branch in branches), default=0))
    bars = False
    for name in panels:
        bars |= draw_panel(axes[name], study, branches, loud, name, scale)
    first, last = axes[panels[0]], axes[panels[-1]]
    last.set_xlabel(study.axes[0].title())
    first.set_title(study.title(), loc="left", weight="bold", pad=22)
    first.text(0, 1.015, summary(study, branches, loud), transform=first.transAxes, color=SOFT, va="bottom")
    legend(last, study, branches, loud, bars)
    taken = name_onsets(first, study, panels[0], scale)
    if labels != "none" and "frequency" in axes:
        named = branches if labels == "all" else loud
        final = max(branch.x[branch.last] for branch in branches)
        name_branches(axes["frequency"], [b for b in named if b.x[b.last] == final])
        name_short(axes["frequency"], [b for b in named if b.x[b.last] < final], taken)
    if labels != "none" and "growth" in axes:
        name_peaks(axes["growth"], loud, taken if first is axes["growth"] else boxes_about(
            last, onset_points(study, "growth", scale) or [(0, 0)], 9))
    return figure


def summary(study, branches, loud):
    """Points, modes, and those that are unstable somewhere."""
    names = list(dict.fromkeys(b.label for b in loud if (b.kind == "unstable").any()))
    points = len({row["value"] for row in study.rows})
    points = f"{points} value{'s' * (points > 1)}"
    bad = ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")
    return f"{points}, {n_modes(branches)} modes; unstable: {bad or 'none'}"
