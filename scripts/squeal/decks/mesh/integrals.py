"""Integrals over elements and faces: volume and first moment, the vector of an area and its moment. Shape functions are the
polynomials of a space that are 1 at one node and 0 at the others; integration by Gauss' points is exact for elements of
straight and of curved edges, since places are polynomials; Q, with the points of V, is exact for parallelepipeds and their like:

  V = int det J,   S = int x det J,   Q = int x x' det J,   A = int x_r x x_s,   M = int x x (x_r x x_s)
"""

import functools
import itertools

import numpy

from .elements import AROUND_SHELL, EDGES, FACES, HEX27_FACES, SHAPES

CHUNK = 100000  # elements at a time
CORNERS = {"tet": ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
           "wedge": tuple((r, s, z) for z in (-1, 1) for r, s in ((0, 0), (1, 0), (0, 1))),
           "hex": tuple((x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))),
           "triangle": ((0, 0), (1, 0), (0, 1)), "quad": ((-1, -1), (1, -1), (1, 1), (-1, 1))}


def nodes_of(shape):
    """Natural coordinates of the nodes of an element, in its own order."""
    corners = numpy.array(CORNERS[shape.family], float)
    places = [corners]
    if shape.second:
        places.append(numpy.array([corners[list(edge)].mean(axis=0) for edge in EDGES[shape.family]]))
    if shape.n_nodes == 27:
        places.append(numpy.array([corners[list(FACES["hex"][face])].mean(axis=0) for face in HEX27_FACES]))
        places.append(numpy.zeros((1, 3)))
    return numpy.concatenate(places)


def nodes_of_face(n):
    """The same of a face with n nodes: corners, middles, centre."""
    family = "triangle" if n in (3, 6) else "quad"
    corners = numpy.array(CORNERS[family], float)
    places = [corners]
    if n > 4:
        places.append(numpy.array([corners[list(edge)].mean(axis=0) for edge in AROUND_SHELL[len(corners)]]))
    if n == 9:
        places.append(numpy.zeros((1, 2)))
    return numpy.concatenate(places)


def powers(family, n):
    """Exponents of the monomials that span the shape functions of n nodes."""
    dimension = 2 if family in ("triangle", "quad") else 3
    high = 2 if n in (6, 8, 9, 10, 15, 20, 27) and (family, n) not in (("wedge", 6), ("hex", 8)) else 1
    rows = itertools.product(range(high + 1), repeat=dimension)
    if family in ("tet", "triangle"):
        return [row for row in rows if sum(row) <= high]
    if family == "wedge":
        return [row for row in rows if row[0] + row[1] <= high and (high == 1 or row[2] < 2 or row[0] + row[1] <= 1)]
    return list(rows) if n in (9, 27) else [row for row in rows if row.count(2) <= 1]


def monomials(places, rows):
    """Values [p][k], and slopes [p][k][d] at places [p][d]."""
    rows = numpy.array(rows)
    values = numpy.prod(places[:, None, :] ** rows, axis=2)
    slopes = numpy.empty((*values.shape, places.shape[1]))
    for d in range(places.shape[1]):
        less = rows.copy()
        less[:, d] = numpy.maximum(rows[:, d] - 1, 0)
        slopes[:, :, d] = rows[:, d] * numpy.prod(places[:, None, :] ** less, axis=2)
    return values, slopes


def points(family, n):
    """Gauss' points [p][d] and weights [p], n along each direction; triangles and tetrahedra are squares and cubes with an
    edge that became a point."""
    at, weight = numpy.polynomial.legendre.leggauss(n)
    half, half_weight = (at + 1) / 2, weight / 2
    found = []
    for ijk in itertools.product(range(n), repeat=2 if family in ("triangle", "quad") else 3):
        u, w = half[list(ijk)], half_weight[list(ijk)]
        if family in ("triangle", "wedge"):
            place, scale = [u[0], u[1] * (1 - u[0])], w[0] * w[1] * (1 - u[0])
            if family == "wedge":
                place, scale = [*place, at[ijk[2]]], scale * weight[ijk[2]]
        elif family == "tet":
            place = [u[0], u[1] * (1 - u[0]), u[2] * (1 - u[0]) * (1 - u[1])]
            scale = w.prod() * (1 - u[0])**2 * (1 - u[1])
        else:
            place, scale = at[list(ijk)], weight[list(ijk)].prod()
        found.append((*place, scale))
    found = numpy.array(found)
    return found[:, :-1], found[:, -1]


@functools.cache
def rule(family, n_nodes, n_points):
    """Shape functions [p][n], slopes [p][n][d] and weights [p]."""
    local = nodes_of_face(n_nodes) if family in ("triangle", "quad") else nodes_of(next(
        shape for shape in SHAPES.values() if (shape.family, shape.n_nodes) == (family, n_nodes)))
    rows = powers(family, n_nodes)
    places, weights = points(family, n_points)
    inverse = numpy.linalg.inv(monomials(local, rows)[0])
    values, slopes = monomials(places, rows)
    return values @ inverse, numpy.einsum("pkd,kn->pnd", slopes, inverse), weights


def straight(shape, x):
    """Whether nodes in the middle of edges, faces and of the element are there, to rounding, of each element x [e][n][3]."""
    corners = len(CORNERS[shape.family])
    apart = abs(x[:, corners:] - rule_at_nodes(shape) @ x[:, :corners])
    return apart.max(axis=(1, 2), initial=0) <= 1e-13 * abs(x).max(initial=0)


@functools.cache
def rule_at_nodes(shape):
    """Functions of the corners alone at the other nodes."""
    n = len(CORNERS[shape.family])
    rows = powers(shape.family, n)
    inverse = numpy.linalg.inv(monomials(numpy.array(CORNERS[shape.family], float), rows)[0])
    return monomials(nodes_of(shape)[n:], rows)[0] @ inverse


def volumes(shape, x):
    """Volume [e], first moment [e][3] and second moments xx, yy, zz, xy, xz, yz [e][6] of elements with nodes x [e][n][3], for a mirrored
    one positive too."""
    volume, moment, second = numpy.zeros(len(x)), numpy.zeros((len(x), 3)), numpy.zeros((len(x), 6))
    for first in range(0, len(x), CHUNK):
        part = x[first:first + CHUNK]
        plain, corners = straight(shape, part), len(CORNERS[shape.family])
        for chosen, n, n_points in ((plain, corners, 2), (~plain, shape.n_nodes, 4)):
            if chosen.any() and chosen is plain and corners == 4:
                rows = first + numpy.flatnonzero(plain)
                volume[rows], moment[rows], second[rows] = tetrahedra(part[plain, :4])
            elif chosen.any():
                rows = first + numpy.flatnonzero(chosen)
                volume[rows], moment[rows], second[rows] = volumes_of_some(rule(shape.family, n, n_points), part[chosen, :n])
    return volume, moment, second


def tetrahedra(x):
    """The same of straight ones: V (sum x_i x_i' + s s') / 20 with s = sum x_i."""
    total = x.sum(axis=1)
    edge = x[:, 1:] - x[:, :1]
    volume = abs(numpy.einsum("ei,ei->e", edge[:, 0], numpy.cross(edge[:, 1], edge[:, 2]))) / 6
    second = [(x[:, :, i] * x[:, :, j]).sum(axis=1) + total[:, i] * total[:, j] for i, j in zip((0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2))]
    return volume, volume[:, None] * total / 4, volume[:, None] * numpy.stack(second, axis=1) / 20


def volumes_of_some(points_of, x):
    """The same by a rule."""
    volume, moment, second = numpy.zeros(len(x)), numpy.zeros((len(x), 3)), numpy.zeros((len(x), 6))
    n, x = len(x), numpy.ascontiguousarray(x.transpose(2, 0, 1)).reshape(-1, x.shape[1])  # rows of each coordinate
    for value, slope, weight in zip(*points_of):
        a, b, c = numpy.ascontiguousarray((x @ slope).T).reshape(3, 3, n)
        det = weight * (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
        volume += det
        at = (x @ value).reshape(3, n)
        part = det * at
        moment += part.T
        second += numpy.concatenate([part * at, [part[0] * at[1], part[0] * at[2], part[1] * at[2]]]).T
    sign = numpy.where(volume < 0, -1.0, 1.0)
    return sign * volume, sign[:, None] * moment, sign[:, None] * second


def areas(x):
    """Vector of the area [f][3] and its moment about the origin [f][3] of faces with nodes x [f][n][3]."""
    family = "triangle" if x.shape[1] in (3, 6) else "quad"
    values, slopes, weights = rule(family, x.shape[1], 4)
    j = numpy.einsum("pnd,fni->fpdi", slopes, x)
    normal = numpy.cross(j[:, :, 0], j[:, :, 1]) * weights[:, None]
    return normal.sum(axis=1), numpy.cross(numpy.einsum("pn,fni->fpi", values, x), normal).sum(axis=1)
