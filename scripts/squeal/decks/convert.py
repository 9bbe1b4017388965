"""From a file to a mesh and a scene."""

import re
from pathlib import Path

import numpy

from ..tables import BadInput, printable
from .abaqus.read import read_abaqus
from .alone import leave_alone
from .ansys.read import read_ansys
from .assemble import assemble, give_sections, model_size
from .balance import compared, of_deck
from .friction import table_text
from .joined.entries import write_equations
from ..mesh.petsc_matrix import write_matrix
from .mesh.faces import surface_nodes
from .mesh.gmsh_file import write_mesh
from .mesh.meshes import MED, read_meshes
from .nastran.read import read_nastran
from .mesh.orientation import set_orientation
from .mesh.shells import solidify
from .scene_file import remarks, scene_lines, write_scene
from .units import guess, named
from .written import of_scene

READERS = {".inp": read_abaqus, ".bdf": read_nastran, ".nas": read_nastran, ".dat": read_nastran,
           ".cdb": read_ansys, **dict.fromkeys(MED, read_meshes), ".vtk": read_meshes, ".vtu": read_meshes}


# Endings that decks of several programs have, and what only those of a program have at the beginning of a line, with a word of it
SHARED = (".dat", ".inp")
SIGNS = ((read_ansys, b"nblock", re.compile(rb"^[ \t]*nblock[ \t]*,", re.IGNORECASE | re.MULTILINE)),
         (read_abaqus, b"*", re.compile(rb"^[ \t]*\*[ \t]*(?:heading|node|part|include)\b", re.IGNORECASE | re.MULTILINE)),
         (read_nastran, b"", re.compile(rb"^[ \t]*(?:grid[ *\t,]|begin[ \t]+bulk|cend\b)", re.IGNORECASE | re.MULTILINE)))


def reader_of(path):
    """Who reads a file: by its ending, and by its content where several programs have this ending."""
    if path.suffix.lower() in SHARED and path.is_file():
        data = path.read_bytes()
        small = data.lower()
        return next((reader for reader, word, sign in SIGNS if word in small and sign.search(data)), READERS[path.suffix.lower()])
    return READERS.get(path.suffix.lower())


def read_deck(path, subcase=None):
    """The deck of a file; of Nastran's of the subcase with that number."""
    reader = reader_of(path)
    if reader is None:
        raise BadInput(f"{path}: files that end in '{path.suffix}' are not read; those in {', '.join(READERS)} are")
    if subcase is None:
        return reader(path)
    if reader is not read_nastran:
        raise BadInput(f"--subcase {subcase}: {path} is no deck of Nastran")
    return reader(path, subcase)


def check_name(path):
    """A name that stands on one line of a scene."""
    if not str(path).isprintable():
        raise BadInput(f"{path}: has a line break, another control character or no UTF-8 in its name; give it another")


def add_files(result, output):
    """Names of the files of the superelement of beams, which its entry gets too; none without."""
    if not result.beams:
        return {}
    files = {key: output.with_name(f"{output.name}_beams{end}") for key, end in (("k", "_k.bin"), ("m", "_m.bin"), ("table", ".csv"))}
    entry, = (entry for entry in result.entries if entry.kind == "superelements")
    entry.rows[:0] = [(key, ("file", path), str(result.beams.place)) for key, path in files.items()]
    return files


def add_tables(result, output):
    """Files of the gaps and of the friction of contacts, whose entries get their names."""
    files = []
    for entry, key, what, place in result.tables:
        files.append((output.with_name(f"{output.name}_{entry.name}_{key.removesuffix('_file')}.csv"), key, what))
        entry.rows.append((key, ("file", files[-1][0]), str(place)))
    return files


def gap_text(result, units, surface, value):
    """The gap at each node of the slave, in SI."""
    nodes = surface_nodes(result, result.surfaces[surface]).tolist()
    each = {result.assembly.into[node]: gap for node, gap in value.items()} if isinstance(value, dict) else dict.fromkeys(nodes, value)
    rows = [",".join(f"{v:.17g}" for v in (*result.x[node], each[node] * units.length)) for node in nodes]
    return "\n".join(["x_m,y_m,z_m,gap_m", *rows]) + "\n"


def write_tables(result, units, files):
    for path, key, what in files:
        path.write_text(gap_text(result, units, *what) if key == "gap" else table_text(what, units), encoding="utf-8")


def write_beams(result, units, files):
    """Matrices and table of the superelement, in SI."""
    if not files:
        return
    write_matrix(files["k"], result.beams.matrix(0, units))
    write_matrix(files["m"], result.beams.matrix(1, units))
    files["table"].write_text(result.beams.table(result.assembly.deck.x, units), encoding="utf-8")


def checked_output(path, output):
    """Where the two files go, without their endings."""
    output = output or Path(path.stem)
    check_name(path)
    check_name(output)
    if "\\" in str(output):
        raise BadInput(f"{output}: PETSc takes \\ in the name of a file for /; give --output another name")
    if not output.parent.is_dir():
        raise BadInput(f"{output.parent}: no such folder; make it, or give --output another")
    return output


def read_bodies(path, subcase, part):
    """The deck with its solids, each in a section, all of them or those of one part; and the size of the model."""
    deck = read_deck(path, subcase)
    solidify(deck)
    if not deck.n_cells:
        raise BadInput(f"{path}:1: there are no volume elements that squeal has")
    set_orientation(deck)
    give_sections(deck)
    if part is not None:
        leave_alone(deck, part)
    size = model_size(deck)
    if not 0 < size < 1e100:
        raise BadInput(f"{path}:1: all nodes are in one place")
    return deck, size


def write_all(deck, result, output, chosen, why):
    """Writes all files; returns their names, mesh and scene first, and the remarks."""
    mesh, scene, table = (output.with_name(output.name + ending) for ending in (".msh", ".yaml", "_equations.csv"))
    equations = table if result.joined.follows else None
    files, tables = add_files(result, output), add_tables(result, output)
    lines, notes = scene_lines(deck, result, chosen, why, (mesh, equations)), [printable(note) for note in remarks(deck)]
    try:
        write_mesh(mesh, result)
        if equations:
            write_equations(table, result)
        write_beams(result, chosen, files)
        write_tables(result, chosen, tables)
        write_scene(scene, [printable(line) for line in lines], notes)
    except OSError as error:
        raise BadInput(f"{error.filename}: {error.strerror}") from None
    return [mesh, scene, *filter(None, (equations, *files.values(), *(path for path, *_ in tables)))], notes


def convert(path, units=None, output=None, strict=False, subcase=None, part=None):
    """Writes OUTPUT.msh and OUTPUT.yaml, of one part alone where one is named; returns the lines to print."""
    chosen = named(units) if units else None
    output = checked_output(path, output)
    deck, size = read_bodies(path, subcase, part)
    nodes = [block.nodes for block in deck.blocks]
    used = [deck.materials[section.material] for section in deck.sections if section.material]
    chosen, why = (chosen, f"units {chosen.name}, given by --units") if chosen else guess(deck, size, used)
    result = assemble(deck, size)
    result.x = result.x * chosen.length
    if not numpy.isfinite(result.x).all():
        raise BadInput(f"{path}:1: places are not finite")
    missing = deck.missing()
    if strict and missing:
        raise BadInput(f"{printable(str(missing[0][0]))}: {printable(missing[0][1])} ({len(missing)} such lines; --strict)")
    written, notes = write_all(deck, result, output, chosen, why)
    balance, differs = compared(of_deck(deck, nodes, result, chosen), of_scene(*written[:2]))
    if strict and differs:
        raise BadInput(f"{path}:1: {differs} (--strict)")
    if result.beams:
        balance.append(f"beams: a superelement of {len(result.beams.words)} unknowns, {result.beams.mass * chosen.mass:.6g} kg, "
                       "which are in no part above")
    cells = sum(len(block.ids) for block in result.blocks)
    return [printable(why), f"{len(result.x)} nodes, {cells} elements, {len(result.volumes)} volumes, {len(result.surfaces)} surfaces, "
            f"{len(result.points)} sets of nodes", *notes, *balance, " ".join(map(str, written))]
