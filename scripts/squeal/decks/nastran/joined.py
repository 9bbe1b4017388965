"""Nastran: rigid elements, means, masses, linear equations between grid points."""

import numpy

from .cards import named
from .systems import SPACE
from ..deck import Equation, Join, Lump

KNOWN = {"RBE2", "RBE3", "RBAR", "CONM2", "MPC", "MPCADD"}
SOLID = {0, 1, 2}


def read_joined(deck, tables, mesh, chosen):
    for name, read in (("RBE2", rigid), ("RBAR", bar), ("RBE3", spread), ("CONM2", mass)):
        for table in named(tables, name):
            for row in range(len(table)):
                read(deck, mesh, table, row)
    for table in chosen.constraints(tables):
        for row in range(len(table)):
            equation(deck, mesh, table, row)


def components(word, place, what):
    """Motions 0 to 5 of digits."""
    if not word or not set(word) <= set("123456"):
        raise place.wrong(f"{what}: '{word}' should be digits of 1 to 6")
    return sorted({int(digit) - 1 for digit in word})


def point(mesh, number, place):
    """The node of a grid point."""
    return int(mesh.nodes.need(numpy.array([number]), "grid point", place)[0])


def turned_axes(mesh, node, x):
    """Axes of a grid point where they are not those of space, else None."""
    number = mesh.turned.get(int(node), 0)
    return mesh.systems[number].directions(x) if number in mesh.systems and number else None


def rigid(deck, mesh, table, row):
    """RBE2: number, independent point, components, dependent points, perhaps a coefficient of expansion."""
    place, words = table.place(row), table.words(row, 4)
    held = [d for d in components(words[2], place, "RBE2") if d < 3]
    points = [word for word in words[3:] if word]
    if points and not points[-1].isdigit():
        points.pop()
    if not all(word.isdigit() for word in points) or not words[1].isdigit():
        raise place.wrong("RBE2: its points should be whole numbers")
    if not held or not points:
        deck.note(place, f"RBE2 {words[0]}: of rotations alone, which solids do not have: not in the scene" if points else
                  f"RBE2 {words[0]}: no points: not in the scene")
        return
    nodes = mesh.nodes.need(numpy.array(points, int), "grid point", place)
    if len(held) < 3 and any(turned_axes(mesh, node, deck.x[node]) is not None for node in nodes.tolist()):
        deck.note(place, f"RBE2 {words[0]}: some components, in axes of a coordinate system (CD of GRID): not in the scene")
        return
    deck.joins.append(Join(f"rbe2_{words[0]}", point(mesh, int(words[1]), place), nodes, True, place, f"RBE2 {words[0]}", tuple(held)))


def bar(deck, mesh, table, row):
    """RBAR: number, two points, components of which one end is independent, all of it taken as rigid."""
    place, words = table.place(row), table.words(row, 7)
    if sorted(words[3] + words[4]) != list("123456") or any(words[5:7]) and not set(words[5] + words[6]) >= set("123"):
        deck.note(place, f"RBAR {words[0]}: only one that is rigid in all six components is read")
        return
    ends = [point(mesh, int(words[k]), place) for k in (1, 2)]
    deck.joins.append(Join(f"rbar_{words[0]}", ends[0], numpy.array(ends[1:]), True, place, f"RBAR {words[0]}"))


def spread(deck, mesh, table, row):
    """RBE3: number, -, point, its components, then weight, components, points ...; UM and ALPHA end them."""
    place, words = table.place(row), table.words(row, 8)
    end = next((k for k, word in enumerate(words) if word.upper() in ("UM", "ALPHA")), len(words))
    if end < len(words) and words[end].upper() == "UM":
        deck.note(place, f"RBE3 {words[0]}: UM changes what follows in Nastran's solution, not the constraint")
    weight, part, shares, numbers = 1.0, "123", [], []
    fields = [word for word in words[4:end] if word]
    for k, word in enumerate(fields):
        if not word.isdigit():
            weight, part = table.one_real(row, 4, word), fields[k + 1] if k + 1 < len(fields) else ""
            if not set("123") <= set(part):
                deck.note(place, f"RBE3 {words[0]}: components {part} of its points; all of 1, 2, 3 are taken")
        elif k == 0 or fields[k - 1].isdigit() or (k > 1 and not fields[k - 2].isdigit()):
            shares.append(weight)
            numbers.append(int(word))
    if not numbers or not words[2].isdigit():
        raise place.wrong("RBE3 needs a point, and points that it is the mean of")
    if not min(shares) > 0:
        raise place.wrong(f"RBE3 {words[0]}: weight {min(shares):g} must be positive")
    nodes = mesh.nodes.need(numpy.array(numbers), "grid point", place)
    equal = len(set(shares)) == 1
    deck.joins.append(Join(f"rbe3_{words[0]}", point(mesh, int(words[2]), place), nodes, False, place, f"RBE3 {words[0]}",
                           shares=None if equal else numpy.array(shares)))


def mass(deck, mesh, table, row):
    """CONM2: number, point, system, mass, offset, I11, I21, I22, I31, I32, I33."""
    place, words = table.place(row), table.words(row, 13)
    node, number = point(mesh, int(table.whole(1, 2)[row, 0]), place), int(table.whole(2, 3)[row, 0]) if words[2] != "-1" else -1
    system = SPACE if number == -1 else mesh.systems.get(number)
    if system is None:
        raise place.wrong(f"CONM2: there is no coordinate system {number}")
    values = [table.one_real(row, k, words[k]) if words[k] else 0.0 for k in range(3, 13) if k != 7]
    at = {k: value for k, value in zip([k for k in range(3, 13) if k != 7], values)}
    inertia = [table.one_real(row, k, table.words(row, 14)[k]) if table.words(row, 14)[k] else 0.0 for k in range(8, 14)]
    axes = system.directions(deck.x[node])
    offset = numpy.array([at[4], at[5], at[6]])
    offset = offset - deck.x[node] if number == -1 else offset @ axes
    i11, i21, i22, i31, i32, i33 = inertia
    tensor = axes.T @ numpy.array([[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]]) @ axes
    values = tuple(tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist())
    deck.lumps.append(Lump(node, place, f"CONM2 {words[0]}", at[3] * mesh.mass_factor, tuple(v * mesh.mass_factor for v in values), offset))


def equation(deck, mesh, table, row):
    """MPC: set, then point, component, coefficient of each term."""
    place, words, terms = table.place(row), table.words(row, 8), []
    for k in [k for first in range(1, len(words), 8) for k in (first, first + 3)]:
        part = (words[k:k + 3] + [""] * 3)[:3]
        if not part[0]:
            continue
        if not part[0].isdigit() or part[1] and not part[1].isdigit():
            raise place.wrong(f"MPC: '{part[0]}', '{part[1]}' are no point and component")
        if int(part[0]) in mesh.scalar or part[1] in ("", "0"):
            deck.note(place, "MPC: of a scalar point: not in the scene")
            return
        node, d, value = point(mesh, int(part[0]), place), components(part[1], place, "MPC")[0], table.one_real(row, k + 2, part[2])
        axes, first = turned_axes(mesh, node, deck.x[node]), 3 if d > 2 else 0
        terms += [(node, d, value)] if axes is None else [(node, first + e, value * float(axes[d - first, e])) for e in range(3)]
    if terms:
        deck.equations.append(Equation(terms, place, "MPC"))
