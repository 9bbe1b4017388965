"""Matrix Market of the files of -operators_save: K, M, C, H sparse, symmetric where they are so to the last bit, and the loads
F; 17 digits, hence the same numbers. Reference: R. Boisvert, R. Pozo, K. Remington, The Matrix Market Exchange Formats, 1996."""

import numpy

from ..mesh.petsc_matrix import read_matrix, read_vector
from ..tables import BadInput, whole

MEANINGS = {"K": "stiffness, N/m", "M": "mass, kg", "C": "damping, N s/m", "H": "friction part per unit mu, N/m", "F": "loads, N"}


def is_symmetric(row, column, value):
    """Whether each entry has its equal across the diagonal."""
    order, across = numpy.lexsort((column, row)), numpy.lexsort((row, column))
    return all(numpy.array_equal(a[order], b[across]) for a, b in ((row, column), (column, row), (value, value)))


def write_rows(stream, form, *columns):
    """Rows of numbers, some thousands at a time."""
    for first in range(0, len(columns[0]), 4096):
        some = [column[first:first + 4096].tolist() for column in columns]
        stream.write(form * len(some[0]) % tuple(value for row in zip(*some) for value in row))


def write_matrix(path, matrix, comment):
    """A sparse matrix."""
    rows, columns, row, column, value = matrix
    symmetric = rows == columns and is_symmetric(row, column, value)
    kept = row >= column if symmetric else slice(None)
    row, column, value = row[kept] + 1, column[kept] + 1, value[kept]
    with whole(path) as temporary, temporary.open("w", encoding="ascii") as stream:
        stream.write(f"%%MatrixMarket matrix coordinate real {'symmetric' if symmetric else 'general'}\n% {comment}\n"
                     f"{rows} {columns} {len(value)}\n")
        write_rows(stream, "%d %d %.17g\n", row, column, value)


def write_vector(path, value, comment):
    """A vector, as a matrix of one column."""
    with whole(path) as temporary, temporary.open("w", encoding="ascii") as stream:
        stream.write(f"%%MatrixMarket matrix array real general\n% {comment}\n{len(value)} 1\n")
        write_rows(stream, "%.17g\n", value)


def write_matrices(folder, output):
    """Every matrix of a folder, and the loads; returns the files."""
    if not folder.is_dir():
        raise BadInput(f"{folder}: no such folder; name that of -operators_save")
    names = [name for name in MEANINGS if (folder / f"{name}.bin").is_file()]
    if not {"K", "M"} <= set(names):
        raise BadInput(f"{folder}: has no K.bin and M.bin, which squeal writes with -operators_save {folder}")
    read = {name: (read_vector if name == "F" else read_matrix)(folder / f"{name}.bin") for name in names}
    sizes = {name: len(matrix) if name == "F" else matrix[0] for name, matrix in read.items()}
    if len(set(sizes.values())) > 1:
        raise BadInput(f"{folder}: has matrices of several runs: rows {', '.join(f'{n} {size}' for n, size in sizes.items())}")
    output.mkdir(parents=True, exist_ok=True)
    for name, matrix in read.items():
        (write_vector if name == "F" else write_matrix)(output / f"{name}.mtx", matrix, f"{name} of squeal: {MEANINGS[name]}")
    return [output / f"{name}.mtx" for name in names]
