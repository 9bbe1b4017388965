"""Eigenvalues of sparse matrices far below double precision: two-sided Rayleigh quotients with residuals in extended precision (64
bits of mantissa); the vectors by inverse iteration with a sparse LU in double precision. Matrices are those of `-operators_save`, as
squeal solves them."""

import numpy
import scipy.sparse
import scipy.sparse.linalg

from ..mesh.petsc_matrix import read_matrix

STEPS = 3
SMALL = 1e-14  # last step, relative
BESIDE = 0.01  # the same beside the stated error
CLOSE = 1e-6  # relative distance of eigenvalues whose vectors mean little one by one


def unit(x):
    return x / numpy.sqrt(numpy.sum(abs(x)**2))


def sparse(path):
    """A matrix of a PETSc binary file."""
    rows, columns, row, column, value = read_matrix(path)
    return scipy.sparse.csr_matrix((value, (row, column)), shape=(rows, columns))


class Product:
    """Products with a matrix and its transpose in extended precision."""

    def __init__(self, matrix):
        self.ways = {}
        for transposed, form in ((False, matrix.tocsr()), (True, matrix.T.tocsr())):
            form.sort_indices()
            filled = numpy.flatnonzero(numpy.diff(form.indptr))
            self.ways[transposed] = filled, form.indptr[filled], form.indices, form.data.astype(numpy.longdouble)

    def times(self, x, transposed=False):
        filled, first, column, value = self.ways[transposed]
        result = numpy.zeros(len(x), numpy.clongdouble)
        result[filled] = numpy.add.reduceat(value * x[column], first)
        return result


class Pencil:
    """lambda^2 M + lambda C + K of a folder of -operators_save, with friction mu H."""

    def __init__(self, folder, mu=0.0):
        parts = {name: sparse(folder / f"{name}.bin") for name in "KMCH" if (folder / f"{name}.bin").exists()}
        self.k = parts["K"] + mu * parts["H"] if "H" in parts else parts["K"]
        self.m = parts["M"]
        self.c = parts.get("C", scipy.sparse.csr_matrix(self.m.shape))
        self.products = [Product(matrix) for matrix in (self.k, self.c, self.m)]

    def apply(self, factors, x, transposed=False):
        """Sum of factor times matrix times x, over K, C, M."""
        return sum(factor * product.times(x, transposed) for factor, product in zip(factors, self.products) if factor != 0)

    def refine(self, guess):
        """The eigenvalue near a guess of many digits, and how much the last step moved it, in extended precision."""
        value = numpy.clongdouble(guess)
        near = complex(guess) * (1 + 1e-10)
        lu = scipy.sparse.linalg.splu((self.k + near * self.c + near * near * self.m).astype(complex).tocsc())
        random = numpy.random.default_rng(1)
        x, y = (unit((random.standard_normal(self.m.shape[0]) + 0j).astype(numpy.clongdouble)) for _ in range(2))
        for _ in range(4):
            slope = 0, 1, 2 * value
            x = unit(lu.solve(self.apply(slope, x).astype(complex)).astype(numpy.clongdouble))
            y = unit(lu.solve(self.apply(slope, y, True).astype(complex), trans="T").astype(numpy.clongdouble))
        step = numpy.inf
        for _ in range(STEPS):
            step = (y @ self.apply((1, value, value * value), x)) / (y @ self.apply((0, 1, 2 * value), x))
            value = value - step
            all_parts = 1, value, value * value
            x = unit(x - lu.solve(self.apply(all_parts, x).astype(complex)))
            y = unit(y - lu.solve(self.apply(all_parts, y, True).astype(complex), trans="T"))
        return value, abs(step)


def refined(folder, mu, guesses):
    """Exact eigenvalues near guesses; the distance of those that are not (a double one, a guess without digits) is nan."""
    pencil = Pencil(folder, mu)
    return numpy.array([complex(value) if step < SMALL * abs(value) else numpy.nan
                        for value, step in map(pencil.refine, guesses)])


def exact_values(pencil, guesses, stated):
    """Exact eigenvalues of the guesses with their stated errors, in extended precision. nan for one that belongs to a cluster or
    whose last step was not small beside what is stated: rounding in extended precision is 1 / 2048 of that in double."""
    values = []
    for guess, error in zip(guesses, stated):
        value, step = pencil.refine(guess)
        near = [other for other in guesses if abs(other - guess) < CLOSE * abs(guess)]
        good = len(near) == 1 and step < BESIDE * error and abs(value - guess) < CLOSE * abs(guess)
        values.append(value if good else numpy.clongdouble(numpy.nan))
    return values
