"""How a quantity on a set is spread over its nodes, as squeal does it (src/model/scene/spread.c): by the area of faces, by the
length of edges, or evenly. Faces are in Gmsh's order: corners, middles after each of them, the centre."""

import numpy

GAUSS = numpy.sqrt(0.6)
LINE = ((-GAUSS, 5 / 9), (0.0, 8 / 9), (GAUSS, 5 / 9))
CORNERS = numpy.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)


def square_points(n_nodes):
    """Places and weights of a rule of 2 x 2 or 3 x 3 points."""
    rule = [(s * 3**-0.5, 1.0) for s in (-1, 1)] if n_nodes == 4 else LINE
    return [((x, y), v * w) for y, w in rule for x, v in rule]


def triangle_points(n_nodes):
    """The middle, or Radon's rule of degree 5."""
    if n_nodes == 3:
        return [((1 / 3, 1 / 3), 0.5)]
    root = 15**0.5
    found = [((1 / 3, 1 / 3), 9 / 80)]
    for a, w in (((6 - root) / 21, (155 - root) / 2400), ((6 + root) / 21, (155 + root) / 2400)):
        found += [((a, a), w), ((1 - 2 * a, a), w), ((a, 1 - 2 * a), w)]
    return found


def triangle(n_nodes, x, y):
    """Shape functions and their two derivatives [3][nodes]."""
    l, dl = numpy.array([1 - x - y, x, y]), numpy.array([[-1, 1, 0], [-1, 0, 1]], float)
    if n_nodes == 3:
        return numpy.vstack([l, dl])
    sides = (0, 1), (1, 2), (2, 0)
    values = [*(l * (2 * l - 1)), *(4 * l[a] * l[b] for a, b in sides)]
    slopes = [[*(d * (4 * l - 1)), *(4 * (d[a] * l[b] + l[a] * d[b]) for a, b in sides)] for d in dl]
    return numpy.array([values, *slopes])


def square(n_nodes, x, y):
    """The same of squares: products of polynomials along the sides, or serendipity."""
    if n_nodes == 9:
        def along(t):
            return numpy.array([t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2]), numpy.array([t - 0.5, -2 * t, t + 0.5])
        (u, du), (v, dv) = along(x), along(y)
        at = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
        return numpy.array([[f[i] * g[j] for i, j in at] for f, g in ((u, v), (du, v), (u, dv))])
    a, b = CORNERS.T
    p, q = 1 + a * x, 1 + b * y
    if n_nodes == 4:
        return numpy.array([p * q, a * q, b * p]) / 4
    corners = numpy.array([p * q * (a * x + b * y - 1), a * q * (2 * a * x + b * y), b * p * (a * x + 2 * b * y)]) / 4
    middles = numpy.array([[(1 - x * x) * (1 - y), (1 + x) * (1 - y * y), (1 - x * x) * (1 + y), (1 - x) * (1 - y * y)],
                           [-2 * x * (1 - y), 1 - y * y, -2 * x * (1 + y), -(1 - y * y)],
                           [-(1 - x * x), -2 * y * (1 + x), 1 - x * x, -2 * y * (1 - x)]]) / 2
    return numpy.hstack([corners, middles])


def face_shares(x, positive):
    """Shares [n][nodes] of faces x [n][nodes][3] in their areas; positive ones, or the integrals of the shape functions."""
    n_nodes = x.shape[1]
    shape, rule = (triangle, triangle_points) if n_nodes in (3, 6) else (square, square_points)
    shares, squares = numpy.zeros(x.shape[:2]), numpy.zeros(x.shape[:2])
    for place, weight in rule(n_nodes):
        values, *slopes = shape(n_nodes, *place)
        first, second = (numpy.einsum("i,nid->nd", slope, x) for slope in slopes)
        area = weight * numpy.linalg.norm(numpy.cross(first, second), axis=1)[:, None]
        shares += area * values
        squares += area * values**2
    if positive and n_nodes in (6, 8, 9):
        return squares * (shares.sum(axis=1) / squares.sum(axis=1))[:, None]
    return shares


def edge_shares(x):
    """Shares of edges x [n][2 or 3][3] in their lengths."""
    if x.shape[1] == 2:
        return numpy.repeat(numpy.linalg.norm(x[:, 1] - x[:, 0], axis=1)[:, None] / 2, 2, axis=1)
    length = numpy.linalg.norm(x[:, 2] - x[:, 0], axis=1) + numpy.linalg.norm(x[:, 2] - x[:, 1], axis=1)
    return length[:, None] * numpy.array([1, 1, 4]) / 6


def set_shares(x, faces, edges, positive):
    """Nodes of a set and their shares in its area, or length; None where it has neither faces nor edges."""
    total = numpy.zeros(len(x))
    for nodes in faces or edges:
        shares = face_shares(x[nodes], positive) if faces else edge_shares(x[nodes])
        numpy.add.at(total, nodes, shares)
    if not faces and not edges:
        return None
    nodes = numpy.unique(numpy.concatenate([nodes.ravel() for nodes in faces or edges]))
    return nodes, total[nodes]
