"""What holds, presses and rubs, as entries of the scene: lines of a deck that say the same of nodes become one set."""

import numpy

from .mesh.faces import surface_nodes
from .gaps import gaps

TOUCH = 1e-6  # of the slave's size: nodes that are nearer touch
ROOM = 1.05  # of a tolerance over the largest gap
DIRECTIONS = "xyz"


def summary(places):
    """Places as a comment: the first, and how many more."""
    shown = str(places[0])
    return shown if len(places) == 1 else f"{shown} and {len(places) - 1} more"


def grouped(rows, n):
    """Nodes with equal rows: dictionary node -> values [n] as (values, nodes) in the order of first appearance."""
    nodes = numpy.array(list(rows), int)
    values = numpy.array([rows[node] for node in rows], float).reshape(-1, n)
    unique, first, inverse = numpy.unique(values, axis=0, return_index=True, return_inverse=True)
    for group in numpy.argsort(first, kind="stable"):
        yield unique[group], nodes[inverse.ravel() == group]


def add_supports(assembly, supports):
    """Directions that are held; those that are moved become motions."""
    named, single, places = {}, {}, {}
    for support in supports:
        if support.name:
            values, where, _ = named.setdefault(support.name, ({}, [], support.nodes))
            values.update(support.values)
            where.append(support.place)
            continue
        for node in support.nodes.tolist():
            row = single.setdefault(node, [numpy.nan] * 3)
            for direction, value in support.values.items():
                row[direction] = value
            places.setdefault(node, support.place)
    for name, (values, where, nodes) in named.items():
        support_entries(assembly, (name, name), nodes, values, where)
    for row, nodes in grouped(numpy_free(single), 3):
        values = {d: float(v) for d, v in enumerate(row) if v < 1e300}
        support_entries(assembly, ("", "support"), nodes, values, [places[int(node)] for node in nodes])


def numpy_free(rows):
    """nan is not equal to itself: a huge number stands for it."""
    return {node: [1e301 if value != value else value for value in row] for node, row in rows.items()}


def support_entries(assembly, names, nodes, values, where):
    """Entries of a set: what is held at its place, and what is moved."""
    written = assembly.node_set(nodes, *names)
    fixed = "".join(DIRECTIONS[d] for d in sorted(values) if values[d] == 0)
    moved = [d for d in sorted(values) if values[d] != 0]
    comment = summary(where)
    if fixed:
        assembly.add("supports", written, [("set", written, comment), ("fix", fixed, comment)])
    if moved:
        vector = tuple(values.get(d, 0) if d in moved else 0.0 for d in range(3))
        assembly.add("motions", f"{written}_motion", [
            ("set", written, comment), ("displacement", ("length", vector), comment),
            ("directions", "".join(DIRECTIONS[d] for d in moved), comment)])


def add_springs(assembly):
    """Springs to the ground, summed at each node."""
    rows, places = {}, {}
    for spring in assembly.deck.springs:
        inside = assembly.into[spring.nodes]
        if (inside < 0).any():
            assembly.deck.note(spring.place, "spring at a node that no volume element has: not in the scene")
        for node in inside[inside >= 0].tolist():
            rows[node] = rows.get(node, numpy.zeros(3)) + spring.stiffness
            places.setdefault(node, spring.place)
    back = {int(new): old for old, new in enumerate(assembly.into.tolist())} if rows else {}
    for stiffness, nodes in grouped(rows, 3):
        comment = summary([places[int(node)] for node in nodes])
        if not stiffness.any():
            assembly.deck.note(places[int(nodes[0])], "springs without stiffness: not in the scene")
            continue
        written = assembly.node_set(numpy.array([back[int(node)] for node in nodes]), "", "spring")
        assembly.add("springs", written, [("set", written, comment),
                                          ("stiffness", ("stiffness", tuple(stiffness)), f"{comment} per node")])


def add_loads(assembly, loads):
    """Forces on nodes and pressures on faces, summed: over a set or surface that has a name, else at each node and face; gravity
    is of the scene as a whole."""
    named, single, places = {}, {}, {}
    for load in loads:
        if load.faces is not None:
            continue
        if load.name:
            force, where, _ = named.setdefault(load.name, (numpy.zeros(3), [], load.nodes))
            force += load.force
            where.append(load.place)
        else:
            for node in load.nodes.tolist():
                single[node] = single.get(node, numpy.zeros(3)) + load.force
                places.setdefault(node, load.place)
    for name, (force, where, nodes) in named.items():
        force_entry(assembly, (name, name), nodes, force, where)
    for force, nodes in grouped(single, 3):
        force_entry(assembly, ("", "force"), nodes, force, [places[int(node)] for node in nodes])
    add_pressures(assembly, [load for load in loads if load.faces is not None])


def add_pressures(assembly, loads):
    """Pressures on surfaces that have a name, and on other faces by their sum."""
    named, single = {}, []
    for load in loads:
        if load.name:
            before = named.setdefault(load.name, [0.0, [], load.faces])
            before[0] += load.pressure
            before[1].append(load.place)
        else:
            single.append(load)
    for name, (pressure, where, faces) in named.items():
        pressure_entry(assembly, (name, name), faces, pressure, where)
    if not single:
        return
    faces, at = numpy.unique(numpy.concatenate([load.faces for load in single]), axis=0, return_inverse=True)
    total, first = numpy.zeros(len(faces)), numpy.full(len(faces), len(single))
    of_load = numpy.repeat(numpy.arange(len(single)), [len(load.faces) for load in single])
    numpy.add.at(total, at.ravel(), numpy.array([load.pressure for load in single])[of_load])
    numpy.minimum.at(first, at.ravel(), of_load)
    for pressure in dict.fromkeys(total[numpy.argsort(first, kind="stable")].tolist()):
        chosen = total == pressure
        where = [single[number].place for number in numpy.unique(first[chosen]).tolist()]
        pressure_entry(assembly, ("", "pressed"), faces[chosen], pressure, where)


def pressure_entry(assembly, names, faces, pressure, where):
    """A pressure on a surface."""
    if not len(faces) or not pressure:
        return
    written, comment = assembly.face_set(faces, *names), summary(where)
    assembly.add("loads", f"{written}_pressure", [("set", written, comment),
                                                  ("pressure", ("stress", (pressure,)), f"{comment} into the body")])


def force_entry(assembly, names, nodes, force, where):
    """A force at every node, as the total of a set of points, over which squeal spreads it evenly."""
    written = assembly.node_set(nodes, *names)
    if not written:
        for place in where:
            assembly.deck.note(place, "force on nodes that no volume element has (reference nodes?): not in the scene")
        return
    n, comment = len(assembly.result.points[written]), summary(where)
    if n != len(nodes):
        assembly.deck.note(where[0], f"force on {len(nodes)} nodes, of which elements have {n}")
    assembly.add("loads", f"{written}_force", [
        ("set", written, comment), ("force", ("force", tuple(n * force)), f"{comment} total of {n} nodes")])


def set_turning(deck):
    """Angular velocity of the master of each contact, by the nodes that turn: all of the master's, or all of the slave's."""
    used = set()
    for contact in deck.contacts:
        sides = [surface_nodes(deck, deck.surfaces[name][0]) for name in (contact.master, contact.slave)]
        for number, turning in enumerate(deck.turnings):
            inside = [len(nodes) > 0 and numpy.isin(nodes, turning.nodes).all() for nodes in sides]
            if inside[0] != inside[1] and turning.omega.any():
                contact.rotation = tuple(turning.omega if inside[0] else -turning.omega)
                contact.centre, contact.turning = tuple(turning.centre), turning.place
                used.add(number)
    for number, turning in enumerate(deck.turnings):
        if number not in used:
            deck.note(turning.place, "nodes that turn, and no contact has one of its two surfaces among them: not in the scene")


def gap_rows(deck, contact):
    """The tolerance that finds the pairs of surfaces that are apart in the deck, or overlap; that is said, since only a state knows it."""
    found = gaps(deck, deck.surfaces[contact.slave][0], deck.surfaces[contact.master][0])
    size = numpy.ptp(deck.x[surface_nodes(deck, deck.surfaces[contact.slave][0])], axis=0).max()
    most = abs(found).max(initial=0)
    if not most > TOUCH * size:
        return []
    deck.differ(contact.place, f"contact {contact.slave}, {contact.master}: apart by {found.min():.3g} to {found.max():.3g} (units of the "
                               "deck); statics and runs in time have this gap, modes take all pairs as closed but about a static state")
    tolerance = float(f"{ROOM * most:.3g}")
    return [("tolerance", ("length", (tolerance,)), f"{contact.place} finds pairs that are {most:.3g} apart there")]


def fit_rows(assembly, contact):
    """The interference beyond that of the mesh, and whether surfaces that overlap in all are fitted in a stage of their own."""
    value, place = contact.fit
    if value > 0:
        return [("interference", ("length", (value,)), str(place))], True
    deck = assembly.deck
    if gaps(deck, deck.surfaces[contact.slave][0], deck.surfaces[contact.master][0]).min(initial=0) < 0:
        return [], True
    deck.note(place, f"*CONTACT INTERFERENCE {contact.slave}, {contact.master}: these surfaces do not overlap: nothing to fit")
    return [], False


LAW = "mu", "stiffness", "points", "exponential", "decay", "table"  # of a contact


def leave_mirrors(deck, pairs, noun):
    """Contacts or ties but those of two surfaces that an earlier one has the other way round, as symmetric contact is written."""
    seen, kept = {}, []
    for pair in pairs:
        sides = tuple(frozenset(map(tuple, deck.surfaces[name][0].tolist())) for name in (pair.slave, pair.master))
        first = seen.get(sides[::-1])
        if not first:
            seen.setdefault(sides, pair)
            kept.append(pair)
            continue
        same = all(getattr(pair, name, None) == getattr(first, name, None) for name in LAW)
        deck.differ(pair.place, f"{noun} {pair.slave}, {pair.master}: the surfaces of the {noun} at {first.place} the other way round, "
                                f"which stands for both{'' if same else '; its own friction or stiffness is NOT taken'}")
    return kept


def add_contacts(assembly):
    """Pairs of surfaces; what a deck does not say is a hint."""
    assembly.deck.contacts = leave_mirrors(assembly.deck, assembly.deck.contacts, "contact")
    set_turning(assembly.deck)
    surfaces = assembly.deck.surfaces
    for contact in assembly.deck.contacts:
        empty = [name for name in (contact.slave, contact.master) if not len(surfaces[name][0])]
        if empty:
            assembly.deck.note(contact.place, f"contact {contact.slave}, {contact.master}: {empty[0]} has no faces; not in the scene")
            continue
        slave, master = (assembly.face_set(surfaces[name][0], name, "") for name in (contact.slave, contact.master))
        comment = str(contact.place)
        rows = [("surfaces", f"{slave},{master}", f"{comment} slave,master")]
        if contact.stiffness:
            rows.append(("kn_per_area", ("stiffness_per_area", (contact.stiffness,)), comment))
        elif contact.points:
            rows += [("pressure_law", "table", comment), ("pressure_table", ("points", contact.points), comment)]
        elif contact.exponential:
            rows += [("pressure_law", "exponential", comment), ("pressure_c0", ("length", contact.exponential[:1]), comment),
                     ("pressure_p0", ("stress", contact.exponential[1:]), comment)]
        else:
            rows.append(("law", "constraint", f"{comment} no stiffness is given: exact contact"))
        rows += gap_rows(assembly.deck, contact)
        more, fitted = fit_rows(assembly, contact) if contact.fit else ([], False)
        rows += more
        hints = []
        if contact.decay:
            rows += [("friction_law", "static_kinetic", comment), ("mu_static", ("", contact.decay[:1]), comment),
                     ("mu_kinetic", ("", contact.decay[1:2]), comment), ("mu_decay_speed", ("speed", contact.decay[2:]), comment)]
        elif contact.table:
            rows.append(("friction_law", "table", comment))
        elif contact.mu is not None:
            rows.append(("mu", ("", (contact.mu,)), comment))
        if (contact.decay or contact.table) and not contact.rotation:
            hints.append("speed: ?   friction depends on the sliding speed, m/s, which is not in the file: give it")
        if contact.rotation:
            rows += [("rotation", ("rate", contact.rotation), f"{contact.turning} of the master"),
                     ("centre", ("length", contact.centre), str(contact.turning))]
        if contact.damping and contact.mu:
            rows.append(("friction_damping", "true", str(contact.damping)))
        if contact.mu and not contact.rotation:
            hints.append('slip: "0,1,0"   the slave\'s sliding direction is not in the file: give it, or rotation: "x,y,z" in rad/s, '
                         'or where it holds by friction kt: its stiffness along the surface')
        assembly.add("contacts", contact.name, rows, hints)
        if fitted:
            assembly.result.fits.append((assembly.result.entries[-1].name, contact.fit[1]))
        if contact.gap:
            assembly.result.tables.append((assembly.result.entries[-1], "gap", (slave, contact.gap[0]), contact.gap[1]))
        if contact.table:
            assembly.result.tables.append((assembly.result.entries[-1], "mu_file", contact.table, contact.place))


def add_ties(assembly):
    """Surfaces of meshes that do not match, glued."""
    deck, surfaces = assembly.deck, assembly.deck.surfaces
    deck.ties = leave_mirrors(deck, deck.ties, "tie")
    for tie in deck.ties:
        empty = [name for name in (tie.slave, tie.master) if not len(surfaces[name][0])]
        if empty:
            deck.note(tie.place, f"{tie.words}: {empty[0]} has no faces; NOT TIED: the bodies stay apart")
            continue
        slave, master = (assembly.face_set(surfaces[name][0], name, "") for name in (tie.slave, tie.master))
        rows = [("surfaces", f"{slave},{master}", f"{tie.place} slave,master")]
        if tie.distance:
            rows.append(("distance", ("length", (tie.distance,)), str(tie.place)))
        rows.append(("far", "free", f"{tie.place} nodes that are farther off stay free, as there"))
        assembly.add("ties", tie.name, rows)
        deck.differ(tie.place, f"{tie.words}: nodes of {tie.slave} follow {tie.master} where they are; gaps stay as rigid arms, no node "
                               "is moved on to the surface")
