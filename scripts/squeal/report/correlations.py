"""Measured modes and responses beside those of the run, as scripts/correlate has compared them: tables of the folder's correlate, and
the expanded measured shape beside the computed one."""

import numpy

from ..mesh.bodies import Scene, opened, sound
from ..tables import BadInput, optional, read_table
from .markup import Column, Markup, figure, figures, fixed, missing, signed, table, tag
from .shapes import Bodies, Shape, data_script, packed, viewer

PAIRS = {"measured": str, "mode": optional, "label": str, **dict.fromkeys((
    "measured_freq_hz", "freq_hz", "freq_difference_percent", "measured_damping_ratio", "damping_ratio", "mac", "mac_group",
    "cross_orthogonality", "expansion_residual"), optional)}
MATRIX = {"matrix": str, "row": str, "column": str, "value": optional}
RESPONSES = {"response": str, "output": str, "low_hz": float, "high_hz": float, "n_frequencies": int, "frac": optional,
             "level_db": optional}
APART = 1.15  # between the two bodies, in extents
MOST = 40  # rows and columns of a matrix that is shown


class Twins(Bodies):
    """The bodies twice, beside one another: the measured shape moves the left ones, the computed one the right ones."""

    def __init__(self, scene):
        super().__init__(scene)
        shift = numpy.array([APART * numpy.ptp(self.place[:, 0]) / 2, 0, 0])
        self.count = len(self.place)
        self.both = numpy.concatenate([self.place - shift, self.place + shift])
        self.both /= abs(self.both).max()

    def packed(self):
        """What is the same for all shapes."""
        one, n = super().packed(), self.count
        return one | {"points": packed(self.both, "<f4"), "quads": packed(numpy.concatenate([self.quads, self.quads + n]), "<u4"),
                      "edges": packed(numpy.concatenate([self.edges, self.edges + n]), "<u4"), "counts": 2 * one["counts"],
                      "parts": [f"{name}, {side}" for side in ("measured", "computed") for name in one["parts"]], "paint": 2 * one["paint"]}

    def packed_twins(self, measured, computed):
        """Both shapes, each relative to its largest displacement."""
        def normed(shape):
            moved = self.moved(shape)
            return moved / (numpy.sqrt((abs(moved)**2).sum(axis=1).max()) or 1.0)
        together = numpy.concatenate([normed(measured), normed(computed)])
        re, im = (numpy.rint(32767 * part).clip(-32767, 32767) for part in (together.real, together.imag))
        return {"re": packed(re, "<i2"), "im": packed(im, "<i2")}


def pair_table(folder, rows):
    """Measured beside computed."""
    columns = [Column("measured", lambda row: row["measured"] or "–", left=True),
               Column("mode", lambda row: row["mode"], lambda v: f"{v:.0f}"),
               Column("label", lambda row: row["label"], left=True),
               Column("measured, Hz", lambda row: row["measured_freq_hz"], lambda v: fixed(v, 2)),
               Column("computed, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 2)),
               Column("difference, %", lambda row: row["freq_difference_percent"], lambda v: signed(v, 3)),
               Column("measured damping, %", lambda row: 100 * row["measured_damping_ratio"], lambda v: fixed(v, 4)),
               Column("damping, %", lambda row: 100 * row["damping_ratio"], lambda v: fixed(v, 4)),
               Column("MAC", lambda row: row["mac"], lambda v: fixed(v, 3)),
               Column("of group", lambda row: row["mac_group"], lambda v: fixed(v, 3),
                      hint="share of the measured shape in the span of the modes near in frequency: shapes of close modes may be turned"),
               Column("cross-orthogonality", lambda row: row["cross_orthogonality"], lambda v: fixed(v, 3)),
               Column("residual", lambda row: row["expansion_residual"], lambda v: figures(v, 2),
                      hint="part of the measured shape that the computed modes do not make up")]
    return table(f"{folder.key}-correlate-table", columns, rows)


def mac_table(folder, path):
    """MAC of all modes as shades."""
    rows = [row for row in read_table(path, MATRIX) if row["matrix"] == "mac"]
    names = [list(dict.fromkeys(row[key] for row in rows)) for key in ("row", "column")]
    if not rows or max(map(len, names)) > MOST:
        return missing(f"The matrix of MAC is in {path}: it has more than {MOST} rows or columns.") if rows else None
    value = {(row["row"], row["column"]): row["value"] for row in rows}
    head = tag("tr", tag("th", "measured \\ mode"), [tag("th", name) for name in names[1]])
    body = [tag("tr", tag("th", a), [shade(value[a, b]) for b in names[1]]) for a in names[0]]
    return tag("div", tag("h4", "MAC, per cent"), tag("div", tag("table", tag("thead", head), tag("tbody", body),
                                                                 id=f"{folder.key}-correlate-mac"),
                                                     class_="scroll", tabindex="0", role="region", aria_label="MAC"))


def shade(value):
    """A cell as dark as its value."""
    if value != value:
        return tag("td", "–")
    return tag("td", f"{100 * value:.0f}" if value >= 0.1 else "", title=f"{value:.4f}",
               style=f"background: rgb(0 114 178 / {0.75 * value:.2f})")


def twin_figure(folder, rows, room):
    """Measured and computed shapes, moving side by side."""
    path = folder.path / "correlate/expanded.h5"
    rows = [row for row in rows if row["measured"] and row["mode"] == row["mode"]]
    if not path.exists() or not rows:
        return None
    with opened(folder.path / "modes.h5") as file, opened(path) as measured:
        scene = Scene(file, folder.disc())
        bodies, shapes = Twins(scene), []
        for row in sorted(rows, key=lambda row: -row["mac_group"]):
            mode, room = int(row["mode"]), room - 4 * 8 * bodies.count
            if room < 0 and shapes:
                break
            values, raw = [], [file["VTKHDF/PointData"], measured]
            for data in raw:
                re, im = (sound(str(path), f"mode_{mode:03d}_{part}", data[f"mode_{mode:03d}_{part}"][:]) for part in ("re", "im"))
                values.append(re + 1j * im)
            if len(values[1]) != len(scene.points):
                raise BadInput(f"{path}: has other nodes than modes.h5; run scripts/correlate again")
            title = f"{row['measured']}: {fixed(row['measured_freq_hz'], 1)} Hz | mode {mode}: {fixed(row['freq_hz'], 1)} Hz"
            shapes.append(Shape(mode, title, f"Left: measured {row['measured']}, expanded. Right: mode {mode} {row['label']}, MAC "
                                f"{fixed(row['mac'], 3)}.", bodies.packed_twins(values[1], values[0])))
    shapes.sort(key=lambda shape: shape.number)
    source = f"{folder.key}-correlate"
    picture = [data_script(source, bodies, shapes), viewer(f"{source}-viewer", source,
                                                           "measured and computed shape, side by side; drag to turn")]
    return figure(f"{source}-shapes", "Measured shapes beside computed ones", picture,
                  "Left the measured shape, expanded to all nodes by the computed modes; right the computed one.",
                  folder.command("correlate", "FILE..."))


def response_table(folder, path):
    """FRAC of measured responses."""
    columns = [Column("response", lambda row: row["response"], left=True), Column("output", lambda row: row["output"], left=True),
               Column("from, Hz", lambda row: row["low_hz"], lambda v: figures(v, 5)), Column("to, Hz", lambda row: row["high_hz"],
                                                                                              lambda v: figures(v, 5)),
               Column("frequencies", lambda row: row["n_frequencies"]), Column("FRAC", lambda row: row["frac"], lambda v: fixed(v, 4)),
               Column("level, dB", lambda row: row["level_db"], lambda v: signed(v, 3), hint="mean of computed over measured")]
    return [tag("h4", "Measured responses"), table(f"{folder.key}-correlate-responses", columns, read_table(path, RESPONSES))]


def is_newer(path, than):
    """Whether a comparison is of the run that is there."""
    return path.exists() and than.exists() and path.stat().st_mtime >= than.stat().st_mtime


def measured_modes(folder, room):
    """All of the modes; nothing where none were compared since the run."""
    path = folder.path / "correlate/correlate.csv"
    if not is_newer(path, folder.path / "modes.csv"):
        return None
    rows = read_table(path, PAIRS)
    paired = [row for row in rows if row["measured"] and row["mode"] == row["mode"]]
    differences = numpy.array([row["freq_difference_percent"] for row in paired])
    said = f"{len(paired)} of {sum(bool(row['measured']) for row in rows)} measured modes have a computed one"
    said += f"; frequencies differ by {figures(float(numpy.sqrt((differences**2).mean())), 3)} % rms." if paired else "."
    matrix = path.with_name("mac.csv")
    return Markup("".join(filter(None, [
        tag("h4", "Beside a test"), tag("p", said), pair_table(folder, rows), mac_table(folder, matrix) if matrix.exists() else None,
        folder.tried(twin_figure, folder, rows, room)])))


def measured_responses(folder):
    """All of the responses."""
    path = folder.path / "correlate/responses.csv"
    return response_table(folder, path) if is_newer(path, folder.path / "frf.csv") else None
