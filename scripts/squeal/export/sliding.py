"""A deck that brings CalculiX into the state of full sliding of a scene with one contact, whose modes it then finds: complex ones
where friction couples them.

A static step makes all points of the contact slip equally: each body moves as a whole, that of the slave into the other until the
pressure is PRESSURE, and by SLIDE along the direction of slip. It starts as much before its place, so that the meshes are in theirs
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

PRESSURE, SLIDE, TWICE, EXCESS = 1e4, 0.2, 2, 1e-2  # Pa, of the size of the slave's body, -, -
BODIES = "SLIDES", "STAYS"


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


def prepare(deck):
    """Moves the slave's body back and names both; returns the contact, the slide, m, and the motion of the static step."""
    if len(deck.contacts) != 1 or deck.contacts[0].stiffness is None or not numpy.any(deck.contacts[0].slip):
        raise BadInput(f"{deck.path}: a deck of sliding needs one contact, by -law penalty, with a direction -slip")
    contact = deck.contacts[0]
    nodes = {name: numpy.concatenate([block.nodes.ravel() for block in deck.blocks]) for name in BODIES}
    slides = body_of(deck, surface_nodes(deck, deck.surfaces[contact.slave][0]))
    if slides[surface_nodes(deck, deck.surfaces[contact.master][0])].any():
        raise BadInput(f"{deck.path}: slave and master of {contact.name} are one body, which cannot slide on itself")
    for name, members in zip(BODIES, (slides, ~slides)):
        deck.node_sets[name] = numpy.intersect1d(nodes[name], numpy.flatnonzero(members)), contact.place
    along = numpy.array(contact.slip) / numpy.linalg.norm(contact.slip)
    slide = SLIDE * numpy.ptp(deck.x[slides], axis=0).max()
    deck.x[slides] -= slide * along
    return contact, slide, slide * along + mean_normal(deck, contact.slave) * PRESSURE / contact.stiffness


def sliding_cards(deck):
    """A whole deck; that of the scene is changed."""
    contact, slide, motion = prepare(deck)
    mu, slope = contact.mu or 0, real(TWICE * (contact.mu or 0) * PRESSURE / slide)
    friction = ["*FRICTION", f"{real(mu * (1 + EXCESS))}, {slope}"] if mu else []
    changed = [f"*CHANGE FRICTION, INTERACTION={contact.name}", "*FRICTION", f"{real(mu)}, {slope}"] if mu else []
    _, *supports = held_cards(deck) or [""]
    modes = frequency_cards(deck, True)
    return [*model_cards(deck), f"*SURFACE INTERACTION, NAME={contact.name}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            real(contact.stiffness), *friction, *pair_cards(contact), "*STEP", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY",
            f"{BODIES[1]}, 1, 3", *(f"{BODIES[0]}, {d + 1}, {d + 1}, {real(value)}" for d, value in enumerate(motion)), "*END STEP",
            modes[0], *changed, "*BOUNDARY, OP=NEW", *supports, *modes[1:]]
