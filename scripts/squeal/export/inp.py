"""The cards of a deck (decks/deck.py) for CalculiX, and for Abaqus, which reads the same. Numbers have 14 digits, as a field of
CalculiX holds 20 characters."""

import numpy

from .calculix import lines_of, node_cards

EVERYTHING = "ALL_PARTS"  # set of all elements, on which gravity acts
STICK = 0.1  # slope of sticking over the stiffness of a contact, which CalculiX needs with friction


def real(value):
    """At most 20 characters."""
    return f"{value:.13e}"


def element_cards(deck):
    """Blocks of elements, each into the set of its part."""
    for block in deck.blocks:
        yield f"*ELEMENT, TYPE={block.kind}, ELSET={block.place.file}"
        rows = numpy.column_stack([block.ids, block.nodes + 1])
        yield from lines_of(rows.tolist())


def set_cards(deck):
    """Sets of nodes, and surfaces of faces; of all elements where there is gravity."""
    if deck.gravity:
        yield from (f"*ELSET, ELSET={EVERYTHING}, GENERATE", f"1, {deck.n_cells}")
    for name, (nodes, _) in deck.node_sets.items():
        yield f"*NSET, NSET={name}"
        yield from lines_of([(nodes[k:k + 12] + 1).tolist() for k in range(0, len(nodes), 12)])
    ids = numpy.concatenate([block.ids for block in deck.blocks])
    for name, (faces, _) in deck.surfaces.items():
        yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
        yield from (f"{ids[cell]}, S{face + 1}" for cell, face in faces.tolist())


def axes_row(axes):
    """Two points: of directions 1 and 2, or of the axis of a cylinder."""
    return [*axes.second, *(axes.second + axes.first)] if axes.cylinder else [*axes.first, *axes.second]


def material_cards(deck):
    """Materials, axes, sections."""
    for material in deck.materials.values():
        yield f"*MATERIAL, NAME={material.name}"
        if len(material.young) == 3:
            rows = [*material.young, *material.poisson, *material.shear[:2]], material.shear[2:]
            yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
            yield from (", ".join(map(real, row)) + end for row, end in zip(rows, (",", "")))
        else:
            yield from ("*ELASTIC", f"{real(material.young[0])}, {real(material.poisson[0])}")
        yield from ("*DENSITY", real(material.density))
        if material.alpha or material.beta:
            yield f"*DAMPING, ALPHA={real(material.alpha)}, BETA={real(material.beta)}"
    for section in deck.sections:
        orientation = ""
        if section.axes:
            orientation = f", ORIENTATION={section.name}"
            system = "CYLINDRICAL" if section.axes.cylinder else "RECTANGULAR"
            yield f"*ORIENTATION, NAME={section.name}, SYSTEM={system}"
            yield ", ".join(map(real, axes_row(section.axes)))
        yield f"*SOLID SECTION, ELSET={section.name}, MATERIAL={section.material}{orientation}"


def spring_cards(deck):
    """SPRING1 of each node and direction; equal ones share a set."""
    groups, number = {}, 1 + sum(len(block.ids) for block in deck.blocks)
    for spring in deck.springs:
        for d in numpy.flatnonzero(spring.stiffness).tolist():
            groups.setdefault((spring.place.file, d, real(spring.stiffness[d])), []).extend(spring.nodes.tolist())
    for k, ((owner, d, value), nodes) in enumerate(groups.items(), 1):
        name = f"{owner}_SPRING_{k}"
        yield f"*ELEMENT, TYPE=SPRING1, ELSET={name}"
        yield from (f"{number + i}, {node + 1}" for i, node in enumerate(nodes))
        number += len(nodes)
        yield from (f"*SPRING, ELSET={name}", str(d + 1), value)


def held_cards(deck):
    """Supports; what motions prescribe is held."""
    rows = [f"{support.name}, {d + 1}, {d + 1}" for support in deck.supports for d in sorted(support.values)]
    return ["*BOUNDARY", *rows] if rows else []


def contact_cards(deck):
    """Surface to surface, linear in the penetration or hard."""
    for contact in deck.contacts:
        yield f"*SURFACE INTERACTION, NAME={contact.name}"
        yield f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={'LINEAR' if contact.stiffness else 'HARD'}"
        if contact.stiffness:
            yield real(contact.stiffness)
        if contact.mu:
            yield from ("*FRICTION", f"{real(contact.mu)}, {real(STICK * (contact.stiffness or 1e12))}")
        yield from pair_cards(contact)


def pair_cards(contact):
    """The two surfaces of a contact."""
    return [f"*CONTACT PAIR, INTERACTION={contact.name}, TYPE=SURFACE TO SURFACE", f"{contact.slave}, {contact.master}"]


def tie_cards(deck):
    """Each node of the slave follows the facet below it; none is moved."""
    for tie in deck.ties:
        yield from (f"*TIE, NAME={tie.name}, ADJUST=NO, POSITION TOLERANCE={real(tie.distance)}", f"{tie.slave}, {tie.master}")


def frequency_cards(deck, perturbed=False):
    """The modes that are asked for: so many of a band, or the lowest."""
    count, low, high, _ = deck.modes
    return ["*STEP, PERTURBATION" if perturbed else "*STEP", "*FREQUENCY",
            f"{count}, {real(low)}, {real(high)}" if high > 0 else str(count),
            "*END STEP"]


def load_cards(deck):
    """What a static step has: forces, pressures, gravity, motions."""
    forces = [(node + 1, d + 1, load.force[d]) for load in deck.loads if load.faces is None
              for node in load.nodes.tolist() for d in numpy.flatnonzero(load.force).tolist()]
    if forces:
        yield "*CLOAD"
        yield from (f"{node}, {d}, {real(value)}" for node, d, value in forces)
    pressed = [load for load in deck.loads if load.faces is not None]
    if pressed:
        yield "*DSLOAD"
        yield from (f"{load.name}, P, {real(load.pressure)}" for load in pressed)
    if deck.gravity:
        size = numpy.linalg.norm(deck.gravity[0])
        yield from ("*DLOAD", f"{EVERYTHING}, GRAV, {real(size)}, " + ", ".join(map(real, deck.gravity[0] / size)))
    moved = [f"{support.name}, {d + 1}, {d + 1}, {real(value)}" for support in deck.supports
             for d, value in support.values.items() if value]
    if moved:
        yield from ("*BOUNDARY", *moved)


def step_cards(deck):
    """Modes; the static step stands before them where there is contact, which it closes, else behind them, since CalculiX would
    stiffen the modes by its stress."""
    loads = list(load_cards(deck))
    static = ["*STEP", "*STATIC", *loads, "*END STEP"] if loads else []
    perturbed = bool(static and deck.contacts)
    modes = frequency_cards(deck, perturbed)
    return [*static, *modes] if perturbed else [*modes, *static]


def model_cards(deck):
    """All but supports, contact and steps."""
    return [*node_cards(deck.x), *element_cards(deck), *set_cards(deck), *material_cards(deck), *spring_cards(deck), *tie_cards(deck)]


def deck_cards(deck):
    """A whole deck."""
    return [*model_cards(deck), *held_cards(deck), *contact_cards(deck), *step_cards(deck)]
