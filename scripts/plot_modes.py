#!/usr/bin/python3
"""Draws the modes that squeal computed: eigenvalues in the complex plane, and shapes.

Above, growth rate (rad/s) against frequency (Hz or kHz); unstable modes are marked and named. Below, the chosen modes
(the four of largest growth among the unstable ones, else the first four): the face of the disc seen along its axis
from the side of the contact, coloured by out-of-plane displacement at the phase of its largest amplitude, nodal lines
in black, the place of the other parts in green; under it those parts seen along the radius, undeformed in grey and
deformed (exaggerated) in blue. Shapes have no scale of their own: colours are relative to the largest value.

Reads modes.csv and modes.h5; without modes.h5 only the eigenvalues are drawn.
"""

import argparse
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import PolyCollection
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from matplotlib.tri import Triangulation
from squeal_tables import BLUE, GREEN, GREY, MINUS, VERMILION, BadInput, flag, save_picture
from squeal_tables import read_table as read_rows

STABLE, UNSTABLE, CONTACT, SHADE = BLUE, VERMILION, GREEN, GREY
COLOURS = "RdBu_r"
WIDTH, DPI = 16, 100  # inches, dots per inch
MAX_SHAPES = 4
LABEL_HEIGHTS = (0, 14, -14, 28, -28, 42, -42, 56, -56, 70, -70, 90, -90)  # tried in this order, points
LABEL_OFFSETS = [(x, y) for y in LABEL_HEIGHTS for x in (14, -14)]
EXAGGERATION = 0.12  # largest displacement of the side view, in heights of the parts

# Faces of VTK's hexahedron, seen anticlockwise from outside
HEX_FACES = numpy.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])


class Scene:
    """Surfaces of the bodies, and the frame in which they are drawn."""

    def __init__(self, file, disc_name):
        group = file["VTKHDF"]
        self.shapes = group["PointData"]
        self.points = group["Points"][:]
        cells = group["Connectivity"][:].reshape(group["NumberOfCells"][0], -1)
        if cells.shape[1] != 8:
            raise BadInput(f"{file.filename}: cells of {cells.shape[1]} nodes; only hexahedra can be drawn")
        names = [name.decode() for name in group["CellData/part"].attrs["names"]]
        on_disc = numpy.full(len(cells), True)
        if disc_name in names:
            on_disc = group["CellData/part"][:] == names.index(disc_name)
        self.disc = boundary_faces(cells[on_disc])
        self.rest = boundary_faces(cells[~on_disc])
        self.rest_names = " and ".join(name for name in names if name != disc_name) if len(self.rest) else ""
        self.set_frame()

    def set_frame(self):
        """Axis = shortest extent of the disc, towards the other parts; radial = towards them in the disc's plane;
        slip = along the circumference there; right and up span the map."""
        disc = self.points[numpy.unique(self.disc)]
        centre = (disc.min(axis=0) + disc.max(axis=0)) / 2
        towards = self.points[numpy.unique(self.rest)].mean(axis=0) - centre if len(self.rest) else numpy.ones(3)
        shortest = numpy.argmin(numpy.ptp(disc, axis=0))
        self.axis = numpy.zeros(3)
        self.axis[shortest] = 1 if towards[shortest] >= 0 else -1
        self.right = numpy.zeros(3)
        self.right[0 if shortest else 1] = 1
        self.up = numpy.cross(self.axis, self.right)
        radial = towards - (towards @ self.axis) * self.axis
        if numpy.linalg.norm(radial) < 1e-6 * numpy.ptp(disc, axis=0).max():
            radial = self.right
        self.radial = radial / numpy.linalg.norm(radial)
        self.slip = numpy.cross(self.axis, self.radial)

    def facing(self, faces, viewer):
        """The faces whose outward normal points at the viewer."""
        corners = self.points[faces]
        normal = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        return faces[normal @ viewer > 0.5 * numpy.linalg.norm(normal, axis=1)]

    def displacement(self, mode):
        """Real displacements at the phase at which the disc's out-of-plane amplitude is largest."""
        key = f"mode_{mode:03d}"
        if f"{key}_re" not in self.shapes:
            raise BadInput(f"{self.shapes.file.filename}: no shape of mode {mode}; see the column mode of modes.csv")
        shape = self.shapes[f"{key}_re"][:] + 1j * self.shapes[f"{key}_im"][:]
        out_of_plane = shape[numpy.unique(self.disc)] @ self.axis
        return (shape * numpy.exp(-0.5j * numpy.angle(numpy.sum(out_of_plane**2)))).real


def boundary_faces(cells):
    """Faces [n][4] that belong to one cell only."""
    faces = cells[:, HEX_FACES].reshape(-1, 4)
    _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def read_table(path):
    """Rows of modes.csv, frequencies in the unit of the picture."""
    rows = read_rows(path, {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str})
    in_khz = max((row["freq_hz"] for row in rows), default=0) >= 1000
    return [{
        "mode": row["mode"],
        "frequency": row["freq_hz"] / (1e3 if in_khz else 1),
        "unit": "kHz" if in_khz else "Hz",
        "growth": row["growth_rad_s"],
        "unstable": row["unstable"],
        "label": row["label"],
    } for row in rows]


def choose_modes(table, wanted):
    """Rows of the modes to draw."""
    if wanted:
        rows = {row["mode"]: row for row in table}
        missing = [mode for mode in wanted if mode not in rows]
        if missing:
            raise BadInput(f"--modes {missing[0]}: no such mode; the table lists {len(table)}")
        return [rows[mode] for mode in wanted]
    unstable = sorted((row for row in table if row["unstable"]), key=lambda row: -row["growth"])[:MAX_SHAPES]
    return sorted(unstable, key=lambda row: row["frequency"]) or table[:MAX_SHAPES]


def place_labels(axes, table):
    """Names the unstable modes where the names cover neither each other nor a point."""
    renderer = axes.figure.canvas.get_renderer()
    points = axes.transData.transform([(row["frequency"], row["growth"]) for row in table])
    taken = [Bbox.from_bounds(x - 5, y - 5, 10, 10) for x, y in points]
    frame = axes.get_window_extent(renderer)
    for row in (row for row in table if row["unstable"]):
        text = f"{row['frequency']:.3f} {row['unit']}  {row['label']}".rstrip()
        for x, y in LABEL_OFFSETS:
            note = axes.annotate(text, (row["frequency"], row["growth"]), (x, y), textcoords="offset points",
                                 fontsize=12, ha="left" if x > 0 else "right", va="center", color=UNSTABLE,
                                 arrowprops={"arrowstyle": "-", "color": SHADE, "lw": 0.6, "shrinkB": 4})
            note.update_positions(renderer)
            box = Text.get_window_extent(note, renderer).padded(2)
            inside = frame.contains(box.x0, box.y0) and frame.contains(box.x1, box.y1)
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            note.remove()


def draw_eigenvalues(axes, table):
    """Growth rate against frequency."""
    for unstable, colour, marker, size in ((False, STABLE, "o", 36), (True, UNSTABLE, "D", 56)):
        rows = [row for row in table if row["unstable"] == unstable]
        name = f"{'unstable' if unstable else 'stable'} ({len(rows)})"
        axes.scatter([row["frequency"] for row in rows], [row["growth"] for row in rows], s=size, c=colour,
                     marker=marker, edgecolors="white", linewidths=0.7, label=name, zorder=3)
    axes.axhline(0, color="black", lw=0.8)
    largest = max((abs(row["growth"]) for row in table), default=0)
    if largest < 1e-3:
        axes.set_ylim(-1, 1)
    axes.margins(x=0.03, y=0.12)
    axes.set_xlabel(f"frequency, {table[0]['unit'] if table else 'Hz'}")
    axes.set_ylabel("growth rate, rad/s")
    axes.set_title("Eigenvalues: above the line a mode grows", loc="left")
    axes.grid(color="#E4E4E4", lw=0.6)
    axes.legend(loc="lower right", ncol=2, frameon=False, bbox_to_anchor=(1, 1), borderpad=0.1)


def draw_map(axes, scene, displacement, row):
    """The disc seen along its axis; returns the coloured surface."""
    faces = scene.facing(scene.disc, scene.axis)
    nodes, quads = numpy.unique(faces, return_inverse=True)
    quads = quads.reshape(faces.shape)
    x, y = (1e3 * scene.points[nodes] @ direction for direction in (scene.right, scene.up))
    triangles = numpy.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    value = displacement[nodes] @ scene.axis
    value = value / (numpy.abs(value).max() or 1)
    surface = axes.tripcolor(Triangulation(x, y, triangles), value, shading="gouraud", cmap=COLOURS, vmin=-1, vmax=1,
                             rasterized=True)
    fixed = ~displacement[nodes].any(axis=1)
    moving = triangles[~fixed[triangles].any(axis=1)]
    if value.min() < 0 < value.max():
        axes.tricontour(Triangulation(x, y, moving), value, levels=[0], colors="black", linewidths=0.7)
    if len(scene.rest):
        foot = 1e3 * scene.points[numpy.unique(scene.rest)]
        a, b = foot @ scene.right, foot @ scene.up
        axes.plot([a.min(), a.max(), a.max(), a.min(), a.min()], [b.min(), b.min(), b.max(), b.max(), b.min()],
                  color=CONTACT, lw=1.8)
    axes.set_aspect("equal")
    axes.set_xlabel("mm")
    growth = f"growth {row['growth']:+.3g} rad/s".replace("-", MINUS)
    axes.set_title(f"{row['mode']}:  {row['frequency']:.3f} {row['unit']}  {row['label']}\n{growth}", fontsize=13,
                   color=UNSTABLE if row["unstable"] else "black")
    return surface


def draw_side(axes, scene, displacement):
    """The other parts seen along the radius, undeformed and deformed."""
    faces = scene.facing(scene.rest, scene.radial)
    nodes, quads = numpy.unique(faces, return_inverse=True)
    quads = quads.reshape(faces.shape)
    frame = numpy.stack([scene.slip, scene.axis], axis=1)
    place, move = 1e3 * scene.points[nodes] @ frame, displacement[nodes] @ frame
    place[:, 0] -= place[:, 0].mean()
    height = numpy.ptp(place[:, 1])
    move *= EXAGGERATION * height / (numpy.abs(move).max() or 1)
    for corners, style in ((place, {"facecolors": "#F2F2F2", "edgecolors": "#CFCFCF"}),
                           (place + move, {"facecolors": "#CFE3F1B0", "edgecolors": STABLE})):
        axes.add_collection(PolyCollection(corners[quads], linewidths=0.5, rasterized=True, **style))
    axes.set_xlim(numpy.array([-1, 1]) * (numpy.abs(place[:, 0]).max() + 2 * EXAGGERATION * height))
    axes.set_ylim(place[:, 1].min() - 0.15 * height, place[:, 1].max() + 0.15 * height)
    axes.set_aspect("equal")
    axes.set_xlabel("along the circumference, mm")


def shape_layout(scene, n_shapes):
    """Places of the maps and of the side views, heights (inches) of the rows and relative widths of the columns: a side
    view stands below its map, or beside it where there is room."""
    columns = range(n_shapes)
    edge = min(5.0, (WIDTH - 1.2) / n_shapes - 0.6)
    if not len(scene.rest):
        return [(0, i) for i in columns], [], [edge + 1.1], n_shapes * [1]
    if n_shapes < 3:
        return [(0, 2 * i) for i in columns], [(0, 2 * i + 1) for i in columns], [edge + 1.1], n_shapes * [1, 0.5]
    return [(0, i) for i in columns], [(1, i) for i in columns], [edge + 1.1, 3.6], n_shapes * [1]


def draw_shapes(figure, layout, scene, rows):
    """Map and side view of each mode."""
    maps, sides, heights, widths = layout
    grid = figure.add_gridspec(len(heights), len(widths) + 1, height_ratios=heights, width_ratios=[*widths, 0.035])
    for column, row in enumerate(rows):
        displacement = scene.displacement(row["mode"])
        axes = figure.add_subplot(grid[maps[column]])
        surface = draw_map(axes, scene, displacement, row)
        if column == 0:
            axes.set_ylabel("mm")
        if sides:
            axes = figure.add_subplot(grid[sides[column]])
            draw_side(axes, scene, displacement)
            if column == 0:
                axes.set_ylabel(f"{scene.rest_names}: height, mm")
    bar = figure.colorbar(surface, cax=figure.add_subplot(grid[0, -1]))
    bar.set_label("out-of-plane displacement / its largest value")


def draw(table, scene, rows, output):
    """The whole picture."""
    layout = shape_layout(scene, len(rows)) if scene else None
    heights = [4.6] + ([sum(layout[2])] if scene else [])
    figure = plt.figure(figsize=(WIDTH, sum(heights)), dpi=DPI, layout="constrained")
    parts = figure.subfigures(len(heights), 1, squeeze=False, height_ratios=heights)
    axes = parts[0, 0].add_subplot()
    draw_eigenvalues(axes, table)
    if scene:
        draw_shapes(parts[1, 0], layout, scene, rows)
    figure.canvas.draw()
    place_labels(axes, table)
    save_picture(figure, output)


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("results"),
                        help="folder that squeal wrote, default: results")
    parser.add_argument("-o", "--output", type=Path, help="picture to write, default: modes.png in that folder")
    parser.add_argument("--modes", help="numbers of the modes to draw, e.g. 3,4,12")
    parser.add_argument("--disc", default="disc",
                        help="part seen along its axis, default: disc; all parts if there is none of that name")
    return parser.parse_args()


def mode_numbers(text):
    """The list of --modes."""
    try:
        return [int(number) for number in text.split(",")] if text else []
    except ValueError:
        raise BadInput(f"--modes {text}: must be numbers with commas between, e.g. 3,4,12") from None


def main():
    """Reads, draws; returns the exit status."""
    args = arguments()
    output = args.output or args.folder / "modes.png"
    fields = args.folder / "modes.h5"
    try:
        wanted = mode_numbers(args.modes)
        table = read_table(args.folder / "modes.csv")
        rows = choose_modes(table, wanted)
        if fields.exists():
            with h5py.File(fields) as file:
                draw(table, Scene(file, args.disc) if rows else None, rows, output)
        elif wanted:
            raise BadInput(f"{fields}: no such file, so that no shape can be drawn; see -output_fields")
        else:
            draw(table, None, rows, output)
    except BadInput as error:
        print(f"plot_modes: {error}", file=sys.stderr)
        return 1
    except (OSError, KeyError) as error:
        print(f"plot_modes: {fields}: cannot be read: {error}", file=sys.stderr)
        return 1
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
