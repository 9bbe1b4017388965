"""Nastran: beams and their properties, and masses along one direction."""

import numpy

from ..deck import Beam, OneWay, Profile
from .cards import named
from .joined import point, turned_axes

KNOWN = {"CBAR", "CBEAM", "PBAR", "PBEAM", "CMASS2"}


def bar_property(table, row):
    """PBAR: number, material, A, I1, I2, J, mass per length, -, stress points, K1, K2, I12. Without K there is no shear."""
    words = table.words(row, 19)
    values = {k: table.one_real(row, k, words[k]) if words[k] else 0.0 for k in (2, 3, 4, 5, 6, 16, 17, 18)}
    if values[18]:
        return None
    return words[1], Profile(*(values[k] for k in (2, 3, 4, 5)), values[16] or numpy.inf, values[17] or numpy.inf), values[6]


def beam_property(table, row):
    """PBEAM of one section: number, material, A, I1, I2, I12, J, mass per length, -, stress points, K1, K2, which are 1 where blank."""
    words = table.words(row, 18)
    values = [table.one_real(row, k, words[k]) if words[k] else 0.0 for k in range(2, 8)]
    if values[3] or any(word in ("YES", "YESA", "NO") for word in words[16:]):
        return None
    shear = [(table.one_real(row, k, words[k]) if words[k] else 1.0) or numpy.inf for k in (16, 17)]
    return words[1], Profile(values[0], values[1], values[2], values[4], *shear), values[5]


def properties(deck, tables):
    """Number -> material, profile, place."""
    found = {}
    for table in named(tables, "PBAR", "PBEAM"):
        for row in range(len(table)):
            place, number = table.place(row), int(table.whole(0, 1)[row, 0])
            read = (bar_property if table.name == "PBAR" else beam_property)(table, row)
            if read is None or min(read[1].area, read[1].bend_1, read[1].bend_2, read[1].torsion) <= 0:
                deck.note(place, f"{table.name} {number}: only one section with A, I1, I2, J, all positive, and I12 = 0 is read: not taken")
                continue
            if read[2]:
                deck.note(place, f"{table.name} {number}: mass per length beside that of the material, not taken")
            found[number] = read[0], read[1], place
    return found


def direction(deck, mesh, table, row, node):
    """The vector of axis 1: x, y, z, or to a grid point; None where it is not there."""
    words = table.words(row, 8)
    if words[4].isdigit() and not any(words[5:7]):
        return deck.x[point(mesh, int(words[4]), table.place(row))] - deck.x[node]
    along = numpy.array([table.one_real(row, k, words[k]) if words[k] else 0.0 for k in (4, 5, 6)])
    axes = turned_axes(mesh, node, deck.x[node])
    return (along if axes is None else along @ axes) if along.any() else None


def read_beams(deck, tables, mesh):
    """CBAR and CBEAM: number, property, two points, the direction; pins and offsets are listed, and such a beam left out."""
    known = properties(deck, tables)
    for table in named(tables, "CMASS2"):
        for row in range(len(table)):
            scalar_mass(deck, mesh, table, row)
    for table in named(tables, "CBAR", "CBEAM"):
        for row, (number, own, first, second) in enumerate(table.whole(0, 4).tolist()):
            place, words = table.place(row), table.words(row, 16)
            own, about = own or number, f"{table.name} {number}"
            if own not in known:
                deck.note(place, f"{about}: there is no PBAR or PBEAM {own} that is read: not in the scene")
                continue
            if any(word not in ("", "0", "0.", "0.0") for word in words[8:16]):
                deck.note(place, f"{about}: with pins or offsets: not in the scene")
                continue
            nodes = point(mesh, first, place), point(mesh, second, place)
            along = direction(deck, mesh, table, row, nodes[0])
            if along is None:
                deck.note(place, f"{about}: without a direction of its axis: not in the scene")
                continue
            deck.differ(place, f"{table.name}: its beams become a superelement by Timoshenko's theory")
            deck.beams.append(Beam(nodes, place, about, known[own][0], known[own][1], tuple(along)))


def scalar_mass(deck, mesh, table, row):
    """CMASS2: number, mass, point, component; of one point."""
    place, words = table.place(row), table.words(row, 6)
    value = table.one_real(row, 1, words[1]) if words[1] else 0.0
    if any(words[k] not in ("", "0") for k in (4, 5)) or not words[2].isdigit() or words[3] not in "123456" or not words[3] or value <= 0:
        deck.note(place, "CMASS2: between points, without a component, or not positive: not in the scene")
        return
    node, d = point(mesh, int(words[2]), place), int(words[3]) - 1
    if turned_axes(mesh, node, deck.x[node]) is not None:
        deck.note(place, "CMASS2: in axes of a coordinate system (CD of GRID): not in the scene")
        return
    deck.one_way.append(OneWay(node, d, value * mesh.mass_factor, place, f"CMASS2 {words[0]}"))
