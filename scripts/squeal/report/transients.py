"""Section of a transient: forces, status, ledger and contact residuals over time, growth, spectrum, spectrogram, orbit
of a probe, summary."""

import base64
import io

import numpy
from matplotlib import colormaps, image

from ..transient.spectrum import spectrogram
from ..transient.cycle import Vibration, contact_quantities, detached_share, vibration_quantities
from ..transient.cycle import figures as with_error
from ..transient.history import Run
from ..transient.lines import FAINTEST, HARMONICS, KHZ, MS, beside, decibels
from .amplitudes import amplitude_pieces
from .charts import Axis, Chart, Panel
from .films import film_figures
from .markup import Column, Part, figure, figures, legend, missing, section, signed, table, tag

DEEPEST = 70  # dB of the spectrogram below its largest value
STATUS = (("slip", "sky", "sliding"), ("stick", "orange", "sticking"), ("open", "quiet", "open"))
ORBIT = 20  # periods of it
NAMES = {"growth_window_start": "growth: window from", "growth_window_end": "growth: window to"}


class Record:
    """The table of a folder and what it does: `name` of the probe, or none."""

    def __init__(self, folder):
        options = folder.options
        self.run = Run(folder.path)
        probe = options.probe if options.probe in self.run.probes else None
        self.probe, self.axis = self.run.choose_probe(probe), options.component
        signal = self.run.acceleration(self.probe, self.axis) if self.probe else self.run.friction
        self.unit = "m/s²" if self.probe else "N"
        self.what = f"acceleration of {self.probe} in {self.axis}" if self.probe else "friction force"
        self.vibration = Vibration(self.run.time, signal, self.run.start())
        words = (["--probe", self.probe] if self.probe else []) + (["--component", self.axis]
                                                                   if self.axis != "y" else [])
        self.command = folder.command("plot/transient", *words)

    def time_axis(self, cut=slice(None)):
        """In ms."""
        return Axis("time, ms", *(MS * self.run.time[cut][[0, -1]]))

    def tip(self):
        """Of the whole record."""
        first, last = (MS * self.run.time[i] for i in (0, -1))
        return f"{figures(first, 4)} to {figures(last, 4)} ms, {len(self.run.time)} rows"


def force_panels(record, cut):
    """Forces and status over a part of the time."""
    run = record.run
    time = MS * run.time[cut]
    panel = Panel(Axis.about("sum of forces, N", numpy.append(run.normal, run.friction), zero=True), 240)
    panel.line(time, run.normal[cut], "blue", "normal force")
    panel.line(time, run.friction[cut], "vermilion", "friction force")
    panels, status = [panel], run.status()
    if status:
        below = Panel(Axis("pairs", 0, max(1, sum(status).max())), 110)
        values = dict(zip(("open", "stick", "slip"), status))
        for name, colour, word in STATUS:
            below.line(time, values[name][cut], colour, f"{word} pairs")
        panels.append(below)
    return panels


def force_figures(folder, record):
    """The whole run, and its last periods."""
    vibration = record.vibration
    normal = record.run.normal[vibration.steady]
    share = detached_share(normal)
    keys = legend([("blue", "line", "normal force"), ("vermilion", "line", "friction force")]
                  + [(colour, "line", f"{word} pairs") for _, colour, word in STATUS] * bool(record.run.status()))
    said = (f"Normal force {figures(normal.min(), 4)} to {figures(normal.max(), 4)} N, "
            + (f"zero for {100 * share:.1f} % of the time" if share else "never zero")
            + f" after {figures(MS * record.run.time[vibration.steady][0], 3)} ms; {record.tip()}.")
    pieces = []
    for name, title, text, cut in (("forces", "Contact forces", said, slice(None)),
                                   ("periods", "Contact forces, last periods", "", beside(vibration))):
        chart = Chart(title, record.time_axis(cut), force_panels(record, cut))
        kind = "wide" if name == "forces" else "half"
        pieces.append(figure(f"{folder.key}-{name}", title, [keys, chart.markup(f"{folder.key}-{name}-chart", kind)],
                             text,
                             record.command))
    return pieces


def signal_figure(folder, record):
    """The signal itself."""
    vibration = record.vibration
    values = vibration.signal[vibration.steady]
    panel = Panel(Axis.about(f"{record.what}, {record.unit}", vibration.signal), 260)
    panel.line(MS * vibration.time, vibration.signal, "blue thin", record.tip())
    chart = Chart(record.what, record.time_axis(), [panel]).markup(f"{folder.key}-signal-chart", "half")
    said = (f"{vibration.regime().capitalize()}; rms {figures(values.std(), 4)}, peak {figures(abs(values).max(), 4)} "
            f"{record.unit} after {figures(MS * vibration.time[vibration.steady][0], 3)} ms.")
    return figure(f"{folder.key}-signal", record.what.capitalize(), chart, said, record.command)


def growth_figure(folder, record):
    """Amplitude of the main line with the exponential fitted."""
    vibration = record.vibration
    time, fit = MS * vibration.line_time, vibration.fit
    after = vibration.amplitude[vibration.line_time >= min(vibration.start, vibration.line_time[-2])]
    low = 0.5 * max(min(after.min(), 0.1 * after.max()), 1e-6 * after.max())
    panel = Panel(Axis(f"amplitude, {record.unit}", low, 2.5 * after.max(), True), 260)
    said = f"{vibration.regime().capitalize()}; no part grows or decays by a factor of e along a straight line."
    if fit:
        window = numpy.array(vibration.window)
        panel.band(MS * window[0], MS * window[1], "window", "window of the fit")
        said = (f"{vibration.regime().capitalize()}; from {figures(MS * window[0], 4)} to "
                f"{figures(MS * window[1], 4)} ms "
                f"{signed(fit.growth)} ± {figures(fit.error, 2)} 1/s at {figures(fit.freq, 7)} Hz.")
    panel.line(time, vibration.amplitude, "blue", "amplitude of the main line")
    if fit:
        values = fit.amplitude * numpy.exp(fit.growth * (window - vibration.fit_start))
        panel.line(MS * window, values, "vermilion thick", f"exponential fitted: {signed(fit.growth)} 1/s")
    if vibration.saturated():
        panel.rule(x=MS * vibration.growth.saturation, colour="green dashed", tip="saturation")
    chart = Chart("amplitude of the main line", record.time_axis(), [panel]).markup(f"{folder.key}-growth-chart",
                                                                                    "half")
    return figure(f"{folder.key}-growth", "Growth of the main line", chart, said, record.command)


def spectrum_figure(folder, record):
    """Power spectral density with its lines."""
    vibration = record.vibration
    frequency, density = vibration.density
    line = vibration.line[0]
    end = min((HARMONICS + 0.9) * line, frequency[-1])
    shown = (frequency > 0) & (frequency <= end)
    level = decibels(density)
    top = level[shown].max()
    panel = Panel(Axis(f"dB re 1 ({record.unit})²/Hz", max(level[shown].min(), top - 120) - 3, top + 14), 260)
    panel.line(KHZ * frequency[shown], level[shown], "blue")
    for number, value in ((1, 0.0), *vibration.harmonics.items()):
        place = KHZ * number * line
        if place < KHZ * end and value >= FAINTEST:
            near = abs(KHZ * frequency - place) <= max(0.02 * place, 4 * KHZ * frequency[1])
            panel.rule(x=place, colour="soft dashed")
            panel.label(place, level[near].max(), f"{place:.3f} kHz"
                        if number == 1 else f"{number}× {signed(value, 3)} dB",
                        "vermilion" if number == 1 else "ink")
    step = max(1, shown.sum() // 400)
    panel.points(KHZ * frequency[shown][::step], level[shown][::step], "blue faint", [
        f"{figures(f, 5)} Hz: {figures(v, 4)} dB" for f, v in zip(frequency[shown][::step], level[shown][::step])], 1)
    chart = Chart("power spectral density", Axis("frequency, kHz", 0, KHZ * end), [panel])
    first, last = (MS * vibration.time[vibration.steady][i] for i in (0, -1))
    said = (f"{figures(first, 3)} to {figures(last, 3)} ms; main line "
            f"{with_error(vibration.line[0], vibration.line[1]).replace('+-', '±')} Hz.")
    return figure(f"{folder.key}-spectrum", "Spectrum", chart.markup(f"{folder.key}-spectrum-chart", "half"), said,
                  record.command)


def spectrogram_figure(folder, record):
    """Spectrum over time, as an image under axes."""
    vibration = record.vibration
    line, length = vibration.line[0], vibration.time[-1] - vibration.time[0]
    times, frequency, density = spectrogram(vibration.time, vibration.signal, max(20 / length, line / 20))
    end = min((HARMONICS + 0.9) * line, frequency[-1])
    level = decibels(density[frequency <= end])
    share = numpy.clip((level - level.max() + DEEPEST) / DEEPEST, 0, 1)
    file = io.BytesIO()
    image.imsave(file, colormaps["magma"](share[::-1]), format="png")
    source = "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
    half_t, half_f = 0.5 * (times[-1] - times[0]) / max(len(times) - 1, 1), 0.5 * frequency[1]
    panel = Panel(Axis("frequency, kHz", 0, KHZ * end), 260)
    panel.image((MS * (times[0] - half_t), MS * (times[-1] + half_t), -KHZ * half_f,
                 KHZ * (frequency[frequency <= end][-1] + half_f)), source, "power over time and frequency")
    chart = Chart("spectrogram", record.time_axis(), [panel]).markup(f"{folder.key}-spectrogram-chart", "half")
    return figure(f"{folder.key}-spectrogram", "Spectrogram", chart,
                  f"Dark to light: {DEEPEST} dB. Segments of {figures(MS * (vibration.time[-1] - times[-1]) * 2, 3)} "
                  f"ms.",
                  folder.command("report"))


def orbit_figure(folder, record):
    """Velocity against displacement of the probe: a closed curve is a limit cycle."""
    run, vibration = record.run, record.vibration
    n = len(run.time)
    step = run.time[1] - run.time[0]
    cut = slice(max(0, n - max(int(ORBIT / vibration.line[0] / step), 8)), n) if vibration.line else beside(vibration)
    x, v = run.probe(record.probe, record.axis)[cut], run.probe(record.probe, f"v{record.axis}")[cut]
    x = 1e6 * (x - x.mean())
    panel = Panel(Axis.about(f"velocity of {record.probe} in {record.axis}, mm/s", 1e3 * v), 260)
    panel.line(x, 1e3 * v, "blue thin")
    panel.points(x[-1:], 1e3 * v[-1:], "vermilion", ["end of the run"], 4)
    chart = Chart("orbit of the probe", Axis.about("displacement from its mean, µm", x), [panel])
    return figure(f"{folder.key}-orbit", "Limit-cycle shape: orbit of the probe",
                  chart.markup(f"{folder.key}-orbit-chart", "half"),
                  f"The last {figures(MS * (run.time[cut][-1] - run.time[cut][0]), 3)} ms. A closed curve is a limit "
                  f"cycle.",
                  folder.command("report"))


def ledger_figure(folder, record):
    """What the balance of energy leaves over, and how exactly the contact laws hold."""
    run, panels = record.run, []
    columns = ((run.ledger_error(), "balance of energy, relative"),
               (run.columns.get("projector_residual"), "residual of contact and friction (KKT), relative"))
    for values, title in columns:
        if values is None or not (values > 0).any():
            continue
        floor = max(values.max() * 1e-6, 1e-18)
        panel = Panel(Axis.about(title, numpy.maximum(values[len(values) // 100:], floor), log=True), 140)
        panel.line(MS * run.time, numpy.maximum(values, floor), "ink thin", f"at most {figures(values.max(), 2)}")
        panels.append(panel)
    if not panels:
        return missing("No ledger: the table has no column energy_error_j.")
    chart = Chart("errors over time", record.time_axis(), panels).markup(f"{folder.key}-ledger-chart")
    return figure(f"{folder.key}-ledger", "Ledger of energy and residual of the contact laws", chart,
                  "Relative to the energy turned over, and to the largest contact impulse.", record.command)


def summary(folder, record):
    """All numbers."""
    rows = [*vibration_quantities(record.vibration, record.unit),
            *contact_quantities(record.run, record.vibration.steady)]
    columns = [Column("quantity", lambda q: q.name, lambda v: NAMES.get(v, v.replace("_", " ")), left=True),
               Column("value", lambda q: float(q.value), lambda v: figures(v, 6)),
               Column("error", lambda q: float("nan") if q.error is None
                      or not numpy.isfinite(q.error) else float(q.error),
                      lambda v: figures(v, 2)), Column("unit", lambda q: q.unit, left=True)]
    return table(f"{folder.key}-summary", columns, rows)


def error_facts(record):
    """Largest errors."""
    error = record.run.ledger_error()
    if error is not None:
        yield "balance of energy, at most, to the energy turned over", figures(error.max(), 2)
    if "projector_residual" in record.run.columns:
        yield "residual of contact and friction, at most", figures(record.run.columns["projector_residual"].max(), 2)
    if record.vibration.fit:
        yield "error of the growth rate", f"{figures(record.vibration.fit.error, 2)} 1/s"


def verdict(record):
    """What matters most."""
    vibration, run = record.vibration, record.run
    state = ", the run is still under way" if run.under_way else ""
    text = f"{figures(MS * run.time[-1], 4)} ms{state}: {vibration.regime()}"
    if vibration.fit:
        text += f", {signed(vibration.fit.growth)} 1/s at {figures(vibration.fit.freq, 6)} Hz"
    if vibration.line:
        text += f"; main line {figures(vibration.line[0], 6)} Hz"
    return text + "."


def transient_part(folder, room):
    """All of it."""
    record = Record(folder)
    halves = [folder.tried(signal_figure, folder, record)]
    if record.vibration.line:
        halves += [folder.tried(make, folder, record) for make in (growth_figure, spectrum_figure, spectrogram_figure)]
    else:
        halves.append(missing(f"No growth and no spectrum: {record.vibration.why}."))
    if record.probe:
        halves.append(folder.tried(orbit_figure, folder, record))
    else:
        halves.append(missing("No motion of a place: the run had no -probes."))
    forces, periods = force_figures(folder, record)
    film, bodies = film_figures(folder, record.run.time[record.vibration.steady][0], room)
    content = section(f"{folder.key}-transient", "In time", forces, tag("div", periods, halves, class_="pair"),
                      folder.tried(amplitude_pieces, folder), film,
                      ledger_figure(folder, record), tag("h4", "Summary"), summary(folder, record))
    return Part(content, bodies, error_facts(record), verdict(record))
