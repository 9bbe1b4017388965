"""Matrices in PETSc's binary form, as MatLoad() and squeal read them: big-endian, integers of 4 bytes, reals of 8."""

import os

import numpy

from squeal.tables import BadInput

CLASS = 1211216  # MAT_FILE_CLASSID
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
