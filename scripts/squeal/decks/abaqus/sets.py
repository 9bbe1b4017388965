"""Abaqus: sets of nodes and elements, and surfaces. Members that are not in the file, or no volume elements, are listed."""

import re

import numpy

from .words import choice, label
from ..mesh.faces import boundary_faces
from ..text import parse_all, whole

MOST = 20000000  # numbers that GENERATE may make
FACE = re.compile(r"S(\d)$")
SHELL_FACES = {"SNEG": "S1", "SPOS": "S2", "E1": "S3", "E2": "S4", "E3": "S5", "E4": "S6"}  # of the solids that shells become
NONE, NO_FACES = numpy.empty(0, int), numpy.empty((0, 2), int)


def join(local, all_sets, scope, name, members, place):
    """Adds members to a set, in the scope and in the deck."""
    if name in local:
        members = numpy.concatenate([local[name], members])
    local[name] = numpy.unique(members)
    all_sets[scope.full(name)] = local[name], place


def numbers_in(card):
    """Numbers of a set whose data are nothing else; None where there are names among them."""
    found = []
    for text, _ in card.pieces:
        flat = text.strip().replace(b",\n", b"\n").replace(b"\n", b",").rstrip(b", ")
        values = parse_all(flat, int) if flat else NONE
        if values is None or len(values) != flat.count(b",") + (1 if flat else 0):
            return None
        found.append(values)
    return numpy.concatenate([NONE, *found])


def generated(card):
    """Numbers of a set by first, last, step."""
    ranges = []
    for place, fields in card.rows():
        values = [whole(word, place) for word in fields]
        if not 1 <= len(values) <= 3:
            raise place.wrong("GENERATE needs first, last and a step")
        first, last, step = [*values, *(values if len(values) == 1 else []), 1][:3]
        if step < 1 or last < first or (last - first) // step > MOST:
            raise place.wrong(f"GENERATE: from {first} to {last} by {step} is no range")
        ranges.append(numpy.arange(first, last + 1, step))
    return numpy.concatenate([NONE, *ranges])


def there(reader, card, known, ids, what, others=None):
    """Members of a set among numbers; those that are not in the file are listed, but for numbers of `others`."""
    at, missing = known.find(ids, what)
    absent = numpy.asarray(ids)[missing]
    if others is not None and len(absent):
        absent = absent[others.find(absent, what)[1]]
    if len(absent):
        reader.deck.note(card.place, f"*{card.keyword}: {len(absent)} of its numbers are no {what}s of the file, the first {absent[0]}")
    return at[~missing]


def do_nset(reader, scope, card):
    name = card.need("NSET")
    inner = instance_of(reader, scope, card)
    ids = generated(card) if "GENERATE" in card.options else numbers_in(card)
    if card.options.get("ELSET"):
        members = nodes_of_cells(reader, inner, card)
    elif ids is not None:
        members = there(reader, card, inner.nodes, ids, "node")
    else:
        members = numpy.concatenate([NONE, *(reader_nodes(reader, inner, word, place) for place, fields in card.rows()
                                             for word in fields if word)])
    join(scope.node_sets, reader.deck.node_sets, scope, name, members, card.place)


def nodes_of_cells(reader, scope, card):
    """Nodes of the elements of a set."""
    cells = reader_cells(reader, scope, card.options["ELSET"], card.place)
    firsts = reader.deck.firsts()
    parts = [block.own_nodes()[cells[(cells >= low) & (cells < high)] - low].ravel()
             for block, low, high in zip(reader.deck.blocks, firsts, firsts[1:])]
    return numpy.unique(numpy.concatenate([NONE, *parts]))


def do_elset(reader, scope, card):
    name = card.need("ELSET")
    inner = instance_of(reader, scope, card)
    ids = generated(card) if "GENERATE" in card.options else numbers_in(card)
    if ids is None:
        members = mixed_cells(reader, scope, inner, card)
    else:
        of_others = ids[~inner.others.find(ids, "element")[1]]
        members = there(reader, card, inner.cells, ids, "element", inner.others)
        if len(of_others):
            scope.other_sets.setdefault(name, []).extend(of_others.tolist())
            if not len(members):
                return
    join(scope.cell_sets, reader.deck.cell_sets, scope, name, members, card.place)


def mixed_cells(reader, scope, inner, card):
    """Members by numbers and names, some of which may be elements that squeal has not."""
    members = [NONE]
    for place, fields in card.rows():
        for word in filter(None, fields):
            name = label(word)
            others = inner.other_sets.get(name, [])
            if name.isdigit() and not inner.others.find([int(name[:15])], "element")[1][0]:
                others = [int(name[:15])]
            if others:
                scope.other_sets.setdefault(card.need("ELSET"), []).extend(others)
            if not others or name in inner.cell_sets:
                members.append(reader_cells(reader, inner, word, place))
    return numpy.concatenate(members)


def instance_of(reader, scope, card):
    """The instance that an option names, or the scope itself."""
    name = label(card.options.get("INSTANCE", ""))
    if not name:
        return scope
    if name not in reader.instances:
        raise card.place.wrong(f"there is no instance {name}")
    return reader.instances[name]


def reader_nodes(reader, scope, word, place):
    """Nodes by a number or the name of a set; a number that is no node is listed."""
    inner, name = reader.split(label(word), scope)
    if name in inner.node_sets:
        return inner.node_sets[name]
    if name.isdigit():
        at, missing = inner.nodes.find([int(name[:15])], "node")
        if missing[0]:
            reader.deck.note(place, f"node {name[:15]} is not in the file")
        return at[~missing]
    raise place.wrong(f"'{word[:40]}' is neither a set of nodes nor the number of one")


def reader_cells(reader, scope, word, place):
    """Cells by a number or the name of a set; elements that are none of squeal's are listed."""
    inner, name = reader.split(label(word), scope)
    if name in inner.cell_sets:
        return inner.cell_sets[name]
    if name in inner.other_sets:
        reader.deck.note(place, f"the elements of {name} are none of squeal's: not taken")
        return NONE
    if name.isdigit():
        at, missing = inner.cells.find([int(name[:15])], "element")
        if missing[0]:
            absent = inner.others.find([int(name[:15])], "element")[1][0]
            reader.deck.note(place, f"element {name[:15]} is {'not in the file' if absent else 'none of squeal: not taken'}")
        return at[~missing]
    raise place.wrong(f"'{word[:40]}' is neither a set of elements nor the number of one")


def do_surface(reader, scope, card):
    name, faces = card.need("NAME"), NO_FACES
    kind = choice(card.options.get("TYPE", "ELEMENT"), "ELEMENT", "NODE", "SEGMENTS", "CYLINDER", "REVOLUTION", "CUTTING SURFACE", "USER")
    if "COMBINE" in card.options:
        faces = union_of(reader, scope, card)
    elif kind == "NODE":
        nodes = [reader_nodes(reader, scope, fields[0], place) for place, fields in card.rows()]
        nodes = reader.surface_nodes[scope.full(name)] = numpy.unique(numpy.concatenate([NONE, *nodes]))
        faces = boundary_faces(reader.deck, nodes)
        reader.deck.note(card.place, f"*SURFACE, TYPE=NODE {name}: taken as the faces all of whose nodes it has")
    elif kind == "ELEMENT":
        found = [surface_row(reader, scope, place, fields) for place, fields in card.rows()]
        faces = numpy.unique(numpy.concatenate([NO_FACES, *found]), axis=0)
        if not len(faces):
            reader.deck.note(card.place, f"*SURFACE {name} has no faces of volume elements")
    else:
        reader.deck.note(card.place, f"*SURFACE, TYPE={kind}: not understood")
    if name in scope.surfaces:
        faces = numpy.unique(numpy.concatenate([reader.deck.surfaces[scope.full(name)][0], faces]), axis=0)
    scope.surfaces[name] = scope.full(name)
    reader.deck.surfaces[scope.full(name)] = faces, card.place


def union_of(reader, scope, card):
    """Faces of the surfaces that a card combines."""
    how = choice(card.options.pop("COMBINE"), "UNION", "INTERSECTION", "DIFFERENCE")
    if how != "UNION":
        raise card.place.wrong(f"*SURFACE, COMBINE={how}: only UNION is read")
    found = [reader.deck.surfaces[surface_of(reader, scope, word, place)][0] for place, fields in card.rows()
             for word in filter(None, fields)]
    return numpy.unique(numpy.concatenate([NO_FACES, *found]), axis=0)


def surface_of(reader, scope, word, place):
    """The name of a surface in the deck."""
    inner, name = reader.split(label(word), scope)
    if name not in inner.surfaces:
        raise place.wrong(f"there is no surface '{word[:60]}'")
    return inner.surfaces[name]


def surface_row(reader, scope, place, fields):
    """Faces (cell, face) of a line: a set or an element, and S1 to S6, or all that are outside."""
    cells = reader_cells(reader, scope, fields[0], place)
    if len(fields) < 2 or not fields[1]:
        faces = boundary_faces(reader.deck)
        return faces[numpy.isin(faces[:, 0], cells)]
    found = FACE.match(SHELL_FACES.get(fields[1].upper(), fields[1].upper()))
    if not found:
        reader.deck.note(place, f"*SURFACE: '{fields[1][:40]}' is no face of a volume element (S1 to S6): not taken")
        return NO_FACES
    return check_faces(reader, cells, int(found[1]), place)


def check_faces(reader, cells, number, place):
    """Face `number`, from 1, of cells; those that have none are listed, and must not be all."""
    firsts, without = reader.deck.firsts(), numpy.zeros(len(cells), bool)
    for block, low, high in zip(reader.deck.blocks, firsts, firsts[1:]):
        if not 1 <= number <= len(block.shape.faces()):
            without |= (cells >= low) & (cells < high)
            if len(cells) and without.all():
                raise place.wrong(f"elements of type {block.kind} have no face {number}")
    if without.any():
        reader.deck.note(place, f"{without.sum()} of {len(cells)} elements have no face {number}: not taken")
    return numpy.stack([cells[~without], numpy.full((~without).sum(), number - 1)], axis=1)


CARDS = {"NSET": do_nset, "ELSET": do_elset, "SURFACE": do_surface}
