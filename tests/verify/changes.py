#!/usr/bin/env python3
"""modes_changed.csv beside other methods:

    changes.py full RESULTS MATRICES MU    all modes of changed matrices by scipy's Arnoldi method on the linearised problem
    changes.py anew RESULTS CHANGE OTHER    all modes of a change beside modes.csv of another run
    changes.py couplings RESULTS MATRICES MU    modes_couplings.csv beside vectors by inverse iteration on the saved matrices
    changes.py absorber RESULTS CHANGE RATIO    the response of a mass with Den Hartog's absorber, made of the eigenvalues

full: the changes of scene.yaml are added to the matrices of -operators_save; each mode of the band stands in the table once, no farther
off than its stated error, with the mode before the change that its shape resembles most.
couplings: S_ij = -y_i' D(lambda_j) x_j / (y_i' Q'(lambda_i) x_i), D what a change adds to Q. Any vectors leave S_ii and S_ij S_ji alone.
absorber: a mass of 1 kg on 1 N/m with an absorber of RATIO kg, k = RATIO / (1 + RATIO)^2 N/m, is excited by 1 N: at both fixed
points the amplitude is sqrt(1 + 2 / RATIO) m, whatever the dashpot (J. P. Den Hartog, Mechanical Vibrations)."""

import csv
import functools
import math
import sys
from pathlib import Path

import h5py
import numpy
import scipy.sparse
import scipy.sparse.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from effects import matrix, nodes_of # noqa: E402
from squeal.provenance import Provenance # noqa: E402

LOOSE = 1e-9  # of an eigenvalue: what scipy leaves
EDGE = 1e-3  # of the band, left out at its ends
LARGEST = 2e-3  # of a frequency, that an error may state
COUPLED = 1e-6  # of the largest coupling: vectors of both
OVERLAP = 2e-4  # of the table: it has four digits


def matrices(folder, mu):
    """K with friction, C and M of -operators_save."""
    return matrix(folder / "K.bin") + mu * matrix(folder / "H.bin"), matrix(folder / "C.bin"), matrix(folder / "M.bin")


def table(folder):
    """Change -> eigenvalues and errors, rad/s, and the mode before with its overlap."""
    found = {}
    with (folder / "modes_changed.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            value = complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
            before = int(row.get("before", 0)) - 1, float(row.get("overlap", "nan"))
            found.setdefault(row["change"], []).append((value, 2 * math.pi * float(row["error_hz"]), before))
    return found


# flat sets of the built-in brake: their part and height, m
SURFACES = {"beam_top": ("beam", 0.11), "pad_face": ("pad", 0.0)}


def tributary(values):
    """Share of each of its levels in a line."""
    levels = numpy.unique(values.round(9))
    width = numpy.gradient(levels, edge_order=1) * numpy.where(numpy.isin(levels, (levels[0], levels[-1])), 0.5, 1)
    return width[numpy.searchsorted(levels, values.round(9))]


def surfaces(brake):
    """Nodes of the flat sets, which are grids, and their shares in the area; of the pad, whose nodes are alike."""
    found = {}
    for name, (part, height) in SURFACES.items():
        nodes = numpy.flatnonzero(brake.of[brake.scene.names("parts").index(part)] & (abs(brake.places[:, 2] - height) < 1e-9))
        share = tributary(brake.places[nodes, 0]) * tributary(brake.places[nodes, 1])
        found[name] = nodes, share / share.sum()
    nodes = numpy.flatnonzero(brake.of[brake.scene.names("parts").index("pad")])
    found["pad"] = nodes, numpy.full(len(nodes), 1 / len(nodes))
    return found


class Brake:
    """The matrices of a run, and which unknown each node has. `sets` are nodes and shares of sets by name, `slopes` what a percent of
    a parameter adds to K, C and M, by name."""

    def __init__(self, results, folder, mu, sets=None, slopes=None):
        self.scene = Provenance(results / "scene.yaml")
        self.K, self.C, self.M = matrices(folder, mu)
        self.sets, self.slopes = sets or {}, slopes or {}
        self.places, self.of = nodes_of(results / "modes_effects.h5")
        with h5py.File(results / "modes.h5") as file:
            grid = file["VTKHDF"]
            self.cells = grid["Connectivity"][()].reshape(-1, 8) if set(grid["Types"][()]) == {12} else None
            self.part_of_cell = grid["CellData/part"][()]
            free = numpy.flatnonzero(sum(abs(shape[()]).reshape(-1) for key, shape in file["VTKHDF/PointData"].items()
                                         if key[-3:] in ("_re", "_im")) > 0)
        self.number = numpy.full(3 * len(self.places), -1)
        self.number[free] = numpy.arange(len(free))
        self.changed = functools.cache(self.changed)

    def column(self, node, direction):
        """A direction at the unknowns of a node."""
        numbers = self.number[3 * node:3 * node + 3]
        moves = numbers >= 0
        return scipy.sparse.csc_matrix((direction[moves], (numbers[moves], numpy.zeros(moves.sum(), int))), (self.M.shape[0], 1))

    def vector(self, name, end, direction):
        """The unit vector along a direction at the node of an end."""
        part = self.scene.names("parts").index(self.scene.value(f"{name}_{'to_' if end == 'to' else ''}part"))
        at = [float(x) for x in self.scene.value(f"{name}_{end}").split(",")]
        return self.column(int(numpy.argmin(((self.places - at)**2).sum(1) + ~self.of[part])), direction)

    def ring(self, inner, outer, part=0):
        """Nodes of a disc of bricks about the z axis between two radii, and their shares in the mass: an eighth of each brick's volume,
        by Gauss's rule."""
        x, volume = self.places[self.cells[self.part_of_cell == part]], numpy.zeros(len(self.places))
        corners = numpy.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
        size = 0
        for point in corners / math.sqrt(3):
            slope = numpy.array([[corner[i] / 8 * math.prod(1 + corner[j] * point[j] for j in range(3) if j != i) for corner in corners]
                                 for i in range(3)])
            size = size + numpy.linalg.det(slope @ x)
        numpy.add.at(volume, self.cells[self.part_of_cell == part], size[:, None] / 8)
        radius = numpy.hypot(*(self.places - volume @ self.places / volume.sum())[:, :2].T)  # about the centre of mass
        near = 2e-3 * radius[volume > 0].max()
        nodes = numpy.flatnonzero((radius > inner - near) & (radius < outer + near) & (volume > 0))
        return nodes, volume[nodes] / volume[nodes].sum()

    def layer(self, name):
        """Nodes and shares of a change over many, None for one at a node."""
        if f"{name}_ring" in self.scene.given:
            return self.ring(*(float(x) for x in self.scene.value(f"{name}_ring").split(",")))
        return self.sets.get(self.scene.value(f"{name}_set"))

    def products(self, name, axis):
        """The matrix that an amount of one is along an axis, and the vector a of a a' where it is one."""
        if layer := self.layer(name):
            columns = [self.column(node, axis) * math.sqrt(share) for node, share in zip(*layer)]
            block = scipy.sparse.hstack(columns, "csc")
            return block @ block.T, None
        a = self.vector(name, "at", axis)
        if f"{name}_to" in self.scene.given:
            a = a - self.vector(name, "to", axis)
        return a @ a.T, a

    def changed(self, name):
        """K, C and M with a change and those made with it."""
        K, C, M = self.K, self.C, self.M
        while name:
            size = [self.scene.number(f"{name}_{word}") for word in ("stiffness", "viscosity", "mass")]
            axes = [numpy.array([float(x) for x in self.scene.value(f"{name}_direction").split(",")])] if sum(size[:2]) else numpy.eye(3)
            hangs = size[2] > 0 and sum(size[:2]) > 0
            if parameter := self.scene.value(f"{name}_parameter"):
                percent, axes = self.scene.number(f"{name}_percent"), []
                parts = [(percent * slope).tocsc() for slope in self.slopes[parameter]]
                for part in parts:
                    part.resize(K.shape)
                K, C, M = (A + part for A, part in zip((K, C, M), parts))
            for axis in axes:
                product, a = self.products(name, axis / numpy.linalg.norm(axis))
                product.resize(K.shape)
                if hangs:  # the motion of the mass is a further unknown
                    a.resize(K.shape[0], 1)
                    K, C, M = (scipy.sparse.block_diag([A, [[value]]], "csc") for A, value in zip((K, C, M), (0, 0, size[2])))
                    a = scipy.sparse.vstack([a, [[-1]]], "csc")
                    product = a @ a.T
                K, C, M = (A + value * product for A, value in zip((K, C, M), (*size[:2], 0 if hangs else size[2])))
            name = self.scene.value(f"{name}_with")
        return K, C, M

    def modes(self, name, band, count):
        """Eigenvalues in the band."""
        return [value for value, _ in self.shapes(name, band, count)]

    def shapes(self, name, band, count):
        """Eigenvalues in the band with their vectors, of the linearised problem about the middle of it."""
        K, C, M = self.changed(name)
        n, shift = K.shape[0], 1j * math.hypot(*band) / math.sqrt(2)
        factors = scipy.sparse.linalg.splu((K + shift * C + shift**2 * M).tocsc(), permc_spec="MMD_AT_PLUS_A")

        def solve(b):
            """(A - shift B)^-1 of [0 I; -K -C] - shift [I 0; 0 M], b = [f; g]: (K + shift C + shift^2 M) x = -g - C f - shift M f."""
            f, g = b[:n], b[n:]
            x = -factors.solve(g + C @ f + shift * (M @ f))
            return numpy.concatenate([x, f + shift * x])

        operator = scipy.sparse.linalg.LinearOperator((2 * n, 2 * n), matvec=lambda z: solve(
            numpy.concatenate([z[:n], M @ z[n:]])), dtype=complex)
        start = numpy.random.default_rng(1).standard_normal(2 * n)
        theta, vectors = scipy.sparse.linalg.eigs(operator, count, which="LM", v0=start, tol=1e-12)
        values = shift + 1 / theta
        if abs(values - shift).max() < max(band) - abs(shift):
            sys.exit("too few eigenvalues of scipy: raise their count")
        return [(value, vector) for value, vector in zip(values, vectors[:n].T) if band[0] < value.imag < band[1]]

    def refined(self, name, value):
        """An eigenvalue by inverse iteration with factors next to it, for Arnoldi's leave 1e-9 of it; its right and left vectors."""
        K, C, M = self.changed(name)
        for _ in range(2):
            s = value * (1 + 1e-9)
            factors = scipy.sparse.linalg.splu((K + s * C + s**2 * M).tocsc(), permc_spec="MMD_AT_PLUS_A")
            slope = (2 * s * M + C).tocsc()
            x = numpy.random.default_rng(3).standard_normal(K.shape[0]) + 0j
            y = x
            for _ in range(3):
                x, y = factors.solve(slope @ x), factors.solve(slope.T @ y, "T")
                x, y = x / numpy.linalg.norm(x), y / numpy.linalg.norm(y)
            value = s - (y @ (K @ x + s * (C @ x) + s**2 * (M @ x))) / (y @ (slope @ x))
        return value, x, y

    def added(self, name, value):
        """What a change adds to Q(value): unknowns that hang at it are eliminated."""
        n = self.K.shape[0]
        Q = sum(A * value**i for i, A in enumerate(self.changed(name))).tocsc()
        found = Q[:n, :n] - (self.K + value * self.C + value**2 * self.M)
        for k in range(n, Q.shape[0]):
            found = found - Q[:n, k] @ Q[k, :n] / Q[k, k]
        return found

    def overlaps(self, x, shapes):
        """|u^H M x|^2 / (u^H M u x^H M x) of each of the shapes u, in rows."""
        x = x[:self.M.shape[0]]
        Mx, Mu = self.M @ x, (self.M @ shapes.T).T
        return abs(shapes.conj() @ Mx)**2 / ((shapes.conj() * Mu).sum(axis=1).real * numpy.vdot(x, Mx).real)


def full(results, folder, mu):
    """Each change beside its full solution."""
    brake, worst, largest = Brake(results, folder, mu), 0, 0
    brake.sets = surfaces(brake)
    edges = [2 * math.pi * float(edge) for edge in brake.scene.value("modes_band").split(",")]
    band = edges[0] + EDGE * edges[1], edges[1] * (1 - EDGE)
    old = sorted(brake.shapes("", band, 2 * max(map(len, table(results).values()))), key=lambda entry: entry[0].imag)
    shapes = numpy.array([shape for _, shape in old])
    for name, rows in table(results).items():
        exact = brake.shapes(name, band, 2 * len(rows))
        inside = [row for row in rows if band[0] < row[0].imag < band[1]]
        if len(exact) != len(inside):
            sys.exit(f"{name}: {len(inside)} modes in the table, {len(exact)} of the matrices")
        for value, error, (before, overlap) in inside:
            nearest = min(range(len(exact)), key=lambda i: abs(exact[i][0] - value))
            other, vector = exact.pop(nearest)
            off = abs(other - value) / (error + LOOSE * abs(value))
            worst, largest = max(worst, off), max(largest, error / abs(value))
            overlaps = brake.overlaps(vector, shapes)
            if before >= len(old) or abs(overlaps[before] - overlap) > OVERLAP or max(overlaps) > overlap + OVERLAP:
                sys.exit(f"{name}: {value} is said to be mode {before + 1}, {overlap}; of the matrices {max(overlaps)}")
        print(f"{name}: {len(inside)} modes, largest growth {max(value.real for value, _, _ in inside):.6g} 1/s")
    print(f"off by {worst:.2g} of the stated error at most, which is {largest:.1e} of the eigenvalue at most")
    return worst <= 1 and largest <= LARGEST


def anew(results, name, other):
    """A change beside a run with it."""
    with (other / "modes.csv").open(newline="") as file:
        exact = [complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in csv.DictReader(file)]
    rows = sorted(table(results)[name], key=lambda row: row[0].imag)
    off = [min(abs(value - one) for one in exact) / (error + LOOSE * abs(value)) for value, error, _ in rows]
    print(f"{name}: {len(rows)} modes, off by {max(off):.2g} of the stated error at most")
    return len(rows) == len(exact) and max(off) <= 1


def couplings(results, folder, mu):
    """All entries between two modes of modes.csv."""
    brake, found = Brake(results, folder, mu), {}
    brake.sets = surfaces(brake)
    with (results / "modes.csv").open(newline="") as file:
        modes = [brake.refined("", complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])))
                 for row in csv.DictReader(file)]
    with (results / "modes_couplings.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            S = found.setdefault(row["change"], numpy.zeros((len(modes), len(modes)), complex))
            S[int(row["mode"]) - 1, int(row["of"]) - 1] = complex(float(row["real_rad_s"]), float(row["imaginary_rad_s"]))
    slopes, worst = [y @ (2 * value * (brake.M @ x) + brake.C @ x) for value, x, y in modes], 0
    left = numpy.array([y for _, _, y in modes])
    for name, S in found.items():
        exact = -numpy.array([left @ (brake.added(name, value) @ x) for value, x, _ in modes]).T / numpy.array(slopes)[:, None]
        off = [abs(numpy.diag(S) - numpy.diag(exact)).max() / abs(numpy.diag(exact)).max(),
               abs(S * S.T - exact * exact.T).max() / abs(exact * exact.T).max()]
        print(f"{name}: {len(modes)} modes, {numpy.count_nonzero(S)} couplings, diagonal off by {off[0]:.1e}, products by {off[1]:.1e}")
        worst = max(worst, *off)
    return set(found) == set(brake.scene.names("modes_changes")) and 0 < worst <= COUPLED


def absorber(results, name, ratio):
    """|k - m w^2 + i w c| / |ratio prod(i w - lambda)| at the fixed points, with the damping that the sum of eigenvalues tells."""
    values = numpy.array([value for value, _, _ in table(results)[name]])
    if len(values) != 2:
        return False
    k = ratio / (1 + ratio)**2
    c = -2 * values.real.sum() / (1 / ratio + 1)  # trace of M^-1 C = c (1 / ratio + 1)
    # undamped and locked absorbers have amplitudes of one size there
    roots = numpy.roots([ratio * (2 + ratio) / 2, 0, -(ratio + (1 + ratio) * k), 0, k])
    fixed = sorted(root.real for root in roots if root.real > 0)
    heights = [abs(k - ratio * w**2 + 1j * w * c) / abs(ratio * numpy.prod((1j * w - values) * (1j * w - values.conj()))) for w in fixed]
    off = max(abs(height / math.sqrt(1 + 2 / ratio) - 1) for height in heights)
    print(f"fixed points at {fixed} rad/s: amplitudes {heights} m, off by {off:.1e}")
    return len(fixed) == 2 and c > 0 and off < 1e-9


if __name__ == "__main__":
    word, folder, *rest = sys.argv[1:]
    passed = (full(Path(folder), Path(rest[0]), float(rest[1])) if word == "full" else
              couplings(Path(folder), Path(rest[0]), float(rest[1])) if word == "couplings" else
              anew(Path(folder), rest[0], Path(rest[1])) if word == "anew" else absorber(Path(folder), rest[0], float(rest[1])))
    sys.exit(0 if passed else 1)
