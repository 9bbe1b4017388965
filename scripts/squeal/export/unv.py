"""UNV: universal files of text, which programs for modal analysis and many meshers read. Datasets 164 units, 2411 nodes, 2412
elements, 2467 the parts as groups, 55 fields at the nodes. Columns are fixed; 55 has six digits, hence the title of a state
carries frequency and growth in full. Reference: SDRC universal file formats, as the University of Cincinnati lists them."""

import math

import numpy

from ..tables import whole

# Type of VTK -> number of the element in UNV, and its nodes in UNV's order, corners and middles in turn around each face
ELEMENTS = {10: (111, range(4)), 24: (118, (0, 4, 1, 5, 2, 6, 7, 8, 9, 3)),
            13: (112, range(6)), 26: (113, (0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11)),
            12: (115, range(8)), 25: (116, (0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15))}
HEX27, HEX20 = 29, 25
STATIC, NORMAL, COMPLEX, TRANSIENT = 1, 2, 3, 4  # analyses of dataset 55
SCALAR, VECTOR = 1, 2
KINDS = {"displacement": 8, "velocity": 11, "contact_force": 9, "contact_pressure": 15}  # what a field is, 0: unknown
LINE = 80


def lines_of(format_one, rows, stream):
    """Writes rows of numbers, some thousands at a time."""
    for first in range(0, len(rows), 4096):
        some = rows[first:first + 4096]
        stream.write(format_one * len(some) % tuple(some.ravel().tolist()))


def dataset(number, stream):
    """Begins one."""
    stream.write(f"{-1:6d}\n{number:6d}\n")


def end(stream):
    """Ends it."""
    stream.write(f"{-1:6d}\n")


def write_units(metre, stream):
    """Code, description and temperature mode; what a metre, a newton and a kelvin are in the units of the file. metre: 1 or 1e3."""
    code, words = (1, "SI: m, N, kg") if metre == 1 else (10, "MN: mm, N, t")
    dataset(164, stream)
    stream.write(f"{code:10d}{words:<20}{2:10d}\n{metre:25.17E}" + 2 * f"{1.0:25.17E}" + f"\n{0.0:25.17E}\n")
    end(stream)


def write_nodes(points, stream):
    """Numbered from 1."""
    dataset(2411, stream)
    numbered = numpy.column_stack([numpy.arange(1.0, len(points) + 1), points])
    lines_of(f"%10d{1:10d}{1:10d}{11:10d}\n%25.16E%25.16E%25.16E\n", numbered, stream)
    end(stream)


def write_elements(grid, stream):
    """Numbered as the cells, from 1; material and colour are those of the part."""
    dataset(2412, stream)
    for kind, (number, nodes) in sorted(grid.cells.items()):
        code, order = ELEMENTS[HEX20 if kind == HEX27 else kind]
        width = len(order)
        head = f"%10d{code:10d}{1:10d}%10d%10d{width:10d}\n"
        rows = "".join("%10d" * len(order[k:k + 8]) + "\n" for k in range(0, width, 8))
        part = grid.part[number] + 1
        lines_of(head + rows, numpy.column_stack([number + 1, part, part, nodes[:, list(order)] + 1]), stream)
    end(stream)


def write_groups(grid, stream):
    """Elements of each part."""
    dataset(2467, stream)
    for i, name in enumerate(grid.names):
        mine = numpy.flatnonzero(grid.part == i) + 1
        stream.write("".join(f"{value:10d}" for value in (i + 1, 0, 0, 0, 0, 0, 0, len(mine))) + f"\n{name[:20]:<20}\n")
        entries = [f"{8:10d}{number:10d}{0:10d}{0:10d}" for number in mine]
        stream.writelines("".join(entries[k:k + 2]) + "\n" for k in range(0, len(entries), 2))
    end(stream)


def analysis_lines(state):
    """Which analysis it is, and the two records of what belongs to it: integers, reals."""
    growth, omega = state.facts.get("growth_rad_s", 0.0), 2 * math.pi * state.facts.get("freq_hz", 0.0)
    number = int(state.value)
    if state.series in ("modes", "filters") and (growth or state.is_complex() or state.series == "filters"):
        return COMPLEX, (2, 6, 1, number), (growth, omega, 0.0, 0.0, 0.0, 0.0)
    if state.series == "modes":
        return NORMAL, (2, 4, 1, number), (state.facts.get("freq_hz", 0.0), 0.0, 0.0, 0.0)
    if state.series == "transient":
        return TRANSIENT, (2, 1, 1, int(state.name.rpartition("_")[2]) + 1), (state.value,)
    return STATIC, (1, 1, 1), (0.0,)


def title_lines(state, name):
    """Five lines: what it is, numbers in full, the array."""
    facts = ", ".join(f"{key} {value!r}" for key, value in state.facts.items() if key in ("mode", "freq_hz", "growth_rad_s", "time_s"))
    return [state.title or state.name, facts or "NONE", name, "NONE", "NONE"]


def write_field(state, name, array, stream):
    """Dataset 55 of an array [n] or [n][3], real or complex."""
    analysis, integers, reals = analysis_lines(state)
    flat = array.reshape(len(array), -1)
    what = next((code for begin, code in KINDS.items() if name.startswith(begin)), 0)
    head = (1, analysis, VECTOR if flat.shape[1] == 3 else SCALAR, what, 5 if numpy.iscomplexobj(flat) else 2, flat.shape[1])
    dataset(55, stream)
    stream.writelines(line[:LINE] + "\n" for line in title_lines(state, name))
    stream.write("".join(f"{value:10d}" for value in head) + "\n" + "".join(f"{value:10d}" for value in integers) + "\n")
    stream.write("".join(f"{value:13.5E}" for value in reals) + "\n")
    if numpy.iscomplexobj(flat):
        flat = numpy.stack([flat.real, flat.imag], axis=2).reshape(len(flat), -1)
    flat = numpy.where(abs(flat) < 1e-99, 0.0, flat)
    lines_of("%10d\n" + "%13.5E" * flat.shape[1] + "\n", numpy.column_stack([numpy.arange(1.0, len(flat) + 1), flat]), stream)
    end(stream)


def fields_of(state):
    """Name and array of each field: a real and an imaginary array are one complex field, of a mode or filter where it is one."""
    for name, array in state.arrays.items():
        stem = name.removesuffix("_re")
        if name.endswith("_im") and name.removesuffix("_im") + "_re" in state.arrays:
            continue
        other = state.arrays.get(f"{stem}_im") if stem != name else None
        if other is not None and analysis_lines(state)[0] == COMPLEX:
            yield stem, array + 1j * other
        else:
            yield stem if other is not None else name, array


def write_unv(states, path, metre=1.0):
    """All states of one mesh in one file, in whose unit of length a metre is so many; returns what could not be said in it."""
    said, grid = [], None
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as temporary, temporary.open("w", encoding="utf-8") as stream:
        for state in states:
            if grid is None:
                grid = state.grid
                write_units(metre, stream)
                write_nodes(grid.points, stream)
                write_elements(grid, stream)
                write_groups(grid, stream)
                if HEX27 in grid.cells:
                    said.append(f"{len(grid.cells[HEX27][0])} hex27 are written as hex20, since UNV has none of 27 nodes; all nodes "
                                "and their fields are there")
                said += [f"part {name}: its name is cut to 20 characters" for name in grid.names if len(name) > 20]
            for name, array in fields_of(state):
                write_field(state, name, array, stream)
    return said
