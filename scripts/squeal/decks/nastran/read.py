"""Decks of Nastran: files, and what stands in them before the bulk data."""

import re

from ...tables import BadInput
from . import case as nastran_case, contact as nastran_contact, loads as nastran_loads, mesh as nastran_mesh, model as nastran_model
from . import beams as nastran_beams, damping as nastran_damping, joined as nastran_joined, shells as nastran_shells
from . import springs as nastran_springs, systems as nastran_systems
from ..deck import Deck, Place
from .cards import tables_of
from ..text import read_bytes

DEEPEST = 10
KNOWN = (nastran_mesh.KNOWN | nastran_systems.KNOWN | nastran_model.KNOWN | nastran_loads.KNOWN | nastran_springs.KNOWN |
         nastran_contact.KNOWN | nastran_case.KNOWN | nastran_joined.KNOWN | nastran_shells.KNOWN | nastran_beams.KNOWN |
         nastran_damping.KNOWN)
# A name, in quotes perhaps over several lines
INCLUDE = re.compile(rb"^[ \t]*include[ \t]*=?[ \t]*"
                     rb"(?:'([^']{1,1000})'|\"([^\"]{1,1000})\"|([^'\"\n$]+))[^\n]*$", re.IGNORECASE | re.MULTILINE)
BEGIN = re.compile(rb"^[ \t]*begin(?:[ \t]+bulk|[ \t]*$)[^\n]*\n?", re.IGNORECASE | re.MULTILINE)
END = re.compile(rb"^[ \t]*enddata\b[^\n]*", re.IGNORECASE | re.MULTILINE)


def included(path, text):
    """The file that INCLUDE names, beside the one it stands in; \\ and capitals as on other systems."""
    name = re.sub(r"\s*\n\s*", "", text.decode("latin-1")).strip().replace("\\", "/")
    found = path.parent / name
    if found.exists() or not found.parent.is_dir():
        return found
    alike = [other for other in found.parent.iterdir() if other.name.lower() == found.name.lower()]
    return alike[0] if len(alike) == 1 else found


def read_text(path, depth=0):
    """Lines of a file with those that it includes in their places: pieces (bytes, file, first line)."""
    data = read_bytes(path)
    pieces, at = [], 0
    for name in INCLUDE.finditer(data):
        place = Place(str(path), data.count(b"\n", 0, name.start()) + 1)
        if depth == DEEPEST:
            raise place.wrong("files include each other too deeply")
        pieces.append((data[at:name.start()], str(path), data.count(b"\n", 0, at) + 1))
        try:
            pieces += read_text(included(path, name[1] or name[2] or name[3]), depth + 1)
        except BadInput as error:
            raise (place.wrong(f"INCLUDE: {error}") if ":" not in str(error).split(" ")[0].rstrip(":") else error) from None
        at = name.end()
    return [*pieces, (data[at:], str(path), data.count(b"\n", 0, at) + 1)]


def split_pieces(path, pieces):
    """Pieces before the bulk data, and those of it; whether it has an end."""
    begun = not any(BEGIN.search(data) for data, _, _ in pieces)
    before, bulk = [], []
    for data, file, first in pieces:
        begin, end = None if begun else BEGIN.search(data), END.search(data)
        if not begun and end and (not begin or end.start() < begin.start()):
            raise Place(file, first + data.count(b"\n", 0, end.start())).wrong("ENDDATA before BEGIN BULK")
        if not begun:
            before.append((data[:begin.start()] if begin else data, file, first))
        if begin:
            begun, first, data = True, first + data.count(b"\n", 0, begin.end()), data[begin.end():]
            end = END.search(data)
        if begun:
            bulk.append((data[:end.start()] if end else data, file, first))
        if begun and end:
            return before, bulk, True
    return before, bulk, False


def read_tables(path, known):
    """Pieces before the bulk data, those of it, its cards as tables, and whether it has an end."""
    before, bulk, ended = split_pieces(path, read_text(path))
    return before, bulk, [table for data, file, first in bulk for table in tables_of(data, first, file, known)], ended


def read_nastran(path, subcase=None):
    """The deck of a file; of several subcases the one with that number, else nastran_case.chosen_case chooses."""
    deck = Deck(path, "Nastran")
    before, bulk, tables, ended = read_tables(path, KNOWN)
    if not any(table.name == "GRID" for table in tables):
        raise BadInput(f"{path}:1: there is no GRID; is this a deck of Nastran?")
    control = nastran_case.read_case(deck, before)
    if not ended:
        data, file, first = bulk[-1]
        deck.note(Place(file, first + data.count(b"\n")), "there is no ENDDATA: is the file whole?")
    mesh = nastran_mesh.read_mesh(deck, tables)
    if not deck.n_cells:
        return deck
    chosen = nastran_case.Chosen(deck, tables, control, subcase)
    nastran_model.read_model(deck, tables, mesh, chosen)
    nastran_joined.read_joined(deck, tables, mesh, chosen)
    nastran_beams.read_beams(deck, tables, mesh)
    nastran_springs.read_springs(deck, tables, mesh)
    nastran_loads.read_loads(deck, tables, mesh, chosen)
    nastran_contact.read_contact(deck, tables, mesh)
    for table in tables:
        if table.name not in KNOWN:
            for row in range(len(table)):
                deck.note(table.place(row), f"{table.name[:20]}: not understood")
    return deck
