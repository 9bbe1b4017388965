#!/usr/bin/env python3
"""modes_changed.csv beside other methods:

    changes.py full RESULTS MATRICES MU    all modes of changed matrices by scipy's Arnoldi method on the linearised problem
    changes.py absorber RESULTS CHANGE RATIO    the response of a mass with Den Hartog's absorber, made of the eigenvalues

full: the changes of scene.yaml are added to the matrices of -operators_save; each mode of the band stands in the table once, no farther
off than its stated error, with the mode before the change that its shape resembles most.
absorber: a mass of 1 kg on 1 N/m with an absorber of RATIO kg, k = RATIO / (1 + RATIO)^2 N/m, is excited by 1 N: at both fixed
points the amplitude is sqrt(1 + 2 / RATIO) m, whatever the dashpot (J. P. Den Hartog, Mechanical Vibrations)."""

import csv
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
OVERLAP = 2e-4  # of the table: it has four digits


def table(folder):
    """Change -> eigenvalues and errors, rad/s, and the mode before with its overlap."""
    found = {}
    with (folder / "modes_changed.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            value = complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
            before = int(row.get("before", 0)) - 1, float(row.get("overlap", "nan"))
            found.setdefault(row["change"], []).append((value, 2 * math.pi * float(row["error_hz"]), before))
    return found


class Brake:
    """The matrices of a run, and which unknown each node has."""

    def __init__(self, results, folder, mu):
        self.scene = Provenance(results / "scene.yaml")
        self.K, self.M = matrix(folder / "K.bin") + mu * matrix(folder / "H.bin"), matrix(folder / "M.bin")
        self.C = matrix(folder / "C.bin")
        self.places, self.of = nodes_of(results / "modes_effects.h5")
        with h5py.File(results / "modes.h5") as file:
            free = numpy.flatnonzero(sum(abs(shape[()]).reshape(-1) for key, shape in file["VTKHDF/PointData"].items()
                                         if key[-3:] in ("_re", "_im")) > 0)
        self.number = numpy.full(3 * len(self.places), -1)
        self.number[free] = numpy.arange(len(free))

    def vector(self, name, end, direction):
        """The unit vector along a direction at the node of an end."""
        part = self.scene.names("parts").index(self.scene.value(f"{name}_{'to_' if end == 'to' else ''}part"))
        at = [float(x) for x in self.scene.value(f"{name}_{end}").split(",")]
        node = int(numpy.argmin(((self.places - at)**2).sum(1) + ~self.of[part]))
        numbers = self.number[3 * node:3 * node + 3]
        moves = numbers >= 0
        return scipy.sparse.csc_matrix((direction[moves], (numbers[moves], numpy.zeros(moves.sum(), int))), (self.M.shape[0], 1))

    def changed(self, name):
        """K, C and M with a change and those made with it."""
        K, C, M = self.K, self.C, self.M
        while name:
            size = [self.scene.number(f"{name}_{word}") for word in ("stiffness", "viscosity", "mass")]
            axes = [numpy.array([float(x) for x in self.scene.value(f"{name}_direction").split(",")])] if sum(size[:2]) else numpy.eye(3)
            hangs = size[2] > 0 and sum(size[:2]) > 0
            for axis in axes:
                axis = axis / numpy.linalg.norm(axis)
                a = self.vector(name, "at", axis)
                if f"{name}_to" in self.scene.given:
                    a = a - self.vector(name, "to", axis)
                a.resize(K.shape[0], 1)
                if hangs:  # the motion of the mass is a further unknown
                    K, C, M = (scipy.sparse.block_diag([A, [[value]]], "csc") for A, value in zip((K, C, M), (0, 0, size[2])))
                    a = scipy.sparse.vstack([a, [[-1]]], "csc")
                K, C, M = (A + value * (a @ a.T) for A, value in zip((K, C, M), (*size[:2], 0 if hangs else size[2])))
            name = self.scene.value(f"{name}_with")
        return K, C, M

    def modes(self, name, band, count):
        """Eigenvalues in the band."""
        return [value for value, _ in self.shapes(name, band, count)]

    def shapes(self, name, band, count):
        """Eigenvalues in the band with their vectors, of the linearised problem about the middle of it."""
        K, C, M = self.changed(name)
        n, shift = K.shape[0], 1j * math.hypot(*band) / math.sqrt(2)
        factors = scipy.sparse.linalg.splu((K + shift * C + shift**2 * M).tocsc())

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
        """An eigenvalue by inverse iteration with factors next to it, for Arnoldi's leave 1e-9 of it."""
        K, C, M = self.changed(name)
        for _ in range(2):
            s = value * (1 + 1e-9)
            factors = scipy.sparse.linalg.splu((K + s * C + s**2 * M).tocsc())
            slope = (2 * s * M + C).tocsc()
            x = numpy.random.default_rng(3).standard_normal(K.shape[0]) + 0j
            y = x
            for _ in range(3):
                x, y = factors.solve(slope @ x), factors.solve(slope.T @ y, "T")
                x, y = x / numpy.linalg.norm(x), y / numpy.linalg.norm(y)
            value = s - (y @ (K @ x + s * (C @ x) + s**2 * (M @ x))) / (y @ (slope @ x))
        return value

    def overlap(self, x, u):
        """|u^H M x|^2 / (u^H M u x^H M x)."""
        x = x[:self.M.shape[0]]
        Mx, Mu = self.M @ x, self.M @ u
        return abs(numpy.vdot(u, Mx))**2 / (numpy.vdot(u, Mu).real * numpy.vdot(x, Mx).real)


def full(results, folder, mu):
    """Each change beside its full solution."""
    brake, worst, largest = Brake(results, folder, mu), 0, 0
    edges = [2 * math.pi * float(edge) for edge in brake.scene.value("modes_band").split(",")]
    band = edges[0] + EDGE * edges[1], edges[1] * (1 - EDGE)
    old = sorted(brake.shapes("", band, 2 * max(map(len, table(results).values()))), key=lambda entry: entry[0].imag)
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
            overlaps = [brake.overlap(vector, shape) for _, shape in old]
            if before >= len(old) or abs(overlaps[before] - overlap) > OVERLAP or max(overlaps) > overlap + OVERLAP:
                sys.exit(f"{name}: {value} is said to be mode {before + 1}, {overlap}; of the matrices {max(overlaps)}")
        print(f"{name}: {len(inside)} modes, largest growth {max(value.real for value, _, _ in inside):.6g} 1/s")
    print(f"off by {worst:.2g} of the stated error at most, which is {largest:.1e} of the eigenvalue at most")
    return worst <= 1 and largest <= LARGEST


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
    passed = full(Path(folder), Path(rest[0]), float(rest[1])) if word == "full" else absorber(Path(folder), rest[0], float(rest[1]))
    sys.exit(0 if passed else 1)
