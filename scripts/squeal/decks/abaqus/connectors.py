"""Abaqus: connectors between two nodes, as far as they are linear: rigid, joined, hinged, or with stiffness and viscosity."""

import numpy

from .material import first_row
from .words import label
from ..deck import Equation, Join, Link
from ..text import whole

RIGID, PINNED = ({"BEAM"}, {"WELD"}), ({"JOIN"}, {"HINGE"}, {"JOIN", "REVOLUTE"})
ELASTIC = ({"BUSHING"}, {"CARTESIAN"}, {"CARTESIAN", "ROTATION"}, {"PROJECTION CARTESIAN", "PROJECTION FLEXION-TORSION"},
           {"CARTESIAN", "CARDAN"})


def do_behavior(reader, _, card):
    reader.connector = card.need("NAME")
    reader.connectors.setdefault(reader.connector, (numpy.zeros(6), numpy.zeros(6)))


def do_component(reader, _, card):
    """Stiffness or viscosity of one component."""
    if reader.connector is None:
        raise card.place.wrong(f"*{card.keyword} outside of a *CONNECTOR BEHAVIOR")
    word = card.options.get("COMPONENT", "")
    if not word or set(card.options) & {"NONLINEAR", "RIGID"}:
        for name in ("NONLINEAR", "RIGID"):
            card.options.pop(name, None)
        reader.deck.note(card.place, f"*{card.keyword}: only linear, of one COMPONENT, is read: not in the scene")
        return
    component, value = whole(word, card.place, "a component"), first_row(card, 1)[0][0]
    if not 1 <= component <= 6 or value < 0:
        raise card.place.wrong(f"*{card.keyword}: component {component} must be 1 to 6, and {value:g} not negative")
    reader.connectors[reader.connector][card.keyword == "CONNECTOR DAMPING"][component - 1] = value


def do_section(reader, scope, card):
    """Waits for the behaviors, which may come later."""
    reader.connector_sections.append((scope, card))


def axes_of(reader, scope, card, rows):
    """Axes 1 and 2 by the *ORIENTATION of the second line; None for those of space; a text where they are not read."""
    name = label(rows[1][1][0]) if len(rows) > 1 and rows[1][1] and rows[1][1][0] else ""
    if not name:
        return None
    inner, local = reader.split(name, scope)
    found = inner.axes.get(local)
    if found is None:
        raise card.place.wrong(f"there is no *ORIENTATION {name}")
    if isinstance(found, list) or found.cylinder:
        return "an orientation that is not rectangular"
    return tuple(found.first), tuple(found.second)


def add_pinned(deck, nodes, kinds, axes, place, words):
    """The same displacements; of a hinge the rotations across its axis 1 too."""
    rows = [[(nodes[0], d, 1.0), (nodes[1], d, -1.0)] for d in range(3)]
    if kinds != {"JOIN"}:
        first = numpy.array(axes[0] if axes else (1.0, 0.0, 0.0))
        across = numpy.linalg.svd(first[None])[2][1:]
        rows += [[(node, 3 + d, sign * float(v)) for node, sign in zip(nodes, (1, -1)) for d, v in enumerate(axis) if abs(v) > 1e-14]
                 for axis in across]
    deck.equations += [Equation(terms, place, words) for terms in rows]


def add_connector(reader, element, kinds, axes, values):
    """One connector."""
    deck, (_, pair, place), nodes = reader.deck, element, tuple(int(node) for node in element[1])
    words = f"*CONNECTOR SECTION, {' '.join(sorted(kinds))}"
    if kinds in RIGID:
        deck.joins.append(Join("", nodes[0], pair[1:], True, place, words))
    elif kinds in PINNED:
        add_pinned(deck, nodes, kinds, axes, place, words)
    if any(value.any() for value in values):
        deck.links.append(Link(nodes, place, words, tuple(values[0]), tuple(values[1]), axes, "connector"))
    elif kinds in ELASTIC:
        deck.note(place, f"{words}: without stiffness and viscosity: not in the scene")


def finish(reader):
    """All connectors, once their behaviors are known."""
    for scope, card in reader.connector_sections:
        name, rows = card.need("ELSET"), list(card.rows())
        chosen = [number for number in scope.other_sets.get(name, []) if scope.holders.get(number, ("",))[0] == "CONN3D2"]
        scope.given.update(chosen)
        kinds, axes = {word.upper() for word in rows[0][1] if word} if rows else set(), axes_of(reader, scope, card, rows)
        if kinds not in RIGID + PINNED + ELASTIC or isinstance(axes, str):
            said = axes if isinstance(axes, str) else " ".join(sorted(kinds))[:60] or "no type"
            reader.deck.note(card.place, f"*CONNECTOR SECTION {name}: {said}, not read: not in the scene; `joints` of squeal may do this")
            continue
        behavior = label(card.options.get("BEHAVIOR", ""))
        if behavior and behavior not in reader.connectors:
            raise card.place.wrong(f"there is no *CONNECTOR BEHAVIOR {behavior}")
        values = reader.connectors.get(behavior, (numpy.zeros(6), numpy.zeros(6)))
        for number in chosen:
            add_connector(reader, scope.holders[number], kinds, axes, values)


CARDS = {"CONNECTOR BEHAVIOR": do_behavior, "CONNECTOR ELASTICITY": do_component, "CONNECTOR DAMPING": do_component,
         "CONNECTOR SECTION": do_section}
