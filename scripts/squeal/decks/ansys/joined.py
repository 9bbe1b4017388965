"""Ansys: what joins nodes: masses, springs, rigid beams, equations, coupled freedoms, pilot nodes of contact by MPC."""

import numpy

from ..deck import Equation, Join, Link, Lump
from ..text import real, whole

KNOWN = {"CE", "CP", "R", "RMORE", "RLBLOCK", "RMODIF", "CERIG", "RBE3"}
TYPES = {21: 1, 14: 2, 184: 2}  # MASS21, COMBIN14, MPC184: nodes
LABELS = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"]
MPC, SPREAD, RIGID = 2, 1, 2  # KEYOPT(2) of contact by constraints; KEYOPT(4): the pilot node is a mean, or carries a rigid set


def read_joined(deck, commands, mesh):
    constants = real_constants(commands)
    for kind, head, nodes, place in mesh.joints:
        if kind not in TYPES:
            continue
        at = mesh.nodes.need(nodes[:TYPES[kind]], "node", place)
        reals, options = constants.get(int(head[2]), []), mesh.options.get(int(head[1]), {})
        {21: mass, 14: spring, 184: beam}[kind](deck, (at, place, f"{NAMES[kind]} element {head[10]}"), reals, options)
    read_equations(deck, commands, mesh)
    read_regions(deck, commands, mesh)


NAMES = {21: "MASS21", 14: "COMBIN14", 184: "MPC184"}


def real_constants(commands):
    """Number of a set -> its values."""
    found, last, lines = {}, None, 0  # lines hold six values each
    for command in commands:
        if command.words[0] == "R":
            lines, last = 1, [command.real(k) for k in range(2, len(command.words))]
            found[command.whole(1)] = last
        elif command.words[0] == "RMORE" and last is not None:
            last += [0.0] * (6 * lines - len(last)) + [command.real(k) for k in range(1, len(command.words))]
            lines += 1
        elif command.words[0] == "RLBLOCK":
            block_of(command, found)
    return found


def block_of(command, found):
    """RLBLOCK: lines with a number, a count and values, the rest on more lines."""
    left, values = 0, []
    for line in command.lines:
        words = line.replace("D", "E").split()
        if line.startswith("(") or not words:
            continue
        if left <= 0:
            values = found[whole(words[0], command.place)] = []
            left, words = whole(words[1], command.place) if len(words) > 1 else 0, words[2:]
        values += [real(word, command.place) for word in words]
        left -= len(words)


def mass(deck, said, reals, options):
    """MASS21, KEYOPT(3) = 0: masses along x, y, z, inertia; 2: one mass."""
    (node,), place, words = said
    values = (list(reals) + [0.0] * 6)[:6]
    if options.get(3, 0) == 2:
        values = [values[0]] * 3 + [0.0] * 3
    if options.get(3, 0) not in (0, 2) or options.get(1, 0) or len(set(values[:3])) > 1:
        deck.note(place, f"{words}: in a plane, by volume, or with several masses: not in the scene")
        return
    deck.lumps.append(Lump(int(node), place, words, values[0], (*values[3:], 0.0, 0.0, 0.0)))


def spring(deck, said, reals, options):
    """COMBIN14: K, CV; KEYOPT(2) is a motion of both nodes, else KEYOPT(3) = 0 along the line between them, 1 a torsion."""
    nodes, place, words = said
    values, motion = (list(reals) + [0.0] * 2)[:2], options.get(2, 0)
    line = deck.x[nodes[1]] - deck.x[nodes[0]]
    if not 0 <= motion <= 6 or options.get(1, 0) or any(reals[2:4]) or not motion and (
            options.get(3, 0) not in (0, 1) or not numpy.linalg.norm(line) > 0):
        deck.note(place, f"{words}: in a plane, not linear, or without a length: not in the scene")
        return
    along = numpy.arange(6) == (motion - 1 if motion else 3 * options.get(3, 0))
    axes = None if motion else (tuple(line / numpy.linalg.norm(line)),)
    deck.links.append(Link(tuple(nodes.tolist()), place, words, tuple(values[0] * along), tuple(values[1] * along), axes, "combin14"))


def beam(deck, said, _, options):
    """MPC184 that is a rigid beam."""
    nodes, place, words = said
    if options.get(1, 0) != 1:
        deck.note(place, f"{words}: KEYOPT(1) = {options.get(1, 0)}, no rigid beam: not in the scene")
        return
    deck.joins.append(Join("mpc184", int(nodes[0]), nodes[1:], True, place, words))


def motion_of(deck, mesh, label, node, command):
    """Terms (node, d, share) of a label at a node, in its own axes where it has some; None for other freedoms."""
    if label.upper() not in LABELS:
        deck.note(command.place, f"{command.words[0]} {label[:10]}: a freedom that is not understood: not in the scene")
        return None
    d, axes = LABELS.index(label.upper()), mesh.turned.get(node)
    if axes is None:
        return [(node, d, 1.0)]
    return [(node, d - d % 3 + e, float(axes[d % 3, e])) for e in range(3)]


def read_equations(deck, commands, mesh):
    """CE of CDWRITE: DEFI with the number of terms and the constant, NODE with terms; or a number, a constant, terms. CP: nodes with the
    same motion."""
    terms, left, place = [], 0, None
    for command in commands:
        if command.words[0] == "CP":
            couple(deck, mesh, command)
        if command.words[0] != "CE":
            continue
        words, kind = (command.plain() + [""] * 6)[:max(len(command.plain()), 6)], (command.plain() + [""])[1].upper()
        if kind != "NODE":
            terms, place = [], command.place
            left = whole(words[2] or "0", place) if kind == "DEFI" else (len(command.plain()) - 3) // 3
            constant = words[4] if kind == "DEFI" else words[2]
            if constant and real(constant, place):
                deck.note(place, f"CE with the constant {constant[:20]}, which is not taken: 0")
            if kind == "DEFI":
                continue
            if left < 1:
                deck.note(place, "CE: neither DEFI nor terms: not in the scene")
                continue
            words = [words[0], "", *words[3:]]
        found = terms_of(deck, mesh, words[2:], command)
        left -= found[0]
        terms = None if terms is None or found[1] is None else terms + found[1]
        if left <= 0 and terms:
            deck.equations.append(Equation(terms, place, "CE"))
            terms = []


def terms_of(deck, mesh, words, command):
    """How many terms of node, label, coefficient there are, and what they are, None where one is not read."""
    count, terms = 0, []
    for k in range(0, len(words) - 2, 3):
        if not words[k]:
            continue
        node = int(mesh.nodes.need(numpy.array([whole(words[k], command.place)]), "node", command.place)[0])
        parts = motion_of(deck, mesh, words[k + 1], node, command)
        count += 1
        value = real(words[k + 2] or "0", command.place)
        terms = None if parts is None or terms is None else terms + [(other, d, value * share) for other, d, share in parts]
    return count, terms


def couple(deck, mesh, command):
    """CP, number, label, nodes."""
    words = command.plain()
    if len(words) < 5 or not words[1].isdigit() or words[2].isdigit():
        deck.note(command.place, "CP: only a number, a label and nodes are read: not in the scene")
        return
    nodes = mesh.nodes.need(numpy.array([int(word) for word in words[3:] if word.isdigit()]), "node", command.place).tolist()
    first = motion_of(deck, mesh, words[2], nodes[0], command)
    for node in nodes[1:] if first else ():
        other = [(at, d, -share) for at, d, share in motion_of(deck, mesh, words[2], node, command)]
        deck.equations.append(Equation([*other, *first], command.place, "CP"))


def read_regions(deck, commands, mesh):
    """CERIG, master, slave or ALL or a component; RBE3."""
    for command in commands:
        if command.words[0] == "RBE3":
            spread(deck, mesh, command)
        if command.words[0] != "CERIG":
            continue
        slave = command.word(2).upper()
        if not command.word(1).isdigit() or command.word(3).upper() not in ("", "ALL", "UXYZ"):
            deck.note(command.place, "CERIG: only of a number, and of all freedoms: not in the scene")
            continue
        node = int(mesh.nodes.need(numpy.array([command.whole(1)]), "node", command.place)[0])
        if mesh.components.get(slave, ("",))[0] == "NODE":
            nodes = mesh.components[slave][1]
        elif slave.isdigit():
            nodes = mesh.nodes.need(numpy.array([int(slave)]), "node", command.place)
        elif slave == "ALL" and isinstance(mesh.selected, numpy.ndarray):
            nodes = mesh.selected
        else:
            deck.note(command.place, f"CERIG {slave[:20]}: of nodes that are not known: not in the scene")
            continue
        deck.joins.append(Join("cerig", node, nodes[nodes != node], True, command.place, "CERIG"))


def spread(deck, mesh, command):
    """RBE3, master, freedoms, an array of nodes or ALL, an array of weights: the master is their mean."""
    place, arrays = command.place, command.lines
    if command.word(2) not in ("ALL", "UXYZ") or not command.word(1).isdigit():
        deck.note(place, f"RBE3 {command.word(1)[:20]}, {command.word(2)[:10]}: only of a number, and of all freedoms: not in the scene")
        return
    node = int(mesh.nodes.need(numpy.array([command.whole(1)]), "node", place)[0])
    if command.word(3) == "ALL" and isinstance(mesh.selected, numpy.ndarray):
        nodes, weights = mesh.selected, arrays[0] if arrays else []
    else:
        nodes, weights = [whole(word, place) for word in (arrays + [[]])[0]], (arrays + [[], []])[1]
        if not nodes or min(nodes) < 1:
            deck.note(place, f"RBE3 {command.word(3)[:20]}: an array that is not there, or has rows that are not read: not in the scene")
            return
        nodes = mesh.nodes.need(numpy.array(nodes), "node", place)
    shares = numpy.array([real(word, place) for word in weights[:len(nodes)]] or [1.0] * len(nodes))
    if len(shares) < len(nodes) or min(shares) <= 0:
        deck.note(place, f"RBE3 {command.word(4)[:20]}: {len(nodes)} positive weights are needed: not in the scene")
        return
    other = nodes != node
    equal = len(set(shares[other])) == 1
    deck.joins.append(Join("rbe3", node, nodes[other], False, place, "RBE3", shares=None if equal else shares[other]))


def pilot(deck, mesh, number):
    """Whether a pair is a surface, or single nodes, with a pilot node by constraints (KEYOPT(2) = 2); it is joined, or listed."""
    targets = mesh.facets.get((number, "target"), [])
    if not targets or any((nodes[:, 1] > 0).any() for nodes, _, _ in targets):
        return False
    (nodes, _, place), *_ = targets
    contacts = mesh.facets.get((number, "contact"), [])
    options = mesh.options.get(int(contacts[0][1][0, 1]), {}) if contacts else {}
    kind = options.get(4, 0)
    if not contacts or options.get(2, 0) != MPC or kind not in (SPREAD, RIGID):
        deck.note(place, f"real constants {number}: a pilot node, and no contact by MPC that is rigid or spread (KEYOPT(2), KEYOPT(4)): "
                         "not in the scene")
        return True
    members = numpy.unique(numpy.concatenate([found[found > 0] for found, _, _ in contacts]))
    node = int(mesh.nodes.need(nodes[0, :1], "node", place)[0])
    at = mesh.nodes.need(members, "node", contacts[0][2])
    words = f"pilot node of real constants {number}"
    deck.joins.append(Join(f"pilot_{number}", node, at[at != node], kind == RIGID, contacts[0][2], words))
    return True

