"""Nastran: forces, pressures, gravity of the sets of loads that act. Each card is a table of one row, with the factor of LOAD."""

import numpy

from ..deck import Load
from ..mesh.faces import faces_by_three
from .case import LOADS

KNOWN = set(LOADS)
NOT_TAKEN = {"SPCD": "a displacement given as a load", "RFORCE": "a body that turns", "RFORCE1": "a body that turns",
             "TEMP": "a temperature", "TEMPD": "a temperature"}


def read_loads(deck, tables, mesh, chosen):
    readers = {"FORCE": force, "MOMENT": force, "FORCE1": force_along, "PLOAD4": pressure, "PLOAD": pressure_on_points, "GRAV": gravity}
    for name, read in readers.items():
        for table, factor in chosen.loads_of(tables, name):
            read(deck, mesh, table, factor)
    for name in (name for name in LOADS if name not in readers):
        for table, _ in chosen.loads_of(tables, name):
            deck.note(table.place(0), f"{name}: {NOT_TAKEN.get(name, 'a load that is not understood')}: not taken")


def add_force(deck, mesh, number, vector, place, turns=False):
    """A force or a moment on a grid point."""
    nodes = mesh.known([number])
    if not len(nodes):
        deck.note(place, f"a force on the scalar point {number}: not taken")
        return
    at = mesh.nodes.need(nodes, "grid point", place)
    deck.loads.append(Load("", place, nodes=at, force=0 * vector if turns else vector, moment=vector if turns else None))


def force(deck, mesh, table, factor):
    """FORCE, MOMENT: set, grid point, system, factor, three components."""
    place = table.place(0)
    _, node, system = table.whole(0, 3)[0].tolist()
    if system not in mesh.systems:
        raise place.wrong(f"FORCE: there is no coordinate system {system}")
    numbers = mesh.known([node])
    x = deck.x[mesh.nodes.need(numbers, "grid point", place)[0]] if len(numbers) else numpy.zeros(3)
    vector = factor * table.real(3, 4)[0, 0] * table.real(4, 7)[0] @ mesh.systems[system].directions(x)
    add_force(deck, mesh, node, vector, place, table.name == "MOMENT")


def force_along(deck, mesh, table, factor):
    """FORCE1: set, grid point, force, two grid points that it goes along."""
    place = table.place(0)
    ends = deck.x[mesh.nodes.need(table.whole(3, 5)[0], "grid point", place)]
    along = ends[1] - ends[0]
    if not numpy.linalg.norm(along) > 0:
        raise place.wrong("FORCE1: its two grid points are in one place")
    add_force(deck, mesh, int(table.whole(1, 2)[0, 0]), factor * table.real(2, 3)[0, 0] * along / numpy.linalg.norm(along), place)


def gravity(deck, mesh, table, factor):
    """GRAV: set, system, acceleration, its direction; several add up."""
    place = table.place(0)
    system = mesh.systems.get(int(table.whole(1, 2)[0, 0]))
    if system is None or system.kind != "R":
        deck.note(place, "GRAV: in a system that is not there, or not rectangular: not taken")
        return
    vector = factor * table.real(2, 3)[0, 0] * table.real(3, 6)[0] @ system.axes
    deck.gravity = vector + (deck.gravity[0] if deck.gravity else 0), place


def pressure_on_points(deck, mesh, table, factor):
    """PLOAD: set, pressure, three or four corners of a face; it pushes where a right-hand screw about them goes."""
    place = table.place(0)
    numbers = [number for number in table.whole(2, 6)[0].tolist() if number]
    corners = mesh.nodes.need(numpy.array(numbers, int), "grid point", place)
    faces, missing = faces_by_three(deck, corners[None, :3]) if len(corners) > 2 else (None, numpy.array([True]))
    if missing[0]:
        deck.note(place, "PLOAD: its grid points are on no face of a solid: not taken")
        return
    cell, number = faces[0].tolist()
    block, nodes = nodes_of(deck, cell)
    a, b, c = deck.x[corners[:3]]
    outward = numpy.cross(b - a, c - a) @ (deck.x[corners].mean(axis=0) - deck.x[nodes[:block.shape.n_corners]].mean(axis=0))
    value = factor * table.real(1, 2)[0, 0] * (-1 if outward > 0 else 1)
    deck.loads.append(Load("", place, faces=numpy.array([[cell, number]]), pressure=value))


def nodes_of(deck, cell):
    """Block and nodes of an element."""
    at = numpy.searchsorted(deck.firsts(), cell, side="right") - 1
    return deck.blocks[at], deck.blocks[at].nodes[cell - deck.firsts()[at]]


def pressure(deck, mesh, table, factor):
    """PLOAD4 on a face of a solid, by two of its corners; a tetrahedron's by one on it and the one that is not."""
    place = table.place(0)
    words = table.words(0, 16)
    values = [table.one_real(0, k, words[k]) for k in (2, 3, 4, 5) if words[k]]
    along = any(table.one_real(0, k, words[k]) for k in (9, 10, 11) if words[k])
    if not values or any(value != values[0] for value in values) or along:
        deck.note(place, "PLOAD4: a pressure that varies, or along a direction: not taken")
        return
    if words[6].upper() == "THRU" or not words[6]:
        deck.note(place, "PLOAD4 without a corner of the face: not taken")
        return
    cell, missing = mesh.cells.find(table.whole(1, 2)[0], "element")
    if missing[0]:
        deck.note(place, f"PLOAD4: element {words[1]} is no solid that squeal has: not taken")
        return
    block, nodes = nodes_of(deck, int(cell[0]))
    numbers = [table.whole(k, k + 1)[0] for k in ((6, 7) if words[7] else (6,))]
    given = [int(mesh.nodes.need(number, "grid point", place)[0]) for number in numbers]
    if not set(given) <= set(nodes[:block.shape.n_corners].tolist()):
        raise place.wrong("PLOAD4: a grid point is no corner of the element")
    found = [number for number, face in enumerate(block.shape.faces()) if on_face(block.shape, nodes[face], given)]
    if len(found) != 1:
        raise place.wrong("PLOAD4: the grid points do not tell a face of the element")
    deck.loads.append(Load("", place, faces=numpy.array([[int(cell[0]), found[0]]]), pressure=factor * values[0]))


def on_face(shape, nodes, given):
    """Whether a face, by its nodes, is the one that is told."""
    triangle = len(nodes) in (3, 6)
    corners = nodes[:3 if triangle else 4].tolist()
    if shape.family == "tet":
        return given[0] in corners and (len(given) < 2 or given[1] not in corners)
    if len(given) == 1:
        return triangle and given[0] in corners
    return not triangle and given[0] in corners and given[1] == corners[(corners.index(given[0]) + 2) % 4]
