"""Bodies and their shapes as the viewer of the page (viewer.js) reads them: surfaces in a frame of their own, x along
the circumference at the contact, y outward, z along the disc's axis towards the other parts, in half the largest
extent; displacements relative to the largest, as whole numbers of 16 bits."""

import base64
import json

import numpy

from ..mesh.bodies import Skin
from ..picture import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION
from .markup import Markup, tag

PAINT = "#9FB4C7", ORANGE, GREEN, PURPLE, SKY, VERMILION, GREY, BLUE  # of the parts, in turn
STILL = 1e-3  # of the largest displacement: imaginary parts below it are not kept
FULL = 32767


def packed(values, kind):
    """Numbers as text."""
    return base64.b64encode(numpy.ascontiguousarray(values, dtype=kind).tobytes()).decode()


class Bodies(Skin):
    """The surfaces of one file as the viewer needs them."""

    def packed(self):
        """What is the same for all shapes."""
        return {"points": packed(self.place, "<f4"), "quads": packed(self.quads, "<u4"),
                "edges": packed(self.edges, "<u4"), "counts": list(self.parts.values()), "parts": list(self.parts),
                "paint": [PAINT[i % len(PAINT)] for i in range(len(self.parts))]}

    def bytes_of_shape(self, is_complex):
        """Length of a shape in the page."""
        return (2 if is_complex else 1) * 8 * len(self.nodes)

    def packed_shape(self, shape):
        """Displacements [nodes][3] of the whole model, real or complex: the viewer shows Re(shape e^(i phase))."""
        moved = self.moved(shape)
        largest = numpy.sqrt((abs(moved)**2).sum(axis=1).max()) or 1.0
        re, im = (numpy.rint(FULL * part / largest) for part in (moved.real, moved.imag))
        return {"re": packed(re, "<i2"), "im": packed(im, "<i2") if abs(im).max() > STILL * FULL else None}


class Shape:
    """One state of the viewer: its number, its names, what it shows."""

    def __init__(self, number, title, detail, content):
        self.number, self.title, self.detail, self.content = number, title, detail, content

    def packed(self):
        return {"number": self.number, "title": self.title, "detail": self.detail, **self.content}


def data_script(name, bodies, shapes, **options):
    """The numbers, as a script that is data."""
    text = json.dumps({**bodies.packed(), "shapes": [shape.packed() for shape in shapes], **options})
    return tag("script", Markup(text.replace("<", "\\u003c")), type="application/json", id=f"{name}-data")


def viewer(name, source, about, still=False):
    """The place where the viewer draws what data_script() of that source holds; still: the bodies at rest."""
    canvas = tag("canvas", about, width="900", height="600", role="img", aria_label=about)
    return tag("div", tag("div", canvas, class_="stage"), class_="viewer", id=name, data_source=f"{source}-data",
               data_still=still)
