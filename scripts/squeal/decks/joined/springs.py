"""Springs and dashpots of Abaqus and CalculiX: SPRING1 and DASHPOT1 by one node and the ground; SPRING2, SPRINGA, DASHPOT2, DASHPOTA
by two. Those of a node of an element to the ground along an axis of space are springs of the scene, all others bushings."""

import numpy

from ..deck import Link, Spring

ALONG = 1e-9  # sine of the angle to an axis below which a spring lies along it


def read_springs(reader):
    """Adds those that are understood to the deck, lists the others."""
    deck = reader.deck
    solid = numpy.zeros(deck.n_nodes, bool)
    for block in deck.blocks:
        solid[block.nodes] = True
    used = set()
    for scope, card, dofs, value in reader.spring_cards:
        name = card.need("ELSET")
        if name not in scope.other_sets:
            raise card.place.wrong(f"*{card.keyword}: there is no set {name} of {card.keyword.lower()} elements")
        for number in scope.other_sets[name]:
            kind, nodes, place = scope.holders.get(number, ("", None, None))
            if not kind.startswith(card.keyword):
                deck.note(card.place, f"*{card.keyword}: element {number} is no {card.keyword.lower()}")
                continue
            used.add((id(scope), number))
            add_spring(deck, solid, (kind, nodes, place, f"{kind} element {number}"), dofs, value)
    for scope in [reader.main, *reader.instances.values()]:
        for number, (kind, _, place) in scope.holders.items():
            keyword = "SPRING" if kind.startswith("SPRING") else "DASHPOT"
            if kind.startswith(keyword) and (id(scope), number) not in used:
                deck.note(place, f"{kind} element {number} has no *{keyword}")


def motion_of(deck, kind, nodes, dofs):
    """Motion 0 to 5 that a spring acts along, and axes or None; (None, None) where it is not understood."""
    if kind.endswith("A"):
        line = deck.x[nodes[1]] - deck.x[nodes[0]]
        size = numpy.abs(line)
        if not size.max() > 0:
            return None, None
        if numpy.sort(size)[1] <= ALONG * size.max():
            return int(size.argmax()), None
        return 0, (tuple(line / numpy.linalg.norm(line)),)
    if not dofs or any(dof not in range(1, 7) for dof in dofs) or (len(dofs) > 1 and dofs[0] != dofs[1]):
        return None, None
    return int(dofs[0]) - 1, None


def add_spring(deck, solid, element, dofs, value):
    """The spring of an element, or a line."""
    kind, nodes, place, words = element
    motion, axes = motion_of(deck, kind, nodes, dofs)
    if motion is None:
        deck.note(place, f"{words}: not understood")
        return
    along = value * (numpy.arange(6) == motion)
    ends = (int(nodes[0]), int(nodes[1]) if len(nodes) > 1 else -1)
    ground = [end for end in ends if end >= 0 and not solid[end] and held(deck, end, motion, axes)]
    inside = [end for end in ends if end >= 0 and solid[end]]
    if kind.startswith("SPRING") and axes is None and motion < 3 and len(inside) == 1 and len(inside) + len(ground) + ends.count(-1) == 2:
        deck.springs.append(Spring(numpy.array(inside), along[:3], "", place))
        return
    values = {"stiffness" if kind.startswith("SPRING") else "viscosity": tuple(along)}
    deck.links.append(Link(ends, place, words, axes=axes, name=kind.lower(), **values))


def held(deck, node, motion, axes):
    """Whether a node is held where a spring acts."""
    if any(node in (join.node, *join.nodes.tolist()) for join in deck.joins):
        return False
    found = {d for support in deck.supports if (support.nodes == node).any() for d, v in support.values.items() if v == 0}
    return found >= ({motion} if axes is None else {0, 1, 2})
