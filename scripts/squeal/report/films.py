"""Figures from the snapshots of a transient: the moving bodies, and what the disc's face does."""

import numpy

from ..mesh.bodies import read_states
from ..tables import BadInput
from ..transient.history import snapshots
from ..transient.shape import MOST, read_shapes
from .charts import Axis, Chart, Panel
from .markup import count, figure, figures, missing, tag
from .shapes import FULL, Bodies, Shape, data_script, packed, viewer

DISPLACEMENT = "displacement_m"
MOST_FRAMES = 80


def chosen_snapshots(files, first, room, size):
    """Those after the ramp, evenly thinned to what the page can hold; size: bytes of one."""
    later = [pair for pair in files if pair[0] is None or pair[0] >= first]
    later = later if len(later) > 1 else files
    most = max(2, min(MOST_FRAMES, int(room / size)))
    return later[::-(-len(later) // most)]


def film_figure(folder, files, first, room):
    """The bodies over time without their mean, and the source of the viewer with its bodies."""
    (scene, _), = read_states([files[0][1]], DISPLACEMENT, folder.disc())
    bodies = Bodies(scene)
    chosen = chosen_snapshots(files, first, room, bodies.bytes_of_shape(False))
    moves = numpy.array([bodies.moved(field) for _, field in
                         read_states([path for _, path in chosen], DISPLACEMENT, folder.disc())])
    moves -= moves.mean(axis=0)
    largest = numpy.sqrt((moves**2).sum(axis=2).max()) or 1.0
    frames = [Shape(i, f"snapshot {i}", f"{figures(1e3 * time, 5)} ms." if time is not None else path.stem,
                    {"re": packed(numpy.rint(FULL * move / largest), "<i2"), "im": None})
              for i, (move, (time, path)) in enumerate(zip(moves, chosen))]
    source = f"{folder.key}-film"
    picture = [data_script(source, bodies, frames, frames=True),
               viewer(f"{source}-viewer", source, "moving bodies; drag to turn them")]
    said = (f"{len(frames)} of {len(files)} snapshots, without their mean, which does not vibrate: at most "
            f"{figures(1e6 * largest, 3)} µm, exaggerated.")
    return figure(f"{source}-figure", "Vibration of the bodies", picture, said, folder.command("plot/film")), (source,
                                                                                                               bodies)


def diameters_figure(folder, files, first):
    """Nodal diameters of the disc's face, and its outer circle."""
    shapes = read_shapes(files, folder.disc(), first)
    shares = 100 * shapes.content[:MOST + 1] / (shapes.content.sum() or 1)
    panel = Panel(Axis("part of the mean square, %", 0, 105), 240)
    panel.boxes([[n - 0.38, n + 0.38] for n in range(len(shares))], [[0, share] for share in shares],
                ["vermilion" if share == shares.max() else "steel" for share in shares],
                [f"{n} nodal diameters: {figures(share, 3)} %" for n, share in enumerate(shares)])
    number = Chart("nodal diameters", Axis("nodal diameters", -0.6, len(shares) - 0.4), [panel])
    chosen = int((shapes.velocity[:, shapes.face.ring]**2).mean(axis=1).argmax())
    order = numpy.argsort(shapes.face.angle)
    angle = numpy.degrees(shapes.face.angle[order])
    panel = Panel(Axis.about("velocity across the face, m/s", shapes.velocity[:, shapes.face.ring].ravel()), 240)
    for i in range(0, len(shapes.velocity), -(-len(shapes.velocity) // 20)):
        panel.line(angle, shapes.velocity[i][shapes.face.ring][order], "sky thin")
    panel.rule(y=0, colour="ink")
    panel.line(angle, shapes.velocity[chosen][shapes.face.ring][order], "blue", "snapshot of the largest velocity")
    circle = Chart("velocity along the outer circle", Axis("angle on the outer circle, degrees", -180, 180), [panel])
    time = shapes.times[chosen]
    command = folder.command("plot/transient")
    return [figure(f"{folder.key}-circle", "Limit-cycle shape: outer circle of the disc",
                   circle.markup(f"{folder.key}-circle-chart", "half"),
                   "Velocity across the face" + (f", the largest at {figures(1e3 * time, 5)} ms."
                                                 if time is not None else "."),
                   command),
            figure(f"{folder.key}-diameters", "Nodal diameters", number.markup(f"{folder.key}-diameters-chart", "half"),
                   f"Most of the mean square, {100 * shapes.share():.0f} %, has "
                   f"{count(shapes.diameters(), 'nodal diameter')}.", command)]


def film_figures(folder, first, room):
    """All of it, and the bodies for the picture of the scene."""
    files = snapshots(folder.path)
    if not files:
        return missing("No shapes in time: there are no snapshots; see -dynamics_snapshot_interval."), None
    try:
        film, bodies = film_figure(folder, files, first, room)
    except BadInput as error:
        return folder.lacks(error), None
    return [film, tag("div", folder.tried(diameters_figure, folder, files, first), class_="pair")], bodies
