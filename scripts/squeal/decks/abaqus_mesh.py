"""Abaqus: nodes, elements, sets and surfaces."""

import re

import numpy

from .deck import Block, Place, shape_of
from .faces import boundary_faces
from .text import parse_all, slow_table, table, whole

MOST = 20000000  # numbers that GENERATE may make
# Type -> shape, and what differs from squeal's element
TYPES = {
    "C3D4": ("tet4", ""), "C3D6": ("wedge6", ""), "C3D8I": ("hex8", ""), "C3D20": ("hex20", ""), "C3D27": ("hex27", ""),
    "C3D8": ("hex8", "C3D8 (full integration, mean dilatation in Abaqus) becomes hex8 of squeal, QM6, which is that of C3D8I"),
    "C3D8R": ("hex8", "C3D8R (one point, hourglass control) becomes hex8 of squeal, QM6, which is that of C3D8I"),
    "C3D10": ("tet10", "C3D10: squeal's mass is exact, that of CalculiX is of 4 points, which moves frequencies by up to 4e-3"),
    "C3D10M": ("tet10", "C3D10M (modified) becomes the ordinary tet10 of squeal"),
    "C3D15": ("wedge15", "C3D15: squeal integrates it more exactly than with 9 points"),
    "C3D20R": ("hex20", "C3D20R (8 points) becomes hex20 of squeal with 27 points"),
}
TYPES |= {f"{name}H": (shape, f"{name}H (hybrid) becomes {shape} of squeal without a pressure of its own")
          for name, (shape, _) in list(TYPES.items()) if name in ("C3D4", "C3D8", "C3D10", "C3D20", "C3D6", "C3D15", "C3D10M")}
SPRINGS = {"SPRING1": 1, "SPRING2": 2, "SPRINGA": 2}
FACE = re.compile(r"S(\d)$")


def check_ids(ids, lines, file, what):
    """Numbers are positive."""
    bad = numpy.flatnonzero((ids < 1) | (ids >= 10**15))
    if len(bad):
        raise Place(file, int(lines[bad[0]])).wrong(f"the number {ids[bad[0]]} of {what} is not positive, or too large")


def do_node(reader, scope, card):
    file = card.place.file
    rows, lines = table(card.pieces, 4, float, file)
    ids = rows[:, 0].astype(numpy.int64) if (numpy.abs(rows[:, 0]) < 1e15).all() else numpy.full(len(rows), -1)
    bad = numpy.flatnonzero(ids != rows[:, 0])
    if len(bad):
        raise Place(file, int(lines[bad[0]])).wrong("a line of *NODE begins with a whole number")
    check_ids(ids, lines, file, "a node")
    x = rows[:, 1:]
    system = card.options.get("SYSTEM", "R").upper()
    if system == "C":
        angle = numpy.radians(x[:, 1])
        x = numpy.stack([x[:, 0] * numpy.cos(angle), x[:, 0] * numpy.sin(angle), x[:, 2]], axis=1)
    elif system != "R":
        raise card.place.wrong(f"*NODE, SYSTEM={system}: only R and C are read")
    at = reader.deck.add_nodes(numpy.ascontiguousarray(x @ scope.turn.T + scope.shift))
    scope.nodes.add(ids, at, lines, file)
    if card.options.get("NSET"):
        join(scope.node_sets, reader.deck.node_sets, scope, card.need("NSET"), at, card.place)


def do_element(reader, scope, card):
    kind, file = card.need("TYPE"), card.place.file
    if kind in TYPES:
        shape, differs = shape_of(TYPES[kind][0]), TYPES[kind][1]
        rows, lines = table(card.pieces, 1 + shape.n_nodes, int, file)
        check_ids(rows[:, 0], lines, file, "an element")
        nodes = scope.nodes.need(rows[:, 1:], "node", lambda row: Place(file, int(lines[row])))
        if not len(rows):
            return
        cells = reader.deck.add_block(Block(shape, kind, rows[:, 0], nodes, card.place))
        scope.cells.add(rows[:, 0], cells, lines, file)
        if differs:
            reader.deck.differ(card.place, differs)
        if card.options.get("ELSET"):
            join(scope.cell_sets, reader.deck.cell_sets, scope, card.need("ELSET"), cells, card.place)
    else:
        other_elements(reader, scope, card, kind)


def other_elements(reader, scope, card, kind):
    """Springs, and elements that are none of squeal's: their numbers may be in sets."""
    if kind in SPRINGS:
        pieces = [slow_table(text, first, 1 + SPRINGS[kind], int, card.place.file) for text, first in card.pieces]
        for rows, lines in pieces:
            for row, line in zip(rows.tolist(), lines.tolist()):
                place = Place(card.place.file, line)
                scope.holders[row[0]] = kind, scope.nodes.need(numpy.array(row[1:]), "node", place), place
        ids = numpy.array([row[0] for rows, _ in pieces for row in rows.tolist()], int)
        lines = numpy.concatenate([lines for _, lines in pieces] or [numpy.empty(0, int)])
    else:
        found, goes_on = [], False
        for place, fields in card.rows():
            if not goes_on:
                found.append((whole(fields[0], place, "the number of an element"), place.line))
            goes_on = len(fields) in (8, 16) and line_goes_on(card, place.line)
        ids, lines = (numpy.array(column, int) for column in zip(*found)) if found else (numpy.empty(0, int),) * 2
        plane = "; a surface of Gmsh? its .msh file keeps surfaces, and needs no import" if kind.startswith("CPS") else ""
        reader.deck.note(card.place, f"*ELEMENT, TYPE={kind}: {len(ids)} elements of a type that squeal has not{plane}")
    scope.others.add(ids, ids, lines, card.place.file)
    if card.options.get("ELSET"):
        scope.other_sets.setdefault(card.need("ELSET"), []).extend(ids.tolist())


def line_goes_on(card, number):
    """Whether a line of data ends with a comma."""
    for text, first in card.pieces:
        lines = text.split(b"\n")
        if first <= number < first + len(lines):
            return lines[number - first].rstrip().endswith(b",")
    return False


def join(local, all_sets, scope, name, members, place):
    """Adds members to a set, in the scope and in the deck."""
    if name in local:
        members = numpy.concatenate([local[name], members])
    local[name] = numpy.unique(members)
    all_sets[scope.full(name)] = local[name], place


def numbers_in(card, known, what):
    """Numbers of a set whose data are nothing else, with their line; None where there are names among them."""
    found = []
    for text, first in card.pieces:
        flat = text.strip().replace(b",\n", b"\n").replace(b"\n", b",").rstrip(b", ")
        values = parse_all(flat, int) if flat else numpy.empty(0, int)
        if values is None or len(values) != flat.count(b",") + (1 if flat else 0):
            return None
        found.append(values)
    ids = numpy.concatenate(found or [numpy.empty(0, int)])
    at, missing = known.find(ids, what)
    return None if missing.any() else at


def generated(card, known, what, notes):
    """Members of a set by first, last, step."""
    members = []
    for place, fields in card.rows():
        values = [whole(word, place) for word in fields]
        if not 2 <= len(values) <= 3:
            raise place.wrong("GENERATE needs first, last and a step")
        first, last, step = values if len(values) == 3 else (*values, 1)
        if step < 1 or last < first or (last - first) // step > MOST:
            raise place.wrong(f"GENERATE: from {first} to {last} by {step} is no range")
        at, missing = known.find(numpy.arange(first, last + 1, step), what)
        if missing.all():
            raise place.wrong(f"GENERATE: there is no {what} from {first} to {last} by {step}")
        if missing.any():
            notes.append((place, f"GENERATE: {missing.sum()} of the numbers are no {what}s"))
        members.append(at[~missing])
    return numpy.concatenate(members or [numpy.empty(0, int)])


def do_nset(reader, scope, card):
    name = card.need("NSET")
    inner, _ = instance_of(reader, scope, card)
    if card.options.get("ELSET"):
        members = nodes_of_cells(reader, inner, card)
    elif "GENERATE" in card.options:
        members = generated(card, inner.nodes, "node", reader.deck.notes)
    else:
        members = numbers_in(card, inner.nodes, "node")
        if members is None:
            members = numpy.concatenate([reader_nodes(reader, inner, word, place) for place, fields in card.rows()
                                         for word in fields if word] or [numpy.empty(0, int)])
    join(scope.node_sets, reader.deck.node_sets, scope, name, members, card.place)


def nodes_of_cells(reader, scope, card):
    """Nodes of the elements of a set."""
    cells = reader_cells(reader, scope, card.need("ELSET"), card.place)
    firsts = reader.deck.firsts()
    parts = [block.nodes[cells[(cells >= low) & (cells < high)] - low].ravel()
             for block, low, high in zip(reader.deck.blocks, firsts, firsts[1:])]
    return numpy.unique(numpy.concatenate(parts))


def do_elset(reader, scope, card):
    name = card.need("ELSET")
    inner, _ = instance_of(reader, scope, card)
    if "GENERATE" in card.options:
        known = inner.cells if inner.cells.n else inner.others
        members = generated(card, known, "element", reader.deck.notes)
        if known is inner.others:
            scope.other_sets.setdefault(name, []).extend(members.tolist())
            return
    else:
        members = numbers_in(card, inner.cells, "element")
        if members is None:
            members = mixed_cells(reader, scope, inner, card)
    join(scope.cell_sets, reader.deck.cell_sets, scope, name, members, card.place)


def mixed_cells(reader, scope, inner, card):
    """Members by numbers and names, some of which may be elements that squeal has not."""
    members = []
    for place, fields in card.rows():
        for word in filter(None, fields):
            if word.isdigit():
                _, missing = inner.others.find([int(word)], "element")
                if not missing[0]:
                    scope.other_sets.setdefault(card.need("ELSET"), []).append(int(word))
                    continue
            elif word.upper() in inner.other_sets and word.upper() not in inner.cell_sets:
                scope.other_sets.setdefault(card.need("ELSET"), []).extend(inner.other_sets[word.upper()])
                continue
            members.append(reader_cells(reader, inner, word, place))
    return numpy.concatenate(members or [numpy.empty(0, int)])


def instance_of(reader, scope, card):
    """The instance that an option names, or the scope itself."""
    name = card.options.get("INSTANCE", "").strip('"').upper()
    if not name:
        return scope, None
    if name not in reader.instances:
        raise card.place.wrong(f"there is no instance {name}")
    return reader.instances[name], name


def reader_nodes(reader, scope, word, place):
    """Nodes by a number or the name of a set."""
    inner, name = reader.split(word.strip('"').upper(), scope)
    if name in inner.node_sets:
        return inner.node_sets[name]
    if name.isdigit():
        return inner.nodes.need(numpy.array([int(name[:15])]), "node", place)
    raise place.wrong(f"'{word[:40]}' is neither a set of nodes nor the number of one")


def reader_cells(reader, scope, word, place):
    """Cells by a number or the name of a set."""
    inner, name = reader.split(word.strip('"').upper(), scope)
    if name in inner.cell_sets:
        return inner.cell_sets[name]
    if name.isdigit():
        return inner.cells.need(numpy.array([int(name[:15])]), "element", place)
    raise place.wrong(f"'{word[:40]}' is neither a set of elements nor the number of one")


def do_surface(reader, scope, card):
    name, kind = card.need("NAME"), card.options.get("TYPE", "ELEMENT").upper()
    if kind == "NODE":
        nodes = [reader_nodes(reader, scope, fields[0], place) for place, fields in card.rows()]
        members = numpy.unique(numpy.concatenate(nodes or [numpy.empty(0, int)]))
        scope.surfaces[name] = scope.full(name)
        reader.deck.surfaces[scope.full(name)] = boundary_faces(reader.deck, members), card.place
        reader.deck.note(card.place, f"*SURFACE, TYPE=NODE {name}: taken as the faces all of whose nodes it has")
        return
    if kind != "ELEMENT":
        reader.deck.note(card.place, f"*SURFACE, TYPE={kind}: not understood")
        return
    found = [surface_row(reader, scope, place, fields) for place, fields in card.rows()]
    faces = numpy.unique(numpy.concatenate(found or [numpy.empty((0, 2), int)]), axis=0)
    if not len(faces):
        raise card.place.wrong(f"*SURFACE {name} has no faces")
    scope.surfaces[name] = scope.full(name)
    reader.deck.surfaces[scope.full(name)] = faces, card.place


def surface_row(reader, scope, place, fields):
    """Faces (cell, face) of a line: a set or an element, and S1 to S6, or all that are outside."""
    cells = reader_cells(reader, scope, fields[0], place)
    if len(fields) < 2 or not fields[1]:
        faces = boundary_faces(reader.deck)
        return faces[numpy.isin(faces[:, 0], cells)]
    found = FACE.match(fields[1].upper())
    if not found:
        raise place.wrong(f"'{fields[1][:40]}' is no face of a volume element (S1 to S6)")
    return check_faces(reader.deck, cells, int(found[1]), place)


def check_faces(deck, cells, number, place):
    """Face `number`, from 1, of cells that have one."""
    firsts = deck.firsts()
    for block, low, high in zip(deck.blocks, firsts, firsts[1:]):
        if ((cells >= low) & (cells < high)).any() and not 1 <= number <= len(block.shape.faces()):
            raise place.wrong(f"elements of type {block.kind} have no face {number}")
    return numpy.stack([cells, numpy.full(len(cells), number - 1)], axis=1)


def do_transform(reader, scope, card):
    name = card.need("NSET")
    reader.turned[id(scope), name] = reader_nodes(reader, scope, name, card.place), card.place
    reader.deck.note(card.place, f"*TRANSFORM: axes at the nodes of {name}; supports and forces there are not taken")


CARDS = {"NODE": do_node, "ELEMENT": do_element, "NSET": do_nset, "ELSET": do_elset, "SURFACE": do_surface,
         "TRANSFORM": do_transform}
