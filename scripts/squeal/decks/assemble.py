"""A deck as a mesh with named sets and a scene: ties merged, nodes that no element has left out, parts by their sections,
holders and loads that say the same joined in one set."""

from dataclasses import dataclass, field

import numpy

from .deck import Material, Section, firsts_of
from .mesh.faces import surface_nodes
from .bolts import add_bolts, add_stages, split_sections
from .holders import add_contacts, add_loads, add_springs, add_supports, add_ties
from .joined.entries import add_joined
from .joined.groups import Groups
from .joined.holds import Holds
from .names import Names

CLOSE = 1e-6  # of the model's size: nodes that are nearer are in one place
MOST_CELL_SETS = 12  # that are no parts: a volume of a file of Gmsh is in 16 groups at most
MOST_RECORDS = 64  # names in one list of squeal


@dataclass
class Entry:
    """One thing of the scene, by its list: name, set, values with the place that each is from."""
    kind: str
    name: str
    rows: list = field(default_factory=list)  # (key, value, comment)
    hints: list = field(default_factory=list)  # lines that are comments only


@dataclass
class Result:
    """What is written."""
    x: numpy.ndarray
    blocks: list
    volumes: dict = field(default_factory=dict)  # name -> cells
    surfaces: dict = field(default_factory=dict)  # name -> faces (cell, face)
    points: dict = field(default_factory=dict)  # name -> nodes
    into: numpy.ndarray = None  # node of the deck -> that of the deck which it became by ties
    joined: object = None  # what joins nodes, of joined/
    beams: object = None  # the superelement of joined/beams.py
    assembly: object = None
    tables: list = field(default_factory=list)  # (entry of a contact, key of a file, slave and its gaps or lines of friction, place)
    fits: list = field(default_factory=list)  # (name of a contact whose surfaces are fitted before all else, place)
    entries: list = field(default_factory=list)

    def firsts(self):
        return firsts_of(self.blocks)


def coincident(x, slaves, masters, limit):
    """For each slave the master within `limit`, or -1."""
    along = numpy.array([0.4824, 0.6411, 0.5968])
    key_m, key_s = x[masters] @ along, x[slaves] @ along
    order = numpy.argsort(key_m)
    first = numpy.searchsorted(key_m[order], key_s - 2 * limit)
    last = numpy.searchsorted(key_m[order], key_s + 2 * limit)
    found, best = numpy.full(len(slaves), -1), numpy.full(len(slaves), limit)
    for step in range(int((last - first).max(initial=0))):
        rows = numpy.flatnonzero(first + step < last)
        candidate = masters[order[first[rows] + step]]
        distance = numpy.linalg.norm(x[candidate] - x[slaves[rows]], axis=1)
        nearer = distance <= best[rows]
        found[rows[nearer]], best[rows[nearer]] = candidate[nearer], distance[nearer]
    return found


def merge_ties(deck, size):
    """Makes one node of each slave node and the master node in its place; ties where one is missing stay in the deck. Returns
    the node that each one became."""
    into, ties = numpy.arange(deck.n_nodes), deck.ties
    deck.ties = []
    merge_equal(deck, CLOSE * size, into)
    for tie in ties:
        slaves, masters = (surface_nodes(deck, deck.surfaces[name][0]) for name in (tie.slave, tie.master))
        found = coincident(deck.x, slaves, masters, CLOSE * size)
        if (found < 0).any():
            deck.ties.append(tie)
            continue
        for slave, master in zip(slaves, found):
            into[into == into[slave]] = into[master]
        deck.differ(tie.place, f"{tie.words}: {len(slaves)} nodes of {tie.slave} become those of {tie.master} in their place")
    return into


def merge_equal(deck, limit, into):
    """Makes one node of two in one place that three equations u_a = u_b tie, a direction each."""
    pairs, used = {}, used_nodes(deck)
    for number, equation in enumerate(deck.equations):
        if len(equation.terms) == 2 and equation.terms[0][1] == equation.terms[1][1] < 3:
            (a, d, one), (b, _, other) = equation.terms
            if one == -other and used[a] and used[b] and a != b:
                pairs.setdefault((min(a, b), max(a, b)), {})[d] = number
    done = set()
    for (a, b), numbers in pairs.items():
        if len(numbers) == 3 and numpy.linalg.norm(deck.x[a] - deck.x[b]) <= limit:
            into[into == into[b]] = into[a]
            done |= set(numbers.values())
    if done:
        first = deck.equations[min(done)]
        deck.differ(first.place, f"{first.words}: {len(done) // 3} pairs of nodes in one place, which move alike, become one node each")
        deck.equations = [equation for number, equation in enumerate(deck.equations) if number not in done]


def model_size(deck):
    """Length of the diagonal of the box around all nodes of elements."""
    used = used_nodes(deck)
    x = deck.x[used]
    return float(numpy.linalg.norm(x.max(axis=0) - x.min(axis=0)))


def used_nodes(deck):
    """Which nodes elements have."""
    used = numpy.zeros(deck.n_nodes, bool)
    for block in deck.blocks:
        used[block.nodes] = True
    return used


def give_sections(deck):
    """Where a deck has no sections, its sets of elements or blocks become parts without a material: the largest first, and of
    those with the same elements the last one."""
    if deck.sections:
        return
    left = numpy.ones(deck.n_cells, bool)
    for name, (cells, place) in sorted(reversed(deck.cell_sets.items()), key=lambda item: -len(item[1][0])):
        if len(cells) and left[cells].all():
            left[cells] = False
            deck.sections.append(Section(name, cells, "", None, place))
            deck.note(place, f"set {name} has no section: it becomes a part without a material")
    if left.any():
        place = deck.blocks[0].place
        deck.sections.append(Section("body", numpy.flatnonzero(left), "", None, place))
        deck.note(place, f"{left.sum()} elements have no section and no set of their own: they become a part `body`")


def parts_of_cells(deck):
    """Number of the section of each cell, the last that it has, -1 without one."""
    part_of = numpy.full(deck.n_cells, -1)
    for number, section in enumerate(deck.sections):
        before = part_of[section.cells]
        for other in numpy.unique(before[before >= 0]).tolist():
            deck.differ(section.place, f"{(before == other).sum()} elements of {deck.sections[other].name} have the later section of "
                                       f"{section.name}")
        part_of[section.cells] = number
    return part_of


def part_names(deck, part_of, sets=None, things=None):
    """Number of each section that has cells -> name of its part."""
    sets, things = sets or Names(), things or Names(reserved=True)
    with_cells = set(numpy.unique(part_of).tolist())
    return {number: things.new(sets.new(section.name)) for number, section in enumerate(deck.sections) if number in with_cells}


class Assembly:
    """Names and groups while the result is made."""

    def __init__(self, deck, result, into):
        self.deck, self.result, self.into = deck, result, into
        self.sets, self.things = Names(), Names(reserved=True)
        self.of_nodes, self.of_faces = {}, {}  # name in the deck -> name of the set

    def parts(self, used):
        """Parts by sections; a cell has the last of its sections, none is in no part. Returns their names by number."""
        part_of = parts_of_cells(self.deck)
        names = part_names(self.deck, part_of, self.sets, self.things)
        for number, section in enumerate(self.deck.sections):
            if number not in names:
                self.deck.note(section.place, f"section of {section.name}: has no elements" + (
                    " but those of later sections" if len(section.cells) else ""))
                continue
            name = names[number]
            self.result.volumes[name] = numpy.flatnonzero(part_of == number)
            if section.material and not used[section.material].young:
                self.deck.note(section.place, f"part {name}: material {section.material} has no stiffness that squeal takes: give it")
            self.result.entries.append(part_entry(name, section, used[section.material]))
        if (part_of < 0).any():
            cell = int(numpy.flatnonzero(part_of < 0)[0])
            number = numpy.searchsorted(self.deck.firsts(), cell, side="right") - 1
            block = self.deck.blocks[number]
            raise block.place.wrong(f"element {block.ids[cell - self.deck.firsts()[number]]} ({(part_of < 0).sum()} in all) has no "
                                    "section, hence no material")
        return names

    def node_set(self, nodes, name, fallback):
        """The name of a set of points; "" where no element has any of its nodes."""
        if name and name in self.of_nodes:
            return self.of_nodes[name]
        members = numpy.unique(self.into[nodes])
        members = members[members >= 0]
        if not len(members):
            return ""
        written = self.sets.new(name or fallback)
        self.result.points[written] = members
        if name:
            self.of_nodes[name] = written
        return written

    def face_set(self, faces, name, fallback):
        """The name of a surface."""
        if name and name in self.of_faces:
            return self.of_faces[name]
        written = self.sets.new(name or fallback)
        self.result.surfaces[written] = numpy.unique(faces, axis=0)
        if name:
            self.of_faces[name] = written
        return written

    def add(self, kind, name, rows, hints=()):
        self.result.entries.append(Entry(kind, self.things.new(name), rows, list(hints)))

    def entry(self, kind, name, rows):
        """An entry whose name is taken already."""
        self.result.entries.append(Entry(kind, name, rows))

    def all_sets(self):
        """What the deck names and the scene does not use; names that begin with _ are those of a preprocessor."""
        for name, (faces, _) in self.deck.surfaces.items():
            if len(faces):
                self.face_set(faces, name, "")
        for name, (nodes, place) in self.deck.node_sets.items():
            if name in self.of_nodes or name.rpartition(".")[2].startswith("_"):
                continue
            if len(nodes) >= self.deck.n_nodes:
                self.deck.note(place, f"set {name} is all nodes: not written")
            elif not self.node_set(nodes, name, ""):
                self.deck.note(place, f"set {name}: no element has one of its nodes")
        parts = {cells.tobytes() for cells in map(numpy.unique, self.result.volumes.values())}
        extra = 0
        for name, (cells, place) in self.deck.cell_sets.items():
            cells = numpy.unique(cells)
            if not len(cells) or cells.tobytes() in parts or name.rpartition(".")[2].startswith("_"):
                continue
            if len(cells) == self.deck.n_cells or extra == MOST_CELL_SETS:
                self.deck.note(place, f"set of elements {name}: not written" +
                               (", it is all of them" if len(cells) == self.deck.n_cells else f", {extra} others are"))
                continue
            extra += 1
            self.result.volumes[self.sets.new(name)] = cells


def part_entry(name, section, material):
    """Material and axes of a part."""
    entry = Entry("parts", name)
    if not material.young:
        entry.hints.append(f"{name}: {{young: ?, poisson: ?{'' if material.density else ', density: ?'}}}   the file has no stiffness that "
                           "squeal takes: give it")

    def row(key, value, keyword):
        entry.rows.append((key, value, f"{material.places.get(keyword, material.place)} {material.name}"))

    if material.young:
        row("young", ("stress", material.young), "ELASTIC")
        row("poisson", ("", material.poisson), "ELASTIC")
    if material.shear:
        row("shear", ("stress", material.shear), "ELASTIC")
        if section.axes is None:
            entry.rows += [("axis_1", ("", (1, 0, 0)), f"{section.place} no orientation: those of space"),
                           ("axis_2", ("", (0, 1, 0)), f"{section.place} no orientation: those of space")]
    if section.axes is not None and material.shear:
        keys = ("cylinder_axis", "cylinder_centre") if section.axes.cylinder else ("axis_1", "axis_2")
        units = "", "length" if section.axes.cylinder else ""
        for key, unit, value in zip(keys, units, (section.axes.first, section.axes.second)):
            entry.rows.append((key, (unit, tuple(value)), str(section.axes.place)))
    if material.density is None and material.young:
        entry.hints.append(f"{name}_density is not in the file: give it")
    elif material.density is not None:
        row("density", ("density", (material.density,)), "DENSITY")
    if material.alpha:
        row("alpha", ("rate", (material.alpha,)), "DAMPING")
    if material.beta:
        row("beta", ("time", (material.beta,)), "DAMPING")
    for key, unit, values in material.law:
        row(key, (unit, values), "VISCOELASTIC")
    if material.loss:
        row("loss_factor", ("", (material.loss,)), "LOSS")
    return entry


def leave_losses(deck):
    """A material with a law of its modulus over frequency has no loss factor beside it."""
    for material in deck.materials.values():
        if material.loss and material.law:
            deck.note(material.places["LOSS"], f"material {material.name}: loss factor {material.loss:g} beside a modulus over frequency, "
                                               "which has its own: not taken")
            material.loss = 0.0


def assemble(deck, size):
    """The result of a deck."""
    leave_losses(deck)
    merged = merge_ties(deck, size)
    for block in deck.blocks:
        block.nodes = merged[block.nodes]
        if (numpy.diff(numpy.sort(block.nodes, axis=1)) == 0).any():
            raise block.place.wrong("a tie makes one node of two nodes of an element")
    used = used_nodes(deck)
    number = numpy.cumsum(used) - 1
    number[~used] = -1
    result = Result(deck.x[used], deck.blocks)
    result.into = merged
    assembly = result.assembly = Assembly(deck, result, number[merged])
    materials = dict(deck.materials) | {"": Material("", None)}
    split_sections(deck)
    parts = assembly.parts(materials)
    result.joined = Holds(deck, Groups(deck, used[merged], merged)).run()
    add_supports(assembly, result.joined.supports)
    add_springs(assembly)
    result.beams = add_joined(assembly, result.joined)
    add_loads(assembly, result.joined.loads)
    add_bolts(assembly, parts)
    add_contacts(assembly)
    add_stages(assembly)
    add_ties(assembly)
    assembly.all_sets()
    for block in deck.blocks:
        block.nodes = number[block.nodes]
    for kind in {entry.kind for entry in result.entries}:
        count = sum(entry.kind == kind for entry in result.entries)
        if count > MOST_RECORDS:
            deck.notes.append((deck.path, f"{count} {kind}: squeal takes {MOST_RECORDS} in one list; join some"))
    return result
