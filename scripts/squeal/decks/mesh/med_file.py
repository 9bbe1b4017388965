"""Files of MED (Salome, Code_Aster), which are HDF5: nodes, cells by type, and families, each of which is in some groups. Fields are
not read."""

from dataclasses import dataclass, field

import numpy

# MED's name of a type -> nodes, name in meshio; of those that squeal lacks a name for the list
TYPES = {"PO1": (1, "vertex"), "SE2": (2, "line"), "SE3": (3, "line3"), "SE4": (4, "line4"), "TR3": (3, "triangle"),
         "TR6": (6, "triangle6"), "TR7": (7, "triangle7"), "QU4": (4, "quad"), "QU8": (8, "quad8"), "QU9": (9, "quad9"),
         "TE4": (4, "tetra"), "T10": (10, "tetra10"), "HE8": (8, "hexahedron"), "H20": (20, "hexahedron20"),
         "H27": (27, "MED hexahedron27"),
         "PE6": (6, "wedge"), "P15": (15, "wedge15"), "P18": (18, "MED wedge18"), "PY5": (5, "pyramid"), "P13": (13, "pyramid13")}


@dataclass
class Cells:
    """Cells of one type; `data` [n][nodes], from 0."""
    type: str
    data: numpy.ndarray


@dataclass
class Mesh:
    """As meshio's, with its names of what the families are."""
    points: numpy.ndarray
    cells: list = field(default_factory=list)
    point_data: dict = field(default_factory=dict)
    cell_data: dict = field(default_factory=lambda: {"cell_tags": []})
    point_tags: dict = field(default_factory=dict)
    cell_tags: dict = field(default_factory=dict)
    others: list = field(default_factory=list)  # names of meshes of the file that are not this one


def text_of(letters):
    """A name, of bytes or of numbers of characters; as Salome writes it, in UTF-8."""
    data = bytes(numpy.asarray(letters).astype(numpy.uint8)) if numpy.asarray(letters).dtype.kind in "iu" else bytes(letters)
    return data.split(b"\0")[0].decode("utf-8", "replace").strip()


def families_of(group):
    """Number of a family -> names of the groups that it is in."""
    found = {}
    for family in group.values():
        names = family["GRO"]["NOM"][()] if "GRO" in family and "NOM" in family["GRO"] else []
        found[int(family.attrs["NUM"])] = [name for name in map(text_of, names) if name]
    return found


def mesh_of(file):
    """The mesh of a file: its first time step; of several the one with the most cells. Returns it, its families, and names."""
    ensemble, found = file["ENS_MAA"], []
    for name, mesh in ensemble.items():
        steps = [mesh] if "NOE" in mesh else [mesh[key] for key in mesh if "NOE" in mesh[key]]
        if steps:
            cells = sum(int(kind["NOD"].attrs["NBR"]) for kind in steps[0].get("MAI", {}).values() if "NOD" in kind)
            found.append((cells, name, mesh, steps[0]))
    if not found:
        raise ValueError("there is no mesh with nodes")
    _, name, mesh, step = max(found, key=lambda item: item[0])
    families = mesh["FAS"] if "FAS" in mesh else file["FAS"][name] if "FAS" in file and name in file["FAS"] else {}
    return mesh, step, families, [other for _, other, *_ in found if other != name]


def read_med(path):
    """The mesh of a file."""
    import h5py
    with h5py.File(path, "r") as file:
        mesh, step, families, others = mesh_of(file)
        places = step["NOE"]["COO"]
        n = int(places.attrs["NBR"])
        dimension = int(mesh.attrs["ESP" if "ESP" in mesh.attrs else "DIM"])  # MED 2 has DIM alone
        found = Mesh(places[()].reshape((n, dimension), order="F"), others=others)
        if "FAM" in step["NOE"]:
            found.point_data["point_tags"] = step["NOE"]["FAM"][()]
        for kind, group in step.get("MAI", {}).items():
            n_nodes, name = TYPES.get(kind, (0, f"MED {kind}"))
            if n_nodes and "NOD" not in group:
                raise ValueError(f"cells {kind} have no nodes")
            n = int(group["NOD"].attrs["NBR"]) if "NOD" in group else 0
            data = group["NOD"][()].reshape((n, -1), order="F") - 1 if n_nodes and n else numpy.zeros((n, n_nodes), int)
            if data.shape[1] != n_nodes:
                raise ValueError(f"cells {kind} have {data.shape[1]} nodes")
            found.cells.append(Cells(name, data))
            found.cell_data["cell_tags"].append(group["FAM"][()] if "FAM" in group else None)
        found.cell_tags = families_of(families["ELEME"]) if "ELEME" in families else {}
        found.point_tags = families_of(families["NOEUD"]) if "NOEUD" in families else {}
    return found
