"""Gaps of a contact as the deck has it: how far nodes of the slave lie from the master below them, negative inside of it."""

import numpy

from .mesh.faces import cell_middles, nodes_by_kind, surface_nodes

NEAREST = 16  # triangles whose middles are nearest to a node, among which its foot is looked for
UPRIGHT = 1e-2  # sine of the angle to the normal above which a foot is beyond an edge of the master


def triangles(deck, faces):
    """Places [t][3][3] of flat triangles of faces, those of second order in pieces, and the middles [t][3] of their cells."""
    found, of_cells = [numpy.empty((0, 3, 3))], [numpy.empty((0, 3))]
    for rows, nodes in nodes_by_kind(deck, faces):
        middle = cell_middles(deck, faces[rows, 0])
        n = 3 if nodes.shape[1] in (3, 6) else 4
        ring = list(range(n)) if nodes.shape[1] == n else [k for i in range(n) for k in (i, n + i)]
        centre = deck.x[nodes].mean(axis=1) if nodes.shape[1] in (3, 4) else deck.x[nodes[:, n:2 * n]].mean(axis=1)
        if nodes.shape[1] == 3:
            found.append(deck.x[nodes])
            of_cells.append(middle)
            continue
        for a, b in zip(ring, ring[1:] + ring[:1]):
            found.append(numpy.stack([deck.x[nodes[:, a]], deck.x[nodes[:, b]], centre], axis=1))
            of_cells.append(middle)
    return numpy.concatenate(found), numpy.concatenate(of_cells)


def nearest(points, corners):
    """The nearest point of triangles [n][3][3] to points [n][3]: inside, or on an edge."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = numpy.cross(b - a, c - a)
    size = numpy.einsum("ni,ni->n", normal, normal)
    size[size == 0] = 1
    inside = points - (numpy.einsum("ni,ni->n", points - a, normal) / size)[:, None] * normal
    best, within = inside, numpy.ones(len(points), bool)
    for start, end in ((a, b), (b, c), (c, a)):
        within &= numpy.einsum("ni,ni->n", numpy.cross(end - start, inside - start), normal) >= 0
    far = numpy.where(within, numpy.linalg.norm(points - inside, axis=1), numpy.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        length = numpy.einsum("ni,ni->n", edge, edge)
        along = numpy.clip(numpy.einsum("ni,ni->n", points - start, edge) / numpy.where(length > 0, length, 1), 0, 1)
        foot = start + along[:, None] * edge
        distance = numpy.linalg.norm(points - foot, axis=1)
        nearer = distance < far
        best, far = numpy.where(nearer[:, None], foot, best), numpy.where(nearer, distance, far)
    return best, far, normal / numpy.sqrt(size)[:, None]


def gaps(deck, slave, master):
    """Distance to the master of each node of the slave that has its foot on it, in the units of the deck, negative inside."""
    from scipy.spatial import cKDTree
    points, (corners, middle) = deck.x[surface_nodes(deck, slave)], triangles(deck, master)
    if not len(points) or not len(corners):
        return numpy.empty(0)
    count = min(NEAREST, len(corners))
    _, near = cKDTree(corners.mean(axis=1)).query(points, k=count)
    near = near.reshape(len(points), count)
    foot, far, normal = nearest(numpy.repeat(points, count, axis=0), corners[near.ravel()])
    row = numpy.arange(len(points)) * count + far.reshape(len(points), count).argmin(axis=1)
    along = numpy.einsum("ni,ni->n", points - foot[row], normal[row])
    beyond = numpy.sqrt(numpy.maximum(far[row]**2 - along**2, 0))
    inward = numpy.einsum("ni,ni->n", middle[near.ravel()[row]] - foot[row], normal[row])
    return (-numpy.sign(along * inward) * far[row])[beyond <= UPRIGHT * far[row] + 1e-12 * abs(points).max()]
