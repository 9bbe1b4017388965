"""Record of an impulse in a transient: what the probes and the nodes of the circles do after it, per N s.

What the ramp of the load still does is taken off in one of two ways: by a run without the impulse, sample by sample, or
by the mean of the time before the impulse, when the ramp has decayed. Used by scripts/response.
"""

import csv
from typing import NamedTuple

import numpy

from ..tables import BadInput, read_table, whole
from ..transient.history import Run, read_columns

IMPULSE = {"name": str, "steps_after": float, "steps_changed": float, "pairs_changed": float,
           **dict.fromkeys(["time_s", *(f"{axis}_m" for axis in "xyz"), *(f"impulse_{axis}_n_s" for axis in "xyz")],
                           float)}
NODE = {"node": str, "circle": str, "axis": str, "from_contact": int,
        **dict.fromkeys(["x_m", "y_m", "z_m", "radius_m", "angle_rad"], float)}
STATUS = ("n_open", "n_stick")
QUIET = 0.1  # part of the time before the impulse, at its end, that is the rest by default
STILL = 1e-2  # of the response: motion before the impulse that is told to be too large


class Blow(NamedTuple):
    """Name, time (s), place (m), momentum (N s) along a unit direction; steps after it, how many of these have other
    pairs open or sticking than before it, and how many pairs at most."""
    name: str
    time: float
    place: tuple
    momentum: float
    direction: tuple
    steps: int
    changed: int
    pairs: int


def read_blow(folder):
    """The impulse of a run. Along an axis its direction is positive, and the momentum may be negative."""
    path = folder / "impulses.csv"
    if not path.exists():
        raise BadInput(f"{path}: no such file; the run needs -impulses, and to be finished")
    rows = read_table(path, IMPULSE)
    if len(rows) != 1:
        raise BadInput(f"{path}: has {len(rows)} impulses that acted; one is needed")
    row = rows[0]
    vector = numpy.array([row[f"impulse_{axis}_n_s"] for axis in "xyz"])
    largest = vector[abs(vector).argmax()]
    momentum = numpy.linalg.norm(vector) * (numpy.sign(largest) if (vector != 0).sum() == 1 else 1)
    return Blow(row["name"], row["time_s"], tuple(row[f"{axis}_m"] for axis in "xyz"), momentum,
                tuple(vector / momentum + 0.0), *(int(row[name]) for name in
                                                 ("steps_after", "steps_changed", "pairs_changed")))


def signals_of(folder):
    """Times (s), displacements by output (m), numbers of open and of sticking pairs, of a run."""
    run = Run(folder)
    columns = {f"{probe}_{axis}": run.probe(probe, axis) for probe in run.probes for axis in "xyz"}
    path = folder / "circles.csv"
    if path.exists():
        table = read_columns(path, False, ("time_s",))
        if len(table["time_s"]) != len(run.time):
            raise BadInput(f"{path}: has {len(table['time_s'])} rows, transient.csv {len(run.time)}; of another run?")
        columns |= {name.removesuffix("_m"): values for name, values in table.items() if name != "time_s"}
    if not columns:
        raise BadInput(f"{folder}: records no motion; the run needs -circles or -probes")
    missing = [name for name in STATUS if name not in run.columns]
    if missing:
        raise BadInput(f"{run.path}: no column {missing[0]}")
    return run.time, columns, numpy.array([run.columns[name] for name in STATUS])


def read_nodes(folder):
    """Rows of the circles' nodes by output; none without circles."""
    path = folder / "circle_nodes.csv"
    if not path.exists():
        return {}
    return {f"{row['node']}_{row['axis']}": row for row in read_table(path, NODE)}


class Record:
    """`time` after the impulse (s), `values` [time][output] (m per N s), `names` of the outputs, `nodes` of circles by
    output, `blow`; `words`: what was done, and what must be known of it."""

    def __init__(self, folder, reference=None, start=None, length=None):
        self.folder, self.blow, self.words = folder, read_blow(folder), []
        self.nodes = read_nodes(folder)
        time, columns, status = signals_of(folder)
        self.names = list(columns)
        values = numpy.array(list(columns.values())).T
        step = (time[-1] - time[0]) / (len(time) - 1)
        self.first = int(numpy.searchsorted(time, self.blow.time - 1e-6 * step))
        self.check_length(time, length)
        if reference:
            values = self.subtract(reference, time, values, status)
        else:
            values = self.take_off_rest(time, values, start)
        last = len(time) if length is None else int(numpy.searchsorted(time, self.blow.time + length, "right"))
        self.time = time[self.first:last] - self.blow.time
        self.values = values[self.first:last] / self.blow.momentum

    def check_length(self, time, length):
        """Raises an error for an impulse outside of the record, and for a window longer than it."""
        left = time[-1] - self.blow.time
        if self.first >= len(time) - 16:
            raise BadInput(f"{self.folder}: the impulse at {self.blow.time:.6g} s is at the end of the record, "
                           f"{time[-1]:.6g} s; let the run go on")
        if length is not None and not 0 < length <= left * (1 + 1e-9):
            raise BadInput(f"--length {length:.6g} s is longer than the record, which ends {left:.6g} s after the "
                           "impulse" if length > 0 else f"--length {length:.6g} s must be positive")

    def subtract(self, folder, time, values, status):
        """Without what a run without the impulse does."""
        if (folder / "impulses.csv").exists() and len(read_table(folder / "impulses.csv", IMPULSE)):
            raise BadInput(f"--reference {folder}: has an impulse itself; it must be the same run without it")
        other, columns, states = signals_of(folder)
        n = min(len(time), len(other))
        if abs(other[:n] - time[:n]).max() > 1e-9 * time[-1] or len(other) < len(time):
            raise BadInput(f"--reference {folder}: has other times than {self.folder}; both runs need the same steps, "
                           "rows and end")
        if list(columns) != self.names:
            raise BadInput(f"--reference {folder}: has other -probes or -circles than {self.folder}")
        self.words.append(f"less the run without the impulse, {folder}")
        differ = abs(status - states[:, :len(time)])[:, self.first:]
        self.tell_changes(int(differ.any(axis=0).sum()), differ.shape[1], int(differ.max()), "samples",
                          "in the run without it")
        return values - numpy.array(list(columns.values())).T[:len(time)]

    def take_off_rest(self, time, values, start):
        """Without the mean before the impulse."""
        if start is None:
            start = self.blow.time - QUIET * (self.blow.time - time[0])
        if not time[0] <= start < self.blow.time:
            raise BadInput(f"--from {start:.6g} s must be between the begin of the record, {time[0]:.6g} s, and the "
                           f"impulse, {self.blow.time:.6g} s")
        begin = min(int(numpy.searchsorted(time, start)), max(self.first - 1, 0))
        before = values[begin:max(self.first, begin + 1)]
        rest = before.mean(axis=0)
        after = numpy.sqrt(((values[self.first:] - rest)**2).sum(axis=1)).max()
        still = numpy.sqrt(((before - rest)**2).sum(axis=1)).max() / max(after, 1e-300)
        self.words.append(f"less the mean from {time[begin]:.6g} s to the impulse, when the ramp has decayed: motion "
                          f"there is {still:.1e} of the response"
                          + (", TOO MUCH: give --reference, or a later impulse" if still > STILL else ""))
        self.tell_changes(self.blow.changed, self.blow.steps, self.blow.pairs, "steps", "before it")
        return values - rest

    def tell_changes(self, n, n_all, pairs, unit, than):
        """How often the impulse opened or stuck pairs."""
        self.words.append(
            f"the impulse opens, closes or sticks pairs in {n} of {n_all} {unit} after it, {pairs} at most: the "
            "response is not linear; give a smaller one" if n else
            f"as many pairs are open and stick in all {n_all} {unit} after the impulse as {than}")


def write_rows(path, names, rows):
    """A table; text that holds a comma is quoted."""
    with whole(path) as part, part.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([f"{cell:.15g}" if isinstance(cell, float) else cell for cell in row] for row in rows)
