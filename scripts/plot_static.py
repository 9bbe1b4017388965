#!/usr/bin/python3
"""Draws the sliding state that squeal computed: pressure and status of the pairs in contact.

Left, seen in the plane of the pairs: the pressure (or, where static.csv does not have it, the normal force per pair) on
the area of each pair; open pairs are empty circles, sliding ones dots, sticking ones squares. The cross is the centre
of the normal forces, the thin lines meet in the middle of the surface, and the arrow is the direction in which the
slave slides, so that its head points at the leading edge. Beside or below it, the mean pressure of each row along the
sliding direction; rows with open pairs are named. One such picture per interface.

Reads static.csv.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
import squeal_tables as tables
from static_map import SOFT, draw_centre, draw_direction, draw_pressure, draw_profile, legend_handles
from static_pairs import read_surfaces

DPI = 150
FONTS = {"font.size": 11, "axes.titlesize": 13, "axes.labelsize": 12, "legend.fontsize": 10.5, "figure.dpi": DPI}
WIDTH, LONGEST, PROFILE = 12.0, 5.6, 2.6  # inches: the picture, the height of a map, that of a profile below a map
LEFT, RIGHT, TOP, BOTTOM, BAR, BETWEEN = 0.85, 0.35, 1.0, 1.15, 0.16, 0.95  # inches; RIGHT is without a colour bar


class Layout:
    """Places of map, colour bar and profile of a surface, inches above its lower left corner: [left, bottom, width,
    height]. The profile stands beside the map, or below it where it runs to the right."""

    def __init__(self, surface):
        width, height = numpy.subtract(*reversed(surface.limits()))
        beside = surface.profile_axis == 1
        room = (0.52 if beside else 1) * WIDTH - LEFT - RIGHT - (0 if beside else BETWEEN)
        scale = min(room / width, LONGEST / height)
        width, height = scale * width, scale * height
        foot = BOTTOM if beside else BOTTOM + PROFILE + 0.75
        right = LEFT + width
        self.map = [LEFT, foot, width, height]
        self.bar = [right + 0.12, foot, BAR, height]
        start = right + 0.12 + BAR + BETWEEN + 0.75
        self.profile = [start, foot, WIDTH - start - RIGHT, height] if beside else [LEFT, BOTTOM, width, PROFILE]
        self.height = foot + height + TOP


def add_axes(figure, place, below, **style):
    """Axes at a place in inches."""
    left, bottom, width, height = place
    total = figure.get_figheight()
    return figure.add_axes([left / WIDTH, (below + bottom) / total, width / WIDTH, height / total], **style)


def draw_surface(figure, surface, layout, below):
    """One interface, `below` inches above the lower edge of the picture."""
    axes = add_axes(figure, layout.map, below)
    colours = draw_pressure(axes, surface)
    draw_centre(axes, surface)
    draw_direction(axes, surface)
    axes.set_xlabel(surface.axis_title(0))
    axes.set_ylabel(surface.axis_title(1))
    bar = figure.colorbar(colours, cax=add_axes(figure, layout.bar, below))
    bar.set_label(f"{surface.quantity}, {surface.unit}")
    bar.outline.set_visible(False)
    along = surface.profile_axis
    beside = add_axes(figure, layout.profile, below, **({"sharey": axes} if along == 1 else {"sharex": axes}))
    draw_profile(beside, surface)
    (beside.set_ylabel if along == 1 else beside.set_xlabel)(surface.axis_title(along))
    top = (below + layout.height) / figure.get_figheight()
    figure.text(LEFT / WIDTH, top - 0.34 / figure.get_figheight(), weight="bold", fontsize=14,
                s=f"Sliding state: {surface.name}" if surface.name else "Sliding state", va="center")
    figure.text(LEFT / WIDTH, top - 0.67 / figure.get_figheight(), surface.summary(), color=SOFT, va="center")
    handles = legend_handles(surface)
    foot = (below + 0.15) / figure.get_figheight()
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(LEFT / WIDTH, foot), ncol=len(handles),
                  frameon=False, columnspacing=1.8, borderaxespad=0, borderpad=0)


def draw(folder, output):
    """Reads and draws; returns the picture's name."""
    surfaces = read_surfaces(folder / "static.csv")
    output = output or folder / "static.png"
    layouts = [Layout(surface) for surface in surfaces]
    below = sum(layout.height for layout in layouts)
    with plt.rc_context(FONTS):
        figure = plt.figure(figsize=(WIDTH, below))
        for surface, layout in zip(surfaces, layouts):
            below -= layout.height
            draw_surface(figure, surface, layout, below)
        tables.save_picture(figure, output)
    return output


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("results"),
                        help="folder that squeal wrote, default: results")
    parser.add_argument("-o", "--output", type=Path, help="picture to write, default: static.png in that folder")
    return parser.parse_args()


def main():
    """Draws; returns the exit status."""
    args = arguments()
    return tables.run("plot_static", lambda: draw(args.folder, args.output))


if __name__ == "__main__":
    sys.exit(main())
