"""Nastran: coordinate systems, and the places of grid points in them. A system may be given in another (CORD2.) or by three
grid points (CORD1.), which are in others again."""

import numpy

from .cards import named

KNOWN = {f"CORD{n}{kind}" for n in (1, 2) for kind in "RCS"}


class System:
    """Axes in rows, origin, and its kind: R rectangular, C cylindrical, S spherical."""

    def __init__(self, axes, origin, kind):
        self.axes, self.origin, self.kind = axes, origin, kind

    def places(self, x):
        """Places in space of coordinates [n][3] in this system; angles in degrees."""
        if self.kind == "C":
            angle = numpy.radians(x[:, 1])
            x = numpy.stack([x[:, 0] * numpy.cos(angle), x[:, 0] * numpy.sin(angle), x[:, 2]], axis=1)
        elif self.kind == "S":  # radius, angle from z, angle about z
            theta, phi = numpy.radians(x[:, 1]), numpy.radians(x[:, 2])
            around = x[:, 0] * numpy.sin(theta)
            x = numpy.stack([around * numpy.cos(phi), around * numpy.sin(phi), x[:, 0] * numpy.cos(theta)], axis=1)
        return x @ self.axes + self.origin

    def directions(self, place):
        """Axes [3][3] in rows of components at a place in space."""
        if self.kind == "R":
            return self.axes
        x = self.axes @ (place - self.origin)
        around = numpy.hypot(x[0], x[1])
        c, s = (x[0] / around, x[1] / around) if around > 0 else (1.0, 0.0)
        local = numpy.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        if self.kind == "S":
            radius = numpy.linalg.norm(x)
            cz, sz = (x[2] / radius, around / radius) if radius > 0 else (1.0, 0.0)
            local = numpy.array([[sz * c, sz * s, cz], [cz * c, cz * s, -sz], [-s, c, 0]])
        return local @ self.axes


SPACE = System(numpy.eye(3), numpy.zeros(3), "R")


def by_points(a, b, c, kind, place, name):
    """The system with its origin in a, b on the third axis, c in the half plane of the first."""
    third = b - a
    second = numpy.cross(third, c - a)
    if not numpy.linalg.norm(second) > 1e-12 * numpy.linalg.norm(third) * numpy.linalg.norm(c - a):
        raise place.wrong(f"{name}: the three points are on a line")
    third, second = third / numpy.linalg.norm(third), second / numpy.linalg.norm(second)
    return System(numpy.array([numpy.cross(second, third), second, third]), a, kind)


def definitions(tables):
    """Number of a system -> (kind, place, system it is given in or None, points [3][3] or three grid points)."""
    found = {}

    def add(number, what, table, row):
        if number in found and str(found[number][2:]) != str(what):
            raise table.place(row).wrong(f"coordinate system {number} stands twice")
        found[number] = (table.name, table.place(row), *what)

    for table in named(tables, "CORD2R", "CORD2C", "CORD2S"):
        for row in range(len(table)):
            number, base = table.whole(0, 2)[row].tolist()
            if table.width < 11 or number < 1:
                raise table.place(row).wrong(f"{table.name}: " + ("the line with the third point is missing" if number > 0
                                                                   else f"the number {number} is not positive"))
            add(number, (base, table.real(2, 11)[row].reshape(3, 3)), table, row)
    for table in named(tables, "CORD1R", "CORD1C", "CORD1S"):
        for row in range(len(table)):
            for number, *points in table.whole(0, 8)[row].reshape(2, 4).tolist():
                if number:
                    add(number, (None, points), table, row)
    return found


def solve_systems(mesh, tables, grid):
    """Systems by number, and places of all grid points: `grid` has numbers, systems, coordinates [n][3]. What waits for another
    that is not known stays away; grid points of such a system are the error of the caller."""
    waiting, known = definitions(tables), numpy.zeros(len(grid.ids), bool)
    x, order = grid.x.copy(), numpy.argsort(grid.ids, kind="stable")
    fresh = [0]
    while fresh:
        for number in fresh:
            rows = numpy.flatnonzero(grid.systems == number)
            known[rows] = True
            x[rows] = mesh.systems[number].places(x[rows]) if number else x[rows]
        fresh = []
        for number, (name, place, base, points) in list(waiting.items()):
            if base is None:
                at = order[numpy.minimum(numpy.searchsorted(grid.ids[order], points), len(order) - 1)]
                three = x[at] if (grid.ids[at] == points).all() and known[at].all() else None
            else:
                three = mesh.systems[base].places(points) if base in mesh.systems else None
            if three is not None:
                mesh.systems[number] = by_points(*three, name[-1], place, name)
                fresh.append(number)
                del waiting[number]
    return x, known, waiting
