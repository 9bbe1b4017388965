"""Decks of Abaqus and CalculiX: keywords with their data, parts that are placed as instances, included files."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy

from ...tables import BadInput
from . import beams as abaqus_beams, bolts as abaqus_bolts, connectors as abaqus_connectors, joined as abaqus_joined, loads as abaqus_loads
from . import material as abaqus_material, mesh as abaqus_mesh
from . import friction as abaqus_friction, model as abaqus_model, sets as abaqus_sets, viscous as abaqus_viscous
from .words import KEYWORDS, PARAMETERS, choice, half_word, label, spelled
from ..deck import NOT_NEEDED, Deck, Index, Place
from ..text import read_bytes, real, shorter

DEEPEST = 10  # files that include each other
BLANKS = re.compile(rb"^[ \t]+(?=\*)", re.MULTILINE)  # the first letter of a line of a keyword, but for blanks, is *
PHASES = {"NODE": 0, "ELEMENT": 1, "NSET": 2, "ELSET": 2, "SURFACE": 3, "DISTRIBUTION": 3, "TRANSFORM": 3,
          "ORIENTATION": 4, "INITIAL CONDITIONS": 4, "TEMPERATURE": 4, "AMPLITUDE": 4}  # others last
OUTPUT = {"NODE PRINT", "EL PRINT", "NODE FILE", "EL FILE", "NODE OUTPUT", "ELEMENT OUTPUT", "OUTPUT", "RESTART", "PREPRINT",
          "CONTACT FILE", "CONTACT PRINT", "CONTACT OUTPUT", "ENERGY OUTPUT", "ENERGY PRINT", "FILE FORMAT", "MONITOR",
          "SECTION PRINT", "PRINT", "MODAL FILE"}
ANALYSES = {"DYNAMIC", "BUCKLE", "MODAL DYNAMIC", "STEADY STATE DYNAMICS", "CONTROLS", "SOLVER CONTROLS"}
GEOMETRY = {"SYSTEM", "NMAP", "NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"}  # without them the mesh is another
PLAIN = {"HEADING", "END STEP", "ASSEMBLY", "END ASSEMBLY"}  # say nothing of the model
ADDED = {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "BOUNDARY", "CLOAD", "DLOAD", "DSLOAD", "TIE"}  # may come in several pieces
INSTEAD = {"SHELL GENERAL SECTION": "its shells have no thickness",
           "CONTACT": "squeal needs a *CONTACT PAIR of two surfaces"}

# Options that change what a card says; others are listed
KNOWN = {"NODE": {"NSET", "SYSTEM", "INPUT"}, "ELEMENT": {"TYPE", "ELSET", "INPUT", "PARENT"},
         "NSET": {"NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"},
         "ELSET": {"ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"},
         "SURFACE": {"NAME", "TYPE", "INTERNAL"}, "TRANSFORM": {"NSET", "TYPE"},
         "MATERIAL": {"NAME"}, "DENSITY": set(), "DISTRIBUTION": {"NAME", "LOCATION", "TABLE"},
         "ELASTIC": {"TYPE"}, "DAMPING": {"ALPHA", "BETA"},
         "INITIAL CONDITIONS": set(), "TEMPERATURE": {"OP"}, "AMPLITUDE": {"NAME", "TIME"},
         "SHELL SECTION": {"ELSET", "MATERIAL", "ORIENTATION", "OFFSET", "CONTROLS", "SECTION INTEGRATION", "POISSON"},
         "SOLID SECTION": {"ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"}, "ORIENTATION": {"NAME", "SYSTEM", "DEFINITION"},
         "BOUNDARY": {"OP", "FIXED"}, "SPRING": {"ELSET"}, "DASHPOT": {"ELSET"}, "MASS": {"ELSET"}, "ROTARY INERTIA": {"ELSET"},
         "COUPLING": {"REF NODE", "SURFACE", "CONSTRAINT NAME", "ORIENTATION", "INFLUENCE RADIUS"}, "KINEMATIC": set(),
         "DISTRIBUTING": {"WEIGHTING METHOD", "COUPLING"}, "KINEMATIC COUPLING": {"REF NODE", "ORIENTATION"},
         "EQUATION": set(), "MPC": set(), "PRE-TENSION SECTION": {"SURFACE", "NODE"},
         "BEAM SECTION": {"ELSET", "MATERIAL", "SECTION", "TEMPERATURE"},
         "BEAM GENERAL SECTION": {"ELSET", "SECTION", "DENSITY"},
         "CONNECTOR SECTION": {"ELSET", "BEHAVIOR"}, "CONNECTOR BEHAVIOR": {"NAME"}, "CONNECTOR ELASTICITY": {"COMPONENT"},
         "CONNECTOR DAMPING": {"COMPONENT"},
         "RIGID BODY": {"REF NODE", "ROT NODE", "NSET", "ELSET", "PIN NSET", "TIE NSET"},
         "TIE": {"NAME", "POSITION TOLERANCE", "ADJUST", "TYPE"},
         "CONTACT PAIR": {"INTERACTION", "TYPE", "SMALL SLIDING", "ADJUST", "CPSET", "NO THICKNESS", "MECHANICAL CONSTRAINT",
                          "TIED"},
         "CLEARANCE": {"MASTER", "SLAVE", "VALUE", "TABULAR"}, "CONTACT INTERFERENCE": {"SHRINK", "OP"},
         "SURFACE INTERACTION": {"NAME"}, "FRICTION": {"SLIP TOLERANCE", "ELASTIC SLIP"}, "SURFACE BEHAVIOR": {"PRESSURE-OVERCLOSURE"},
         "GLOBAL DAMPING": {"ALPHA", "BETA", "FIELD", "STRUCTURAL"},
         "VISCOELASTIC": set(), "CHANGE FRICTION": {"INTERACTION"}, "CLOAD": {"OP"}, "DLOAD": {"OP"}, "DSLOAD": {"OP"},
         "MOTION": {"ROTATION", "TYPE"}, "STEP": {"NAME", "PERTURBATION", "INC", "NLGEOM"},
         "FREQUENCY": {"EIGENSOLVER", "STORAGE", "NORMALIZATION", "SOLVER"}, "STATIC": {"SOLVER"},
         "COMPLEX FREQUENCY": {"FRICTION DAMPING", "SOLVER", "RIGHT EIGENVECTORS"}}
IDLE = {"STEP": {"UNSYMM"}, "FREQUENCY": {"SIM", "ACOUSTIC COUPLING"}, "STATIC": {"STABILIZE", "DIRECT", "ADIABATIC"}}


def listed(do):
    """Lists the options of a card that change what it says and are not known."""
    def done(reader, scope, card):
        do(reader, scope, card)
        for name in sorted(set(card.options) - KNOWN[card.keyword] - {"TYPE"}):
            idle = name in IDLE.get(card.keyword, ())
            reader.deck.note(card.place, f"*{card.keyword}: option {name}{f', {NOT_NEEDED}' if idle else ' is not understood'}")
    return done


CARDS = {keyword: listed(do) for keyword, do in (
    abaqus_mesh.CARDS | abaqus_sets.CARDS | abaqus_material.CARDS | abaqus_model.CARDS | abaqus_loads.CARDS | abaqus_joined.CARDS |
    abaqus_beams.CARDS | abaqus_connectors.CARDS | abaqus_bolts.CARDS | abaqus_viscous.CARDS |
    abaqus_friction.CARDS).items()}


@dataclass
class Card:
    """A keyword, its options, and its data as pieces of text with the line on which each begins."""
    keyword: str
    options: dict
    place: Place
    pieces: list = field(default_factory=list)

    def rows(self):
        """Place and fields of each line of data."""
        for text, first in self.pieces:
            yield from self.rows_of(text, first)

    def rows_of(self, text, first):
        """The same of one piece."""
        for number, line in enumerate(text.decode("latin-1").split("\n"), first):
            if line.strip():
                fields = [word.strip() for word in line.split(",")]
                yield Place(self.place.file, number), fields[:-1] if len(fields) > 1 and not fields[-1] else fields

    def need(self, name):
        """The value of an option."""
        if not self.options.get(name):
            raise self.place.wrong(f"*{self.keyword} needs {name}=")
        return label(self.options[name])

    def choose(self, name, default, *values):
        """The value of an option that has one of these, in full."""
        value = choice(self.options.get(name) or default, *values)
        if value not in values:
            raise self.place.wrong(f"*{self.keyword}, {name}={self.options[name][:40]}: it is one of {', '.join(values)}")
        return value


def read_header(lines, place):
    """Keyword and options of a line that begins with *, with those that go on it."""
    words = [word.strip() for word in "".join(lines).split(",")]
    keyword = spelled(words[0].lstrip("*"), KEYWORDS)
    options, known = {}, PARAMETERS.get(keyword, {})
    for word in filter(None, words[1:]):
        key, _, value = word.partition("=")
        options[spelled(key, known)] = value.strip()
    return Card(keyword, options, place)


def split_cards(data, file):
    """Cards of a file; comments, which begin with **, divide data into pieces."""
    if b" *" in data or b"\t*" in data:
        data = BLANKS.sub(b"", data)
    at, line, card, cards = 0, 1, None, []
    while at < len(data):
        if data.startswith(b"*", at):
            end = data.find(b"\n", at)
            end = len(data) if end < 0 else end
            text = data[at:end].decode("latin-1")
            step = 1
            if not text.startswith("**"):
                lines = [text]
                while lines[-1].rstrip().endswith(",") and end < len(data) and data[end + 1:end + 2] not in (b"*", b""):
                    begin, end = end + 1, data.find(b"\n", end + 1)
                    end = len(data) if end < 0 else end
                    lines.append(data[begin:end].decode("latin-1"))
                    step += 1
                card = read_header(lines, Place(file, line))
                cards.append(card)
            at, line = end + 1, line + step
            continue
        end = data.find(b"\n*", at)
        end = len(data) if end < 0 else end
        text = data[at:end]
        if card is None and text.strip():
            card = Card("", {}, Place(file, line))
            cards.append(card)
        if card:
            card.pieces.append((text, line))
        at, line = end + 1, line + text.count(b"\n") + 1
    return cards


def read_cards(path, depth=0, last=None):
    """Cards of a file and of those that it includes; `last` holds the one before. Data that follow *INCLUDE, or begin an included
    file, are of the keyword before."""
    last = [None] if last is None else last
    for card in split_cards(read_bytes(path), str(path)):
        if card.keyword == "INCLUDE":
            name = (card.options.get("INPUT") or card.options.get("FILE", "")).strip('"')
            if not name or depth == DEEPEST:
                raise card.place.wrong("*INCLUDE needs INPUT=FILE" if not name else "files include each other too deeply")
            try:
                yield from read_cards(beside(path, name), depth + 1, last)
            except BadInput as error:
                missing = str(error).startswith(f"{beside(path, name)}: ")
                raise card.place.wrong(f"*INCLUDE: {error}") if missing else error
        if (card.keyword == "INCLUDE" or (depth and not card.keyword)) and last[0] is not None:
            yield from more_of(last[0], card)
            continue
        if card.keyword == "INCLUDE":
            continue
        last[0] = card
        if "INPUT" in card.options and card.keyword in ("NODE", "ELEMENT", "NSET", "ELSET"):
            name = card.options.pop("INPUT").strip('"')
            other = beside(path, name)
            card.pieces.append((read_bytes(other), 1))
            card.place = Place(str(other), 1)
        yield card


def more_of(last, card):
    """Data of `card` as those of the keyword before it."""
    if not any(text.strip() for text, _ in card.pieces):
        return
    if last.keyword in ADDED:
        yield Card(last.keyword, dict(last.options), card.place, card.pieces)
    elif last.keyword not in PLAIN | OUTPUT:
        raise card.place.wrong(f"*INCLUDE within the data of *{last.keyword} is not read")


def beside(path, name):
    """A file that another one names."""
    return path.parent / Path(name)


class Scope:
    """What a part, placed as an instance, or the deck itself has names for; places are turned, then shifted."""

    def __init__(self, deck, prefix="", turn=None, shift=None):
        self.deck, self.prefix = deck, prefix
        self.turn = numpy.eye(3) if turn is None else turn
        self.shift = numpy.zeros(3) if shift is None else shift
        self.nodes, self.cells, self.others = Index(), Index(), Index(once=False)
        self.node_sets, self.cell_sets, self.surfaces, self.axes, self.distributions = {}, {}, {}, {}, {}
        self.other_sets = {}  # elsets -> numbers of elements that are no volumes
        self.holders = {}  # numbers of elements of one or two nodes -> (type, nodes, place)
        self.given = set()  # those of masses that have their value

    def full(self, name):
        """The name in the deck."""
        return f"{self.prefix}.{name}" if self.prefix else name


class Reader:
    """The state of reading: scopes, and the material, interaction or step that following cards add to."""

    def __init__(self, path):
        self.deck = Deck(path, "Abaqus or CalculiX")
        self.main, self.instances, self.parts = Scope(self.deck), {}, {}
        self.material = self.interaction = self.changed = None
        self.interactions, self.spring_cards, self.pairs, self.bolts = {}, [], [], []
        self.turned, self.rotations, self.surface_nodes = {}, {}, {}  # node -> its axes (None: unknown); ROT NODE -> REF NODE
        self.connector, self.connectors, self.connector_sections = None, {}, []  # of connectors.py
        self.coupling, self.solid = None, None  # that *KINEMATIC or *DISTRIBUTING follows; which nodes elements have
        self.unplaced = {}  # name of a part without an instance so far -> its place
        self.steps, self.forces, self.pressures, self.gravity = 0, [], [], []  # loads as they come, loads.py
        self.viscous, self.instant = [], set()  # (material, whether a series, rows, place); names of those with fast moduli
        self.clearances, self.fits = [], []  # (slave and master, value or those of nodes, place)
        self.of_bolts = []  # forces of all steps, those that ended too
        self.supports = []  # (step, Support) as they come
        self.temperature, self.amplitudes, self.period = None, {}, 1.0  # (value, place); name -> [n][2]; of the last *STATIC
        self.preload = self.damping = None  # places of the last *STATIC, and of friction damping
        self.global_damping, self.modes_step = [], None  # step, (alpha, beta, loss factor), place; the step of the modes

    def axes_at(self, node):
        """Axes that a node has of its own, or None."""
        return self.turned.get(node)

    def is_solid(self, node):
        """Whether a volume element has a node; elements are all read before."""
        if self.solid is None or len(self.solid) != self.deck.n_nodes:
            self.solid = numpy.zeros(self.deck.n_nodes, bool)
            for block in self.deck.blocks:
                self.solid[block.nodes] = True
        return bool(self.solid[node])

    def split(self, name, scope):
        """Scope and local name of INSTANCE.NAME, which may stand behind ASSEMBLY. too."""
        first, dot, last = name.partition(".")
        if dot and first not in self.instances and last.partition(".")[0] in self.instances:
            first, dot, last = last.partition(".")
        if dot and first in self.instances:
            return self.instances[first], last
        return scope, name

    def run(self, cards):
        """Reads parts and instances, then what stands outside of them."""
        outside, inside, opened = [], None, None
        for card in cards:
            if inside is not None:
                if card.keyword == f"END {opened.keyword}":
                    self.close(opened, inside)
                    inside = None
                elif card.keyword in ("PART", "INSTANCE", "ASSEMBLY", "STEP"):
                    raise card.place.wrong(f"*{card.keyword} before *END {opened.keyword}")
                else:
                    inside.append(card)
            elif card.keyword in ("PART", "INSTANCE"):
                opened, inside = card, []
            else:
                outside.append(card)
        if inside is not None:
            raise opened.place.wrong(f"*{opened.keyword} has no *END {opened.keyword}: is the file cut off?")
        self.check_ends(outside)
        self.replay(outside, self.main)
        return self.finish()

    def check_ends(self, cards):
        """What begins must end."""
        for word in ("STEP", "ASSEMBLY"):
            opened = None
            for card in cards:
                if card.keyword == word:
                    if opened:
                        raise card.place.wrong(f"*{word} before *END {word} of line {opened.place.line}")
                    opened = card
                elif card.keyword == f"END {word}":
                    if not opened:
                        raise card.place.wrong(f"*END {word} without *{word}")
                    opened = None
            if opened:
                raise opened.place.wrong(f"*{word} has no *END {word}: is the file cut off?")

    def close(self, card, inside):
        """Keeps a part, or places an instance."""
        if card.keyword == "PART":
            name = card.need("NAME")
            if name in self.parts:
                raise card.place.wrong(f"part {name} stands twice")
            self.parts[name], self.unplaced[name] = inside, card.place
            return
        name, part = card.need("NAME"), label(card.options.get("PART", ""))
        if name in self.instances:
            raise card.place.wrong(f"instance {name} stands twice")
        if part and part not in self.parts:
            raise card.place.wrong(f"*INSTANCE: there is no part {part}")
        self.instances[name] = Scope(self.deck, name, *motion(card))
        self.unplaced.pop(part, None)
        self.replay([*self.parts.get(part, []), *inside], self.instances[name])

    def replay(self, cards, scope):
        """Does what cards say: nodes and elements first, then sets, then what refers to them."""
        for _, card in sorted(((PHASES.get(card.keyword, 5), card) for card in cards), key=lambda pair: pair[0]):
            do = CARDS.get(card.keyword)
            if do:
                do(self, scope, card)
            elif card.keyword in GEOMETRY:
                raise card.place.wrong(f"*{card.keyword} is not read, and without it the mesh is another: write out all nodes and elements")
            elif card.keyword in OUTPUT:
                self.deck.note(card.place, f"*{card.keyword}: output, {NOT_NEEDED}")
            elif card.keyword in ANALYSES:
                self.deck.note(card.place, f"*{card.keyword}: an analysis, {NOT_NEEDED}")
            elif not card.keyword:
                words = b" ".join(text for text, _ in card.pieces).split() or [b"*"]
                self.deck.note(card.place, f"'{shorter(words[0])}': of no keyword, not taken")
            elif card.keyword not in PLAIN:
                self.deck.note(card.place, f"*{card.keyword}: " + (f"not in the scene; {INSTEAD[card.keyword]}"
                                                                   if card.keyword in INSTEAD else "not understood"))
            if card.keyword in abaqus_material.END_MATERIAL:
                self.material = None

    def finish(self):
        """What needs all of the deck."""
        abaqus_viscous.finish(self)
        abaqus_bolts.finish(self)
        abaqus_loads.finish_loads(self)
        abaqus_connectors.finish(self)
        abaqus_model.finish(self)
        abaqus_bolts.give_gaps(self)
        abaqus_material.finish_sections(self.deck)
        for name, place in self.unplaced.items():
            self.deck.note(place, f"*PART {name}: no *INSTANCE places it, not in the mesh")
        if not self.steps:
            self.deck.note(Place(self.deck.path, 1), "there is no *STEP: is the file whole?")
        for scope in [self.main, *self.instances.values()]:
            scope.nodes.sorted("node")
            scope.cells.sorted("element")
            for number, (kind, _, place) in scope.holders.items():
                if kind in abaqus_joined.NAMED and number not in scope.given:
                    self.deck.note(place, f"*ELEMENT, TYPE={kind}: element {number} has no *{abaqus_joined.NAMED[kind]}")
        return self.deck


def motion(card):
    """Rotation matrix and shift of an instance: moved, then turned about the line from a to b by an angle in degrees."""
    rows = list(card.rows())
    if len(rows) > 2:
        raise rows[2][0].wrong("*INSTANCE has at most two lines of data: a translation and a rotation")
    values = [[real(word or "0", place) for word in fields] for place, fields in rows]
    for (place, _), row, wanted in zip(rows, values, (3, 7)):
        if len(row) != wanted:
            raise place.wrong(f"*INSTANCE: {len(row)} numbers, expected {wanted}")
    shift, turn = numpy.array(values[0] if values else [0.0] * 3), numpy.eye(3)
    if len(values) == 2:
        a, b, angle = numpy.array(values[1][:3]), numpy.array(values[1][3:6]), numpy.radians(values[1][6])
        if not numpy.linalg.norm(b - a) > 0:
            raise rows[1][0].wrong("*INSTANCE: the two points of the axis are the same")
        turn = rotation(b - a, angle)
        shift = turn @ (shift - a) + a
    return turn, shift


def rotation(axis, angle):
    """Matrix of a rotation, rad (Rodrigues)."""
    n = axis / numpy.linalg.norm(axis)
    cross = numpy.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def read_abaqus(path):
    """The deck of a file."""
    reader = Reader(path)
    cards = list(read_cards(path))
    if not any(card.keyword == "NODE" for card in cards):
        raise BadInput(f"{path}:1: there is no *NODE; is this a deck of Abaqus or CalculiX?")
    deck, word = reader.run(cards), half_word(path)
    if word:
        deck.note(cards[-1].place, f"the file ends in '{word}': is it whole?")
    return deck
