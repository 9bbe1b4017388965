"""Options that scripts/correlate and scripts/update share: the axes of a test, and which modes are pairs."""

import argparse
import math

import numpy

from .measured import UNITS


def numbers(text, n):
    """So many numbers with commas between."""
    try:
        found = [float(word) for word in text.split(",")]
    except ValueError:
        found = []
    if len(found) != n or not all(map(math.isfinite, found)):
        raise argparse.ArgumentTypeError(f"{text}: must be {f'{n} numbers with commas between' if n > 1 else 'a number'}")
    return numpy.array(found)


def point(text):
    """NAME=x,y,z."""
    name, _, place = text.partition("=")
    return name, numbers(place, 3)


def above_zero(text, scale=1.0):
    """A number above 0."""
    number = numbers(text, 1)[0]
    if not number > 0:
        raise argparse.ArgumentTypeError(f"{text}: must be above 0")
    return scale * number


def share(text):
    """A number from 0 to 1."""
    number = numbers(text, 1)[0]
    if not 0 <= number <= 1:
        raise argparse.ArgumentTypeError(f"{text}: must be from 0 to 1")
    return number


class Points(argparse.Action):
    """A dictionary of NAME=x,y,z."""

    def __call__(self, parser, namespace, values, option_string=None):
        if len(dict(values)) < len(values):
            parser.error("--points: a name stands twice")
        setattr(namespace, self.dest, dict(values))


def add_axes(parser):
    """Adds them."""
    parser.add_argument("--units", choices=UNITS, help="length of the test; default: as dataset 164 says, else m")
    axes = parser.add_mutually_exclusive_group()
    axes.add_argument("--transform", type=lambda text: numbers(text, 6), metavar="X,Y,Z,A,B,C",
                      help="turn the test by A, B, C degrees about x, y, z of the mesh, one after the other, then move it by X, Y, Z m")
    axes.add_argument("--points", type=point, nargs="+", action=Points, metavar="NAME=X,Y,Z", help="places of points of the test in the "
                      "mesh, m")
    parser.add_argument("--tolerance", type=lambda text: above_zero(text, 1e-3), metavar="MM",
                        help="largest distance of a sensor from the mesh, mm; default: 2 %% of its extent")
    parser.add_argument("--parts", type=lambda text: text.split(","), default=[], metavar="NAMES",
                        help="parts that carry sensors; default: all")
    parser.add_argument("--near", type=lambda text: above_zero(text, 1e-2), default=0.2, metavar="PERCENT",
                        help="largest difference of frequency in a pair; default: 20")
    parser.add_argument("--least", type=share, default=0.5, metavar="MAC", help="least MAC, with its group, of a pair; default: 0.5")
    parser.add_argument("--group", type=lambda text: above_zero(text, 1e-2), default=0.01, metavar="PERCENT",
                        help="modes closer than this are compared as a group too, as their shapes may be turned; default: 1")
    parser.add_argument("--alike", type=share, default=0.7, metavar="MAC", help="auto-MAC of modes from which on it is said; default: 0.7")
