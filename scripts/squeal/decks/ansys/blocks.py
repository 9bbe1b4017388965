"""Blocks of Ansys' archives: a header with commas, a format such as (3i9,6e21.13e3), lines in fixed columns, and an end."""

import re
from dataclasses import dataclass, field

import numpy

from ..deck import Place
from ..text import columns, matrix_of, real, whole

BLOCK = re.compile(rb"^[ \t]*(NBLOCK|EBLOCK|CMBLOCK|ETBLOCK|DBLOCK|FBLOCK)[ \t]*(?:,[^\n]*)?$", re.IGNORECASE | re.MULTILINE)
LAST = re.compile(rb"^[ \t]*-1[ \t]*$", re.MULTILINE)
END = {"NBLOCK": re.compile(rb"^[ \t]*(?:N[ \t]*,|-1[ \t]*$)[^\n]*", re.IGNORECASE | re.MULTILINE)}
NESTED = re.compile(r"(\d+)\(([^()]*)\)")
FIELD = re.compile(r"(\d*)p?([iagef])(\d+)(?:\.\d+)?(?:e\d+)?$")
DATABASE = re.compile(r"(R\d+\.\d+|UNBL)$", re.IGNORECASE)  # says that a command is of CDWRITE, and of which version


@dataclass
class Command:
    """A line with commas."""
    words: list
    place: Place
    lines: list = field(default_factory=list)  # of numbers that follow it

    def word(self, number):
        return self.words[number] if number < len(self.words) else ""

    def real(self, number, default=0.0):
        return real(self.word(number), self.place) if self.word(number) else default

    def whole(self, number, default=0):
        return whole(self.word(number), self.place) if self.word(number) else default

    def plain(self):
        """The words without the version of CDWRITE."""
        return [word for word in self.words if not DATABASE.match(word)]


def widths_of(text, place):
    """Kind and width of each field of a format."""
    if not (text.startswith("(") and text.endswith(")")):
        raise place.wrong(f"'{text[:40]}' is no format such as (3i9,6e21.13e3)")
    inside = NESTED.sub(lambda found: ",".join([found[2]] * min(int(found[1]), 40)), text[1:-1].replace(" ", "").lower())
    found = []
    for part in inside.split(","):
        field = FIELD.match(part)
        if not field or not (1 <= int(field[1] or 1) <= 40 and 1 <= int(field[3]) <= 40):
            raise place.wrong(f"format {text[:40]} is not read")
        found += [(field[2], int(field[3]))] * int(field[1] or 1)
    return found


@dataclass
class Blocked:
    """A block: its header, lines of data as (offsets in `data`, numbers), fields of the format."""
    header: Command
    data: bytes
    starts: numpy.ndarray  # offsets of all lines of the file
    first: int  # line of the first data, from 0
    n_lines: int
    fields: list  # (kind, width)

    @property
    def name(self):
        return self.header.words[0]

    @property
    def n_whole(self):
        """Fields of whole numbers at the beginning."""
        kinds = [kind for kind, _ in self.fields] + ["end"]
        return next(k for k, kind in enumerate(kinds) if kind != "i")

    def place(self, row):
        return Place(self.header.place.file, self.first + row + 1)

    def letters(self):
        """Lines as characters; none may be longer than the format."""
        rows = numpy.arange(self.first, self.first + self.n_lines)
        most = sum(width for _, width in self.fields)
        length = numpy.diff(self.starts)[rows] - 1
        found = matrix_of(self.data, self.starts, rows, max(int(length.max(initial=0)), most))
        beyond = (found[:, most:] != ord(" ")).any(axis=1)
        if beyond.any():
            raise self.place(int(beyond.argmax())).wrong(f"{self.name}: a line is longer than its format")
        return found[:, :most]

    def part(self, letters, first, last):
        """Characters of fields first to last - 1, all as wide as the widest, and this width."""
        ends = numpy.cumsum([0, *(width for _, width in self.fields)])
        most = max(width for _, width in self.fields[first:last])
        found = numpy.full((len(letters), last - first, most), ord(" "), numpy.uint8)
        for k in range(first, last):
            found[:, k - first, most - self.fields[k][1]:] = letters[:, ends[k]:ends[k + 1]]
        return found.reshape(len(letters), (last - first) * most), most

    def wholes(self, letters):
        part, width = self.part(letters, 0, self.n_whole)
        return columns(part, width, int, lambda row, _, word: whole(word, self.place(row)))

    def reals(self, letters):
        part, width = self.part(letters, self.n_whole, len(self.fields))
        return columns(part, width, float, lambda row, _, word: real(word, self.place(row)))

    def words(self, row, letters):
        """Fields of a line as text."""
        ends = numpy.cumsum([0, *(width for _, width in self.fields)])
        text = letters[row].tobytes().decode("latin-1")
        return [text[a:b].strip() for a, b in zip(ends, ends[1:])]


def read_block(path, data, starts, match):
    """The block of a header, and the offset behind it."""
    number = int(numpy.searchsorted(starts, match.start(), side="right")) - 1
    header = Command([word.strip() for word in match[0].decode("latin-1").partition("!")[0].split(",")], Place(str(path), number + 1))
    name = header.words[0] = header.words[0].upper()
    if number + 2 >= len(starts):
        raise header.place.wrong(f"{name} has no data: is the file cut off?")
    text = data[starts[number + 1]:starts[number + 2] - 1].decode("latin-1").partition("!")[0].strip()
    fields = widths_of(text, Place(str(path), number + 2))
    first = number + 2
    if name == "CMBLOCK":
        count = header.whole(3, -1)
        if count < 0:
            raise header.place.wrong("CMBLOCK needs the number of its items")
        last = first + -(-count // len(fields))
        if last >= len(starts):
            raise header.place.wrong(f"CMBLOCK announces {count} items, and the file ends before: is it cut off?")
        return Blocked(header, data, starts, first, last - first, fields), int(starts[last])
    end = END.get(name, LAST).search(data, starts[first] if first < len(starts) else len(data))
    if not end:
        raise header.place.wrong(f"{name} has no end (a line with -1): is the file cut off?")
    last = int(numpy.searchsorted(starts, end.start(), side="right")) - 1
    return Blocked(header, data, starts, first, last - first, fields), end.end()
