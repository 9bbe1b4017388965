"""What a deck says, whichever code it is of. Nodes are indices into `x`, cells numbers of all volume elements from 0 in the
order of the blocks; values are in the units of the deck."""

from dataclasses import dataclass, field

import numpy

from ..tables import BadInput
from .mesh.elements import SHAPES

NOT_NEEDED = "not needed here"  # how notes of what is no part of a scene end


@dataclass(frozen=True)
class Place:
    """Where something stands."""
    file: str
    line: int

    def __str__(self):
        return f"{self.file}:{self.line}"

    def wrong(self, text):
        """The error for it."""
        return BadInput(f"{self}: {text}")


@dataclass
class Block:
    """Volume elements of one type."""
    shape: object
    kind: str  # as the deck names it
    ids: numpy.ndarray  # [n]
    nodes: numpy.ndarray  # [n][nodes], indices
    place: Place
    plain: numpy.ndarray = None  # of shells: their own nodes

    def own_nodes(self):
        """Nodes as the deck has them."""
        return self.nodes if self.plain is None else self.plain


@dataclass
class Axes:
    """Of a material: directions 1 and 2, or an axis and a point of it."""
    cylinder: bool
    first: numpy.ndarray  # direction 1; of a cylinder the direction of the axis
    second: numpy.ndarray  # direction 2; of a cylinder a point of the axis
    place: Place


@dataclass
class Material:
    """`young` etc. hold one or three values; what is not given is None."""
    name: str
    place: Place
    young: tuple = ()
    poisson: tuple = ()
    shear: tuple = ()
    density: float = None
    alpha: float = 0
    beta: float = 0
    loss: float = 0  # factor of structural damping
    law: tuple = ()  # of the modulus over frequency: (key of a part, unit, values)
    places: dict = field(default_factory=dict)


def give_loss(material, loss, place):
    """Adds to the loss factor of a material."""
    if not loss >= 0:
        raise place.wrong(f"the loss factor {loss:g} must not be negative")
    material.loss += loss
    material.places.setdefault("LOSS", place)


@dataclass
class Section:
    """Cells of one material: a part of the scene."""
    name: str
    cells: numpy.ndarray
    material: str
    axes: Axes
    place: Place


@dataclass
class Support:
    """Directions 0, 1, 2 (3, 4, 5: rotations) -> value of nodes; `name` where they are a named set."""
    nodes: numpy.ndarray
    values: dict
    name: str
    place: Place


@dataclass
class Spring:
    """To the ground, at every node."""
    nodes: numpy.ndarray
    stiffness: numpy.ndarray  # [3]
    name: str
    place: Place


@dataclass
class Join:
    """Nodes that follow a reference node: rigidly, or it follows them in the mean with shares (None: equal ones)."""
    name: str
    node: int
    nodes: numpy.ndarray
    rigid: bool
    place: Place
    words: str  # as the deck has it
    directions: tuple = (0, 1, 2)
    shares: numpy.ndarray = None
    knot: bool = False  # a fibre of a shell


@dataclass
class Lump:
    """A mass, and its inertia xx, yy, zz, xy, xz, yz about its own place, `offset` from a node."""
    node: int
    place: Place
    words: str
    mass: float = 0.0
    inertia: tuple = (0.0,) * 6
    offset: numpy.ndarray = field(default_factory=lambda: numpy.zeros(3))
    written: bool = False  # whether it is in the scene


@dataclass
class Link:
    """Stiffness and viscosity along and about x, y, z, or axes 1 and 2, between two nodes; -1 is the ground."""
    nodes: tuple
    place: Place
    words: str
    stiffness: tuple = (0.0,) * 6
    viscosity: tuple = (0.0,) * 6
    axes: tuple = None
    name: str = ""
    written: bool = False  # whether it is in the scene


@dataclass
class Profile:
    """Section of a beam: second moments of deflection along axes 1 and 2, of torsion; shares of the area that bear shear."""
    area: float
    bend_1: float
    bend_2: float
    torsion: float
    shear_1: float
    shear_2: float


@dataclass
class Beam:
    """A straight beam between two nodes, or ends that rigid arms `offsets` [2][3] hold; axis 1 is the part of `along` across it. `pins`:
    of each end the motions 0 to 5 along and about its own axes that pass no force."""
    nodes: tuple
    place: Place
    words: str
    material: str
    profile: Profile
    along: tuple
    offsets: tuple = None
    pins: tuple = ((), ())
    written: bool = False  # whether it is in the scene


@dataclass
class OneWay:
    """A mass that resists motion d of a node alone."""
    node: int
    d: int
    value: float
    place: Place
    words: str


@dataclass
class Equation:
    """sum of coefficient times motion d (0 to 5) of a node is 0: terms (node, d, coefficient)."""
    terms: list
    place: Place
    words: str


@dataclass
class Load:
    """Either `force` [3] and a `moment` at every one of the nodes, or a pressure on faces (cell, face), into the body."""
    name: str
    place: Place
    nodes: numpy.ndarray = None
    force: numpy.ndarray = None
    moment: numpy.ndarray = None
    faces: numpy.ndarray = None
    pressure: float = 0


@dataclass
class Contact:
    """Slave and master are names of surfaces."""
    name: str
    slave: str
    master: str
    place: Place
    mu: float = None
    stiffness: float = None  # per area
    points: tuple = ()  # or overclosure, pressure, overclosure, ...
    exponential: tuple = ()  # or clearance at no pressure, pressure at no clearance
    decay: tuple = ()  # static and kinetic coefficient, speed over which the first falls to the second
    table: tuple = ()  # or lines of friction.py; mu is the largest
    rotation: tuple = ()
    centre: tuple = ()
    turning: Place = None  # where the rotation is from
    damping: Place = None  # where friction damping is from
    gap: tuple = ()  # of the unloaded surfaces at all nodes of the slave, or of each by its number, and its Place
    fit: tuple = ()  # by how much more they overlap than in the mesh, in a stage before all else, and its Place


@dataclass
class Turning:
    """Nodes that turn at `omega` [3], rad/time, about an axis through `centre`."""
    nodes: numpy.ndarray
    omega: numpy.ndarray
    centre: numpy.ndarray
    place: Place


@dataclass
class Tie:
    """Slave and master are names of surfaces; `words` say where it is from."""
    name: str
    slave: str
    master: str
    place: Place
    words: str
    distance: float = 0  # farther nodes stay free; 0: not said


class Index:
    """Numbers of nodes or elements -> places in their array; a number that stands twice is an error where it must not."""

    def __init__(self, once=True):
        self.once, self.parts, self.lines, self.n, self.ready = once, [], [], 0, None

    def add(self, ids, at, lines, file):
        """Numbers, their places, lines of the file."""
        self.parts.append((ids, at))
        self.lines.append((len(ids), lines, file))
        self.n += len(ids)
        self.ready = None

    def sorted(self, what):
        """Numbers in rising order and their places."""
        if self.ready is None:
            ids = numpy.concatenate([ids for ids, _ in self.parts] or [numpy.empty(0, int)])
            at = numpy.concatenate([at for _, at in self.parts] or [numpy.empty(0, int)])
            order = numpy.argsort(ids, kind="stable")
            twice = numpy.flatnonzero(ids[order][1:] == ids[order][:-1])
            if len(twice) and self.once:
                later = order[twice + 1].min()
                raise self.line_of(later).wrong(f"{what} {ids[later]} stands twice")
            self.ready = ids[order], at[order]
        return self.ready

    def line_of(self, number):
        """Place of the number-th entry."""
        for n, lines, file in self.lines:
            if number < n:
                return Place(file, int(lines[number]))
            number -= n
        raise IndexError(number)

    def find(self, ids, what):
        """Places of numbers [...], and which of them are missing."""
        known, at = self.sorted(what)
        ids = numpy.asarray(ids, int)
        if not len(known):
            return numpy.zeros(ids.shape, int), numpy.ones(ids.shape, bool)
        first = numpy.minimum(numpy.searchsorted(known, ids), len(known) - 1)
        return at[first], known[first] != ids

    def need(self, ids, what, place):
        """Places of numbers, all of which must be there; `place` tells where the i-th stands."""
        at, missing = self.find(ids, what)
        if missing.any():
            first = tuple(numpy.argwhere(missing)[0])
            where = place(int(first[0])) if callable(place) else place
            raise where.wrong(f"{what} {numpy.asarray(ids)[first]} is not in the file")
        return at


class Deck:
    """All that was understood, and notes of all else."""

    def __init__(self, path, form):
        self.path, self.form = str(path), form
        self.x_parts, self.n_nodes, self.blocks, self.n_cells = [], 0, [], 0
        self.node_sets, self.cell_sets, self.surfaces = {}, {}, {}  # name -> (indices or faces [n][2], Place)
        self.materials, self.sections = {}, []
        self.supports, self.springs, self.loads, self.contacts, self.ties, self.turnings = [], [], [], [], [], []
        self.joins, self.lumps, self.links, self.equations, self.beams, self.one_way = [], [], [], [], [], []
        self.bolts = []  # of bolts.py
        self.shells, self.dummies = [], None  # of mesh/shells.py
        self.gravity = None  # (vector, Place)
        self.modes = None  # (count, lowest, highest, Place)
        self.all_mirrored = False  # whether the format has all elements the other way round
        self.preload = None  # Place of the step about whose state the modes are
        self.notes, self.differs = [], {}

    def missing(self):
        """Notes of what the scene may need: those but output and analyses."""
        return [note for note in self.notes if not note[1].endswith(NOT_NEEDED)]

    def idle(self):
        """The other ones."""
        return [note for note in self.notes if note[1].endswith(NOT_NEEDED)]

    def note(self, place, text):
        """Something that is not in the scene."""
        self.notes.append((place, text))

    def differ(self, place, text):
        """A formulation that differs, said once."""
        self.differs.setdefault(text, place)

    def add_nodes(self, x):
        """Coordinates [n][3]; returns their indices."""
        self.x_parts.append(x)
        self.n_nodes += len(x)
        return numpy.arange(self.n_nodes - len(x), self.n_nodes)

    @property
    def x(self):
        """Coordinates of all nodes."""
        if len(self.x_parts) != 1:
            self.x_parts = [numpy.concatenate(self.x_parts or [numpy.empty((0, 3))])]
        return self.x_parts[0]

    def add_block(self, block):
        """Returns the numbers of its cells."""
        check_twice(block)
        self.blocks.append(block)
        self.n_cells += len(block.ids)
        return numpy.arange(self.n_cells - len(block.ids), self.n_cells)

    def firsts(self):
        return firsts_of(self.blocks)


def firsts_of(blocks):
    """Number of the first cell of each block, and of all cells."""
    return numpy.cumsum([0, *(len(block.ids) for block in blocks)])


def check_twice(block):
    """No node may stand twice in an element."""
    rows = numpy.sort(block.nodes, axis=1)
    twice = (rows[:, 1:] == rows[:, :-1]).any(axis=1)
    if twice.any():
        number = block.ids[numpy.flatnonzero(twice)[0]]
        raise block.place.wrong(f"element {number} of type {block.kind} has a node twice")


def shape_of(name):
    return SHAPES[name]
