"""OUTPUT4 of Nastran: dense and sparse (also BIGMAT) matrices, as text here and as binary records in op4_bytes.py. Reference: MSC
Nastran, DMAP Programmer's Guide, module OUTPUT4.

A column is dense, its first row above 0, or in strings, its first row 0. A string has a head, IS = row + 65536 (words + 1) or
with BIGMAT words + 1 and row; then its words, of double precision two a number. The column after the last one ends it."""

import re

from ..tables import BadInput
from .entries import entries
from .op4_bytes import is_binary, read_binary
from .op4_columns import FORMS, Columns, check_head, string_head
from .text import read_lines, real, whole


def read(path):
    """All matrices of a file."""
    try:
        found = read_binary(path) if is_binary(path) else Text(path).matrices()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None
    names = [name for name, *_ in found]
    for name in names:
        if names.count(name) > 1:
            raise BadInput(f"{path}: two matrices are named {name}")
    return [finish(path, *matrix) for matrix in found]


def finish(path, name, head, row, column, value):
    """Entries of one matrix; zeros of dense columns are left out."""
    columns, rows, form, kind = head
    some = [i for i, number in enumerate(value) if number != 0]
    one = entries(name, path, (abs(rows), columns), [row[i] for i in some], [column[i] for i in some], [value[i] for i in some],
                  FORMS[form])
    if form == 6 and (rows == columns or -rows == columns) and (one.matrix() != one.matrix().T).nnz:
        raise BadInput(f"{path}: {name} is said to be symmetric, and is not")
    return one


class Text:
    """A file of text."""

    def __init__(self, path):
        self.path, self.lines, self.at = path, read_lines(path), 0

    def line(self):
        """The next one."""
        if self.at >= len(self.lines):
            raise BadInput(f"{self.path}: ends within a matrix; was it cut off?")
        self.at += 1
        return self.lines[self.at - 1]

    def integers(self, line, n):
        """n integers of 8 characters."""
        if len(line.rstrip()) > 8 * n:
            raise BadInput(f"{self.path}: line {self.at}: '{line.strip()[:40]}' should be {n} whole numbers of 8 "
                           f"characters")
        return [whole(self.path, self.at, line[i:i + 8]) for i in range(0, 8 * n, 8)]

    def numbers(self, n):
        """n reals of the present format."""
        if not 0 < n <= self.limit:
            raise BadInput(f"{self.path}: line {self.at}: {n} numbers in a column of {self.limit}")
        values = []
        while len(values) < n:
            line, here = self.line().rstrip(), min(self.per, n - len(values))
            if len(line) > here * self.width:
                raise BadInput(f"{self.path}: line {self.at} is longer than {here} numbers of {self.width} "
                               f"characters")
            values += [real(self.path, self.at, line[i:i + self.width]) for i in range(0, here * self.width, self.width)]
        return values

    def matrices(self):
        """Name, head and columns of each."""
        found = []
        while self.at < len(self.lines) and any(line.strip() for line in self.lines[self.at:]):
            line = self.line()
            head = [whole(self.path, self.at, line[i:i + 8]) for i in range(0, 32, 8)]
            name, form = line[32:40].strip(), re.match(r"(?:1P,)?(\d+)[EDed](\d+)\.\d+$", line[40:].strip() or "5E16.9")
            check_head(self.path, name, head)
            if not form or not int(form[1]) or not int(form[2]):
                raise BadInput(f"{self.path}: line {self.at}: '{line[40:].strip()[:20]}' is no format of numbers")
            self.per, self.width, self.limit = int(form[1]), int(form[2]), abs(head[1])
            found.append(self.columns(name, head))
        if not found:
            raise BadInput(f"{self.path}: holds no matrix")
        return found

    def columns(self, name, head):
        """All columns, and the number that stands after the last one."""
        columns = Columns(self.path, name, head)
        while True:
            column, row, words = self.integers(self.line(), 3)
            if not columns.begin(column):
                if words != 1:
                    raise BadInput(f"{self.path}: line {self.at}: {words} words after the last column, not 1")
                self.numbers(1)
                return columns.result()
            if row > 0:
                columns.add(row, self.numbers(words))
            else:
                self.strings(columns, head, words)

    def strings(self, columns, head, words):
        """The strings of a sparse column."""
        per = head[3]  # words a number
        while words > 0:
            if head[1] < 0:
                length, row = self.integers(self.line(), 2)
                length, used = length - 1, length + 1
            else:
                length, row = string_head(whole(self.path, self.at + 1, self.line()))
                used = length + 1
            words -= used
            if length < per or length % per or words < 0:
                raise BadInput(f"{self.path}: line {self.at}: a string of {length} words does not fit its column")
            columns.add(row, self.numbers(length // per))
