"""Odd files of MED and VTK for test_import_keywords.py, made with h5py and meshio: what other programs write and squeal has not."""

import numpy as np

CUBE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float)
STEP = "-0000000000000000001-0000000000000000001"


def letters(names):
    """Names of groups as MED has them."""
    return np.array([list(name.encode().ljust(80, b"\0")) for name in names], np.int8)


def write_med(path, meshes, fields=False):
    """Meshes {name: (points, cells {type: (nodes from 0, families or None)}, families {number: names or None})}."""
    import h5py
    with h5py.File(path, "w") as file:
        for name, (points, cells, families) in meshes.items():
            mesh = file.create_group(f"ENS_MAA/{name}")
            mesh.attrs["ESP"] = points.shape[1]
            step = mesh.create_group(STEP)
            places = step.create_dataset("NOE/COO", data=points.ravel(order="F"))
            places.attrs["NBR"] = len(points)
            for kind, (nodes, numbers) in cells.items():
                data = step.create_dataset(f"MAI/{kind}/NOD", data=(np.array(nodes) + 1).ravel(order="F"))
                data.attrs["NBR"] = len(nodes)
                if numbers is not None:
                    step.create_dataset(f"MAI/{kind}/FAM", data=numbers)
            for number, names in families.items():
                family = file.create_group(f"FAS/{name}/ELEME/FAM_{number}")
                family.attrs["NUM"] = number
                if names is not None:
                    family.create_dataset("GRO/NOM", data=letters(names))
        if fields:  # of elements that are not in the mesh
            file.create_group(f"CHA/forces/{STEP}/MAI.SE2/MED_NO_PROFILE_INTERNAL")


def beside(points):
    """The cube and one more beside it."""
    return np.vstack([CUBE, CUBE + (2, 0, 0), points])


TURNED = (0, 3, 2, 1, 4, 7, 6, 5)  # corners as MED has them
HEXA = [TURNED, tuple(8 + k for k in TURNED)]
MIDDLES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]


def hexa27():
    """The cube with 27 nodes: corners, edges, faces, centre, in MED's order of corners."""
    x = CUBE[list(TURNED)]
    inside = [x[list(face)].mean(axis=0) for face in ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
    return np.vstack([x, [(x[a] + x[b]) / 2 for a, b in MIDDLES], inside, x.mean(axis=0)])


POINTS = beside([(0.5, 0.5, -1), (5, 5, 5), (6, 5, 5)])
# Name -> meshes, and starts of lines that must be printed; None: the one line of the error
MED = {
    "odd": ({"Mesh": (POINTS, {
        "HE8": (HEXA, [-1, -2]), "PY5": ([(0, 1, 2, 3, 16)], [-1]), "QU9": ([[0, 1, 2, 3, 4, 5, 6, 7, 8]], [-3]),
        "TR7": ([[0, 1, 5, 2, 3, 4, 6]], None), "QU4": ([(0, 3, 2, 1), (1, 2, 10, 9)], [-4, -4]), "POE": ([()], None),
        "SE2": ([(17, 18)], [-5])}, {-1: ["left", "both"], -2: ["both", ""], -3: None, -4: ["skin"], -5: ["bar"], -6: ["no one"]}),
        "Second": (CUBE, {}, {})}, [
            "1 cells of type pyramid: not taken; squeal has no such elements", "1 cells of type MED POE: not taken", "mesh 'Second'",
            "group skin: 1 of its cells are no face"]),
    "plain": ({"Mesh": (CUBE, {"HE8": (HEXA[:1], None)}, {})}, ["set rest has no section"]),
    "hexa27": ({"Mesh": (hexa27(), {"H27": ([range(27)], [0])}, {})}, ["differs: 1 cells of type MED hexahedron27 become hex20"]),
    "faces": ({"Mesh": (CUBE, {"TR3": ([(0, 1, 2), (0, 2, 3)], [-1, -1])}, {-1: ["face"]})}, None),
    "points": ({"Mesh": (CUBE, {}, {})}, None),
    "nothing": ({}, None),
    "flat": ({"Mesh": (CUBE[:4, :2], {"QU4": ([(0, 1, 2, 3)], [0])}, {})}, None)}
