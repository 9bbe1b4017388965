"""Decks of CalculiX for the meshes of gmsh.py, runs of it, and the eigenvalues that it prints."""

import math

import numpy

from .gmsh import HEX20, TET10
from .program import measured
from .tables import BadInput

# Type of Gmsh -> name in CalculiX, and the order of its nodes
SOLIDS = {TET10: ("C3D10", [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
          HEX20: ("C3D20", [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15])}
SIDES = (0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)  # S1 to S6 of a hexahedron


def lines_of(rows):
    """Lines of numbers, at most 16 in one; all but the last end with a comma."""
    for row in rows:
        for first in range(0, len(row), 16):
            yield ", ".join(map(str, row[first:first + 16])) + ("," if first + 16 < len(row) else "")


def node_cards(places):
    """Nodes, from 1; a field of CalculiX has 20 characters."""
    return ["*NODE", *(", ".join([str(number), *(f"{x:.12e}" for x in place)]) for number, place in enumerate(places, 1))]


def body_cards(name, kind, cells, first=1):
    """Elements of a body, numbered from `first`; cells [n][nodes], nodes from 0."""
    title, order = SOLIDS[kind]
    return [f"*ELEMENT, TYPE={title}, ELSET={name}",
            *lines_of([first + i, *nodes] for i, nodes in enumerate((cells[:, order] + 1).tolist()))]


def set_cards(name, nodes):
    """A set of nodes, from 0, each as often as one likes."""
    return [f"*NSET, NSET={name}", *map(str, (numpy.unique(nodes) + 1).tolist())]


def face_cards(name, faces, cells, first=1):
    """A surface of faces [n][nodes] of hexahedra that are numbered from `first`."""
    side = {frozenset(nodes[list(corners)].tolist()): f"{first + i}, S{k}"
            for i, nodes in enumerate(cells) for k, corners in enumerate(SIDES, 1)}
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(side[frozenset(nodes[:4].tolist())] for nodes in faces)]


def run_calculix(folder, cards):
    """Runs a deck; returns its eigenvalues, s of processor and MB of the process."""
    (folder / "job.inp").write_text("\n".join(cards) + "\n")
    text, seconds, megabytes = measured(["ccx", "job"], "ccx", folder=folder)
    if "Job finished" not in text:
        raise BadInput(f"ccx: {text.strip()[-300:]}")
    return eigenvalues(folder / "job.dat"), seconds, megabytes


def eigenvalues(path):
    """sigma + i omega of what *FREQUENCY printed to seven digits, rad/s, by frequency. From unsymmetric matrices they come
    without the column of the squares, and in pairs of either sign of sigma where they are complex."""
    text = path.read_text().partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in text.splitlines()]
    rows = [list(map(float, row[1:])) for row in rows if len(row) in (4, 5) and row[0].isdigit()]
    found = numpy.array([complex(row[-1], 2 * math.pi * row[-2]) for row in rows])
    return found[numpy.argsort(found.imag, kind="stable")]
