"""Sections of a map of vibration and of limit cycles: the picture of plot/map or plot/cycle, and the rows of the table."""

import base64
import io
import math

import matplotlib.pyplot as plt

from ..transient.cycle_branch import COLUMNS as CYCLES
from ..transient.cycle_branch import Branch, draw_branch
from ..sweep.tables import FONTS
from ..tables import BadInput, read_table
from ..transient.vibration_map import VIBRATES, WAYS, Table, draw_table
from .markup import Column, Part, count, figure, figures, missing, section, table, tag

DPI = 130


def picture(draw, *given, about):
    """What a function draws, as an element of the page."""
    with plt.rc_context(FONTS):
        drawn = draw(*given)
        try:
            file = io.BytesIO()
            drawn.savefig(file, format="png", dpi=DPI)
        finally:
            plt.close(drawn)
    return tag("img", src="data:image/png;base64," + base64.b64encode(file.getvalue()).decode(), alt=about, class_="plot")


def number(title, name, digits=5, factor=1.0):
    """A column of numbers of the table."""
    return Column(title, lambda row: factor * row[name], lambda value: figures(value, digits))


def map_part(folder, _):
    """A row a point and direction."""
    vibration = Table(folder.path)
    columns = [number(axis.title(), name, factor=axis.factor) for axis, name in zip(vibration.axes, ("value", "value_2"))]
    columns += [Column("direction", lambda row: WAYS[row["direction"]][0] if row["direction"] in WAYS else row["direction"],
                       left=True),
                Column("regime", lambda row: row["regime"], left=True), number("main line, Hz", "freq_hz", 6),
                number("its error, Hz", "freq_error_hz", 2), number("rms of the force, N", "force_rms_n"),
                number("its error, %", "error_estimate", 2, 100), number("time without force, %", "open_share", 3, 100),
                number("growth, 1/s", "growth_rad_s", 4), Column("ended", lambda row: row["status"], left=True)]
    rows = vibration.rows
    vibrates = sum(row["regime"] in VIBRATES for row in rows)
    verdict = f"{count(len(rows), 'row')}: {vibrates} vibrate, {sum(row['regime'] == 'stable' for row in rows)} are stable"
    chance = sum(row["regime"] == "bistable" for row in rows)
    verdict += f", {chance} of those that vibrate by rounding alone (bistable)" if chance else ""
    n_both = len(vibration.find_both_ways())
    verdict += f"; {count(n_both, 'point')} vibrate{'s' * (n_both == 1)} one way and {'is' if n_both == 1 else 'are'} stable the other."
    drawn = figure(f"{folder.key}-vibration", "Where it vibrates, and how much",
                   picture(draw_table, vibration, about="regime, amplitude and frequency over the parameters"), "",
                   folder.command("plot/map"))
    rows = table(f"{folder.key}-points", columns, rows, lambda row: "bad" if row["regime"] in VIBRATES else None)
    return Part(section(f"{folder.key}-map", "Map of vibration", drawn, tag("h4", "All transients"), rows), verdict=verdict)


def cycle_columns(parameter):
    """Of the table of cycles."""
    columns = [number(parameter, "value", 7), Column("kind", lambda row: row["kind"], left=True)] if parameter else []
    return columns + [
        Column("stability", lambda row: row["class"], left=True), number("freq, Hz", "freq_hz", 7),
        number("its error, Hz", "freq_error_hz", 2), number("rms of the force, N", "force_rms_n"),
        number("its error, N", "force_rms_error_n", 2), number("largest force, N", "force_peak_n"),
        number("error, N", "force_peak_error_n", 2), number("largest multiplier", "multiplier_abs"),
        number("its error", "multiplier_error", 2)]


def cycle_part(folder, _):
    """A row a cycle, in their order along the branch."""
    path = folder.path / "cycle.csv"
    rows = read_table(path, CYCLES)
    if not rows:
        raise BadInput(f"{path}: has no rows")
    parameter = rows[0]["parameter"]
    drawn = missing("One cycle and no branch: -cycle_parameter follows one.")
    verdict = f"Limit cycle of {figures(rows[0]['freq_hz'], 6)} Hz, {rows[0]['class']}."
    if parameter:
        values = [row["value"] for row in rows if not math.isnan(row["value"])] or [math.nan]
        folds = [figures(row["value"], 5) for row in rows if row["kind"] == "fold"]
        verdict = (f"{count(len(rows) - len(folds), 'limit cycle')} from {parameter} {figures(min(values), 5)} to "
                   f"{figures(max(values), 5)}" + (f"; folds at {', '.join(folds)}" if folds else "") + ".")
        drawn = figure(f"{folder.key}-branch", f"Limit cycles over {parameter}",
                       picture(draw_branch, Branch(folder.path), about=f"amplitude and stability over {parameter}"), "",
                       folder.command("plot/cycle"))
    rows = table(f"{folder.key}-cycles", cycle_columns(parameter), rows,
                 lambda row: "bad" if row["class"] == "unstable" else None)
    return Part(section(f"{folder.key}-cycle", "Limit cycles", drawn, tag("h4", "All cycles"), rows), verdict=verdict)
