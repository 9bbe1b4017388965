"""OUTPUT4 of Nastran as binary: Fortran records between marks of their length, of either byte order, words of 4 or 8 bytes."""

import struct

import numpy

from ..tables import BadInput, regular
from .op4_columns import Columns, check_head, string_head


def is_binary(path):
    """By the mark of the first record, the head of a matrix."""
    with regular(path).open("rb") as stream:
        mark = stream.read(4)
    return mark in [struct.pack(order + "i", n) for order in "<>" for n in (24, 48)]


class Records:
    """Records of a file one after the other."""

    def __init__(self, path):
        self.path, self.data, self.at = path, path.read_bytes(), 0
        self.order = "<" if self.data[0] else ">"
        self.word = 4 if max(self.data[0], self.data[3]) == 24 else 8
        self.integer = numpy.dtype(f"{self.order}i{self.word}")

    def mark(self):
        """A mark of a length."""
        if self.at + 4 > len(self.data):
            raise BadInput(f"{self.path}: ends within a matrix; was it cut off?")
        self.at += 4
        return struct.unpack(self.order + "i", self.data[self.at - 4:self.at])[0]

    def next(self):
        """The bytes of a record."""
        n, first = self.mark(), self.at
        if n < 0 or first + n > len(self.data):
            raise BadInput(f"{self.path}: a record of {n} bytes at byte {first} goes beyond the end; was it cut off?")
        self.at += n
        if self.mark() != n:
            raise BadInput(f"{self.path}: a record at byte {first} has another length at its end than the {n} "
                           f"bytes of its head")
        return self.data[first:first + n]

    def integers(self, data, first, n):
        """n integers from word `first` on."""
        if (first + n) * self.word > len(data):
            raise BadInput(f"{self.path}: a record before byte {self.at} is too short")
        return [int(value) for value in numpy.frombuffer(data, self.integer, n, first * self.word)]

    def reals(self, data, first, words, kind):
        """Numbers of `words` words from word `first` on."""
        per = kind if self.word == 4 else 1
        if words < 1 or words % per or (first + words) * self.word > len(data):
            raise BadInput(f"{self.path}: {words} words of numbers do not fit a record before byte {self.at}")
        size = self.word * per
        return numpy.frombuffer(data, f"{self.order}f{size}", words // per, first * self.word).astype(float).tolist()


def read_binary(path):
    """Name, head and columns of each matrix."""
    records, found = Records(path), []
    while records.at < len(records.data):
        data = records.next()
        if len(data) != 6 * records.word:
            raise BadInput(f"{path}: the head of a matrix has {len(data)} bytes, not {6 * records.word}")
        head = records.integers(data, 0, 4)
        try:
            name = data[4 * records.word:].decode("ascii").replace("\0", " ").replace(" ", "")
        except UnicodeDecodeError:
            raise BadInput(f"{path}: the name of a matrix is no text") from None
        check_head(path, name, head)
        found.append(read_columns(records, name, head))
    return found


def read_columns(records, name, head):
    """All columns, and the record after the last one."""
    columns = Columns(records.path, name, head)
    while True:
        data = records.next()
        column, row, words = records.integers(data, 0, 3)
        if not columns.begin(column):
            return columns.result()
        if len(data) != (3 + words) * records.word:
            raise BadInput(f"{records.path}: {name}: column {column} of {words} words has a record of {len(data)} "
                           f"bytes")
        if row > 0:
            columns.add(row, records.reals(data, 3, words, head[3]))
        else:
            read_strings(records, columns, data, head)


def read_strings(records, columns, data, head):
    """The strings of a sparse column."""
    at, end = 3, len(data) // records.word
    while at < end:
        if head[1] < 0:
            length, row = records.integers(data, at, 2)
            length, at = length - 1, at + 2
        else:
            length, row = string_head(records.integers(data, at, 1)[0])
            at += 1
        columns.add(row, records.reals(data, at, length, head[3]))
        at += length
