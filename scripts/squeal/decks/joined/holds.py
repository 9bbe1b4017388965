"""Reference nodes that are held, equations between nodes, supports in turned axes: as supports of the scene where these do, else as
linear equations between displacements of nodes of elements."""

from dataclasses import dataclass, field

import numpy

from ..deck import NOT_NEEDED, Load, Support
from .groups import mean, motions, straight
from .linear import Equations, chosen_rows, kernel

WORDS = "along x", "along y", "along z", "about x", "about y", "about z"


@dataclass
class Joined:
    """What becomes of the joins of a deck: groups, supports and loads on nodes of elements, equations {unknown: {unknown: share}}."""
    groups: object
    supports: list = field(default_factory=list)
    loads: list = field(default_factory=list)
    follows: dict = field(default_factory=dict)
    fixed: dict = field(default_factory=dict)  # node of no element -> {direction: (value, place)}
    used: set = field(default_factory=set)  # nodes of no element that something joins

    def at(self, node):
        """The group that a node of no element moves with, or None."""
        return self.groups.of_node.get(int(node))

    def carrier(self, node):
        """The same, or the rigid group that has a node of elements among its nodes: it tells rotations."""
        if not self.groups.solid[node]:
            return self.at(node)
        at = self.groups.into[node]
        return next((group for group in self.groups.groups if group.rigid and len(group.directions) == 3 and at in group.nodes), None)


class Holds:
    """Solves what is linear."""

    def __init__(self, deck, groups):
        self.deck, self.groups = deck, groups
        self.solid, self.into = groups.solid, groups.into
        self.joined = Joined(groups)
        self.held = set()  # (node, direction) that supports hold
        self.equations = Equations(lambda unknown: unknown in self.held, lambda unknown: not self.solid[unknown[0]])

    def run(self):
        self.split_supports()
        rows = [(self.row_of(equation.terms), equation) for equation in self.deck.equations]
        touched = {int(node) for equation in self.deck.equations for node, _, _ in equation.terms}
        for group in self.groups.groups:
            self.hold(group, group.knot or bool(touched & (group.attached | {group.node})))
        for row, equation in rows:
            if row is None:
                self.deck.note(equation.place, f"{equation.words}: of a rotation that solids do not have: not in the scene")
            elif any(self.moved(unknown) for unknown in row):
                self.deck.note(equation.place, f"{equation.words}: of a node that is moved: not in the scene")
            else:
                self.equations.add(row)
        self.spread_loads()
        self.joined.follows = {unknown: row for unknown, row in self.equations.follows.items() if self.solid[unknown[0]]}
        lost = [row for row in self.joined.follows.values() if any(not self.solid[node] for node, _ in row)]
        if lost:
            raise self.deck.equations[0].place.wrong(f"{len(lost)} equations hang on nodes of no element that nothing tells")
        return self.joined

    def moved(self, unknown):
        """Whether a support moves an unknown."""
        return self.moves.get((self.into[unknown[0]] if self.solid[unknown[0]] else unknown[0], unknown[1]), 0.0) != 0

    def split_supports(self):
        """Supports of nodes of elements, and what holds others."""
        self.moves = {}
        used = self.joined.used = {int(node) for link in self.deck.links for node in link.nodes} | {
            int(node) for equation in self.deck.equations for node, _, _ in equation.terms} | set(self.groups.of_node) | {
                node for beam in self.deck.beams for node in beam.nodes}
        for support in self.deck.supports:
            inside = self.solid[support.nodes]
            if not inside.all() and not used.intersection(support.nodes[~inside].tolist()) and min(support.values) < 3:
                self.note_lost(support, inside)
            values = {d: value for d, value in support.values.items() if d < 3}
            if inside.any() and values:
                name = support.name if inside.all() else ""
                self.joined.supports.append(Support(support.nodes[inside], values, name, support.place))
            for node in self.into[support.nodes[inside]].tolist():
                for d, value in values.items():
                    self.moves[node, d] = value
                    self.held.add((node, d))
            for node in support.nodes[~inside].tolist():
                row = self.joined.fixed.setdefault(int(node), {})
                for d, value in support.values.items():
                    row[d] = value, support.place
                    self.moves[int(node), d] = value
                    if int(node) not in self.groups.of_node:
                        self.held.add((int(node), d))

    def note_lost(self, support, inside):
        """Supports of nodes that nothing has."""
        where = "of nodes" if not inside.any() else f"of {len(inside)} nodes, {(~inside).sum()} of them"
        kind = "a reference node?" if len(inside) == 1 else "reference nodes?"
        self.deck.note(support.place, f"support {where} that no volume element has ({kind}): not in the scene")

    def unknowns(self, node, d):
        """Motion d of a node by displacements {unknown: share}; None for a rotation of a solid."""
        if self.solid[node]:
            return {(int(self.into[node]), d): 1.0} if d < 3 else None
        group = self.groups.of_node.get(int(node))
        if group is None:
            return {(int(node), d): 1.0}
        x, about = self.deck.x[group.nodes], self.deck.x[node]
        if group.rigid:
            rows, _ = chosen_rows(motions(x, about))
            shares = numpy.linalg.pinv(motions(x, about)[rows])[d]
        else:
            rows, shares = range(3 * len(x)), mean(x, about, group.shares)[d]
        return {(int(group.nodes[row // 3]), row % 3): float(share) for row, share in zip(rows, shares) if share}

    def row_of(self, terms):
        """An equation between nodes by unknowns, None where a rotation of a solid is in it."""
        row = {}
        for node, d, coefficient in terms:
            parts = self.unknowns(node, d)
            if parts is None:
                return None
            for unknown, share in parts.items():
                row[unknown] = row.get(unknown, 0.0) + coefficient * share
        return row

    def conditions(self, group):
        """What supports hold of a group's motion about its node: rows [m][6], and their values."""
        rows, values = [], []
        for node in sorted(group.attached):
            for d, (value, _) in self.joined.fixed.get(node, {}).items():
                rows.append(motions(self.deck.x[node][None], group.x)[d] if d < 3 else numpy.eye(6)[d])
                values.append(value)
        return numpy.array(rows).reshape(-1, 6), numpy.array(values)

    def hold(self, group, touched):
        """A group as a point, as supports of its nodes, or as equations."""
        rows, values = self.conditions(group)
        if self.solid[group.node] and not group.rigid:
            self.follow_mean(group)
        elif values.any():
            self.move(group, rows, values)
        elif not group.rigid:
            self.hold_mean(group, rows)
        else:
            self.hold_rigid(group, rows, touched)

    def place_of(self, group):
        """Where a support of a group stands."""
        return next((place for node in sorted(group.attached) for _, place in self.joined.fixed.get(node, {}).values()), group.place)

    def hold_rigid(self, group, rows, touched):
        """Of the six motions those that are free are left."""
        keys = [(int(node), d) for node in group.nodes for d in group.directions]
        phi = motions(self.deck.x[group.nodes], group.x).reshape(-1, 3, 6)[:, list(group.directions)].reshape(-1, 6)
        free = phi @ kernel(rows)
        if abs(free).max(initial=0) <= 1e-12 * abs(phi).max():
            group.how = "held"
            self.joined.supports.append(Support(group.nodes, {d: 0.0 for d in group.directions}, group.name, self.place_of(group)))
            self.held.update(keys)
            return
        held = [key in self.held for key in keys]
        if not (touched or len(rows) or any(held) or len(group.directions) < 3 or straight(self.deck.x[group.nodes])):
            return
        group.how = "equations"
        if any(held):
            free = free @ kernel(free[held])
        left, T = chosen_rows(free)
        for number, key in enumerate(keys):
            if number not in left and not held[number]:
                self.equations.add({key: 1.0, **{keys[k]: -float(t) for k, t in zip(left, T[number]) if abs(t) > 1e-13}})

    def hold_mean(self, group, rows):
        """Each motion of the mean that is held is an equation."""
        if not len(rows):
            return
        group.how = "equations"
        keys = [(int(node), d) for node in group.nodes for d in range(3)]
        for row in rows @ mean(self.deck.x[group.nodes], group.x, group.shares):
            self.equations.add({key: float(value) for key, value in zip(keys, row) if value})

    def follow_mean(self, group):
        """A node of an element that moves as others in the mean."""
        group.how = "equations"
        keys = [(int(node), d) for node in group.nodes for d in range(3)]
        for d, row in enumerate(mean(self.deck.x[group.nodes], group.x, group.shares)[:3]):
            self.equations.add({(int(self.into[group.node]), d): 1.0,
                                **{key: -float(value) for key, value in zip(keys, row) if value}})

    def move(self, group, rows, values):
        """A rigid group whose motion is told: that of its nodes."""
        place = self.place_of(group)
        if not group.rigid or numpy.linalg.matrix_rank(rows) < 6:
            self.deck.note(place, f"{group.words}: its reference node is moved in some directions only, or moves nodes in the mean: not in "
                                  "the scene")
            return
        motion = numpy.linalg.lstsq(rows, values, rcond=None)[0]
        if abs(motion[3:]).max() > 1e-12 * abs(motion[:3]).max(initial=0):
            self.deck.note(place, f"{group.words}: its reference node is turned: not in the scene")
            return
        group.how = "held"
        moved = {d: float(motion[d]) for d in range(3)}
        self.joined.supports.append(Support(group.nodes, moved, group.name, place))

    def spread_loads(self):
        """Loads on nodes that an equation tells act on those that tell it; others stay."""
        for load in self.deck.loads:
            own = [] if load.faces is not None else [
                node for node in load.nodes.tolist() if not self.solid[node] and node not in self.groups.of_node]
            told = {node: [(d, self.equations.follows[node, d]) for d in range(3) if (node, d) in self.equations.follows and load.force[d]]
                    for node in own}
            if not any(told.values()):
                self.joined.loads.append(load)
                continue
            for node, rows in told.items():
                for d, row in rows:
                    for (other, e), share in row.items():
                        force = numpy.zeros(3)
                        force[e] = share * load.force[d]
                        self.joined.loads.append(Load("", load.place, nodes=numpy.array([other]), force=force))


def note_idle(deck, group, place, what):
    """Something on a group that does not move."""
    deck.note(place, f"{what} on {group.words}, whose reference node is held: {NOT_NEEDED}")
