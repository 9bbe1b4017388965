"""Where nodes are: a table with the columns node, x, y, z, or *NODE of a deck of Abaqus or CalculiX."""

import csv
import math
import re

from ..tables import BadInput
from .text import real, read_lines, whole


def read_places(path):
    """Node -> (x, y, z)."""
    lines = read_lines(path)
    if not lines:
        raise BadInput(f"{path}: is empty")
    rows = deck(path, lines) if any(line.startswith("*") for line in lines) else table(path, lines)
    places = {}
    for number, words in rows:
        node = whole(path, number, words[0])
        if node in places:
            raise BadInput(f"{path}: line {number}: node {node} stands twice")
        places[node] = tuple(real(path, number, word) for word in words[1:4])
        if not all(math.isfinite(x) and abs(x) < 1e30 for x in places[node]):
            raise BadInput(f"{path}: line {number}: node {node} lies nowhere")
    if not places:
        raise BadInput(f"{path}: has no nodes")
    return places


def table(path, lines):
    """Rows below the header."""
    rows = list(csv.reader(lines))
    names = [name.strip().lower() for name in rows[0]]
    if not {"node", "x", "y", "z"} <= set(names):
        raise BadInput(f"{path}: line 1 must have the columns node, x, y, z")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise BadInput(f"{path}: line {number}: {len(row)} columns, the header has {len(names)}")
        yield number, [row[names.index(name)] for name in ("node", "x", "y", "z")]


def deck(path, lines):
    """Lines of *NODE."""
    inside = False
    for number, line in enumerate(lines, 1):
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            inside = bool(re.match(r"\*\s*NODE\s*(,|$)", line, re.IGNORECASE))
            if re.match(r"\*\s*(INSTANCE|INCLUDE)\b", line, re.IGNORECASE):
                raise BadInput(f"{path}: line {number}: parts, instances and included files have nodes of their "
                               f"own numbers; give a table node,x,y,z")
            continue
        if inside:
            words = [word.strip() or "0" for word in line.rstrip().rstrip(",").split(",")]
            yield number, [*words, "0", "0", "0"][:4]
