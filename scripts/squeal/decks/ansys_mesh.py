"""Ansys: nodes, elements with their degenerate shapes, components, coordinate systems."""

import numpy

from .deck import Block, Index, shape_of

KNOWN = {"ET", "LOCAL"}
MOST = 10**9
# Number of a type -> nodes
SOLIDS = {185: 8, 45: 8, 186: 20, 95: 20, 187: 10, 92: 10, 285: 4}
FACETS = {173: "contact", 174: "contact", 170: "target"}  # elements on surfaces
DIFFERS = {("hex8", 185): "SOLID185 becomes hex8 of squeal, QM6, which is that of its enhanced strains, KEYOPT(2) = 3 (or 2)",
           ("hex8", 45): "SOLID45 becomes hex8 of squeal, QM6, which is that with its extra shapes",
           ("hex20", 186): "SOLID186 (reduced integration by default) becomes hex20 of squeal with 27 points",
           ("hex20", 95): "SOLID95 becomes hex20 of squeal with 27 points",
           ("tet4", 285): "SOLID285 (with a pressure of its own) becomes the ordinary tet4 of squeal, which is too stiff"}
# Of hexahedra in which nodes are the same: corners that must be equal, places of the nodes of the shape
DEGENERATE = {
    8: [(((2, 3), (4, 5), (4, 6), (4, 7)), ("tet4", (0, 1, 2, 4))),
        (((2, 3), (6, 7)), ("wedge6", (0, 1, 2, 4, 5, 6))), ((), ("hex8", range(8)))],
    20: [(((2, 3), (4, 5), (4, 6), (4, 7)), ("tet10", (0, 1, 2, 4, 8, 9, 11, 16, 17, 18))),
         (((2, 3), (6, 7)), ("wedge15", (0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18))), ((), ("hex20", range(20)))],
    10: [((), ("tet10", range(10)))], 4: [((), ("tet4", range(4)))]}
# Face number of SFE -> ours, from 0
FACES = {"hex": {1: 0, 2: 2, 3: 3, 4: 4, 5: 5, 6: 1}, "wedge": {1: 0, 2: 2, 3: 3, 5: 4, 4: 4, 6: 1},
         "tet": {1: 0, 2: 1, 3: 2, 4: 3, 5: 3}}


class Mesh:
    """Nodes, elements and what each has: material, system; components; elements on surfaces by their real constants."""

    def __init__(self):
        self.nodes, self.cells, self.others = Index(), Index(), Index()
        self.materials, self.systems_of, self.components = [], [], {}
        self.turned, self.facets, self.types = set(), {}, {}
        self.systems = {0: (False, numpy.eye(3), numpy.zeros(3)), 1: (True, numpy.eye(3), numpy.zeros(3))}


def positive(block, ids, what, rows=None):
    bad = numpy.flatnonzero((ids < 1) | (ids > MOST))
    if len(bad):
        row = int(bad[0]) if rows is None else int(rows[bad[0]])
        raise block.place(row).wrong(f"the number {ids[bad[0]]} of {what} is not positive, or too large")


def read_nodes(deck, mesh, block):
    """NBLOCK, fields, SOLID, largest, count."""
    letters = block.letters()
    if not block.n_real:
        raise block.header.place.wrong("NBLOCK: its format has no coordinates")
    ids, values = block.wholes(letters)[:, 0], block.reals(letters)
    values = numpy.pad(values, ((0, 0), (0, max(0, 6 - values.shape[1]))))
    announced = block.header.whole(4, len(ids))
    if announced != len(ids):
        raise block.header.place.wrong(f"NBLOCK announces {announced} nodes and has {len(ids)}: is the file damaged?")
    positive(block, ids, "a node")
    at = deck.add_nodes(numpy.ascontiguousarray(values[:, :3]))
    mesh.nodes.add(ids, at, numpy.arange(len(ids)) + block.first + 1, block.header.place.file)
    mesh.turned.update(at[values[:, 3:6].any(axis=1)].tolist())


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


def read_elements(deck, mesh, block):
    """EBLOCK, fields, SOLID, largest, count: material, type, real, section, system, 3 others, n, unused, number, nodes."""
    if block.header.word(2).upper() != "SOLID" or block.n_whole != 19:
        raise block.header.place.wrong("EBLOCK: only blocks with SOLID and 19 fields are read")
    numbers = block.wholes(block.letters())
    rows = rows_of(block, numbers)
    announced = block.header.whole(4, len(rows))
    if announced != len(rows):
        raise block.header.place.wrong(f"EBLOCK announces {announced} elements and has {len(rows)}: is the file damaged?")
    head = numbers[rows]
    second = numpy.zeros((len(rows), 19), int)
    long = head[:, 8] > 8
    second[long] = numbers[rows[long] + 1]
    nodes = numpy.hstack([head[:, 11:19], second])
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
    if kind not in SOLIDS:
        mesh.others.add(head[:, 10], head[:, 10], lines, block.header.place.file)
        if kind in FACETS:
            for real in numpy.unique(head[:, 2]).tolist():
                chosen = head[:, 2] == real
                mesh.facets.setdefault((real, FACETS[kind]), []).append((nodes[chosen], head[chosen], block.place(int(rows[chosen][0]))))
        else:
            deck.note(block.place(int(rows[0])), f"{len(rows)} elements of type {kind}, which squeal has not")
        return
    n = SOLIDS[kind]
    wrong = numpy.flatnonzero((head[:, 8] != n) | (nodes[:, :n] < 1).any(axis=1) | (nodes[:, n:] != 0).any(axis=1))
    if len(wrong):
        raise block.place(int(rows[wrong[0]])).wrong(f"element {head[wrong[0], 10]} of type {kind} needs {n} nodes; squeal has "
                                                     "none without some of its middles")
    left = numpy.ones(len(rows), bool)
    for equal, made in DEGENERATE[n]:
        match = left.copy()
        for a, b in equal:
            match &= nodes[:, a] == nodes[:, b]
        if match.any():
            left &= ~match
            add_shape(deck, mesh, block, (kind, *made), (head[match], nodes[match][:, list(made[1])], rows[match]))


def add_shape(deck, mesh, block, made, found):
    kind, name, _ = made
    head, nodes, rows = found
    at = mesh.nodes.need(nodes, "node", lambda row: block.place(int(rows[row])))
    cells = deck.add_block(Block(shape_of(name), f"SOLID{kind}", head[:, 10], at, block.place(int(rows[0]))))
    mesh.cells.add(head[:, 10], cells, rows + block.first + 1, block.header.place.file)
    mesh.materials.append(head[:, 0])
    mesh.systems_of.append(head[:, 4])
    if (name, kind) in DIFFERS:
        deck.differ(block.place(int(rows[0])), DIFFERS[name, kind])


def read_component(deck, mesh, block):
    """CMBLOCK, name, NODE or ELEM, count: numbers; a negative one ends a range."""
    name, kind = block.header.word(1).upper(), block.header.word(2).upper()
    count = block.header.whole(3)
    letters = block.letters()
    filled = (letters.reshape(len(letters), block.n_whole, block.width) != ord(" ")).any(axis=2).ravel()
    if filled[:count].sum() != count or filled[count:].any():
        raise block.header.place.wrong(f"CMBLOCK {name} announces {count} items and has {filled.sum()}: is the file damaged?")
    numbers = []
    for value in block.wholes(letters).ravel()[:count].tolist():
        if value < 0:
            if not numbers or not numbers[-1] < -value <= numbers[-1] + 10**7:
                raise block.header.place.wrong(f"CMBLOCK {name}: {value} ends no range")
            numbers.extend(range(numbers[-1] + 1, 1 - value))
        else:
            numbers.append(value)
    numbers, place = numpy.array(numbers, int), block.header.place
    if not kind.startswith(("NODE", "ELEM")):
        deck.note(place, f"CMBLOCK {name}: {kind} is not understood")
    elif name in mesh.components:
        raise place.wrong(f"component {name} stands twice")
    elif kind.startswith("NODE"):
        mesh.components[name] = "NODE", numpy.unique(mesh.nodes.need(numbers, "node", place))
        deck.node_sets[name] = mesh.components[name][1], place
    else:
        at, missing = mesh.cells.find(numbers, "element")
        mesh.others.need(numbers[missing], "element", place)
        mesh.components[name] = "ELEM", numpy.unique(at[~missing])
        if not missing.all():
            deck.cell_sets[name] = mesh.components[name][1], place


def read_systems(mesh, commands):
    """LOCAL: number, kind (0 rectangular, 1 cylinder), origin, turns about z, x, y in degrees."""
    for command in commands:
        if command.words[0] != "LOCAL":
            continue
        words = [word for word in command.words if not word.upper().startswith("R5")]
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


def read_mesh(deck, blocks, commands):
    mesh = Mesh()
    for command in commands:
        if command.words[0] == "ET":
            if not command.word(1) or not command.word(2):
                raise command.place.wrong("ET needs a number and a type")
            mesh.types[command.whole(1)] = command.whole(2)
    read_systems(mesh, commands)
    for name, read in (("NBLOCK", read_nodes), ("EBLOCK", read_elements), ("CMBLOCK", read_component)):
        for block in blocks:
            if block.header.words[0] == name:
                read(deck, mesh, block)
        mesh.nodes.sorted("node")
    mesh.cells.sorted("element")
    return mesh
