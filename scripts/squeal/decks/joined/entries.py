"""Points and bushings of the scene, and loads on points: masses, springs and forces at nodes that move with groups, or at nodes of
elements."""

import numpy

from .beams import add_beams, take_lump
from .holds import note_idle


class Places:
    """Points of the scene by the node that each stands for."""

    def __init__(self, assembly, joined):
        self.assembly, self.joined, self.deck = assembly, joined, assembly.deck
        self.rows, self.names, self.first, self.sets, self.rigid = {}, {}, {}, {}, set()  # the last: groups whose point joins them

    def set_of(self, node, group=None):
        """The set that moves with a node; "" for one that nothing moves with."""
        group = group or self.joined.at(node)
        key = id(group) if group else int(node)
        if key not in self.sets:
            inside = group.nodes if group else numpy.array([node])
            name = self.joined_name(group, inside) if group else ""
            self.sets[key] = self.assembly.node_set(inside, name, (group.name or "joined") if group else "node")
        return self.sets[key]

    def joined_name(self, group, nodes):
        """The name of a set of the deck that has just these nodes."""
        found = self.deck.node_sets.get(group.name)
        return group.name if found is not None and numpy.array_equal(numpy.unique(found[0]), nodes) else ""

    def point(self, node, place, group=None):
        """Rows of the point at a node, which is made where there is none; None where nothing carries it."""
        node, group = int(node), group or self.joined.at(node)
        if node not in self.rows:
            written = self.set_of(node, group)
            if not written:
                return None
            rows = self.rows[node] = [("set", written, str(place))]
            if group and group.how == "point" and group.rigid and id(group) not in self.rigid:
                self.rigid.add(id(group))
                rows.append(("join", "rigid", f"{group.place} {group.words}"))
            elif group and not group.rigid and group.shares is not None and numpy.ptp(group.shares) > 0:
                self.deck.differ(group.place, f"{group.words}: its nodes have unequal weights; the point of the scene, which has "
                                              "a mass, a spring or a load, follows all of them alike")
            rows.append(("at", ("length", tuple(self.deck.x[node])), str(place)))
            name = (group.name if group else "") or f"point_{written}"
            first = self.first.setdefault(name, node) == node  # PETSc takes -name_2_join for -name_join
            self.names[node] = self.assembly.things.new(name if first else f"{name}_n{node}")
        return self.rows[node]


def add_joined(assembly, joined):
    """Rigid groups, masses, loads on reference nodes, springs between nodes; returns the superelement of beams, or None."""
    places = Places(assembly, joined)
    for group in joined.groups.groups:
        if group.rigid and group.how == "point":
            places.point(group.node, group.place, group)
    body = add_beams(places)
    for lump in assembly.deck.lumps:
        if not take_lump(body, lump):
            add_lump(places, lump)
    loads = [load for load in joined.loads if load.faces is not None]
    for load in joined.loads:
        if load.faces is None:
            loads += put_load(places, load)
    joined.loads[:] = loads
    finish_points(assembly, places)
    for link in assembly.deck.links:
        add_link(places, link)
    return body


def finish_points(assembly, places):
    """Entries of points, and the loads on them."""
    for node, rows in places.rows.items():
        assembly.entry("points", places.names[node], [row for row in rows if row[0] != "load"])
    for node, rows in places.rows.items():
        acting = [row[1] for row in rows if row[0] == "load"]
        if not acting:
            continue
        force, moment = sum(load.force for load in acting), sum(
            load.moment for load in acting if load.moment is not None) + numpy.zeros(3)
        comment = f"{acting[0].place}" + (f" and {len(acting) - 1} more" if acting[1:] else "")
        values = [("point", places.names[node], comment)]
        values += [("force", ("force", tuple(force)), comment)] * bool(force.any())
        values += [("moment", ("moment", tuple(moment)), comment)] * bool(moment.any())
        if len(values) > 1:
            assembly.add("loads", f"{places.names[node]}_force", values)


def add_lump(places, lump):
    """A mass with inertia, which may stand off its node."""
    group = places.joined.carrier(lump.node)
    if group and group.how == "held":
        note_idle(places.deck, group, lump.place, lump.words)
        return
    inertia = numpy.array(lump.inertia)
    if not group and (inertia.any() or lump.offset.any()):
        places.deck.note(lump.place, f"{lump.words}: inertia, or a mass off its node, on a node that has no rotation: not in the scene")
        return
    if group and len(group.directions) < 3:
        places.deck.note(lump.place, f"{lump.words}: on {group.words}, which joins some directions only: not in the scene")
        return
    if not lump.mass and not inertia.any():
        places.deck.note(lump.place, f"{lump.words}: without a mass: not in the scene")
        return
    rows = places.point(lump.node, lump.place, group)
    if rows is None:
        places.deck.note(lump.place, f"{lump.words}: at a node that no volume element has, and nothing joins: not in the scene")
        return
    old = {key: value[1] for key, value, _ in rows if key in ("mass", "inertia")}
    mass, before = old.get("mass", (0.0,))[0], numpy.array(old.get("inertia", (0.0,) * 6))
    if lump.offset.any():
        mass, inertia = moved_lump(places, rows, lump, (mass, before))
    else:
        mass, inertia, lump.written = mass + lump.mass, before + inertia, True
    rows[:] = [row for row in rows if row[0] not in ("mass", "inertia")]
    rows += [("mass", ("mass", (mass,)), f"{lump.place} {lump.words}")] * bool(mass)
    rows += [("inertia", ("inertia", tuple(inertia)), f"{lump.place} {lump.words}")] * bool(inertia.any())


def moved_lump(places, rows, lump, before):
    """A mass that stands off its node: the place of the point is there, where it has nothing else; else it is listed."""
    if before[0] or before[1].any() or any(row[0] == "load" for row in rows):
        places.deck.note(lump.place, f"{lump.words}: a second one at its node, which stands off it: not in the scene")
        return before
    moved = ("at", ("length", tuple(places.deck.x[lump.node] + lump.offset)), str(lump.place))
    rows[:] = [moved if row[0] == "at" else row for row in rows]
    lump.written = True
    return lump.mass, numpy.array(lump.inertia)


def put_load(places, load):
    """Puts a load on points; returns what acts on nodes of elements."""
    deck, joined, left = places.deck, places.joined, []
    inside = [node for node in load.nodes.tolist() if joined.groups.solid[node]]
    turned = inside if load.moment is not None and load.moment.any() else []
    for node in turned:
        if joined.carrier(node) and joined.carrier(node).how != "held":
            rows = places.point(node, load.place, joined.carrier(node))
            rows.append(("load", type(load)("", load.place, nodes=load.nodes, force=numpy.zeros(3), moment=load.moment), ""))
        else:
            deck.note(load.place, "a moment on a node of volume elements, which has no rotation: not in the scene")
    if inside and load.force.any():
        whole = len(inside) == len(load.nodes)
        left.append(type(load)(load.name if whole else "", load.place, nodes=numpy.array(inside), force=load.force))
    for node in load.nodes.tolist():
        if joined.groups.solid[node]:
            continue
        group = joined.at(node)
        if group and group.how == "held":
            note_idle(deck, group, load.place, "a load")
        elif group and len(group.directions) < 3:
            deck.note(load.place, f"a load on {group.words}, which joins some directions only: not in the scene")
        elif group is None:
            if any(load.force) or load.moment is not None and load.moment.any():
                left.append(type(load)("", load.place, nodes=numpy.array([node]), force=load.force))
        else:
            rows = places.point(node, load.place)
            at = next(row[1][1] for row in rows if row[0] == "at")
            arm = deck.x[node] - numpy.array(at)
            moment = numpy.cross(arm, load.force) + (0 if load.moment is None else load.moment)
            rows.append(("load", type(load)("", load.place, nodes=load.nodes, force=load.force, moment=moment), ""))
    return left


def add_link(places, link):
    """A bushing between two nodes, or one and the ground."""
    deck, joined = places.deck, places.joined
    values = numpy.concatenate([link.stiffness, link.viscosity]).reshape(4, 3)
    if not values.any():
        deck.note(link.place, f"{link.words}: without stiffness or viscosity: not in the scene")
        return
    ends = []
    for node in link.nodes:
        held = node >= 0 and (joined.at(node) is None and not joined.groups.solid[node]
                              and holds_all(joined.fixed.get(int(node), {}), values, link.axes)
                              or joined.at(node) is not None and joined.at(node).how == "held")
        ends.append(-1 if held else int(node))
    ends.sort(key=lambda node: node < 0)
    if ends[0] < 0:
        deck.note(link.place, f"{link.words}: between nodes that are held: {NOT_MOVING}")
        return
    solid = [node for node in ends if node >= 0 and joined.carrier(node) is None]
    if values[1::2].any() and solid:
        deck.note(link.place, f"{link.words}: stiffness about an axis at a node that has no rotation: not in the scene")
        return
    turns = values[1::2].any()
    sets = [places.set_of(node, joined.carrier(node) if turns else None) if node >= 0 else "" for node in ends]
    if any(node >= 0 and not name for node, name in zip(ends, sets)):
        deck.note(link.place, f"{link.words}: a node that no volume element has, and nothing joins or holds: not in the scene")
        return
    if sets[0] == sets[1]:
        deck.note(link.place, f"{link.words}: both nodes move as one: {NOT_MOVING}")
        return
    write_link(places, link, (ends, sets), values)


NOT_MOVING = "it does nothing; not needed here"


def holds_all(fixed, values, axes):
    """Whether a node is held in all directions that a link acts along."""
    needed = {d for row, first in zip(values, (0, 3, 0, 3)) for d in numpy.flatnonzero(row) + first}
    if axes is not None:
        needed = {d + first for first in (0, 3) if any(first <= d < first + 3 for d in needed) for d in range(3)}
    return all(d in fixed and fixed[d][0] == 0 for d in needed)


def write_link(places, link, sides, values):
    """Rows of a bushing."""
    (ends, sets), comment, deck = sides, f"{link.place} {link.words}", places.deck
    rows = [("a", sets[0], comment)]
    rows += [("b", sets[1], comment)] * bool(sets[1])
    rows.append(("at", ("length", tuple(deck.x[ends[0]])), comment))
    if sets[1] and (deck.x[ends[0]] != deck.x[ends[1]]).any():
        rows.append(("at_b", ("length", tuple(deck.x[ends[1]])), comment))
    for key, axis in zip(("axis_1", "axis_2"), () if link.axes is None else link.axes):
        rows.append((key, ("", tuple(axis)), comment))
    for key, kind, row in zip(("stiffness", "turn_stiffness", "viscosity", "turn_viscosity"),
                              ("stiffness", "turn_stiffness", "viscosity", "turn_viscosity"), values):
        if row.any():
            rows.append((key, (kind, tuple(row)), comment))
    places.assembly.add("joints", link.name or "spring", rows)
    link.written = True


def write_equations(path, result):
    """The table of -model_equations. A node that stands where one of another part does has its part."""
    lines, parts, into = ["equation,x_m,y_m,z_m,direction,coefficient,part"], double_parts(result), result.assembly.into

    def line(number, unknown, value):
        node = int(into[unknown[0]])
        place = ",".join(f"{v:.17g}" for v in result.x[node])
        lines.append(f"{number},{place},{unknown[1] + 1},{value:.17g},{parts.get(node, '')}")

    for number, (unknown, row) in enumerate(result.joined.follows.items(), 1):
        line(number, unknown, -1.0)
        for other, share in row.items():
            line(number, other, share)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def double_parts(result):
    """Node -> name of its part, of nodes that stand where another one does."""
    _, at, count = numpy.unique(result.x, axis=0, return_inverse=True, return_counts=True)
    double = numpy.flatnonzero(count[at.ravel()] > 1)
    if not len(double):
        return {}
    found, inside = {}, numpy.zeros(len(result.x), bool)
    inside[double] = True
    firsts = result.firsts()
    for name in [entry.name for entry in result.entries if entry.kind == "parts"]:
        cells = result.volumes[name]
        for block, low, high in zip(result.blocks, firsts, firsts[1:]):
            nodes = numpy.unique(block.nodes[cells[(cells >= low) & (cells < high)] - low])
            for node in nodes[inside[nodes]].tolist():
                found.setdefault(node, name)
    return found
