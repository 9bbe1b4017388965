"""Nastran: springs and dashpots to the ground, and between grid points."""

import numpy

from ..deck import Link, Spring
from .cards import named

KNOWN = {"CELAS1", "CELAS2", "PELAS", "CBUSH", "PBUSH", "CDAMP1", "CDAMP2", "PDAMP"}


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
    """Number -> stiffness [6] behind the word K of PBUSH and damping [6] behind B; loss factors behind GE are listed."""
    found = {}
    for table in named(tables, "PBUSH"):
        for row in range(len(table)):
            words, values, read = table.words(row, 8), {"K": numpy.zeros(6), "B": numpy.zeros(6)}, set()
            for name, value in values.items():
                at = words.index(name) if name in words[1:] else -1
                if at >= 0:
                    read |= set(range(at, at + 7))
                    for k, word in enumerate((words[at + 1:at + 7] + [""] * 6)[:6]):
                        value[k] = table.one_real(row, at + 1 + k, word) if word else 0.0
            note_rest(deck, table, row, [word for k, word in enumerate(words) if k and k not in read], "K and B are")
            add_property(found, int(table.whole(0, 1)[row, 0]), (values["K"], values["B"]), table.place(row))
    return found


def damper_properties(tables):
    """B of PDAMP, of which a card may have four."""
    found = {}
    for table in named(tables, "PDAMP"):
        for row in range(len(table)):
            words = table.words(row, 8)
            for at in range(0, 8, 2):
                if words[at]:
                    add_property(found, int(words[at]), table.one_real(row, at + 1, words[at + 1]), table.place(row))
    return found


def read_bars(deck, tables, mesh):
    """CELAS1, CELAS2, CDAMP1, CDAMP2: a component of a point against one of another, or the ground."""
    properties = {"CELAS1": bar_properties(deck, tables), "CDAMP1": damper_properties(tables)}
    for table in named(tables, "CELAS1", "CELAS2", "CDAMP1", "CDAMP2"):
        for row, values in enumerate(table.whole(2, 6).tolist()):
            place, one = table.place(row), table.name[-1] == "1"
            number = int(table.whole(1, 2)[row, 0]) if one else 0
            if one and number not in properties[table.name]:
                deck.note(place, f"{table.name}: there is no {'PELAS' if table.name[1] == 'E' else 'PDAMP'} {number}: not taken")
                continue
            note_rest(deck, table, row, table.words(row)[6:], "the stiffness is")
            value = properties[table.name][number] if one else float(table.real(1, 2)[row, 0])
            ends = [(node, direction) for node, direction in (values[:2], values[2:]) if node]
            if not ends or any(not 1 <= d <= 6 or node in mesh.scalar for node, d in ends) or len({d for _, d in ends}) > 1:
                deck.note(place, f"{table.name}: of a scalar point, or between two components: not taken")
                continue
            along = value * (numpy.arange(6) == ends[0][1] - 1)
            numbers = [node for node, _ in ends]
            join(deck, mesh, numbers, (along, 0 * along) if table.name[1] == "E" else (0 * along, along), (place, table.name))


def axes_of_bush(deck, mesh, table, row, nodes):
    """Axes 1 and 2 of a CBUSH: of a system, or along its points with a vector or point; None for those of space, a text where it is
    not read."""
    words = table.words(row, 8)
    if words[7]:
        system = mesh.systems.get(int(words[7]) if words[7].isdigit() else -1)
        return f"CBUSH: there is no coordinate system {words[7]}" if system is None else system.directions(deck.x[nodes[0]])[:2]
    if not any(words[4:7]):
        return None if len(nodes) < 2 or not numpy.linalg.norm(deck.x[nodes[1]] - deck.x[nodes[0]]) > 0 else (
            "CBUSH: neither axes nor a direction that tells them")
    if len(nodes) < 2 or not numpy.linalg.norm(deck.x[nodes[1]] - deck.x[nodes[0]]) > 0:
        return "CBUSH: a direction without a second point in another place"
    if words[4].isdigit() and not any(words[5:7]):
        other = deck.x[mesh.nodes.need(numpy.array([int(words[4])]), "grid point", table.place(row))[0]] - deck.x[nodes[0]]
    else:
        other = numpy.array([table.one_real(row, k, words[k]) if words[k] else 0.0 for k in (4, 5, 6)])
    return numpy.array([deck.x[nodes[1]] - deck.x[nodes[0]], other])


def read_springs(deck, tables, mesh):
    """The same, and CBUSH."""
    read_bars(deck, tables, mesh)
    bushes = bush_properties(deck, tables)
    for table in named(tables, "CBUSH"):
        for row, (number, first, second) in enumerate(table.whole(1, 4).tolist()):
            place = table.place(row)
            if number not in bushes:
                deck.note(place, f"CBUSH: there is no PBUSH {number}: not taken")
                continue
            numbers = [node for node in (first, second) if node]
            nodes = mesh.nodes.need(numpy.array(numbers), "grid point", place)
            axes = axes_of_bush(deck, mesh, table, row, nodes)
            if isinstance(axes, str):
                deck.note(place, f"{axes}: not in the scene")
                continue
            join(deck, mesh, numbers, bushes[number], (place, "CBUSH"), axes)


def join(deck, mesh, numbers, values, said, axes=None):
    """Adds a spring or dashpot, whose values [6] are in axes, or in those of its first point."""
    place, name = said
    if min(values[0].min(), values[1].min()) < 0:
        raise place.wrong(f"{name}: the stiffness must not be negative")
    nodes = mesh.nodes.need(numpy.array(numbers), "grid point", place)
    own = mesh.turned.get(int(nodes[0]), 0)
    if axes is None and own in mesh.systems and own:
        axes = mesh.systems[own].directions(deck.x[nodes[0]])
    if axes is not None and numpy.allclose(axes[:2], numpy.eye(3)[:2]):
        axes = None
    if axes is None and len(nodes) == 1 and not values[1].any() and not values[0][3:].any() and mesh.is_solid(deck, nodes[0]):
        deck.springs.append(Spring(nodes, values[0][:3], "", place))
        return
    ends = (int(nodes[0]), int(nodes[1]) if len(nodes) > 1 else -1)
    deck.links.append(Link(ends, place, name, tuple(values[0]), tuple(values[1]), None if axes is None else tuple(map(tuple, axes[:2])),
                           name.lower()))
