"""Elements of the other orientation. MED has all of them so; writers of VTK differ on wedges; halves that were mirrored have both."""

import numpy

from .elements import FACES, signed_volumes


def mirrored_faces(shape):
    """For each face of a mirrored element the one that it was before."""
    order = shape.mirror_order()
    corners = [frozenset(face) for face in FACES[shape.family]]
    return [corners.index(frozenset(order[corner] for corner in face)) for face in FACES[shape.family]]


def set_orientation(deck):
    """Mirrors each element whose volume is negative, and gives faces of surfaces and pressures their new numbers."""
    arrays = [faces for faces, _ in deck.surfaces.values()] + [load.faces for load in deck.loads if load.faces is not None]
    for first, block in zip(deck.firsts(), deck.blocks):
        wrong = signed_volumes(block.shape, deck.x[block.nodes[:, :block.shape.n_corners]]) < 0
        if not wrong.any():
            continue
        block.nodes[wrong] = block.nodes[wrong][:, block.shape.mirror_order()]
        new = numpy.argsort(mirrored_faces(block.shape))
        for faces in arrays:
            inside = (faces[:, 0] >= first) & (faces[:, 0] < first + len(wrong))
            inside[inside] = wrong[faces[inside, 0] - first]
            faces[inside, 1] = new[faces[inside, 1]]
        if not (deck.all_mirrored and wrong.all()):
            deck.differ(block.place, f"{wrong.sum()} of {len(wrong)} elements {block.kind} have the other orientation: they are mirrored")
    deck.outer = None
