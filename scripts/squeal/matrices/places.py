"""Where nodes are: a table with the columns node, x, y, z, *NODE of a deck of Abaqus or CalculiX, or GRID of one of Nastran."""

import csv
import math
import re

from ..decks.nastran import mesh as nastran_mesh, systems as nastran_systems
from ..decks.deck import Deck
from ..decks.nastran.read import read_tables
from ..tables import BadInput
from .text import real, read_lines, whole


NASTRAN = ".bdf", ".dat", ".nas", ".pch"


def grid_points(path):
    """Of GRID. Points whose displacements are in axes of their own are at no place, since directions of unknowns are those of space."""
    deck, mesh = Deck(path, "Nastran"), nastran_mesh.Mesh()
    tables = read_tables(path, nastran_mesh.KNOWN | nastran_systems.KNOWN)[2]
    if not any(table.name == "GRID" for table in tables):
        raise BadInput(f"{path}: has no GRID")
    nastran_mesh.read_grid(deck, mesh, tables)
    ids, places = mesh.nodes.sorted("grid point")
    return {node: tuple(deck.x[at].tolist()) for node, at in zip(ids.tolist(), places.tolist()) if at not in mesh.turned}


def read_places(path):
    """Node -> (x, y, z)."""
    if path.suffix.lower() in NASTRAN:
        return grid_points(path)
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
