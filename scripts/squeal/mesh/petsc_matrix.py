"""Matrices and vectors in PETSc's binary form, as MatLoad() and squeal read them: big-endian, integers of 4 bytes, reals of 8."""

import os

import numpy

from ..tables import BadInput, regular

CLASS, VECTOR = 1211216, 1211214  # MAT_FILE_CLASSID, VEC_FILE_CLASSID
LARGEST = 1e60  # squeal refuses larger entries, whose products overflow


def check(matrix, what):
    """Raises BadInput for a matrix that squeal would refuse."""
    if matrix.nnz and not numpy.isfinite(matrix.data).all():
        raise BadInput(f"{what}: an entry is not finite")
    if matrix.nnz and abs(matrix.data).max() > LARGEST:
        raise BadInput(f"{what}: an entry is {abs(matrix.data).max():g}: numbers must be of at most {LARGEST:g}")
    if min(matrix.shape) < 1 or matrix.nnz > 2**31 - 1:
        raise BadInput(f"{what}: a matrix of {matrix.shape[0]} x {matrix.shape[1]} with {matrix.nnz} entries is none")


def write_matrix(path, matrix):
    """Writes a scipy sparse matrix under a temporary name, then renames it."""
    matrix = matrix.tocsr()
    matrix.sum_duplicates()
    matrix.sort_indices()
    check(matrix, path)
    part = path.with_name(path.name + ".part")
    head = numpy.array([CLASS, *matrix.shape, matrix.nnz])
    with part.open("wb") as out:
        for numbers, kind in ((head, ">i4"), (numpy.diff(matrix.indptr), ">i4"), (matrix.indices, ">i4"), (matrix.data, ">f8")):
            numbers.astype(kind).tofile(out)
    os.replace(part, path)


def read_words(path):
    """The bytes of a file, and its first four words, as far as it has them."""
    data = regular(path).read_bytes()
    return data, numpy.frombuffer(data[:min(16, len(data) // 4 * 4)], ">i4")


def read_matrix(path):
    """Rows, columns of a sparse matrix, and row, column and value of each entry, row by row."""
    data, head = read_words(path)
    if len(head) < 4 or head[0] != CLASS or min(head[1:]) < 0:
        raise BadInput(f"{path}: is no sparse matrix in PETSc's binary form; see -operators_save")
    rows, columns, n = map(int, head[1:])
    if len(data) != 16 + 4 * rows + 12 * n:
        raise BadInput(f"{path}: has {len(data)} bytes, where {16 + 4 * rows + 12 * n} would hold its {n} entries")
    count = numpy.frombuffer(data, ">i4", rows, 16)
    column = numpy.frombuffer(data, ">i4", n, 16 + 4 * rows).astype(numpy.int64)
    value = numpy.frombuffer(data, ">f8", n, 16 + 4 * (rows + n)).astype(float)
    if (count < 0).any() or count.sum() != n or (n and not 0 <= column.min() <= column.max() < columns):
        raise BadInput(f"{path}: rows and columns of its entries are not those of its head; was the file damaged?")
    return rows, columns, numpy.repeat(numpy.arange(rows), count), column, finite(path, value)


def read_vector(path):
    """Values of a vector."""
    data, head = read_words(path)
    if len(head) < 2 or head[0] != VECTOR or len(data) != 8 + 8 * int(head[1]):
        raise BadInput(f"{path}: is no vector in PETSc's binary form; see -operators_save")
    return finite(path, numpy.frombuffer(data, ">f8", int(head[1]), 8).astype(float))


def finite(path, value):
    """Values, if all are numbers."""
    if not numpy.isfinite(value).all():
        raise BadInput(f"{path}: entry {int(numpy.argmin(numpy.isfinite(value)))} is not finite")
    return value
