"""A pad of 40 x 40 x 20 mm on the middle of a plate of 80 x 80 x 20 mm, each of equal hexahedra of one kind, with nodes of their own:
volumes "pad" and "plate", surfaces "pad_bottom", "pad_top", "plate_top" and "plate_bottom"."""

import numpy

from ..mesh_error.lattice import CORNERS, KINDS, with_middles
from ..mesh_error.subdivide import write_mesh

FACES = {5: 3, 17: 16, 12: 10}  # hexahedra -> their faces, as numbers of Gmsh
BOXES = {"pad": ((-0.02, -0.02, 0.0), (0.02, 0.02, 0.02)), "plate": ((-0.04, -0.04, -0.02), (0.04, 0.04, 0.0))}
CONTACT = ("-parts", "pad,plate", "-supports", "clamp", "-clamp_set", "plate_bottom", "-clamp_fix", "xyz", "-contacts", "contact",
           "-contact_surfaces", "pad_bottom,plate_top", "-contact_slip", "0,1,0", "-contact_mu", 0.3, "-plate_young", 210e9,
           "-plate_poisson", 0.3, "-plate_density", 7800, "-pad_young", 25e9, "-pad_poisson", 0.3, "-pad_density", 2500, "-springs", "back",
           "-back_set", "pad_top", "-back_stiffness_per_area", "1e12,1e12,1e12")


def grid(counts):
    """Places (i, j, k) of all cells."""
    return numpy.stack(numpy.meshgrid(*map(numpy.arange, counts), indexing="ij"), -1).reshape(-1, 1, 3)


def box(name, kind, counts):
    """Places and sets of one box."""
    low, high = map(numpy.array, BOXES[name])
    cells = with_middles("hex", KINDS[kind][1], grid(counts) + CORNERS["hex"])
    sets = {(name, kind): cells}
    for side, level in (("bottom", 0), ("top", counts[2])):
        flat = grid((*counts[:2], 1))
        corners = numpy.concatenate([CORNERS["quad"], numpy.zeros((4, 1), int)], axis=1)
        faces = with_middles("quad", KINDS[FACES[kind]][1], flat + corners)
        faces[..., 2] = 2 * level
        sets[f"{name}_{side}", FACES[kind]] = faces
    points, numbers = numpy.unique(numpy.concatenate([rows.reshape(-1, 3) for rows in sets.values()]), axis=0, return_inverse=True)
    ends = numpy.cumsum([rows.shape[0] * rows.shape[1] for rows in sets.values()])[:-1]
    parts = numpy.split(numbers.ravel(), ends)
    return low + (high - low) * points / (2 * numpy.array(counts)), {
        key: part.reshape(rows.shape[:2]) for (key, rows), part in zip(sets.items(), parts)}


def write_boxes(path, kind, pad, plate):
    """The mesh, with counts of elements along x and y of the pad and of half the plate; along z half as many as on the pad."""
    first, sets = box("pad", kind, (pad, pad, max(1, pad // 2)))
    second, more = box("plate", kind, (2 * plate, 2 * plate, max(1, plate // 2)))
    write_mesh(path, numpy.concatenate([first, second]), sets | {key: nodes + len(first) for key, nodes in more.items()})
