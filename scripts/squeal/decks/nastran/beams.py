"""Nastran: beams and their properties, and masses along one direction."""

import numpy

from ..abaqus.beams import profile_of
from ..deck import Beam, OneWay, Profile
from .cards import named
from .joined import point, turned_axes

KNOWN = {"CBAR", "CBEAM", "PBAR", "PBEAM", "PBARL", "CMASS2"}
# Lengths of the shapes of PBARL as those of Abaqus' sections: axis 1 is that of Nastran's plane 1, along which DIM2 is
SHAPES = {"ROD": (1, lambda r: profile_of("CIRC", [r])), "TUBE": (2, lambda r, inner: profile_of("PIPE", [r, r - inner])),
          "BAR": (2, lambda width, height: profile_of("RECT", [height, width])),
          "BOX": (4, lambda width, height, flat, side: profile_of("BOX", [height, width, flat]) if flat == side else None)}


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


def shape_property(table, row):
    """PBARL: number, material, group, shape, -, -, -, -, lengths, mass per length."""
    words = table.words(row, 18)
    n, made = SHAPES.get(words[3].upper(), (0, None))
    values = [table.one_real(row, 8 + k, words[8 + k]) if words[8 + k] else 0.0 for k in range(n + 1)]
    profile = made(*values[:n]) if made and min(values[:n]) > 0 else None
    return profile and (words[1], profile, values[n])


def properties(deck, tables):
    """Number -> material, profile, place."""
    found = {}
    reader = {"PBAR": bar_property, "PBEAM": beam_property, "PBARL": shape_property}
    for table in named(tables, *reader):
        for row in range(len(table)):
            place, number = table.place(row), int(table.whole(0, 1)[row, 0])
            read = reader[table.name](table, row)
            if read is None and table.name == "PBARL":
                deck.note(place, f"PBARL {number}: only {', '.join(SHAPES)}, of one wall, are read: not taken; give its PBAR")
                continue
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


def ends_of(deck, mesh, table, row, nodes):
    """Pins and offsets of the two ends: OFFT, two words of digits, two vectors, each in the axes of its point; None where OFFT is not
    GGG."""
    words = table.words(row, 16)
    if words[7].upper() not in ("", "GGG", "0", "0.", "0.0") or any(set(word) - set("0123456") for word in words[8:10]):
        return None
    pins = tuple(tuple(sorted({int(letter) - 1 for letter in word} - {-1})) for word in words[8:10])
    arms = []
    for node, first in zip(nodes, (10, 13)):
        arm = numpy.array([table.one_real(row, k, words[k]) if words[k] else 0.0 for k in range(first, first + 3)])
        axes = turned_axes(mesh, node, deck.x[node])
        arms.append(arm if axes is None else arm @ axes)
    return pins, arms


def read_beams(deck, tables, mesh):
    """CBAR and CBEAM: number, property, two points, the direction, pins and offsets."""
    known = properties(deck, tables)
    for table in named(tables, "CMASS2"):
        for row in range(len(table)):
            scalar_mass(deck, mesh, table, row)
    for table in named(tables, "CBAR", "CBEAM"):
        for row, (number, own, first, second) in enumerate(table.whole(0, 4).tolist()):
            place = table.place(row)
            own, about = own or number, f"{table.name} {number}"
            if own not in known:
                deck.note(place, f"{about}: there is no PBAR or PBEAM {own} that is read: not in the scene")
                continue
            nodes = point(mesh, first, place), point(mesh, second, place)
            ends = ends_of(deck, mesh, table, row, nodes)
            if ends is None:
                deck.note(place, f"{about}: OFFT that is not GGG, bits, or pins beyond 1 to 6: not in the scene")
                continue
            along = direction(deck, mesh, table, row, nodes[0])
            if along is None:
                deck.note(place, f"{about}: without a direction of its axis: not in the scene")
                continue
            deck.differ(place, f"{table.name}: its beams become a superelement by Timoshenko's theory")
            deck.beams.append(Beam(nodes, place, about, known[own][0], known[own][1], tuple(along), ends[1], ends[0]))


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
