"""Matrices of OUTPUT4, text or binary: their heads, and the columns that are collected."""

import re

from ..tables import BadInput
from .entries import LARGEST

FORMS = {1: "general", 2: "general", 6: "half"}  # square, rectangular, symmetric


def check_head(path, name, head):
    """Raises BadInput for what is no real matrix."""
    columns, rows, form, kind = head
    if not re.match(r"[A-Za-z]\w*$", name):
        raise BadInput(f"{path}: '{name[:20]}' is no name of a matrix")
    if not 1 <= columns <= 10**8 or not 1 <= abs(rows) <= 10**8:
        raise BadInput(f"{path}: {name} of {abs(rows)} x {columns} is none")
    if kind in (3, 4):
        raise BadInput(f"{path}: {name} is complex; real matrices can be imported")
    if form not in FORMS or kind not in (1, 2):
        raise BadInput(f"{path}: {name} is of form {form}, type {kind}; square and symmetric real ones (forms 1, "
                       f"2, 6, types 1, 2) can be imported")


class Columns:
    """Collects the columns of a matrix, and checks them."""

    def __init__(self, path, name, head):
        self.path, self.name, self.head, self.last = path, name, head, 0
        self.row, self.column, self.value = [], [], []

    def begin(self, column):
        """Whether there is such a column; one after the last ends the matrix."""
        if column <= self.last or column > self.head[0] + 1:
            raise BadInput(f"{self.path}: {self.name}: column {column} after column {self.last} of {self.head[0]}")
        self.last, self.next = column, 1
        return column <= self.head[0]

    def add(self, row, values):
        """Consecutive values of the present column."""
        if row < self.next or not len(values) or row + len(values) - 1 > abs(self.head[1]):
            raise BadInput(f"{self.path}: {self.name}: rows {row} to {row + len(values) - 1} of column "
                           f"{self.last} do not follow in a matrix of {abs(self.head[1])} rows")
        self.next = row + len(values)
        self.row += range(row - 1, row - 1 + len(values))
        self.column += [self.last - 1] * len(values)
        self.value += values
        if not all(abs(value) <= LARGEST for value in values):
            raise BadInput(f"{self.path}: {self.name}: a value of column {self.last} is not finite, or too large")

    def result(self):
        """As finish() takes it."""
        return self.name, self.head, self.row, self.column, self.value


def string_head(word):
    """Words and first row of a string without BIGMAT."""
    words = (word >> 16) - 1
    return words, word - ((words + 1) << 16)
