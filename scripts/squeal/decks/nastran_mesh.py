"""Nastran: coordinate systems, grid points, solid elements."""

import numpy

from .deck import Block, Index, shape_of

KNOWN = {"GRID", "CTETRA", "CPENTA", "CHEXA", "CORD2R", "CORD2C", "CORD1R", "CORD1C", "CORD1S", "CORD2S", "GRDSET", "SPOINT"}
MOST = 10**9
# Name -> corners, shapes of first and second order, order of Nastran's nodes in ours (second order)
SOLIDS = {"CTETRA": (4, ("tet4", "tet10"), range(10)),
          "CPENTA": (6, ("wedge6", "wedge15"), (*range(9), 12, 13, 14, 9, 10, 11)),
          "CHEXA": (8, ("hex8", "hex20"), (*range(12), 16, 17, 18, 19, 12, 13, 14, 15))}
DIFFERS = {"hex8": "CHEXA of 8 nodes becomes hex8 of squeal, QM6, of incompatible modes, as Nastran's own has bubbles",
           "hex20": "CHEXA of 20 nodes becomes hex20 of squeal with 27 points",
           "wedge15": "CPENTA of 15 nodes: squeal may integrate it more exactly"}


class System:
    """Axes in rows, origin, and whether they are a cylinder's."""

    def __init__(self, axes, origin, cylinder):
        self.axes, self.origin, self.cylinder = axes, origin, cylinder

    def places(self, x):
        """Places in space of coordinates [n][3] in this system."""
        if self.cylinder:
            angle = numpy.radians(x[:, 1])
            x = numpy.stack([x[:, 0] * numpy.cos(angle), x[:, 0] * numpy.sin(angle), x[:, 2]], axis=1)
        return x @ self.axes + self.origin


SPACE = System(numpy.eye(3), numpy.zeros(3), False)


class Mesh:
    """Grid points and elements by their numbers, property and coordinate systems of each."""

    def __init__(self):
        self.nodes, self.cells, self.systems, self.turned = Index(), Index(), {0: SPACE}, {}
        self.blocks = []  # (first cell, property numbers, table)


def named(tables, *names):
    return [table for table in tables if table.name in names]


def check_rows(table, least, most):
    """Fields that a card must and may have."""
    beyond = (table.part(most, max(table.width, most)) != ord(" ")).any(axis=1)
    if beyond.any():
        raise table.place(int(numpy.flatnonzero(beyond)[0])).wrong(f"{table.name} has more than {most} fields")
    blank = (table.part(0, least).reshape(len(table), least, -1) == ord(" ")).all(axis=2)
    if blank.any():
        row, column = numpy.argwhere(blank)[0]
        raise table.place(int(row)).wrong(f"{table.name}: field {column + 2} is blank")


def positive(table, ids, what):
    """Numbers of things are positive."""
    bad = numpy.flatnonzero((ids < 1) | (ids > MOST))
    if len(bad):
        raise table.place(int(bad[0])).wrong(f"{table.name}: the number {ids[bad[0]]} of {what} is not positive, or too large")


def read_systems(mesh, tables):
    """CORD2R, CORD2C: three points in another system, which must be known before."""
    waiting = [(table, row) for table in named(tables, "CORD2R", "CORD2C") for row in range(len(table))]
    for table in named(tables, "CORD2R", "CORD2C"):
        check_rows(table, 1, 16)
        if table.width < 11:
            raise table.place(0).wrong(f"{table.name}: the line with the third point is missing")
    while waiting:
        later = []
        for table, row in waiting:
            number, base = (int(value) for value in table.whole(0, 2)[row])
            if base not in mesh.systems:
                later.append((table, row))
                continue
            if number in mesh.systems:
                raise table.place(row).wrong(f"coordinate system {number} stands twice")
            mesh.systems[number] = new_system(table, row, mesh.systems[base])
        if len(later) == len(waiting):
            table, row = later[0]
            raise table.place(row).wrong(f"{table.name}: there is no coordinate system {table.whole(1, 2)[row, 0]}")
        waiting = later
    for table in named(tables, "CORD1R", "CORD1C", "CORD1S", "CORD2S", "GRDSET", "SPOINT"):
        raise table.place(0).wrong(f"{table.name} is not read, and without it the grid points are others; only CORD2R and CORD2C are")


def new_system(table, row, base):
    a, b, c = base.places(table.real(2, 11)[row].reshape(3, 3))
    third = b - a
    second = numpy.cross(third, c - a)
    if not numpy.linalg.norm(second) > 0:
        raise table.place(row).wrong(f"{table.name}: the three points are on a line")
    third, second = third / numpy.linalg.norm(third), second / numpy.linalg.norm(second)
    return System(numpy.array([numpy.cross(second, third), second, third]), a, table.name.endswith("C"))


def read_grid(deck, mesh, tables):
    """GRID: number, system, x1 x2 x3, system of displacements, held directions."""
    held = []
    for table in named(tables, "GRID"):
        check_rows(table, 1, 8)
        ids, systems, x = table.whole(0, 1)[:, 0], table.whole(1, 2)[:, 0], table.real(2, 5)
        positive(table, ids, "a grid point")
        if table.width < 5:
            raise table.place(0).wrong("GRID: the line with the third coordinate is missing")
        blank = (table.part(2, 5).reshape(len(table), 3, -1) == ord(" ")).all(axis=2).any(axis=1)
        if blank.any():
            deck.note(table.place(int(blank.argmax())), f"GRID: {blank.sum()} grid points with a blank coordinate, which is 0")
        x = x.copy()
        for number in numpy.unique(systems).tolist():
            rows = numpy.flatnonzero(systems == number)
            if number not in mesh.systems:
                raise table.place(int(rows[0])).wrong(f"GRID: there is no coordinate system {number}")
            if number:
                x[rows] = mesh.systems[number].places(x[rows])
        at = deck.add_nodes(x)
        mesh.nodes.add(ids, at, table.lines, table.file)
        turned = table.whole(5, 6)[:, 0]
        for row in numpy.flatnonzero(turned).tolist():
            mesh.turned[int(at[row])] = int(turned[row])
        held += [(int(at[row]), word, table.place(row)) for row, word in filled_words(table, 6)]
    return held


def filled_words(table, column):
    """Row and text of a field where it is not blank."""
    letters = table.part(column, column + 1)
    for row in numpy.flatnonzero((letters != ord(" ")).any(axis=1)).tolist():
        yield row, letters[row].tobytes().decode("latin-1").strip()


def read_solids(deck, mesh, tables):
    """CTETRA, CPENTA, CHEXA: number, property, nodes; of second order with all middles, or none."""
    for table in named(tables, *SOLIDS):
        corners, shapes, order = SOLIDS[table.name]
        most = len(order)
        check_rows(table, 2 + corners, 2 + most)
        head, nodes = table.whole(0, 2), table.whole(2, 2 + most)
        positive(table, head[:, 0], "an element")
        middles = nodes[:, corners:] != 0
        second = middles.all(axis=1)
        some = middles.any(axis=1) & ~second
        if some.any():
            raise table.place(int(numpy.flatnonzero(some)[0])).wrong(f"{table.name} with some of its nodes in the middle of edges "
                                                                      "and not all: squeal has no such element")
        for shape, rows in zip(shapes, (numpy.flatnonzero(~second), numpy.flatnonzero(second))):
            if len(rows):
                add_solids(deck, mesh, table, shape_of(shape), rows)


def add_solids(deck, mesh, table, shape, rows):
    order = SOLIDS[table.name][2]
    head, nodes = table.whole(0, 2)[rows], table.whole(2, 2 + len(order))[rows]
    chosen = nodes[:, list(order)] if shape.second else nodes[:, :shape.n_nodes]
    found = mesh.nodes.need(chosen, "grid point", lambda row: table.place(int(rows[row])))
    cells = deck.add_block(Block(shape, table.name, head[:, 0], found, table.place(int(rows[0]))))
    mesh.cells.add(head[:, 0], cells, table.lines[rows], table.file)
    mesh.blocks.append((cells, head[:, 1]))
    if shape.name in DIFFERS:
        deck.differ(table.place(int(rows[0])), DIFFERS[shape.name])


def read_mesh(deck, tables):
    """Systems, grid points and solids; what GRID holds goes on."""
    mesh = Mesh()
    read_systems(mesh, tables)
    mesh.held = read_grid(deck, mesh, tables)
    mesh.nodes.sorted("grid point")
    read_solids(deck, mesh, tables)
    mesh.cells.sorted("element")
    return mesh
