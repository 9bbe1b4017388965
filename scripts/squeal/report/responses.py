"""Section of a frequency response: magnitude and phase of every output, its error, peaks with the mode that makes
them."""

import numpy

from ..response.frf_tables import Responses
from ..tables import BadInput, regular
from .charts import Axis, Chart, Panel
from .correlations import measured_responses
from .markup import Column, Part, count, figure, figures, fixed, legend, missing, section, table, tag

COLOURS = ("blue", "orange", "green", "purple", "sky", "vermilion", "grey")
MOST_TIPS = 400  # points of an output that tell their numbers


def scaled(freq):
    """Factor and unit of the frequencies."""
    return (1e-3, "kHz") if freq.max() >= 1000 else (1.0, "Hz")


def magnitude_figure(folder, responses):
    """Magnitude and phase over frequency, peaks named."""
    scale, unit = scaled(responses.freq)
    x = scale * responses.freq
    outputs = {name: responses.outputs[name] for name in responses.strongest(len(COLOURS))}
    magnitude = {name: numpy.where(values == 0, numpy.nan, abs(values)) for name, values in outputs.items()}
    above = Panel(Axis.about("magnitude, m/N", numpy.concatenate(list(magnitude.values())), log=True), 330)
    below = Panel(Axis("phase, degrees", -185, 185), 170)
    for k, (name, values) in enumerate(outputs.items()):
        colour, phase = COLOURS[k % len(COLOURS)], numpy.degrees(numpy.angle(values))
        above.line(x, magnitude[name], colour, name)
        jumps = numpy.append(abs(numpy.diff(phase)) > 180, False)
        below.line(x, numpy.where(jumps, numpy.nan, phase), colour, name)
        step = -(-len(x) // MOST_TIPS)
        above.points(x[::step], magnitude[name][::step], f"{colour} faint", [
            f"{name}, {figures(f, 6)} Hz: {figures(m, 4)} m/N, {figures(p, 4)}°"
            for f, m, p in zip(responses.freq[::step], magnitude[name][::step], phase[::step])], 1.2)
    for row in responses.peaks:
        at = abs(responses.freq - row["freq_hz"]).argmin()
        top = max(numpy.nan_to_num(values[at]) for values in magnitude.values())
        above.label(scale * row["freq_hz"], top, row["label"] or f"{scale * row['freq_hz']:.3f}")
    panels = [above, below]
    if any(name in responses.coherence for name in outputs):
        panels.append(Panel(Axis("coherence", 0, 1.05), 110))
    for k, name in enumerate(outputs):
        if name in responses.coherence:
            panels[-1].line(x, responses.coherence[name], COLOURS[k], name)
    chart = Chart("frequency response", Axis(f"frequency, {unit}", x.min(), x.max()), panels)
    keys = legend([(COLOURS[k % len(COLOURS)], "line", name) for k, name in enumerate(outputs)])
    return figure(f"{folder.key}-response", "Displacement per force",
                  [keys, chart.markup(f"{folder.key}-response-chart")],
                  f"{len(outputs)} of {count(len(responses.outputs), 'output')}, the largest ones; peaks carry the "
                  "label of the mode that gives most.", folder.command("plot/frf"))


def error_figure(folder, responses):
    """Estimated error over frequency."""
    if responses.relative is None or not (responses.relative > 0).any():
        return missing("No errors: the table has no value in error_relative.")
    scale, unit = scaled(responses.freq)
    panel = Panel(Axis.about("estimated error, relative", responses.relative, log=True), 240)
    panel.line(scale * responses.freq, numpy.where(responses.relative > 0, responses.relative, numpy.nan), "blue",
               f"at most {figures(responses.relative.max(), 2)}")
    chart = Chart("error of the response", Axis(f"frequency, {unit}", *(scale * responses.freq[[0, -1]])), [panel])
    return figure(f"{folder.key}-response-errors", "Error of the response",
                  chart.markup(f"{folder.key}-response-err", "half"),
                  "Of all outputs together: an estimate, not a bound.",
                  folder.command("plot/frf"))


def peak_table(folder, responses):
    """Maxima and their modes."""
    if not responses.peaks:
        return missing("No peaks: peaks.csv is not there, or has no row.")
    columns = [Column("peak, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2)),
               Column("magnitude, m/N", lambda row: row["magnitude_m_n"], lambda v: figures(v, 4)),
               Column("mode", lambda row: row["mode"]),
               Column("its freq, Hz", lambda row: row["mode_freq_hz"], lambda v: fixed(v, 2)),
               Column("damping, %", lambda row: 100 * row["damping_ratio"], lambda v: fixed(v, 4)),
               Column("label", lambda row: row["label"], left=True)]
    return table(f"{folder.key}-peaks", columns, responses.peaks)


def how_it_was_done(folder):
    """Lines that scripts/response wrote about a response in time; nothing about another one."""
    path = folder.path / "response.txt"
    if not path.exists() or not folder.scene or folder.scene.value("analysis") != "transient":
        return None
    try:
        lines = regular(path).read_text(encoding="utf-8").splitlines()
    except (BadInput, OSError, ValueError) as error:
        return folder.lacks(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}")
    return tag("div", tag("h4", "How it was done"), tag("ul", [tag("li", line) for line in lines]),
               id=f"{folder.key}-response-how")


def response_part(folder, _):
    """All of it."""
    responses = Responses(folder.path)
    content = section(f"{folder.key}-frf", "Frequency response", how_it_was_done(folder),
                      magnitude_figure(folder, responses), folder.tried(measured_responses, folder),
                      tag("div", tag("div", tag("h4", "Peaks"), peak_table(folder, responses)),
                          error_figure(folder, responses), class_="pair"))
    errors = [("estimated error of the response, at most", figures(responses.relative.max(), 2))
              ] if responses.relative is not None else []
    low, high = responses.freq[[0, -1]]
    verdict = (f"Response of {count(len(responses.outputs), 'output')} at "
               f"{count(len(responses.freq), 'frequency', 'frequencies')} "
               f"from {figures(low, 5)} to {figures(high, 5)} Hz; {count(len(responses.peaks), 'peak')}.")
    return Part(content, None, errors, verdict)
