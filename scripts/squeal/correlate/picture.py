"""Pictures of a correlation: MAC of all modes with the frequencies of the pairs, and shapes at the sensors side by side."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Line3DCollection  # noqa: E402

from ..picture import BLUE, GREY, VERMILION, save_picture  # noqa: E402

MOST = 30  # rows and columns of a matrix with numbers in it
NAMES = 40  # along an axis
SHOWN = 6  # pairs
MANY = 1000  # points, from which on they are drawn smaller
MOVED = 0.15  # of the largest extent: the largest motion of a picture


def draw_mac(axes, to):
    """Measured modes upward, computed ones to the right."""
    matrix = to.matrices["mac"]
    image = axes.imshow(matrix, vmin=0, vmax=1, cmap="Blues", origin="lower", aspect="auto")
    for axis, texts in ((axes.xaxis, [f"{row['mode']}\n{row['freq_hz']:.0f}" for row in to.rows]),
                        (axes.yaxis, [f"{mode.name}  {mode.freq:.0f}" for mode in to.measured.modes])):
        step = -(-len(texts) // NAMES)
        axis.set_ticks(range(0, len(texts), step), texts[::step], fontsize=7)
    axes.set_xlabel("computed mode, Hz")
    axes.set_ylabel("measured mode, Hz")
    if max(matrix.shape) <= MOST:
        for (i, k), value in numpy.ndenumerate(matrix):
            if value >= 0.1:
                axes.text(k, i, f"{100 * value:.0f}", ha="center", va="center", fontsize=6, color="white" if value > 0.6 else "black")
    for pair in to.pairs:
        axes.add_patch(plt.Rectangle((pair.computed - 0.5, pair.measured - 0.5), 1, 1, fill=False, edgecolor=VERMILION, lw=1.5))
    axes.figure.colorbar(image, ax=axes, label="MAC; pairs are framed")


def draw_frequencies(axes, to):
    """Computed over measured frequency in per cent."""
    pairs = sorted(to.pairs, key=lambda pair: to.measured.modes[pair.measured].freq)
    values = [100 * (to.rows[pair.computed]["freq_hz"] / to.measured.modes[pair.measured].freq - 1) for pair in pairs]
    axes.bar(range(len(pairs)), values, color=BLUE)
    axes.axhline(0, color="black", lw=0.8)
    axes.set_xticks(range(len(pairs)), [to.measured.modes[pair.measured].name for pair in pairs], fontsize=7)
    axes.set_xlabel("measured mode")
    axes.set_ylabel("computed less measured, %")


def draw_summary(to, output):
    """MAC and frequencies."""
    figure, axes = plt.subplots(1, 2 if to.matrices else 1, figsize=(16 if to.matrices else 8, 7), dpi=100, layout="constrained",
                                squeeze=False,
                                width_ratios=[2, 1] if to.matrices else [1])
    if to.matrices:
        draw_mac(axes[0, 0], to)
    draw_frequencies(axes[0, -1], to)
    save_picture(figure, output)
    plt.close(figure)


def sensor_points(to):
    """Places of the sensors [points][3], and of each channel the number of its point."""
    places = numpy.array([sensor.channel.place for sensor in to.found])
    _, first, of = numpy.unique(places.round(9), axis=0, return_index=True, return_inverse=True)
    return places[first], of.ravel()


def motion(to, values, of, count):
    """Real motions of the points at the phase of the largest one."""
    values = values * numpy.exp(-0.5j * numpy.angle((values**2).sum()))
    moves = numpy.zeros((count, 3))
    for sensor, value, point in zip(to.found, values.real, of):
        moves[point] += value * sensor.channel.direction
    return moves / (numpy.linalg.norm(moves, axis=1).max() or 1)


def draw_shape(axes, points, moves, lines, colour):
    """Points at rest and moved; trace lines where there are some."""
    moved = points + moves
    small = min(1, MANY / len(points))
    axes.scatter(*points.T, s=4 * small, linewidths=0, color=GREY)
    axes.scatter(*moved.T, s=9 * small, linewidths=0, color=colour)
    axes.add_collection3d(Line3DCollection(moved[numpy.reshape(lines, (-1, 2)).astype(int)], colors=colour, linewidths=0.8))
    axes.add_collection3d(Line3DCollection(numpy.stack([points, moved], axis=1), colors=colour, linewidths=0.4 * small))
    middle, half = (points.max(axis=0) + points.min(axis=0)) / 2, 0.55 * numpy.ptp(points, axis=0).max()
    for name, at in zip("xyz", middle):
        getattr(axes, f"set_{name}lim")(at - half, at + half)
    axes.set_box_aspect((1, 1, 1), zoom=1.5)
    axes.set_axis_off()


def draw_shapes(to, output):
    """The pairs that are most alike, measured above computed."""
    pairs = sorted(sorted(to.pairs, key=lambda pair: -pair.share)[:SHOWN], key=lambda pair: pair.measured)
    points, of = sensor_points(to)
    number = {sensor.channel.name.rstrip("xyz").rstrip("-"): k for sensor, k in zip(to.found, of)}
    lines = [(number[a], number[b]) for a, b in to.measured.lines if a in number and b in number]
    scale, shapes = MOVED * numpy.ptp(points, axis=0).max(), to.measured.shapes()
    figure = plt.figure(figsize=(3.2 * max(len(pairs), 2), 6.4), dpi=100, layout="constrained")
    for column, pair in enumerate(pairs):
        a, b = shapes[:, pair.measured], to.computed[:, pair.computed]
        a = a * numpy.vdot(a, b)  # in phase with the computed one
        row, mode = to.rows[pair.computed], to.measured.modes[pair.measured]
        moves = [motion(to, values, of, len(points)) for values in (a, b)]
        if (moves[0] * moves[1]).sum() < 0:
            moves[0] = -moves[0]
        for i, (colour, title) in enumerate(((VERMILION, f"measured {mode.name}: {mode.freq:.1f} Hz"),
                                             (BLUE, f"mode {row['mode']}: {row['freq_hz']:.1f} Hz, MAC {pair.mac:.3f}"))):
            axes = figure.add_subplot(2, len(pairs), 1 + column + i * len(pairs), projection="3d")
            draw_shape(axes, points, scale * moves[i], lines, colour)
            axes.set_title(title, fontsize=9, color=colour)
    save_picture(figure, output)
    plt.close(figure)
