"""Matrix Market. Reference: R. Boisvert, R. Pozo, K. Remington, The Matrix Market Exchange Formats, 1996."""

import numpy

from ..tables import BadInput, regular
from .entries import entries
from .text import integers, read_lines, table, whole

SYMMETRIES = {"general": "general", "symmetric": "symmetric", "skew-symmetric": "skew"}


def is_market(path):
    """By its first bytes."""
    with regular(path).open("rb") as stream:
        return stream.read(14).lower() == b"%%matrixmarket"


def read(path):
    """The one matrix of a file."""
    lines = read_lines(path)
    words = (lines[0].lower().split() if lines else [])
    if len(words) != 5 or words[:2] != ["%%matrixmarket", "matrix"] or words[2] not in ("coordinate", "array"):
        raise BadInput(f"{path}: line 1 should be %%MatrixMarket matrix, coordinate or array, a field and a symmetry")
    form, field, symmetry = words[2:]
    if field not in ("real", "integer", "double"):
        raise BadInput(f"{path}: its field is {field}; real and integer can be imported")
    if symmetry not in SYMMETRIES:
        raise BadInput(f"{path}: its symmetry is {symmetry}; it must be one of {', '.join(SYMMETRIES)}")
    kept = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("%")]
    if not kept:
        raise BadInput(f"{path}: has no line with its size")
    number, head = kept[0]
    size = [whole(path, number, word) for word in head.split()]
    if len(size) != (3 if form == "coordinate" else 2):
        raise BadInput(f"{path}: line {number}: '{head.strip()[:30]}' is no size")
    body, first = [line for _, line in kept[1:]], kept[1][0] if len(kept) > 1 else number
    return [(coordinate if form == "coordinate" else array)(path, size, body, first, SYMMETRIES[symmetry])]


def coordinate(path, size, body, first, symmetry):
    """Row, column and value a line."""
    if len(body) != size[2]:
        raise BadInput(f"{path}: {len(body)} entries, its size says {size[2]}")
    rows = table(path, body, first, 3)
    row, column = integers(path, rows[:, 0], "row") - 1, integers(path, rows[:, 1], "column") - 1
    if symmetry != "general" and (row < column).any():
        raise BadInput(f"{path}: a symmetric or skew matrix has an entry above the diagonal")
    return entries(path.stem, path, size[:2], row, column, rows[:, 2], symmetry)


def array(path, size, body, first, symmetry):
    """All values column by column; of a symmetric matrix those on and below the diagonal."""
    n, m = size
    if not 0 < n * m <= 10**8:
        raise BadInput(f"{path}: an array of {n} x {m} is none, or too large")
    column, row = numpy.divmod(numpy.arange(n * m), n)
    keep = row >= column + (symmetry == "skew") if symmetry != "general" else numpy.ones(n * m, bool)
    if len(body) != keep.sum():
        raise BadInput(f"{path}: {len(body)} values, its size asks for {keep.sum()}")
    value = table(path, body, first, 1)[:, 0]
    row, column = row[keep], column[keep]
    some = value != 0
    return entries(path.stem, path, (n, m), row[some], column[some], value[some], symmetry)
