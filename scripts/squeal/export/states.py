"""The states of a result folder, one at a time: shapes of modes, modal filters, the sliding state, snapshots."""

import re
from dataclasses import dataclass, field

import numpy

from ..mesh.bodies import opened, sound
from ..mesh.cells import read_cells
from ..tables import BadInput, header, read_table
from ..transient.history import snapshots

VERSION = 1, 0  # of VTKHDF, which squeal writes
MODE = re.compile(r"mode_(\d+)_(\w+)")
NAMES = {"re": "displacement_re", "im": "displacement_im"}  # of a mode's arrays; those of a filter keep theirs
NUMBERS = "freq_hz", "growth_rad_s", "damping_ratio", "error_hz"  # columns of modes.csv that go with a shape


@dataclass
class Grid:
    """Points [n][3]; by VTK's type the numbers of its cells and their nodes [...][nodes]; part of each cell, and names."""
    points: numpy.ndarray
    cells: dict
    part: numpy.ndarray
    names: list


@dataclass
class State:
    """Arrays at the nodes, [n] or [n][3], with what is known of them: a series, its value (number of the mode, or s),
    the title, and numbers by name."""
    grid: Grid
    series: str
    name: str
    value: float
    title: str
    arrays: dict
    facts: dict = field(default_factory=dict)

    def is_complex(self):
        """Whether some displacement has an imaginary part."""
        return "displacement_im" in self.arrays and bool(self.arrays["displacement_im"].any())


def read_grid(file):
    """The mesh of a file, if it is squeal's."""
    group = file["VTKHDF"]
    version = tuple(int(number) for number in group.attrs["Version"])
    if version != VERSION:
        raise BadInput(f"{file.filename}: is VTKHDF {'.'.join(map(str, version))}, must be "
                       f"{'.'.join(map(str, VERSION))} as squeal writes it")
    points = sound(file.filename, "Points", group["Points"][:])
    offsets, nodes = group["Offsets"][:], group["Connectivity"][:]
    if (numpy.diff(offsets) <= 0).any() or offsets[0] or offsets[-1] != len(nodes) or nodes.min() < 0 or nodes.max() >= len(points):
        raise BadInput(f"{file.filename}: cells name nodes that are not there; was the file damaged?")
    part = group["CellData/part"]
    names = [name.decode() for name in part.attrs["names"]]
    if not len(part) == len(group["Types"]) == len(offsets) - 1 or (part[:] < 0).any() or (part[:] >= len(names)).any():
        raise BadInput(f"{file.filename}: types, parts and nodes of its cells do not fit together; was the file damaged?")
    return Grid(points, read_cells(group), part[:], names)


def values(file, key, n_points):
    """An array of a file and its title, without the mode's number in front."""
    data = file["VTKHDF/PointData"][key]
    if len(data) != n_points:
        raise BadInput(f"{file.filename}: array {key} has {len(data)} rows for {n_points} nodes; was the file damaged?")
    title = data.attrs.get("title", b"")
    title = title.decode() if isinstance(title, bytes) else str(title)
    return sound(file.filename, key, data[:]), title


def mode_facts(folder):
    """Rows of modes.csv by number, where there is one."""
    path = folder / "modes.csv"
    if not path.exists():
        return {}
    kinds = {"mode": int, **{name: float for name in NUMBERS if name in header(path)}}
    return {row["mode"]: {name: value for name, value in row.items() if name != "mode"} for row in read_table(path, kinds)}


def mode_states(path, series, wanted, facts):
    """One state for each mode of modes.h5 or filters.h5, or for those that are wanted."""
    with opened(path) as file:
        grid, keys = read_grid(file), {}
        for key in file["VTKHDF/PointData"]:
            match = MODE.fullmatch(key)
            if match:
                other = match[2] if series == "modes" else f"filter_{match[2]}"
                keys.setdefault(int(match[1]), []).append((key, NAMES.get(match[2], other)))
        missing = [mode for mode in wanted if mode not in keys]
        if missing:
            raise BadInput(f"{path}: no shape of mode {missing[0]}; it has {len(keys)}, see modes.csv")
        for mode in sorted(wanted or keys):
            state = State(grid, series, f"{series}_{mode:03d}", mode, "", {}, {"mode": mode, **facts.get(mode, {})})
            for key, name in sorted(keys[mode]):
                state.arrays[name], state.title = values(file, key, len(grid.points))
            yield state


def single_state(path, series, name, value, facts):
    """The state of a file with one, with all its arrays."""
    with opened(path) as file:
        state = State(read_grid(file), series, name, value, "", {}, facts)
        for key in file["VTKHDF/PointData"]:
            state.arrays[key], state.title = values(file, key, len(state.grid.points))
    return state


def read_states(folder, wanted=()):
    """All states of a folder, one after the other; modes may be chosen by number. A folder that is missing is told at once, before
    anything is written."""
    if not folder.is_dir():
        raise BadInput(f"{folder}: no such folder; name an -output_dir of squeal")
    return states_of(folder, wanted)


def states_of(folder, wanted):
    """The same of a folder that there is, as a generator."""
    facts, n_states = mode_facts(folder), 0
    for series in ("modes", "filters"):
        path = folder / f"{series}.h5"
        if path.exists():
            for state in mode_states(path, series, wanted, facts):
                n_states += 1
                yield state
    if wanted and not n_states:
        raise BadInput(f"{folder}: has no modes.h5, in which mode {wanted[0]} would be")
    if (folder / "static.h5").exists() and not wanted:
        n_states += 1
        yield single_state(folder / "static.h5", "static", "static", 0.0, {})
    for k, (time, path) in enumerate([] if wanted else snapshots(folder)):
        n_states += 1
        yield single_state(path, "transient", path.stem, float(k) if time is None else time, {} if time is None else {"time_s": time})
    if not n_states:
        raise BadInput(f"{folder}: has no fields: none of modes.h5, filters.h5, static.h5, snapshot_*.h5; was it run with "
                       "-output_fields 0?")
