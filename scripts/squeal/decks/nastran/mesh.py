"""Nastran: grid points, solid elements."""

from dataclasses import dataclass

import numpy

from ..deck import Block, Index, shape_of
from ..mesh.middles import fill_middles
from .cards import named
from .shells import read_shells
from .systems import SPACE, solve_systems

KNOWN = {"GRID", "GRDSET", "SPOINT", "CTETRA", "CPENTA", "CHEXA", "CPYRAM"}
MOST = 10**9
# Name -> corners, shapes of first and second order, order of Nastran's nodes in ours (second order)
SOLIDS = {"CTETRA": (4, ("tet4", "tet10"), range(10)),
          "CPENTA": (6, ("wedge6", "wedge15"), (*range(9), 12, 13, 14, 9, 10, 11)),
          "CHEXA": (8, ("hex8", "hex20"), (*range(12), 16, 17, 18, 19, 12, 13, 14, 15))}
DIFFERS = {"hex8": "CHEXA of 8 nodes becomes hex8 of squeal, QM6, of incompatible modes, as Nastran's own has bubbles",
           "hex20": "CHEXA of 20 nodes becomes hex20 of squeal with 27 points",
           "wedge15": "CPENTA of 15 nodes: squeal may integrate it more exactly"}


class Mesh:
    """Grid points and elements by their numbers, property and coordinate systems of each."""

    def __init__(self):
        self.nodes, self.cells, self.systems, self.turned = Index(), Index(), {0: SPACE}, {}
        self.blocks = []  # (cells, property numbers)
        self.scalar = set()  # numbers of SPOINT
        self.held, self.waiting, self.fluids = [], {}, set()
        self.shells = []  # (cells, property numbers, table, rows)
        self.mass_factor, self.solid = 1.0, None  # PARAM WTMASS; which nodes elements have

    def is_solid(self, deck, node):
        """Whether a volume element has a node."""
        if self.solid is None:
            self.solid = numpy.zeros(deck.n_nodes, bool)
            for block in deck.blocks:
                self.solid[block.nodes] = True
        return bool(self.solid[node])

    def known(self, numbers):
        """Those that are no scalar points, which are at no place."""
        return numpy.array([number for number in numbers if number not in self.scalar], int)


@dataclass
class Grid:
    """Of all GRID: number, system, coordinates, system of displacements."""
    ids: numpy.ndarray
    systems: numpy.ndarray
    x: numpy.ndarray
    turned: numpy.ndarray


def check_rows(table, least, most):
    """Fields that a card must and may have."""
    beyond = (table.part(most, max(table.width, most)) != ord(" ")).any(axis=1)
    if beyond.any():
        raise table.place(int(numpy.flatnonzero(beyond)[0])).wrong(f"{table.name} has more than {most} fields")
    blank = table.blank(0, least)
    if blank.any():
        row, column = numpy.argwhere(blank)[0]
        raise table.place(int(row)).wrong(f"{table.name}: field {column + 2} is blank")


def positive(table, ids, what):
    """Numbers of things are positive."""
    bad = numpy.flatnonzero((ids < 1) | (ids > MOST))
    if len(bad):
        raise table.place(int(bad[0])).wrong(f"{table.name}: the number {ids[bad[0]]} of {what} is not positive, or too large")


def once(tables, name):
    """Tables of a card without rows that stand twice word for word, which Nastran takes for one."""
    found, seen = named(tables, name), {}
    ids = numpy.concatenate([table.whole(0, 1)[:, 0] for table in found])
    unique, count = numpy.unique(ids, return_counts=True)
    if (count == 1).all():
        return found
    kept_tables = []
    for table in found:
        numbers = table.whole(0, 1)[:, 0]
        kept = numpy.ones(len(table), bool)
        for row in numpy.flatnonzero(numpy.isin(numbers, unique[count > 1])).tolist():
            words = table.words(row, 9)
            first = seen.setdefault(int(numbers[row]), words)
            kept[row] = first is words or first != words
        kept_tables.append(table.rows(numpy.flatnonzero(kept)))
    return kept_tables


def defaults(tables):
    """GRDSET: system, system of displacements, held directions of grid points where these are blank."""
    found = 0, 0, ""
    for table in named(tables, "GRDSET"):
        for row in range(len(table)):
            found = (int(table.whole(1, 2)[row, 0]), int(table.whole(5, 6)[row, 0]), table.words(row, 7)[6])
    return found


def read_grid(deck, mesh, tables):
    """GRID: number, system, x1 x2 x3, system of displacements, held directions."""
    base, turned_base, held_base = defaults(tables)
    parts, found = [], once(tables, "GRID")
    for table in found:
        check_rows(table, 1, 8)
        ids, systems, turned = table.whole(0, 1)[:, 0], table.whole(1, 2)[:, 0], table.whole(5, 6)[:, 0]
        positive(table, ids, "a grid point")
        if table.width < 5:
            raise table.place(0).wrong("GRID: the line with the third coordinate is missing")
        blank = table.blank(2, 5).any(axis=1)
        if blank.any():
            deck.note(table.place(int(blank.argmax())), f"GRID: {blank.sum()} grid points with a blank coordinate, which is 0")
        systems[table.blank(1, 2)[:, 0]] = base
        turned[table.blank(5, 6)[:, 0]] = turned_base
        parts.append((ids, systems, table.real(2, 5), turned))
    grid = Grid(*(numpy.concatenate(columns) for columns in zip(*parts)))
    x, known, mesh.waiting = solve_systems(mesh, tables, grid)
    at, first = deck.add_nodes(x), 0
    for table in found:
        rows = slice(first, first + len(table))
        unknown = numpy.flatnonzero(~known[rows])
        if len(unknown):
            number = grid.systems[rows][unknown[0]]
            raise table.place(int(unknown[0])).wrong(f"GRID: there is no coordinate system {number}" + (
                ", or it hangs on one that is not there" if number in mesh.waiting else ""))
        mesh.nodes.add(grid.ids[rows], at[rows], table.lines, table.file)
        for row in numpy.flatnonzero(grid.turned[rows]).tolist():
            mesh.turned[int(at[first + row])] = int(grid.turned[first + row])
        words = dict(filled_words(table, 6))
        mesh.held += [(int(at[first + row]), words.get(row, held_base), table.place(row))
                      for row in (range(len(table)) if held_base else words)]
        first += len(table)


def filled_words(table, column):
    """Row and text of a field where it is not blank."""
    letters = table.part(column, column + 1)
    for row in numpy.flatnonzero((letters != ord(" ")).any(axis=1)).tolist():
        yield row, letters[row].tobytes().decode("latin-1").strip()


def read_scalars(mesh, tables):
    """SPOINT: points with one freedom and no place."""
    for table in named(tables, "SPOINT"):
        for row in range(len(table)):
            words = [word for word in table.words(row) if word]
            if len(words) == 3 and words[1].upper() == "THRU" and words[0].isdigit() and words[2].isdigit():
                mesh.scalar.update(range(int(words[0]), min(int(words[2]), int(words[0]) + 10**6) + 1))
            else:
                mesh.scalar.update(int(word) for word in words if word.isdigit())


def read_fluids(mesh, tables):
    """Properties of elements of a fluid."""
    materials = {int(number) for table in named(tables, "MAT10") for number in table.whole(0, 1)[:, 0]}
    for table in named(tables, "PSOLID"):
        for row, (number, material) in enumerate(table.whole(0, 2).tolist()):
            if table.words(row, 6)[5].upper() == "PFLUID" or material in materials:
                mesh.fluids.add(number)


def read_solids(deck, mesh, tables):
    """CTETRA, CPENTA, CHEXA: number, property, nodes; of second order with middles."""
    found = []
    for table in named(tables, *SOLIDS):
        corners, shapes, order = SOLIDS[table.name]
        check_rows(table, 1, 2 + len(order))
        missing = table.blank(2, 2 + corners)
        if missing.any():
            row, column = numpy.argwhere(missing)[0]
            raise table.place(int(row)).wrong(f"{table.name}: field {column + 4} is blank")
        head = table.whole(0, 2)
        positive(table, head[:, 0], "an element")
        owned = table.blank(1, 2)[:, 0]
        head[owned, 1] = head[owned, 0]
        fluid = numpy.isin(head[:, 1], list(mesh.fluids))
        if fluid.any():
            deck.note(table.place(int(fluid.argmax())), f"{fluid.sum()} {table.name} of a fluid: not taken")
        nodes = table.whole(2, 2 + len(order))
        second = (nodes[:, corners:] != 0).any(axis=1)
        for shape, chosen in zip(shapes, (~second, second)):
            rows = numpy.flatnonzero(chosen & ~fluid)
            if len(rows):
                found.append(solids_of(deck, mesh, (table, rows), shape_of(shape), (head[rows], nodes[rows])))
    fill_middles(deck, [block for block, *_ in found])
    for block, properties, table, rows in found:
        cells = deck.add_block(block)
        mesh.cells.add(block.ids, cells, table.lines[rows], table.file)
        mesh.blocks.append((cells, properties))
    for table in named(tables, "CPYRAM"):
        deck.note(table.place(0), f"{len(table)} CPYRAM: squeal has no pyramids; they are left out, and their places are empty")


def solids_of(deck, mesh, where, shape, values):
    """(block, properties, table, rows) of elements of one shape; middles that are not there are -1."""
    (table, rows), (head, nodes) = where, values
    order = list(SOLIDS[table.name][2]) if shape.second else list(range(shape.n_nodes))
    place = table.place(int(rows[0]))
    chosen = nodes[:, order]
    given = (chosen != 0) | (numpy.arange(len(order)) < shape.n_corners)
    numbers = numpy.where(given, chosen, chosen[:, :1])
    found = numpy.where(given, mesh.nodes.need(numbers, "grid point", lambda row: table.place(int(rows[row]))), -1)
    if shape.name in DIFFERS:
        deck.differ(place, DIFFERS[shape.name])
    return Block(shape, table.name, head[:, 0], found, place), head[:, 1], table, rows


def read_mesh(deck, tables):
    """Systems, grid points and solids."""
    mesh = Mesh()
    read_scalars(mesh, tables)
    read_fluids(mesh, tables)
    read_grid(deck, mesh, tables)
    mesh.nodes.sorted("grid point")
    read_solids(deck, mesh, tables)
    read_shells(deck, mesh, tables)
    mesh.cells.sorted("element")
    return mesh
