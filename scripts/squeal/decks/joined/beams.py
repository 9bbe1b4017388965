"""Beams of a deck, and masses along one direction, as a superelement of the scene: nodes of solids and of what moves with them keep
their displacements, at points their rotations; all else is internal."""

from dataclasses import dataclass, field

import numpy
from scipy.sparse import coo_matrix

from .frames import axes_of, carried, matrices, released

WORDS = "x", "y", "z", "rx", "ry", "rz"


@dataclass
class Body:
    """A superelement in the units of the deck: unknowns (node, d) in their order, and what each is in its table."""
    unknowns: dict = field(default_factory=dict)  # (node, d) -> number
    words: list = field(default_factory=list)  # of each: direction, or internal
    entries: list = field(default_factory=list)  # (matrix 0 or 1, row, column, value)
    free: set = field(default_factory=set)  # nodes of beams alone
    mass: float = 0.0
    place: object = None

    def add(self, which, keys, block):
        """Adds a block to K (0) or M (1); a key that is held has no row."""
        rows = [self.unknowns.get(key, -1) for key in keys]
        self.entries += [(which, i, j, float(block[a, b])) for a, i in enumerate(rows) for b, j in enumerate(rows)
                         if i >= 0 and j >= 0 and block[a, b] != 0]

    def matrix(self, which, units):
        """K or M in SI; rotations have a unit of their own."""
        chosen = [entry[1:] for entry in self.entries if entry[0] == which]
        i, j, value = (numpy.array(column) for column in zip(*chosen)) if chosen else (numpy.zeros(0, int),) * 3
        turns = numpy.array([d > 2 for _, d in self.unknowns])
        size = numpy.where(turns, units.length, 1.0)
        factor = units.stiffness if which == 0 else units.mass
        return coo_matrix((value * factor * size[i] * size[j], (i, j)), shape=2 * [len(self.unknowns)]).tocsr()

    def table(self, x, units):
        """Lines of the table."""
        lines = ["unknown,node,direction,x,y,z"]
        for number, ((node, _), word) in enumerate(zip(self.unknowns, self.words), 1):
            place = ",".join(f"{v * units.length:.17g}" for v in x[node]) if word != "internal" else "0,0,0"
            lines.append(f"{number},{node + 1},{word},{place}")
        return "\n".join(lines) + "\n"


def directions(places, body, node, place, turns=True):
    """What the motions 0 to 5 of a node are: d -> word of the table; what is not there is held. None: nothing tells it."""
    joined, solid = places.joined, bool(places.joined.groups.solid[node])
    if solid and not turns:
        return dict(enumerate(WORDS[:3]))
    group = joined.carrier(node) if solid else joined.at(node)
    if group and group.how == "held":
        return {}
    if group and group.how == "point" and len(group.directions) == 3:
        places.point(node, place, group)
        return dict(enumerate(WORDS))
    if solid:
        return dict(enumerate(WORDS[:3])) | {d: "internal" for d in (3, 4, 5)}
    if group:
        return None
    fixed = joined.fixed.get(int(node), {})
    if any(value for value, _ in fixed.values()):
        return None
    body.free.add(int(node))
    return {d: "internal" for d in range(6) if d not in fixed}


def take_node(places, body, taken, node, place, turns=True):
    """Unknowns of a node, once; whether it is told."""
    if node not in taken:
        found = directions(places, body, node, place, turns)
        taken[node] = found is not None
        for d, word in sorted((found or {}).items()):
            body.unknowns[node, d] = len(body.words)
            body.words.append(word)
    return taken[node]


def constants(deck, beam):
    """E, G and density of a beam; None and a line where they are not there."""
    material = deck.materials.get(beam.material)
    if material is None or len(material.young) != 1 or not material.density:
        deck.note(beam.place, f"{beam.words}: its material {beam.material or 'without a name'} has no modulus or no density: not in "
                              "the scene")
        return None
    return material.young[0], material.young[0] / (2 * (1 + material.poisson[0])), material.density


def add_beam(places, body, taken, beam):
    """Adds one beam, or a line."""
    deck = places.deck
    arms = numpy.zeros((2, 3)) if beam.offsets is None else numpy.array(beam.offsets)
    line = deck.x[beam.nodes[1]] + arms[1] - deck.x[beam.nodes[0]] - arms[0]
    material = constants(deck, beam)
    if material is None:
        return
    axes = axes_of(line, numpy.array(beam.along)) if numpy.linalg.norm(line) > 0 else None
    if axes is None:
        deck.note(beam.place, f"{beam.words}: no length, or axis 1 lies along it: not in the scene")
        return
    if not all([take_node(places, body, taken, node, beam.place) for node in beam.nodes]):
        deck.note(beam.place, f"{beam.words}: an end that is moved, or that equations tell: not in the scene")
        return
    keys = [(node, d) for node in beam.nodes for d in range(6)]
    blocks, pins = matrices(line, axes, material, beam.profile), [6 * end + d for end in (0, 1) for d in beam.pins[end]]
    try:
        blocks = carried(*(released(*blocks, axes, pins) if pins else blocks), arms)
    except numpy.linalg.LinAlgError:
        deck.note(beam.place, f"{beam.words}: its pins leave it a motion without stiffness: not in the scene")
        return
    for which, block in enumerate(blocks):
        body.add(which, keys, block)
    body.mass += material[2] * beam.profile.area * float(numpy.linalg.norm(line))
    beam.written = True


def add_beams(places):
    """The superelement of all beams and masses along one direction, None without; lumps on nodes of beams alone belong to it."""
    deck, body, taken = places.deck, Body(), {}
    for beam in deck.beams:
        add_beam(places, body, taken, beam)
    for one in deck.one_way:
        if not take_node(places, body, taken, one.node, one.place, one.d > 2) or (one.node, one.d) not in body.unknowns:
            deck.note(one.place, f"{one.words}: at a node that is held, moved, or that equations tell: not in the scene")
            continue
        body.add(1, [(one.node, one.d)], numpy.array([[one.value]]))
        body.mass += one.value
    if not body.words:
        return None
    body.place = (deck.beams + deck.one_way)[0].place
    on = sorted({node for node, _ in body.unknowns if places.joined.groups.solid[node]})
    rows = [("sets", places.assembly.node_set(numpy.array(on), "", "beams_on"), str(body.place))] if on else []
    places.assembly.add("superelements", "beams", rows)
    return body


def take_lump(body, lump):
    """A mass on a node of beams alone; whether it is."""
    if body is None or lump.node not in body.free:
        return False
    xx, yy, zz, xy, xz, yz = lump.inertia
    r, m = numpy.array(lump.offset), lump.mass
    arm = numpy.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    block = numpy.zeros((6, 6))
    block[:3, :3], block[:3, 3:], block[3:, :3] = m * numpy.eye(3), -m * arm, m * arm
    block[3:, 3:] = numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) - m * arm @ arm
    body.add(1, [(lump.node, d) for d in range(6)], block)
    body.mass += m
    return True
