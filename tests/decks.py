"""Decks of other codes, as their manuals show them, for the boxes of solids.py: lengths in mm, stresses in MPa, masses in t.
The order of nodes is that of the manuals, by the corners that each node is between."""

import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.gmsh import read_mesh

import numpy as np
from solids import EDGES, FIRST, SIDES, TYPES

MM = 1000
NAMES = {TYPES[name]: name for name in ("tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20")}
# Corners around the nodes behind the corners, by code; Ansys has the order of Abaqus
ABAQUS = {"tet": "01 12 20 03 13 23", "wedge": "01 12 20 34 45 53 03 14 25", "hex": "01 12 23 30 45 56 67 74 04 15 26 37"}
NASTRAN = {"tet": "01 12 20 03 13 23", "wedge": "01 12 20 03 14 25 34 45 53", "hex": "01 12 23 30 04 15 26 37 45 56 67 74"}
# Corners of the faces S1, S2 ... of Abaqus
FACES = {"tet": "012 031 132 230", "wedge": "012 354 0341 1452 2530", "hex": "0123 4765 0451 1562 2673 3740"}
KINDS = {"tet4": "C3D4", "tet10": "C3D10", "wedge6": "C3D6", "wedge15": "C3D15", "hex8": "C3D8I", "hex20": "C3D20"}
YOUNG, POISSON, DENSITY = 210e3, 0.3, 7.8e-9
ORTHOTROPIC = ([60e3, 9e3, 20e3], [0.28, 0.35, 0.31], [5e3, 7e3, 3e3])  # E 1,2,3; nu 12,13,23; G 12,13,23
AXES = [0.6, 0.5, 0.2], [-0.3, 0.8, 0.4]


def family(name):
    return name.rstrip("0123456789")


def order(name, edges):
    """Places in Gmsh's order of the nodes of an element in another's."""
    shape = family(name)
    theirs = [frozenset(pair) for pair in EDGES[shape].split()]
    first = FIRST[shape]
    middles = [first + theirs.index(frozenset(pair)) for pair in edges[shape].split()]
    return [*range(first), *(middles if int(name[len(shape):]) > first else [])]


class Solid:
    """A box of solids.py: x (m), cells {shape: nodes from 0, Gmsh's order}, sides {name: faces by their nodes}."""

    def __init__(self, kind, folder, *options):
        self.path = folder / f"{kind.replace('+', '_')}.msh"
        words = [Path(__file__).with_name("solids.py"), kind, self.path, "--format", "2.2", *options]
        subprocess.run([sys.executable, *map(str, words)], check=True)
        self.x, sets = read_mesh(self.path)
        self.cells = {NAMES[kind]: nodes for (name, kind), nodes in sets.items() if name == "bar"}
        self.sides = {}
        for (name, _), faces in sets.items():
            if name not in ("bar", "edge"):
                self.sides.setdefault(name, []).extend(faces.tolist())

    def nodes(self, side):
        """Nodes of a side, from 0, with those in the middle of edges; sides are plane."""
        axis, end = SIDES[side]
        far = self.x[:, axis].max() if end else self.x[:, axis].min()
        return np.flatnonzero(abs(self.x[:, axis] - far) < 1e-9).tolist()

    def numbered(self):
        """(first number, shape, nodes) of the cells of each shape, numbers from 1."""
        first = 1
        for name, nodes in self.cells.items():
            yield first, name, nodes
            first += len(nodes)

    def faces(self, side):
        """(element, face of Abaqus), from 1, of a side."""
        corners = {}
        for first, name, cells in self.numbered():
            for k, face in enumerate(FACES[family(name)].split(), 1):
                for i, nodes in enumerate(cells):
                    corners[frozenset(nodes[[int(c) for c in face]].tolist())] = first + i, k
        found = (corners.get(frozenset(face[:3])) or corners[frozenset(face[:4])] for face in self.sides[side])
        return sorted(found)


def lines(rows, most=16):
    """Lines of data with at most 16 entries; all but the last of a row end with a comma."""
    for row in rows:
        for first in range(0, len(row), most):
            yield ", ".join(map(str, row[first:first + most])) + ("," if first + most < len(row) else "")


def abaqus_mesh(solid, numbers=lambda n: n):
    """Nodes, elements in the set BAR, sets of nodes and surfaces of the sides."""
    cards = ["*NODE", *lines([numbers(i), *map(repr, place.tolist())] for i, place in enumerate(solid.x * MM, 1))]
    for first, name, nodes in solid.numbered():
        cards += [f"*ELEMENT, TYPE={KINDS[name]}, ELSET=BAR"]
        cards += lines([first + i, *map(numbers, row)] for i, row in enumerate((nodes[:, order(name, ABAQUS)] + 1).tolist()))
    for side in solid.sides:
        cards += [f"*NSET, NSET={side.upper()}", *lines([[numbers(n + 1) for n in solid.nodes(side)]])]
        cards += [f"*SURFACE, NAME={side.upper()}_FACE, TYPE=ELEMENT", *(f"{e}, S{k}" for e, k in solid.faces(side))]
    return cards


def abaqus_material(name="STEEL", constants=(YOUNG, POISSON)):
    cards = [f"*MATERIAL, NAME={name}", "*DENSITY", repr(DENSITY)]
    if len(constants) == 2:
        return [*cards, "*ELASTIC", *lines([constants])]
    young, poisson, shear = constants
    return [*cards, "*ELASTIC, TYPE=ENGINEERING CONSTANTS", *lines([[*young, *poisson, *shear]], 8)]


def abaqus(solid, constants=(YOUNG, POISSON), count=8, more=()):
    """A deck of the box, clamped on its left side, with springs on the right one along y."""
    turned = len(constants) == 3
    cards = [*abaqus_mesh(solid), *abaqus_material(constants=constants)]
    if turned:
        cards += ["*ORIENTATION, NAME=TURNED, SYSTEM=RECTANGULAR", *lines([AXES[0] + AXES[1]])]
    cards += ["*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL" + (", ORIENTATION=TURNED" if turned else "")]
    springs = solid.nodes("right")
    cards += ["*ELEMENT, TYPE=SPRING1, ELSET=ROWS", *(f"{100000 + i}, {n + 1}" for i, n in enumerate(springs))]
    cards += ["*SPRING, ELSET=ROWS", "2", repr(STIFFNESS)]
    return [*cards, "*BOUNDARY", "LEFT, 1, 3", *more, "*STEP, PERTURBATION", "*FREQUENCY", str(count), "*END STEP"]


STIFFNESS = 50.0  # N/mm, of each spring


def scene_words(mesh, constants=(YOUNG, POISSON), count=8):
    """The same scene in squeal's words, SI."""
    words = ["-model_mesh", mesh, "-parts", "bar", "-bar_density", 7800, "-supports", "hold", "-hold_set", "left", "-hold_fix",
             "xyz", "-springs", "rows", "-rows_set", "right", "-rows_stiffness", f"0,{STIFFNESS * 1000},0",
             "-modes_target", 1, "-modes_count", count]
    if len(constants) == 2:
        return [*words, "-bar_young", constants[0] * 1e6, "-bar_poisson", constants[1]]
    young, poisson, shear = constants
    for k in (0, 1):
        words += [f"-bar_axis_{k + 1}", ",".join(map(str, AXES[k]))]
    for what, values, factor in (("young", young, 1e6), ("poisson", poisson, 1), ("shear", shear, 1e6)):
        words += [f"-bar_{what}", ",".join(repr(v * factor) for v in values)]
    return words
