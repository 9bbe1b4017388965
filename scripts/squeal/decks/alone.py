"""One part of a deck, free: its elements, material and sets, without what holds, loads and touches it."""

import numpy

from ..tables import BadInput
from .assemble import part_names, parts_of_cells
from .deck import Block

JOINING = ("supports", "springs", "loads", "contacts", "ties", "turnings", "joins", "lumps", "links", "equations", "beams", "one_way",
           "bolts")


MOST_NAMED = 4  # other parts


def leave_alone(deck, wanted):
    """Takes all but the part with that name in the scene out of the deck."""
    part_of = parts_of_cells(deck)
    names = part_names(deck, part_of)
    number = next((number for number, name in names.items() if name == wanted), None)
    if number is None:
        raise BadInput(f"--part {wanted}: the parts of {deck.path} are {', '.join(names.values())}")
    kept = part_of == number
    section = deck.sections[number]
    others = [name for name in names.values() if name != wanted]
    left_out = sum(len(getattr(deck, kind)) for kind in JOINING)
    keep_cells(deck, kept)
    section.cells, section.name = numpy.arange(deck.n_cells), wanted
    deck.sections, deck.gravity, deck.preload = [section], None, None
    for kind in JOINING:
        setattr(deck, kind, [])
    named = ", ".join(others[:MOST_NAMED]) + (" and others" if others[MOST_NAMED:] else "")
    deck.differ(section.place, f"{wanted} alone, free (--part): without {named or 'other parts'}, and without supports, loads, contacts, "
                               f"ties, joints and masses, {left_out} in all")


def keep_cells(deck, kept):
    """Leaves the cells that are kept, with sets of what is left of each."""
    firsts, cell_into = deck.firsts(), numpy.cumsum(kept) - 1
    parts = [kept[a:b] for a, b in zip(firsts[:-1], firsts[1:])]
    deck.blocks = [Block(block.shape, block.kind, block.ids[part], block.nodes[part], block.place,
                         None if block.plain is None else block.plain[part]) for block, part in zip(deck.blocks, parts) if part.any()]
    deck.n_cells = int(kept.sum())
    inside = numpy.zeros(deck.n_nodes, bool)
    for block in deck.blocks:
        inside[block.nodes] = True
    for sets in (deck.cell_sets, deck.surfaces, deck.node_sets):
        for name, (members, place) in list(sets.items()):
            members = numpy.asarray(members, int)
            chosen = members[inside[members] if sets is deck.node_sets else kept[members if sets is deck.cell_sets else members[:, 0]]]
            if not len(chosen):
                del sets[name]
                continue
            if sets is deck.cell_sets:
                chosen = cell_into[chosen]
            elif sets is deck.surfaces:
                chosen = numpy.column_stack([cell_into[chosen[:, 0]], chosen[:, 1:]])
            sets[name] = chosen, place
