"""Abaqus: holders, contact, loads and steps."""

import numpy

from .abaqus_material import CARDS as MATERIAL_CARDS
from .abaqus_material import first_row, numbers, other_rows
from .abaqus_mesh import SPRINGS, check_faces, reader_cells, reader_nodes
from .deck import NOT_NEEDED, Contact, Load, Support, Tie, Turning
from .springs import ground_springs
from .text import real, whole

HELD = {"ENCASTRE": (0, 1, 2), "PINNED": (0, 1, 2), "XSYMM": (0,), "YSYMM": (1,), "ZSYMM": (2,), "XASYMM": (1, 2),
        "YASYMM": (0, 2), "ZASYMM": (0, 1)}
# Options that change what a card says; others are listed
KNOWN = {"MATERIAL": {"NAME"}, "DENSITY": set(), "ELASTIC": {"TYPE"}, "DAMPING": {"ALPHA", "BETA"},
         "SOLID SECTION": {"ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"}, "ORIENTATION": {"NAME", "SYSTEM", "DEFINITION"},
         "BOUNDARY": {"OP", "FIXED"}, "SPRING": {"ELSET"}, "TIE": {"NAME", "POSITION TOLERANCE", "ADJUST", "TYPE"},
         "CONTACT PAIR": {"INTERACTION", "TYPE", "SMALL SLIDING", "ADJUST", "CPSET", "NO THICKNESS", "MECHANICAL CONSTRAINT",
                          "TIED"},
         "SURFACE INTERACTION": {"NAME"}, "FRICTION": {"SLIP TOLERANCE", "ELASTIC SLIP"}, "SURFACE BEHAVIOR": {"PRESSURE-OVERCLOSURE"},
         "CHANGE FRICTION": {"INTERACTION"}, "CLOAD": {"OP"}, "DLOAD": {"OP"}, "DSLOAD": {"OP"},
         "MOTION": {"ROTATION", "TYPE"}, "STEP": {"NAME", "PERTURBATION", "INC", "NLGEOM"},
         "FREQUENCY": {"EIGENSOLVER", "STORAGE", "NORMALIZATION", "SOLVER"}, "STATIC": {"SOLVER"},
         "COMPLEX FREQUENCY": {"FRICTION DAMPING", "SOLVER", "RIGHT EIGENVECTORS"}}
IDLE = {"STEP": {"UNSYMM"}, "FREQUENCY": {"SIM", "ACOUSTIC COUPLING"}, "STATIC": {"STABILIZE", "DIRECT", "ADIABATIC"}}


def direction(word, place, keyword, reader):
    """0, 1, 2 of a degree of freedom; others, which solids do not have, are listed."""
    dof = whole(word, place, "a degree of freedom")
    if 1 <= dof <= 3:
        return dof - 1
    reader.deck.note(place, f"*{keyword}: degree of freedom {dof}, which solids do not have")
    return None


def is_turned(reader, nodes, place, keyword):
    """Whether *TRANSFORM has given nodes other axes; then the line is listed."""
    if any(numpy.isin(nodes, turned).any() for turned, _ in reader.turned.values()):
        reader.deck.note(place, f"*{keyword}: in the axes of *TRANSFORM, not taken")
        return True
    return False


def do_boundary(reader, scope, card):
    if card.options.get("TYPE", "DISPLACEMENT").upper() != "DISPLACEMENT":
        reader.deck.note(card.place, f"*BOUNDARY, TYPE={card.options['TYPE']}: not understood")
        return
    if card.options.get("OP", "MOD").upper() == "NEW":
        reader.deck.note(card.place, "*BOUNDARY, OP=NEW: supports of earlier steps are kept in the scene; see which you want")
    for place, fields in card.rows():
        nodes = reader_nodes(reader, scope, fields[0], place)
        if is_turned(reader, nodes, place, card.keyword):
            continue
        word = fields[1].upper() if len(fields) > 1 else ""
        values = {d: 0.0 for d in HELD[word]} if word in HELD else boundary_values(reader, place, fields)
        name = "" if fields[0].isdigit() else set_name(reader, scope, fields[0])
        if values:
            reader.deck.supports.append(Support(nodes, values, name, place))


def boundary_values(reader, place, fields):
    """Direction -> displacement of a line: first and last degree of freedom, and the value."""
    if not 2 <= len(fields) <= 4:
        raise place.wrong(f"*BOUNDARY: {len(fields)} fields, expected 2 to 4")
    first = whole(fields[1], place, "a degree of freedom")
    last = whole(fields[2], place, "a degree of freedom") if len(fields) > 2 and fields[2] else first
    value = real(fields[3], place) if len(fields) > 3 and fields[3] else 0.0
    if not 1 <= first <= last <= 31:
        raise place.wrong(f"*BOUNDARY: degrees of freedom {first} to {last}")
    if last > 3 and not (first <= 3 and last <= 6):
        reader.deck.note(place, f"*BOUNDARY: degrees of freedom {first} to {last}, those above 3 solids do not have")
    return {dof - 1: value for dof in range(first, min(last, 3) + 1)}


def set_name(reader, scope, word):
    """The name of a set in the deck."""
    inner, name = reader.split(word.strip('"').upper(), scope)
    return inner.full(name)


def do_spring(reader, scope, card):
    """Degrees of freedom, then the stiffness; done when all supports are known."""
    rows = [row for _, row in numbers(card)]
    if "NONLINEAR" in card.options:
        reader.deck.note(card.place, "*SPRING, NONLINEAR: not understood")
        return
    lines = [text.split(b"\n") for text, _ in card.pieces]
    blank = bool(lines and not lines[0][0].strip())
    dofs, values = ([], rows) if blank or len(rows) < 2 else (rows[0], rows[1:])
    if not values or not values[0]:
        raise card.place.wrong("*SPRING has no stiffness")
    if values[0][0] < 0:
        raise card.place.wrong(f"*SPRING: stiffness {values[0][0]:g} must not be negative")
    reader.spring_cards.append((scope, card, dofs, values[0][0]))


def do_tie(reader, scope, card):
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
    found = []
    for word in fields[:2]:
        inner, name = reader.split(word.strip('"').upper(), scope)
        if name not in inner.surfaces:
            raise place.wrong(f"there is no surface '{word[:60]}'")
        found.append(inner.surfaces[name])
    return found


def do_interaction(reader, _, card):
    reader.interaction = card.need("NAME")
    reader.interactions.setdefault(reader.interaction, {"place": card.place})


def do_friction(reader, _, card):
    if "ROUGH" in card.options:
        raise card.place.wrong("*FRICTION, ROUGH: squeal has no contact without slip; give mu")
    row, rest = first_row(card, 1)
    values = reader.interactions.get(reader.interaction)
    if values is None:
        raise card.place.wrong("*FRICTION outside of a *SURFACE INTERACTION")
    if row[0] < 0:
        raise card.place.wrong(f"friction coefficient {row[0]:g} must not be negative")
    if "mu" in values:
        reader.deck.note(values["friction"], f"*FRICTION {values['mu']:g}: not taken, another one follows on line {card.place.line}")
    values["mu"], values["friction"] = row[0], card.place
    if {"SLIP TOLERANCE", "ELASTIC SLIP"} & set(card.options):
        reader.deck.differ(card.place, "*FRICTION: slip that Abaqus allows a pair that sticks; Coulomb's law of squeal allows none")
    if any(row[1:]):
        reader.deck.note(card.place, "*FRICTION: only the first number, mu, is taken")
    other_rows(reader, card, rest)


def do_behavior(reader, _, card):
    kind = card.options.get("PRESSURE-OVERCLOSURE", "HARD").upper()
    values = reader.interactions.get(reader.interaction)
    if values is None:
        raise card.place.wrong("*SURFACE BEHAVIOR outside of a *SURFACE INTERACTION")
    if kind == "LINEAR":
        values["stiffness"] = first_row(card, 1)[0][0]
        if not values["stiffness"] > 0:
            raise card.place.wrong("*SURFACE BEHAVIOR: the stiffness must be positive")
    elif kind == "TIED":
        values["tied"] = True
    elif kind != "HARD":
        reader.deck.note(card.place, f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={kind}: not understood, contact is exact")


def do_change_friction(reader, _, card):
    reader.interaction = card.need("INTERACTION")
    if reader.interaction not in reader.interactions:
        raise card.place.wrong(f"there is no *SURFACE INTERACTION {reader.interaction}")


def do_pair(reader, scope, card):
    interaction = card.need("INTERACTION")
    for place, fields in card.rows():
        reader.pairs.append((Contact(interaction, *surface_pair(reader, scope, place, fields), place), interaction, "TIED" in card.options))


def forget(reader, card):
    """OP=NEW: the loads of earlier steps act no longer."""
    if card.options.get("OP", "MOD").upper() == "NEW":
        reader.loads = {key: value for key, value in reader.loads.items() if key[0] != card.keyword or value[0] == reader.steps}


def act(reader, key, load=None):
    """Adds a load, None where it is 0; the same in an earlier step acts no longer (OP=MOD)."""
    step, loads = reader.loads.get(key, (0, []))
    kept = loads if step == reader.steps else []
    reader.loads[key] = reader.steps, kept + ([load] if load else [])


def do_cload(reader, scope, card):
    forget(reader, card)
    for place, fields in card.rows():
        if len(fields) != 3:
            raise place.wrong(f"*CLOAD: {len(fields)} fields, expected a node or set, a direction, a force")
        nodes, d = reader_nodes(reader, scope, fields[0], place), direction(fields[1], place, card.keyword, reader)
        value = real(fields[2], place)
        if d is None or is_turned(reader, nodes, place, card.keyword):
            continue
        force = numpy.zeros(3)
        force[d] = value
        name = "" if fields[0].isdigit() else set_name(reader, scope, fields[0])
        key = (card.keyword, name or int(nodes[0]), d)
        act(reader, key, Load(name, place, nodes=nodes, force=force) if value else None)


def do_dload(reader, scope, card):
    forget(reader, card)
    for place, fields in card.rows():
        kind = fields[1].upper() if len(fields) > 1 else ""
        if kind == "GRAV":
            gravity(reader, scope, place, fields)
        elif len(kind) == 2 and kind[0] == "P" and kind[1].isdigit() and len(fields) == 3:
            faces = check_faces(reader.deck, reader_cells(reader, scope, fields[0], place), int(kind[1]), place)
            act(reader, (card.keyword, faces.tobytes()), Load("", place, faces=faces, pressure=real(fields[2], place)))
        else:
            reader.deck.note(place, f"*DLOAD {kind}: not understood")


def gravity(reader, scope, place, fields):
    """Acceleration and direction, on all cells."""
    if len(fields) != 6:
        raise place.wrong("*DLOAD GRAV needs an acceleration and three components of its direction")
    values = numpy.array([real(word or "0", place) for word in fields[2:]])
    cells = reader_cells(reader, scope, fields[0], place) if fields[0] else numpy.arange(reader.deck.n_cells)
    if not numpy.linalg.norm(values[1:]) > 0:
        raise place.wrong("*DLOAD GRAV has no direction")
    if len(cells) < reader.deck.n_cells or reader.deck.gravity:
        reader.deck.note(place, "*DLOAD GRAV: gravity of squeal is one, and acts on all parts; not taken")
        return
    reader.deck.gravity = values[0] * values[1:] / numpy.linalg.norm(values[1:]), place


def do_dsload(reader, scope, card):
    forget(reader, card)
    for place, fields in card.rows():
        if len(fields) != 3 or fields[1].upper() != "P":
            reader.deck.note(place, f"*DSLOAD {', '.join(fields[1:2])}: not understood")
            continue
        name = surface_pair(reader, scope, place, [fields[0], fields[0]])[0]
        load = Load(name, place, faces=reader.deck.surfaces[name][0], pressure=real(fields[2], place))
        act(reader, (card.keyword, name), load)


def do_motion(reader, scope, card):
    """Nodes that turn: a set, rad per time, two points of the axis, by the right-hand rule from the first to the second."""
    if "ROTATION" not in card.options or card.options.get("TYPE", "VELOCITY").upper() != "VELOCITY":
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
        reader.deck.note(card.place, "*STEP: the scene has the supports and loads of all steps, of the same set and direction "
                                     "the last one; see which you want")
    if card.options.get("NLGEOM", "NO").upper() in ("", "YES"):
        reader.deck.differ(card.place, "*STEP, NLGEOM: motion of squeal is small; -static_geometric and -static_follower give "
                                       "modes the stiffness of the preload")


def do_static(reader, _, card):
    reader.preload = card.place


def do_frequency(reader, _, card):
    rows = numbers(card)
    row = (rows[0][1] if rows else []) + [0, 0, 0]
    reader.deck.modes, reader.deck.preload = (row[0], row[1], row[2], card.place), reader.preload


def do_complex(reader, _, card):
    if card.options.get("FRICTION DAMPING", "NO").upper() == "YES":
        reader.damping = card.place
    elif reader.deck.modes:
        reader.deck.note(card.place, f"*COMPLEX FREQUENCY: modes of squeal are complex, {NOT_NEEDED}")
    if not reader.deck.modes:
        do_frequency(reader, _, card)


def finish_steps(reader):
    """Whether modes are about the sliding state, as after a *STATIC that presses; where they are not, that is listed."""
    deck = reader.deck
    pressed = deck.loads or deck.gravity or any(any(support.values.values()) for support in deck.supports)
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


def finish(reader):
    """Loads that act, contact of all pairs, springs."""
    reader.deck.loads += [load for _, loads in reader.loads.values() for load in loads]
    for contact, interaction, tied in reader.pairs:
        values = reader.interactions.get(interaction)
        if values is None:
            raise contact.place.wrong(f"there is no *SURFACE INTERACTION {interaction}")
        if tied or values.get("tied"):
            reader.deck.ties.append(Tie(contact.name, contact.slave, contact.master, contact.place,
                                        f"*CONTACT PAIR {contact.slave}, {contact.master}, tied"))
            continue
        contact.mu, contact.stiffness = values.get("mu"), values.get("stiffness")
        reader.deck.contacts.append(contact)
    ground_springs(reader, SPRINGS)
    finish_steps(reader)
    for section in reader.deck.sections:
        if section.material not in reader.deck.materials:
            raise section.place.wrong(f"there is no *MATERIAL {section.material}")


def listed(do):
    """Lists the options of a card that change what it says and are not known."""
    def done(reader, scope, card):
        do(reader, scope, card)
        for name in sorted(set(card.options) - KNOWN[card.keyword] - {"TYPE"}):
            idle = name in IDLE.get(card.keyword, ())
            reader.deck.note(card.place, f"*{card.keyword}: option {name}{f', {NOT_NEEDED}' if idle else ' is not understood'}")
    return done


CARDS = {keyword: listed(do) for keyword, do in (MATERIAL_CARDS | {
    "BOUNDARY": do_boundary, "SPRING": do_spring, "TIE": do_tie,
    "SURFACE INTERACTION": do_interaction, "FRICTION": do_friction, "SURFACE BEHAVIOR": do_behavior,
    "CHANGE FRICTION": do_change_friction, "CONTACT PAIR": do_pair, "CLOAD": do_cload, "DLOAD": do_dload,
    "DSLOAD": do_dsload, "MOTION": do_motion, "STEP": do_step, "STATIC": do_static, "FREQUENCY": do_frequency,
    "COMPLEX FREQUENCY": do_complex}).items()}
