"""Surfaces of bodies of any of VTK's cells: faces [n][4] of nodes, of a triangle with the last node twice. A face of
second order is drawn as the flat pieces between its nodes."""

import numpy

from ..tables import BadInput

# Faces of VTK's cells by their corners, anticlockwise seen from outside
TETRAHEDRON = ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1))
HEXAHEDRON = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
WEDGE = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
# Edges with a node in their middle, in the order of these nodes
TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
HEXAHEDRON_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
WEDGE_EDGES = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
# Type of VTK -> corners, faces, edges, whether faces have a middle node
CELLS = {10: (4, TETRAHEDRON, (), False), 24: (4, TETRAHEDRON, TETRAHEDRON_EDGES, False),
         12: (8, HEXAHEDRON, (), False), 25: (8, HEXAHEDRON, HEXAHEDRON_EDGES, False),
         29: (8, HEXAHEDRON, HEXAHEDRON_EDGES, True),
         13: (6, WEDGE, (), False), 26: (6, WEDGE, WEDGE_EDGES, False)}


def pieces(corners, middles, centre):
    """Flat pieces of a face, as rows of four local nodes: `middles` after each corner, none in a face of first order."""
    n = len(corners)
    if not middles:
        return [(*corners, *corners[n - 1:] * (4 - n))]
    if centre is not None:
        return [(corners[i], middles[i], centre, middles[i - 1]) for i in range(n)]
    inner = middles if n == 4 else (*middles, middles[2])
    return [(corners[i], middles[i], middles[i - 1], middles[i - 1]) for i in range(n)] + [inner]


def face_table(kind):
    """For each face of a type of cells: its corners, four of them, -1 for the fourth of a triangle, and its pieces."""
    n_corners, faces, edges, centred = CELLS[kind]
    middle = {frozenset(edge): n_corners + i for i, edge in enumerate(edges)}
    table = []
    for i, corners in enumerate(faces):
        around = [frozenset((a, b)) for a, b in zip(corners, corners[1:] + corners[:1])]
        middles = tuple(middle[edge] for edge in around) if edges else ()
        centre = n_corners + len(edges) + i if centred else None
        table.append(((*corners, -1)[:4], pieces(corners, middles, centre)))
    return table


def cell_faces(kind, cells):
    """Corners in rising order [n][4], and the pieces [n][m][4] of all faces of cells [...][nodes] of one type."""
    keys, parts = [], []
    padded = numpy.hstack([cells, numpy.full((len(cells), 1), -1)])
    for corners, table in face_table(kind):
        keys.append(numpy.sort(padded[:, corners], axis=1))
        parts.append(cells[:, table])
    return keys, parts


def boundary_faces(cells):
    """Faces [n][4], in flat pieces, that belong to one cell only; `cells`: type -> nodes [...][nodes]."""
    keys, owner, parts = [], [], []
    for kind, rows in cells.items():
        for key, part in zip(*cell_faces(kind, rows)):
            owner += [numpy.stack([numpy.full(len(key), len(parts)), numpy.arange(len(key))], axis=1)]
            keys.append(key)
            parts.append(part)
    if not parts:
        return numpy.empty((0, 4), int)
    keys, owner = numpy.concatenate(keys), numpy.concatenate(owner)
    _, first, count = numpy.unique(keys, axis=0, return_index=True, return_counts=True)
    kept = owner[numpy.sort(first[count == 1])]
    return numpy.concatenate([part[kept[kept[:, 0] == i, 1]].reshape(-1, 4) for i, part in enumerate(parts)])


def triangles_of(faces):
    """Triangles [n][3] of faces."""
    second = faces[faces[:, 2] != faces[:, 3]]
    return numpy.concatenate([faces[:, [0, 1, 2]], second[:, [0, 2, 3]]])


def read_cells(group):
    """For each type in a file of VTKHDF the numbers of its cells and their nodes [...][nodes]."""
    types, offsets = group["Types"][:], group["Offsets"][:]
    nodes = group["Connectivity"][:]
    unknown = set(numpy.unique(types)) - set(CELLS)
    if unknown == {1}:
        raise BadInput(f"{group.file.filename}: holds nodes of matrices, which have no faces; ParaView shows them as points")
    if unknown:
        raise BadInput(f"{group.file.filename}: cells of VTK's type {min(unknown)}; known are {sorted(CELLS)}")
    found = {}
    for kind in numpy.unique(types):
        number = numpy.flatnonzero(types == kind)
        width = offsets[number[0] + 1] - offsets[number[0]]
        found[int(kind)] = number, nodes[offsets[number][:, None] + numpy.arange(width)]
    return found
