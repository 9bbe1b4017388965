"""DMIG of Nastran's bulk data: the head of a matrix, NAME 0 IFO TIN TOUT POLAR - NCOL, and columns, NAME GJ CJ - G1 C1 A1 B1
G2 C2 A2 B2 ..., of grid points G and components C (0 of scalar points). IFO is 1 of a square matrix, 6 of a symmetric one, of
which each pair has one entry, 2 or 9 of a rectangular one. TIN 3 and 4 are complex, A + i B, or with POLAR amplitude and phase
in degrees. Case control K2GG, M2GG, B2GG, K2PP, M2PP, B2PP says which are taken, with factors. Reference: MSC Nastran, Quick
Reference Guide."""

import re
from collections import Counter

import numpy

from ..decks.nastran import systems as nastran_systems
from ..decks.deck import Place
from ..decks.nastran.read import read_tables
from ..decks.nastran.cards import named
from ..tables import BadInput
from .entries import labelled

READ = {"DMIG", "PARAM", "GRID", "GRDSET"} | nastran_systems.KNOWN
FORMS = {1: "general", 6: "symmetric"}
RECTANGULAR = 2, 9
KINDS = {"K2GG": "stiffness", "K2PP": "stiffness", "M2GG": "mass", "M2PP": "mass", "B2GG": "damping", "B2PP": "damping", "K42GG": ""}
FACTORS = {"K2GG": "CK2", "M2GG": "CM2", "B2GG": "CB2"}  # PARAM that multiplies
CHOICE = re.compile(rb"(?im)^[ \t]*([KMB]2(?:GG|PP)|K42GG)[ \t]*(?:\([^)\n]*\))?[ \t]*=[ \t]*([^$\n]*)")
PART = re.compile(r"(?:([+-]?[\d.]+(?:[eEdD]?[+-]?\d+)?)\s*\*\s*)?([A-Za-z][A-Za-z0-9_]*)$")
LONGEST = 80  # columns of a line in fixed fields


def names_of(table):
    """Name of the matrix of each card."""
    letters = numpy.ascontiguousarray(table.part(0, 1)).view(f"S{table.each}")[:, 0]
    return numpy.char.decode(numpy.char.upper(numpy.char.strip(letters)), "latin-1")


class Head:
    """What stands in the card with a 0."""

    def __init__(self, table, row):
        self.place = table.place(row)
        _, self.form, self.kind, _, self.polar = table.whole(1, 6)[row].tolist()
        if self.form not in (*FORMS, *RECTANGULAR) or self.kind not in (1, 2, 3, 4):
            raise self.place.wrong(f"DMIG {names_of(table)[row]}: form {self.form}, type {self.kind}; forms 1, 2, 6, 9 and types 1 to 4 "
                                   "exist")


def heads_of(tables):
    """Name -> head."""
    heads = {}
    for table in tables:
        for row in numpy.flatnonzero(table.whole(1, 2)[:, 0] == 0).tolist():
            name = str(names_of(table)[row])
            if name in heads:
                raise table.place(row).wrong(f"DMIG {name}: a second head; the first is that of line {heads[name].place.line}")
            heads[name] = Head(table, row)
    return heads


def rows_of(table, name, head):
    """Grid points [n][2], components [n][2] of row and column, and A, B of the entries of a matrix in a table."""
    table = table.rows(numpy.flatnonzero((names_of(table) == name) & (table.whole(1, 2)[:, 0] != 0)))
    if not len(table):
        return []
    column, parts = table.whole(1, 3), []
    for at in range(4, table.width, 4):
        blank = table.blank(at, at + 4)
        lost = blank[:, 0] & ~blank.all(axis=1) | ~blank[:, 0] & blank[:, 2]
        if lost.any():
            row = int(lost.argmax())
            raise table.place(row).wrong(f"DMIG {name}: field {at + (2 if blank[row, 0] else 4)} is blank")
        row, value = table.whole(at, at + 2), table.real(at + 2, at + 4)
        if head.kind < 3 and value[:, 1].any():
            row = int(numpy.flatnonzero(value[:, 1])[0])
            raise table.place(row).wrong(f"DMIG {name}: an imaginary part, field {at + 5}, of a real matrix (TIN {head.kind})")
        kept = ~blank[:, 0]
        parts.append((numpy.stack([row[kept, 0], column[kept, 0]], 1), numpy.stack([row[kept, 1], column[kept, 1]], 1), value[kept]))
        bad = numpy.flatnonzero(kept & ((row < (1, 0)).any(axis=1) | (column < (1, 0)).any(axis=1) |
                                        (numpy.maximum(row, column)[:, 1] > 6)))
        if len(bad):
            raise table.place(int(bad[0])).wrong(f"DMIG {name}: ({row[bad[0], 0]}, {row[bad[0], 1]}), ({column[bad[0], 0]}, "
                                                 f"{column[bad[0], 1]}) are no grid points and components of 0 to 6")
    return parts


def matrices_of(path, tables, name, head):
    """The matrix of a name, and beside a complex one NAME_IMAG of its imaginary part."""
    parts = [part for table in tables for part in rows_of(table, name, head)]
    if not parts:
        raise head.place.wrong(f"DMIG {name} has no columns")
    node, direction, value = (numpy.concatenate(arrays) for arrays in zip(*parts))
    if head.kind > 2 and head.polar > 0:
        value = value[:, :1] * numpy.stack([numpy.cos(numpy.radians(value[:, 1])), numpy.sin(numpy.radians(value[:, 1]))], 1)
    found = [labelled(name, path, node, direction, value[:, 0], FORMS[head.form])]
    if head.form == 1 and one_triangle(node, direction):
        found[0].how = "IFO 1, and has one triangle alone: taken as it is"
    if value[:, 1].any():
        found.append(labelled(f"{name}_IMAG", path, node, direction, value[:, 1], FORMS[head.form]))
        found[1].kind, found[1].how = "", f"imaginary part of {name}, for stiffness structural damping, which is no part of -terms"
    return found


def one_triangle(node, direction):
    """Whether entries off the diagonal are all on one side of it."""
    side = numpy.sign(10 * (node[:, 0] - node[:, 1]) + direction[:, 0] - direction[:, 1])
    return bool(side.any()) and not (side > 0).any() * (side < 0).any()


def choices_of(before, tables):
    """Name of a matrix -> (kind, factor, place), as case control has it; PARAM multiplies."""
    scales = {word: table.one_real(row, 1, table.words(row, 2)[1]) for table in named(tables, "PARAM") for row in range(len(table))
              for word in [table.words(row)[0].upper()] if word in FACTORS.values()}
    found = {}
    for data, file, first in before:
        for line in CHOICE.finditer(data):
            word, text = line[1].decode().upper(), line[2].decode("latin-1")
            place = Place(file, first + data.count(b"\n", 0, line.start(1)))
            for part in re.split(r",(?![^()]*\))", text.strip()):
                match = PART.match(part.strip())
                if not match:
                    raise place.wrong(f"{word} = {text.strip()[:40]}: is no list of names with real factors")
                factor = float(re.sub("[dD]", "e", match[1])) if match[1] else 1.0
                chosen = KINDS[word], factor * scales.get(FACTORS.get(word), 1.0), place
                name = match[2].upper()
                if name in found and found[name][:2] != chosen[:2]:
                    raise place.wrong(f"{name} is chosen twice, in line {found[name][2].line} otherwise; --take NAME=MATRIX chooses")
                found[name] = chosen
    return found


def check_lines(bulk):
    """What stands behind the last column of a DMIG is no comment: a line has lost its end."""
    for data, file, first in bulk:
        for line in re.finditer(rb"(?im)^(?:DMIG|[ *+])[^,$\n]{%d,}$" % LONGEST, data):
            if line[0][LONGEST:].strip():
                raise Place(file, first + data.count(b"\n", 0, line.start())).wrong(f"a line of more than {LONGEST} columns")


def beside(path, tables, heads):
    """Lines about what is not read."""
    lines = [f"{head.place.file}:{head.place.line}: DMIG {name}: rectangular (IFO {head.form}), not read"
             for name, head in heads.items() if head.form in RECTANGULAR]
    others = Counter()
    for table in tables:
        others[table.name] += len(table) * (table.name not in READ)
    words = [f"{count} {name}" for name, count in sorted(others.items(), key=lambda item: -item[1]) if count]
    if words:
        lines.append(f"{path}: not read, since the matrices alone are the system: {', '.join(words[:12])}{' ...' if words[12:] else ''}")
    return lines


def read(path):
    """All square matrices of a file; those that case control does not name are not chosen."""
    before, bulk, tables, ended = read_tables(path, READ)
    dmigs = named(tables, "DMIG")
    if not dmigs:
        raise BadInput(f"{path}: has no DMIG" + (" before its ENDDATA" if ended else ""))
    check_lines(bulk)
    heads, choices = heads_of(dmigs), choices_of(before, tables)
    for table in dmigs:
        for row in numpy.flatnonzero(~numpy.isin(names_of(table), list(heads))).tolist():
            raise table.place(row).wrong(f"DMIG {names_of(table)[row]} has no head")
    for name, (_, _, place) in choices.items():
        if name not in heads or heads[name].form in RECTANGULAR:
            raise place.wrong(f"{name}: " + ("there is no such DMIG" if name not in heads else "is rectangular"))
    found = []
    for name, head in heads.items():
        if head.form not in RECTANGULAR:
            found += matrices_of(path, dmigs, name, head)
    lines = beside(path, tables, heads)
    if not found:
        raise BadInput(f"{path}: has no square matrix: {', '.join(heads)} are rectangular")
    for one in found:
        kind, scale, _ = choices.get(one.name.removesuffix("_IMAG"), (None, 1.0, None))
        one.scale, one.chosen = scale, not choices or kind is not None
        if one.kind is None:
            one.kind = "" if one.name.startswith("K4") else kind
        if one.kind == "" and not one.how:
            one.how = "structural damping, which is no part of -terms"
    found[0].beside = lines
    return found
