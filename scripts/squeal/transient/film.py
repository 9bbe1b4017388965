"""Films of bodies that move: quads painted from the back to the front, lit, coloured by the displacement along the
disc's axis; written as GIF, and as MP4 where there is ffmpeg. Used by plot/film."""

import matplotlib.pyplot as plt
import numpy
from matplotlib import animation, colormaps
from matplotlib.collections import LineCollection, PolyCollection

from ..picture import INK, SOFT, save_picture
from ..tables import BadInput

YAW, PITCH = 0.55, 0.62  # of the look, rad
SIZE, DPI = (6.4, 4.8), 100  # inches, dots per inch
COLOURS = colormaps["RdBu_r"]
LIGHT = numpy.array([-0.36, 0.51, 0.78])
FINEST = 6000  # quads of a picture: fewer are divided, so that colours are smooth
FEWEST = 0.1  # of the largest displacement: colours do not tell apart less
BRIGHT = 0.93  # of the nodes of a still have colours within the scale
EDGE, EDGE_LIFT = (0.13, 0.13, 0.13, 0.7), 0.012  # of a still: colour, and how far it stands before its faces


def look(yaw=YAW, pitch=PITCH):
    """Rotation of places: right, up, towards the viewer."""
    c, s, e, f = numpy.cos(yaw), numpy.sin(yaw), numpy.cos(pitch), numpy.sin(pitch)
    return numpy.array([[c, s, 0], [s * f, -c * f, e], [-s * e, c * e, f]])


class Motion:
    """What moves: `skin`, moves [frames][nodes][3] relative to the largest, a text for each frame."""

    def __init__(self, skin, moves, title, texts):
        largest = numpy.sqrt((moves**2).sum(axis=2).max()) or 1.0
        self.skin, self.moves, self.title, self.texts = skin, moves / largest, title, texts
        self.range = max(abs(self.moves[:, :, 2]).max(), FEWEST)

    @classmethod
    def of_shape(cls, skin, shape, n_frames, title):
        """A complex shape over one turn of its phase."""
        phase = 2 * numpy.pi * numpy.arange(n_frames) / n_frames
        moved = skin.moved(shape)
        moves = (moved[None] * numpy.exp(1j * phase)[:, None, None]).real
        return cls(skin, moves, title, [f"phase {numpy.degrees(angle):.0f}°" for angle in phase])


def divided(values, n):
    """Bilinear values [quads * n * n][4][...] at the corners of n times n parts of each quad [quads][4][...]."""
    at = numpy.arange(n)
    corner = [(at[None, :] + a, at[:, None] + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    u, v = (numpy.stack([numpy.broadcast_to(c[k], (n, n)).ravel() for c in corner], axis=1) / n for k in (0, 1))
    weights = numpy.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=2)
    return numpy.einsum("pck,qk...->qpc...", weights, values).reshape(-1, *values.shape[1:])


class Screen:
    """One picture that is changed from frame to frame."""

    def __init__(self, motion, exaggeration, turn):
        self.motion, self.exaggeration, self.turn = motion, exaggeration, turn
        self.figure = plt.figure(figsize=SIZE, dpi=DPI)
        self.parts = int(numpy.clip(numpy.sqrt(FINEST / len(motion.skin.quads)), 1, 5))
        self.axes = self.figure.add_axes([0, 0, 1, 0.88])
        self.axes.set_axis_off()
        self.axes.set_aspect("equal")
        rest = motion.skin.place @ self.turn.T
        self.rest = self.axes.add_collection(LineCollection(rest[motion.skin.edges][:, :, :2], colors="#00000040",
                                                            linewidths=0.5))
        self.quads = self.axes.add_collection(PolyCollection([], linewidths=0.4))
        room = 0.05 + 0.6 * exaggeration
        for limit, values in ((self.axes.set_xlim, rest[:, 0]), (self.axes.set_ylim, rest[:, 1])):
            limit(values.min() - room / 2, values.max() + room / 2)
        self.figure.text(0.03, 0.95, motion.title, weight="bold", fontsize=13, va="center", color=INK)
        self.note = self.figure.text(0.03, 0.9, "", fontsize=10, va="center", color=SOFT)

    def faces(self, i):
        """Of one frame: corners of the pieces of quads [n][4][3] that face the viewer, and their colours."""
        skin, move = self.motion.skin, self.motion.moves[i]
        place = (skin.place + self.exaggeration * move) @ self.turn.T
        corners = divided(place[skin.quads], self.parts)
        value = divided(move[skin.quads][:, :, 2], self.parts).mean(axis=1) / self.motion.range
        normal = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        normal /= numpy.linalg.norm(normal, axis=1)[:, None] + 1e-300
        seen = normal[:, 2] > 0
        colours = COLOURS(0.5 + 0.5 * value[seen])
        colours[:, :3] *= (0.62 + 0.38 * abs(normal[seen] @ LIGHT))[:, None]
        return corners[seen], colours

    def paint(self, corners, colours):
        """From the back to the front."""
        order = numpy.argsort(corners[:, :, 2].mean(axis=1))
        self.quads.set_verts(corners[order][:, :, :2])
        self.quads.set_facecolor(colours[order])
        self.quads.set_edgecolor(colours[order])

    def show(self, i):
        """One frame."""
        self.paint(*self.faces(i))
        self.note.set_text(self.motion.texts[i])
        return [self.quads, self.note]

    def show_still(self):
        """The first frame, with its edges where nothing is before them, and no text."""
        corners, colours = self.faces(0)
        skin = self.motion.skin
        place = (skin.place + self.exaggeration * self.motion.moves[0]) @ self.turn.T + [0, 0, EDGE_LIFT]
        edges = place[skin.edges[:, [0, 1, 1, 0]]]
        self.rest.remove()
        self.paint(numpy.concatenate([corners, edges]), numpy.concatenate([colours, numpy.tile(EDGE, (len(edges), 1))]))


def has_ffmpeg():
    """Whether MP4 can be written."""
    return animation.FFMpegWriter.isAvailable()


def write_still(motion, output, exaggeration, turn):
    """Writes the first frame as `output` with the ending .png; returns its name."""
    motion.range = max(numpy.quantile(abs(motion.moves[0, :, 2]), BRIGHT), 1e-300)
    screen = Screen(motion, exaggeration, turn)
    screen.parts = max(screen.parts, 2)
    screen.show_still()
    save_picture(screen.figure, output.with_suffix(".png"), 1.6 * DPI)
    plt.close(screen.figure)
    return output.with_suffix(".png")


def write_film(motion, output, exaggeration, rate, turn):
    """Writes `output` with the endings .gif and .mp4; returns the names written."""
    screen = Screen(motion, exaggeration, turn)
    film = animation.FuncAnimation(screen.figure, screen.show, frames=len(motion.moves))
    writers = [(".gif", animation.PillowWriter(fps=rate))]
    if has_ffmpeg():
        writers.append((".mp4", animation.FFMpegWriter(fps=rate, codec="libx264", extra_args=["-pix_fmt", "yuv420p"])))
    for ending, writer in writers:
        path = output.with_suffix(ending)
        try:
            film.save(path, writer=writer)
        except OSError as error:
            raise BadInput(f"cannot write {path}: {error.strerror or error}") from None
    plt.close(screen.figure)
    return [output.with_suffix(ending) for ending, _ in writers]
