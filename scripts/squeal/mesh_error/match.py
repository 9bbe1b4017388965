"""Which mode of one mesh is which of another: by shape, since all are on the nodes of their meshes. Modes as near to each other
as doublets share a space of shapes and are told apart inside it by their eigenvalues."""

import itertools

import h5py
import numpy
from scipy.spatial import cKDTree

from ..tables import BadInput, regular

SAMPLED = 3000  # nodes at which shapes are compared
LEAST = 0.5  # share of a shape that lies in the space of its partner
CLOSE = 2e-3  # relative distance of frequencies that make a group
SECOND_ORDER = 20  # types of VTK's cells from here on have nodes in the middle of edges
HEX27 = 29
MOST_PERMUTED = 5


class Shapes:
    """Places of the nodes, the part of each, shapes of the modes [node][3], complex, in the order of modes.csv."""

    def __init__(self, folder, n_modes):
        path = folder / "modes.h5"
        try:
            with h5py.File(regular(path)) as file:
                self.read(file["VTKHDF"], n_modes)
        except (OSError, KeyError) as error:
            raise BadInput(f"{path}: has no shapes to compare: {error}") from None

    def read(self, group, n_modes):
        self.x, offsets = group["Points"][:], group["Offsets"][:]
        owner = numpy.repeat(group["CellData/part"][:], numpy.diff(offsets))
        self.part = numpy.full(len(self.x), -1)
        self.part[group["Connectivity"][:]] = owner
        types = group["Types"][:]
        self.cells, self.second, self.lobatto = len(types), bool((types >= SECOND_ORDER).all()), bool((types == HEX27).all())
        data = group["PointData"]
        self.modes = [data[f"mode_{i:03d}_re"][:] + 1j * data[f"mode_{i:03d}_im"][:] for i in range(1, n_modes + 1)]

    def sample(self):
        """Nodes at which others are compared."""
        nodes = numpy.flatnonzero(self.part >= 0)
        return nodes[::max(1, len(nodes) // SAMPLED)]

    def at(self, other, nodes):
        """The modes at nodes of another mesh, from the four nearest nodes of the same part each, as rows of unit length."""
        rows = numpy.zeros((len(self.modes), len(nodes), 3), complex)
        for part in numpy.unique(other.part[nodes]):
            to, own = numpy.flatnonzero(other.part[nodes] == part), numpy.flatnonzero(self.part == part)
            distance, near = cKDTree(self.x[own]).query(other.x[nodes[to]], k=min(4, len(own)))
            distance, near = distance.reshape(len(to), -1), near.reshape(len(to), -1)
            weight = 1 / numpy.maximum(distance, 1e-9 * (1e-30 + distance.max(axis=1, keepdims=True)))**2
            weight /= weight.sum(axis=1, keepdims=True)
            for mode, row in zip(self.modes, rows):
                row[to] = numpy.einsum("nk,nkd->nd", weight, mode[own][near])
        rows = rows.reshape(len(rows), -1)
        return rows / numpy.maximum(numpy.linalg.norm(rows, axis=1, keepdims=True), 1e-300)


def groups_of(values):
    """Neighbours, by frequency, that are nearer than CLOSE."""
    order = sorted(range(len(values)), key=lambda i: values[i].imag)
    groups = []
    for i in order:
        if groups and values[i].imag - values[groups[-1][-1]].imag <= CLOSE * max(abs(values[i].imag), 1.0):
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def pair_inside(group, chosen, values, others):
    """Partners inside a group: the least sum of distances of eigenvalues about their means, or by rank in a large group."""
    def about(numbers):
        return numpy.array(numbers) - numpy.mean(numbers)

    own, theirs = about([values[i] for i in group]), about([others[j] for j in chosen])
    if len(group) > MOST_PERMUTED or len(chosen) != len(group):
        ranked = sorted(chosen, key=lambda j: (others[j].imag, others[j].real))
        return dict(zip(sorted(group, key=lambda i: (values[i].imag, values[i].real)), ranked))
    best = min(itertools.permutations(range(len(group))), key=lambda order: abs(own - theirs[list(order)]).sum())
    return {i: chosen[k] for i, k in zip(group, best)}


def match(values, others, here, there):
    """Mode -> (its partner, share of that shape in the space of the mode's group). values, others: eigenvalues sigma + i omega
    of both meshes; here, there: shapes at the same nodes, rows of unit length."""
    offers, groups = [], groups_of(values)
    for g, group in enumerate(groups):
        space, _ = numpy.linalg.qr(here[group].T)
        share = numpy.linalg.norm(there @ space.conj(), axis=1)**2
        offers += [(share[j], g, j) for j in range(len(others)) if share[j] > LEAST]
    chosen, taken = {g: {} for g in range(len(groups))}, set()
    for share, g, j in sorted(offers, reverse=True):
        if j not in taken and len(chosen[g]) < len(groups[g]):
            chosen[g][j] = share
            taken.add(j)
    return {i: (j, chosen[g][j]) for g, group in enumerate(groups) if chosen[g]
            for i, j in pair_inside(group, sorted(chosen[g]), values, others).items()}
