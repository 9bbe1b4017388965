"""Ansys: sections of shells and beams. Shells become solids of their thickness, beams a superelement."""

import numpy

from ..abaqus.beams import profile_of
from ..deck import Beam, Profile
from ..mesh.shells import add_shells, set_thickness
from ..text import real

SHELLS = {181: 4, 63: 4, 281: 8, 93: 8}  # number of a type -> nodes
BEAMS = {188: 2, 189: 3}
SIDES = {"MID": 0.0, "TOP": -0.5, "BOT": 0.5}  # the middle surface from the nodes along the normal, over the thickness
INSTEAD = "let Ansys write a superelement of them"


class Section:
    """What SECTYPE and the commands behind it say: kind, shape, numbers of each line, offset."""

    def __init__(self, command):
        self.kind, self.shape, self.place = command.word(2).upper(), command.word(3).upper(), command.place
        self.rows, self.offset = [], "MID"


def read_sections(commands):
    """Number of a section -> what it says; and the commands that do."""
    found, taken, last = {}, [], None
    for command in commands:
        word = command.words[0]
        if word == "SECTYPE":
            last = found[command.whole(1)] = Section(command)
        elif last is None or word not in ("SECDATA", "SECBLOCK", "SECOFFSET"):
            continue
        elif word == "SECDATA":
            last.rows.append(command.words[1:])
        elif word == "SECBLOCK":
            last.rows += [[part.strip() for part in line.split(",")] for line in command.lines]
        elif command.word(1):
            last.offset = command.word(1).upper()
        taken.append(command)
    return found, taken


def numbers_of(row, place):
    """Numbers of a line; blanks are 0."""
    return [real(word, place) if word else 0.0 for word in row]


def add_shell_cells(deck, mesh, waiting):
    """Cells of shells, triangles where corners are the same; returns of each group the cells and heads of its elements."""
    groups = []
    for kind, head, nodes, rows, block in waiting:
        n = SHELLS[kind]
        middles = (nodes[:, 4:n] > 0).all(axis=1) if n > 4 else numpy.zeros(len(nodes), bool)
        three = nodes[:, 2] == nodes[:, 3]
        for chosen, places in ((~three & ~middles, range(4)), (three & ~middles, range(3)),
                               (~three & middles, range(8)), (three & middles, (0, 1, 2, 4, 5, 7))):
            if not chosen.any():
                continue
            part, lines = nodes[chosen][:, list(places)], rows[chosen]
            at = mesh.nodes.need(part, "node", lambda row, lines=lines, block=block: block.place(int(lines[row])))
            cells = add_shells(deck, f"SHELL{kind}", head[chosen, 10], at, block.place(int(lines[0])))
            mesh.cells.add(head[chosen, 10], cells, lines + block.first + 1, block.header.place.file)
            mesh.materials.append(head[chosen, 0])
            mesh.systems_of.append(head[chosen, 4])
            groups.append((kind, cells, head[chosen], block.place(int(lines[0]))))
    return groups


def set_shells(deck, mesh, sections, constants):
    """Thicknesses by SECDATA, SECBLOCK of one layer, or real constants; shells without one have a line."""
    for kind, cells, head, place in mesh.shells:
        for section, number in {tuple(pair) for pair in head[:, [3, 2]].tolist()}:
            chosen = cells[(head[:, 3] == section) & (head[:, 2] == number)]
            said = sections.get(section)
            if said and said.kind == "SHELL" and len(said.rows) == 1 and said.offset in SIDES:
                thickness = (numbers_of(said.rows[0][:1], said.place) or [0.0])[0]
                if thickness <= 0:
                    raise said.place.wrong(f"SECTYPE {section}: a shell of the thickness {thickness:g}")
                set_thickness(deck, chosen, thickness, SIDES[said.offset] * thickness)
            elif said and said.kind == "SHELL":
                deck.note(said.place, f"SECTYPE {section}: " + (f"{len(said.rows)} layers" if len(said.rows) != 1 else
                                                                f"SECOFFSET {said.offset}") + f": not taken; {INSTEAD}")
            elif constants.get(number) and constants[number][0] > 0:
                given = [value for value in constants[number][:4] if value > 0]
                if len(set(given)) > 1:
                    deck.note(place, f"SHELL{kind}: a thickness that varies; the mean is taken")
                set_thickness(deck, chosen, sum(given) / len(given))


def profile_said(section):
    """The profile of a section of a beam, axis 1 being its y; None where it is not read."""
    if section is None or section.kind != "BEAM" or len(section.rows) != 1:
        return None
    values = numbers_of(section.rows[0], section.place)
    if section.shape == "RECT":
        return profile_of("RECT", values[:2])
    if section.shape == "CSOLID":
        return profile_of("CIRC", values[:1])
    if section.shape == "CTUBE" and len(values) > 1:
        return profile_of("PIPE", [values[1], values[1] - values[0]])
    if section.shape == "HREC" and len(values) > 5:
        return profile_of("BOX", values[:6])
    if section.shape == "ASEC" and len(values) > 5 and not values[2] and min(values[0], values[1], values[3], values[5]) > 0:
        return Profile(values[0], values[3], values[1], values[5], 1.0, 1.0)
    return None


def read_beams(deck, mesh, sections):
    """BEAM188 and BEAM189: two ends, a middle of BEAM189, and a node in the plane of x and z; without it y is level."""
    for kind, head, nodes, place in mesh.joints:
        if kind not in BEAMS:
            continue
        words, profile = f"BEAM{kind} element {head[10]}", profile_said(sections.get(int(head[3])))
        if profile is None:
            deck.note(place, f"{words}: a section that is not read (RECT, CSOLID, CTUBE, HREC of one wall, ASEC are): not in the scene; "
                             f"{INSTEAD}")
            continue
        ends = mesh.nodes.need(nodes[:2], "node", place).tolist()
        line = deck.x[ends[1]] - deck.x[ends[0]]
        side = nodes[BEAMS[kind]]
        up = deck.x[mesh.nodes.need(nodes[BEAMS[kind]:BEAMS[kind] + 1], "node", place)[0]] - deck.x[ends[0]] if side else (
            numpy.array([0.0, 0.0, 1.0]) if numpy.linalg.norm(line[:2]) > 1e-4 * numpy.linalg.norm(line) else numpy.array([-1.0, 0.0, 0.0]))
        path = [ends[0], *(mesh.nodes.need(nodes[2:3], "node", place).tolist() if kind == 189 and nodes[2] else ()), ends[1]]
        deck.differ(place, f"BEAM{kind}: its beams become a superelement by Timoshenko's theory, of straight pieces between nodes")
        deck.beams += [Beam((a, b), place, words, str(int(head[0])), profile, tuple(numpy.cross(up, line)))
                       for a, b in zip(path, path[1:])]
