"""Abaqus: holders, contact and steps."""

import numpy

from .joined import leave_coupling
from .material import add_global_damping, first_row, numbers
from .sets import reader_nodes, surface_of
from .words import choice, label
from ..deck import NOT_NEEDED, Contact, Equation, Support, Tie, Turning
from ..axes import aligned
from ..joined.springs import read_springs
from ..text import real, whole

HELD = {"ENCASTRE": range(6), "PINNED": (0, 1, 2), "XSYMM": (0, 4, 5), "YSYMM": (1, 3, 5), "ZSYMM": (2, 3, 4), "XASYMM": (1, 2, 3),
        "YASYMM": (0, 2, 4), "ZASYMM": (0, 1, 5)}


def direction(word, place, keyword, reader):
    """0 to 5 of a degree of freedom; others are listed."""
    dof = whole(word, place, "a degree of freedom")
    if 1 <= dof <= 6:
        return dof - 1
    reader.deck.note(place, f"*{keyword}: degree of freedom {dof}, which solids do not have")
    return None


def do_boundary(reader, scope, card):
    kind = choice(card.options.get("TYPE", "DISPLACEMENT"), "DISPLACEMENT", "VELOCITY", "ACCELERATION")
    from_elsewhere = [word for word in ("SUBMODEL", "USER", "MASS FLOW") if word in card.options]
    if kind != "DISPLACEMENT" or from_elsewhere:
        reader.deck.note(card.place, f"*BOUNDARY, {from_elsewhere[0] if from_elsewhere else f'TYPE={kind}'}: not understood")
        return
    if card.choose("OP", "MOD", "NEW", "MOD") == "NEW":
        reader.deck.note(card.place, "*BOUNDARY, OP=NEW: supports of earlier steps act no longer; see which you want")
        reader.supports = [row for row in reader.supports if row[0] == reader.steps]
    factor = factor_of(reader, card)
    for place, fields in card.rows():
        nodes = reader_nodes(reader, scope, fields[0], place)
        word = fields[1].upper() if len(fields) > 1 else ""
        values = {d: 0.0 for d in HELD[word]} if word in HELD else boundary_values(reader, place, fields)
        values = {d: factor * value for d, value in values.items()}
        name = "" if fields[0].isdigit() else set_name(reader, scope, fields[0])
        whole_set = len(nodes)
        if any(d not in values or values[d] for d in range(3)):
            nodes = hold_turned(reader, nodes, values, place)
        if values and len(nodes):
            reader.supports.append((reader.steps, Support(nodes, values, name if len(nodes) == whole_set else "", place)))


def hold_turned(reader, nodes, values, place):
    """Holds nodes that have axes of their own: along axes of space, or by equations; returns the other nodes."""
    own = numpy.array([node in reader.turned for node in nodes.tolist()], bool)
    for node in nodes[own].tolist():
        axes, plain = reader.turned[node], {}
        if axes is None:
            reader.deck.note(place, "*BOUNDARY: in the axes of *TRANSFORM, not taken")
            continue
        for first in (0, 3):
            held = [d for d in range(3) if first + d in values]
            found = aligned(axes, held) if held else {}
            if found is not None and not any(values[first + d] for d in held) or found and all(sign for _, sign in found.values()):
                plain |= {first + d: sign * values[first + own_d] + 0.0 if sign else 0.0 for d, (own_d, sign) in found.items()}
            elif any(values[first + d] for d in held):
                reader.deck.note(place, "*BOUNDARY: moved in the axes of *TRANSFORM, not taken")
            else:
                reader.deck.equations += [
                    Equation([(node, first + e, float(axes[d, e])) for e in range(3) if abs(axes[d, e]) > 1e-12], place,
                             "*BOUNDARY in the axes of *TRANSFORM") for d in held]
        if plain:
            reader.supports.append((reader.steps, Support(numpy.array([node]), plain, "", place)))
    return nodes[~own]


def boundary_values(reader, place, fields):
    """Direction -> displacement of a line: first and last degree of freedom, and the value."""
    if not 2 <= len(fields) <= 4:
        raise place.wrong(f"*BOUNDARY: {len(fields)} fields, expected 2 to 4")
    first = whole(fields[1], place, "a degree of freedom")
    last = whole(fields[2], place, "a degree of freedom") if len(fields) > 2 and fields[2] else first
    value = real(fields[3], place) if len(fields) > 3 and fields[3] else 0.0
    if not 0 <= first <= last <= 31:
        raise place.wrong(f"*BOUNDARY: degrees of freedom {first} to {last}")
    if first < 1 or last > 6:
        reader.deck.note(place, f"*BOUNDARY: degrees of freedom {first} to {last}, those beyond 1 to 3 solids do not have")
    return {dof - 1: value for dof in range(max(first, 1), min(last, 6) + 1)}


def finish_supports(reader):
    """Supports of the deck: of a node and direction the last line counts, whichever set named it."""
    deck, last, kept = reader.deck, numpy.full((reader.deck.n_nodes, 6), numpy.nan), []
    for _, support in reader.supports:
        if min(support.values) > 2 and all(reader.is_solid(node) for node in support.nodes.tolist()):
            dofs = f"{min(support.values) + 1} to {max(support.values) + 1}"
            deck.note(support.place, f"*BOUNDARY: degrees of freedom {dofs}, those beyond 1 to 3 solids do not have")
    for _, support in reversed(reader.supports):
        left = {}
        for d, value in support.values.items():
            there = last[support.nodes, d]
            left[d] = numpy.isnan(there) | (there == value)
            last[support.nodes[left[d]], d] = value
        if all(free.all() for free in left.values()):
            kept.append(support)
            continue
        kept += [Support(support.nodes[free], {d: support.values[d]}, "", support.place) for d, free in left.items() if free.any()]
    deck.supports += reversed(kept)


def set_name(reader, scope, word):
    """The name of a set in the deck."""
    inner, name = reader.split(label(word), scope)
    return inner.full(name)


def do_spring(reader, scope, card):
    """Degrees of freedom, then the stiffness; done when all supports are known."""
    rows = [row for _, row in numbers(card)]
    if "NONLINEAR" in card.options:
        reader.deck.note(card.place, f"*{card.keyword}, NONLINEAR: not understood")
        return
    lines = [text.split(b"\n") for text, _ in card.pieces]
    blank = bool(lines and not lines[0][0].strip())
    dofs, values = ([], rows) if blank or len(rows) < 2 else (rows[0], rows[1:])
    if not values or not values[0]:
        raise card.place.wrong(f"*{card.keyword} has no {'stiffness' if card.keyword == 'SPRING' else 'coefficient'}")
    if values[0][0] < 0:
        what = "stiffness" if card.keyword == "SPRING" else "coefficient"
        raise card.place.wrong(f"*{card.keyword}: {what} {values[0][0]:g} must not be negative")
    reader.spring_cards.append((scope, card, dofs, values[0][0]))


def do_tie(reader, scope, card):
    other = [word for word in ("CYCLIC SYMMETRY", "MULTISTAGE", "FLUID PERIODIC") if word in card.options]
    if other:
        card.options.pop(other[0])
        reader.deck.note(card.place, f"*TIE, {other[0]}: not read, and no glue; the sector is a body of its own")
        return
    for place, fields in card.rows():
        slave, master = surface_pair(reader, scope, place, fields)
        name = card.options.get("NAME", "tie").strip('"')
        reader.deck.ties.append(Tie(name, slave, master, place, f"*TIE {name}", tie_distance(card)))


def tie_distance(card):
    """POSITION TOLERANCE, 0 where it is not given."""
    text = card.options.get("POSITION TOLERANCE", "0")
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        raise card.place.wrong(f"*TIE: POSITION TOLERANCE={text[:30]} must be a number, 0 or more")
    return value


def surface_pair(reader, scope, place, fields):
    """Names of two surfaces in the deck."""
    if len(fields) < 2:
        raise place.wrong("two surfaces are needed: slave, master")
    return [surface_of(reader, scope, word, place) for word in fields[:2]]


def do_interaction(reader, _, card):
    reader.interaction = card.need("NAME")
    reader.interactions.setdefault(reader.interaction, {"place": card.place})


def points_of(reader, card):
    """Overclosure and pressure, one after the other, of a table that rises from no pressure on; else it is listed, and nothing."""
    rows = [(place, row) for place, row in numbers(card) if row]
    points = numpy.array([row[1::-1] for _, row in rows if len(row) == 2])
    if len(points) != len(rows) or len(points) < 2:
        raise card.place.wrong("*SURFACE BEHAVIOR: a table needs two lines at least, each with pressure and overclosure")
    if points[0, 1] == 0 and (numpy.diff(points, axis=0) > 0).all():
        return tuple(points.ravel())
    reader.deck.note(card.place, "*SURFACE BEHAVIOR: a table that does not rise from no pressure on, not taken: contact is exact")
    return ()


def do_behavior(reader, _, card):
    kind = choice(card.options.get("PRESSURE-OVERCLOSURE", "HARD"), "HARD", "LINEAR", "EXPONENTIAL", "TABULAR", "TIED",
                  "SCALE FACTOR", "USER DEFINED")
    values = reader.interactions.get(reader.interaction)
    if values is None:
        raise card.place.wrong("*SURFACE BEHAVIOR outside of a *SURFACE INTERACTION")
    if kind == "LINEAR":
        values["stiffness"] = first_row(card, 1)[0][0]
        if not values["stiffness"] > 0:
            raise card.place.wrong("*SURFACE BEHAVIOR: the stiffness must be positive")
    elif kind == "TABULAR":
        values["points"] = points_of(reader, card)
    elif kind == "EXPONENTIAL":
        row = first_row(card, 2)[0]
        if min(row[:2]) <= 0:
            raise card.place.wrong("*SURFACE BEHAVIOR: clearance and pressure of the exponential law must be positive")
        values["exponential"] = row[0], row[1]
        reader.deck.differ(card.place, "*SURFACE BEHAVIOR, EXPONENTIAL: as Abaqus has it; CalculiX' law of this name is "
                                       "another, p0 exp(ln(100) c / c0)")
    elif kind == "TIED":
        values["tied"] = True
    elif kind != "HARD":
        reader.deck.note(card.place, f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={kind}: not understood, contact is exact")


def do_pair(reader, scope, card):
    interaction = card.need("INTERACTION")
    for place, fields in card.rows():
        reader.pairs.append((Contact(interaction, *surface_pair(reader, scope, place, fields), place), interaction, "TIED" in card.options))


def do_motion(reader, scope, card):
    """Nodes that turn: a set, rad per time, two points of the axis, by the right-hand rule from the first to the second."""
    if "ROTATION" not in card.options or choice(card.options.get("TYPE", "VELOCITY"), "VELOCITY", "DISPLACEMENT") != "VELOCITY":
        reader.deck.note(card.place, "*MOTION: only ROTATION with TYPE=VELOCITY is understood")
        return
    for place, fields in card.rows():
        if len(fields) != 8:
            raise place.wrong(f"*MOTION: {len(fields)} fields, expected a set, a velocity and two points")
        nodes = reader_nodes(reader, scope, fields[0], place)
        values = numpy.array([real(word or "0", place) for word in fields[1:]])
        axis = values[4:7] - values[1:4]
        if not numpy.linalg.norm(axis) > 0:
            raise place.wrong("*MOTION: the two points of the axis are the same")
        reader.deck.turnings.append(Turning(nodes, values[0] * axis / numpy.linalg.norm(axis), values[1:4], place))


def do_step(reader, _, card):
    reader.steps += 1
    if reader.steps == 2:
        reader.deck.note(card.place, "*STEP: the scene has the supports and loads of all steps, of the same node and "
                                     "direction the last one; see which you want")
    if "NLGEOM" in card.options and card.choose("NLGEOM", "YES", "YES", "NO") == "YES":
        reader.deck.differ(card.place, "*STEP, NLGEOM: motion of squeal is small; -static_geometric and -static_follower give "
                                       "modes the stiffness of the preload")


def do_static(reader, _, card):
    reader.preload = card.place
    rows = numbers(card)
    reader.period = rows[0][1][1] if rows and len(rows[0][1]) > 1 and rows[0][1][1] > 0 else 1.0


def do_amplitude(reader, _, card):
    """Times and values, several in a line."""
    kind = choice(card.options.pop("DEFINITION", "TABULAR"), "TABULAR", "EQUALLY SPACED", "SMOOTH STEP", "PERIODIC", "DECAY", "USER")
    values = [value for _, row in numbers(card) for value in row]
    if kind not in ("TABULAR", "SMOOTH STEP") or len(values) < 4 or len(values) % 2 or (numpy.diff(values[::2]) < 0).any():
        reader.deck.note(card.place, f"*AMPLITUDE, DEFINITION={kind}: not understood; loads keep their size")
        return
    reader.amplitudes[card.need("NAME")] = numpy.array(values).reshape(-1, 2)


def factor_of(reader, card):
    """Size of what an amplitude scales, at the end of the step."""
    name = label(card.options.pop("AMPLITUDE", ""))
    if not name:
        return 1.0
    if name not in reader.amplitudes:
        reader.deck.note(card.place, f"*{card.keyword}: amplitude {name} is not read: not scaled")
        return 1.0
    table = reader.amplitudes[name]
    value = float(numpy.interp(reader.period, table[:, 0], table[:, 1]))
    reader.deck.differ(card.place, f"*{card.keyword}: times {value:g}, the value of *AMPLITUDE {name} at the end of the step")
    return value


def do_frequency(reader, _, card):
    rows = numbers(card)
    row = (rows[0][1] if rows else []) + [0, 0, 0]
    reader.modes_step = reader.steps
    reader.deck.modes, reader.deck.preload = (row[0], row[1], row[2], card.place), reader.preload


def do_complex(reader, _, card):
    if card.choose("FRICTION DAMPING", "NO", "YES", "NO") == "YES":
        reader.damping = card.place
    elif reader.deck.modes:
        reader.deck.note(card.place, f"*COMPLEX FREQUENCY: modes of squeal are complex, {NOT_NEEDED}")
    if not reader.deck.modes:
        do_frequency(reader, _, card)
    reader.modes_step = reader.steps


def finish_steps(reader):
    """Whether modes are about the sliding state, as after a *STATIC that presses; where they are not, that is listed."""
    deck = reader.deck
    add_global_damping(reader)
    pressed = deck.loads or deck.bolts or deck.gravity or reader.fits or any(any(support.values.values()) for support in deck.supports)
    if not (deck.contacts and pressed):
        deck.preload = None
    if reader.preload and not deck.preload:
        deck.note(reader.preload, f"*STATIC: {'without contact or load before the modes' if deck.modes else 'an analysis'}, {NOT_NEEDED}")
    if not reader.damping:
        return
    if not deck.preload:
        deck.note(reader.damping, "*COMPLEX FREQUENCY, FRICTION DAMPING: without a *STATIC that presses a contact there is none")
        return
    for contact in deck.contacts:
        contact.damping = reader.damping


def turn_nodes(reader):
    """What holds or loads a ROT NODE is of the rotations of the reference node."""
    for at, (step, support) in enumerate(reader.supports):
        own = [node for node in support.nodes.tolist() if node in reader.rotations]
        for node in own:
            turned = {d + 3: value for d, value in support.values.items() if d < 3}
            if turned:
                reader.supports.append((step, Support(numpy.array([reader.rotations[node]]), turned, "", support.place)))
        if own:
            reader.supports[at] = step, Support(numpy.setdiff1d(support.nodes, own), support.values, "", support.place)


def finish(reader):
    """Supports, contact of all pairs, springs."""
    leave_coupling(reader)
    turn_nodes(reader)
    finish_supports(reader)
    for contact, interaction, tied in reader.pairs:
        values = reader.interactions.get(interaction)
        if values is None:
            raise contact.place.wrong(f"there is no *SURFACE INTERACTION {interaction}")
        if tied or values.get("tied"):
            reader.deck.ties.append(Tie(contact.name, contact.slave, contact.master, contact.place,
                                        f"*CONTACT PAIR {contact.slave}, {contact.master}, tied"))
            continue
        contact.mu, contact.stiffness = values.get("mu"), values.get("stiffness")
        for name in ("points", "exponential", "decay", "table"):
            setattr(contact, name, values.get(name, ()))
        reader.deck.contacts.append(contact)
    read_springs(reader)
    finish_steps(reader)


CARDS = {"AMPLITUDE": do_amplitude, "BOUNDARY": do_boundary, "SPRING": do_spring, "DASHPOT": do_spring, "TIE": do_tie,
         "SURFACE INTERACTION": do_interaction, "SURFACE BEHAVIOR": do_behavior,
         "CONTACT PAIR": do_pair, "MOTION": do_motion, "STEP": do_step, "STATIC": do_static,
         "FREQUENCY": do_frequency, "COMPLEX FREQUENCY": do_complex}
