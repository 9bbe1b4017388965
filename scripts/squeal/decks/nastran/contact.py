"""Nastran: surfaces of solids, and pairs of them."""

import numpy

from ..deck import Contact
from ..mesh.faces import faces_by_three
from .cards import named

KNOWN = {"BSURFS", "BCTABLE", "BCPROP"}


def read_contact(deck, tables, mesh):
    """BSURFS: a number, then an element and three corners of its face each; BCTABLE: pairs of surfaces with friction."""
    for table in named(tables, "BSURFS"):
        for row in range(len(table)):
            words = [word for word in table.words(row) if word]
            if len(words) < 5 or (len(words) - 1) % 4 or not all(word.isdigit() for word in words):
                raise table.place(row).wrong("BSURFS: a number, then an element and three corners of its face each")
            rows = numpy.array([int(word) for word in words[1:]]).reshape(-1, 4)
            corners = mesh.nodes.need(rows[:, 1:], "grid point", table.place(row))
            add_surface(deck, int(words[0]), surface_faces(deck, corners, table.place(row)), table.place(row))
    for table in named(tables, "BCPROP"):
        for row in range(len(table)):
            deck.note(table.place(row), "BCPROP: surfaces of properties (shells): not understood")
    for table in named(tables, "BCTABLE"):
        for row in range(len(table)):
            add_pairs(deck, table, row)


def add_pairs(deck, table, row):
    """Pairs of a BCTABLE: from the second line on source, target, -, friction."""
    words, place = table.words(row, 8), table.place(row)
    for at in range(8, len(words) - 5, 8):
        names = words[at:at + 2]
        if not names[0]:
            continue
        if not all(f"SURFACE_{name}" in deck.surfaces for name in names):
            deck.note(place, f"BCTABLE {words[0]}: '{names[0]}', '{names[1]}' are no two BSURFS: the pair is not taken")
            continue
        mu = table.one_real(row, at + 3, words[at + 3]) if words[at + 3] else 0.0
        deck.contacts.append(Contact(f"contact_{words[0]}", *(f"SURFACE_{name}" for name in names), place, mu=mu))


def add_surface(deck, number, faces, place):
    name = f"SURFACE_{number}"
    if name in deck.surfaces:
        faces = numpy.concatenate([deck.surfaces[name][0], faces])
    deck.surfaces[name] = faces, place


def surface_faces(deck, corners, place):
    """Faces of solids with three of these corners."""
    faces, missing = faces_by_three(deck, corners)
    if missing.any():
        raise place.wrong("BSURFS: three corners are on no face of an element")
    return faces
