"""Abaqus: what joins nodes: couplings, rigid bodies, constraints, equations, masses, and axes of nodes."""

import numpy

from .beams import KINDS as BEAMS
from .material import axis_of, first_row, numbers
from .sets import NONE, reader_nodes, surface_of
from .words import choice, label
from ..deck import Equation, Join, Lump
from ..mesh.faces import surface_nodes
from ..text import real, whole

NAMED = {"MASS": "MASS", "ROTARYI": "ROTARY INERTIA", "DCOUP3D": "DISTRIBUTING COUPLING", "CONN3D2": "CONNECTOR SECTION",
         **dict.fromkeys(BEAMS, "BEAM SECTION")}
WEIGHTS = {"UNIFORM": lambda r: numpy.ones(len(r)), "LINEAR": lambda r: 1 - r, "QUADRATIC": lambda r: 1 - r**2,
           "CUBIC": lambda r: 1 - 3 * r**2 + 2 * r**3}


def one_node(reader, scope, word, place, what):
    """A node by its number or a set of one; None and a note where it is not there."""
    nodes = reader_nodes(reader, scope, word, place)
    if len(nodes) > 1:
        raise place.wrong(f"{what} {word[:40]}: {len(nodes)} nodes, expected one")
    return int(nodes[0]) if len(nodes) else None


def nodes_of_surface(reader, name):
    """Nodes of a surface: of faces, or of nodes alone."""
    return reader.surface_nodes[name] if name in reader.surface_nodes else surface_nodes(reader.deck, reader.deck.surfaces[name][0])


def do_coupling(reader, scope, card):
    """Waits for *KINEMATIC or *DISTRIBUTING."""
    leave_coupling(reader)
    if not card.options.get("REF NODE"):
        raise card.place.wrong("*COUPLING needs REF NODE=")
    node = one_node(reader, scope, card.options["REF NODE"], card.place, "*COUPLING, REF NODE")
    name = surface_of(reader, scope, card.need("SURFACE"), card.place)
    nodes = nodes_of_surface(reader, name)
    radius = real(card.options["INFLUENCE RADIUS"], card.place) if "INFLUENCE RADIUS" in card.options else None
    if radius is not None and node is not None:
        nodes = nodes[numpy.linalg.norm(reader.deck.x[nodes] - reader.deck.x[node], axis=1) <= radius]
    title = label(card.options.get("CONSTRAINT NAME", "")) or name
    reader.coupling = node, nodes, radius, title, card


def leave_coupling(reader):
    if reader.coupling:
        card = reader.coupling[-1]
        reader.deck.note(card.place, "*COUPLING without *KINEMATIC or *DISTRIBUTING: not in the scene")
    reader.coupling = None


def directions_of(card):
    """Directions 0, 1, 2 of lines with a first and a last degree of freedom; all where there is no line."""
    rows = list(card.rows())
    found = set() if rows else {0, 1, 2}
    for place, fields in rows:
        values = [whole(word, place, "a degree of freedom") for word in fields if word]
        if not 1 <= len(values) <= 2 or not 1 <= values[0] <= values[-1] <= 6:
            raise place.wrong(f"*{card.keyword}: expected a first and a last degree of freedom, 1 to 6")
        found |= set(range(values[0] - 1, min(values[-1], 3)))
    return tuple(sorted(found))


def do_kinematic(reader, scope, card):
    if not reader.coupling:
        raise card.place.wrong("*KINEMATIC without *COUPLING before it")
    (node, nodes, _, name, coupling), reader.coupling = reader.coupling, None
    directions = directions_of(card)
    add_kinematic(reader, scope, (node, nodes, directions), (name, coupling))


def add_kinematic(reader, scope, what, said):
    """A rigid join, in some directions of space perhaps."""
    (node, nodes, directions), (name, card) = what, said
    orientation = card.options.get("ORIENTATION")
    if node is None:
        return
    if not directions or orientation and len(directions) < 3:
        reader.deck.note(card.place, f"*{card.keyword} {name}: " + ("of rotations alone, which solids do not have" if not directions else
                                                                    "some directions of axes of its own") + ": not in the scene")
        return
    reader.deck.joins.append(Join(name, node, nodes[nodes != node], True, card.place, f"*{card.keyword} {name}", directions))


def do_distributing(reader, _, card):
    if not reader.coupling:
        raise card.place.wrong("*DISTRIBUTING without *COUPLING before it")
    (node, nodes, radius, name, coupling), reader.coupling = reader.coupling, None
    directions_of(card)
    if node is None:
        return
    nodes = nodes[nodes != node]
    how = choice(card.options.get("WEIGHTING METHOD", "UNIFORM"), *WEIGHTS)
    if how not in WEIGHTS:
        raise card.place.wrong(f"*DISTRIBUTING, WEIGHTING METHOD={how[:40]}: it is one of {', '.join(WEIGHTS)}")
    shares = None
    if how != "UNIFORM" and len(nodes):
        r = numpy.linalg.norm(reader.deck.x[nodes] - reader.deck.x[node], axis=1)
        shares = WEIGHTS[how](r / max(radius or 0, r.max(), 1e-300))
    reader.deck.differ(card.place, "*DISTRIBUTING: every node counts alike, as in CalculiX; Abaqus weighs nodes of elements by their area")
    reader.deck.joins.append(Join(name, node, nodes, False, coupling.place, f"*COUPLING {name}", shares=shares))


def do_kinematic_coupling(reader, scope, card):
    """The older form: lines with a set and degrees of freedom."""
    node = one_node(reader, scope, card.options.get("REF NODE", ""), card.place, "*KINEMATIC COUPLING, REF NODE")
    for place, fields in card.rows():
        nodes = reader_nodes(reader, scope, fields[0], place)
        values = [whole(word, place, "a degree of freedom") for word in fields[1:] if word]
        directions = tuple(range(max(values[0], 1) - 1, min(values[-1], 3))) if values else (0, 1, 2)
        add_kinematic(reader, scope, (node, nodes, directions), ("", card))


def do_rigid_body(reader, scope, card):
    if not card.options.get("REF NODE"):
        raise card.place.wrong("*RIGID BODY needs REF NODE=")
    node = one_node(reader, scope, card.options["REF NODE"], card.place, "*RIGID BODY, REF NODE")
    parts, name = [NONE], ""
    for option in ("NSET", "TIE NSET", "PIN NSET", "ELSET"):
        if option not in card.options:
            continue
        name = name or label(card.options[option])
        if option == "ELSET":
            parts.append(nodes_of_elements(reader, scope, label(card.options[option]), card.place))
        else:
            parts.append(reader_nodes(reader, scope, card.options[option], card.place))
    nodes = numpy.unique(numpy.concatenate(parts))
    if node is None:
        return
    reader.deck.joins.append(Join(name, node, nodes[nodes != node], True, card.place, f"*RIGID BODY {name}"))
    if "ROT NODE" in card.options:
        turn = one_node(reader, scope, card.options["ROT NODE"], card.place, "*RIGID BODY, ROT NODE")
        if turn is not None:
            reader.rotations[turn] = node


def nodes_of_elements(reader, scope, name, place):
    """Nodes of a set of elements, of volumes and others."""
    inner, local = reader.split(name, scope)
    found = [nodes for number in inner.other_sets.get(local, []) if number in inner.holders for nodes in [inner.holders[number][1]]]
    if local in inner.cell_sets:
        cells, firsts = inner.cell_sets[local], reader.deck.firsts()
        found += [block.own_nodes()[cells[(cells >= low) & (cells < high)] - low].ravel()
                  for block, low, high in zip(reader.deck.blocks, firsts, firsts[1:])]
    if not found:
        reader.deck.note(place, f"the elements of {name} are none of squeal's: not taken")
    return numpy.unique(numpy.concatenate([NONE, *found]))


def do_mass(reader, scope, card):
    """A mass at each node of its elements; or a rotary inertia, xx, yy, zz, xy, xz, yz."""
    row, rest = first_row(card, 1)
    for place, _ in rest:
        reader.deck.note(place, f"*{card.keyword}: only the first line is taken")
    kind, name = "MASS" if card.keyword == "MASS" else "ROTARYI", card.need("ELSET")
    chosen = [number for number in scope.other_sets.get(name, []) if scope.holders.get(number, ("",))[0] == kind]
    found = [scope.holders[number] for number in chosen]
    scope.given.update(chosen)
    if not found:
        raise card.place.wrong(f"*{card.keyword}: there is no set {name} of {kind} elements")
    if row[0] < 0:
        raise card.place.wrong(f"*{card.keyword}: {row[0]:g} must not be negative")
    turn = scope.turn
    for _, nodes, _ in found:
        if kind == "MASS":
            reader.deck.lumps.append(Lump(int(nodes[0]), card.place, f"*MASS {name}", mass=row[0]))
            continue
        xx, yy, zz, xy, xz, yz = (row + [0.0] * 6)[:6]
        tensor = turn @ numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        values = tuple(tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist())
        reader.deck.lumps.append(Lump(int(nodes[0]), card.place, f"*ROTARY INERTIA {name}", inertia=values))


def do_equation(reader, scope, card):
    """A number of terms, then node or set, degree of freedom, coefficient of each, over several lines."""
    if card.options.pop("REMOVE", None) is not None:
        reader.deck.note(card.place, "*EQUATION, REMOVE: equations stay")
        return
    words = [(place, word) for place, fields in card.rows() for word in fields if word]
    at = 0
    while at < len(words):
        place, count = words[at][0], whole(words[at][1], words[at][0], "a number of terms")
        rows = [[word for _, word in words[k:k + 3]] for k in range(at + 1, at + 1 + 3 * count, 3)]
        if count < 1 or len(words) < at + 1 + 3 * count:
            raise place.wrong(f"*EQUATION: {count} terms are announced, and there are fewer")
        at += 1 + 3 * count
        terms = [(reader_nodes(reader, scope, word, place), whole(dof, place, "a degree of freedom"), real(value, place))
                 for word, dof, value in rows]
        if any(not 1 <= dof <= 6 for _, dof, _ in terms):
            reader.deck.note(place, "*EQUATION: degrees of freedom beyond 1 to 6: not in the scene")
            continue
        n = len(terms[0][0])
        if any(len(nodes) not in (1, n) for nodes, _, _ in terms):
            raise place.wrong("*EQUATION: its sets have different numbers of nodes")
        for k in range(n):
            pieces = [(int(nodes[k if len(nodes) > 1 else 0]), dof, value) for nodes, dof, value in terms]
            reader.deck.equations.append(Equation(
                [term for node, dof, value in pieces for term in in_space(reader, node, dof - 1, value)], place, "*EQUATION"))


def in_space(reader, node, d, value):
    """A motion of a node, in its own axes where it has some, by those along x, y, z."""
    axes = reader.axes_at(node)
    if axes is None:
        return [(node, d, value)]
    first = 3 if d > 2 else 0
    return [(node, first + e, value * float(axes[d - first, e])) for e in range(3) if axes[d - first, e]]


def do_mpc(reader, scope, card):
    """BEAM: a rigid beam between nodes; TIE, PIN: the same displacements; LINEAR: a node between two. Others are listed."""
    beams = {}
    for place, fields in card.rows():
        kind = fields[0].upper()
        if kind not in ("BEAM", "TIE", "PIN", "LINEAR"):
            reader.deck.note(place, f"*MPC, {kind[:20]}: not understood")
            continue
        sides = [reader_nodes(reader, scope, word, place) for word in fields[1:] if word]
        if len(sides) != (3 if kind == "LINEAR" else 2) or any(len(side) not in (1, len(sides[0])) for side in sides):
            raise place.wrong(f"*MPC, {kind}: {len(sides)} nodes or sets, expected {3 if kind == 'LINEAR' else 2} of one size")
        for k in range(len(sides[0])):
            nodes = [int(side[k if len(side) > 1 else 0]) for side in sides]
            if kind == "BEAM":
                beams.setdefault(nodes[1], ([], place))[0].append(nodes[0])
            else:
                add_tied(reader, kind, nodes, place)
    for node, (nodes, place) in beams.items():
        reader.deck.joins.append(Join("", node, numpy.unique(nodes), True, place, "*MPC, BEAM"))


def add_tied(reader, kind, nodes, place):
    """Equations of a node that moves as another one, or as two on a line do where it is."""
    shares = [1.0]
    if kind == "LINEAR":
        a, b, c = reader.deck.x[nodes]
        along = float((a - b) @ (c - b) / max((c - b) @ (c - b), 1e-300))
        shares = [1 - along, along]
    for d in range(3):
        terms = [(nodes[0], d, 1.0), *((node, d, -share) for node, share in zip(nodes[1:], shares))]
        reader.deck.equations.append(Equation(terms, place, f"*MPC, {kind}"))
    if kind == "TIE" and not reader.is_solid(nodes[0]) and not reader.is_solid(nodes[1]):
        reader.deck.equations += [Equation([(nodes[0], d, 1.0), (nodes[1], d, -1.0)], place, "*MPC, TIE") for d in range(3, 6)]


def do_transform(reader, scope, card):
    """Axes at nodes: by two points, rectangular; or radial, along the angle and along a cylinder's axis."""
    name = card.need("NSET")
    nodes = reader_nodes(reader, scope, name, card.place)
    rows = numbers(card)
    if not rows or len(rows[0][1]) < 6:
        raise card.place.wrong("*TRANSFORM needs two points, six numbers")
    a, b = numpy.array(rows[0][1][:3]), numpy.array(rows[0][1][3:6])
    kind = choice(card.options.get("TYPE", "R"), "R", "C", "S")
    if kind == "S":
        reader.deck.note(card.place, f"*TRANSFORM, TYPE=S: axes of a sphere at the nodes of {name}: what holds or loads them is not taken")
        for node in nodes.tolist():
            reader.turned[node] = None
        return
    if kind == "R":
        first = axis_of(a, card)
        third = axis_of(numpy.cross(first, b), card)
        axes = numpy.array([first, numpy.cross(third, first), third]) @ scope.turn.T
        for node in nodes.tolist():
            reader.turned[node] = axes
        return
    origin, along = scope.turn @ a + scope.shift, axis_of(scope.turn @ (b - a), card)
    for node in nodes.tolist():
        out = reader.deck.x[node] - origin
        out = out - along * (along @ out)
        if numpy.linalg.norm(out) > 0:
            out /= numpy.linalg.norm(out)
            reader.turned[node] = numpy.array([out, numpy.cross(along, out), along])
        else:
            reader.turned[node] = None


CARDS = {"COUPLING": do_coupling, "KINEMATIC": do_kinematic, "DISTRIBUTING": do_distributing, "RIGID BODY": do_rigid_body,
         "KINEMATIC COUPLING": do_kinematic_coupling, "MASS": do_mass, "ROTARY INERTIA": do_mass, "EQUATION": do_equation, "MPC": do_mpc,
         "TRANSFORM": do_transform}
