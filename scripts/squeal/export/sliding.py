"""A deck that brings CalculiX into the state of full sliding of a scene, whose modes it then finds: complex ones where friction couples
them. Each contact has a slave's body of its own, as pads on both sides of a disc.

A static step makes all points of a contact slip equally: each body moves as a whole, that of the slave into the other by DEEP, well
above rounding, and by SLIDE along the direction of slip. It starts as much before its place, so that the meshes are in theirs
after it. *FREQUENCY about this state asks again whether each point slips, by comparing two sides that are equal: rounding would
decide, half of the points would stick and frequencies be off by 1e-3. Hence the static step has a friction coefficient that is larger
by EXCESS. Across the direction of slip CalculiX leaves the slope of sticking, N/m^3, which is such that friction is reached at half
of the slide. CalculiX has its springs at the
integration points of the faces, squeal at the nodes: eigenvalues are the same where contact is much stiffer than the bodies.
"""

import numpy

from ..decks.mesh.faces import nodes_by_kind, surface_nodes
from ..tables import BadInput
from .inp import frequency_cards, held_cards, model_cards, pair_cards, real

DEEP, SLIDE, TWICE, EXCESS = 2.5e-13, 0.2, 2, 1e-2  # both of the size of the slave's body, -, -
STAYS = "STAYS"


def body_of(deck, start):
    """Nodes that elements connect with those of `start`."""
    inside = numpy.zeros(deck.n_nodes, bool)
    inside[start] = True
    count = 0
    while count < inside.sum():
        count = inside.sum()
        for block in deck.blocks:
            inside[block.nodes[inside[block.nodes].any(axis=1)]] = True
    return inside


def mean_normal(deck, name):
    """Outward unit normal of a surface, from the corners of its faces."""
    total = numpy.zeros(3)
    for _, nodes in nodes_by_kind(deck, deck.surfaces[name][0]):
        corners = 3 if nodes.shape[1] in (3, 6) else 4
        a, b, c = (deck.x[nodes[:, k]] for k in (0, 1, corners - 1))
        total += numpy.cross(b - a, c - a).sum(axis=0)
    length = numpy.linalg.norm(total)
    return outward(deck, name, total / length) if length else total


def outward(deck, name, normal):
    """The normal, or its opposite where it points at the elements of the surface."""
    faces = deck.surfaces[name][0]
    firsts, cells = deck.firsts(), []
    for first, last, block in zip(firsts, firsts[1:], deck.blocks):
        mine = faces[(faces[:, 0] >= first) & (faces[:, 0] < last), 0] - first
        cells.append(deck.x[block.nodes[mine]].mean(axis=1))
    away = deck.x[surface_nodes(deck, faces)].mean(axis=0) - numpy.concatenate(cells).mean(axis=0)
    return normal if away @ normal > 0 else -normal


def sliding_bodies(deck):
    """Nodes of the slave's body of each contact; none is part of another contact."""
    bodies = [body_of(deck, surface_nodes(deck, deck.surfaces[contact.slave][0])) for contact in deck.contacts]
    for contact, slides in zip(deck.contacts, bodies):
        if contact.stiffness is None or not numpy.any(contact.slip):
            raise BadInput(f"{deck.path}: a deck of sliding needs contacts by -law penalty, with a direction -slip; {contact.name} is none")
        for other, body in zip(deck.contacts, bodies):
            if body[surface_nodes(deck, deck.surfaces[contact.master][0])].any():
                raise BadInput(f"{deck.path}: the master of {contact.name} is on the body that slides at {other.name}, or on that of its "
                               "own slave: it must stay")
            if other is not contact and (body & slides).any():
                raise BadInput(f"{deck.path}: {contact.name} and {other.name} have one slave's body, which cannot slide at both")
    if not bodies:
        raise BadInput(f"{deck.path}: a deck of sliding needs a contact, by -law penalty, with a direction -slip")
    return bodies


def prepare(deck):
    """Moves the slaves' bodies back and names all bodies; returns of each contact the name of its body, pressure over slide, Pa/m, and the
    motion of the static step."""
    bodies, motions, place = sliding_bodies(deck), [], deck.contacts[0].place
    nodes = numpy.unique(numpy.concatenate([block.nodes.ravel() for block in deck.blocks]))
    deck.node_sets[STAYS] = nodes[~numpy.any(bodies, axis=0)[nodes]], place
    for k, (contact, slides) in enumerate(zip(deck.contacts, bodies), 1):
        deck.node_sets[f"SLIDES{k}"] = nodes[slides[nodes]], contact.place
        along = numpy.array(contact.slip) / numpy.linalg.norm(contact.slip)
        size = numpy.ptp(deck.x[slides], axis=0).max()
        deck.x[slides] -= SLIDE * size * along
        motion = size * (SLIDE * along + DEEP * mean_normal(deck, contact.slave))
        motions.append((f"SLIDES{k}", DEEP * contact.stiffness / SLIDE, motion))
    return motions


def sliding_cards(deck):
    """A whole deck; that of the scene is changed."""
    motions = prepare(deck)
    contacts, moved, changed = [], [f"{STAYS}, 1, 3"], []
    for contact, (body, steep, motion) in zip(deck.contacts, motions):
        mu, slope = contact.mu or 0, real(TWICE * (contact.mu or 0) * steep)
        contacts += [f"*SURFACE INTERACTION, NAME={contact.name}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                     real(contact.stiffness)]
        contacts += ["*FRICTION", f"{real(mu * (1 + EXCESS))}, {slope}"] if mu else []
        contacts += pair_cards(contact)
        changed += [f"*CHANGE FRICTION, INTERACTION={contact.name}", "*FRICTION", f"{real(mu)}, {slope}"] if mu else []
        moved += [f"{body}, {d + 1}, {d + 1}, {real(value)}" for d, value in enumerate(motion)]
    _, *supports = held_cards(deck) or [""]
    modes = frequency_cards(deck, True)
    return [*model_cards(deck), *contacts, "*STEP", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY", *moved, "*END STEP", modes[0], *changed,
            "*BOUNDARY, OP=NEW", *supports, *modes[1:]]
