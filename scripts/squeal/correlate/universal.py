"""Universal files: datasets between lines of -1, text in fixed columns, or binary numbers behind eleven lines of text (58b). What is
damaged raises BadInput with the line, or the byte of a binary block. Reference: SDRC universal file formats, as the University of
Cincinnati lists them."""

import re
from typing import NamedTuple

import numpy

from ..tables import BadInput, printable, regular

MARK = b"-1"
TITLES = 5  # lines of free text at the head of datasets 55, 58 and, behind three others, 2414, which may hold anything
HEAD_58 = 11  # lines before the numbers of dataset 58
FREE = {55: TITLES, 58: TITLES, 2414: 3 + TITLES}
TOUCHING = re.compile(rb"(?<=[0-9.])(?=[-+])")  # numbers that fill their columns: -1.5E+00-2.5E+00
FORTRAN = bytes.maketrans(b"dD", b"EE")
BINARY = re.compile(rb"\s*58b\s+(\d+)\s+(\d+)\s+(\d+)\s+(\d+)(?:\s+\d+)*\s*", re.IGNORECASE)
ASCII = re.compile(rb"\s*(\d+)\s*")
LONGEST = 2000  # letters of a line of text


class Dataset(NamedTuple):
    """Its number, the number of its first line behind that, its lines; `raw`: binary numbers, and how they are stored."""
    number: int
    line: int
    lines: list
    raw: bytes | None = None
    kind: tuple = ()
    at: int = 0  # byte of the raw numbers


class Cursor:
    """Lines of a file, with the number of each, and the byte that is next."""

    def __init__(self, path):
        if not path.exists():
            raise BadInput(f"{path}: no such file")
        self.path, self.data, self.at, self.line = path, regular(path).read_bytes(), 0, 0

    def wrong(self, what, line=None):
        """The error to raise."""
        return BadInput(f"{self.path}:{self.line if line is None else line}: {what}")

    def more(self):
        """Whether there is a line."""
        return self.at < len(self.data)

    def next(self, of):
        """The next line, without its end."""
        if not self.more():
            raise self.wrong(f"the file ends within {of}; was it cut off?")
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        found, self.at, self.line = self.data[self.at:end].rstrip(b"\r"), end + 1, self.line + 1
        if len(found) > LONGEST:
            raise self.wrong(f"a line of {len(found)} bytes; is this a universal file?")
        return found


def shown(text):
    """The begin of a line, for an error."""
    return "'" + printable(text.decode("utf-8", "replace").strip()[:40]) + "'"


def words(line):
    """A title."""
    return printable(line.decode("utf-8", "replace").strip())


def raw_block(cursor, head, first):
    """A dataset 58b: eleven lines, so many bytes, the mark."""
    order, form, n_lines, n_bytes = (int(head[i]) for i in range(1, 5))
    if order not in (1, 2) or form != 2:
        raise cursor.wrong(f"dataset 58b with byte order {order} and floating format {form}: read are orders 1 and 2 of format 2 (IEEE)")
    if n_lines != HEAD_58:
        raise cursor.wrong(f"dataset 58b with {n_lines} lines of text: it has {HEAD_58}")
    lines = [cursor.next("the text of dataset 58b") for _ in range(HEAD_58)]
    begin = cursor.at
    raw = cursor.data[begin:begin + n_bytes]
    if len(raw) < n_bytes:
        raise cursor.wrong(f"byte {begin}: dataset 58b states {n_bytes} bytes, the file has {len(raw)}; was it cut off?")
    cursor.at = begin + n_bytes
    closing = re.match(rb"[ \r\n]*-1[ \r]*(\n|$)", cursor.data[cursor.at:cursor.at + LONGEST])
    if not closing:
        raise cursor.wrong(f"byte {cursor.at}: behind the {n_bytes} bytes of dataset 58b there is no -1; are there more or fewer?")
    cursor.at += closing.end()
    cursor.line += 1 + raw.count(b"\n") + closing[0].count(b"\n")
    return Dataset(58, first, lines, raw, ("<" if order == 1 else ">",), begin)


def text_block(cursor, number, first):
    """A dataset of text: all lines to the mark."""
    lines = [cursor.next(f"dataset {number}") for _ in range(FREE.get(number, 0))]
    for i, line in enumerate(lines[:-1]):
        if line.strip() == MARK and lines[i + 1].strip() == MARK:
            raise cursor.wrong(f"dataset {number} ends within its titles", first + i)
    while (line := cursor.next(f"dataset {number}, which begins at line {first}")).strip() != MARK:
        lines.append(line)
    return Dataset(number, first, lines)


def datasets(path):
    """All datasets of a file, one after the other."""
    cursor, found = Cursor(path), 0
    while cursor.more():
        whole = cursor.next("it")
        line = whole.strip(b" \t\r\x00\x1a")
        if not line and set(whole) == set(b" ") and cursor.at > len(cursor.data):
            raise cursor.wrong("the file ends within a line; was it cut off?")
        if not line:
            continue
        if line != MARK:
            raise cursor.wrong(f"{shown(line)} stands outside of the datasets, which begin and end with -1"
                               + ("" if found else "; is this a universal file?"))
        head = cursor.next("the head of a dataset")
        found += 1
        if binary := BINARY.fullmatch(head):
            yield raw_block(cursor, binary, cursor.line + 1)
        elif plain := ASCII.fullmatch(head):
            yield text_block(cursor, int(plain[1]), cursor.line + 1)
        else:
            raise cursor.wrong(f"{shown(head)} is no number of a dataset")
    if not found:
        raise BadInput(f"{path}: has no dataset; is it a universal file?")


def integers(line, n=None):
    """Whole numbers of a line in columns of ten; None where it has others, or not n."""
    words = line.split()
    try:
        found = [int(word) for word in words]
    except ValueError:
        return None
    return found if n is None or len(found) == n else None


def reals(text):
    """Numbers of text whose columns may touch; None where one is none, or not finite."""
    words = TOUCHING.sub(b" ", text.translate(FORTRAN)).split()
    try:
        found = numpy.array(words, dtype="S").astype(float) if words else numpy.empty(0)
    except ValueError:
        return None
    return found if numpy.isfinite(found).all() else None
