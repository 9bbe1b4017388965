"""Ansys: materials, parts, supports, forces, pressures, contact."""

import numpy

from .blocks import DATABASE
from .friction import give_friction
from .joined import pilot, real_constants
from .mesh import FACES
from ..axes import aligned
from ..deck import Axes, Contact, Equation, Load, Material, Section, Support, Tie, Turning, give_loss
from ..mesh.faces import boundary_faces, faces_by_three
from ..text import REAL

DAMPING = {"ALPHAD": "alpha", "BETAD": "beta", "DMPSTR": "loss"}  # of all materials
KNOWN = {"MP", "MPDATA", "D", "F", "SF", "SFE", "ACEL", "MODOPT", "CMROTATE", *DAMPING}
FREEDOMS = "UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"
LABELS = {"EX", "EY", "EZ", "PRXY", "PRYZ", "PRXZ", "NUXY", "NUYZ", "NUXZ", "GXY", "GYZ", "GXZ", "DENS", "ALPD", "BETD", "DMPS",
          "MU"}


def read_model(deck, commands, mesh, friction):
    """`friction` has the tables of TB,FRIC by their material."""
    values = read_constants(deck, commands)
    for number, constants in values.items():
        make_material(deck, number, constants)
    add_damping(deck, commands)
    read_parts(deck, mesh)
    pending = {"D": support, "F": force, "SFE": pressure_on_face, "SF": pressure_on_nodes, "ACEL": gravity, "MODOPT": modes,
               "CMROTATE": turning, "CMSEL": select, "NSEL": select, "ALLSEL": select}
    for command in commands:
        if command.words[0] in pending:
            pending[command.words[0]](deck, mesh, command)
    hold_turned(deck, mesh)
    read_contact(deck, mesh, values, friction, real_constants(commands))


def read_constants(deck, commands):
    """Number of a material -> {label: (value, place)} of MP and MPDATA, at the first temperature."""
    found = {}
    for command in commands:
        if command.words[0] not in ("MP", "MPDATA"):
            continue
        words = command.words
        if words[0] == "MPDATA":
            if DATABASE.match(command.word(1)):
                command.words = [words[0], *words[3:]]
            if command.whole(3, 1) != 1 or len({word for word in command.words[4:] if word}) > 1:
                deck.note(command.place, "MPDATA: more than one temperature; the first value is taken")
            if command.whole(3, 1) != 1:
                continue
            command.words = [*command.words[:3], *command.words[4:]]
        label, number = command.word(1).upper(), command.whole(2)
        if label not in LABELS or number < 1:
            deck.note(command.place, f"{words[0]} {label[:20]}: not understood")
            continue
        if not command.word(3):
            raise command.place.wrong(f"{words[0]} {label} has no value")
        found.setdefault(number, {})[label] = command.real(3), command.place
        if any(command.words[4:]) and words[0] == "MP":
            deck.note(command.place, f"MP {label}: depends on the temperature; the constant is taken")
    return found


def add_damping(deck, commands):
    """The last ALPHAD, BETAD and DMPSTR add to those of the materials; springs, contacts and points have none of it."""
    last = {command.words[0]: command for command in commands if command.words[0] in DAMPING and command.word(1)}
    for keyword, command in last.items():
        value, key = command.real(1), DAMPING[keyword]
        for material in deck.materials.values() if value else ():
            if key == "loss":
                give_loss(material, value, command.place)
            else:
                setattr(material, key, getattr(material, key) + value)
                material.places.setdefault("DAMPING", command.place)
        if value:
            deck.differ(command.place, f"{keyword} {command.word(1)}: of all parts; springs, points and contacts have none")


def make_material(deck, number, constants):
    """Isotropic by EX, else by EX, EY, EZ; Poisson's ratios PR.. are those of squeal, NU.. the others: nu_21 = NUXY."""
    value = {label: number for label, (number, _) in constants.items()}
    place = next(iter(constants.values()))[1]
    material = deck.materials[str(number)] = Material(str(number), place)
    material.places = {"ELASTIC": constants["EX"][1]} if "EX" in constants else {}
    if "DENS" in constants:
        material.places["DENSITY"] = constants["DENS"][1]
    if "ALPD" in constants or "BETD" in constants:
        material.places["DAMPING"] = (constants.get("ALPD") or constants["BETD"])[1]
    material.density, material.alpha, material.beta = value.get("DENS") or None, value.get("ALPD", 0.0), value.get("BETD", 0.0)
    if "DMPS" in constants:
        give_loss(material, *constants["DMPS"])
    if (material.density or 1) < 0:
        raise constants["DENS"][1].wrong("the density must not be negative")
    if "EX" not in value:
        return
    if min(value[label] for label in value if label[0] in "EG") <= 0:
        raise place.wrong(f"material {number}: moduli must be positive")
    if not {"EY", "EZ"} & set(value):
        material.young, material.poisson = (value["EX"],), (value.get("PRXY", value.get("NUXY", 0.3)),)
        if not {"PRXY", "NUXY"} & set(value):
            deck.note(constants["EX"][1], f"material {number} has no Poisson's ratio: Ansys takes 0.3, and so is it here")
        return
    missing = [label for label in ("EY", "EZ", "GXY", "GYZ", "GXZ") if label not in value]
    if missing:
        raise constants["EX"][1].wrong(f"material {number} is orthotropic and has no {missing[0]}")
    material.young = value["EX"], value["EY"], value["EZ"]
    material.shear = value["GXY"], value["GXZ"], value["GYZ"]
    ratios = []
    for pair in ("XY", "XZ", "YZ"):
        if f"PR{pair}" in value:
            ratios.append(value[f"PR{pair}"])
        elif f"NU{pair}" in value:
            ratios.append(value[f"NU{pair}"] * value[f"E{pair[0]}"] / value[f"E{pair[1]}"])
        else:
            raise constants["EX"][1].wrong(f"material {number} is orthotropic and has neither PR{pair} nor NU{pair}")
    material.poisson = tuple(ratios)


def read_parts(deck, mesh):
    """Elements of one material and system, by the name of a component that is the same."""
    material, system = numpy.concatenate(mesh.materials or [[]]), numpy.concatenate(mesh.systems_of or [[]])
    names = {members.tobytes(): name for name, (kind, members) in mesh.components.items() if kind == "ELEM"}
    for number, axes in sorted({pair for pair in zip(material.tolist(), system.tolist())}):
        cells = numpy.flatnonzero((material == number) & (system == axes))
        place = mesh.cells.line_of(int(cells[0]))
        if str(number) not in deck.materials:
            deck.note(place, f"there is no material {number} (MP, MPDATA): the part has none, give it")
        if axes not in mesh.systems:
            raise place.wrong(f"there is no coordinate system {axes} (LOCAL)")
        title = names.get(cells.tobytes()) or f"part_{number}" + (f"_{axes}" if axes else "")
        cylinder, rows, origin = mesh.systems[axes]
        turned = Axes(True, rows[2], origin, place) if cylinder else Axes(False, rows[0], rows[1], place)
        deck.sections.append(Section(title, cells, str(number) if str(number) in deck.materials else "", turned if axes else None, place))


def select(_, mesh, command):
    """Which nodes ALL means from here on: all, those of a component, or what is not followed."""
    kind, name = command.word(1).upper(), command.word(2).upper()
    if command.words[0] == "ALLSEL" or command.words[0] == "NSEL" and kind == "ALL":
        mesh.selected = "ALL"
    elif command.words[0] == "CMSEL" and mesh.components.get(name, ("",))[0] == "ELEM":
        return
    elif command.words[0] == "CMSEL" and kind in ("S", "") and name in mesh.components:
        mesh.selected = mesh.components[name][1]
    else:
        mesh.selected = ""


def nodes_of(deck, mesh, command):
    """Nodes by a number, by a range, by a component, or those that are selected; and the name of the component. None, and a note,
    where there are none."""
    word, name = command.word(1).upper(), command.words[0]
    if mesh.components.get(word, ("",))[0] == "NODE":
        return mesh.components[word][1], word
    if word == "ALL":
        if isinstance(mesh.selected, str) and not mesh.selected:
            deck.note(command.place, f"{name},ALL: of nodes that NSEL or CMSEL chose, which is not followed: not taken")
            return None, ""
        return (mesh.nodes.sorted("node")[1], "") if isinstance(mesh.selected, str) else (mesh.selected, "")
    if not word.isdigit():
        deck.note(command.place, f"{name} {word[:20]}: no node and no component of nodes: not taken")
        return None, ""
    first, last, step = command.whole(1), command.whole(5) if name in "DF" else 0, command.whole(6) if name in "DF" else 0
    numbers = numpy.arange(first, max(last, first) + 1, max(step, 1))
    at, missing = mesh.nodes.find(numbers, "node")
    if missing.all():
        deck.note(command.place, f"{name}: node {first} is not in the file: not taken")
        return None, ""
    return at[~missing], ""


def value_of(deck, command, number):
    """A value, None and a note where it is a table or of two parts."""
    word = command.word(number)
    if not REAL.match(word or "0"):
        deck.note(command.place, f"{command.words[0]} {command.word(2)[:10]}: '{word[:20]}' is no number: not taken")
        return None
    if command.word(number + 1) and REAL.match(command.word(number + 1)) and command.real(number + 1):
        deck.note(command.place, f"{command.words[0]} with an imaginary part: not taken")
        return None
    return command.real(number)


def support(deck, mesh, command):
    """D, node, UX, value, -, last node, step, more labels."""
    labels = [word.upper() for word in (command.word(2), *command.words[7:12]) if word]
    for label in labels:
        if label not in (*FREEDOMS, "ALL"):
            deck.note(command.place, f"D {label[:10]}: not understood")
    held = sorted({d for d, label in enumerate(FREEDOMS) if {label, "ALL"} & set(labels)})
    nodes, name = nodes_of(deck, mesh, command) if held else (None, "")
    value = value_of(deck, command, 3) if nodes is not None else None
    if value is None:
        return
    own = [node for node in nodes.tolist() if node in mesh.turned] if mesh.turned else []
    for node in own:
        mesh.own_held.setdefault(node, {}).update({d: (value, command.place) for d in held})
    rest = numpy.setdiff1d(nodes, own) if own else nodes
    if len(rest):
        deck.supports.append(Support(rest, {d: value for d in held}, "" if own else name, command.place))


def hold_turned(deck, mesh):
    """Supports of nodes with axes of their own."""
    for node, values in mesh.own_held.items():
        for first in (0, 3):
            part = {d - first: value for d, value in values.items() if first <= d < first + 3}
            if part:
                hold_own(deck, node, mesh.turned[node], part, first)


def hold_own(deck, node, axes, values, first):
    """Holds translations or rotations of a node in its own axes: along those of space, or by equations."""
    found, place = aligned(axes, sorted(values)), next(iter(values.values()))[1]
    moved = any(value for value, _ in values.values())
    if found is not None and not (moved and any(sign == 0 for _, sign in found.values())):
        deck.supports.append(Support(numpy.array([node]), {first + d: sign * values[own][0] + 0.0 if moved else 0.0
                                                           for d, (own, sign) in found.items()}, "", place))
    elif moved:
        deck.note(place, "D: in the turned axes of a node, not taken")
    else:
        deck.equations += [Equation([(node, first + e, float(axes[d, e])) for e in range(3) if abs(axes[d, e]) > 1e-12], place,
                                    "D in the turned axes of a node") for d in values]


def force(deck, mesh, command):
    """F, node, FX, value, -, last node, step."""
    label = command.word(2).upper()
    if label not in ("FX", "FY", "FZ", "MX", "MY", "MZ"):
        deck.note(command.place, f"F {label[:10]}: not understood")
        return
    nodes, name = nodes_of(deck, mesh, command)
    value = value_of(deck, command, 3) if nodes is not None else None
    if not value:
        return
    vector = numpy.zeros(3)
    vector["XYZ".index(label[1])] = value
    own = [node for node in nodes.tolist() if node in mesh.turned] if mesh.turned else []
    for node in own:
        deck.loads.append(load_of(label, "", command.place, numpy.array([node]), vector @ mesh.turned[node]))
    rest = numpy.setdiff1d(nodes, own) if own else nodes
    if len(rest):
        deck.loads.append(load_of(label, "" if own else name, command.place, rest, vector))


def load_of(label, name, place, nodes, vector):
    """A force, or a moment."""
    turns = label[0] == "M"
    return Load(name, place, nodes=nodes, force=0 * vector if turns else vector, moment=vector if turns else None)


def pressure_on_face(deck, mesh, command):
    """SFE, element, face, PRES, , values at its corners."""
    if command.word(3).upper() != "PRES" or command.whole(4) > 1:
        deck.note(command.place, f"SFE {command.word(3)[:10]}: not understood")
        return
    if not command.word(1).isdigit() or mesh.cells.find([command.whole(1)], "element")[1][0]:
        deck.note(command.place, f"SFE {command.word(1)[:20]}: no number of a solid: not taken")
        return
    if not all(REAL.match(word) for word in command.words[5:] if word):
        deck.note(command.place, "SFE: a pressure by a table: not taken")
        return
    values = [command.real(k) for k in range(5, len(command.words)) if command.word(k)]
    cell = int(mesh.cells.find([command.whole(1)], "element")[0][0])
    at = numpy.searchsorted(deck.firsts(), cell, side="right") - 1
    if deck.blocks[at].plain is not None:
        deck.note(command.place, "SFE on a shell: not taken; press its nodes by F, or its surface in the scene")
        return
    face = FACES[deck.blocks[at].shape.family].get(command.whole(2))
    if face is None or not values:
        raise command.place.wrong(f"SFE: face {command.word(2)} of element {command.word(1)} has no pressure, or there is no such face")
    if any(values[1:]) and any(value != values[0] for value in values):
        deck.note(command.place, "SFE: a pressure that varies: not taken")
        return
    deck.loads.append(Load("", command.place, faces=numpy.array([[cell, face]]), pressure=values[0]))


def pressure_on_nodes(deck, mesh, command):
    """SF, nodes, PRES, value: on faces all of whose nodes are among these."""
    if command.word(2).upper() != "PRES":
        deck.note(command.place, f"SF {command.word(2)[:10]}: not understood")
        return
    nodes, name = nodes_of(deck, mesh, command)
    value = value_of(deck, command, 3) if nodes is not None else None
    if value is None:
        return
    faces = boundary_faces(deck, nodes)
    if not len(faces):
        deck.note(command.place, "SF: no face of an element has all of its nodes there: not taken")
        return
    deck.loads.append(Load(f"{name}_face" if name else "", command.place, faces=faces, pressure=value))


def gravity(deck, _, command):
    """ACEL: the acceleration of the supports, against which gravity acts."""
    if not all(REAL.match(word or "0") for word in command.words[1:4]):
        deck.note(command.place, "ACEL: by a table: not taken")
        return
    vector = numpy.array([command.real(k) for k in (1, 2, 3)])
    if vector.any():
        deck.gravity = -vector, command.place


def turning(deck, mesh, command):
    """CMROTATE, component of elements, velocity about the line through two points, or its components about a point."""
    kind, members = mesh.components.get(command.word(1).upper(), ("", None))
    if kind != "ELEM":
        raise command.place.wrong(f"CMROTATE: there is no component '{command.word(1)[:40]}' of elements")
    if not all(REAL.match(word or "0") for word in command.words[2:11]):
        deck.note(command.place, "CMROTATE: by a table: not taken")
        return
    values = numpy.array([command.real(k) for k in range(2, 11)])
    omega, centre, axis = values[:3], values[3:6], values[6:] - values[3:6]
    if any(command.words[8:11]) and numpy.linalg.norm(axis) > 0:
        omega = values[0] * axis / numpy.linalg.norm(axis)
    firsts = deck.firsts()
    nodes = [block.nodes[members[(members >= low) & (members < high)] - low].ravel()
             for block, low, high in zip(deck.blocks, firsts, firsts[1:])]
    deck.turnings.append(Turning(numpy.unique(numpy.concatenate(nodes)), omega, centre, command.place))


def modes(deck, _, command):
    """MODOPT, method, number, lowest, highest."""
    deck.modes = command.whole(2), command.real(3), command.real(4), command.place


BONDED = 3, 5, 6  # values of KEYOPT(12)


def read_contact(deck, mesh, values, friction, real):
    """Pairs of contact and target elements with one set of real constants; friction by MU of the material."""
    for number in sorted({number for number, _ in mesh.facets}):
        if pilot(deck, mesh, number):
            continue
        sides = {}
        for kind in ("contact", "target"):
            for nodes, head, place in mesh.facets.get((number, kind), []):
                corners = mesh.nodes.need(numpy.where(nodes[:, :3] > 0, nodes[:, :3], nodes[:, :1]), "node", place)
                faces, missing = faces_by_three(deck, corners)
                if missing.any():
                    deck.note(place, f"{missing.sum()} {kind} elements of real constants {number} are on no face of a solid")
                found = sides.setdefault(kind, ([], head, place))
                found[0].append(faces[~missing])
        if len(sides) < 2:
            place = next(iter(sides.values()))[2]
            deck.note(place, f"real constants {number}: {next(iter(sides))} elements without their counterpart; not taken")
            continue
        for kind, (faces, _, place) in sides.items():
            deck.surfaces[f"{kind}_{number}"] = numpy.concatenate(faces), place
        _, head, place = sides["contact"]
        kind = mesh.behaviour.get(int(head[0, 1]), 0)
        if kind in BONDED:
            deck.ties.append(Tie(f"bond_{number}", f"contact_{number}", f"target_{number}", place,
                                 f"real constants {number}, KEYOPT(12) = {kind}, bonded"))
            continue
        if kind:
            deck.note(place, f"real constants {number}: KEYOPT(12) = {kind}, rough or without separation; not taken: NOT TIED")
            continue
        material = int(head[0, 0])
        deck.contacts.append(Contact(f"pair_{number}", f"contact_{number}", f"target_{number}", place))
        give_friction(deck, deck.contacts[-1], number, material, friction, values.get(material, {}), real.get(number, []))
