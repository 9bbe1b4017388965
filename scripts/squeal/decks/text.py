"""Files of text. Tables of numbers are read all at once; where that does not go, line by line, which is slow and tells the
line that is wrong."""

import re
import warnings

import numpy

from ..tables import BadInput, regular
from .deck import Place

WHOLE = re.compile(r"[+-]?\d{1,15}$")
REAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$")
NOTHING = b" \t\n\r\f\v+-"  # that a field without a number has
CONTROL = bytes(sorted({*range(32), 127} - set(b"\t\n\f\r")))
CHUNK = 200000  # lines that become a matrix of characters at once


def control_at(data):
    """Place of the first byte that no text has, or -1."""
    if len(data.translate(None, CONTROL)) == len(data):
        return -1
    return next(at for at, byte in enumerate(data) if byte in CONTROL)


def read_bytes(path):
    """Content of a file, with lines that end as Unix does."""
    try:
        data = regular(path).read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None
    data = data.removeprefix(b"\xef\xbb\xbf")  # the mark of UTF-8
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    at = control_at(data)
    if at >= 0:
        raise Place(str(path), data.count(b"\n", 0, at) + 1).wrong(f"the byte {data[at]} is no text")
    return data


def shorter(word):
    """The beginning of bytes, as text."""
    return word[:40].decode("latin-1")


def whole(text, place, what="a number"):
    """A whole number."""
    text = text.strip()
    if not WHOLE.match(text):
        raise place.wrong(f"'{text[:40]}' should be {what} (a whole one)")
    return int(text)


def real(text, place, what="a number"):
    """A finite number."""
    text = text.strip()
    if not REAL.match(text):
        raise place.wrong(f"'{text[:40]}' should be {what}")
    value = float(text.replace("D", "E").replace("d", "e"))
    if abs(value) > 1e300:
        raise place.wrong(f"{text[:40]} is too large")
    return value


def parse_all(flat, kind):
    """Numbers with commas between, or None where one is none. (numpy takes blanks for -1, and a sign alone for 0.)"""
    tight = flat.translate(None, NOTHING)
    if b",," in tight or tight[:1] in (b"", b",") or tight[-1:] == b",":
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = numpy.fromstring(flat, kind, sep=",")
        except (DeprecationWarning, ValueError):
            return None
    if kind == float and not numpy.isfinite(values).all():
        return None
    return values


def fast_table(text, first, width, kind):
    """Rows [n][width] and the line of each of lines with commas, the rows of which may go on over several lines that end
    with a comma; None where anything is unusual."""
    if b" \n" in text or b"\t\n" in text:
        text = re.sub(rb"[ \t]+\n", b"\n", text)
    if not text.endswith(b"\n"):
        text += b"\n"
    letters = numpy.frombuffer(text, numpy.uint8)
    ends = numpy.flatnonzero(letters == ord("\n"))
    if ends[0] == 0 or (numpy.diff(ends) == 1).any():
        return None
    trailing = letters[ends - 1] == ord(",")
    before = numpy.searchsorted(numpy.flatnonzero(letters == ord(",")), ends)
    fields = numpy.cumsum(numpy.diff(before, prepend=0) + 1 - trailing)
    values = parse_all(text.replace(b",\n", b"\n").replace(b"\n", b",")[:-1], kind)
    if values is None or len(values) != fields[-1] or len(values) % width:
        return None
    starts = numpy.arange(0, len(values), width)
    line = numpy.searchsorted(fields, starts, side="right")
    begins = numpy.concatenate([[0], fields])
    if (begins[line] != starts).any():
        return None
    goes_on = begins[1:] % width != 0
    if (goes_on & ~trailing).any():
        return None
    return values.reshape(-1, width), line + first


def slow_table(text, first, width, kind, file):
    """The same line by line; the first line that is wrong is an error."""
    rows, lines, row = [], [], []
    for number, line in enumerate(text.decode("latin-1").split("\n"), first):
        if not line.strip():
            continue
        place = Place(file, number)
        fields = line.split(",")
        goes_on = not fields[-1].strip()
        if goes_on:
            fields.pop()
        if not row:
            lines.append(number)
        row += [(whole if kind == int else real)(field or " ", place) for field in fields]
        if len(row) > width or (len(row) < width and not goes_on):
            raise place.wrong(f"{len(row)} numbers, expected {width}")
        if len(row) == width:
            rows.append(row)
            row = []
    if row:
        raise Place(file, lines[-1]).wrong(f"{len(row)} numbers and then no more, expected {width}")
    return numpy.array(rows, kind).reshape(-1, width), numpy.array(lines, int)


def table(pieces, width, kind, file):
    """Numbers [n][width] of pieces (text, first line), and their lines."""
    found = []
    for text, first in pieces:
        if text.strip():
            found.append(fast_table(text, first, width, kind) or slow_table(text, first, width, kind, file))
    if not found:
        return numpy.empty((0, width), kind), numpy.empty(0, int)
    return tuple(numpy.concatenate(parts) for parts in zip(*found))


def line_starts(data):
    """Offsets at which lines begin, and the end of the file."""
    ends = numpy.flatnonzero(numpy.frombuffer(data, numpy.uint8) == ord("\n"))
    starts = numpy.concatenate([[0], ends + 1])
    return starts if starts[-1] == len(data) else numpy.concatenate([starts, [len(data) + 1]])


def matrix_of(data, starts, rows, width):
    """Characters [n][width] of lines by their numbers from 0, blank behind their ends."""
    letters = numpy.frombuffer(data, numpy.uint8)
    found = numpy.full((len(rows), width), ord(" "), numpy.uint8)
    column = numpy.arange(width)
    for first in range(0, len(rows), CHUNK):
        chunk = rows[first:first + CHUNK]
        begin, length = starts[chunk], starts[chunk + 1] - starts[chunk] - 1
        inside = column < length[:, None]
        at = numpy.minimum(begin[:, None] + column, len(letters) - 1)
        found[first:first + CHUNK][inside] = letters[at[inside]]
    return found


def columns(matrix, width, kind, fail):
    """Numbers [n][k] in fields of `width` characters that stand side by side; blank ones are 0. Where one is none, `fail`
    gets row, column and text and returns the number, or raises the error."""
    n, k = len(matrix), matrix.shape[1] // width
    if not n or not k:
        return numpy.zeros((n, k), kind)
    fields = matrix[:, :k * width].reshape(n, k, width)
    joined = numpy.full((n, k, width + 1), ord(","), numpy.uint8)
    joined[:, :, :width] = fields
    joined[:, :, width - 1][(fields == ord(" ")).all(axis=2)] = ord("0")
    if kind == float:
        joined[(joined == ord("D")) | (joined == ord("d"))] = ord("E")
    values = parse_all(joined.tobytes()[:-1], kind)
    if values is not None and len(values) == n * k:
        return values.reshape(n, k)
    found = numpy.zeros((n, k), kind)
    words = numpy.ascontiguousarray(fields).view(f"S{width}")[:, :, 0]
    for row in range(n):
        for column in range(k):
            word = words[row, column].decode("latin-1").strip()
            found[row, column] = fail(row, column, word) if word else 0
    return found
