"""Sections of samples and of conditions: probability of growth of each branch, histogram of its growth, growth over each
variable, which variable matters; modes of conditions and how many of them are unstable in each frequency band."""

import math

import numpy

from ..tables import header, optional, read_table
from .charts import Axis, Chart, Panel
from .markup import Column, Part, count, figure, figures, fixed, legend, missing, section, table, tag

COLOURS = ("vermilion", "blue", "green", "orange", "purple")
BINS = 48
MOST_POINTS = 600  # of a branch over a variable
FIRST = 7  # columns of samples.csv before the variables
PROBABILITY = {"branch": str, "label": str, "samples": int, "unstable": int, "freq_mean_hz": optional, "probability": optional,
               "probability_lower": optional, "probability_upper": optional, "growth_99_rad_s": optional}
INDEX = {"branch": str, "of": str, "variable": str, "total": optional, "total_error": optional, "slope": optional, "slope_error": optional}
BANDS = {"freq_from_hz": float, "freq_to_hz": float, "conditions": int, "occurrence_percent": float, "modes": int, "worst": str,
         "growth_rad_s": optional, "freq_hz": optional}
MODES = {"condition": int, "name": str, "branch": str, "label": str, "freq_hz": float, "growth_rad_s": float, "class": str}


def branch_growth(folder):
    """Branch -> numbers of samples from 0 on, growth."""
    found = {}
    for row in read_table(folder.path / "samples_modes.csv", {"sample": int, "branch": str, "growth_rad_s": float}):
        if row["branch"]:
            numbers, growth = found.setdefault(row["branch"], ([], []))
            numbers.append(row["sample"] - 1)
            growth.append(row["growth_rad_s"])
    return {branch: (numpy.array(numbers), numpy.array(growth)) for branch, (numbers, growth) in found.items()}


def shown_branches(rows):
    """Branches that may grow, the likeliest first; the first of all where none may."""
    rows = sorted((row for row in rows if row["branch"] != "any" and row["samples"]),
                  key=lambda row: (-row["probability"], -row["growth_99_rad_s"]))
    return [row for row in rows if row["unstable"]][:len(COLOURS)] or rows[:1]


def histogram(folder, rows, growth):
    """Samples by growth."""
    values = numpy.concatenate([growth[row["branch"]][1] for row in rows])
    edges = numpy.linspace(values.min(), values.max() if values.max() > values.min() else values.min() + 1, BINS + 1)
    counts = [numpy.histogram(growth[row["branch"]][1], edges)[0] for row in rows]
    panel = Panel(Axis("samples", 0, 1.05 * max(count.max() for count in counts)), 260)
    for row, colour, height in zip(rows, COLOURS, counts):
        seen = height > 0
        panel.boxes(numpy.c_[edges[:-1], edges[1:]][seen], numpy.c_[numpy.zeros(seen.sum()), height[seen]],
                    [f"{colour} faint"] * seen.sum(),
                    [f"{row['label']}: {n} samples from {figures(a, 3)} to {figures(b, 3)} 1/s"
                     for n, a, b in zip(height[seen], edges[:-1][seen], edges[1:][seen])])
    panel.rule(x=0)
    chart = Chart("histogram of the growth", Axis("growth rate, 1/s", edges[0], edges[-1]), [panel])
    keys = legend([(colour, "line", row["label"]) for row, colour in zip(rows, COLOURS)])
    return figure(f"{folder.key}-histogram", "Growth", [keys, chart.markup(f"{folder.key}-histogram-chart", "half")],
                  "Right of zero the mode grows.", folder.command("plot/sample"))


def scatter(folder, rows, growth, samples, name, k):
    """Growth over one variable."""
    values = numpy.array([sample[name] for sample in samples])
    panel = Panel(Axis.about("growth rate, 1/s", numpy.concatenate([growth[row["branch"]][1] for row in rows]), zero=True), 220)
    for row, colour in zip(rows, COLOURS):
        numbers, growing = (each[::-(-len(growth[row["branch"]][0]) // MOST_POINTS)] for each in growth[row["branch"]])
        panel.points(values[numbers], growing, colour,
                     [f"sample {n + 1}: {name} {figures(x, 4)}, {figures(y, 4)} 1/s" for n, x, y in zip(numbers, values[numbers], growing)],
                     2)
    panel.rule(y=0)
    return Chart(f"growth over {name}", Axis.about(name, values), [panel]).markup(f"{folder.key}-scatter-{k}", "half")


def bars_of(index, of, key):
    """Value and error of branches and variables, where there are any."""
    chosen = [row for row in index if row["of"] == of and math.isfinite(row[key])]
    return {(row["branch"], row["variable"]): (row[key], row[f"{key}_error"]) for row in chosen}


def tornado(folder, rows, index, names):
    """Bars of what matters, the most important on top; of the frequency where growth is the same everywhere."""
    total = any(math.isfinite(row["total"]) for row in index)
    key = "total" if total else "slope"
    bars, of = bars_of(index, "growth_rad_s", key), "growth"
    if not any((row["branch"], name) in bars for row in rows for name in names):
        bars, of = bars_of(index, "freq_hz", key), "frequency, as growth is the same in all"
    none = (math.nan, math.nan)
    order = sorted(names, key=lambda name: max((abs(numpy.nan_to_num(bars.get((row["branch"], name), none)[0])) for row in rows),
                                               default=0))
    panel = Panel(Axis("", -0.6, len(order) - 0.4), 40 + 34 * len(order))
    largest = max([abs(value) for (branch, _), (value, _) in bars.items() if branch in {row["branch"] for row in rows}], default=0) or 1
    for k, (row, colour) in enumerate(zip(rows, COLOURS)):
        for place, name in enumerate(order):
            value, error = bars.get((row["branch"], name), none)
            low = place - 0.4 + 0.8 * k / len(rows)
            if math.isfinite(value):
                panel.boxes(numpy.array([[min(value, 0), max(value, 0)]]), numpy.array([[low, low + 0.8 / len(rows)]]), [colour],
                            [f"{row['label']}, {name}: {figures(value, 3)} ± {figures(error, 2)}"])
    left = -0.7 * largest if total else -1.05 * largest
    for place, name in enumerate(order):
        panel.label(0.5 * left if total else 0.9 * left, place, name)
    panel.rule(x=0)
    title = f"{'total index of Sobol' if total else 'standardised slope'} of the {of}"
    chart = Chart(title, Axis(title, left, 1.05 * largest), [panel])
    return figure(f"{folder.key}-tornado", "What matters", chart.markup(f"{folder.key}-tornado-chart", "half"),
                  "Each with its standard error where it is touched.", folder.command("plot/sample"))


def probability_table(folder, rows):
    """Branches with their probabilities."""
    columns = [Column("branch", lambda row: row["branch"], left=True), Column("label", lambda row: row["label"], left=True),
               Column("mean freq, Hz", lambda row: row["freq_mean_hz"], lambda v: fixed(v, 2)),
               Column("samples", lambda row: row["samples"]),
               Column("grows, %", lambda row: 100 * row["probability"], lambda v: figures(v, 4)),
               Column("at least, %", lambda row: 100 * row["probability_lower"], lambda v: figures(v, 4)),
               Column("at most, %", lambda row: 100 * row["probability_upper"], lambda v: figures(v, 4)),
               Column("growth 99 %, 1/s", lambda row: row["growth_99_rad_s"], lambda v: figures(v, 4))]
    return table(f"{folder.key}-probability", columns, rows)


def sample_part(folder, _):
    """All of samples."""
    names = header(folder.path / "samples.csv")[FIRST:]
    samples = read_table(folder.path / "samples.csv", {name: float for name in names})
    rows = read_table(folder.path / "probability.csv", PROBABILITY)
    shown, growth = shown_branches(rows), branch_growth(folder)
    if not shown or not names:
        return Part(section(f"{folder.key}-sample", "Samples", missing("No branch has a mode in the band at any sample.")), None, [],
                    "No modes.")
    content = section(
        f"{folder.key}-sample", "Samples", tag("h4", "Probability of growth"), probability_table(folder, rows),
        tag("div", histogram(folder, shown, growth),
            tornado(folder, shown, read_table(folder.path / "indices.csv", INDEX), names), class_="pair"),
        tag("div", [scatter(folder, shown, growth, samples, name, k) for k, name in enumerate(names)], class_="pair"))
    worst = next(row for row in rows if row["branch"] == "any")
    verdict = (f"{count(len(samples), 'sample')}: some mode grows in {figures(100 * worst['probability'], 3)} % of them "
               f"({figures(100 * worst['probability_lower'], 3)} to {figures(100 * worst['probability_upper'], 3)} %).")
    return Part(content, None, [], verdict)


def bubble_figure(folder, rows):
    """A bubble for each mode of each condition."""
    largest = max((abs(row["growth_rad_s"]) for row in rows), default=0) or 1
    panel = Panel(Axis.about("frequency, Hz", numpy.array([row["freq_hz"] for row in rows])), 380)
    for row in sorted(rows, key=lambda row: row["class"] == "unstable"):
        panel.points([row["condition"]], [row["freq_hz"]], "vermilion" if row["class"] == "unstable" else "grey",
                     [f"{row['name']}: {row['label']} {fixed(row['freq_hz'], 1)} Hz, {figures(row['growth_rad_s'], 4)} 1/s, "
                      f"{row['class']}"],
                     2.2 + 14 * math.sqrt(abs(row["growth_rad_s"]) / largest))
    chart = Chart("modes of conditions", Axis.about("condition", numpy.array([row["condition"] for row in rows])), [panel])
    keys = legend([("vermilion", "line", "unstable"), ("grey", "line", "decays or is neutral")])
    return figure(f"{folder.key}-bubbles", "Modes of the conditions", [keys, chart.markup(f"{folder.key}-bubbles-chart")],
                  f"The area is the growth or decay, at most {figures(largest, 3)} 1/s.", folder.command("plot/conditions"))


def conditions_part(folder, _):
    """All of conditions."""
    rows, bands = read_table(folder.path / "conditions.csv", MODES), read_table(folder.path / "conditions_bands.csv", BANDS)
    columns = [Column("from, Hz", lambda row: row["freq_from_hz"], lambda v: figures(v, 6)),
               Column("to, Hz", lambda row: row["freq_to_hz"], lambda v: figures(v, 6)),
               Column("unstable conditions", lambda row: row["conditions"]),
               Column("occurrence, %", lambda row: row["occurrence_percent"], lambda v: figures(v, 4)),
               Column("unstable modes", lambda row: row["modes"]), Column("worst", lambda row: row["worst"], left=True),
               Column("its growth, 1/s", lambda row: row["growth_rad_s"], lambda v: figures(v, 4)),
               Column("at, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2))]
    content = section(f"{folder.key}-conditions", "Conditions",
                      bubble_figure(folder, rows) if rows else missing("No condition has a mode in the band."),
                      tag("h4", "Occurrence by frequency band"), table(f"{folder.key}-bands", columns, bands[:-1]))
    n = bands[-1]["conditions"]
    return Part(content, None, [], f"{count(n, 'condition')} {'is' if n == 1 else 'are'} unstable, "
                                   f"{figures(bands[-1]['occurrence_percent'], 3)} % of all.")
