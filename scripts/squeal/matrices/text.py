"""Files of numbers as text."""

import math
import re
import warnings

import numpy

from ..decks.text import control_at
from ..tables import BadInput, regular

REAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+|[+-]\d+)?$")  # Fortran may leave out the E
WHOLE = re.compile(r"[+-]?\d{1,15}$")


def read_lines(path):
    """Lines of a file of text."""
    try:
        data = regular(path).read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None
    try:
        text = data.decode("ascii")
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: byte {error.start} is no text") from None
    at = control_at(data)
    if at >= 0:
        raise BadInput(f"{path}: byte {at} is no text")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if lines[-1]:
        raise BadInput(f"{path}: its last line has no end; was it cut off?")
    return lines[:-1]


def whole(path, number, text):
    """A whole number of line `number`."""
    if not WHOLE.match(text.strip()):
        raise BadInput(f"{path}: line {number}: '{text.strip()[:30]}' is no whole number")
    return int(text)


def real(path, number, text):
    """A finite number of line `number`, as Fortran writes it too."""
    match = REAL.match(text.strip())
    if not match:
        raise BadInput(f"{path}: line {number}: '{text.strip()[:30]}' is no number")
    part = match[2] or ""
    value = float(match[1] + ("e" + part.lstrip("eEdD") if part else ""))
    if not math.isfinite(value):
        raise BadInput(f"{path}: line {number}: {text.strip()[:30]} is too large")
    return -value if text.strip().startswith("-") else value


def table(path, lines, first, width, separator=None):
    """Lines of `width` numbers as an array; `first` is the number of the first line in the file."""
    if not lines:
        return numpy.empty((0, width))
    text = " ".join(lines) if separator is None else separator.join(lines)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = numpy.fromstring(text, float, sep=" " if separator is None else separator)
            widths = {line.count(separator) + 1 if separator else len(line.split()) for line in lines}
            if values.size == width * len(lines) and widths == {width} and numpy.isfinite(values).all():
                return values.reshape(-1, width)
        except (DeprecationWarning, ValueError):
            pass
    rows = []
    for number, line in enumerate(lines, first):  # slow, and tells the line that is wrong
        words = line.split(separator)
        if len(words) != width:
            raise BadInput(f"{path}: line {number}: {len(words)} numbers, not {width}")
        rows.append([real(path, number, word) for word in words])
    return numpy.array(rows)


def integers(path, values, what):
    """Numbers that must be whole ones."""
    values = numpy.asarray(values)
    if values.size and not ((values == numpy.rint(values)) & (abs(values) < 1e15)).all():
        raise BadInput(f"{path}: a {what} is no whole number")
    return values.astype(numpy.int64)
