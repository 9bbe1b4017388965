"""Eigenvalues of small matrices far below double precision: Newton's method with both vectors, residuals in extended
precision (64 bits of mantissa). Matrices are those of `-operators_save`, as squeal solves them."""

from pathlib import Path

import numpy

from .petsc_matrix import read_matrix
from .tables import BadInput

STEPS = 3
SMALL = 0.01  # last step beside the stated error
CLOSE = 1e-6  # relative distance of eigenvalues whose vectors mean little one by one


class Sparse:
    """A matrix of a PETSc binary file, with products in extended precision."""

    def __init__(self, path):
        self.n, columns, self.row, self.column, self.value = read_matrix(Path(path))
        if columns != self.n:
            raise BadInput(f"{path}: no square matrix")

    def dense(self):
        full = numpy.zeros((self.n, self.n))
        numpy.add.at(full, (self.row, self.column), self.value)
        return full


class Extended:
    """A dense matrix with products in extended precision by its entries that are not zero."""

    def __init__(self, full):
        self.full = full
        self.parts = {}
        for transposed, matrix in ((False, full), (True, full.T)):
            row, column = numpy.nonzero(matrix)
            first = numpy.searchsorted(row, numpy.arange(len(full)))
            if len(numpy.unique(row)) < len(full):  # an empty row would take the entries of the next
                row, column = numpy.nonzero(numpy.ones_like(matrix))
                first = numpy.arange(0, row.size, len(full))
            self.parts[transposed] = first, column, matrix[row, column].astype(numpy.longdouble)

    def times(self, x, transposed=False):
        first, column, value = self.parts[transposed]
        return numpy.add.reduceat(value * x[column], first)


class Pencil:
    """lambda^2 M + lambda C + K of a folder, with friction mu H."""

    def __init__(self, folder, mu):
        folder = Path(folder)
        stiffness = Sparse(folder / "K.bin").dense()
        if (folder / "H.bin").exists():
            stiffness = stiffness + mu * Sparse(folder / "H.bin").dense()
        self.stiffness, self.mass = Extended(stiffness), Extended(Sparse(folder / "M.bin").dense())
        self.damping = Extended(Sparse(folder / "C.bin").dense()) if (folder / "C.bin").exists() else None

    def at(self, value):
        """Q(lambda) in double precision."""
        full = self.stiffness.full + value * value * self.mass.full
        return full + value * self.damping.full if self.damping else full

    def residual(self, value, x, transposed=False):
        result = self.stiffness.times(x, transposed) + value * value * self.mass.times(x, transposed)
        return result + value * self.damping.times(x, transposed) if self.damping else result

    def derivative(self, value, x, transposed=False):
        result = 2 * value * self.mass.times(x, transposed)
        return result + self.damping.times(x, transposed) if self.damping else result

    def refine(self, guess):
        """The eigenvalue that a guess of many digits belongs to, and how much the last step moved it."""
        value = numpy.clongdouble(guess)
        random = numpy.random.default_rng(1)
        x, y = (random.standard_normal((2, len(self.mass.full))) + 0j).astype(numpy.clongdouble)
        inverse = numpy.linalg.inv(self.at(complex(value) * (1 + 1e-9)))
        for _ in range(3):  # nearest vectors, in double precision
            x = unit((inverse @ self.derivative(value, x).astype(complex)).astype(numpy.clongdouble))
            y = unit((inverse.T @ self.derivative(value, y, True).astype(complex)).astype(numpy.clongdouble))
        step = numpy.inf
        for _ in range(STEPS):
            right = self.residual(value, x)
            step = (y @ right) / (y @ self.derivative(value, x))
            value = value - step
            x = unit(x - (inverse @ self.residual(value, x).astype(complex)))
            y = unit(y - (inverse.T @ self.residual(value, y, True).astype(complex)))
        return value, abs(step)


def unit(x):
    return x / numpy.sqrt(numpy.sum(abs(x)**2))


def exact_values(pencil, guesses, stated):
    """Exact eigenvalues of the guesses with their stated errors. nan for one that belongs to a cluster or whose last step
    was not small beside what is stated: rounding in extended precision is 1 / 2048 of that in double."""
    values = []
    for guess, error in zip(guesses, stated):
        value, step = pencil.refine(guess)
        near = [other for other in guesses if abs(other - guess) < CLOSE * abs(guess)]
        good = len(near) == 1 and step < SMALL * error and abs(value - guess) < CLOSE * abs(guess)
        values.append(value if good else numpy.clongdouble(numpy.nan))
    return values
