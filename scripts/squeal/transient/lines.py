"""Pictures of a transient over time and frequency: forces with status and ledger, acceleration, spectrum, growth. Used
by plot/transient."""

import matplotlib.pyplot as plt
import numpy
from matplotlib.ticker import MaxNLocator

from ..picture import BLUE, GREEN, GREY, INK, MINUS, ORANGE, PURPLE, SKY, SOFT, VERMILION, place_texts
from .signal import TWO_PI
from .cycle import detached_share, figures

WIDTH = 10.0  # inches
WINDOW = "#F6EEDC"
GRID = {"color": "#EDEDED", "lw": 0.7}
STATUS = (("open", "#E3E3E3"), ("stick", ORANGE), ("slip", SKY))
MS, KHZ = 1e3, 1e-3
MOST = 6000  # points of a line over the whole run: of more, the extremes of pieces are drawn
PERIODS = 4  # beside the whole run
SHORTEST = 60  # samples beside the whole run where no line is known
HARMONICS = 6
FAINTEST = -80.0  # dB of harmonics that are named


def signed(text):
    """With the sign of typography."""
    return text.replace("-", MINUS).replace(f"+{MINUS}", "\N{PLUS-MINUS SIGN}")


def plot_line(axes, times, values, **style):
    """A line, thinned to the least and largest value of pieces where it has too many points."""
    piece = 2 * len(times) // MOST
    if piece > 1:
        n = len(times) // piece * piece
        blocks = values[:n].reshape(-1, piece)
        values = numpy.stack([blocks.min(axis=1), blocks.max(axis=1)], axis=1).ravel()
        times = numpy.repeat(times[:n:piece], 2)
    axes.plot(MS * times, values, **style)


def beside(vibration):
    """The last periods of the run, as a slice."""
    n = len(vibration.time)
    if not vibration.line:
        return slice(max(0, n - SHORTEST), n)
    step = vibration.time[1] - vibration.time[0]
    return slice(max(0, n - max(int(PERIODS / vibration.line[0] / step), 8)), n)


def head(figure, title, text, height):
    """Title and the line below it."""
    figure.text(0.012, 1 - 0.24 / height, title, weight="bold", fontsize=15, va="center")
    figure.text(0.012, 1 - 0.56 / height, signed(text), color=SOFT, va="center")


def rows_and_columns(height, ratios, zoom=True):
    """A figure with rows of axes, each with the last periods beside it."""
    figure = plt.figure(figsize=(WIDTH, height))
    grid = figure.add_gridspec(len(ratios), 2, height_ratios=ratios, width_ratios=[2.3, 1], left=0.095, right=0.985,
                               top=1 - 0.95 / height, bottom=0.62 / height, hspace=0.13, wspace=0.05)
    wide = [figure.add_subplot(grid[i, 0 if zoom else slice(None)]) for i in range(len(ratios))]
    near = [figure.add_subplot(grid[i, 1], sharey=wide[i]) for i in range(len(ratios))] if zoom else []
    for axes in wide + near:
        axes.grid(**GRID)
        axes.set_axisbelow(True)
    for axes in near:
        axes.tick_params(labelleft=False)
        axes.xaxis.set_major_locator(MaxNLocator(4, prune="both"))
    for axes in wide[:-1] + near[:-1]:
        axes.tick_params(labelbottom=False)
    for column in (wide, near):
        for axes in column[:-1]:
            axes.sharex(column[-1])
        if column:
            column[-1].set_xlabel("time, ms")
    return figure, wide, near


def mark_periods(axes, times):
    """Where the columns beside lie."""
    axes.axvspan(MS * times[0], MS * times[-1], color=WINDOW, lw=0, zorder=0)


def draw_status(axes, times, status):
    """Open, sticking and sliding pairs, one upon another."""
    order = [status[2], status[1], status[0]]
    colours = [STATUS[2][1], STATUS[1][1], STATUS[0][1]]
    every = max(len(times) // MOST, 1)
    axes.stackplot(MS * times[::every], *(values[::every] for values in order), colors=colours, lw=0, step="post")


def forces_text(run, vibration):
    """Line below the title."""
    normal = run.normal[vibration.steady]
    apart = detached_share(normal)
    return (f"{vibration.regime()}; normal force {normal.min():.4g} to {normal.max():.4g} N, "
            + (f"zero for {apart:.1%} of the time" if apart else "never zero") + f" after "
            f"{MS * vibration.time[vibration.steady][0]:.3g} ms")


def draw_forces(run, vibration, case):
    """Sum of the contact forces, status of the pairs, error of the ledger."""
    status, error = run.status(), run.ledger_error()
    ratios = [3] + ([1.3] if status else []) + ([1.1] if error is not None else [])
    height = 1.57 + 1.1 * sum(ratios)
    figure, wide, near = rows_and_columns(height, ratios)
    head(figure, f"Contact forces{case}", forces_text(run, vibration), height)
    last = beside(vibration)
    for axes, cut in ((wide[0], slice(None)), (near[0], last)):
        for values, colour in ((run.normal, BLUE), (run.friction, VERMILION)):
            plot_line(axes, run.time[cut], values[cut], color=colour, lw=1.1 if cut.start is None else 1.8)
    wide[0].set_ylabel("sum of forces, N")
    legend = [("normal", BLUE), ("friction", VERMILION)]
    place_legend(wide[0], legend, "line", "best")
    if status:
        draw_status(wide[1], run.time, status)
        draw_status(near[1], run.time[last], [values[last] for values in status])
        wide[1].set_ylabel("pairs")
        wide[1].set_ylim(0, max(1, sum(status).max()))
        place_legend(wide[1], STATUS, "patch", "lower left")
    if error is not None:
        draw_ledger(wide[-1], near[-1], run, error, last)
    for axes in wide:
        mark_periods(axes, run.time[last])
    wide[0].set_xlim(MS * run.time[0], MS * run.time[-1])
    near[0].set_xlim(MS * run.time[last][0], MS * run.time[last][-1])
    return figure


def draw_ledger(wide, near, run, error, last):
    """What the ledger of energy leaves over, relative to the energy turned over."""
    floor = max(error.max() * 1e-6, 1e-18)
    plot_line(wide, run.time, numpy.maximum(error, floor), color=INK, lw=0.9)
    near.plot(MS * run.time[last], numpy.maximum(error[last], floor), color=INK, lw=1.4)
    wide.set_yscale("log")
    shown = numpy.log10(numpy.maximum(error[len(error) // 100:], floor))
    wide.set_ylim(10**(numpy.floor(shown.min()) - 0.2), 10**(numpy.ceil(shown.max()) + 0.2))
    wide.set_ylabel("balance error")


def place_legend(axes, entries, kind, place):
    """Names with colours, upon the lines."""
    make = {"line": lambda colour: plt.Line2D([], [], color=colour, lw=2.5),
            "patch": lambda colour: plt.Rectangle((0, 0), 1, 1, color=colour)}[kind]
    axes.legend([make(colour) for _, colour in entries], [name for name, _ in entries], loc=place,
                ncol=len(entries), framealpha=0.85, edgecolor="none", borderpad=0.25, handlelength=1.3,
                columnspacing=1.2, borderaxespad=0.3)


def draw_acceleration(vibration, name, case):
    """Acceleration over time."""
    height = 4.4
    figure, (wide,), (near,) = rows_and_columns(height, [1])
    values = vibration.signal[vibration.steady]
    head(figure, f"Acceleration {name}{case}", f"{vibration.regime()}; rms {values.std():.4g} m/s\N{SUPERSCRIPT TWO}, "
         f"peak {abs(values).max():.4g} m/s\N{SUPERSCRIPT TWO} after {MS * vibration.time[vibration.steady][0]:.3g} ms",
         height)
    last = beside(vibration)
    plot_line(wide, vibration.time, vibration.signal, color=BLUE, lw=0.7)
    near.plot(MS * vibration.time[last], vibration.signal[last], color=BLUE, lw=1.8)
    mark_periods(wide, vibration.time[last])
    wide.set_ylabel("m/s\N{SUPERSCRIPT TWO}")
    wide.ticklabel_format(axis="y", scilimits=(-3, 4))
    wide.set_xlim(MS * vibration.time[0], MS * vibration.time[-1])
    near.set_xlim(MS * vibration.time[last][0], MS * vibration.time[last][-1])
    return figure


def decibels(values):
    """Of powers."""
    return 10 * numpy.log10(numpy.maximum(values, 1e-300))


def draw_spectrum(vibration, name, case):
    """Power spectral density with the main line and its harmonics."""
    height = 4.8
    figure, (axes,), _ = rows_and_columns(height, [1], zoom=False)
    frequency, density = vibration.density
    first, last = (MS * vibration.time[vibration.steady][i] for i in (0, -1))
    head(figure, f"Spectrum of the acceleration {name}{case}",
         f"{first:.3g} to {last:.3g} ms; main line {figures(vibration.line[0], vibration.line[1])} Hz", height)
    end = min((HARMONICS + 0.9) * vibration.line[0], frequency[-1])
    shown = (frequency <= end) & (frequency > 0)
    level = decibels(density[shown])
    axes.plot(KHZ * frequency[shown], level, color=BLUE, lw=1.3, zorder=3)
    top = level.max()
    floor = max(level.min(), top - 120)
    end = min(end, max(1.1 * frequency[shown][level > floor][-1], 2.5 * vibration.line[0]))  # nothing is seen beyond
    axes.set_ylim(floor - 3, top + 0.14 * (top - floor))
    axes.set_xlim(0, KHZ * end)
    mark_harmonics(axes, vibration, KHZ * end, frequency, decibels(density))
    axes.set_xlabel("frequency, kHz")
    axes.set_ylabel("dB re 1 (m/s\N{SUPERSCRIPT TWO})\N{SUPERSCRIPT TWO}/Hz")
    return figure


def mark_harmonics(axes, vibration, end, frequency, level):
    """Dotted lines at the multiples of the main line, with their levels, and the largest other line."""
    taken = []

    def name(place, reach, text, **style):
        top = level[abs(KHZ * frequency - place) <= reach].max()
        place_texts(axes, [((place, top), signed(text))], [(0, y) for y in (14, 21, 40, 60)], taken, zorder=4,
                    bbox={"fc": "white", "ec": "none", "pad": 0.6, "alpha": 0.8}, **style)

    for number, value in ((1, 0.0), *vibration.harmonics.items()):
        place = KHZ * number * vibration.line[0]
        if place >= end:
            continue
        axes.axvline(place, color=VERMILION if number == 1 else GREY, lw=1, ls=":", zorder=1)
        if value < FAINTEST:
            continue
        text = f"{place:.3f} kHz" if number == 1 else f"{number}\N{MULTIPLICATION SIGN}  {value:.0f} dB"
        name(place, max(0.02 * place, 4 * KHZ * frequency[1]), text, fontsize=12, color=VERMILION if number == 1 else INK)
    if vibration.other and KHZ * vibration.other[0] < end:
        place = KHZ * vibration.other[0]
        name(place, 2 * KHZ * frequency[1], f"{place:.2f} kHz\n{vibration.other[1]:.0f} dB", fontsize=11, color=PURPLE)


def growth_text(vibration):
    """Line below the title."""
    if not vibration.fit:
        return f"{vibration.regime()}; the amplitude nowhere grows or decays by a factor of e along a straight line"
    first, last = (MS * t for t in vibration.window)
    sign = "+" if vibration.fit.growth > 0 else ""
    return (f"{vibration.regime()}; {first:.4g} to {last:.4g} ms: {sign}{figures(*vibration.fit[1::2])} 1/s at "
            f"{figures(vibration.fit.freq, vibration.fit.error / TWO_PI)} Hz")


def draw_growth(vibration, name, case):
    """Amplitude and frequency of the main line over time, with the exponential fitted."""
    height = 5.8
    figure, (axes, below), _ = rows_and_columns(height, [2.6, 1], zoom=False)
    head(figure, f"Growth of the main line {name}{case}", growth_text(vibration), height)
    plot_line(axes, vibration.line_time, vibration.amplitude, color=BLUE, lw=1.8)
    axes.set_yscale("log")
    axes.set_ylabel("amplitude, m/s\N{SUPERSCRIPT TWO}")
    visible = vibration.amplitude[vibration.line_time >= min(vibration.start, vibration.line_time[-2])]
    axes.set_ylim(0.5 * max(min(visible.min(), 0.1 * visible.max()), 1e-6 * visible.max()), 2.5 * visible.max())
    axes.set_xlim(MS * vibration.time[0], MS * vibration.time[-1])
    plot_line(below, vibration.line_time, KHZ * vibration.frequency, color=BLUE, lw=1.3)
    centre = KHZ * (vibration.fit.freq if vibration.fit else vibration.line[0])
    reach = max(1.8 * abs(centre - KHZ * vibration.line[0]), 0.02 * centre)
    below.set_ylim(centre - reach, centre + reach)
    below.set_ylabel("line, kHz")
    if vibration.fit:
        times = numpy.array(vibration.window)
        values = vibration.fit.amplitude * numpy.exp(vibration.fit.growth * (times - vibration.fit_start))
        axes.plot(MS * times, values, color=VERMILION, lw=2.6, ls=(0, (4, 1.6)), zorder=4, label="exponential fitted")
        below.plot(MS * times, 2 * [KHZ * vibration.fit.freq], color=VERMILION, lw=2.6, ls=(0, (4, 1.6)), zorder=4)
        for panel in (axes, below):
            panel.axvspan(*(MS * times), color=WINDOW, lw=0, zorder=0)
    if vibration.saturated():
        axes.axvline(MS * vibration.growth.saturation, color=GREEN, lw=1.6, ls=":", label="saturation")
    if axes.get_legend_handles_labels()[0]:
        corner = "lower left" if vibration.regime() == "decays" else "lower right"
        axes.legend(loc=corner, framealpha=0.85, edgecolor="none")
    return figure
