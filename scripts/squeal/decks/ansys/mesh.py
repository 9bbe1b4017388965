"""Ansys: nodes, elements with their degenerate shapes, components, coordinate systems."""

import re

import numpy

from .sections import BEAMS, SHELLS, add_shell_cells
from ..deck import Block, Index, shape_of
from ..mesh.middles import fill_middles

KNOWN = {"ET", "LOCAL"}
MOST = 10**9
# Number of a type -> nodes
SOLIDS = {185: 8, 45: 8, 186: 20, 95: 20, 187: 10, 92: 10, 285: 4}
JOINTS = {21, 14, 184, 179, *BEAMS}  # ansys/joined.py, bolts.py, sections.py
FACETS = {173: "contact", 174: "contact", 175: "contact", 170: "target"}  # elements on surfaces
DIFFERS = {("hex8", 185): "SOLID185 becomes hex8 of squeal, QM6, which is that of its enhanced strains, KEYOPT(2) = 3 (or 2)",
           ("hex8", 45): "SOLID45 becomes hex8 of squeal, QM6, which is that with its extra shapes",
           ("hex20", 186): "SOLID186 (reduced integration by default) becomes hex20 of squeal with 27 points",
           ("hex20", 95): "SOLID95 becomes hex20 of squeal with 27 points",
           ("tet4", 285): "SOLID285 (with a pressure of its own) becomes the ordinary tet4 of squeal, which is too stiff"}
# Of hexahedra in which nodes are the same: corners that must be equal, places of the nodes of the shape
DEGENERATE = {
    8: [(((2, 3), (4, 5), (4, 6), (4, 7)), ("tet4", (0, 1, 2, 4))),
        (((4, 5), (4, 6), (4, 7)), ("pyramid", ())),
        (((2, 3), (6, 7)), ("wedge6", (0, 1, 2, 4, 5, 6))), ((), ("hex8", range(8)))],
    20: [(((2, 3), (4, 5), (4, 6), (4, 7)), ("tet10", (0, 1, 2, 4, 8, 9, 11, 16, 17, 18))),
         (((4, 5), (4, 6), (4, 7)), ("pyramid", ())),
         (((2, 3), (6, 7)), ("wedge15", (0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18))), ((), ("hex20", range(20)))],
    10: [((), ("tet10", range(10)))], 4: [((), ("tet4", range(4)))]}
# Face number of SFE -> ours, from 0
FACES = {"hex": {1: 0, 2: 2, 3: 3, 4: 4, 5: 5, 6: 1}, "wedge": {1: 0, 2: 2, 3: 3, 5: 4, 4: 4, 6: 1},
         "tet": {1: 0, 2: 1, 3: 2, 4: 3, 5: 3}}


FIRST_ORDER = {"tet10": "tet4", "wedge15": "wedge6", "hex20": "hex8"}


class Mesh:
    """Nodes, elements and what each has: material, system; components; elements on surfaces by their real constants."""

    def __init__(self):
        self.nodes, self.cells, self.others = Index(), Index(), Index()
        self.materials, self.systems_of, self.components = [], [], {}
        self.turned, self.facets, self.types = {}, {}, {}  # node -> its own axes, ...
        self.joints, self.options = [], {}  # (type, head, nodes, place) of MASS21 and the like; type -> {number of KEYOPT: value}
        self.behaviour = {}  # type -> KEYOPT(12): what contact does where it is not 0: rough, without separation, bonded
        self.own_held = {}  # node -> {own direction: (value, place)}
        self.selected = "ALL"  # nodes that ALL means: an array, or "" where this is not known
        self.systems = {0: (False, numpy.eye(3), numpy.zeros(3)), 1: (True, numpy.eye(3), numpy.zeros(3))}
        self.shells, self.waiting_shells = [], []  # (type, cells, head, place); (type, head, nodes, rows, block) before they are cells
        self.waiting = []  # (block, head, lines): solids before their middles are there


def positive(block, ids, what, rows=None):
    bad = numpy.flatnonzero((ids < 1) | (ids > MOST))
    if len(bad):
        row = int(bad[0]) if rows is None else int(rows[bad[0]])
        raise block.place(row).wrong(f"the number {ids[bad[0]]} of {what} is not positive, or too large")


def read_nodes(deck, mesh, block):
    """NBLOCK, fields, SOLID, largest, count."""
    letters = block.letters()
    if not 1 <= block.n_whole < len(block.fields):
        raise block.header.place.wrong("NBLOCK: its format has no coordinates")
    ids, values = block.wholes(letters)[:, 0], block.reals(letters)
    values = numpy.pad(values, ((0, 0), (0, max(0, 6 - values.shape[1]))))
    announced = block.header.whole(4, len(ids))
    if announced != len(ids):
        raise block.header.place.wrong(f"NBLOCK announces {announced} nodes and has {len(ids)}: is the file damaged?")
    positive(block, ids, "a node")
    at = deck.add_nodes(numpy.ascontiguousarray(values[:, :3]))
    mesh.nodes.add(ids, at, numpy.arange(len(ids)) + block.first + 1, block.header.place.file)
    for row in numpy.flatnonzero(values[:, 3:6].any(axis=1)).tolist():
        mesh.turned[int(at[row])] = turned(values[row, 3:6])


def rows_of(block, numbers):
    """First line of each element; nodes beyond the eighth are on a second one."""
    rows, row, counts = [], 0, numbers[:, 8].tolist()
    while row < len(counts):
        if not 1 <= counts[row] <= 20:
            raise block.place(row).wrong(f"EBLOCK: an element of {counts[row]} nodes; 1 to 20 are read")
        rows.append(row)
        row += 1 + (counts[row] > 8)
    if row != len(counts):
        raise block.place(len(counts) - 1).wrong("EBLOCK: the nodes of the last element are not all there")
    return numpy.array(rows, int)


def solid_rows(block):
    """Lines of elements, their heads [n][11] and nodes [n][27] of EBLOCK with SOLID: material, type, real, section, system, 3 others,
    n, unused, number, nodes."""
    if block.n_whole != 19:
        raise block.header.place.wrong("EBLOCK with SOLID: only blocks with 19 fields are read")
    numbers = block.wholes(block.letters())
    rows = rows_of(block, numbers)
    head = numbers[rows]
    second = numpy.zeros((len(rows), 19), int)
    long = head[:, 8] > 8
    second[long] = numbers[rows[long] + 1]
    return rows, head[:, :11], numpy.hstack([head[:, 11:19], second])


def plain_rows(block, types):
    """The same of EBLOCK without SOLID: number, type, real, material, system, nodes; from the eleventh node on a second line."""
    numbers, rows, row = block.wholes(block.letters()), [], 0
    most = numbers.shape[1] - 5
    if most < 1:
        raise block.header.place.wrong("EBLOCK: its format has no nodes")
    while row < len(numbers):
        rows.append(row)
        row += 1 + (SOLIDS.get(types.get(int(numbers[row, 1]), 0), 0) > most)
    if row != len(numbers):
        raise block.place(len(numbers) - 1).wrong("EBLOCK: the nodes of the last element are not all there")
    rows = numpy.array(rows, int)
    nodes = numpy.zeros((len(rows), max(27, 2 * numbers.shape[1])), int)
    nodes[:, :most] = numbers[rows, 5:]
    two = numpy.diff(numpy.append(rows, len(numbers))) > 1
    nodes[two, most:most + numbers.shape[1]] = numbers[rows[two] + 1]
    head = numpy.zeros((len(rows), 11), int)
    head[:, [10, 1, 2, 0, 4]] = numbers[rows, :5]
    head[:, 8] = (nodes != 0).sum(axis=1)
    return rows, head, nodes


def read_elements(deck, mesh, block):
    """EBLOCK, fields, SOLID, largest, count."""
    solid = block.header.word(2).upper().startswith("SOLID")
    rows, head, nodes = solid_rows(block) if solid else plain_rows(block, mesh.types)
    announced = block.header.whole(4, len(rows))
    if announced != len(rows):
        raise block.header.place.wrong(f"EBLOCK announces {announced} elements and has {len(rows)}: is the file damaged?")
    for number in numpy.unique(head[:, 1]).tolist():
        chosen = numpy.flatnonzero(head[:, 1] == number)
        if number not in mesh.types:
            raise block.place(int(rows[chosen[0]])).wrong(f"EBLOCK: there is no ET {number}")
        add_type(deck, mesh, block, mesh.types[number], (head[chosen], nodes[chosen], rows[chosen]))


def add_type(deck, mesh, block, kind, found):
    """Elements of one type."""
    head, nodes, rows = found
    lines = rows + block.first + 1
    positive(block, head[:, 10], "an element", rows)
    if kind in SHELLS:
        mesh.waiting_shells.append((kind, head, nodes, rows, block))
        return
    if kind not in SOLIDS:
        mesh.others.add(head[:, 10], head[:, 10], lines, block.header.place.file)
        if kind in FACETS:
            for real in numpy.unique(head[:, 2]).tolist():
                chosen = head[:, 2] == real
                mesh.facets.setdefault((real, FACETS[kind]), []).append((nodes[chosen], head[chosen], block.place(int(rows[chosen][0]))))
        elif kind in JOINTS:
            mesh.joints += [(kind, *row, block.place(int(at))) for *row, at in zip(head, nodes, rows)]
        else:
            deck.note(block.place(int(rows[0])), f"{len(rows)} elements of type {kind}, which squeal has not")
        return
    n = SOLIDS[kind]
    corners = 8 if n in (8, 20) else 4
    wrong = numpy.flatnonzero((nodes[:, :corners] < 1).any(axis=1) | (nodes < 0).any(axis=1) | (nodes[:, n:] != 0).any(axis=1))
    if len(wrong):
        raise block.place(int(rows[wrong[0]])).wrong(f"element {head[wrong[0], 10]} of type {kind} needs {n} nodes" + (
            f", or {corners} and some middles" if n > corners else ""))
    left = numpy.ones(len(rows), bool)
    for equal, made in DEGENERATE[n]:
        match = left.copy()
        for a, b in equal:
            match &= nodes[:, a] == nodes[:, b]
        if match.any():
            left &= ~match
            add_shape(deck, mesh, block, (kind, *made), (head[match], nodes[match][:, list(made[1])], rows[match]))


def add_shape(deck, mesh, block, made, found):
    """Elements of one shape: of first order where they have no middle at all. What is folded in another way is left out."""
    kind, name, _ = made
    head, nodes, rows = found
    place = block.place(int(rows[0]))
    if name == "pyramid":
        mesh.others.add(head[:, 10], head[:, 10], rows + block.first + 1, block.header.place.file)
        deck.note(place, f"{len(rows)} pyramids of SOLID{kind}: squeal has none; they are left out, and their places are empty")
        return
    corners = shape_of(name).n_corners
    plain = ~(nodes[:, corners:] != 0).any(axis=1)
    for chosen, shape in ((plain, FIRST_ORDER.get(name, name)), (~plain, name)):
        if not chosen.any():
            continue
        part = nodes[chosen][:, :shape_of(shape).n_nodes]
        numbers = numpy.where(part > 0, part, part[:, :1])
        at = mesh.nodes.need(numbers, "node", lambda row, chosen=chosen: block.place(int(rows[chosen][row])))
        place = block.place(int(rows[chosen][0]))
        made = Block(shape_of(shape), f"SOLID{kind}", head[chosen, 10], numpy.where(part > 0, at, -1), place)
        mesh.waiting.append((made, head[chosen], rows[chosen] + block.first + 1))
        if (shape, kind) in DIFFERS:
            deck.differ(place, DIFFERS[shape, kind])
        elif shape != name:
            deck.differ(place, f"SOLID{kind} without middles becomes {shape} of squeal")


def add_solids(deck, mesh):
    """All solids, with their middles."""
    fill_middles(deck, [block for block, *_ in mesh.waiting])
    for block, head, lines in mesh.waiting:
        cells = deck.add_block(block)
        mesh.cells.add(head[:, 10], cells, lines, block.place.file)
        mesh.materials.append(head[:, 0])
        mesh.systems_of.append(head[:, 4])
    mesh.shells = add_shell_cells(deck, mesh, mesh.waiting_shells)


def read_component(deck, mesh, block):
    """CMBLOCK, name, NODE or ELEM, count: numbers; a negative one ends a range."""
    name, kind = block.header.word(1).upper(), block.header.word(2).upper()
    count = block.header.whole(3)
    part, width = block.part(block.letters(), 0, len(block.fields))
    filled = (part.reshape(len(part), len(block.fields), width) != ord(" ")).any(axis=2).ravel()
    if filled[:count].sum() != count or filled[count:].any():
        raise block.header.place.wrong(f"CMBLOCK {name} announces {count} items and has {filled.sum()}: is the file damaged?")
    numbers = []
    for value in block.wholes(block.letters()).ravel()[:count].tolist():
        if value < 0:
            if not numbers or not numbers[-1] < -value <= numbers[-1] + 10**7:
                raise block.header.place.wrong(f"CMBLOCK {name}: {value} ends no range")
            numbers.extend(range(numbers[-1] + 1, 1 - value))
        else:
            numbers.append(value)
    numbers, place = numpy.array(numbers, int), block.header.place
    if not kind.startswith(("NODE", "ELEM")):
        deck.note(place, f"CMBLOCK {name}: {kind} is not understood")
        return
    index = mesh.nodes if kind.startswith("NODE") else mesh.cells
    at, missing = index.find(numbers, "node" if kind.startswith("NODE") else "element")
    lost = numbers[missing]
    if not kind.startswith("NODE"):
        lost = lost[mesh.others.find(lost, "element")[1]]
    if len(lost):
        deck.note(place, f"CMBLOCK {name}: {len(lost)} of its numbers are not in the file, the first is {lost[0]}")
    mesh.components[name] = kind[:4], numpy.unique(at[~missing])  # a later one of a name replaces it
    sets = deck.node_sets if kind.startswith("NODE") else deck.cell_sets
    if not missing.all():
        sets[name] = mesh.components[name][1], place


def read_systems(mesh, commands):
    """LOCAL: number, kind (0 rectangular, 1 cylinder), origin, turns about z, x, y in degrees."""
    for command in commands:
        if command.words[0] != "LOCAL":
            continue
        words = command.plain()
        part = words[1].upper() if len(words) > 1 and words[1].upper() in ("LOC", "ANG", "PRM") else ""
        command.words = [words[0], *words[2 if part else 1:]]
        number, kind = command.whole(1), command.whole(2)
        values = [command.real(k) for k in range(3, 9)]
        if number < 11 or kind not in (0, 1):
            raise command.place.wrong(f"LOCAL {number}: numbers from 11 on, rectangular or cylindrical (0, 1)")
        known = mesh.systems.get(number, (kind == 1, numpy.eye(3), numpy.zeros(3)))
        if part == "LOC":
            mesh.systems[number] = kind == 1, known[1], numpy.array(values[:3])
        elif part == "ANG":
            mesh.systems[number] = kind == 1, turned(values[:3]), known[2]
        elif part == "":
            mesh.systems[number] = kind == 1, turned(values[3:]), numpy.array(values[:3])


def turned(degrees):
    """Axes in rows, turned about z, then the new x, then the new y."""
    (cz, cx, cy), (sz, sx, sy) = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    about_z = numpy.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    about_x = numpy.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = numpy.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return (about_z @ about_x @ about_y).T


def read_type_block(mesh, block):
    """ETBLOCK, count, largest number: number, type and options a line."""
    letters = block.letters()
    rows = block.wholes(letters)[:, :2]
    positive(block, rows[:, 0], "an element type")
    if len(rows) not in (block.header.whole(1, len(rows)), block.header.whole(2)) or len(set(rows[:, 0].tolist())) < len(rows):
        raise block.header.place.wrong(f"ETBLOCK announces {block.header.word(1)} types and has {len(rows)} lines, or two of a number: "
                                       "is the file damaged?")
    for row, (number, kind) in enumerate(rows.tolist()):
        mesh.types[number] = kind
        options = block.words(row, letters)[2:]
        mesh.options[number] = {k: int(word) for k, word in enumerate(options, 1) if word.isdigit() and int(word)}
        if len(options) > 11 and options[11].isdigit():
            mesh.behaviour[number] = int(options[11])


def read_types(mesh, blocks, commands):
    """ET: number, type by number or name (SOLID185); ETBLOCK."""
    for block in blocks:
        if block.name == "ETBLOCK":
            read_type_block(mesh, block)
    for command in commands:
        if command.words[0] == "ET":
            name = re.match(r"[A-Za-z]*(\d{1,6})$", command.word(2))
            if not command.word(1) or not name:
                raise command.place.wrong("ET needs a number and a type")
            mesh.types[command.whole(1)] = int(name[1])
        elif command.words[0] == "KEYOPT" and command.word(2).isdigit():
            mesh.options.setdefault(command.whole(1), {})[command.whole(2)] = command.whole(3)
            if command.word(2) == "12":
                mesh.behaviour[command.whole(1)] = command.whole(3)


def read_mesh(deck, blocks, commands):
    mesh = Mesh()
    read_types(mesh, blocks, commands)
    read_systems(mesh, commands)
    for name, read in (("NBLOCK", read_nodes), ("EBLOCK", read_elements), ("CMBLOCK", read_component)):
        if name == "CMBLOCK":
            add_solids(deck, mesh)
            mesh.cells.sorted("element")
        for block in blocks:
            if block.name == name:
                read(deck, mesh, block)
        mesh.nodes.sorted("node")
    return mesh
