"""Matrices of CalculiX, *FREQUENCY, SOLVER=MATRIXSTORAGE: JOB.sti and JOB.mas have row, column and value of the upper triangle,
column by column with every diagonal entry; line i of JOB.dof is unknown i as node.direction."""

import numpy

from ..tables import BadInput
from .entries import entries
from .text import integers, read_lines, table, whole

NAMES = {".sti": "K", ".mas": "M"}


def read_labels(path):
    """Node and direction of each unknown."""
    labels = []
    for number, line in enumerate(read_lines(path), 1):
        words = line.strip().split(".")
        if len(words) != 2:
            raise BadInput(f"{path}: line {number}: '{line.strip()[:30]}' is no node.direction")
        labels.append((whole(path, number, words[0]), whole(path, number, words[1])))
        if not 0 <= labels[-1][1] <= 6 or labels[-1][0] < 1:
            raise BadInput(f"{path}: line {number}: '{line.strip()[:30]}' is no node.direction")
    if len(set(labels)) != len(labels):
        raise BadInput(f"{path}: an unknown stands twice")
    return labels


def read(path):
    """The one matrix of a file."""
    lines = read_lines(path)
    rows = table(path, lines, 1, 3)
    dofs = path.with_suffix(".dof")
    labels = read_labels(dofs) if dofs.exists() else None
    row, column = integers(path, rows[:, 0], "row"), integers(path, rows[:, 1], "column")
    n = len(labels) if labels else int(max(row.max(initial=0), column.max(initial=0)))
    if not len(row):
        raise BadInput(f"{path}: has no entries")
    if not numpy.array_equal(numpy.unique(row[row == column]), numpy.arange(1, n + 1)):
        raise BadInput(f"{path}: its diagonal has not one entry for each of {n} "
                       f"unknowns{f', those of {dofs.name}' if labels else ''}; was it cut off?")
    if (row > column).any():
        raise BadInput(f"{path}: line {int((row > column).argmax()) + 1}: an entry below the diagonal; the upper "
                       f"triangle is stored")
    return [entries(NAMES[path.suffix.lower()], path, (n, n), row - 1, column - 1, rows[:, 2], "symmetric", labels)]
