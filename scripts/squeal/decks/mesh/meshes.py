"""Files of VTK and VTU, which meshio reads, and of MED. They hold meshes and groups, hence no material and no scene."""

import contextlib
import io

import numpy

from ...tables import BadInput
from ..deck import Block, Deck, Place, shape_of
from .faces import faces_by_three
from .med_file import read_med

SHAPES = {"tetra": "tet4", "tetra10": "tet10", "wedge": "wedge6", "wedge15": "wedge15", "hexahedron": "hex8",
          "hexahedron20": "hex20", "hexahedron27": "hex27", "voxel": "hex8"}
VOXEL = (0, 1, 3, 2, 4, 5, 7, 6)  # corners of a hexahedron among those of a voxel
# Without their nodes inside of faces and elements
PLAINER = {"MED hexahedron27": "hex20", "MED wedge18": "wedge15", "wedge18": "wedge15", "hexahedron24": "hex20"}
FACES = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}
MED = ".med", ".mmed", ".rmed"  # as Code_Aster names inputs and results too
THIN = ("vertex", "line", *FACES)
MOST = 64  # values of a field of whole numbers that tells parts


def load(path):
    """meshio's mesh; whatever it stumbles over is one line."""
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    try:
        import meshio
    except ImportError:
        raise BadInput("meshio is missing: apt-get install python3-meshio") from None
    getattr(meshio._mesh, "topological_dimension", {}).setdefault("wedge15", 3)  # pylint: disable=protected-access
    read = read_med if path.suffix.lower() in MED else {".vtk": meshio.vtk.read, ".vtu": meshio.vtu.read}[path.suffix.lower()]
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), numpy.errstate(all="ignore"):
            return read(str(path))
    except MemoryError:
        raise BadInput(f"{path}:1: announces more than there is memory for: is the file damaged?") from None
    except (Exception, SystemExit) as error:  # pylint: disable=broad-except
        text = " ".join(str(error).split())[:160] or type(error).__name__
        raise BadInput(f"{path}:1: it cannot be read ({text}): is the file damaged?") from None


def checked(deck, mesh):
    """Coordinates and blocks of nodes, without what cannot be."""
    place = Place(deck.path, 1)
    x = numpy.asarray(mesh.points, float)
    if x.ndim == 2 and len(x) and x.shape[1] in (1, 2):
        where = "in a plane" if x.shape[1] == 2 else "on a line"
        raise place.wrong(f"there are no volume elements that squeal has: its points are {where}")
    if x.ndim != 2 or x.shape[1] != 3 or not len(x):
        raise place.wrong("its points are not in space")
    if not numpy.isfinite(x).all() or abs(x).max() > 1e100:
        raise place.wrong(f"point {int(numpy.argwhere(~(abs(x) <= 1e100))[0][0]) + 1} is not finite")
    for cells in mesh.cells:
        if cells.type not in SHAPES and cells.type not in PLAINER and cells.type not in FACES:
            continue
        nodes = numpy.asarray(cells.data)
        if nodes.dtype.kind not in "iu" or nodes.ndim != 2:
            raise place.wrong(f"cells of type {cells.type} are no table of nodes")
        if len(nodes) and (nodes.min() < 0 or nodes.max() >= len(x)):
            raise place.wrong(f"a cell of type {cells.type} has a node that is not in the file")
    return x


def tags_of(mesh, number, block, name):
    """A field of whole numbers of a block of cells, or None."""
    values = mesh.cell_data.get(name)
    if values is None or number >= len(values):
        return None
    values = numpy.asarray(values[number])
    values = values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values
    return values if values.ndim == 1 and len(values) == len(block) and values.dtype.kind in "iu" else None


def field_of_parts(deck, mesh):
    """The field of cells that tells parts: the first of whole numbers with few values."""
    solids = [k for k, cells in enumerate(mesh.cells) if cells.type in SHAPES or cells.type in PLAINER]
    chosen = None
    for name in mesh.cell_data:
        found = [tags_of(mesh, k, mesh.cells[k].data, name) for k in solids]
        if chosen is None and all(values is not None for values in found) and len(
                numpy.unique(numpy.concatenate(found or [numpy.empty(0)]))) <= MOST:
            chosen = name
        else:
            deck.note(Place(deck.path, 1), f"field '{name}' of cells: not taken")
    for name in mesh.point_data:
        if name != "point_tags":
            deck.note(Place(deck.path, 1), f"field '{name}' of points: not taken")
    return chosen


def add_cells(deck, cells, nodes, first):
    """Numbers of volume elements in the deck; those of squeal have no nodes inside of faces and, but for VTK's hex27, of elements."""
    place = Place(deck.path, 1)
    shape = shape_of(SHAPES.get(cells.type) or PLAINER[cells.type])
    if cells.type == "voxel":
        nodes = nodes[:, VOXEL]
    if cells.type in PLAINER:
        nodes = nodes[:, :shape.n_nodes]
        deck.differ(place, f"{len(nodes)} cells of type {cells.type} become {shape.name}: without their nodes inside of faces")
    if nodes.shape[1] != shape.n_nodes:
        raise place.wrong(f"cells of type {cells.type} have {nodes.shape[1]} nodes")
    return deck.add_block(Block(shape, cells.type, numpy.arange(first, first + len(nodes)), nodes, place))


def read_meshes(path):
    """The deck of a file."""
    mesh, deck, place = load(path), Deck(path, "mesh of MED" if path.suffix.lower() in MED else "mesh by meshio"), Place(str(path), 1)
    x = checked(deck, mesh)
    deck.add_nodes(x)
    deck.all_mirrored = med = path.suffix.lower() in MED
    for name in getattr(mesh, "others", ()):
        deck.note(place, f"mesh '{name}': a second one, not taken")
    field, first, groups, surfaces = "cell_tags" if med else field_of_parts(deck, mesh), 1, {}, []
    for number, cells in enumerate(mesh.cells):
        if cells.type in SHAPES or cells.type in PLAINER:
            nodes = numpy.array(cells.data, int)
            tags = tags_of(mesh, number, nodes, field) if field else None
            tags = numpy.zeros(len(nodes), int) if tags is None and med else tags
            added = add_cells(deck, cells, nodes, first)
            first += len(nodes)
            for tag in numpy.unique(tags).tolist() if tags is not None else ():
                groups.setdefault(tag, []).append(added[tags == tag])
        elif cells.type in FACES and med:
            nodes = numpy.array(cells.data, int)
            surfaces.append((nodes[:, :3], tags_of(mesh, number, nodes, "cell_tags")))
        else:
            thin = cells.type.rstrip("0123456789") in THIN
            deck.note(place, f"{len(cells.data)} cells of type {cells.type}: not taken" + (
                "" if thin else "; squeal has no such elements, their places are empty"))
    if med:
        add_groups(deck, mesh, groups, surfaces)
    else:
        for tag, parts in groups.items():
            deck.cell_sets[f"part_{tag}"] = numpy.concatenate(parts), place
    return deck


def note_families(deck, what, numbers, families):
    """Says which families are not in the file, and which groups nothing is in: a file that lost some."""
    place, used = Place(deck.path, 1), {int(number) for tags in numbers if tags is not None for number in numpy.unique(tags)}
    gone = sorted(used - {0, *families})
    if gone:
        deck.note(place, f"family {gone[0]}{f' and {len(gone) - 1} more' if gone[1:] else ''} of {what} is not in the file: "
                         "the groups of its members are not known")
    bare = sorted(number for number in used - {0} if number in families and not families[number])
    if bare:
        deck.note(place, f"family {bare[0]}{f' and {len(bare) - 1} more' if bare[1:] else ''} of {what} is in no group")
    kept = {name for number in used for name in families.get(number, [])}
    for name in sorted({name for names in families.values() for name in names} - kept):
        deck.note(place, f"group {name}: no {what} are in it")


def add_groups(deck, mesh, groups, surfaces):
    """Groups of MED: a family, the tag, is in some of them."""
    place, members, faces, lost = Place(deck.path, 1), {}, {}, {}
    for tag, parts in groups.items():
        for name in mesh.cell_tags.get(tag, ["rest"] if tag == 0 else []):
            members.setdefault(name, []).extend(parts)
    for name, parts in members.items():
        deck.cell_sets[name] = numpy.sort(numpy.concatenate(parts)), place
    for three, tags in surfaces:
        found, missing = faces_by_three(deck, three)
        for tag in numpy.unique(tags).tolist() if tags is not None else ():
            chosen = tags == tag
            for name in mesh.cell_tags.get(tag, []):
                lost[name] = lost.get(name, 0) + int(missing[chosen].sum())
                faces.setdefault(name, []).append(found[chosen & ~missing])
    for name, parts in faces.items():
        if lost[name]:
            deck.note(place, f"group {name}: {lost[name]} of its cells are no face of a volume element; they are not in it")
        if any(map(len, parts)):
            deck.surfaces[name] = numpy.concatenate(parts), place
    tags = mesh.point_data.get("point_tags")
    note_families(deck, "cells", mesh.cell_data["cell_tags"], mesh.cell_tags)
    note_families(deck, "nodes", [tags], mesh.point_tags)
    for tag, names in (mesh.point_tags if tags is not None else {}).items():
        for name in names:
            nodes = numpy.flatnonzero(numpy.asarray(tags) == tag)
            before = deck.node_sets.get(name, (numpy.empty(0, int),))[0]
            if len(nodes):
                deck.node_sets[name] = numpy.concatenate([before, nodes]), place
