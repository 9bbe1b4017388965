"""Abaqus and CalculiX: pre-tension sections, and clearances of contacts. What holds or loads the node of a section is its tension or
shortening: a force tightens it in the step where it acts, after which the length stays, as behind a lock."""

import numpy

from .joined import one_node
from .material import numbers
from .sets import surface_of
from ..bolts import Bolt, normal_of, side_of
from ..text import real


def do_section(reader, scope, card):
    node = one_node(reader, scope, card.need("NODE"), card.place, "*PRE-TENSION SECTION, NODE")
    if "ELEMENT" in card.options:
        card.options.pop("ELEMENT")
        reader.deck.note(card.place, "*PRE-TENSION SECTION, ELEMENT: of a beam: not in the scene; mesh the bolt as a solid, or press by "
                                     "two -loads on what it holds")
        return
    name = surface_of(reader, scope, card.need("SURFACE"), card.place)
    rows = [row for _, row in numbers(card)]
    reader.bolts.append((node, name, numpy.array(rows[0][:3]) if rows and len(rows[0]) > 2 else None, card))


def said_of(reader, node):
    """Force, displacement and places that the steps give a node along 1; they are taken from what holds and loads nodes."""
    forces, moved = [(row.value, row.place) for row in reader.of_bolts if row.d == 0 and node in row.members], []
    for row in reader.forces:
        row.members = row.members[row.members != node]
    for _, support in reader.supports:
        if node in support.nodes:
            moved.append((support.values.get(0, 0.0), support.place))
            support.nodes = support.nodes[support.nodes != node]
            support.name = ""
    reader.forces = [row for row in reader.forces if len(row.members)]
    reader.supports = [(step, support) for step, support in reader.supports if len(support.nodes)]
    return forces, moved


def finish(reader):
    """Bolts of the deck."""
    deck = reader.deck
    for number, (node, name, given, card) in enumerate(reader.bolts, 1):
        words = f"*PRE-TENSION SECTION {name}"
        if node is None or not len(deck.surfaces[name][0]):
            deck.note(card.place, f"{words}: without a node, or faces: not tightened")
            continue
        axis = normal_of(deck, deck.surfaces[name][0])
        if given is not None and numpy.linalg.norm(given) > 0:
            given = given / numpy.linalg.norm(given)
            axis = given if given @ axis > 0 else -given
        cells, nodes = side_of(deck, deck.surfaces[name][0], axis)
        bolt = Bolt(f"pretension_{number}" if len(reader.bolts) > 1 else "pretension", cells, nodes, axis, card.place, words)
        forces, moved = said_of(reader, node)
        tighten(deck, bolt, [row for row in forces if row[0]], [row for row in moved if row[0]], bool(moved))


def tighten(deck, bolt, forces, moved, locked):
    """Its tension or shortening; what else is said of it is listed."""
    if not forces and not moved:
        deck.note(bolt.place, f"{bolt.words}: nothing tightens it; the bolt is whole")
        return
    (value, place), other = (forces or moved)[-1], moved if forces else []
    for _, where in (forces or moved)[:-1] + other:
        deck.note(where, f"{bolt.words}: not taken, line {place.line} tightens it")
    if value < 0:
        deck.note(place, f"{bolt.words}: {value:g} would press the bolt: not tightened")
        return
    bolt.place = place
    bolt.tension, bolt.shortening = (value, 0.0) if forces else (0.0, value)
    if forces and not locked:
        deck.differ(place, f"{bolt.words}: the length of a bolt stays after the step that tightens it; in modes the bolt is whole")
    deck.bolts.append(bolt)


def do_clearance(reader, scope, card):
    """One gap of two surfaces, in the place of that of the mesh; negative where they overlap."""
    if not card.options.get("VALUE") or {"TABULAR", "CPSET"} & set(card.options):
        reader.deck.note(card.place, "*CLEARANCE: only MASTER, SLAVE and VALUE are read: not taken; give the contact a `gap`")
        for word in ("TABULAR", "CPSET", "BOLT"):
            card.options.pop(word, None)
        return
    names = [surface_of(reader, scope, card.need(word), card.place) for word in ("SLAVE", "MASTER")]
    reader.clearances.append((names, real(card.options["VALUE"], card.place), card.place))


def give_gaps(reader):
    """Clearances to the contacts of their surfaces."""
    for names, value, place in reader.clearances:
        found = [contact for contact in reader.deck.contacts if [contact.slave, contact.master] == names]
        for contact in found:
            contact.gap = value, place
        if not found:
            reader.deck.note(place, f"*CLEARANCE: there is no *CONTACT PAIR of {names[0]}, {names[1]}: not taken")


CARDS = {"PRE-TENSION SECTION": do_section, "CLEARANCE": do_clearance}
