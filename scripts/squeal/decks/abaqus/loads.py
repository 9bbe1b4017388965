"""Abaqus: forces, pressures, gravity. What acts is what the last step says: within a step loads on the same node or face add
up; a later step replaces what an earlier one said of the same node and direction, or face, whichever set named it; with OP=NEW
all of it (CalculiX' forcadd and loadadd do the same)."""

from dataclasses import dataclass

import numpy

from .model import direction, factor_of, set_name
from .sets import check_faces, reader_cells, reader_nodes, surface_of
from ..deck import Load
from ..text import real


@dataclass
class Said:
    """What a line says in a step of nodes, faces (cell, face) or cells; a force is along direction `d`."""
    step: int
    keyword: str
    members: numpy.ndarray
    value: object
    place: object
    name: str = ""
    d: int = 0


def forget(reader, card):
    """OP=NEW: the loads of earlier steps act no longer; *DLOAD and *DSLOAD are one in CalculiX."""
    if card.choose("OP", "MOD", "NEW", "MOD") != "NEW":
        return
    for said in [reader.forces] if card.keyword == "CLOAD" else [reader.pressures, reader.gravity]:
        gone = {row.keyword for row in said if row.step != reader.steps}
        for keyword in sorted(gone - {card.keyword}):
            reader.deck.note(card.place, f"*{card.keyword}, OP=NEW: ends *{keyword} of earlier steps too, as in CalculiX")
        said[:] = [row for row in said if row.step == reader.steps]


def in_force(rows, keys_of, n):
    """What acts: each row with which of its members no later step speaks of; keys of members are below n."""
    covered, left = numpy.zeros(n, bool), {}
    for step in sorted({row.step for row in rows}, reverse=True):
        now = [(number, keys_of(row)) for number, row in enumerate(rows) if row.step == step]
        left |= {number: ~covered[keys] for number, keys in now}
        for _, keys in now:
            covered[keys] = True
    return [(row, left[number]) for number, row in enumerate(rows)]


def do_cload(reader, scope, card):
    forget(reader, card)
    factor = factor_of(reader, card)
    for place, fields in card.rows():
        if len(fields) < 3:
            raise place.wrong(f"*CLOAD: {len(fields)} fields, expected a node or set, a direction, a force")
        if any(fields[3:]):
            reader.deck.note(place, f"*CLOAD: fields behind the force ({', '.join(fields[3:])[:30]}): not taken")
        nodes, d = reader_nodes(reader, scope, fields[0], place), direction(fields[1], place, card.keyword, reader)
        value = factor * real(fields[2], place)
        if d is None:
            continue
        name = "" if fields[0].isdigit() else set_name(reader, scope, fields[0])
        turned = [node for node in nodes.tolist() if node in reader.rotations]
        for node in turned:
            reader.forces.append(Said(reader.steps, card.keyword, numpy.array([reader.rotations[node]]), value, place, "", d % 3 + 3))
        rest = numpy.setdiff1d(nodes, turned) if turned else nodes
        if len(rest):
            reader.forces.append(Said(reader.steps, card.keyword, rest, value, place, "" if turned else name, d))
            reader.of_bolts.append(reader.forces[-1])


def do_dload(reader, scope, card):
    forget(reader, card)
    factor = factor_of(reader, card)
    for place, fields in card.rows():
        kind = fields[1].upper() if len(fields) > 1 else ""
        if kind == "GRAV":
            gravity(reader, scope, place, fields, factor)
        elif kind == "P" and len(fields) == 3:
            faces = check_faces(reader, reader_cells(reader, scope, fields[0], place), 1, place)
            reader.pressures.append(Said(reader.steps, card.keyword, faces, factor * real(fields[2], place), place))
        elif len(kind) == 2 and kind[0] == "P" and kind[1].isdigit() and len(fields) == 3:
            faces = check_faces(reader, reader_cells(reader, scope, fields[0], place), int(kind[1]), place)
            reader.pressures.append(Said(reader.steps, card.keyword, faces, factor * real(fields[2], place), place))
        else:
            reader.deck.note(place, f"*DLOAD {kind}: not understood")


def gravity(reader, scope, place, fields, factor):
    """Acceleration and direction, on all cells or some."""
    if len(fields) != 6:
        raise place.wrong("*DLOAD GRAV needs an acceleration and three components of its direction")
    values = numpy.array([real(word or "0", place) for word in fields[2:]])
    cells = reader_cells(reader, scope, fields[0], place) if fields[0] else numpy.arange(reader.deck.n_cells)
    if not numpy.linalg.norm(values[1:]) > 0:
        raise place.wrong("*DLOAD GRAV has no direction")
    vector = factor * values[0] * values[1:] / numpy.linalg.norm(values[1:])
    reader.gravity.append(Said(reader.steps, "DLOAD", cells, vector, place))


def do_dsload(reader, scope, card):
    forget(reader, card)
    factor = factor_of(reader, card)
    for place, fields in card.rows():
        if len(fields) != 3 or fields[1].upper() != "P":
            reader.deck.note(place, f"*DSLOAD {', '.join(fields[1:2])}: not understood")
            continue
        name = surface_of(reader, scope, fields[0], place)
        faces = reader.deck.surfaces[name][0]
        if not len(faces):
            reader.deck.note(place, f"*DSLOAD: {name} has no faces; not in the scene")
        reader.pressures.append(Said(reader.steps, card.keyword, faces, factor * real(fields[2], place), place, name))


def finish_loads(reader):
    """Loads of the deck."""
    deck = reader.deck
    for row, left in in_force(reader.forces, lambda row: 6 * row.members + row.d, 6 * deck.n_nodes):
        if row.value and left.any():
            add_force(reader, row, row.members[left], row.name if left.all() else "")
    for row, left in in_force(reader.pressures, lambda row: row.members @ (6, 1), 6 * deck.n_cells):
        if row.value and left.any():
            deck.loads.append(Load(row.name if left.all() else "", row.place, faces=row.members[left], pressure=row.value))
    finish_gravity(reader)


def add_force(reader, row, nodes, name):
    """A force or moment at each of the nodes, in its own axes where it has some."""
    own = [node for node in nodes.tolist() if node in reader.turned]
    for node in own:
        axes = reader.turned[node]
        if axes is None:
            reader.deck.note(row.place, "*CLOAD: in the axes of *TRANSFORM, not taken")
        else:
            reader.deck.loads.append(load_of(row, "", numpy.array([node]), row.value * axes[row.d % 3]))
    rest = numpy.setdiff1d(nodes, own) if own else nodes
    if len(rest):
        reader.deck.loads.append(load_of(row, "" if own else name, rest, row.value * numpy.eye(3)[row.d % 3]))


def load_of(row, name, nodes, vector):
    """The load of a row: a force or a moment."""
    none = numpy.zeros(3)
    return Load(name, row.place, nodes=nodes, force=vector if row.d < 3 else none, moment=vector if row.d > 2 else None)


def finish_gravity(reader):
    """Gravity of squeal is one, of all cells."""
    deck, of_cells, last = reader.deck, numpy.zeros((reader.deck.n_cells, 3)), None
    for row, left in in_force(reader.gravity, lambda row: row.members, deck.n_cells):
        of_cells[row.members[left]] += row.value
        last = row.place if left.any() else last
    if last is None or not of_cells.any():
        return
    if (of_cells == of_cells[0]).all():
        deck.gravity = of_cells[0], last
    else:
        deck.note(last, "*DLOAD GRAV: gravity of squeal is one, and acts on all parts; not taken")


CARDS = {"CLOAD": do_cload, "DLOAD": do_dload, "DSLOAD": do_dsload}
