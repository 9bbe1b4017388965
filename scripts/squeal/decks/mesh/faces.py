"""Faces of cells: those that belong to one cell only, and those with given corners or nodes."""

import numpy

MIX = numpy.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x27D4EB2F165667C5], numpy.uint64)


def keys_of(corners):
    """A number of 64 bits for the corners [n][3 or 4] of faces, the same in any order."""
    rows = numpy.sort(corners, axis=1).astype(numpy.uint64)
    key = numpy.full(len(rows), rows.shape[1], numpy.uint64)
    with numpy.errstate(over="ignore"):
        for column in range(rows.shape[1]):
            key = (key ^ (rows[:, column] + MIX[column])) * MIX[column]
            key ^= key >> numpy.uint64(29)
    return key


def all_faces(deck):
    """Keys of the faces of all cells, and (cell, face) of each."""
    keys, faces = [], []
    for first, block in zip(deck.firsts(), deck.blocks):
        cells = numpy.arange(first, first + len(block.ids))
        for number, nodes in enumerate(block.shape.faces()):
            n = 3 if len(nodes) in (3, 6) else 4
            keys.append(keys_of(block.nodes[:, nodes[:n]]))
            faces.append(numpy.stack([cells, numpy.full(len(cells), number)], axis=1))
    return numpy.concatenate(keys), numpy.concatenate(faces)


def boundary_faces(deck, members=None):
    """Faces (cell, face) of one cell only; those whose nodes are all among `members`, where these are given."""
    if not deck.n_cells:
        return numpy.empty((0, 2), int)
    if getattr(deck, "outer", None) is None or deck.outer[0] != deck.n_cells:
        keys, faces = all_faces(deck)
        order = numpy.argsort(keys, kind="stable")
        same = keys[order][1:] == keys[order][:-1]
        alone = numpy.concatenate([[True], ~same]) & numpy.concatenate([~same, [True]])
        deck.outer = deck.n_cells, faces[numpy.sort(order[alone])]
    faces = deck.outer[1]
    if members is None:
        return faces
    inside = numpy.zeros(deck.n_nodes, bool)
    inside[members] = True
    kept = numpy.zeros(len(faces), bool)
    for rows, nodes in nodes_by_kind(deck, faces):
        kept[rows] = inside[nodes].all(axis=1)
    return faces[kept]


def nodes_by_kind(deck, faces):
    """For faces (cell, face) of each shape and number: which rows these are, and their nodes in Gmsh's order."""
    firsts = deck.firsts()
    for low, high, block in zip(firsts, firsts[1:], deck.blocks):
        rows = numpy.flatnonzero((faces[:, 0] >= low) & (faces[:, 0] < high))
        for number, local in enumerate(block.shape.faces() if len(rows) else ()):
            chosen = rows[faces[rows, 1] == number]
            if len(chosen):
                yield chosen, block.nodes[faces[chosen, 0] - low][:, local]


def surface_nodes(deck, faces):
    """All nodes of faces."""
    parts = [nodes.ravel() for _, nodes in nodes_by_kind(deck, faces)]
    return numpy.unique(numpy.concatenate(parts or [numpy.empty(0, int)]))


def faces_by_three(deck, three):
    """Faces (cell, face) with these three corners [n][3] among theirs, and which are none of a cell; of two cells that share
    one, the first."""
    if not deck.n_cells:
        return numpy.zeros((len(three), 2), int), numpy.ones(len(three), bool)
    keys, faces = [], []
    for first, block in zip(deck.firsts(), deck.blocks):
        cells = numpy.arange(first, first + len(block.ids))
        for number, nodes in enumerate(block.shape.faces()):
            n = 3 if len(nodes) in (3, 6) else 4
            for left_out in range(n if n == 4 else 1):
                kept = [nodes[k] for k in range(n) if n == 3 or k != left_out]
                keys.append(keys_of(block.nodes[:, kept]))
                faces.append(numpy.stack([cells, numpy.full(len(cells), number)], axis=1))
    keys, faces = numpy.concatenate(keys), numpy.concatenate(faces)
    order = numpy.argsort(keys, kind="stable")
    wanted = keys_of(three)
    at = numpy.minimum(numpy.searchsorted(keys[order], wanted), len(keys) - 1)
    return faces[order[at]], keys[order[at]] != wanted


def cell_middles(deck, cells):
    """Middles of cells."""
    found = numpy.zeros((len(cells), 3))
    for low, high, block in zip(deck.firsts(), deck.firsts()[1:], deck.blocks):
        inside = (cells >= low) & (cells < high)
        found[inside] = deck.x[block.nodes[cells[inside] - low]].mean(axis=1)
    return found
