"""Decks of other codes, as their manuals show them, for the boxes of solids.py: lengths in mm, stresses in MPa, masses in t.
The order of nodes is that of the manuals, by the corners that each node is between."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import read_mesh

import numpy as np
from forked import run_well
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
        run_well(Path(__file__).with_name("solids.py"), kind, self.path, "--format", "2.2", *options)
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


def abaqus(solid, constants=(YOUNG, POISSON), count=8, springs=None):
    """A deck of the box, clamped on its left side, with springs along y on the right one, or at other nodes."""
    turned = len(constants) == 3
    cards = [*abaqus_mesh(solid), *abaqus_material(constants=constants)]
    if turned:
        cards += ["*ORIENTATION, NAME=TURNED, SYSTEM=RECTANGULAR", *lines([AXES[0] + AXES[1]])]
    cards += ["*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL" + (", ORIENTATION=TURNED" if turned else "")]
    springs = solid.nodes("right") if springs is None else springs
    cards += ["*ELEMENT, TYPE=SPRING1, ELSET=ROWS", *(f"{100000 + i}, {n + 1}" for i, n in enumerate(springs))]
    cards += ["*SPRING, ELSET=ROWS", "2", repr(STIFFNESS)]
    return [*cards, "*BOUNDARY", "LEFT, 1, 3", "*STEP, PERTURBATION", "*FREQUENCY", str(count), "*END STEP"]


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


def number(value, width):
    """A number in at most `width` characters, as exact as they go."""
    for digits in range(width, 0, -1):
        text = f"{value:.{digits}g}" if value else "0."
        text = text if "." in text or "e" in text else f"{text}."
        text = text.replace("e-0", "e-").replace("e+0", "e+").replace("e", "")  # as 1.5-3
        if len(text) <= width:
            return text
    raise ValueError(value)


def nastran_card(form, name, *fields):
    """A card with small or large fields, or free ones."""
    wide = 16 if form != "small" else 8
    words = [number(field, wide) if isinstance(field, float) else str(field) for field in fields]
    if form == "free":
        rows = [words[at:at + 8] for at in range(0, len(words), 8)]
        return [",".join([name if k == 0 else "", *row]) for k, row in enumerate(rows)]
    most, head, go_on = (4, f"{name}*", "*") if form == "large" else (8, name, "+" if len(words) % 2 else "")
    rows = [words[at:at + most] for at in range(0, len(words), most)]
    rows += [[""]] * (form == "large" and len(rows) % 2)
    return [(head if k == 0 else go_on).ljust(8) + "".join(word.ljust(wide) for word in row) for k, row in enumerate(rows)]


def nastran(solid, form, constants=(YOUNG, POISSON), count=8):
    """The deck of abaqus() for Nastran."""
    cards = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "$ a comment"]

    def card(*fields):
        cards.extend(nastran_card(form, *fields))

    for i, place in enumerate((solid.x * MM).tolist(), 1):
        card("GRID", i, "", *place)
    for first, name, nodes in solid.numbered():
        title = {"tet": "CTETRA", "wedge": "CPENTA", "hex": "CHEXA"}[family(name)]
        for i, row in enumerate((nodes[:, order(name, NASTRAN)] + 1).tolist()):
            card(title, first + i, 7, *row)
    if len(constants) == 2:
        card("PSOLID", 7, 3)
        card("MAT1", 3, constants[0], "", constants[1], DENSITY)
    else:
        first, second = (np.array(axis) for axis in AXES)
        second = second - first * (second @ first) / (first @ first)
        third = np.cross(first, second)
        card("CORD2R", 5, 0, 0., 0., 0., *third.tolist(), *first.tolist())
        card("PSOLID", 7, 3, 5)
        card("MAT11", 3, *(float(v) for values in constants for v in values), DENSITY)
    held = [n + 1 for n in solid.nodes("left")]
    card("SPC1", 1, "123", *held)
    for i, n in enumerate(solid.nodes("right")):
        card("CELAS2", 100000 + i, STIFFNESS, n + 1, 2)
    card("EIGRL", 1, "", "", count)
    return [*cards, "ENDDATA"]


# Nodes of a hexahedron of 20 nodes that a tetrahedron and a wedge of second order become, and of 8 nodes likewise
FOLDED = {"tet10": (0, 1, 2, 2, 3, 3, 3, 3, 4, 5, 2, 6, 3, 3, 3, 3, 7, 8, 9, 9), "tet4": (0, 1, 2, 2, 3, 3, 3, 3),
          "wedge15": (0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14), "wedge6": (0, 1, 2, 2, 3, 4, 5, 5),
          "hex8": range(8), "hex20": range(20)}


def ansys(solid, constants=(YOUNG, POISSON), count=8, plain=False):
    """The deck of abaqus() as an archive of Ansys, without springs; tetrahedra as types of their own (plain), or folded."""
    n = len(solid.x)
    cards = ["/COM,ANSYS RELEASE 2023", "/PREP7", "/NOPR", "ET,        1,186", "ET,        2,185", "ET,        3,187", "ET,        4,285",
             "KEYOP,       2,2,  3", f"NBLOCK,6,SOLID,{n:9d},{n:9d}", "(3i9,6e21.13e3)"]
    for i, place in enumerate((solid.x * MM).tolist(), 1):
        cards.append(f"{i:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place).rstrip())
    cards += ["N,R5.3,LOC,       -1,"]
    total = sum(len(nodes) for nodes in solid.cells.values())
    cards += [f"EBLOCK,19,SOLID,{total:9d},{total:9d}", "(19i9)"]
    for first, name, nodes in solid.numbered():
        kind = {"tet10": 3, "tet4": 4}[name] if plain else 1 if int(name[len(family(name)):]) > 8 else 2
        places = order(name, ABAQUS) if plain else [order(name, ABAQUS)[k] for k in FOLDED[name]]
        for i, row in enumerate((nodes[:, places] + 1).tolist()):
            head = [1, kind, 1, 1, 11 if len(constants) > 2 else 0, 0, 0, 0, len(row), 0, first + i]
            for part in (head + row[:8], row[8:]):
                cards += ["".join(f"{v:9d}" for v in part)] if part else []
    cards += ["       -1"]
    held = [k + 1 for k in solid.nodes("left")]
    cards += [f"CMBLOCK,HELD    ,NODE,{len(held):8d}", "(8i10)"]
    cards += ["".join(f"{v:10d}" for v in held[at:at + 8]) for at in range(0, len(held), 8)]
    if len(constants) == 2:
        values = {"EX": constants[0], "NUXY": constants[1]}
    else:
        (e1, e2, e3), (n12, n13, n23), (g12, g13, g23) = constants
        values = {"EX": e1, "EY": e2, "EZ": e3, "PRXY": n12, "NUXZ": n13 * e3 / e1, "PRYZ": n23, "GXY": g12, "GYZ": g23, "GXZ": g13}
    for label, value in (values | {"DENS": DENSITY}).items():
        cards += [f"MPTEMP,R5.0, 1, 1,  0.00000000    ,", f"MPDATA,R5.0, 1,{label:4},       1, 1, {value!r}    ,"]
    if len(constants) > 2:
        cards += ["LOCAL,R5.0,LOC,       11,0,  0.0,  0.0,  0.0", "LOCAL,R5.0,ANG,       11,0," + ",".join(map(repr, euler()))]
    cards += [f"D,HELD,{label},  0.00000000    ,  0.00000000" for label in ("UX", "UY", "UZ")]
    return [*cards, "/SOLU", f"MODOPT,LANB,{count}", "FINISH"]


def euler():
    """Turns about z, the new x, the new y, degrees, that make AXES: the columns of Rz Rx Ry are the axes."""
    first, second = (np.array(axis) for axis in AXES)
    first = first / np.linalg.norm(first)
    second = second - first * (second @ first)
    second /= np.linalg.norm(second)
    third = np.cross(first, second)
    about_x = np.arcsin(second[2])
    return np.degrees([np.arctan2(-second[0], second[1]), about_x, np.arctan2(-first[2], third[2])]).tolist()


# Corners of the mirror image
MIRROR = {"tet": (0, 2, 1, 3), "wedge": (0, 2, 1, 3, 5, 4), "hex": (0, 3, 2, 1, 4, 7, 6, 5)}


def mirrored(name, edges):
    """Places of the nodes of an element in their order by `edges`, of the element the other way round, as MED has them."""
    corners = MIRROR[family(name)]
    pairs = [frozenset(map(int, pair)) for pair in edges[family(name)].split()]
    middles = [pairs.index(frozenset(corners[i] for i in pair)) for pair in pairs]
    return [*corners, *(len(corners) + k for k in middles)][:int(name[len(family(name)):])]


def meshio_file(solid, path, half=False):
    """The box as a file of meshio: VTK or VTU with a field, or MED with groups, and elements as Code_Aster has them; or every second
    element the other way round."""
    import meshio
    getattr(meshio._mesh, "topological_dimension", {}).setdefault("wedge15", 3)  # pylint: disable=protected-access
    names = {"tet4": "tetra", "tet10": "tetra10", "wedge6": "wedge", "wedge15": "wedge15", "hex8": "hexahedron",
             "hex20": "hexahedron20"}
    places = {name: order(name, ABAQUS) for name in solid.cells}
    if path.suffix == ".med":
        places = {name: [row[k] for k in mirrored(name, ABAQUS)] for name, row in places.items()}
    cells = [(names[name], nodes[:, places[name]]) for _, name, nodes in solid.numbered()]
    if half:
        for (_, name, _), (_, nodes) in zip(solid.numbered(), cells):
            nodes[::2] = nodes[::2][:, mirrored(name, ABAQUS)]
    if path.suffix != ".med":
        data = {"material": [np.full(len(nodes), 4, np.int32) for _, nodes in cells]}
        meshio.write(str(path), meshio.Mesh(solid.x * MM, cells, cell_data=data))
        return
    faces = {3: "triangle", 4: "quad"}
    tags = [np.full(len(nodes), -1) for _, nodes in cells]
    for number in faces:
        chosen = [(face, tag) for tag, side in ((-2, "left"), (-3, "right")) for face in solid.sides[side] if len(face) == number]
        if chosen:
            cells.append((faces[number], np.array([face for face, _ in chosen])))
            tags.append(np.array([tag for _, tag in chosen]))
    points = np.zeros(len(solid.x), int)
    points[solid.nodes("left")] = 1
    mesh = meshio.Mesh(solid.x * MM, cells, cell_data={"cell_tags": tags}, point_data={"point_tags": points})
    mesh.cell_tags, mesh.point_tags = {-1: ["BAR"], -2: ["LEFT_FACE"], -3: ["RIGHT"]}, {1: ["LEFT"]}
    mesh.write(str(path))
