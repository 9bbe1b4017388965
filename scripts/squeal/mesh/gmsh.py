"""Meshes that the program gmsh makes of the scripts of options/ and others, and what stands in its files, in text."""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

from ..run.program import ROOT
from ..tables import BadInput, regular

TRI6, TET10, QUAD8, HEX20 = 9, 11, 16, 17  # numbers of types
FOLDED = "Failed to reach critical value"
FACTORS = 1, 1, 0.98, 0.96, 0.94  # of sizes, where a mesh has folded elements
DIMENSION = {15: 0, 1: 1, 8: 1} | dict.fromkeys((2, 3, TRI6, 10, QUAD8), 2)  # of others 3


def run_gmsh(script, path, *options, form="msh41", dimension=3):
    """Has gmsh mesh a script into a file; what it calls an error is one. A mesh in which curved elements stay folded is made again, as
    meshes differ from run to run, then of smaller elements, which is said."""
    for factor in FACTORS:
        words = ["gmsh", f"-{dimension}", "-format", form, script, "-o", path, *options]
        if factor != 1:
            words += ["-setnumber", "Mesh.MeshSizeFactor", factor]
            print(f"{Path(script).name}: curved elements stay folded; meshed again with all sizes times {factor}", file=sys.stderr)
        try:
            done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
        except OSError:
            raise BadInput("gmsh cannot be run: apt-get install gmsh") from None
        errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error") and "---" not in line]
        if not any(FOLDED in error for error in errors):
            break
    if done.returncode or errors:
        raise BadInput(f"gmsh {script}: {errors[0] if errors else done.stderr.strip()}")


def make_mesh(name, path, form="msh41", **numbers):
    """Has gmsh mesh options/NAME.geo into a file, with numbers of the script set."""
    options = [word for key, value in numbers.items() for word in ("-setnumber", key, value)]
    run_gmsh(ROOT / f"options/{name}.geo", path, *options, form=form)


def as_text(path, folder):
    """The file itself where it is of format 2.2 in text, else one in `folder` that gmsh makes of it."""
    try:
        with regular(path).open("rb") as file:
            head = file.read(64)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from None
    if not head.startswith(b"$MeshFormat"):
        raise BadInput(f"{path}: is no file of Gmsh")
    if head.split()[1:3] == [b"2.2", b"0"]:
        return path
    made = folder / "text.msh"
    run_gmsh(path, made, form="msh22", dimension=0)
    return made


def sections(path):
    """Words of each section of a file, line by line."""
    found, name = {}, None
    for line in path.read_text().splitlines():
        if line.startswith("$"):
            name = None if line.startswith("$End") else line[1:]
            found.setdefault(name, [])
        else:
            found[name].append(line.split())
    return found


def names_of(part):
    """(dimension, number) -> name of a physical group."""
    return {(int(d), int(tag)): name.strip('"') for d, tag, name in part["PhysicalNames"][1:]}


def read_22(part):
    """Places by node number, and (name of the group, type, nodes) of each element."""
    nodes = {int(number): place for number, *place in part["Nodes"][1:]}
    name = names_of(part)
    elements = []
    for row in part["Elements"][1:]:
        _, kind, n_tags, group, *rest = map(int, row)
        if (DIMENSION.get(kind, 3), group) in name:
            elements.append((name[DIMENSION.get(kind, 3), group], kind, rest[n_tags - 1:]))
    return nodes, elements


def read_41(part):
    """The same; an entity's line ends, after its box, with its groups and its boundary."""
    counts, *rows = part["Entities"]
    name, group = names_of(part), {}
    rows = rows[int(counts[0]) + int(counts[1]):]
    for i, row in enumerate(rows):
        dimension = 2 if i < int(counts[2]) else 3
        group |= {(dimension, int(row[0])): name[dimension, int(tag)] for tag in row[8:8 + int(row[7])]}
    nodes, elements, rows = {}, [], iter(part["Nodes"][1:])
    for row in rows:
        numbers = [int(next(rows)[0]) for _ in range(int(row[3]))]
        nodes |= {number: next(rows) for number in numbers}
    rows = iter(part["Elements"][1:])
    for dimension, tag, kind, count in (map(int, row) for row in rows):
        elements += [(group[dimension, tag], kind, list(map(int, next(rows)[1:]))) for _ in range(count)]
    return nodes, elements


def read_mesh(path):
    """Places [n][3], m, and by (name, type) the nodes of each element, from 0."""
    part = sections(path)
    nodes, elements = (read_41 if part["MeshFormat"][0][0] == "4.1" else read_22)(part)
    index = numpy.zeros(max(nodes) + 1, int)
    index[list(nodes)] = numpy.arange(len(nodes))
    sets = {}
    for name, kind, corners in elements:
        sets.setdefault((name, kind), []).append(corners)
    return numpy.array(list(nodes.values()), float), {key: index[numpy.array(rows)] for key, rows in sets.items()}


def read_any(path):
    """The same of any file of Gmsh, in text or binary, by gmsh where it is not of format 2.2 in text; a damaged one is one line."""
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        text = as_text(path, Path(folder))
        try:
            part = sections(text)
            for name in ("Nodes", "Elements"):
                if len(part[name]) != 1 + int(part[name][0][0]) or f"$End{name}" not in text.read_text():
                    raise BadInput(f"{path}: has not as many lines of ${name} as it says; was the file cut off?")
            return read_mesh(text)
        except (KeyError, ValueError, IndexError, TypeError):
            raise BadInput(f"{path}: cannot be read; was the file damaged?") from None
