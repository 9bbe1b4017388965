"""Part of a transient's section: amplitudes of its modes over time with the exponentials of their eigenvalues, and how
long they follow these."""

import numpy

from ..transient.amplitudes import Amplitudes
from ..transient.history import open_table
from ..transient.lines import MS
from .charts import Axis, Chart, Panel
from .markup import Column, figure, figures, fixed, join, legend, signed, table

COLOURS = ("blue", "vermilion", "green", "orange", "purple", "sky", "grey")
DEEPEST = 1e-8  # of the largest amplitude: what is smaller is not drawn
TABLE = "amplitudes.csv"


def colour_of(k):
    """Of the k-th mode."""
    return COLOURS[k % len(COLOURS)]


def amplitude_figure(folder, amplitudes):
    """Amplitudes over time."""
    largest = max(abs(mode.values).max() for mode in amplitudes.modes)
    floor = DEEPEST * largest
    sizes = [numpy.where(abs(mode.values) > floor, abs(mode.values), numpy.nan) for mode in amplitudes.modes]
    later = numpy.concatenate([size[amplitudes.time > amplitudes.start] for size in sizes])
    panel = Panel(Axis.about("amplitude at the largest place of the shape, m", later, log=True), 330)
    for k, (mode, size) in enumerate(zip(amplitudes.modes, sizes)):
        panel.line(MS * amplitudes.time, size, colour_of(k), mode.name)
    for mode in amplitudes.modes:
        line = amplitudes.line(mode)
        if line:
            panel.line(MS * line[0], line[1], "ink dashed",
                       f"eigenvalue of mode {mode.mode}: {signed(mode.growth)} 1/s")
    chart = Chart("amplitudes of the modes over time", Axis("time, ms", *(MS * amplitudes.time[[0, -1]])), [panel])
    keys = legend([(colour_of(k), "line", mode.name) for k, mode in enumerate(amplitudes.modes)])
    said = "By modal filters of left vectors. " + (
        "Dashed: the exponential of the eigenvalue, from the last blow or ramp on." if amplitudes.source
        else "Growth and labels are not known, since the folder of the modes is not there.")
    return figure(f"{folder.key}-amplitudes", "Amplitudes of the modes",
                  [keys, chart.markup(f"{folder.key}-amplitudes-chart")], said, folder.command("plot/amplitudes"))


def amplitude_table(folder, amplitudes):
    """Growth in time beside the eigenvalue, and which mode is the largest at the end."""
    parts = {mode.mode: amplitudes.straight(mode) for mode in amplitudes.modes}
    nan = float("nan")

    def of_part(name, factor=1.0):
        return lambda mode: factor * float(getattr(parts[mode.mode], name)) if parts[mode.mode] else nan

    def leads(mode):
        time = amplitudes.leads_from(mode)
        return nan if time is None else MS * float(time)

    columns = [Column("mode", lambda mode: mode.mode), Column("label", lambda mode: mode.label, left=True),
               Column("freq, Hz", lambda mode: float(mode.freq), lambda v: fixed(v, 2)),
               Column("growth, 1/s", lambda mode: float(mode.growth), signed, hint="of the eigenvalue"),
               Column("in time, 1/s", of_part("growth"), signed,
                      hint="fitted while the amplitude is within 10 % of the exponential; –: it changes too little"),
               Column("until, ms", of_part("last", MS), lambda v: figures(v, 4), hint="it follows its eigenvalue"),
               Column("at the end, m", lambda mode: float(abs(mode.values[-1])), lambda v: figures(v, 3)),
               Column("largest from, ms", leads, lambda v: figures(v, 4), hint="until the end")]
    return table(f"{folder.key}-amplitudes-table", columns, amplitudes.modes)


def amplitude_pieces(folder):
    """All of it; nothing where the run had no filters."""
    if not open_table(folder.path, TABLE)[0].exists():
        return None
    amplitudes = Amplitudes(folder.path)
    return join([amplitude_figure(folder, amplitudes), amplitude_table(folder, amplitudes)])
