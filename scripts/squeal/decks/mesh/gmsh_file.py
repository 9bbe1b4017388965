"""The mesh as a file of Gmsh 4.1, binary: an entity for each set of points and surface, and for each combination of sets that
cells are in."""

import numpy

from ...tables import whole
from .elements import FACE_GMSH, POINT_GMSH
from .faces import nodes_by_kind

INT, SIZE = numpy.int32, numpy.uint64


def combinations(volumes, n_cells):
    """Combination of each cell, and the sets that each combination is of (numbers of names)."""
    code = numpy.zeros(n_cells, numpy.int64)
    members = [()]
    for number, cells in enumerate(volumes.values()):
        inside = numpy.zeros(n_cells, bool)
        inside[cells] = True
        known, code = numpy.unique(2 * code + inside, return_inverse=True)
        members = [members[value // 2] + ((number,) if value % 2 else ()) for value in known.tolist()]
    return code, members


class GmshFile:
    """Sections, one after the other."""

    def __init__(self, out, result):
        self.out, self.result = out, result
        self.names = [(3, name) for name in result.volumes] + [(2, name) for name in result.surfaces] + [
            (0, name) for name in result.points]
        self.blocks, self.n_elements = [], 0

    def ints(self, *values):
        self.out.write(numpy.array(values, INT).tobytes())

    def sizes(self, *values):
        self.out.write(numpy.array(values, SIZE).tobytes())

    def reals(self, values):
        self.out.write(numpy.ascontiguousarray(values, float).tobytes())

    def write(self):
        self.out.write(b"$MeshFormat\n4.1 1 8\n")
        self.ints(1)
        self.out.write(b"\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(self.names))
        for tag, (dimension, name) in enumerate(self.names, 1):
            self.out.write(f'{dimension} {tag} "{name}"\n'.encode())
        self.out.write(b"$EndPhysicalNames\n$Entities\n")
        self.collect()
        self.entities()
        self.out.write(b"\n$EndEntities\n$Nodes\n")
        self.nodes()
        self.out.write(b"\n$EndNodes\n$Elements\n")
        self.elements()
        self.out.write(b"\n$EndElements\n")

    def collect(self):
        """Blocks of elements (dimension, entity, type, nodes [n][nodes] from 0)."""
        result, first, tag = self.result, 0, {name: tag for tag, (_, name) in enumerate(self.names, 1)}
        for name, nodes in result.points.items():
            self.blocks.append((0, tag[name], POINT_GMSH, nodes[:, None]))
        for name, faces in result.surfaces.items():
            by_type = {}
            for _, nodes in nodes_by_kind(result, faces):
                by_type.setdefault(nodes.shape[1], []).append(nodes)
            self.blocks += [(2, tag[name], FACE_GMSH[n], numpy.concatenate(parts)) for n, parts in by_type.items()]
        code, self.members = combinations(result.volumes, sum(len(block.ids) for block in result.blocks))
        for block in result.blocks:
            of_block = code[first:first + len(block.ids)]
            first += len(block.ids)
            order = block.shape.gmsh_order()
            for number in numpy.unique(of_block).tolist():
                self.blocks.append((3, number + 1, block.shape.gmsh, block.nodes[of_block == number][:, order]))

    def entities(self):
        low, high = self.result.x.min(axis=0), self.result.x.max(axis=0)
        points = [tag for tag, (dimension, _) in enumerate(self.names, 1) if dimension == 0]
        surfaces = [tag for tag, (dimension, _) in enumerate(self.names, 1) if dimension == 2]
        self.sizes(len(points), 0, len(surfaces), len(self.members))
        for tag in points:
            self.ints(tag)
            self.reals(low)
            self.sizes(1)
            self.ints(tag)
        rows = [(tag, [tag]) for tag in surfaces]
        rows += [(number, [1 + member for member in members]) for number, members in enumerate(self.members, 1)]
        for tag, groups in rows:
            self.ints(tag)
            self.reals([low, high])
            self.sizes(len(groups))
            self.ints(*groups)
            self.sizes(0)

    def nodes(self):
        n = len(self.result.x)
        self.sizes(1, n, 1, n)
        self.ints(3, 1, 0)
        self.sizes(n)
        self.out.write(numpy.arange(1, n + 1, dtype=SIZE).tobytes())
        self.reals(self.result.x)

    def elements(self):
        n = sum(len(nodes) for *_, nodes in self.blocks)
        self.sizes(len(self.blocks), n, 1, n)
        first = 1
        for dimension, entity, kind, nodes in self.blocks:
            self.ints(dimension, entity, kind)
            self.sizes(len(nodes))
            rows = numpy.empty((len(nodes), nodes.shape[1] + 1), SIZE)
            rows[:, 0] = numpy.arange(first, first + len(nodes))
            rows[:, 1:] = nodes + 1
            self.out.write(rows.tobytes())
            first += len(nodes)


def write_mesh(path, result):
    """Writes the file, whole or not at all."""
    with whole(path) as part, part.open("wb") as out:
        GmshFile(out, result).write()
