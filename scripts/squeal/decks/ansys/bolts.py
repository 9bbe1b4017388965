"""Ansys: pretension sections. PRETS179 elements join nodes of the two sides of a cut, in one place each, and have a node for the
section: SECDATA says along which normal, SLOAD or a force or displacement of that node how much. The nodes of the sides become one."""

import numpy

from ..bolts import Bolt, cell_middles
from ..deck import Equation
from ..text import real

KIND = 179


def sections_of(commands):
    """Number of a pretension section -> its node's number and normal; and the commands that say so."""
    found, taken, last = {}, [], None
    for command in commands:
        if command.words[0] == "SECTYPE":
            last = command.whole(1) if command.word(2).upper().startswith("PRET") else None
            taken += [command] if last is not None else []
        elif command.words[0] == "SECDATA" and last is not None:
            found[last] = command.whole(1), numpy.array([command.real(k) for k in (2, 3, 4)])
            taken.append(command)
    return found, taken


def sizes_of(deck, mesh, commands, sections):
    """Node's number -> (tension, shortening, place), the first that is not 0; and the commands that say so."""
    found, taken = {}, []
    for command in commands:
        words = command.words
        if words[0] == "SLOAD" and command.word(1).isdigit() and command.whole(1) in sections:
            kind, number, text = command.word(4).upper(), sections[command.whole(1)][0], command.word(5)
        elif words[0] in ("F", "D") and command.word(2).upper() in ("FX", "UX") and command.word(1).isdigit():
            number, text = command.whole(1), command.word(3)
            kind = "FORC" if words[0] == "F" else "DISP"
            if number not in {node for node, _ in sections.values()}:
                continue
        else:
            continue
        taken.append(command)
        value = real(text, command.place) if text and not text.startswith("%") else 0.0
        if value and kind in ("FORC", "DISP") and number not in found:
            found[number] = (value, 0.0, command.place) if kind == "FORC" else (0.0, value, command.place)
        elif value:
            deck.note(command.place, f"{words[0]} of a pretension section: not taken, another line tightens it")
    return found, taken


def read_bolts(deck, commands, mesh):
    """Bolts of the deck; returns the commands that they have taken."""
    rows = [(nodes[:3], place) for kind, _, nodes, place in mesh.joints if kind == KIND]
    sections, taken = sections_of(commands)
    sizes, more = sizes_of(deck, mesh, commands, sections)
    normals = {node: normal for node, normal in sections.values()}
    for count, number in enumerate(sorted({int(nodes[2]) for nodes, _ in rows}), 1):
        members = numpy.array([nodes for nodes, _ in rows if nodes[2] == number])
        place = next(place for nodes, place in rows if nodes[2] == number)
        add_bolt(deck, mesh, (f"pretension_{count}", members, place), normals.get(number), sizes.get(number))
    return taken + more


def add_bolt(deck, mesh, said, normal, size):
    """Makes one of the nodes of the two sides, and a bolt where it is tightened."""
    name, members, place = said
    words = f"PRETS179 with node {members[0, 2]}"
    sides = mesh.nodes.need(members[:, :2], "node", place)
    for a, b in sides.tolist():
        deck.equations += [Equation([(a, d, 1.0), (b, d, -1.0)], place, words) for d in range(3)]
    if size is None or normal is None or not numpy.linalg.norm(normal) > 0:
        deck.note(place, f"{words}: " + ("no SLOAD, F or D tightens it" if size is None else "no SECDATA has its normal") +
                  ": the bolt is whole")
        return
    on = numpy.zeros(deck.n_nodes, bool)
    on[sides[:, 0]] = True
    cells = numpy.concatenate([low + numpy.flatnonzero(on[block.nodes].any(axis=1)) for low, block in zip(deck.firsts(), deck.blocks)])
    axis = normal / numpy.linalg.norm(normal)
    if len(cells):
        axis = axis * -numpy.sign((cell_middles(deck, cells).mean(axis=0) - deck.x[sides[:, 0]].mean(axis=0)) @ axis)
    if not len(cells) or size[0] < 0 or size[1] < 0:
        deck.note(size[2], f"{words}: " + ("its nodes are of no volume element" if not len(cells) else "it would press the bolt") +
                  ": not tightened")
        return
    deck.bolts.append(Bolt(name, cells, numpy.unique(sides), axis, size[2], words, size[0], size[1]))
