"""Surfaces of the bodies whose fields squeal wrote, and the frame in which a disc and its neighbours are drawn."""

import numpy

from .tables import BadInput

# Faces of VTK's hexahedron, seen anticlockwise from outside
HEX_FACES = numpy.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])


class Scene:
    """Surfaces of the bodies, and the frame in which they are drawn."""

    def __init__(self, file, disc_name):
        group = file["VTKHDF"]
        self.shapes = group["PointData"]
        self.points = group["Points"][:]
        cells = group["Connectivity"][:].reshape(group["NumberOfCells"][0], -1)
        if cells.shape[1] != 8:
            raise BadInput(f"{file.filename}: cells of {cells.shape[1]} nodes; only hexahedra can be drawn")
        names = [name.decode() for name in group["CellData/part"].attrs["names"]]
        part = group["CellData/part"][:]
        on_disc = part == names.index(disc_name) if disc_name in names else numpy.full(len(cells), True)
        self.disc = boundary_faces(cells[on_disc])
        self.rest = boundary_faces(cells[~on_disc])
        self.others = {name: boundary_faces(cells[~on_disc & (part == i)]) for i, name in enumerate(names)
                       if (~on_disc & (part == i)).any()}
        self.set_frame()

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
        key = f"mode_{mode:03d}"
        if f"{key}_re" not in self.shapes:
            raise BadInput(f"{self.shapes.file.filename}: no shape of mode {mode}; see the column mode of modes.csv")
        shape = self.shapes[f"{key}_re"][:] + 1j * self.shapes[f"{key}_im"][:]
        out_of_plane = shape[numpy.unique(self.disc)] @ self.axis
        return (shape * numpy.exp(-0.5j * numpy.angle(numpy.sum(out_of_plane**2)))).real


def boundary_faces(cells):
    """Faces [n][4] that belong to one cell only."""
    faces = cells[:, HEX_FACES].reshape(-1, 4)
    _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]
