"""Section of a sweep: frequency and growth over one parameter, or the stability map over two; onsets, errors, what was
verified, and sensitivities."""

import numpy

from ..sweep.lines import MARKERS, QUIET, branches_of, jump_places, onset_points, through_onsets
from ..sweep.tables import Study
from ..tables import header, optional, read_table
from .charts import Axis, Chart, Panel
from .maps import map_figures
from .markup import (Column, Part, count, figure, figures, fixed, join, legend, missing, section, signed, table, tag)

LOUD = ("blue", "orange", "green", "purple", "sky")
SIGNS = {"lock_in": ("up", "ink"), "lock_out": ("down", "ink"), "divergence": ("square", "ink"),
         "negative_damping": ("up", "vermilion"), "positive_damping": ("down", "vermilion"),
         "restabilisation": ("square", "green"), "jump": ("cross", "soft")}
FIRST = {"lock_in": "lock-in", "negative_damping": "negative damping"}
VERIFY = {"value": float, "true_error": optional, "error_estimate": optional, "modes_full": int, "modes_reduced": int,
          "unstable_full": int, "unstable_reduced": int}
EXTRA = {"sensitivities.csv": "Sensitivities", "verify.csv":
         "Compared with full solutions", "parameters.csv": "Parameters of the scene"}


def tip_of(branch, i, axis, unit):
    """What a point tells."""
    text = (f"{axis.name} {figures(branch.x[i], 5)} {axis.unit}: {figures(branch.frequency[i], 7)} {unit} "
            f"{branch.label}, "
            f"growth {signed(branch.growth[i])} 1/s, {branch.kind[i]}")
    return text + (f", error {figures(branch.error[i], 2)} Hz" if numpy.isfinite(branch.error[i]) else "")


def branch_panel(study, branches, quantity, scale, unit):
    """Frequency or growth of all branches."""
    loud = [branch for branch in branches if branch.colour != QUIET]
    axis = study.axes[0]
    if quantity == "frequency":
        values = [value for branch in branches for value in branch.frequency]
        panel = Panel(Axis.about(f"frequency, {unit}", values, room=0.03), 420)
    else:
        values = numpy.array([value for branch in loud or branches for value in branch.growth])
        high = max(0.0, numpy.nanmax(values))
        panel = Panel(Axis.about("growth rate, 1/s", [max(numpy.nanmin(values), -1.2 * high or -1), high], True, 0.1),
                      260)
        panel.rule(y=0, colour="ink")
    for x in jump_places(study):
        panel.rule(x=x, colour="grey", tip=f"{axis.name} {figures(x, 4)} {axis.unit}: other pairs are closed from here")
    for row in study.onsets:
        panel.rule(x=row["critical_value"] * axis.factor, colour="soft dashed")
    for branch in branches:
        if branch.colour == QUIET and quantity == "frequency":
            low, high = (function(branch.frequency) for function in (numpy.nanmin, numpy.nanmax))
            panel.line(branch.x, branch.frequency, "quiet", f"{branch.label}: {figures(low, 5)} to "
                                                            f"{figures(high, 5)} {unit}")
    for k, branch in sorted(enumerate(loud), key=lambda pair: (pair[1].kind == "unstable").sum()):  # what grows covers its partner
        y, colour = getattr(branch, quantity), LOUD[k % len(LOUD)]
        x, through, grows = through_onsets(branch, quantity, zip(onset_points(study, quantity, scale), study.onsets))
        panel.line(x, through, colour, branch.label)
        panel.line(numpy.where(grows, x, numpy.nan), through, "vermilion thick", branch.label)
        error = branch.errors(quantity, scale)
        wide = numpy.nan_to_num(error) > 0.004 * (panel.y.high - panel.y.low)
        panel.errors(branch.x[wide], y[wide], error[wide], colour)
        for kinds, style, radius in (("stable", colour, 2.5), ("unstable", "vermilion", 4),
                                     ("numerical", "vermilion hollow", 4)):
            at = numpy.flatnonzero((branch.kind == kinds) & numpy.isfinite(y))
            panel.points(branch.x[at], y[at], style, [tip_of(branch, i, axis, unit) for i in at], radius)
    return panel


def add_onsets(panel, study, scale):
    """Marks with their critical values."""
    axis = study.axes[0]
    for row in study.onsets:
        x, y = row["critical_value"] * axis.factor, row["freq_hz"] * scale
        sign, colour = SIGNS.get(row["kind"], ("square", "ink"))
        name = MARKERS.get(row["kind"], ("", row["kind"]))[1]
        panel.marks([x], [y], sign, colour, [
            f"{name} at {axis.name} {figures(x, 6)} {axis.unit}, {figures(row['freq_hz'], 6)} Hz, {row['label']}"
            + ("" if row["confirmed"] else ", not confirmed on the full problem")])
        panel.label(x, y, f"{figures(x, 4)} {axis.unit}".rstrip())


def line_figure(folder, study):
    """Both panels."""
    scale, unit = (1e-3, "kHz") if max(row["freq_hz"] for row in study.rows) >= 1000 else (1.0, "Hz")
    branches, loud = branches_of(study, scale)
    axis = study.axes[0]
    panels = [branch_panel(study, branches, quantity, scale, unit) for quantity in ("frequency", "growth")]
    add_onsets(panels[0], study, scale)
    for branch in loud:
        growth = numpy.where(branch.kind == "unstable", branch.growth, -numpy.inf)
        if growth.max() > 0:
            panels[1].label(branch.x[growth.argmax()], growth.max(), branch.label, "vermilion")
    kinds = {kind for branch in branches for kind in branch.kind}
    entries = [("vermilion", "line", "unstable")] * ("unstable" in kinds)
    entries += [("vermilion", "hollow", "numerical: the error bar covers zero")] * ("numerical" in kinds)
    entries += [(SIGNS[kind][1], SIGNS[kind][0], name) for kind, (_, name) in MARKERS.items()
                if any(row["kind"] == kind for row in study.onsets)]
    entries += [("quiet", "line", f"{len(branches) - len(loud)} other modes")] * (len(branches) > len(loud))
    x = Axis(axis.title(), axis.first, axis.last, axis.logarithmic)
    chart = Chart("frequency and growth over the parameter", x, panels).markup(f"{folder.key}-lines")
    return figure(f"{folder.key}-branches", study.title(), [legend(entries), chart],
                  "Coloured: modes that are unstable somewhere, or that meet another one. Each point tells its "
                  "numbers.",
                  folder.command("plot/sweep"))


def onset_table(folder, study):
    """Critical values."""
    if not study.onsets:
        return missing("No onsets: the table onsets.csv is not there, or has no row.")
    axis = study.axes[0]
    columns = [Column(f"{axis.name}, {axis.unit}".rstrip(", "), lambda row: row["critical_value"] * axis.factor,
                      lambda v: figures(v, 7)),
               Column("kind", lambda row: MARKERS.get(row["kind"], ("", row["kind"]))[1], left=True),
               Column("label", lambda row: row["label"], left=True),
               Column("freq, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2)),
               Column("confirmed", lambda row: "yes" if row["confirmed"] else "no", left=True,
                      hint="on the factorised full problem")]
    if study.is_map:
        second = study.axes[1]
        columns.insert(1, Column(second.title(), lambda row: row["value_2"] * second.factor, lambda v: figures(v, 5)))
    return table(f"{folder.key}-onsets", columns, study.onsets)


def error_figure(folder, study):
    """Largest error stated at each value, and the true ones of the points that were verified."""
    axis = study.axes[0]
    values = sorted({row["value"] for row in study.rows})
    largest = [max((row["error_hz"] for row in study.rows if row["value"] == value
                    and row["error_hz"] == row["error_hz"]),
                   default=numpy.nan) for value in values]
    if not numpy.isfinite(largest).any():
        return missing("No errors: the table has no value in error_hz.")
    panel = Panel(Axis.about("largest error, Hz", largest, log=True), 240)
    x = numpy.array(values) * axis.factor
    panel.line(x, largest, "blue")
    panel.points(x, largest, "blue", [f"{axis.name} {figures(v, 5)} {axis.unit}: at most {figures(e, 2)} Hz"
                                      for v, e in zip(x, largest)], 3)
    chart = Chart("largest stated error at each value", Axis(axis.title(), axis.first, axis.last, axis.logarithmic),
                  [panel])
    return figure(f"{folder.key}-sweep-errors", "Errors of the sweep", chart.markup(f"{folder.key}-sweep-err", "half"),
                  "The largest of all modes: an estimate, not a bound; that of the mesh is another matter.",
                  folder.command("report"))


def word(text):
    """A number where it is one."""
    try:
        return float(text)
    except ValueError:
        return text


def plain_table(folder, name):
    """Any table as it is."""
    path = folder.path / name
    rows = read_table(path, {column: word for column in header(path)})
    columns = [Column(column, lambda row, column=column: row[column],
                      lambda v: figures(v, 6) if isinstance(v, float) else str(v) or "–",
                      left=any(isinstance(row[column], str) and row[column] for row in rows))
               for column in header(path)]
    return table(f"{folder.key}-{path.stem}", columns, rows)


def verified(folder):
    """True errors beside estimates, in words."""
    path = folder.path / "verify.csv"
    if not path.exists():
        return []
    rows = read_table(path, VERIFY)
    true, stated = (max((row[key] for row in rows if row[key] == row[key]), default=float("nan"))
                    for key in ("true_error", "error_estimate"))
    wrong = sum((row["modes_full"], row["unstable_full"]) != (row["modes_reduced"], row["unstable_reduced"])
                for row in rows)
    return [(f"true error at {count(len(rows), 'verified point')}, relative", figures(true, 2)),
            ("estimate there", figures(stated, 2)), ("verified points with another number of modes", str(wrong))]


def verdict(study):
    """What matters most."""
    names = list(dict.fromkeys(row["label"] for row in study.rows if row["class"] == "unstable"))
    n = len({(row["value"], row["value_2"]) for row in study.rows})
    text = f"{count(n, 'point')}; " + (f"unstable somewhere: {', '.join(names[:6])}"
                                       if names else "no mode is unstable")
    first = min((row for row in study.onsets if row["kind"] in FIRST), key=lambda row: row["critical_value"],
                default=None)
    if first and not study.is_map:
        axis = study.axes[0]
        value = figures(first["critical_value"] * axis.factor, 5)
        text += f"; first {FIRST[first['kind']]} at {axis.name} {value} {axis.unit}".rstrip()
        text += f", {fixed(first['freq_hz'], 1)} Hz, {first['label']}"
    return text + "."


def sweep_part(folder, _):
    """All of it."""
    study = Study(folder.path, folder.options.band, None)
    picture = map_figures(folder, study) if study.is_map else line_figure(folder, study)
    extra = [tag("details", tag("summary", title), folder.tried(plain_table, folder, name))
             for name, title in EXTRA.items() if (folder.path / name).exists()]
    stated = max((row["error_hz"] for row in study.rows if row["error_hz"] == row["error_hz"]), default=float("nan"))
    content = section(f"{folder.key}-sweep", "Sweep", picture,
                      tag("div", tag("div", tag("h4", "Onsets"), onset_table(folder, study)),
                          None if study.is_map else error_figure(folder, study),
                          class_=None if study.is_map else "pair"), join(extra))
    errors = [("largest stated error of an eigenvalue", f"{figures(stated, 2)} Hz"), *verified(folder)]
    return Part(content, None, errors, verdict(study))
