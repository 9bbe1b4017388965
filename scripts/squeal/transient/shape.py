"""Shape of the vibration from snapshots: velocity of the disc's face across it, and its nodal diameters. Used by
plot/transient."""

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy
from matplotlib.tri import Triangulation

from ..mesh.bodies import read_states
from ..mesh.cells import triangles_of
from ..picture import BLUE, GREEN, GREY, SKY, SOFT, VERMILION
from .spectrum import circle_content
from ..tables import BadInput

WIDTH, HEIGHT = 10.0, 5.6  # inches
RING = 1e-3  # nodes within this part of the outer radius belong to its circle
STILL = 1e-9  # of the largest velocity: nodes that are held
VELOCITY = "velocity_m_s"
MOST = 12  # numbers of nodal diameters in the picture


class Face(NamedTuple):
    """Seen along the axis: places (mm), triangles, outline of the other parts (mm) or None; the circle's nodes, their
    angles, the axis."""
    place: numpy.ndarray
    triangles: numpy.ndarray
    foot: numpy.ndarray | None
    nodes: numpy.ndarray
    ring: numpy.ndarray
    angle: numpy.ndarray
    axis: numpy.ndarray


class Shapes(NamedTuple):
    """The face; velocities in the direction of x, y or z across it (m/s) [snapshot][node of the face] and their times
    (None: unknown); mean squares by number of nodal diameters over all snapshots."""
    face: Face
    velocity: numpy.ndarray
    times: list
    content: numpy.ndarray

    def diameters(self):
        """Number of nodal diameters with most of the mean square."""
        return int(self.content.argmax())

    def share(self):
        """Share of that number in the mean square along the circle."""
        return float(self.content.max() / self.content.sum()) if self.content.sum() > 0 else 0.0


def face_of(scene):
    """The face of the disc towards the other parts, and its outer circle."""
    faces = scene.facing(scene.disc, scene.axis)
    nodes, quads = numpy.unique(faces, return_inverse=True)
    quads = quads.reshape(faces.shape)
    flat = scene.points[nodes] @ numpy.stack([scene.right, scene.up], axis=1)
    flat_centre = (flat.min(axis=0) + flat.max(axis=0)) / 2
    x, y = (flat - flat_centre).T
    radius = numpy.hypot(x, y)
    ring = numpy.flatnonzero(radius >= (1 - RING) * radius.max())
    foot = None
    if len(scene.rest):
        rest = scene.points[numpy.unique(scene.rest)] @ numpy.stack([scene.right, scene.up], axis=1)
        foot = 1e3 * numpy.array([rest.min(axis=0), rest.max(axis=0)])
    triangles = triangles_of(quads)
    return Face(1e3 * flat, triangles, foot, nodes, ring, numpy.arctan2(y[ring], x[ring]), scene.axis)


def read_shapes(files, disc_name, first):
    """Snapshots (time, path) from a time on, or the last one if there is none; times that are not known count all."""
    chosen = [pair for pair in files if pair[0] is None or pair[0] >= first] or files[-1:]
    face, velocity = None, []
    for scene, values in read_states([path for _, path in chosen], VELOCITY, disc_name):
        face = face or face_of(scene)
        velocity.append(values[face.nodes] @ abs(face.axis))
    if len(face.ring) < 8:
        raise BadInput(f"{chosen[0][1]}: {len(face.ring)} nodes on the outer circle of the part {disc_name}, "
                       "8 are needed")
    content = numpy.mean([circle_content(face.angle, values[face.ring]) for values in velocity], axis=0)
    return Shapes(face, numpy.array(velocity), [time for time, _ in chosen], content)


def draw_face(axes, face, values):
    """The face, coloured by its velocity."""
    largest = abs(values).max() or 1
    mesh = Triangulation(*face.place.T, face.triangles)
    surface = axes.tripcolor(mesh, values, shading="gouraud", cmap="RdBu_r", vmin=-largest, vmax=largest,
                             rasterized=True)
    if values.min() < 0 < values.max():
        still = abs(values) <= STILL * largest
        moving = face.triangles[~still[face.triangles].any(axis=1)]
        axes.tricontour(Triangulation(*face.place.T, moving), values, levels=[0], colors="black", linewidths=0.8)
    if face.foot is not None:
        (a, b), (c, d) = face.foot
        axes.plot([a, c, c, a, a], [b, b, d, d, b], color=GREEN, lw=2.2)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return surface


def draw_circle(axes, shapes, chosen):
    """Velocity along the outer circle."""
    angle = numpy.degrees(shapes.face.angle)
    order = numpy.argsort(angle)
    angle, order = numpy.append(angle[order], angle[order[0]] + 360), numpy.append(order, order[0])
    for i, values in enumerate(shapes.velocity):
        style = {"color": BLUE, "lw": 2.2, "zorder": 3} if i == chosen else {"color": SKY, "lw": 0.6, "alpha": 0.5}
        if i == chosen or len(shapes.velocity) <= 60:
            axes.plot(angle, values[shapes.face.ring][order], **style)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_xlim(angle[0], angle[-1])
    axes.set_xticks([-180, -90, 0, 90, 180])
    axes.set_xlabel("angle on the outer circle, degrees", labelpad=2)
    axes.set_ylabel("m/s")
    axes.grid(color="#EDEDED", lw=0.7)


def draw_numbers(axes, content):
    """Part of the mean square by number of nodal diameters."""
    shares = 100 * content[:MOST + 1] / (content.sum() or 1)
    colours = [VERMILION if i == content.argmax() else GREY for i in range(len(shares))]
    axes.bar(range(len(shares)), shares, color=colours, width=0.7)
    axes.set_xlabel("nodal diameters", labelpad=2)
    axes.set_ylabel("% of mean square")
    axes.set_xticks(range(0, len(shares), 2))
    axes.set_ylim(0, 105)


def draw_shape(shapes, case):
    """The face at its largest velocity, the circle, and its content."""
    figure = plt.figure(figsize=(WIDTH, HEIGHT))
    chosen = int((shapes.velocity[:, shapes.face.ring]**2).mean(axis=1).argmax())
    time = shapes.times[chosen]
    direction = "xyz"[int(abs(shapes.face.axis).argmax())]
    n, m = len(shapes.velocity), shapes.diameters()
    figure.text(0.012, 1 - 0.24 / HEIGHT, f"Velocity of the disc's face in {direction}{case}", weight="bold",
                fontsize=15, va="center")
    figure.text(0.012, 1 - 0.56 / HEIGHT, (f"{1e3 * time:.5g} ms; " if time is not None else "")
                + f"{m} nodal diameter{'s' * (m != 1)} with {shapes.share():.0%} of the mean square on the outer "
                f"circle in {n} snapshot{'s' * (n > 1)}", color=SOFT, va="center")
    axes = figure.add_axes([0.01, 0.02, 0.49, 0.83])
    surface = draw_face(axes, shapes.face, shapes.velocity[chosen])
    bar = figure.colorbar(surface, cax=figure.add_axes([0.515, 0.1, 0.012, 0.67]))
    bar.set_label("m/s")
    bar.outline.set_visible(False)
    draw_circle(figure.add_axes([0.71, 0.53, 0.27, 0.31]), shapes, chosen)
    draw_numbers(figure.add_axes([0.71, 0.11, 0.27, 0.28]), shapes.content)
    return figure
