"""What all pictures share: colours, the command line of a script that draws a folder, texts that cover nothing,
saving."""

import argparse
from pathlib import Path

import numpy
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter
from matplotlib.transforms import Bbox

from .tables import BadInput

# Safe for colour-blind readers (Okabe and Ito)
BLUE, VERMILION, GREEN, SKY, PURPLE, ORANGE = "#0072B2", "#D55E00", "#009E73", "#56B4E9", "#AA4499", "#E69F00"
GREY, SOFT, INK = "#8A8A8A", "#555555", "#222222"
MINUS = "\N{MINUS SIGN}"


def folder_parser(doc, output):
    """Command line with the folder that squeal wrote, and -o with its help."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("results"),
                        help="folder that squeal wrote, default: results")
    parser.add_argument("-o", "--output", type=Path, help=output)
    return parser


def rising(text):
    """Two rising numbers of the command line."""
    try:
        first, last = map(float, text.split(","))
    except ValueError:
        first, last = 0, 0
    if not 0 <= first < last < float("inf"):
        raise argparse.ArgumentTypeError(f"{text}: must be two numbers, the smaller one first, e.g. 2500,6000")
    return first, last


def boxes_about(axes, points, half):
    """Squares of half width `half`, points of the screen, about places of a panel."""
    return [Bbox.from_bounds(x - half, y - half, 2 * half, 2 * half) for x, y in axes.transData.transform(points)]


def place_texts(axes, texts, offsets, taken, **style):
    """Texts (point, text) at the first of the offsets (points) where they cover neither each other nor the boxes taken;
    those that find no room are left out. `style`: of annotate(); `ha` may depend on the offset's sign, as "outward"."""
    renderer = axes.figure.canvas.get_renderer()
    frame = axes.get_window_extent(renderer)
    outward = style.pop("ha", "center") == "outward"
    for point, text in texts:
        for offset in offsets:
            side = ("left" if offset[0] > 0 else "right") if outward else "center"
            note = axes.annotate(text, point, offset, textcoords="offset points", ha=side, va="center", **style)
            note.update_positions(renderer)
            box = Text.get_window_extent(note, renderer).padded(3)
            inside = frame.contains(box.x0, box.y0) and frame.contains(box.x1, box.y1)
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            note.remove()


def spread(places, least):
    """Places that are `least` apart at least, moved as little as their order allows, from 0 to 1."""
    order = numpy.argsort(places)
    moved = numpy.array(places, float)[order]
    for _ in range(200):
        gap = least - numpy.diff(moved)
        push = numpy.maximum(gap, 0) / 2
        moved[:-1] -= push
        moved[1:] += push
        moved = numpy.clip(moved, 0, 1)
        if gap.max(initial=0) <= 1e-6:
            break
    out = numpy.empty_like(moved)
    out[order] = moved
    return out


def plain_number(value):
    """As one writes it, thousands with a k."""
    return f"{value / 1000:g}k" if value >= 1000 else f"{value:g}"


def plain_ticks(axis, digits):
    """Numbers of a logarithmic axis, drawn already: powers of ten, and those between that begin with one of `digits`, or with 2 or 5
    where it has more than a decade."""
    low, high = axis.get_view_interval()
    shown = "25" if high > 10 * low else digits
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(value)))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: plain_number(value) if f"{value:.0e}"[0] in shown else ""))


def save_picture(figure, output, dpi="figure"):
    """Writes the picture in the format of the name's ending."""
    try:
        figure.savefig(output, dpi=dpi)
    except (OSError, ValueError) as error:
        raise BadInput(f"cannot write {output}: {getattr(error, 'strerror', None) or error}") from None
