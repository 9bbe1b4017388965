"""Shapes of elements. The nodes of an element stand in the order of VTK and Abaqus: corners, then the middles of EDGES in
their order, then of hex27 the middles of the faces and the centre. Faces are those of Abaqus, S1 to S6."""

from dataclasses import dataclass

import numpy

EDGES = {"tet": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
         "wedge": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
         "hex": ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))}
FACES = {"tet": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
         "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
         "hex": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))}
AROUND_SHELL = {3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 3), (3, 0))}
# Other corners that make a mirror image of the element the right way round
MIRROR = {"tet": (0, 2, 1, 3), "wedge": (0, 2, 1, 3, 5, 4), "hex": (0, 3, 2, 1, 4, 7, 6, 5)}
HEX27_FACES = (5, 3, 2, 4, 0, 1)  # of VTK's nodes 20 to 25 in their order: x-, x+, y-, y+, z-, z+
# Gmsh's order of middles, as corners
GMSH_EDGES = {"tet": "01 12 20 03 23 13", "wedge": "01 02 03 12 14 25 34 35 45",
              "hex": "01 03 04 12 15 23 26 37 45 47 56 67"}
GMSH_FACES = (0, 2, 5, 3, 4, 1)  # of its nodes 20 to 25 of hex27


@dataclass(frozen=True)
class Shape:
    """One kind of elements."""
    name: str
    family: str
    n_nodes: int
    gmsh: int  # its number there

    @property
    def n_corners(self):
        return {"tet": 4, "wedge": 6, "hex": 8}[self.family]

    @property
    def second(self):
        """Whether it has nodes in the middle of its edges."""
        return self.n_nodes > self.n_corners

    def middle(self, a, b):
        """Local node between two corners."""
        edges = [frozenset(edge) for edge in EDGES[self.family]]
        return self.n_corners + edges.index(frozenset((a, b)))

    def face(self, number):
        """Local nodes of face `number`, from 0, in Gmsh's order of a triangle or quadrilateral."""
        corners = FACES[self.family][number]
        nodes = list(corners)
        if self.second:
            nodes += [self.middle(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
        if self.n_nodes == 27:
            nodes.append(20 + HEX27_FACES.index(number))
        return nodes

    def faces(self):
        return [self.face(number) for number in range(len(FACES[self.family]))]

    def gmsh_order(self):
        """Local nodes in the order of Gmsh."""
        order = list(range(self.n_corners))
        if self.second:
            order += [self.middle(int(pair[0]), int(pair[1])) for pair in GMSH_EDGES[self.family].split()]
        if self.n_nodes == 27:
            order += [20 + HEX27_FACES.index(face) for face in GMSH_FACES] + [26]
        return order

    def mirror_order(self):
        """Local nodes of the mirror image."""
        corners = MIRROR[self.family]
        order = list(corners)
        if self.second:
            order += [self.middle(corners[a], corners[b]) for a, b in EDGES[self.family]]
        if self.n_nodes == 27:
            faces = [frozenset(face) for face in FACES[self.family]]
            turned = [faces.index(frozenset(corners[i] for i in FACES[self.family][f])) for f in HEX27_FACES]
            order += [20 + HEX27_FACES.index(face) for face in turned] + [26]
        return order


SHAPES = {shape.name: shape for shape in (
    Shape("tet4", "tet", 4, 4), Shape("tet10", "tet", 10, 11), Shape("wedge6", "wedge", 6, 6),
    Shape("wedge15", "wedge", 15, 18), Shape("hex8", "hex", 8, 5), Shape("hex20", "hex", 20, 17),
    Shape("hex27", "hex", 27, 12))}
FACE_GMSH = {3: 2, 6: 9, 4: 3, 8: 16, 9: 10}  # nodes of a face -> Gmsh's number
POINT_GMSH = 15


# Three neighbours of each corner, the right way round
CORNERS = {"tet": ((1, 2, 3), ), "wedge": ((1, 2, 3), (2, 0, 4), (0, 1, 5), (5, 4, 0), (3, 5, 1), (4, 3, 2)),
           "hex": ((1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3))}


def signed_volumes(shape, x):
    """Mean over the corners of the volumes spanned by their edges, of elements with corners x [n][corners][3]; the sign is that of
    the volume."""
    total = numpy.zeros(len(x))
    for corner, ends in enumerate(CORNERS[shape.family]):
        a, b, c = (x[:, end] - x[:, corner] for end in ends)
        total += numpy.einsum("ij,ij->i", numpy.cross(a, b), c)
    return total / len(CORNERS[shape.family])
