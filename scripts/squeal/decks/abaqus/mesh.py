"""Abaqus: nodes and elements."""

import numpy

from .beams import KINDS as BEAMS
from .sets import NONE, join
from .words import choice
from ..deck import Block, Place, shape_of
from ..mesh.shells import add_shells
from ..text import fast_table, real, slow_table, whole

# Type -> shape, and what differs from squeal's element
TYPES = {
    "C3D4": ("tet4", "C3D4: squeal's mass is exact, that of CalculiX is of one point, which moves frequencies"),
    "C3D6": ("wedge6", "C3D6: squeal has 6 points, CalculiX 2, which makes its wedges much softer in bending"),
    "C3D8I": ("hex8", ""), "C3D20": ("hex20", ""), "C3D27": ("hex27", ""),
    "C3D8": ("hex8", "C3D8 (full integration, mean dilatation in Abaqus) becomes hex8 of squeal, QM6, which is that of C3D8I"),
    "C3D8R": ("hex8", "C3D8R (one point, hourglass control) becomes hex8 of squeal, QM6, which is that of C3D8I"),
    "C3D10": ("tet10", "C3D10: squeal's mass is exact, that of CalculiX is of 4 points, which moves frequencies by up to 4e-3"),
    "C3D10M": ("tet10", "C3D10M (modified) becomes the ordinary tet10 of squeal"),
    "C3D15": ("wedge15", "C3D15: squeal integrates it more exactly than with 9 points"),
    "C3D20R": ("hex20", "C3D20R (8 points) becomes hex20 of squeal with 27 points"),
}
HYBRID = "C3D4", "C3D8", "C3D8R", "C3D8I", "C3D10", "C3D10M", "C3D20", "C3D20R", "C3D6", "C3D15"
TYPES |= {f"{name}H": (TYPES[name][0], f"{name}H (hybrid) becomes {TYPES[name][0]} of squeal without a pressure of its own")
          for name in HYBRID}
COUPLED = "C3D4", "C3D6", "C3D8", "C3D8R", "C3D10", "C3D10M", "C3D20", "C3D20R"
TYPES |= {f"{name}T": (TYPES[name][0], f"{name}T: its temperature is no unknown of squeal; else as {name}") for name in COUPLED}
SHELLS = {"S3": 3, "S3R": 3, "S3RS": 3, "STRI3": 3, "S4": 4, "S4R": 4, "S4RS": 4, "S4R5": 4, "S6": 6,
          "STRI65": 6, "S8": 8, "S8R": 8, "S8R5": 8}
HOLDERS = {"SPRING1": 1, "SPRING2": 2, "SPRINGA": 2, "DASHPOT1": 1, "DASHPOT2": 2, "DASHPOTA": 2, "MASS": 1, "ROTARYI": 1,
           "CONN3D2": 2, "DCOUP3D": 1} | BEAMS  # elements of one or two nodes that join or load them


def check_ids(ids, lines, file, what):
    """Numbers are positive."""
    bad = numpy.flatnonzero((ids < 1) | (ids >= 10**15))
    if len(bad):
        raise Place(file, int(lines[bad[0]])).wrong(f"the number {ids[bad[0]]} of {what} is not positive, or too large")


def places(card):
    """Numbers and places [n][4] of nodes, and their lines. What is left out is 0; numbers behind the places (of normals) are not
    needed."""
    rows, lines = [numpy.empty((0, 4))], [NONE]
    for text, first in card.pieces:
        found = fast_table(text, first, 4, float) if text.strip() else None
        if found is None:
            said = list(card.rows_of(text, first))
            found = ([[real(word or "0", place) for word in [*fields, "0", "0", "0"][:4]] for place, fields in said],
                     [place.line for place, _ in said])
        rows.append(numpy.reshape(found[0], (-1, 4)))
        lines.append(numpy.array(found[1], int))
    return numpy.concatenate(rows), numpy.concatenate(lines)


def do_node(reader, scope, card):
    file = card.place.file
    rows, lines = places(card)
    ids = rows[:, 0].astype(numpy.int64) if (numpy.abs(rows[:, 0]) < 1e15).all() else numpy.full(len(rows), -1)
    bad = numpy.flatnonzero(ids != rows[:, 0])
    if len(bad):
        raise Place(file, int(lines[bad[0]])).wrong("a line of *NODE begins with a whole number")
    check_ids(ids, lines, file, "a node")
    x = rows[:, 1:]
    system = choice(card.options.get("SYSTEM", "R"), "R", "C", "S")
    if system == "C":
        angle = numpy.radians(x[:, 1])
        x = numpy.stack([x[:, 0] * numpy.cos(angle), x[:, 0] * numpy.sin(angle), x[:, 2]], axis=1)
    elif system != "R":
        raise card.place.wrong(f"*NODE, SYSTEM={system}: only R and C are read")
    at = reader.deck.add_nodes(numpy.ascontiguousarray(x @ scope.turn.T + scope.shift))
    scope.nodes.add(ids, at, lines, file)
    if card.options.get("NSET"):
        join(scope.node_sets, reader.deck.node_sets, scope, card.need("NSET"), at, card.place)


def element_rows(reader, card, width):
    """Numbers [n][width] of elements and their lines; where each line has as many as an element needs or more, its first ones."""
    rows, lines = [numpy.empty((0, width), int)], [NONE]
    for text, first in card.pieces:
        if not text.strip():
            continue
        found = fast_table(text, first, width, int)
        if found is None:
            said = list(card.rows_of(text, first))
            if all(len(fields) >= width for _, fields in said) and any(len(fields) > width for _, fields in said):
                reader.deck.note(said[0][0], f"*ELEMENT: lines with more than the {width} numbers of an element of TYPE="
                                             f"{card.options['TYPE']}: the first are taken, as CalculiX does")
                found = [[whole(word, place) for word in fields[:width]] for place, fields in said], [place.line for place, _ in said]
            else:
                found = slow_table(text, first, width, int, card.place.file)
        rows.append(numpy.array(found[0], int))
        lines.append(numpy.array(found[1], int))
    return numpy.concatenate(rows), numpy.concatenate(lines)


def do_element(reader, scope, card):
    kind, file = card.need("TYPE"), card.place.file
    if kind in TYPES:
        shape, differs = shape_of(TYPES[kind][0]), TYPES[kind][1]
        rows, lines = element_rows(reader, card, 1 + shape.n_nodes)
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
    elif kind in SHELLS:
        shell_elements(reader, scope, card, kind)
    elif kind.startswith("C3D"):
        raise card.place.wrong(f"*ELEMENT, TYPE={kind}: squeal has no such solid, and without it the body is another")
    else:
        other_elements(reader, scope, card, kind)


def shell_elements(reader, scope, card, kind):
    """Shells: solids of their thickness."""
    file = card.place.file
    rows, lines = element_rows(reader, card, 1 + SHELLS[kind])
    check_ids(rows[:, 0], lines, file, "an element")
    nodes = scope.nodes.need(rows[:, 1:], "node", lambda row: Place(file, int(lines[row])))
    if not len(rows):
        return
    cells = add_shells(reader.deck, kind, rows[:, 0], nodes, card.place)
    scope.cells.add(rows[:, 0], cells, lines, file)
    if card.options.get("ELSET"):
        join(scope.cell_sets, reader.deck.cell_sets, scope, card.need("ELSET"), cells, card.place)


def other_elements(reader, scope, card, kind):
    """Springs and the like, and elements that are none of squeal's: their numbers may be in sets."""
    if kind in HOLDERS:
        pieces = [slow_table(text, first, 1 + HOLDERS[kind], int, card.place.file) for text, first in card.pieces]
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


CARDS = {"NODE": do_node, "ELEMENT": do_element}
