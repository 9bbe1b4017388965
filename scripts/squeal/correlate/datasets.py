"""Datasets of a universal file that a correlation needs: 15 and 2411 nodes, 82 trace lines, 55 and 2414 shapes, 58 functions, 164 units.
A universal file keeps a length of L m as length factor times L, hence values are divided by the factors of dataset 164."""

from dataclasses import dataclass, field
from functools import partial

import numpy

from .shapes import shape_55, shape_2414
from .systems import CYLINDRICAL, systems_18, systems_2420
from .universal import HEAD_58, datasets, integers, reals, shown, words
from ..tables import BadInput

FRF = 4  # of dataset 58: type of a function
NAMES = {151: "header", 1858: "qualifiers of functions", 2400: "model header", 2412: "elements", 2429: "groups",
         2435: "groups", 2467: "groups", 2477: "groups"}
FUNCTIONS = {0: "unknown", 1: "time response", 2: "auto spectrum", 3: "cross spectrum", 5: "transmissibility", 6: "coherence",
             9: "power spectral density", 12: "spectrum"}


@dataclass
class Function:
    """A frequency response: (node, direction) of the response and of the force, what is measured, frequencies, values."""
    where: str
    title: str
    response: tuple
    reference: tuple
    numerator: int
    denominator: int
    freq: numpy.ndarray
    values: numpy.ndarray


@dataclass
class Contents:
    """All of a file: places of nodes and, where they are not those of space, their directions, by label; `said`: a line for each
    thing that is not in it."""
    path: object
    nodes: dict = field(default_factory=dict)
    axes: dict = field(default_factory=dict)
    traces: list = field(default_factory=list)
    shapes: list = field(default_factory=list)
    functions: list = field(default_factory=list)
    factors: tuple | None = None  # of length and force
    said: list = field(default_factory=list)


class Reader:
    """Puts the datasets of a file into its Contents."""

    def __init__(self, path):
        self.path, self.to, self.left, self.systems, self.systems_of = path, Contents(path), {}, {}, {}

    def wrong(self, line, what):
        """The error to raise."""
        return BadInput(f"{self.path}:{line}: {what}")

    def add_node(self, line, label, place, systems):
        """A node, which may stand twice only at the same place."""
        if label < 1:
            raise self.wrong(line, f"node {label}: labels begin with 1")
        if label in self.to.nodes and (self.to.nodes[label], self.systems_of[label]) != (place, systems):
            raise self.wrong(line, f"node {label} stands twice, at two places or in two coordinate systems")
        self.to.nodes[label], self.systems_of[label] = place, systems

    def nodes_15(self, data):
        """Label, two coordinate systems, colour, place, in a line."""
        for k, line in enumerate(data.lines, data.line):
            head, place = integers(line[:40], 4), reals(line[40:])
            if head is None or place is None or len(place) != 3:
                raise self.wrong(k, f"{shown(line)} is no node of dataset 15: four whole numbers and three coordinates")
            self.add_node(k, head[0], tuple(place.tolist()), tuple(head[1:3]))

    def nodes_2411(self, data):
        """The same in two lines."""
        if len(data.lines) % 2:
            raise self.wrong(data.line, f"dataset 2411 has {len(data.lines)} lines, two to a node; is one missing?")
        for k in range(0, len(data.lines), 2):
            head, place = integers(data.lines[k], 4), reals(data.lines[k + 1])
            if head is None:
                raise self.wrong(data.line + k, f"{shown(data.lines[k])} is no head of a node: four whole numbers")
            if place is None or len(place) != 3:
                raise self.wrong(data.line + k + 1, f"{shown(data.lines[k + 1])} is not three coordinates")
            self.add_node(data.line + k, head[0], tuple(place.tolist()), (0, head[2]))

    def traces_82(self, data):
        """Pieces of a line through nodes; 0 lifts the pen."""
        head = integers(data.lines[0], 3) if len(data.lines) > 1 else None
        labels = [integers(line) for line in data.lines[2:]]
        if head is None or None in labels:
            bad = 0 if head is None else 2 + labels.index(None)
            raise self.wrong(data.line + bad, f"{shown(data.lines[bad]) if data.lines else 'nothing'} is not whole numbers of a trace line")
        labels = [label for row in labels for label in row]
        while len(labels) > head[1] and not labels[-1]:  # the last line is filled up
            labels.pop()
        if len(labels) != head[1]:
            raise self.wrong(data.line, f"the trace line states {head[1]} nodes and has {len(labels)}")
        self.to.traces.append((data.line, labels))

    def systems_all(self, data):
        """Coordinate systems of the file."""
        for label, system in (systems_18 if data.number == 18 else systems_2420)(self, data):
            if system.kind > CYLINDRICAL:
                self.leave(f"coordinate system {label} of type {system.kind}", data.line)
            else:
                self.systems[label] = system

    def turn_nodes(self):
        """Places of space, and the directions of each node."""
        absent = set()
        for label, (placed, moving) in self.systems_of.items():
            absent |= {system for system in (placed, moving) if system > 1} - set(self.systems)
            if placed in self.systems:
                self.to.nodes[label] = self.systems[placed].place(self.to.nodes[label])
            if moving in self.systems:
                self.to.axes[label] = self.systems[moving].directions(self.to.nodes[label])
        if absent:
            some = ", ".join(map(str, sorted(absent)[:5])) + (f" and {len(absent) - 5} more" if len(absent) > 5 else "")
            self.to.said.append(f"{self.path}: nodes are in coordinate systems {some}, which are not read: taken as that of space")

    def units_164(self, data):
        """Factors of length and force."""
        factors = reals(b" ".join(data.lines[1:]))
        if factors is None or not 3 <= len(factors) <= 4 or not (factors[:2] > 0).all():
            raise self.wrong(data.line, "dataset 164 must have a line of words, then three factors above 0 and an offset")
        self.to.factors = tuple(factors[:2].tolist())

    def function_58(self, data):
        """A frequency response; other functions are left out with a line."""
        if len(data.lines) < HEAD_58:
            raise self.wrong(data.line, f"dataset 58 has {HEAD_58} lines before its numbers, here are {len(data.lines)}")
        ends = self.ends_58(data)
        form = self.form_58(data)
        values = self.raw_58(data, *form) if data.raw is not None else self.text_58(data, *form)
        kinds = [integers(line[:10], 1) for line in data.lines[7:10]]
        if None in kinds:
            bad = 7 + kinds.index(None)
            raise self.wrong(data.line + bad, f"{shown(data.lines[bad])} does not begin with the type of an axis")
        if ends[0] != FRF:
            return self.leave(f"function of type {ends[0]} ({FUNCTIONS.get(ends[0], 'other')})", data.line)
        freq, values = self.axes_58(data, form, values)
        return self.to.functions.append(Function(
            f"{self.path}:{data.line}", words(data.lines[0]), *ends[1:], kinds[1][0], kinds[2][0], freq, values))

    def ends_58(self, data):
        """Type of the function, node and direction of response and reference."""
        line, found = data.lines[5], None
        if len(line) >= 75:
            found = integers(line[:30]), integers(line[41:55]), integers(line[66:80])
        if not found or None in found or [len(part) for part in found] != [4, 2, 2]:
            text = line.split()
            found = None if len(text) != 10 else tuple(integers(b" ".join(text[a:b])) for a, b in ((0, 4), (5, 7), (8, 10)))
        if not found or None in found or max(abs(found[1][1]), abs(found[2][1])) > 6:
            raise self.wrong(data.line + 5, f"{shown(line)}: must be the type of the function, then name, node and direction of response "
                             f"and force")
        return found[0][0], tuple(found[1]), tuple(found[2])

    def form_58(self, data):
        """Type of the numbers, how many, whether even, first and step."""
        line, head = data.lines[6], integers(data.lines[6][:30], 3)
        rest = reals(data.lines[6][30:])
        if head is None or rest is None or not 2 <= len(rest) <= 3 or head[0] not in (2, 4, 5, 6) or head[1] < 1 or head[2] not in (0, 1):
            raise self.wrong(data.line + 6, f"{shown(line)}: must be a type of numbers (2, 4, 5, 6), how many, 0 or 1, and two or three "
                             f"numbers")
        if head[2] == 1 and not rest[1] > 0:
            raise self.wrong(data.line + 6, f"the step of the axis is {rest[1]:g}, must be above 0")
        return (*head, rest[0], rest[1])

    def text_58(self, data, form, count, even, *_):
        """Numbers of text."""
        wanted = count * ((2 if form > 4 else 1) + (not even))
        lines = data.lines[HEAD_58:]
        found = reals(b"\n".join(lines))
        if found is None:
            bad = next(k for k, line in enumerate(lines) if reals(line) is None)
            raise self.wrong(data.line + HEAD_58 + bad, f"{shown(lines[bad])}: a number is none, or not finite")
        if len(found) != wanted:
            raise self.wrong(data.line, f"dataset 58 has {len(found)} numbers, its seventh line states {wanted}")
        return found

    def raw_58(self, data, form, count, even, *_):
        """Binary numbers: the axis, where it is uneven, has single precision with single values, else double."""
        size = 4 if form in (2, 5) else 8
        wanted = count * ((2 if form > 4 else 1) + (not even)) * size
        if len(data.raw) != wanted:
            raise self.wrong(data.line + 6, f"states {count} values of type {form}, {wanted} bytes; dataset 58b has {len(data.raw)}")
        found = numpy.frombuffer(data.raw, f"{data.kind[0]}f{size}").astype(float)
        if not numpy.isfinite(found).all():
            at = data.at + size * int(numpy.argmin(numpy.isfinite(found)))
            raise BadInput(f"{self.path}: byte {at}: a number of dataset 58b is not finite")
        return found

    def axes_58(self, data, form, values):
        """Frequencies and complex values."""
        kind, count, even, first, step = form
        if even:
            freq = first + step * numpy.arange(count)
        else:
            table = values.reshape(count, -1)
            freq, values = table[:, 0].copy(), table[:, 1:].ravel()
        if kind > 4:
            values = values[::2] + 1j * values[1::2]
        if count > 1 and not (numpy.diff(freq) > 0).all() or freq[0] < 0:
            raise self.wrong(data.line + 6, "frequencies must rise from 0 or above")
        return freq, values + 0j

    def leave(self, what, line):
        """Something that is not in the contents."""
        self.left.setdefault(what, []).append(line)

    def read(self):
        """All of it."""
        known = {15: self.nodes_15, 2411: self.nodes_2411, 82: self.traces_82, 55: partial(shape_55, self),
                 2414: partial(shape_2414, self), 58: self.function_58, 164: self.units_164, 18: self.systems_all, 2420: self.systems_all}
        for data in datasets(self.path):
            if data.number in known:
                known[data.number](data)
            else:
                self.leave(f"dataset {data.number} ({NAMES.get(data.number, 'not understood')})", data.line)
        for line, labels in self.to.traces:
            absent = [label for label in labels if label and label not in self.to.nodes]
            if absent and self.to.nodes:
                raise self.wrong(line, f"the trace line names node {absent[0]}, which is not there")
        self.turn_nodes()
        self.to.said += [f"{self.path}:{lines[0]}: {what} {f'and {len(lines) - 1} more ' if len(lines) > 1 else ''}left out"
                         for what, lines in self.left.items()]
        return self.to


def read_universal(path):
    """The Contents of a file."""
    return Reader(path).read()
