"""Abaqus: beams and their sections."""

import math

import numpy

from .material import numbers
from .words import choice
from ..deck import Beam, Material, Profile

KINDS = {"B31": 2, "B31H": 2, "B31OS": 2, "B33": 2, "B33H": 2, "B32": 3, "B32R": 3, "B32H": 3, "B32OS": 3}


def rectangle(a, b):
    """a along axis 1, b along axis 2; the torsion to 0.5 %."""
    long, short = max(a, b), min(a, b)
    torsion = long * short**3 * (1 / 3 - 0.21 * short / long * (1 - (short / long)**4 / 12))
    return Profile(a * b, b * a**3 / 12, a * b**3 / 12, torsion, 0.85, 0.85)


def circle(r, other=None):
    if other and other != r:
        return None
    return Profile(math.pi * r**2, math.pi * r**4 / 4, math.pi * r**4 / 4, math.pi * r**4 / 2, 0.89, 0.89)


def pipe(r, t):
    if t > r:
        return None
    outer, inner = circle(r), circle(r - t)
    values = [one - two for one, two in zip((outer.area, outer.bend_1, outer.bend_2, outer.torsion),
                                            (inner.area, inner.bend_1, inner.bend_2, inner.torsion))]
    return Profile(*values, 0.53, 0.53)


def box(a, b, *walls):
    """Walls of one thickness, t1 to t4."""
    if len(set(walls)) != 1 or len(walls) not in (1, 4):
        return None
    t = walls[0]
    if 2 * t >= min(a, b):
        return None
    outer, inner = rectangle(a, b), rectangle(a - 2 * t, b - 2 * t)
    torsion = 2 * t * ((a - t) * (b - t))**2 / (a + b - 2 * t)
    return Profile(outer.area - inner.area, outer.bend_1 - inner.bend_1, outer.bend_2 - inner.bend_2, torsion, 0.44, 0.44)


SHAPES = {"RECT": (2, 2, rectangle), "CIRC": (1, 2, circle), "PIPE": (2, 2, pipe), "BOX": (3, 6, box)}


def profile_of(kind, values):
    """The profile of a section with its lengths, None where it is not read."""
    least, most, made = SHAPES.get(kind, (1, 0, None))
    if not least <= len(values) <= most or min(values) <= 0:
        return None
    profile = made(*values)
    return profile if profile and min(profile.area, profile.bend_1, profile.bend_2, profile.torsion) > 0 else None


def general(row):
    """A, I11, I12, I22, J: I11 is of bending about axis 1, hence along axis 2."""
    if len(row) < 5 or row[2] or min(row[0], row[1], row[3], row[4]) <= 0:
        return None
    return Profile(row[0], row[3], row[1], row[4], 1.0, 1.0)


def axis_1(rows):
    """The direction of axis 1 on the second line; what is left out of it is 0."""
    return (rows[1] + 2 * [0.0])[:3] if len(rows) > 1 and rows[1] else [0.0, 0.0, -1.0]


def do_beam_section(reader, scope, card):
    """Lengths of the section, then the direction of axis 1."""
    name, material = card.need("ELSET"), card.need("MATERIAL")
    kind = choice(card.options.get("SECTION", ""), *SHAPES, "GENERAL", "I", "L", "ARBITRARY", "HEX", "TRAPEZOID")
    rows = [row for _, row in numbers(card)]
    if not rows:
        raise card.place.wrong(f"*{card.keyword} needs the lengths of its section")
    add_section(reader, scope, card, (name, material, profile_of(kind, rows[0]), axis_1(rows)))


def do_general_section(reader, scope, card):
    """A, I11, I12, I22, J; the direction of axis 1; E and G, which have a material of their own."""
    name, rows = card.need("ELSET"), [row for _, row in numbers(card)]
    kind = choice(card.options.get("SECTION", "GENERAL"), "GENERAL", *SHAPES)
    if not rows or len(rows) < 3 or len(rows[2]) < 2 or not card.options.get("DENSITY"):
        reader.deck.note(card.place, "*BEAM GENERAL SECTION: needs DENSITY, and a line with E and G: not in the scene")
        return
    try:
        density = float(card.options["DENSITY"])
    except ValueError:
        raise card.place.wrong(f"*BEAM GENERAL SECTION: DENSITY={card.options['DENSITY'][:30]} is no number") from None
    young, shear = rows[2][:2]
    if not (young > 0 and shear > 0 and density > 0):
        raise card.place.wrong("*BEAM GENERAL SECTION: E, G and DENSITY must be positive")
    material = f"section of {scope.full(name)}"
    reader.deck.materials[material] = Material(material, card.place, (young,), (young / (2 * shear) - 1,), density=density)
    add_section(reader, scope, card, (name, material, general(rows[0]) if kind == "GENERAL" else profile_of(kind, rows[0]),
                                       axis_1(rows)))


def add_section(reader, scope, card, section):
    """Beams of the elements of a set."""
    name, material, profile, along = section
    chosen = [number for number in scope.other_sets.get(name, []) if scope.holders.get(number, ("",))[0] in KINDS]
    scope.given.update(chosen)
    if profile is None or not numpy.any(along):
        reader.deck.note(card.place, f"*{card.keyword} {name}: a section, or a direction of axis 1, that is not read "
                                     f"({', '.join(SHAPES)} of one wall, or A, I11, I12 = 0, I22, J of GENERAL are): not in the scene")
        return
    if not chosen:
        raise card.place.wrong(f"*{card.keyword}: there is no set {name} of beams")
    reader.deck.differ(card.place, f"*{card.keyword} {name}: its beams become a superelement by Timoshenko's theory, of straight "
                                   "pieces between nodes; CalculiX makes solids of them")
    for number in chosen:
        kind, nodes, place = scope.holders[number]
        ends = nodes.tolist()
        reader.deck.beams += [Beam((int(a), int(b)), place, f"{kind} element {number}", material, profile, tuple(scope.turn @ along))
                              for a, b in zip(ends, ends[1:])]


CARDS = {"BEAM SECTION": do_beam_section, "BEAM GENERAL SECTION": do_general_section}
