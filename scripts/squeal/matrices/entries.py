"""What a reader returns: the entries of a matrix, and what its unknowns are called."""

from dataclasses import dataclass, field

import numpy
import scipy.sparse

from ..tables import BadInput

MAX_ROWS = 100_000_000  # as squeal
LARGEST = 1e60  # larger entries are refused there, whose products overflow


@dataclass
class Entries:
    """Rows and columns count from 0."""

    name: str
    path: object
    shape: tuple
    row: numpy.ndarray
    column: numpy.ndarray
    value: numpy.ndarray
    labels: list = None  # of each unknown (node, direction), where the file tells
    how: str = ""  # in words, what was made of its storage
    kind: str = None  # stiffness, mass, damping, or "" for none of these; None: the name tells
    scale: float = 1.0  # of the term
    chosen: bool = True  # False: the file names others
    beside: list = field(default_factory=list)  # lines about what else the file holds

    def matrix(self):
        """As scipy has it."""
        return scipy.sparse.csr_matrix((self.value, (self.row, self.column)), shape=self.shape)


def entries(name, path, shape, row, column, value, symmetry="general", labels=None):
    """Checked, and symmetric or skew storage expanded; symmetry: general, symmetric, skew, or half, which is symmetric where no
    entry has one across the diagonal."""
    rows, columns = (int(n) for n in shape)
    row, column, value = numpy.asarray(row, numpy.int64), numpy.asarray(column, numpy.int64), numpy.asarray(value, float)
    check_places(path, (rows, columns), row, column, value)
    check_values(path, row, column, value)
    check_once(path, columns, row, column)
    how = ""
    if symmetry == "half":
        symmetry = symmetry_of_half(columns, row, column)
        how = "half of a symmetric matrix, expanded" if symmetry == "symmetric" else ""
    if symmetry in ("symmetric", "skew"):
        row, column, value = mirrored(path, (rows, columns), row, column, value, symmetry)
        how = how or f"half of a {symmetry} matrix, expanded"
    return Entries(name, path, (rows, columns), row, column, value, labels, how)


def labelled(name, path, node, direction, value, symmetry):
    """Entries between unknowns: node [n][2] and direction [n][2] of rows and columns; the unknowns are sorted by these."""
    labels, index = numpy.unique(numpy.stack([node.T.ravel(), direction.T.ravel()], 1), axis=0, return_inverse=True)
    row, column = index.reshape(2, -1)
    return entries(name, path, (len(labels),) * 2, row, column, value, symmetry, [tuple(map(int, label)) for label in labels])


def check_places(path, shape, row, column, value):
    """Raises BadInput for a shape that is none, and for entries outside of it."""
    rows, columns = shape
    if not 1 <= rows <= MAX_ROWS or not 1 <= columns <= MAX_ROWS:
        raise BadInput(f"{path}: a matrix of {rows} x {columns} is none")
    if not len(row) == len(column) == len(value):
        raise BadInput(f"{path}: {len(row)} rows, {len(column)} columns and {len(value)} values are not as many "
                       f"of each")
    outside = (row < 0) | (row >= rows) | (column < 0) | (column >= columns)
    if outside.any():
        at = int(outside.argmax())
        raise BadInput(f"{path}: entry ({row[at] + 1}, {column[at] + 1}) lies outside of a matrix of {rows} x "
                       f"{columns}")


def check_values(path, row, column, value):
    """Raises BadInput for an entry that is no number, or too large a one."""
    bad = ~(abs(value) <= LARGEST)
    if bad.any():
        at = int(bad.argmax())
        raise BadInput(f"{path}: entry ({row[at] + 1}, {column[at] + 1}) is {value[at]:g}: numbers must be of at "
                       f"most {LARGEST:g}")


def symmetry_of_half(columns, row, column):
    """General where some entry has one across the diagonal, or none lies off it."""
    off = row != column
    across = numpy.isin(row[off] * columns + column[off], column[off] * columns + row[off]).any()
    return "general" if across or not off.any() else "symmetric"


def check_once(path, columns, row, column):
    """Raises BadInput for an entry that stands twice."""
    key = numpy.sort(row * columns + column)
    twice = key[1:][key[1:] == key[:-1]]
    if len(twice):
        raise BadInput(f"{path}: entry ({twice[0] // columns + 1}, {twice[0] % columns + 1}) stands twice")


def mirrored(path, shape, row, column, value, symmetry):
    """With the other triangle."""
    if shape[0] != shape[1]:
        raise BadInput(f"{path}: a {symmetry} matrix of {shape[0]} x {shape[1]} is none")
    off = row != column
    twice = numpy.isin(row[off] * shape[1] + column[off], column[off] * shape[1] + row[off])
    if twice.any():
        at = int(twice.argmax())
        raise BadInput(f"{path}: a {symmetry} matrix has entry ({row[off][at] + 1}, {column[off][at] + 1}) on "
                       f"both sides of the diagonal")
    if symmetry == "skew" and value[~off].any():
        raise BadInput(f"{path}: a skew matrix has entries on its diagonal")
    sign = -1 if symmetry == "skew" else 1
    return (numpy.concatenate([row, column[off]]), numpy.concatenate([column, row[off]]),
            numpy.concatenate([value, sign * value[off]]))
