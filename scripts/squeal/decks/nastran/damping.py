"""Nastran: damping of modes over their frequency, SDAMPING = n of case control and TABDMP1 n: a structural damping g, a share of the
critical one (g / 2), or a quality 1 / g. squeal has it as a loss factor of all parts, or a table of it."""

import numpy

from .cards import named
from ..deck import give_loss

KNOWN = {"TABDMP1"}
FACTORS = {"": lambda g: g, "G": lambda g: g, "CRIT": lambda c: 2 * c, "Q": lambda q: 1 / q if q else float("nan")}
LOW = 1e-2  # of the next frequency: in place of 0, which a table of squeal does not have
MOST = 64  # rows of a table of squeal, which goes by the logarithm of the frequency, while Nastran's is straight


def read_damping(deck, tables, chosen):
    """The table that case control chooses; others are listed."""
    number, place = chosen.damping
    found = False
    for table in named(tables, "TABDMP1"):
        for row, own in enumerate(table.whole(0, 1)[:, 0].tolist()):
            if own == number:
                found, points = True, points_of(table, row)
                if points:
                    add(deck, table.place(row), number, points)
                else:
                    deck.note(table.place(row), f"TABDMP1 {own}: up to {MOST} rising frequencies with damping that is not negative are "
                                                "needed: not taken")
            else:
                deck.note(table.place(row), f"TABDMP1 {own}: case control has no SDAMPING = {own}: not taken")
    if number is not None and not found:
        deck.note(place, f"SDAMPING = {number}: there is no such TABDMP1")


def points_of(table, row):
    """Frequencies and loss factors of a card, ascending; none of one that squeal cannot have."""
    words, place = table.words(row, 9), table.place(row)
    kind, points = words[1].upper(), []
    if kind not in FACTORS:
        raise place.wrong(f"TABDMP1: type {kind[:10]} is none of G, CRIT, Q")
    for at in range(8, len(words) - 1, 2):
        pair = words[at:at + 2]
        if "ENDT" in (pair[0].upper(), pair[1].upper()):
            break
        if pair[0] and "SKIP" not in (pair[0].upper(), pair[1].upper()):
            frequency, value = (table.one_real(row, at + k, pair[k] or "0.") for k in (0, 1))
            points.append((frequency, FACTORS[kind](value)))
    falls = any(b <= a for (a, _), (b, _) in zip(points, points[1:]))
    if len(points) > MOST or falls or any(not g >= 0 or f < 0 for f, g in points):
        return []
    return points


def finer(points):
    """Points between those of a table, on its straight lines, as many as squeal takes."""
    own, g = numpy.array(points).T
    x = numpy.array([own[0] or LOW * own[1], *own[1:]])
    spare = max(0, MOST - len(x)) / numpy.log(x[-1] / x[0])
    parts = [numpy.geomspace(a, b, 2 + int(spare * numpy.log(b / a)))[:-1] for a, b in zip(x, x[1:])]
    at = numpy.concatenate([*parts, x[-1:]])
    return at, numpy.interp(at, own, g)


def add(deck, place, number, points):
    """Adds the damping to all materials."""
    factors = {g for _, g in points}
    deck.differ(place, f"TABDMP1 {number}: the damping of a mode as a loss factor of all parts" + (
        "" if len(factors) == 1 else ", from the first to the last frequency of the table, beyond which squeal takes none") +
        "; springs and contacts have none")
    for material in deck.materials.values():
        if len(factors) == 1:
            give_loss(material, points[0][1], place)
        elif len(material.young) != 1 or material.shear:
            deck.note(place, f"TABDMP1 {number}: material {material.name} is orthotropic and gets no damping that varies; give the part "
                             "a loss_factor")
        else:
            frequency, g = finer(points)
            material.law = (("table_frequency", "rate", tuple(frequency)), ("table_modulus", "stress", material.young * len(g)),
                            ("table_loss_factor", "", tuple(g + material.loss)))
            material.loss, material.places["VISCOELASTIC"] = 0.0, place
