"""Abaqus: friction of surface interactions, from *FRICTION there and, behind *CHANGE FRICTION, in steps; the last one counts."""

import math

from .material import first_row, numbers
from ..friction import law_of, unlike

LAWS = "mu", "friction", "decay", "table"


def do_friction(reader, _, card):
    if "ROUGH" in card.options:
        raise card.place.wrong("*FRICTION, ROUGH: squeal has no contact without slip; give mu")
    row, _ = first_row(card, 1)
    values = reader.interactions.get(reader.interaction)
    if values is None:
        raise card.place.wrong("*FRICTION outside of a *SURFACE INTERACTION")
    if row[0] < 0:
        raise card.place.wrong(f"friction coefficient {row[0]:g} must not be negative")
    if "mu" in values:
        reader.deck.note(values["friction"], f"*FRICTION {values['mu']:g}: not taken, another one follows on line {card.place.line}")
    if {"SLIP TOLERANCE", "ELASTIC SLIP"} & set(card.options):
        reader.deck.differ(card.place, "*FRICTION: slip that Abaqus allows a pair that sticks; Coulomb's law of squeal allows none")
    for name in LAWS:
        values.pop(name, None)
    values["mu"], values["friction"] = row[0], card.place
    if "EXPONENTIAL DECAY" in card.options:
        card.options.pop("EXPONENTIAL DECAY")
        values.update(decay_of(reader, card))
    else:
        values.update(table_of(reader, card))
    if not reader.steps:  # what RESET goes back to
        values["first"] = {name: values[name] for name in LAWS if name in values}


def decay_of(reader, card):
    """Static and kinetic coefficient, speed of the decay; by TEST DATA from mu at rest, mu at a slip rate, mu of fast sliding."""
    rows = [row for _, row in numbers(card)]
    measured = card.options.pop("TEST DATA", None) is not None
    if measured:
        still, (slow, rate, *_) = rows[0][0], (*(rows[1] if len(rows) > 1 else []), 0.0, 0.0)[:2]
        fast = rows[2][0] if len(rows) > 2 else (slow - 0.05 * still) / 0.95
        good = rate > 0 and still > slow > fast >= 0 or rate > 0 and 0 <= still < slow < fast
        found = (still, fast, rate / math.log((still - fast) / (slow - fast))) if good else ()
    else:
        row = (rows[0] + [0.0] * 3)[:3]
        found = (row[0], row[1], 1 / row[2]) if row[2] > 0 and row[1] >= 0 else ()
    if len(rows) > (3 if measured else 1):
        reader.deck.note(card.place, "*FRICTION, EXPONENTIAL DECAY: only the first line is taken" if not measured else
                         "*FRICTION, EXPONENTIAL DECAY, TEST DATA: only the first three lines are taken")
    if not found:
        reader.deck.note(card.place, "*FRICTION, EXPONENTIAL DECAY: needs mu_s, mu_k and a positive decay; mu_s is taken")
        return {}
    return {"decay": found}


def table_of(reader, card):
    """mu, slip rate, pressure, temperature, and other fields, of which the first values count."""
    rows = [row for _, row in numbers(card) if row]
    if "ANISOTROPIC" in card.options:
        card.options.pop("ANISOTROPIC")
        reader.deck.note(card.place, f"*FRICTION, ANISOTROPIC: squeal's friction is the same along all directions: the first mu, "
                                     f"{rows[0][0]:g}, is taken")
        return {}
    if len(rows) == 1:
        if any(rows[0][1:]):
            reader.deck.note(card.place, "*FRICTION: only the first number, mu, is taken")
        return {}
    fields = {tuple(row[4:]) for row in rows}
    if card.options.pop("DEPENDENCIES", "") and len(fields) > 1 or any(len(row) > 8 for row in rows):
        first = tuple(rows[0][4:])
        rows = [row for row in rows if tuple(row[4:]) == first]
        reader.deck.note(card.place, "*FRICTION: depends on field variables: the lines of their first values are taken")
    lines = [tuple((row + [0.0] * 3)[:4]) for row in rows]
    if not unlike(lines):
        reader.deck.note(card.place, "*FRICTION: only the first line is taken")
        return {}
    mu, table = law_of(reader.deck, card.place, "*FRICTION", lines, reader.temperature)
    return {"mu": mu, "table": table}


def do_change_friction(reader, _, card):
    reader.interaction = card.need("INTERACTION")
    values = reader.interactions.get(reader.interaction)
    if values is None:
        raise card.place.wrong(f"there is no *SURFACE INTERACTION {reader.interaction}")
    if "RESET" in card.options:
        card.options.pop("RESET")
        for name in LAWS:
            values.pop(name, None)
        values.update(values.get("first", {}))


CARDS = {"FRICTION": do_friction, "CHANGE FRICTION": do_change_friction}
