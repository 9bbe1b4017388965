"""Nastran: springs to the ground."""

import numpy

from ..deck import Spring
from .cards import named
from .model import in_space

KNOWN = {"CELAS1", "CELAS2", "PELAS", "CBUSH", "PBUSH"}


def note_rest(deck, table, row, words, read):
    """Lists what a card of springs has beside the stiffness."""
    if any(words):
        deck.note(table.place(row), f"{table.name}: only {read} read; {', '.join(filter(None, words))}: not taken")


def add_property(found, number, value, place):
    if number in found:
        raise place.wrong(f"property {number} stands twice")
    found[number] = value


def bar_properties(deck, tables):
    """K of PELAS, of which a card may have two."""
    found = {}
    for table in named(tables, "PELAS"):
        for row in range(len(table)):
            words = table.words(row, 8)
            note_rest(deck, table, row, words[2:4] + words[6:8], "K is")
            for at in (0, 4):
                if words[at]:
                    add_property(found, int(table.whole(at, at + 1)[row, 0]), float(table.real(at + 1, at + 2)[row, 0]), table.place(row))
    return found


def bush_properties(deck, tables):
    """K1 to K3 behind the word K of PBUSH; it may also have K4 to K6, damping behind B, loss factors behind GE."""
    found = {}
    for table in named(tables, "PBUSH"):
        for row in range(len(table)):
            words = table.words(row)
            at = words.index("K") if "K" in words else -1
            note_rest(deck, table, row, words[1:max(at, 1)] + words[at + 4 if at >= 0 else 1:], "K1 to K3 are")
            value = table.real(at + 1, at + 4)[row] if at >= 0 else numpy.zeros(3)
            add_property(found, int(table.whole(0, 1)[row, 0]), value, table.place(row))
    return found


def read_bars(deck, tables, mesh):
    """CELAS1, CELAS2 with one grid point, the other end of which is the ground."""
    stiffness = bar_properties(deck, tables)
    for table in named(tables, "CELAS1", "CELAS2"):
        for row, values in enumerate(table.whole(2, 6).tolist()):
            place, number = table.place(row), int(table.whole(1, 2)[row, 0]) if table.name == "CELAS1" else 0
            if table.name == "CELAS1" and number not in stiffness:
                deck.note(place, f"CELAS1: there is no PELAS {number}: not taken")
                continue
            note_rest(deck, table, row, table.words(row)[6:], "the stiffness is")
            value = stiffness[number] if table.name == "CELAS1" else float(table.real(1, 2)[row, 0])
            ends = [(node, direction) for node, direction in (values[:2], values[2:]) if node]
            if len(ends) != 1 or not 1 <= ends[0][1] <= 3 or ends[0][0] in mesh.scalar:
                deck.note(place, f"{table.name}: between two grid points, or of a rotation; `joints` of squeal may do this")
                continue
            along = numpy.zeros(3)
            along[ends[0][1] - 1] = value
            spring(deck, mesh, ends[0][0], along, place, table.name)


def read_springs(deck, tables, mesh):
    """The same, and CBUSH with one grid point."""
    read_bars(deck, tables, mesh)
    bushes = bush_properties(deck, tables)
    for table in named(tables, "CBUSH"):
        for row, (number, first, second) in enumerate(table.whole(1, 4).tolist()):
            place, words = table.place(row), table.words(row, 8)
            if number not in bushes:
                deck.note(place, f"CBUSH: there is no PBUSH {number}: not taken")
            elif second or any(words[4:8]) and words[7] != "0":
                deck.note(place, "CBUSH: between two grid points, or in axes of its own; `joints` of squeal may do this")
            else:
                spring(deck, mesh, first, bushes[number], place, "CBUSH")


def spring(deck, mesh, number, stiffness, place, name):
    """Adds a spring, whose stiffness [3] is in the axes of its point."""
    if (stiffness < 0).any():
        raise place.wrong(f"{name}: the stiffness must not be negative")
    nodes = mesh.nodes.need(numpy.array([number]), "grid point", place)
    found = in_space(mesh, nodes[0], deck.x[nodes[0]], numpy.flatnonzero(stiffness).tolist())
    if found is None or any(sign == 0 for _, sign in found.values()):
        deck.note(place, f"{name}: in the axes of a coordinate system (CD of GRID), not taken")
        return
    turned = numpy.zeros(3)
    for direction, (own, _) in found.items():
        turned[direction] = stiffness[own]
    deck.springs.append(Spring(nodes, turned, "", place))
