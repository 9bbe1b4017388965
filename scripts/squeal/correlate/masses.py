"""Mass at the sensors from the matrices of -operators_save: X^H M X of the modes, and Guyan's reduction, with the static shapes of unit
motions of the sensors T = K^-1 R' (R K^-1 R')^-1, R the sensors' motions by the unknowns, M_R = T' M T. A body that is free has
K + s M for K, s a ten-thousandth of its lowest frequency squared."""

import numpy
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from ..mesh.petsc_matrix import read_matrix
from ..tables import BadInput

SAME = 1e-6  # of x^H M x = 1, by which matrices are those of the run
SOFT = 1e-4


def sparse(path):
    """A matrix of -operators_save."""
    if not path.is_file():
        raise BadInput(f"--matrices: {path}: no such file; -operators_save writes it")
    rows, columns, row, column, value = read_matrix(path)
    return csc_matrix((value, (row, column)), shape=(rows, columns))


class Masses:
    """K and M of a run, in the order in which the nodes have their unknowns. shapes: of all modes, [nodes][3] each."""

    def __init__(self, folder, shapes, modes):
        self.m, self.k, self.folder = sparse(folder / "M.bin"), sparse(folder / "K.bin"), folder
        moves = numpy.zeros(shapes(modes[0]).size, bool)
        for mode in modes:
            moves |= shapes(mode).ravel() != 0
        self.free = numpy.flatnonzero(moves)
        if len(self.free) != self.m.shape[0]:
            raise BadInput(f"--matrices {folder}: have {self.m.shape[0]} unknowns, the modes move {len(self.free)}: give those of this "
                           f"run, on one "
                           "rank, with contact_law penalty")
        self.x = numpy.stack([shapes(mode).ravel()[self.free] for mode in modes], axis=1)
        self.gram = self.x.conj().T @ (self.m @ self.x)
        if abs(numpy.diag(self.gram) - 1).max() > SAME:
            raise BadInput(f"--matrices {folder}: x^H M x of mode {modes[int(abs(numpy.diag(self.gram) - 1).argmax())]} is not 1: the "
                           f"matrices are not "
                           "those of this run on one rank")

    def guyan(self, found, lowest):
        """Mass matrix at the sensors; lowest: frequency above 0, rad/s."""
        number = numpy.full(self.free[-1] + 1, -1)
        number[self.free] = numpy.arange(len(self.free))
        rows = numpy.zeros((len(found), len(self.free)))
        for row, sensor in zip(rows, found):
            for node, weight in zip(sensor.nodes, sensor.weights):
                for axis in range(3):
                    at = 3 * node + axis
                    if at < len(number) and number[at] >= 0:
                        row[number[at]] += weight * sensor.channel.direction[axis]
        shapes = splu((self.k + SOFT * lowest**2 * self.m).tocsc()).solve(rows.T)
        shapes = shapes @ numpy.linalg.pinv(rows @ shapes, rcond=1e-10)
        return shapes.T @ (self.m @ shapes)
