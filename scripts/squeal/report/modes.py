"""Section of complex modes: eigenvalues, moving shapes, the table, contributions of the parts, errors."""

import math

from ..mesh.bodies import Scene, opened
from ..tables import BadInput, flag, header, optional, read_table
from .causes import causes, components
from .correlations import measured_modes
from .cures import cures
from .effects import effects, sensitivities
from .charts import Axis, Chart, Panel
from .markup import Column, Part, count, figure, figures, fixed, legend, missing, section, signed, table, tag
from .shapes import Bodies, Shape, data_script, viewer

KINDS = {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str}
MORE = {"damping_ratio": float, "backward_error": optional, "condition": optional, "error_hz": optional, "label_percent": optional,
        "state": str, "mechanism": str, "partner": optional}
PART = "part_{}_percent"
COLOURS = ("steel", "orange", "green", "purple", "sky", "vermilion", "grey")


class Modes:
    """Rows of modes.csv, and the names of the parts."""

    def __init__(self, folder):
        path = folder / "modes.csv"
        there = header(path)
        self.parts = [name[5:-8] for name in there if name.startswith("part_") and name.endswith("_percent")]
        kinds = KINDS | {name: kind for name, kind in MORE.items() if name in there}
        self.rows = read_table(path, kinds | {PART.format(name): float for name in self.parts})
        self.has = set(kinds)
        self.fields = folder / "modes.h5"
        self.neutral = [row for row in self.rows if row.get("state") == "neutral"]
        self.unstable = sorted((row for row in self.rows if row["unstable"]), key=lambda row: -row["growth_rad_s"])

    def largest(self, name):
        """Largest value of a column; nan where there is none."""
        values = [row[name] for row in self.rows if name in row and row[name] == row[name]]
        return max(values, default=float("nan"))

    def order(self, wanted):
        """Rows whose shapes are shown, the most important ones first: the wanted ones, or the unstable ones, then by
        frequency."""
        rows = {row["mode"]: row for row in self.rows}
        absent = [mode for mode in wanted if mode not in rows]
        if absent:
            raise BadInput(f"--modes {absent[0]}: no such mode; the table lists {len(rows)}")
        return [rows[mode] for mode in wanted] or self.unstable + [row for row in self.rows if not row["unstable"]]


def name_of(row):
    """13: 3472.8 Hz (0,4+)"""
    return f"{row['mode']}: {fixed(row['freq_hz'], 1)} Hz {row['label']}".rstrip()


def mechanism_of(row):
    """coupling with mode 12"""
    text = row.get("mechanism", "").replace("damping_induced", "damping-induced").replace("_", " ")
    return text + (f" with mode {row['partner']:.0f}" if text and row["partner"] == row["partner"] else "")


def detail_of(row):
    """A line about a mode."""
    text = f"Mode {row['mode']}, {fixed(row['freq_hz'], 3)} Hz, {row['label'] or 'unnamed'}: "
    if row["unstable"]:
        text += f"UNSTABLE, growth {signed(row['growth_rad_s'])} 1/s" + ", ".join(["", mechanism_of(row)]).rstrip(", ")
    elif row.get("state") == "neutral":
        text += f"neutral, growth {signed(row['growth_rad_s'])} 1/s, by e in {figures(1 / row['growth_rad_s'], 3)} s"
    elif row["growth_rad_s"]:
        text += f"decays with {figures(-row['growth_rad_s'], 4)} 1/s"
    else:
        text += "neither grows nor decays"
    if row.get("damping_ratio"):
        text += f", damping ratio {figures(100 * row['damping_ratio'], 4)} %"
    return text + "."


def verdict(modes):
    """What matters most."""
    if not modes.rows:
        return "No mode lies in the band."
    low, high = (figures(modes.rows[i]["freq_hz"], 5) for i in (0, -1))
    text = f"{count(len(modes.rows), 'mode')} from {low} to {high} Hz; "
    slight = f" {len(modes.neutral)} more {'grows' if len(modes.neutral) == 1 else 'grow'} so slowly that it is no instability (neutral)." \
        if modes.neutral else ""
    if not modes.unstable:
        return text + "none is unstable." + slight
    worst = modes.unstable[0]
    verb = "is" if len(modes.unstable) == 1 else "are"
    return text + (f"{len(modes.unstable)} {verb} unstable, fastest {worst['label']} at {fixed(worst['freq_hz'], 1)} "
                   f"Hz "
                   f"with {signed(worst['growth_rad_s'])} 1/s{' by ' + mechanism_of(worst) if mechanism_of(worst) else ''}.") + slight


def eigenvalues(modes, folder):
    """Growth against frequency."""
    rows = modes.rows
    scale, unit = (1e-3, "kHz") if max(row["freq_hz"] for row in rows) >= 1000 else (1.0, "Hz")
    x = Axis.about(f"frequency, {unit}", [scale * row["freq_hz"] for row in rows], room=0.03)
    growth = [row["growth_rad_s"] for row in rows]
    most = max(map(abs, growth))
    panel = Panel(Axis.about("growth rate, 1/s", growth if most > 1e-3 else [-1, 1], zero=True, room=0.12), 330)
    panel.rule(y=0, colour="ink")
    for bad, colour, radius in ((False, "blue", 4), (True, "vermilion", 6)):
        chosen = [row for row in rows if row["unstable"] == bad]
        panel.points([scale * row["freq_hz"] for row in chosen], [row["growth_rad_s"] for row in chosen], colour,
                     [detail_of(row) for row in chosen], radius, [{"data_shape": row["mode"]} for row in chosen])
    for row in modes.unstable:
        panel.label(scale * row["freq_hz"], row["growth_rad_s"], f"{scale * row['freq_hz']:.3f} {unit} {row['label']}",
                    "vermilion")
    keys = legend([("vermilion", "dot", f"unstable ({len(modes.unstable)})"),
                   ("blue", "dot", f"stable ({len(rows) - len(modes.unstable) - len(modes.neutral)})"
                    + (f" or neutral ({len(modes.neutral)})" if modes.neutral else ""))])
    picture = [keys, Chart("growth rate of each mode against its frequency", x, [panel]).markup(f"{folder.key}-plane")]
    return figure(f"{folder.key}-eigenvalues", "Eigenvalues", picture,
                  "Above the line a vibration grows. A mode that locks in has a partner below the line.",
                  folder.command("plot/modes"))


def shapes_of(modes, folder, room):
    """Viewer of the shapes that fit into so many bytes of the page; says which do not."""
    if not modes.fields.exists():
        return missing(f"No shapes: {modes.fields.name} is not there; see -output_fields."), None
    with opened(modes.fields) as file:
        scene = Scene(file, folder.disc())
        bodies, shapes, left = Bodies(scene), [], []
        for row in modes.order(folder.options.modes):
            shape = bodies.packed_shape(scene.shape(row["mode"]))
            room -= bodies.bytes_of_shape(shape["im"])
            if room < 0 and shapes:
                left.append(row["mode"])
                continue
            shapes.append(Shape(row["mode"], name_of(row), detail_of(row), shape | {"unstable": row["unstable"]}))
    absent = ", ".join(map(str, left))
    rest = f" Not in the page, which stays below 10 MB: modes {absent}; --modes chooses." if left else ""
    picture = [data_script(folder.key, bodies, shapes),
               viewer(f"{folder.key}-viewer", folder.key, "moving shape of a mode; drag to turn it")]
    number = shapes[0].number
    said = ("Displacements have no scale of their own: colours are relative to the largest value of the shape, white "
            "is "
            "zero. The thin outline is the body at rest. Drag to turn." + rest)
    return figure(f"{folder.key}-shapes", "Mode shapes", picture, said,
                  folder.command("plot/film", f"--mode {number}")), bodies


def mode_table(modes, folder):
    """All numbers."""
    columns = [Column("mode", lambda row: row["mode"]),
               Column("freq, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 3)),
               Column("growth, 1/s", lambda row: row["growth_rad_s"], lambda v: figures(v, 5))]
    if "damping_ratio" in modes.has:
        columns.append(Column("damping, %", lambda row: 100 * row["damping_ratio"], lambda v: fixed(v, 5),
                              hint="negative: the vibration grows"))
    if "mechanism" in modes.has and (modes.unstable or modes.neutral):
        columns += [Column("state", lambda row: row["state"], left=True,
                           hint="neutral: growth beyond its error that is no instability"),
                    Column("mechanism", mechanism_of, left=True, hint="why an unstable mode grows")]
    columns.append(Column("label", lambda row: row["label"], left=True,
                          hint="(n,m): n nodal circles, m nodal diameters; in plane IP-R(m) radial, IP-C(m) circumferential, "
                               "IP-R(n,m) with circles; + an antinode at the contact"))
    if "label_percent" in modes.has:
        columns.append(Column("label, %", lambda row: row["label_percent"], lambda v: fixed(v, 1),
                              hint="share of the shape that the label explains"))
    for name, title, hint in (("error_hz", "error, Hz", "first-order error of the eigenvalue"),
                              ("condition", "condition", "of the eigenvalue: 1 is best"),
                              ("backward_error", "backward error", "relative residual")):
        if name in modes.has:
            columns.append(Column(title, lambda row, name=name: row[name], lambda v: figures(v, 3), hint=hint))
    columns += [Column(f"{name}, %", lambda row, name=name: row[PART.format(name)], lambda v: fixed(v, 1),
                       hint=f"part of {name} in the mode, by left and right vectors") for name in modes.parts]
    return table(f"{folder.key}-table", columns, modes.rows, lambda row: "bad" if row["unstable"] else None,
                 lambda row: {"data_shape": row["mode"]})


def contributions(modes, folder):
    """Which parts take part in which mode."""
    if not modes.parts or not modes.rows:
        return missing("No contributions of parts: the table has no column part_..._percent.")
    panel = Panel(Axis("share, %", 0, 100), 334)
    for k, name in enumerate(modes.parts):
        low = [sum(max(row[PART.format(other)], 0) for other in modes.parts[:k]) for row in modes.rows]
        high = [below + max(row[PART.format(name)], 0) for below, row in zip(low, modes.rows)]
        panel.boxes([[i + 0.54, i + 1.46] for i in range(len(modes.rows))], list(zip(low, high)),
                    len(modes.rows) * [COLOURS[k % len(COLOURS)]],
                    [f"{name_of(row)}: {name} {fixed(row[PART.format(name)], 1)} %" for row in modes.rows])
    for i, row in enumerate(modes.rows):
        if row["unstable"]:
            panel.marks([i + 1], [4], "up", "vermilion", [f"{name_of(row)} is unstable"])
    keys = legend([(COLOURS[k % len(COLOURS)], "box", name) for k, name in enumerate(modes.parts)]
                  + [("vermilion", "up", "unstable")] * bool(modes.unstable))
    x = Axis("mode, in the order of the table", 0.3, len(modes.rows) + 0.7)
    chart = Chart("share of each part in each mode", x, [panel]).markup(f"{folder.key}-share", "half")
    return figure(f"{folder.key}-parts", "Contributions of the parts", [keys, chart],
                  "Measured with left and right vectors, so that the shares sum to 100 %.", folder.command("report"))


def errors(modes, folder):
    """Error and condition of each eigenvalue."""
    rows = [row for row in modes.rows if row.get("error_hz", 0) > 0]
    if not rows:
        return missing("No errors: the table has no column error_hz; see -modes_left.")
    scale, unit = (1e-3, "kHz") if max(row["freq_hz"] for row in rows) >= 1000 else (1.0, "Hz")
    x = Axis.about(f"frequency, {unit}", [scale * row["freq_hz"] for row in rows], room=0.03)
    panels = []
    for name, title in (("error_hz", "error, Hz"), ("condition", "condition")):
        if name not in modes.has:
            continue
        values = [row[name] for row in rows]
        panel = Panel(Axis.about(title, values, log=True), 150)
        tips = [f"{name_of(row)}: error {figures(row['error_hz'], 2)} Hz, condition "
                f"{figures(row.get('condition', math.nan), 3)}" for row in rows]
        panel.points([scale * row["freq_hz"] for row in rows], values, "blue", tips, 3.5)
        panels.append(panel)
    chart = Chart("error and condition of each eigenvalue", x, panels).markup(f"{folder.key}-err", "half")
    return figure(f"{folder.key}-errors", "Errors of the eigenvalues", chart,
                  "Errors of the algebra; that of the mesh is another matter. A large condition is a mode near a "
                  "lock-in.",
                  folder.command("report"))


def error_facts(modes):
    """Largest errors of the eigenvalues."""
    for name, title, unit in (("error_hz", "largest error of an eigenvalue", " Hz"),
                              ("backward_error", "largest backward error", ""), ("condition", "largest condition", "")):
        if name in modes.has:
            yield title, f"{figures(modes.largest(name), 2)}{unit}"


def modes_part(folder, room):
    """All of it."""
    modes, key = Modes(folder.path), f"{folder.key}-modes"
    if not modes.rows:
        return Part(section(key, "Modes", missing("No mode lies in the band.")))
    try:
        shapes, bodies = shapes_of(modes, folder, room)
    except BadInput as error:
        shapes, bodies = folder.lacks(error), None
    content = section(key, "Modes", eigenvalues(modes, folder), causes(modes, folder), effects(modes, folder), cures(folder),
                      sensitivities(modes, folder), components(modes, folder), shapes, folder.tried(measured_modes, folder, room / 2),
                      tag("h4", "Table of modes"),
                      mode_table(modes, folder),
                      tag("div", contributions(modes, folder), errors(modes, folder), class_="pair"))
    return Part(content, bodies and (folder.key, bodies), error_facts(modes), verdict(modes))
