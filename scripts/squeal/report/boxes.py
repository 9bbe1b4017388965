"""Sections of a quiet box and of a design: what is stated and how sure, the box and its cells in planes through the scene's own values,
the nearest dangerous point; the design that was found beside the scene, the designs on the way, and its corners in full."""

import itertools
import math

import numpy

from ..tables import header, optional, read_table
from .charts import Axis, Chart, Panel
from .markup import Column, Part, count, figure, figures, fixed, legend, missing, pairs, section, signed, table, tag

COLOURS = {"quiet": "green", "dangerous": "vermilion", "open": "grey"}
MOST_PLANES = 6
BOUNDS = {"variable": str, "own": float, "lower": float, "upper": float, "quiet_lower": float, "quiet_upper": float, "danger": optional}
STATEMENT = {"goal": str, "size": float, "quiet_share": float, "dangerous_share": float, "open_share": float, "margin_rad_s": optional,
             "error": float, "danger_distance": optional, "danger_label": str, "danger_freq_hz": optional, "danger_growth_rad_s": optional,
             "confirmed": str, "full_freq_hz": optional, "full_growth_rad_s": optional, "cells": int, "random": int, "random_unstable": int,
             "full": int, "full_unstable": int, "full_true_error": optional, "full_modes_beyond_error": int, "full_other_status": int,
             "closed_pairs": optional, "status_points": int, "other_status": int, "other_pairs": int,
             "other_distance": optional}
DESIGN = ("design", "scenarios", "unstable_scenarios", "unstable_modes", "excess_rad_s", "freq_hz", "change", "mass_ratio", "solved",
          "full_excess_rad_s", "found", "statuses", "other_statuses")
CORNER = ("modes", "unstable", "excess_rad_s", "freq_hz", "growth_rad_s", "error_rad_s", "closed_pairs")


def plane(folder, cells, rows, pair, number):
    """Two of the variables; the others at the scene's own values."""
    across, up = (rows[k] for k in pair)
    others = [row for k, row in enumerate(rows) if k not in pair]
    seen = [cell for cell in cells
            if all(cell[f"lower_{row['variable']}"] <= row["own"] <= cell[f"upper_{row['variable']}"] for row in others)]
    panel = Panel(Axis(up["variable"], up["lower"], up["upper"]), 340)
    ends = [numpy.array([[cell[f"lower_{row['variable']}"], cell[f"upper_{row['variable']}"]] for cell in seen]) for row in (across, up)]
    if seen:
        panel.boxes(*ends, [f"{COLOURS[cell['state']]} faint" for cell in seen],
                    [f"{cell['state']}" + (f", margin {figures(cell['margin_rad_s'], 3)} rad/s" if cell["state"] == "quiet" else "")
                     for cell in seen])
    (left, right), (low, high) = ((row["quiet_lower"], row["quiet_upper"]) for row in (across, up))
    panel.line([left, right, right, left, left], [low, low, high, high, low], "blue thick", "the quiet box")
    panel.marks([across["own"]], [up["own"]], "cross", "ink", ["the scene's own values"])
    if math.isfinite(across["danger"]):
        panel.points([across["danger"]], [up["danger"]], "vermilion", ["nearest dangerous point"], 5)
    chart = Chart(f"{up['variable']} over {across['variable']}", Axis(across["variable"], across["lower"], across["upper"]), [panel])
    return chart.markup(f"{folder.key}-plane-{number}", "half")


def planes(folder, rows):
    """All pairs of variables, up to six."""
    if len(rows) < 2:
        return missing("No picture of the cells: there is one variable.")
    names = {f"{end}_{row['variable']}": float for row in rows for end in ("lower", "upper")}
    cells = read_table(folder.path / "quiet_cells.csv", {"state": str, "margin_rad_s": optional, **names})
    chosen = list(itertools.combinations(range(len(rows)), 2))[:MOST_PLANES]
    keys = legend([(colour, "box", name) for name, colour in COLOURS.items()] + [("blue", "line", "the box"), ("ink", "cross", "the scene"),
                                                                                ("vermilion", "dot", "nearest dangerous point")])
    drawn = tag("div", [plane(folder, cells, rows, pair, k) for k, pair in enumerate(chosen)], class_="pair")
    return figure(f"{folder.key}-cells", "Cells of the box", [keys, drawn],
                  "Each in the plane through the scene's own values of the other variables.", folder.command("plot/quiet"))


def bound_table(folder, rows):
    """A row a variable."""
    number = lambda v: figures(v, 6)  # noqa: E731
    half = lambda row: 50 * (row["quiet_upper"] - row["quiet_lower"]) / abs(row["own"]) if row["own"] else math.nan  # noqa: E731
    columns = [Column("variable", lambda row: row["variable"], left=True), Column("the scene's", lambda row: row["own"], number),
               Column("given: from", lambda row: row["lower"], number), Column("to", lambda row: row["upper"], number),
               Column("quiet: from", lambda row: row["quiet_lower"], number), Column("to", lambda row: row["quiet_upper"], number),
               Column("half width, %", half, lambda v: figures(v, 4), hint="of the quiet box, of the scene's own value"),
               Column("dangerous at", lambda row: row["danger"], number)]
    return table(f"{folder.key}-quiet-box", columns, rows)


def statement_facts(statement):
    """What is known, and how sure."""
    s, shares = statement, [f"{figures(100 * statement[f'{name}_share'], 4)} % {name}" for name in COLOURS]
    yield "the cells", f"{s['cells']} tested; {', '.join(shares)} of the volume of the box"
    if math.isfinite(s["margin_rad_s"]):
        yield "margin, in each cell at least", f"{figures(s['margin_rad_s'], 3)} rad/s"
    if math.isfinite(s["danger_distance"]):
        told = "the full solution there does not grow"
        if s["confirmed"] == "yes":
            told = f"full solution {fixed(s['full_freq_hz'], 2)} Hz, {signed(s['full_growth_rad_s'])} 1/s"
        yield "nearest dangerous point", (f"at {figures(s['danger_distance'], 5)} of the box: {s['danger_label'] or 'a mode'}, "
                                          f"{fixed(s['danger_freq_hz'], 2)} Hz, {signed(s['danger_growth_rad_s'])} 1/s; {told}")
    else:
        yield "nearest dangerous point", "none was found in the box"
    yield "random points inside", f"{s['random']}, {s['random_unstable']} unstable on the reduced model"
    if s["full"]:
        yield "of these in full", (f"{s['full']}, {s['full_unstable']} unstable; largest true error {figures(s['full_true_error'], 2)}, "
                                   f"{s['full_modes_beyond_error']} modes beyond what is stated")
    if math.isfinite(s["closed_pairs"]):
        other = f", as at all {s['status_points']} points of the box that were looked at"
        if s["other_status"]:
            other = (f"; others are closed at {s['other_status']} of {s['status_points']} points of the box, by {s['other_pairs']} pairs "
                     f"at most, the nearest at {figures(s['other_distance'], 3)} of the box: there the statement is none about the brake")
        yield "contact status", f"that of the scene's own values, {s['closed_pairs']:.0f} pairs closed{other}"


def quiet_verdict(statement):
    """What matters most."""
    if statement["goal"] == "parts":
        return (f"Of the box {figures(100 * statement['quiet_share'], 4)} % is quiet, {figures(100 * statement['dangerous_share'], 4)} % "
                f"dangerous, {figures(100 * statement['open_share'], 4)} % is left open.")
    if statement["size"] <= 0:
        return "No box about the scene's own values is quiet."
    text = f"No mode of the band grows in {'all' if statement['size'] == 1 else figures(statement['size'], 4)} of the box"
    if math.isfinite(statement["danger_distance"]):
        text += f"; the nearest dangerous point is at {figures(statement['danger_distance'], 4)}"
    return text + (f"; this is about the contact status of the scene's own values, which {statement['other_status']} of "
                   f"{statement['status_points']} points of the box do not have." if statement["other_status"] else ".")


def quiet_part(folder, _):
    """All of a quiet box."""
    rows = read_table(folder.path / "quiet.csv", BOUNDS)
    statement = read_table(folder.path / "quiet_statement.csv", STATEMENT)[0]
    content = section(f"{folder.key}-quiet", "Quiet box", bound_table(folder, rows), pairs(statement_facts(statement)),
                      folder.tried(planes, folder, rows))
    return Part(content, None, [("largest estimated relative error of an eigenvalue", figures(statement["error"], 2))],
                quiet_verdict(statement))


def change_table(folder, names, first, last):
    """The design beside the scene."""
    columns = [Column("parameter", lambda name: name, left=True), Column("the scene's", lambda name: first[name], lambda v: figures(v, 6)),
               Column("the design's", lambda name: last[name], lambda v: figures(v, 6)),
               Column("change, %", lambda name: 100 * (last[name] / first[name] - 1) if first[name] else math.nan, lambda v: signed(v, 3))]
    return table(f"{folder.key}-change", columns, names)


def design_table(folder, rows):
    """The designs on the way."""
    columns = [Column("design", lambda row: int(row["design"])),
               Column("unstable scenarios", lambda row: int(row["unstable_scenarios"])),
               Column("unstable modes", lambda row: int(row["unstable_modes"])),
               Column("growth beyond the limit, 1/s", lambda row: row["excess_rad_s"], lambda v: figures(v, 4), hint="largest"),
               Column("at, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2)),
               Column("change", lambda row: row["change"], lambda v: figures(v, 3), hint="root of the mean square, of the half widths"),
               Column("mass, %", lambda row: 100 * (row["mass_ratio"] - 1), lambda v: signed(v, 3)),
               Column("in full, 1/s", lambda row: row["full_excess_rad_s"], lambda v: figures(v, 4),
                      hint="growth beyond the limit of the full solution at the worst scenario"),
               Column("statuses", lambda row: int(row["statuses"]), hint="of the contact, of its scenarios"),
               Column("others", lambda row: int(row["other_statuses"]),
                      hint="scenarios whose status is none of the basis: the nearest was taken")]
    return table(f"{folder.key}-designs", columns, rows, lambda row: "bad" if row["unstable_scenarios"] else None)


def corner_table(folder):
    """Full solutions of the design that was found."""
    path = folder.path / "design_corners.csv"
    if not path.exists():
        return missing("No corners in full: no design was found, or nothing is uncertain.")
    names = header(path)[len(CORNER):]
    rows = read_table(path, dict.fromkeys((*CORNER, *names), optional))
    columns = [Column("unstable", lambda row: int(row["unstable"])),
               Column("growth beyond the limit, 1/s", lambda row: row["excess_rad_s"], lambda v: figures(v, 4)),
               Column("at, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2))]
    if any(math.isfinite(row["closed_pairs"]) for row in rows):
        columns.append(Column("closed pairs", lambda row: row["closed_pairs"], lambda v: fixed(v, 0)))
    columns += [Column(name, lambda row, name=name: row[name], lambda v: figures(v, 5)) for name in names]
    return table(f"{folder.key}-corners", columns, rows, lambda row: "bad" if row["unstable"] else None)


def design_verdict(rows, last, corners):
    """What matters most."""
    text = f"The scene has an unstable mode at {count(int(rows[0]['unstable_scenarios']), 'scenario')} of {rows[0]['scenarios']:.0f}; "
    if not last["found"]:
        return text + f"no design was found in {count(len(rows), 'try', 'tries')}."
    left, mass = count(int(last["unstable_scenarios"]), "scenario"), signed(100 * (last["mass_ratio"] - 1), 3)
    text += f"a design leaves {left} unstable, with {mass} % mass"
    bad = sum(row["unstable"] > 0 for row in corners)
    return text + (f"; {bad} of {len(corners)} full solutions at corners are unstable." if corners else ".")


def design_part(folder, _):
    """All of a design."""
    path, corners = folder.path / "design.csv", folder.path / "design_corners.csv"
    names = header(path)[len(DESIGN):]
    rows = read_table(path, dict.fromkeys((*DESIGN, *names), optional))
    last = next((row for row in rows if row["found"]), rows[-1])
    solved = read_table(corners, {"unstable": float}) if corners.exists() else []
    content = section(f"{folder.key}-design", "Design", tag("h4", "The design beside the scene" if last["found"] else "The last try"),
                      change_table(folder, names, rows[0], last), tag("h4", "Designs on the way"), design_table(folder, rows),
                      tag("h4", "The design at corners of what is uncertain, in full"), folder.tried(corner_table, folder))
    return Part(content, None, [], design_verdict(rows, last, solved))
