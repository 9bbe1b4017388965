"""Matrices of Abaqus, *MATRIX GENERATE with *MATRIX OUTPUT: FORMAT=MATRIX INPUT has row node, direction, column node, direction
and value a line, of a symmetric matrix one triangle; FORMAT=COORDINATE row, column and value. Nodes with negative numbers are
Abaqus' own: Lagrange multipliers, generalised ones."""

import re

from ..tables import BadInput
from .entries import entries, labelled
from .text import integers, read_lines, table

NAMES = {"STIF": "K", "MASS": "M", "DMPV": "C", "DMPS": "S", "LOAD": None}


def name(path):
    """K, M, C of job_STIF1.mtx and its like, else the name of the file."""
    match = re.search(r"_(STIF|MASS|DMPV|DMPS|LOAD)\d*$", path.stem, re.IGNORECASE)
    if match and NAMES[match[1].upper()] is None:
        raise BadInput(f"{path}: holds loads, no matrix")
    return NAMES[match[1].upper()] if match else path.stem


def read(path):
    """The one matrix of a file."""
    lines, symmetry, body, first = read_lines(path), "half", [], 1
    for number, line in enumerate(lines, 1):
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            if body or not re.match(r"\*\s*MATRIX\s*INPUT\b", line, re.IGNORECASE):
                raise BadInput(f"{path}: line {number}: '{line.strip()[:40]}' is none of a matrix")
            kind = re.search(r"TYPE\s*=\s*(\w+)", line, re.IGNORECASE)
            symmetry = "general" if kind and kind[1].upper() == "UNSYMMETRIC" else "half"
            if re.search(r"SCALE\s*FACTOR|INPUT\s*=", line, re.IGNORECASE):
                raise BadInput(f"{path}: line {number}: scale factors and files in files are not imported")
            continue
        first = first if body else number
        body.append(line)
    if not body:
        raise BadInput(f"{path}: has no entries")
    width = len(body[0].replace(",", " ").split())
    if width not in (3, 5):
        raise BadInput(f"{path}: line {first}: {width} numbers; node, direction, node, direction, value or row, "
                       f"column, value belong there")
    rows = table(path, [line.rstrip().rstrip(",") for line in body], first, width, "," if "," in body[0] else None)
    return [(by_nodes if width == 5 else numbered)(path, rows, symmetry)]


def by_nodes(path, rows, symmetry):
    """Nodes and directions, sorted, are the unknowns."""
    node = integers(path, rows[:, [0, 2]], "node")
    direction = integers(path, rows[:, [1, 3]], "direction")
    if (direction < 0).any() or (direction > 99).any():
        raise BadInput(f"{path}: a direction is {direction.min() if (direction < 0).any() else direction.max()}")
    return labelled(name(path), path, node, direction, rows[:, 4], symmetry)


def numbered(path, rows, symmetry):
    """Numbers of the unknowns, from 1."""
    row, column = integers(path, rows[:, 0], "row"), integers(path, rows[:, 1], "column")
    if min(row.min(), column.min()) < 1:
        raise BadInput(f"{path}: a row or column is {min(row.min(), column.min())}: they count from 1; take "
                       f"FORMAT=MATRIX INPUT for nodes of Abaqus' own")
    n = int(max(row.max(), column.max()))
    return entries(name(path), path, (n, n), row - 1, column - 1, rows[:, 2], symmetry)
