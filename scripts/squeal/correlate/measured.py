"""What was measured, of universal files and tables: channels (a place and a direction), modes with their shapes at the channels, and
responses per unit force. Places are in m, in the axes of the test until moved() puts them into those of the mesh."""

from dataclasses import dataclass, field

import numpy

from .csv_files import read_csv
from .datasets import read_universal
from ..tables import BadInput

AXES = "xyz"
QUANTITIES = {8: "displacement", 11: "velocity", 12: "acceleration"}  # of dataset 58
ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}
FORCES = 0, 1, 9, 13  # of dataset 58: unknown, general, reaction force, excitation force
UNITS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254}  # m in one


@dataclass
class Channel:
    """One direction of a sensor."""
    name: str
    place: numpy.ndarray
    direction: numpy.ndarray


@dataclass
class Mode:
    """Frequency (Hz), damping ratio or nan, values at the channels or None."""
    name: str
    freq: float
    damping: float
    shape: numpy.ndarray | None


@dataclass
class Response:
    """Displacement per force (m/N) of a channel over frequency (Hz); where and along what the force acts, where that is known."""
    name: str
    channel: Channel | None
    force: Channel | None
    freq: numpy.ndarray
    values: numpy.ndarray


@dataclass
class Measured:
    """All of it; `points`: places by name; `lines`: pairs of names, to be drawn; `said`: what is not in it."""
    channels: list = field(default_factory=list)
    modes: list = field(default_factory=list)
    responses: list = field(default_factory=list)
    points: dict = field(default_factory=dict)
    lines: list = field(default_factory=list)
    said: list = field(default_factory=list)

    def shapes(self):
        """Values [channels][modes] of all modes; None where there are none."""
        shapes = [mode.shape for mode in self.modes]
        return numpy.array(shapes).T if self.channels and shapes and shapes[0] is not None else None

    def moved(self, turn, shift):
        """Puts all places and directions into the axes of the mesh: turn @ x + shift."""
        self.points = {name: turn @ place + shift for name, place in self.points.items()}
        ends = [end for response in self.responses for end in (response.channel, response.force) if end]
        for channel in {id(one): one for one in (*self.channels, *ends)}.values():
            channel.place, channel.direction = turn @ channel.place + shift, turn @ channel.direction


def receptance(quantity, freq, values):
    """Displacement per force of a velocity or acceleration per force; 0 Hz, which has none, is left out."""
    order = ORDERS[quantity]
    kept = freq > 0 if order else slice(None)
    return freq[kept], values[kept] / (2j * numpy.pi * freq[kept])**order


class Gathering:
    """Puts files together. unit: m in a unit of length of the test, None as the files say; quantity: of responses that do not say it."""

    def __init__(self, unit, quantity):
        self.unit, self.quantity, self.to = unit, quantity, Measured()
        self.contents, self.tables = [], []

    def add(self, path):
        """Reads a file."""
        if path.suffix.lower() == ".csv":
            self.tables.append(read_csv(path))
        else:
            self.contents.append(read_universal(path))
            self.to.said += self.contents[-1].said

    def metre(self, contents):
        """m in a unit of length of a file."""
        return self.unit or (1 / contents.factors[0] if contents.factors else 1.0)

    def gather(self):
        """The Measured of all files."""
        axes = {}
        for contents in self.contents:
            scale = self.metre(contents)
            for label, place in contents.nodes.items():
                old = self.to.points.setdefault(str(label), scale * numpy.array(place))
                if not numpy.allclose(old, scale * numpy.array(place), rtol=1e-5, atol=1e-9):
                    raise BadInput(f"{contents.path}: node {label} is at another place in another file")
            axes |= contents.axes
            for _, labels in contents.traces:
                self.to.lines += [(str(a), str(b)) for a, b in zip(labels, labels[1:]) if a and b]
        self.add_shapes([(contents, shape) for contents in self.contents for shape in contents.shapes], axes)
        for contents in self.contents:
            for function in contents.functions:
                self.add_function(contents, function, axes)
        self.add_tables()
        if not self.to.modes and not self.to.responses:
            raise BadInput(f"{', '.join(str(one.path) for one in (*self.contents, *self.tables))}: no mode and no frequency response in it")
        return self.to

    def channel(self, where, node, direction, axes):
        """A direction (1 to 3, negative against it) at a node."""
        name = str(node)
        if name not in self.to.points:
            raise BadInput(f"{where}: node {node} has no place in datasets 15 and 2411")
        along = numpy.sign(direction) * axes.get(node, numpy.eye(3))[abs(direction) - 1]
        return Channel(f"{name}{'-' if direction < 0 else ''}{AXES[abs(direction) - 1]}", self.to.points[name], along)

    def add_shapes(self, shapes, axes):
        """Modes of dataset 55: a direction that is 0 in all of them was not measured."""
        labels = sorted({label for _, shape in shapes for label in shape.values})
        if not labels:
            self.to.modes += [Mode(shape.title or f"mode {k + 1}", shape.freq, shape.damping, None) for k, (_, shape) in enumerate(shapes)]
            return
        none = numpy.zeros(3)
        values = numpy.array([[shape.values.get(label, none) for label in labels] for _, shape in shapes])
        moves = abs(values).max(axis=0) > 0
        if not moves.all():
            self.to.said.append(f"{shapes[0][1].where}: {(~moves).sum()} of {moves.size} directions are 0 in all shapes: not measured")
        empty = [shape for (_, shape), row in zip(shapes, values) if not row.any()]
        if empty:
            raise BadInput(f"{empty[0].where}: the shape is 0 everywhere")
        where = shapes[0][1].where
        self.to.channels = [self.channel(where, label, k + 1, axes) for label, row in zip(labels, moves) for k in numpy.flatnonzero(row)]
        for k, (_, shape) in enumerate(shapes):
            self.to.modes.append(Mode(f"{k + 1}", shape.freq, shape.damping, values[k][moves]))

    def add_function(self, contents, function, axes):
        """A frequency response of dataset 58."""
        quantity = QUANTITIES.get(function.numerator, self.quantity)
        directions = function.response[1], function.reference[1]
        if quantity is None:
            raise BadInput(f"{function.where}: does not say what is measured (type {function.numerator}); give --quantity displacement, "
                           f"velocity "
                           "or acceleration")
        if function.denominator not in FORCES or not 1 <= abs(directions[0]) <= 3 or abs(directions[1]) > 3:
            self.to.said.append(f"{function.where}: per quantity {function.denominator} in directions {directions}: no motion per force, "
                                f"left out")
            return
        length, force = contents.factors or (1.0, 1.0)
        freq, values = receptance(quantity, function.freq, function.values * (force / length))
        known = str(function.reference[0]) in self.to.points and directions[1]
        self.to.responses.append(Response(
            f"{function.response[0]}{'-' if directions[0] < 0 else ''}{AXES[abs(directions[0]) - 1]}",
            self.channel(function.where, *function.response, axes),
            self.channel(function.where, *function.reference, axes) if known else None, freq, values))

    def add_tables(self):
        """Sensors, modes and responses of tables."""
        sensors = {}
        for table in self.tables:
            for name, (place, direction) in table.sensors.items():
                if name in sensors:
                    raise BadInput(f"{table.path}: sensor {name} stands twice")
                sensors[name] = Channel(name, (self.unit or 1.0) * place, direction)
                self.to.points[name] = sensors[name].place
        for table in self.tables:
            absent = [name for name in table.names if name not in sensors]
            if absent:
                raise BadInput(f"{table.path}: column {absent[0]}: no sensor of that name; sensors are in a table with columns "
                               f"sensor,x,y,z,"
                               "direction_x,direction_y,direction_z")
            if table.modes and self.to.modes:
                raise BadInput(f"{table.path}: modes stand in two files; give one")
            if table.names:
                self.to.channels = [sensors[name] for name in table.names]
            self.to.modes += [Mode(name or f"{k + 1}", freq, damping, shape) for k, (name, freq, damping, shape) in enumerate(table.modes)]
            for name, quantity, values in table.responses:
                self.to.responses.append(Response(name, sensors.get(name), None, *receptance(quantity, table.freq, values)))


def read_measured(paths, unit, quantity):
    """All of some files."""
    gathering = Gathering(unit and UNITS[unit], quantity)
    for path in paths:
        gathering.add(path)
    return gathering.gather()
