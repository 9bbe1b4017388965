"""Abaqus and CalculiX: pre-tension sections, and clearances of contacts. What holds or loads the node of a section is its tension or
shortening: a force tightens it in the step where it acts, after which the length stays, as behind a lock."""

import numpy

from .joined import one_node
from .material import numbers
from .model import factor_of, surface_pair
from .sets import reader_nodes, surface_of
from .words import choice
from ..bolts import Bolt, normal_of, side_of
from ..mesh.faces import surface_nodes
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
    """One gap of two surfaces, or that of each node, in the place of that of the mesh; negative where they overlap."""
    if "TABULAR" not in card.options and not card.options.get("VALUE") or {"BOLT", "CPSET", "INPUT"} & set(card.options):
        reader.deck.note(card.place, "*CLEARANCE: only MASTER, SLAVE and VALUE or TABULAR are read: not taken; give the contact a `gap`")
        for word in ("CPSET", "BOLT", "INPUT"):
            card.options.pop(word, None)
        return
    names = [surface_of(reader, scope, card.need(word), card.place) for word in ("SLAVE", "MASTER")]
    value = clearance_table(reader, scope, card) if "TABULAR" in card.options else real(card.options["VALUE"], card.place)
    reader.clearances.append((names, value, card.place))


def clearance_table(reader, scope, card):
    """Gap of each node: lines of a node or set, its gap, and a normal that squeal has of the surfaces."""
    found = {}
    for place, fields in card.rows():
        if len(fields) < 2:
            raise place.wrong("*CLEARANCE, TABULAR: a node or set and its gap are needed")
        found |= dict.fromkeys(reader_nodes(reader, scope, fields[0], place).tolist(), real(fields[1], place))
        if any(fields[2:5]):
            reader.deck.differ(place, "*CLEARANCE, TABULAR: normals are those of the surfaces")
    return found


def do_interference(reader, scope, card):
    """What is left at the end of the step of overlaps v that are allowed: nothing, or v times the amplitude there; below 0 the surfaces
    overlap by more than in the mesh."""
    if choice(card.options.get("TYPE", "CONTACT PAIR"), "CONTACT PAIR", "ELEMENT") == "ELEMENT":
        reader.deck.note(card.place, "*CONTACT INTERFERENCE, TYPE=ELEMENT: of contact elements, not taken")
        return
    if card.choose("OP", "MOD", "NEW", "MOD") == "NEW":
        reader.fits = []
    left = factor_of(reader, card) if card.options.get("AMPLITUDE") and "SHRINK" not in card.options else 0.0
    card.options.pop("AMPLITUDE", None)
    for place, fields in card.rows():
        names = surface_pair(reader, scope, place, fields)
        value = left * real(fields[2], place) if len(fields) > 2 and fields[2] and left else 0.0
        if any(fields[3:6]):
            reader.deck.differ(place, "*CONTACT INTERFERENCE: surfaces are shifted along their normals, not in a direction")
        reader.fits.append((names, value, place))


def give_gaps(reader):
    """Clearances and interferences to the contacts of their surfaces."""
    for word, said in (("CLEARANCE", reader.clearances), ("CONTACT INTERFERENCE", reader.fits)):
        for names, value, place in said:
            found = [contact for contact in reader.deck.contacts if [contact.slave, contact.master] == names]
            for contact in found:
                give_gap(reader, contact, value, place) if word == "CLEARANCE" else give_fit(reader, contact, value, place)
            if not found:
                reader.deck.note(place, f"*{word}: there is no *CONTACT PAIR of {names[0]}, {names[1]}: not taken")


def give_gap(reader, contact, value, place):
    """A gap of all nodes of the slave, or a table that has each of them."""
    nodes = surface_nodes(reader.deck, reader.deck.surfaces[contact.slave][0])
    missing = [node for node in nodes.tolist() if node not in value] if isinstance(value, dict) else []
    if missing:
        reader.deck.note(place, f"*CLEARANCE, TABULAR: {len(missing)} of the {len(nodes)} nodes of {contact.slave} are not in it, and one "
                                "table has all of them: not taken; give the contact a `gap`")
        return
    contact.gap = value, place


def give_fit(reader, contact, value, place):
    """An interference beyond the mesh's; what may stay inside of the other body at the end is a gap."""
    if value <= 0:
        contact.fit = -value, place
    elif contact.gap and not isinstance(contact.gap[0], dict):
        contact.gap = contact.gap[0] + value, place
    else:
        reader.deck.note(place, f"*CONTACT INTERFERENCE: an overlap of {value:g} stays allowed at the end: not taken; give the contact a "
                                "`gap`")


CARDS = {"PRE-TENSION SECTION": do_section, "CLEARANCE": do_clearance, "CONTACT INTERFERENCE": do_interference}
