"""Harwell-Boeing as Ansys writes it (*HBMAT): real assembled matrices, symmetric (RSA), unsymmetric (RUA, RRA) or skew (RZA), and
the mapping of its equations. Reference: I. S. Duff, R. G. Grimes, J. G. Lewis, Users' Guide for the Harwell-Boeing Sparse
Matrix Collection, 1992."""

import re

import numpy

from ..tables import BadInput
from .entries import entries
from .text import read_lines, real, whole

FORM = re.compile(r"\(\s*(?:\d*P\s*,?\s*)?(\d*)\s*([IEDFG])\s*(\d+)(?:\.\d+)?(?:E\d+)?\s*\)$", re.IGNORECASE)
SYMMETRIES = {"S": "symmetric", "U": "general", "R": "general", "Z": "skew"}
DIRECTIONS = {"UX": 1, "UY": 2, "UZ": 3, "ROTX": 4, "ROTY": 5, "ROTZ": 6}


def read(path):
    """The one matrix of a file."""
    lines = read_lines(path)
    if len(lines) < 5:
        raise BadInput(f"{path}: has {len(lines)} lines, too few for Harwell-Boeing")
    cards = [whole(path, 2, lines[1][i:i + 14]) if lines[1][i:i + 14].strip() else 0 for i in range(0, 70, 14)]
    kind, size = lines[2][:3].upper(), [whole(path, 3, lines[2][i:i + 14] or "0") for i in (14, 28, 42)]
    if not re.match("[RCPI][SUHZR][AE]$", kind):
        raise BadInput(f"{path}: line 3: '{kind}' is no type of a Harwell-Boeing matrix")
    if kind[0] != "R" or kind[1] not in SYMMETRIES or kind[2] != "A":
        raise BadInput(f"{path}: is of type {kind}; RSA, RUA, RRA and RZA can be imported")
    n, m, count = size
    if min(size) < 0 or n > 10**8 or count > 2**31 - 1:
        raise BadInput(f"{path}: line 3: {n} x {m} with {count} entries is no matrix")
    first = 4 + (cards[4] > 0)
    if cards[0] != sum(cards[1:]) or len(lines) != first + cards[0]:
        raise BadInput(f"{path}: {len(lines) - first} lines of data, its head says {cards[0]} of {sum(cards[1:])}")
    starts = first + numpy.cumsum([0, *cards[1:4]])
    forms = [lines[3][0:16], lines[3][16:32], lines[3][32:52]]
    pointer, index, value = (field(path, lines, starts[i], starts[i + 1], forms[i], i < 2, (m + 1, count, count)[i]) for i in range(3))
    if pointer[0] != 1 or pointer[-1] != count + 1 or (numpy.diff(pointer) < 0).any():
        raise BadInput(f"{path}: where its columns begin does not ascend from 1 to {count + 1}")
    column = numpy.repeat(numpy.arange(m), numpy.diff(pointer))
    return [entries(path.stem, path, (n, m), index - 1, column, value, SYMMETRIES[kind[1]])]


def field(path, lines, begin, end, form, is_whole, count):
    """Numbers of one block, in columns of a fixed width."""
    match = FORM.match(form.strip())
    if not match:
        raise BadInput(f"{path}: line 4: '{form.strip()}' is no format of numbers")
    per, width = int(match[1] or 1), int(match[3])
    if not per or not width:
        raise BadInput(f"{path}: line 4: '{form.strip()}' is no format of numbers")
    values = []
    for at in range(begin, end):
        line = lines[at].rstrip()
        n = min(per, count - len(values))
        if len(line) > n * width:
            raise BadInput(f"{path}: line {at + 1} is longer than {n} numbers of {width} characters")
        convert = whole if is_whole else real
        values += [convert(path, at + 1, line[i:i + width]) for i in range(0, n * width, width)]
    if len(values) != count:
        raise BadInput(f"{path}: {len(values)} numbers where {count} belong, lines {begin + 1} to {end}")
    return numpy.array(values, numpy.int64 if is_whole else float)


def read_mapping(path, n):
    """Labels of the n equations from lines such as `equation node direction`, UX or 1 to 6."""
    labels = {}
    for number, line in enumerate(read_lines(path), 1):
        words = line.split()
        if len(words) != 3 or not words[0].isdigit():
            if labels:
                raise BadInput(f"{path}: line {number}: '{line.strip()[:40]}' is no equation, node and direction")
            continue  # heading
        equation, node = whole(path, number, words[0]), whole(path, number, words[1])
        direction = DIRECTIONS.get(words[2].upper(), int(words[2]) if words[2].isdigit() else words[2].upper())
        if not 1 <= equation <= n or equation in labels:
            raise BadInput(f"{path}: line {number}: equation {equation} "
                           f"{'stands twice' if equation in labels else f'is none of 1 to {n}'}")
        labels[equation] = (node, direction)
    if len(labels) != n:
        raise BadInput(f"{path}: {len(labels)} equations, the matrix has {n}")
    return [labels[i] for i in range(1, n + 1)]
