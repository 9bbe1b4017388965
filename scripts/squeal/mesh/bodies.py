"""Surfaces of the bodies whose fields squeal wrote, and the frame in which a disc and its neighbours are drawn."""

from contextlib import contextmanager
from pathlib import Path

import numpy

from .cells import boundary_faces, read_cells
from ..provenance import Units
from ..tables import BadInput, regular

LARGEST = 1e30  # of what is a displacement, a velocity or a place
DISCS = ("disc", "disk", "rotor")  # in the name of a part that is one


class Scene:
    """Surfaces of the bodies in m, and the frame in which they are drawn."""

    def __init__(self, file, disc_name):
        group = file["VTKHDF"]
        self.shapes = group["PointData"]
        self.points = Units(Path(file.filename).parent).factor("m") * sound(file.filename, "Points", group["Points"][:])
        cells = read_cells(group)
        names = [name.decode() for name in group["CellData/part"].attrs["names"]]
        disc_name = disc_among(names, disc_name)
        part = group["CellData/part"][:]
        on_disc = part == names.index(disc_name) if disc_name in names else numpy.full(len(part), True)
        self.cells = {name: those(cells, part == i) for i, name in enumerate(names) if (part == i).any()}
        self.surfaces = {name: boundary_faces(of_part) for name, of_part in self.cells.items()}
        self.disc = boundary_faces(those(cells, on_disc))
        self.rest = boundary_faces(those(cells, ~on_disc))
        self.others = {name: faces for name, faces in self.surfaces.items() if name != disc_name and len(self.rest)}
        self.set_frame()

    def nodes_of(self, parts=()):
        """Nodes of some parts, of all where none is named."""
        kinds = [nodes.ravel() for name, cells in self.cells.items() if not parts or name in parts for nodes in cells.values()]
        return numpy.unique(numpy.concatenate(kinds))

    def set_frame(self):
        """Axis = shortest extent of the disc, towards the other parts; radial = towards them in the disc's plane;
        slip = along the circumference there; right and up span the map."""
        disc = self.points[numpy.unique(self.disc)]
        centre = (disc.min(axis=0) + disc.max(axis=0)) / 2
        towards = self.points[numpy.unique(self.rest)].mean(axis=0) - centre if len(self.rest) else numpy.ones(3)
        shortest = numpy.argmin(numpy.ptp(disc, axis=0))
        self.axis = numpy.zeros(3)
        self.axis[shortest] = 1 if towards[shortest] >= 0 else -1
        self.right = numpy.zeros(3)
        self.right[0 if shortest else 1] = 1
        self.up = numpy.cross(self.axis, self.right)
        radial = towards - (towards @ self.axis) * self.axis
        if numpy.linalg.norm(radial) < 1e-6 * numpy.ptp(disc, axis=0).max():
            radial = self.right
        self.radial = radial / numpy.linalg.norm(radial)
        self.slip = numpy.cross(self.axis, self.radial)

    def facing(self, faces, viewer):
        """The faces whose outward normal points at the viewer."""
        corners = self.points[faces]
        normal = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        return faces[normal @ viewer > 0.5 * numpy.linalg.norm(normal, axis=1)]

    def displacement(self, mode):
        """Real displacements at the phase at which the disc's out-of-plane amplitude is largest."""
        return self.shape(mode).real

    def shape(self, mode):
        """Complex displacements, turned so that this phase is zero."""
        key = f"mode_{mode:03d}"
        if f"{key}_re" not in self.shapes:
            raise BadInput(f"{self.shapes.file.filename}: no shape of mode {mode}; see the column mode of modes.csv")
        name = self.shapes.file.filename
        re, im = (sound(name, f"{key}_{part}", self.shapes[f"{key}_{part}"][:]) for part in ("re", "im"))
        shape = re + 1j * im
        out_of_plane = shape[numpy.unique(self.disc)] @ self.axis
        return shape * numpy.exp(-0.5j * numpy.angle(numpy.sum(out_of_plane**2)))


def disc_among(names, wanted):
    """Name of the disc: the part of that name; where none is called disc, the only one that is one by its name."""
    found = [name for name in names if any(disc in name.lower() for disc in DISCS)]
    return found[0] if wanted == DISCS[0] and wanted not in names and len(found) == 1 else wanted


class Skin:
    """The surfaces of a scene in a frame of their own: x along the circumference at the contact, y outward, z along the
    axis, from the middle, in half the largest extent; `extent` in m. `quads` index `nodes` of the scene."""

    def __init__(self, scene):
        self.frame = numpy.stack([scene.slip, scene.radial, scene.axis], axis=1)
        faces = numpy.concatenate(list(scene.surfaces.values()))
        self.nodes, quads = numpy.unique(faces, return_inverse=True)
        self.quads = quads.reshape(faces.shape)
        self.parts = {name: len(part) for name, part in scene.surfaces.items()}
        self.part = numpy.repeat(numpy.arange(len(self.parts)), list(self.parts.values()))
        place = scene.points[self.nodes] @ self.frame
        self.extent = numpy.ptp(place, axis=0)
        self.half = self.extent.max() / 2 or 1.0
        self.place = (place - (place.max(axis=0) + place.min(axis=0)) / 2) / self.half
        self.edges = feature_edges(self.place, self.quads, self.part)

    def moved(self, field):
        """Vectors of the scene's nodes, real or complex, on the surface in its frame."""
        return field[self.nodes] @ self.frame


def sound(path, name, values):
    """Values of an array, if they can be any of a field."""
    if not (abs(values) < LARGEST).all():
        raise BadInput(f"{path}: array {name} has values that are no numbers or above {LARGEST:g}; was the file "
                       f"damaged?")
    return values


@contextmanager
def opened(path):
    """An HDF5 file; what cannot be read is one line."""
    try:
        import h5py
    except ImportError:
        raise BadInput(f"{path}: cannot be read without the Python module h5py") from None
    try:
        with h5py.File(regular(path)) as file:
            yield file
    except (OSError, KeyError, IndexError, ValueError, RuntimeError, TypeError) as error:  # the last two: h5py's of torn files
        raise BadInput(f"{path}: cannot be read: {error}") from None


def read_states(paths, name, disc_name):
    """Values of an array at the nodes of each file, whose name ends in its unit, in SI, with the scene of the first one:
    they share a mesh."""
    scene = None
    for path in paths:
        with opened(path) as file:
            scene = scene or Scene(file, disc_name)
            data = file["VTKHDF/PointData"]
            if name not in data:
                raise BadInput(f"{path}: no array {name}")
            yield scene, Units(path.parent).factor(name.partition("_")[2]) * sound(path, name, data[name][:])


def those(cells, chosen):
    """Of the cells of read_cells() the chosen ones, by type."""
    return {kind: nodes[chosen[number]] for kind, (number, nodes) in cells.items() if chosen[number].any()}


def feature_edges(points, faces, part, sharp=0.8):
    """Edges [n][2] at which a body has a corner (the cosine between the faces is below `sharp`), or an end; `part` is
    that of each face."""
    normal = numpy.cross(points[faces[:, 2]] - points[faces[:, 0]], points[faces[:, 3]] - points[faces[:, 1]])
    normal /= numpy.linalg.norm(normal, axis=1)[:, None] + 1e-300
    edges = numpy.sort(numpy.stack([faces, numpy.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    face = numpy.repeat(numpy.arange(len(faces)), 4)
    true = edges[:, 0] != edges[:, 1]  # not the one between the equal nodes of a triangle
    edges, face = edges[true], face[true]
    order = numpy.lexsort((face, edges[:, 1], edges[:, 0], part[face]))
    edges, face = edges[order], face[order]
    same = (edges[1:] == edges[:-1]).all(axis=1) & (part[face[1:]] == part[face[:-1]])
    flat = same & ((normal[face[1:]] * normal[face[:-1]]).sum(axis=1) > sharp)
    smooth = numpy.append(flat, False) | numpy.append(False, flat)
    return numpy.unique(edges[~smooth], axis=0)
