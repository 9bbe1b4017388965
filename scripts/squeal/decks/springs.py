"""Springs of Abaqus that hold nodes to the ground: SPRING1 by one node; SPRING2 and SPRINGA by two, one of which is no
node of a volume element and is held."""

import numpy

from .deck import Spring

ALONG = 1e-9  # sine of the angle to an axis below which a spring lies along it


def ground_springs(reader, kinds):
    """Adds those that are understood to the deck, lists the others."""
    deck = reader.deck
    solid = numpy.zeros(deck.n_nodes, bool)
    for block in deck.blocks:
        solid[block.nodes] = True
    used = set()
    for scope, card, dofs, stiffness in reader.spring_cards:
        name = card.need("ELSET")
        if name not in scope.other_sets:
            raise card.place.wrong(f"*SPRING: there is no set {name} of spring elements")
        for number in scope.other_sets[name]:
            if number not in scope.holders:
                deck.note(card.place, f"*SPRING: element {number} is no spring")
                continue
            used.add((id(scope), number))
            kind, nodes, place = scope.holders[number]
            found = one_spring(deck, solid, (kind, nodes, place), dofs, stiffness)
            if found is None:
                text = "two nodes of the model; `joints` of squeal may do this" if solid[nodes].all() else "not understood"
                deck.note(place, f"{kind} element {number}: {text}")
            elif found:
                deck.springs.append(found)
    for scope in [reader.main, *reader.instances.values()]:
        for number, (kind, _, place) in scope.holders.items():
            if (id(scope), number) not in used:
                deck.note(place, f"{kind} element {number} has no *SPRING")
    return kinds


def one_spring(deck, solid, element, dofs, stiffness):
    """The spring of an element, None where it is not one to the ground."""
    kind, nodes, place = element
    inside = nodes[solid[nodes]]
    if len(inside) != 1:
        return None
    along = numpy.zeros(3)
    if kind == "SPRINGA":
        line = numpy.abs(deck.x[nodes[1]] - deck.x[nodes[0]])
        if not line.max() > 0 or numpy.sort(line)[1] > ALONG * line.max():
            return None
        along[int(line.argmax())] = 1
    else:
        if not dofs or any(dof not in (1, 2, 3) for dof in dofs) or (len(dofs) > 1 and dofs[0] != dofs[1]):
            return None
        along[int(dofs[0]) - 1] = 1
    if kind != "SPRING1":
        other = nodes[~solid[nodes]][0]
        held = {d for support in deck.supports if (support.nodes == other).any() for d, v in support.values.items() if v == 0}
        if not held >= set(numpy.flatnonzero(along).tolist()):
            return None
    return Spring(inside, stiffness * along, "", place)
