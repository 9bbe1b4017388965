"""Coordinate systems of a universal file, datasets 18 and 2420: Cartesian (type 0) and cylindrical (1). A node of dataset 15 has its
place in one, its directions are those of another; places of dataset 2411 are those of space."""

import math

import numpy

from .universal import integers, reals, shown

CARTESIAN, CYLINDRICAL = 0, 1


class System:
    """Type, origin, and axes as rows."""

    def __init__(self, kind, origin, axes):
        self.kind, self.origin, self.axes = kind, origin, axes

    def place(self, local):
        """A place of space; the angle of a cylindrical system is in degrees."""
        if self.kind == CYLINDRICAL:
            angle = math.radians(local[1])
            local = local[0] * math.cos(angle), local[0] * math.sin(angle), local[2]
        return tuple((self.origin + numpy.array(local) @ self.axes).tolist())

    def directions(self, place):
        """The three directions at a place of space, as rows."""
        if self.kind == CARTESIAN:
            return self.axes
        across = self.axes[:2] @ (numpy.array(place) - self.origin)
        size = numpy.hypot(*across)
        cos, sin = across / size if size else (1.0, 0.0)
        return numpy.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]]) @ self.axes


def orthonormal(x, across):
    """Axes from the first and a vector in the plane of the first and the third."""
    x = x / numpy.linalg.norm(x)
    y = numpy.cross(across, x)
    y /= numpy.linalg.norm(y)
    return numpy.array([x, y, numpy.cross(x, y)])


def systems_18(reader, data):
    """A head, a name, and nine numbers in two lines: origin, a point of the x axis, a point of the x-z plane."""
    for k in range(0, len(data.lines), 4):
        head, found = integers(data.lines[k], 5), reals(b" ".join(data.lines[k + 2:k + 4]))
        if head is None or found is None or len(found) != 9:
            raise reader.wrong(data.line + k, f"{shown(data.lines[k])} is no coordinate system of dataset 18: five whole numbers, a "
                               f"name, nine "
                                              "numbers")
        origin, x, across = found[:3], found[3:6] - found[:3], found[6:] - found[:3]
        if not numpy.linalg.norm(numpy.cross(x, across)) > 0:
            raise reader.wrong(data.line + k + 2, "the three points of a coordinate system lie on a line")
        yield head[0], System(head[1], origin, orthonormal(x, across))


def systems_2420(reader, data):
    """A head and a name of the part, then six lines to a system: label and type, name, three axes, origin."""
    if len(data.lines) % 6 != 2:
        raise reader.wrong(data.line, f"dataset 2420 has {len(data.lines)} lines: two, and six to each coordinate system")
    for k in range(2, len(data.lines), 6):
        head, found = integers(data.lines[k], 3), [reals(line) for line in data.lines[k + 2:k + 6]]
        if head is None or any(row is None or len(row) != 3 for row in found):
            raise reader.wrong(data.line + k, f"{shown(data.lines[k])} is no coordinate system of dataset 2420")
        axes = numpy.array(found[:3])
        if not numpy.allclose(axes @ axes.T, numpy.eye(3), atol=1e-4):
            raise reader.wrong(data.line + k + 2, "the axes of a coordinate system must be of length 1 and at right angles")
        yield head[0], System(head[1], found[3], axes)
