"""Section of the sliding state: pressure and status of every pair, profile along the sliding, reactions and their
balance, residuals of the laws of contact and friction, deformation."""

import re

import numpy
from matplotlib.colors import to_hex

from ..mesh.bodies import read_states
from ..static.map import COLOURS, EMPTY
from ..static.pairs import MM, SAME, grid_cells, profile, read_surfaces, triangles
from ..tables import BadInput, read_table
from .charts import Axis, Chart, Panel
from .markup import (Column, Markup, Part, count, figure, figures, join, legend, missing, scale, section, table,
                     tag)
from .shapes import Bodies, Shape, data_script, viewer
from .words import sliding_words

MOST_TIPS = 4000  # pairs that tell their numbers
REACTIONS = {"name": str, "kind": str, "force_x_n": float, "force_y_n": float, "force_z_n": float}
DISPLACEMENT = "displacement_m"
WORDS = {"open": "open", "stick": "sticking", "slip": "sliding"}
LAWS = (("penetration", "largest overlap of a pair, to the largest displacement or gap"),
        ("sign", "largest pull of a pair, to the largest normal force"),
        ("complementarity", "largest force across a gap"),
        ("cone", "largest friction beyond mu times the normal force"),
        ("dissipation", "largest friction off the direction of slip, or slip where a pair holds"),
        ("equilibrium", "forces that the equilibrium leaves over, to the load"))


def tips_of(surface):
    """What each pair tells."""
    return [f"pair {n}, {WORDS[status]}: x {figures(x[0] * MM, 4)}, y {figures(x[1] * MM, 4)}, z "
            f"{figures(x[2] * MM, 4)} mm; "
            f"normal force {figures(force, 4)} N, friction {figures(friction, 4)} N, {surface.quantity} "
            f"{figures(value, 4)} {surface.unit}, gap {figures(1e6 * gap, 3)} µm"
            for n, status, x, force, friction, value, gap in zip(
                surface.number, surface.status, surface.x, surface.normal_force, surface.friction, surface.value,
                surface.gap)]


def colour_of(surface):
    """Of the pressure of each pair."""
    most = surface.value.max() or 1
    return [to_hex(COLOURS(value / most)) for value in surface.value]


def cells_of(surface):
    """Limits [n][2] along both axes of the area of each pair; None where the pairs form no grid."""
    cells = grid_cells(surface)
    if cells is None:
        return None

    def limits(borders, place):
        i = numpy.clip(numpy.searchsorted(borders, place, side="right") - 1, 0, len(borders) - 2)
        return numpy.stack([borders[i], borders[i + 1]], axis=1)

    return limits(cells[0], surface.place[:, 0]), limits(cells[1], surface.place[:, 1])


def patches_of(surface):
    """Polygons [k][2] of the area of each pair where the pairs form no grid: of each triangle between pairs what is nearest
    to one of its corners."""
    found = [[] for _ in surface.number]
    if min(surface.size) > SAME * max(surface.size):
        for corners in triangles(surface).get_masked_triangles():
            places = surface.place[corners]
            for i, pair in enumerate(corners):
                found[pair].append([places[i], (places[i] + places[i - 2]) / 2, places.mean(axis=0),
                                    (places[i] + places[i - 1]) / 2])
    return found


def pressure_chart(surface, key):
    """The pairs seen along the normal."""
    (x0, y0), (x1, y1) = surface.limits()
    panel = Panel(Axis(surface.axis_title(1), y0, y1), 400)
    tips = tips_of(surface) if len(surface.number) <= MOST_TIPS else len(surface.number) * [None]
    cells = cells_of(surface)
    closed = surface.closed
    colours = [colour if shut else EMPTY for colour, shut in zip(colour_of(surface), closed)]
    if cells:
        panel.boxes(*cells, colours, tips)
    else:
        panel.patches(patches_of(surface), colours, tips)
    for name, radius, colour in (("open", 4, "dark hollow"), ("slip", 2, "dark"), ("stick", 4, "blue")):
        chosen = numpy.flatnonzero(surface.status == name)
        panel.points(*surface.place[chosen].T, colour, [tips[i] for i in chosen],
                     radius * min(1, (400 / max(len(surface.number), 1))**0.5) + 1)
    middle = MM * surface.middle @ surface.axes.T
    panel.rule(x=middle[0], colour="soft dashed")
    panel.rule(y=middle[1], colour="soft dashed")
    if surface.centre is not None:
        panel.marks([surface.centre[0]], [surface.centre[1]], "cross", "green",
                    [f"centre of force: {figures(surface.centre[0], 4)}, {figures(surface.centre[1], 4)} mm"])
    arrow = surface.arrow()
    if len(arrow):
        panel.line(*arrow.T, "blue thick", "direction in which the slave slides")
        panel.points([arrow[1][0]], [arrow[1][1]], "blue", ["the slave slides this way: the leading edge"], 6)
    chart = Chart(f"pressure and status of the pairs of {surface.name or 'the contact'}",
                  Axis(surface.axis_title(0), x0, x1), [panel], square=True)
    entries = [("dark", "hollow", f"open ({(~closed).sum()})")] * bool((~closed).any())
    entries += [(colour, "dot", f"{WORDS[name]} ({(surface.status == name).sum()})")
                for name, colour in (("slip", "dark"), ("stick", "blue")) if (surface.status == name).any()]
    entries += [("green", "cross", "centre of force")] + [("blue", "line", "sliding direction")] * bool(len(arrow))
    colours = scale(lambda share: to_hex(COLOURS(share)), f"{figures(surface.value.max(), 3)} {surface.unit}")
    return join([legend(entries), colours, chart.markup(f"{key}-map", "half")])


def profile_chart(surface, key):
    """Mean pressure of each row along the sliding."""
    borders, value, closed, pairs = profile(surface)
    unit = f"mean {surface.quantity}, {surface.unit}" if surface.area is not None else "normal force of a row, N"
    panel = Panel(Axis.about(unit, value, zero=True), 360)
    tips = [f"{figures(a, 4)} to {figures(b, 4)} mm: {figures(v, 4)} "
            f"{surface.unit if surface.area is not None else 'N'}, "
            f"{n} of {of} pairs closed" for a, b, v, n, of in zip(borders, borders[1:], value, closed, pairs)]
    panel.boxes(numpy.stack([borders[:-1], borders[1:]], axis=1), [[0, v] for v in value], len(value) * ["orange"],
                tips)
    along = surface.profile_axis
    axis = Axis(surface.axis_title(along), borders.min(), borders.max())
    if surface.direction is not None:
        ends = (axis.low, axis.high) if surface.direction[along] > 0 else (axis.high, axis.low)
        for at, text in zip(ends, ("trailing edge", "leading edge")):
            inside = at + 0.15 * (sum(ends) / 2 - at)
            panel.label(inside, panel.y.high * 0.9, text, "blue")
    return Chart("pressure along the sliding", axis, [panel]).markup(f"{key}-profile", "half")


def residuals(scene):
    """Of the laws and of the equilibrium, (meaning, text), as squeal wrote them; none where it did not."""
    facts = scene.facts if scene else {}
    found = dict(re.findall(r"(\w+) (\d[\d.e+-]*)", facts.get("kkt", "")))
    found["equilibrium"] = facts.get("equilibrium", "")
    for name, meaning in LAWS:
        try:
            yield meaning, figures(float(found[name]), 2)
        except (KeyError, ValueError):
            continue


def reactions(folder):
    """Forces on the bodies, their table and what is left over relative to the largest one."""
    path = folder.path / "reactions.csv"
    if not path.exists():
        return missing("No reactions: reactions.csv is not there."), None
    rows = read_table(path, REACTIONS)
    columns = [Column("name", lambda row: row["name"], left=True), Column("kind", lambda row: row["kind"], left=True)]
    columns += [Column(f"force {axis}, N", lambda row, axis=axis: row[f"force_{axis}_n"], lambda v: figures(v, 6))
                for axis in "xyz"]
    force = numpy.array([[row[f"force_{axis}_n"] for axis in "xyz"] for row in rows
                         if not row["kind"].startswith("contact")]).reshape(-1, 3)
    largest = abs(force).max() if len(force) else 0
    left = abs(force.sum(axis=0)).max() / largest if largest else 0.0
    return table(f"{folder.key}-reactions", columns, rows), left


def deformation(folder):
    """The bodies as the loads bend them."""
    path = folder.path / "static.h5"
    if not path.exists():
        return missing("No deformation: static.h5 is not there; see -output_fields."), None
    (scene, field), = read_states([path], DISPLACEMENT, folder.disc())
    bodies = Bodies(scene)
    largest = 1e6 * numpy.linalg.norm(field, axis=1).max()
    detail = f"Largest displacement {figures(largest, 4)} µm."
    shape = Shape(0, "sliding state", detail, bodies.packed_shape(field))
    source = f"{folder.key}-static-field"
    picture = [data_script(source, bodies, [shape], fixed=True),
               viewer(f"{source}-viewer", source, "deformed bodies; drag to turn them")]
    return figure(f"{source}-figure", "Deformation", picture, f"{detail} Exaggerated; the outline is the body at rest.",
                  folder.command("report")), bodies


def pair_table(folder, surface, key):
    """All pairs."""
    rows = range(len(surface.number))
    columns = [Column("pair", lambda i: surface.number[i])]
    columns += [Column(f"{axis}, mm", lambda i, k=k: float(MM * surface.x[i, k]), lambda v: figures(v, 5))
                for k, axis in enumerate("xyz")]
    columns += [Column("status", lambda i: str(surface.status[i]), left=True),
                Column("normal force, N", lambda i: float(surface.normal_force[i]), lambda v: figures(v, 5)),
                Column("friction, N", lambda i: float(surface.friction[i]), lambda v: figures(v, 5)),
                Column(f"{surface.quantity}, {surface.unit}", lambda i: float(surface.value[i]),
                       lambda v: figures(v, 4)),
                Column("gap, µm", lambda i: float(1e6 * surface.gap[i]), lambda v: figures(v, 4))]
    return tag("details", tag("summary", f"All {count(len(surface.number), 'pair')}"),
               table(f"{key}-pairs", columns, rows))


def surface_figures(folder, surface, number):
    """Map, profile, table of one interface."""
    key, command = f"{folder.key}-contact{number}", folder.command("plot/static")
    slides = sliding_words(folder.scene, surface.name) if folder.scene else ""
    maps = figure(f"{key}-pressure", f"Pressure {surface.name}".rstrip(), pressure_chart(surface, key),
                  f"{surface.summary()}{slides and '; '}{slides}.", command)
    rows = figure(f"{key}-rows", "Rows along the sliding", profile_chart(surface, key),
                  "Friction turns the pad: the leading edge carries more.", command)
    return [tag("div", maps, rows, class_="pair"), pair_table(folder, surface, key)]


def static_part(folder, _):
    """All of it."""
    surfaces = read_surfaces(folder.path / "static.csv")
    forces, left = folder.tried(reactions, folder), None
    if not isinstance(forces, Markup):
        forces, left = forces
    try:
        shape, bodies = deformation(folder)
    except BadInput as error:
        shape, bodies = folder.lacks(error), None
    errors = [("forces left over, to the largest", figures(left, 2))] if left is not None else []
    errors += residuals(folder.scene)
    content = section(f"{folder.key}-static", "Sliding state",
                      [surface_figures(folder, surface, i) for i, surface in enumerate(surfaces, 1)],
                      tag("h4", "Forces on the bodies"), forces, shape)
    verdict = "; ".join(f"{surface.name}: {surface.summary()}" if surface.name else surface.summary()
                        for surface in surfaces) + "."
    return Part(content, bodies and (f"{folder.key}-static-field", bodies), errors, verdict)
