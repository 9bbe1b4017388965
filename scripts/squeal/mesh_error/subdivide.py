"""A mesh of Gmsh with every element cut into k along each edge. New nodes lie on the elements as they are: faces of second order
stay curved, those of first order stay flat facets, hence the error of flat facets on a round body is not seen."""

import numpy

from ..tables import BadInput, whole
from .lattice import CORNERS, KINDS, cut


def random_numbers(n):
    """A whole number of 64 bits for each node."""
    return numpy.random.default_rng(20240229).integers(0, 2**64, n, dtype=numpy.uint64)


def subdivide(places, sets, k):
    """Places [n][3] and sets {(name, type): nodes [m][nodes]} of the finer mesh.

    A new node is known by the sum of its weights times a random number of each corner, modulo 2^64: the same in all elements that
    have it, on a common face or edge, and another one for nodes that only lie in the same place, as across a contact."""
    number = random_numbers(len(places))
    unknown = {kind for _, kind in sets} - set(KINDS)
    if unknown:
        raise BadInput(f"elements of Gmsh's type {min(unknown)} cannot be refined; valid are {sorted(KINDS)}")
    keys, points, made, of_old = [], [], {}, numpy.full(len(places), 0, numpy.uint64)
    for (name, kind), nodes in sorted(sets.items(), key=lambda item: -CORNERS[KINDS[item[0][1]][0]].shape[1]):
        if KINDS[kind][0] == "point":
            made[name, kind] = of_old[nodes[:, 0]][:, None]
            continue
        parts = cut(kind, k)
        key = number[nodes[:, :parts.weight.shape[1]]] @ parts.weight.T.astype(numpy.uint64)
        is_old = parts.old >= 0
        of_old[nodes[:, is_old]] = key[:, parts.old[is_old]]
        keys.append(key.ravel())
        points.append(numpy.einsum("pn,end->epd", parts.shape, places[nodes]).reshape(-1, 3))
        made[name, kind] = key[:, parts.parts].reshape(-1, parts.parts.shape[1])
    known, first = numpy.unique(numpy.concatenate(keys), return_index=True)
    fine = {key: numpy.searchsorted(known, nodes) for key, nodes in made.items()}
    return numpy.concatenate(points)[first], fine


def write_mesh(path, places, sets):
    """As a file of Gmsh, format 2.2 in text: there an element in two sets stands twice."""
    names = {}
    for name, kind in sets:
        names.setdefault((CORNERS[KINDS[kind][0]].shape[1], name), len(names) + 1)
    with whole(path) as part, part.open("w", encoding="utf-8") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
        out.writelines(f'{dimension} {tag} "{name}"\n' for (dimension, name), tag in names.items())
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(places)}\n")
        numpy.savetxt(out, numpy.column_stack([numpy.arange(1, len(places) + 1), places]), "%d %.17g %.17g %.17g")
        out.write(f"$EndNodes\n$Elements\n{sum(map(len, sets.values()))}\n")
        first = 1
        for (name, kind), nodes in sets.items():
            tag = names[CORNERS[KINDS[kind][0]].shape[1], name]
            head = numpy.tile([0, kind, 2, tag, tag], (len(nodes), 1))
            head[:, 0] = numpy.arange(first, first + len(nodes))
            numpy.savetxt(out, numpy.hstack([head, nodes + 1]), "%d")
            first += len(nodes)
        out.write("$EndElements\n")
