"""An element cut into k parts along each of its edges. Elements of Gmsh in their parameters, which go from 0 to 1: line x, quad x y,
hex x y z; tri, tet x y z >= 0 with sum <= 1; wedge a tri in x y, z.

A tetrahedron is cut as Freudenthal does: with b0 + ... + b3 = k of its corners and x1 = b1 + b2 + b3, x2 = b2 + b3, x3 = b3 it is
{0 <= x3 <= x2 <= x1 <= k}, and the paths along the edges of each unit cube in it make simplices, all of one volume. On a face
this is the cut by lines parallel to its sides, which does not depend on the order of its corners: neighbours fit."""

import functools
import itertools
from dataclasses import dataclass

import numpy

from ..decks.mesh.elements import GMSH_EDGES

CORNERS = {
    "point": numpy.zeros((1, 0), int), "line": numpy.array([[0], [1]]), "tri": numpy.array([[0, 0], [1, 0], [0, 1]]),
    "quad": numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]]),
    "tet": numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    "wedge": numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]),
    "hex": numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])}
# Corners that each further node is the middle of, in Gmsh's order
MIDDLES = GMSH_EDGES | {"line": "01", "tri": "01 12 20", "quad": "01 12 23 30 0123",
                        "hex": GMSH_EDGES["hex"] + " 0321 0154 0473 1265 2376 4567 01234567"}
# Gmsh's number -> family, nodes
KINDS = {15: ("point", 1), 1: ("line", 2), 8: ("line", 3), 2: ("tri", 3), 9: ("tri", 6), 3: ("quad", 4), 16: ("quad", 8),
         10: ("quad", 9), 4: ("tet", 4), 11: ("tet", 10), 6: ("wedge", 6), 18: ("wedge", 15), 5: ("hex", 8), 17: ("hex", 20),
         12: ("hex", 27)}


def powers(family, n_nodes):
    """Exponents [n_nodes][dimension] of the monomials of an element's shape functions."""
    dimension = CORNERS[family].shape[1]
    every = numpy.array(list(itertools.product(range(3), repeat=dimension))).reshape(-1, dimension)
    squared, total = (every == 2).sum(axis=1), every.sum(axis=1)
    first = squared == 0
    if family in ("tri", "tet"):
        kept = total <= (1 if n_nodes == dimension + 1 else 2)
    elif family == "wedge":
        plane = every[:, :2].sum(axis=1)
        kept = (plane <= 1) & (every[:, 2] <= 1) if n_nodes == 6 else (plane <= 2) & (plane + every[:, 2] <= 3)
    elif n_nodes == 2**dimension:
        kept = first
    else:
        kept = numpy.ones(len(every), bool) if n_nodes == 3**dimension else squared <= 1
    return every[kept]


def with_middles(family, n_nodes, corners):
    """All nodes [...][n_nodes][d] of elements with these corners [...][corner][d], twice as large, hence whole numbers."""
    groups = MIDDLES[family].split()[:n_nodes - len(CORNERS[family])]
    middles = [2 * corners[..., [int(c) for c in group], :].sum(axis=-2) // len(group) for group in groups]
    return numpy.concatenate([2 * corners, numpy.stack(middles, axis=-2)], axis=-2) if middles else 2 * corners


def simplices(dimension, k):
    """Corners [n][dimension + 1][dimension] of the parts of a simplex of side k, all the right way round."""
    found = []
    for base in itertools.product(range(k), repeat=dimension):
        for order in itertools.permutations(range(dimension)):
            path = numpy.array(base) + numpy.vstack([numpy.zeros(dimension, int),
                                                     numpy.cumsum(numpy.eye(dimension, dtype=int)[list(order)], axis=0)])
            if (numpy.diff(path, axis=1) <= 0).all():
                inverted = numpy.linalg.det(numpy.eye(dimension)[list(order)]) < 0
                corners = path - numpy.hstack([path[:, 1:], numpy.zeros((dimension + 1, 1), int)])
                found.append(corners[[0, 1, 3, 2] if dimension == 3 else [0, 2, 1]] if inverted else corners)
    return numpy.array(found)


def child_corners(family, k):
    """Corners [n][corner][d] of the parts of an element of side k."""
    dimension = CORNERS[family].shape[1]
    if family in ("tri", "tet"):
        return simplices(dimension, k)
    if family == "wedge":
        layers = [numpy.dstack([numpy.hstack([tri, tri]), numpy.full((len(tri), 6), z) + [0, 0, 0, 1, 1, 1]])
                  for tri in [simplices(2, k)] for z in range(k)]
        return numpy.concatenate(layers)
    bases = numpy.array(list(itertools.product(range(k), repeat=dimension))).reshape(-1, 1, dimension)
    return bases + CORNERS[family]


@dataclass(frozen=True)
class Cut:
    """An element cut: `shape` [point][node] shape functions of the whole at all places of nodes of parts, `weight`
    [point][corner] of its corners in these places, in whole numbers of one sum for all elements, `parts` [part][node] their
    points, `old` [node] the points that are nodes of the whole (-1: none)."""
    shape: numpy.ndarray
    weight: numpy.ndarray
    parts: numpy.ndarray
    old: numpy.ndarray


def corner_weights(family, at, side):
    """Weights [point][corner] of places from 0 to `side`; their sum is side^3."""
    if family in ("tri", "tet"):
        return side**2 * numpy.hstack([side - at.sum(axis=1, keepdims=True), at])
    if family == "wedge":
        flat = numpy.hstack([side - at[:, :2].sum(axis=1, keepdims=True), at[:, :2]])
        return side * numpy.hstack([flat * (side - at[:, 2:]), flat * at[:, 2:]])
    corners = CORNERS[family]
    factors = numpy.where(corners[None] == 1, at[:, None], side - at[:, None])
    return side**(3 - corners.shape[1]) * factors.prod(axis=2)


@functools.cache
def cut(kind, k):
    """The cut of an element of Gmsh's number `kind` into k parts along each edge."""
    family, n_nodes = KINDS[kind]
    places = with_middles(family, n_nodes, child_corners(family, k))
    points, index = numpy.unique(places.reshape(-1, places.shape[2]), axis=0, return_inverse=True)
    own = k * with_middles(family, n_nodes, CORNERS[family])
    old = [next(iter(numpy.flatnonzero((points == node).all(axis=1))), -1) for node in own]
    exponents = powers(family, n_nodes)
    monomials = [numpy.prod((at[:, None] / (2 * k))**exponents, axis=2) for at in (points, own)]
    shape = numpy.linalg.solve(monomials[1].T, monomials[0].T).T
    return Cut(shape, corner_weights(family, points, 2 * k), index.reshape(places.shape[:2]), numpy.array(old))
