"""Nastran: springs, loads, contact."""

import numpy

from .deck import Contact, Load, Spring
from .faces import faces_by_three
from .nastran_mesh import named
from .nastran_model import straight, table_whole

KNOWN = {"CELAS1", "CELAS2", "PELAS", "CBUSH", "PBUSH", "FORCE", "PLOAD4", "GRAV", "BSURFS", "BCTABLE", "BCPROP"}


def read_acting(deck, tables, mesh):
    read_springs(deck, tables, mesh)
    read_loads(deck, tables, mesh)
    read_contact(deck, tables, mesh)


def property_values(tables, name, read):
    """Number -> value of a property of springs."""
    found = {}
    for table in named(tables, name):
        for row in range(len(table)):
            number = int(table.whole(0, 1)[row, 0])
            if number in found:
                raise table.place(row).wrong(f"property {number} stands twice")
            found[number] = read(table, row)
    return found


def note_rest(deck, table, row, words, read):
    """Lists what a card of springs has beside the stiffness."""
    if any(words):
        deck.note(table.place(row), f"{table.name}: only {read} read; {', '.join(filter(None, words))}: not taken")


def bar_stiffness(deck, table, row):
    """K of PELAS."""
    note_rest(deck, table, row, table.words(row)[2:], "K is")
    return float(table.real(1, 2)[row, 0])


def bush_stiffness(deck, table, row):
    """K1 to K3 behind the word K of PBUSH; it may also have K4 to K6, damping behind B, loss factors behind GE."""
    words = table.words(row)
    at = words.index("K") if "K" in words else -1
    note_rest(deck, table, row, words[1:max(at, 1)] + words[at + 4 if at >= 0 else 1:], "K1 to K3 are")
    return table.real(at + 1, at + 4)[row] if at >= 0 else numpy.zeros(3)


def read_springs(deck, tables, mesh):
    """CELAS1, CELAS2, CBUSH with one grid point, the other end of which is the ground."""
    stiffness = property_values(tables, "PELAS", lambda table, row: bar_stiffness(deck, table, row))
    for table in named(tables, "CELAS1", "CELAS2"):
        for row, values in enumerate(table.whole(2, 6).tolist()):
            place, number = table.place(row), int(table.whole(1, 2)[row, 0]) if table.name == "CELAS1" else 0
            if table.name == "CELAS1" and number not in stiffness:
                raise place.wrong(f"there is no PELAS {number}")
            note_rest(deck, table, row, table.words(row)[6:], "the stiffness is")
            value = stiffness[number] if table.name == "CELAS1" else float(table.real(1, 2)[row, 0])
            ends = [(node, direction) for node, direction in (values[:2], values[2:]) if node]
            if len(ends) != 1 or not 1 <= ends[0][1] <= 3:
                deck.note(place, f"{table.name}: between two grid points, or of a rotation; `joints` of squeal may do this")
                continue
            along = numpy.zeros(3)
            along[ends[0][1] - 1] = value
            spring(deck, mesh, ends[0][0], along, place, table.name)
    bushes = property_values(tables, "PBUSH", lambda table, row: bush_stiffness(deck, table, row))
    for table in named(tables, "CBUSH"):
        for row, (number, first, second) in enumerate(table.whole(1, 4).tolist()):
            place = table.place(row)
            if number not in bushes:
                raise place.wrong(f"there is no PBUSH {number}")
            words = table.words(row) + [""] * 8
            if second or any(words[4:8]) and words[7] != "0":
                deck.note(place, "CBUSH: between two grid points, or in axes of its own; `joints` of squeal may do this")
            else:
                spring(deck, mesh, first, bushes[number], place, "CBUSH")


def spring(deck, mesh, number, stiffness, place, name):
    if (stiffness < 0).any():
        raise place.wrong(f"{name}: the stiffness must not be negative")
    nodes = mesh.nodes.need(numpy.array([number]), "grid point", place)
    if straight(deck, mesh, nodes, place, name):
        deck.springs.append(Spring(nodes, numpy.array(stiffness), "", place))


def read_loads(deck, tables, mesh):
    for table in named(tables, "FORCE"):
        for row, (_, node, system) in enumerate(table.whole(0, 3).tolist()):
            place, factor, vector = table.place(row), table.real(3, 4)[row, 0], table.real(4, 7)[row]
            nodes = mesh.nodes.need(numpy.array([node]), "grid point", place)
            if system not in mesh.systems or mesh.systems[system].cylinder:
                raise place.wrong(f"FORCE: there is no rectangular coordinate system {system}")
            deck.loads.append(Load("", place, nodes=nodes, force=factor * vector @ mesh.systems[system].axes))
    for table in named(tables, "PLOAD4"):
        for row in range(len(table)):
            pressure(deck, mesh, table, row)
    for table in named(tables, "GRAV"):
        for row in range(len(table)):
            if deck.gravity or table.whole(1, 2)[row, 0]:
                deck.note(table.place(row), "GRAV: a second one, or in a coordinate system: not taken")
                continue
            deck.gravity = table.real(2, 3)[row, 0] * table.real(3, 6)[row], table.place(row)


def pressure(deck, mesh, table, row):
    """PLOAD4 on a face of a solid, by two of its corners; a tetrahedron's by one on it and the one that is not."""
    words, place = table.words(row) + [""] * 16, table.place(row)
    values = [table.one_real(row, at, words[at]) for at in (2, 3, 4, 5) if words[at]]
    if not values or any(value != values[0] for value in values) or any(words[8:12]):
        deck.note(place, "PLOAD4: a pressure that varies, or along a direction: not taken")
        return
    if words[6].upper() == "THRU" or not words[6]:
        deck.note(place, "PLOAD4 without a corner of the face: not taken")
        return
    cell = int(mesh.cells.need(table.whole(1, 2)[row], "element", place)[0])
    at = numpy.searchsorted(deck.firsts(), cell, side="right") - 1
    block, local = deck.blocks[at], cell - deck.firsts()[at]
    nodes = block.nodes[local]
    numbers = [table.whole(k, k + 1)[row] for k in ((6, 7) if words[7] else (6,))]
    given = [int(mesh.nodes.need(number, "grid point", place)[0]) for number in numbers]
    if not set(given) <= set(nodes[:block.shape.n_corners].tolist()):
        raise place.wrong("PLOAD4: a grid point is no corner of the element")
    found = [number for number, face in enumerate(block.shape.faces()) if on_face(block.shape, nodes[face], given)]
    if len(found) != 1:
        raise place.wrong("PLOAD4: the grid points do not tell a face of the element")
    deck.loads.append(Load("", place, faces=numpy.array([[cell, found[0]]]), pressure=values[0]))


def on_face(shape, nodes, given):
    """Whether a face, by its nodes, is the one that is told."""
    triangle = len(nodes) in (3, 6)
    corners = nodes[:3 if triangle else 4].tolist()
    if shape.family == "tet":
        return given[0] in corners and (len(given) < 2 or given[1] not in corners)
    if len(given) == 1:
        return triangle and given[0] in corners
    return not triangle and given[0] in corners and given[1] == corners[(corners.index(given[0]) + 2) % 4]


def read_contact(deck, tables, mesh):
    """BSURFS and BCPROP: surfaces; BCTABLE: pairs of them with friction."""
    for table in named(tables, "BSURFS"):
        for row in range(len(table)):
            words = [table_whole(table, row, word) for word in table.words(row) if word]
            if len(words) < 5 or (len(words) - 1) % 4:
                raise table.place(row).wrong("BSURFS: a number, then an element and three corners of its face each")
            rows = numpy.array(words[1:]).reshape(-1, 4)
            corners = mesh.nodes.need(rows[:, 1:], "grid point", table.place(row))
            add_surface(deck, words[0], surface_faces(deck, corners, table.place(row)), table.place(row))
    for table in named(tables, "BCPROP"):
        deck_note_all(deck, table, "BCPROP: surfaces of properties (shells): not understood")
    for table in named(tables, "BCTABLE"):
        for row in range(len(table)):
            words, place = table.words(row) + [""] * 8, table.place(row)
            for at in range(8, len(words) - 5, 8):
                if not words[at]:
                    continue
                names = [str(table_whole(table, row, word)) for word in words[at:at + 2]]
                for name in names:
                    if f"SURFACE_{name}" not in deck.surfaces:
                        raise place.wrong(f"BCTABLE: there is no BSURFS {name}")
                mu = table.one_real(row, at + 3, words[at + 3]) if words[at + 3] else 0.0
                deck.contacts.append(Contact(f"contact_{words[0]}", *(f"SURFACE_{name}" for name in names), place, mu=mu))


def deck_note_all(deck, table, text):
    for row in range(len(table)):
        deck.note(table.place(row), text)


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
