#!/usr/bin/env python3
"""Writes a box of 60 x 20 x 20 mm, x from 0, meshed with any element, as a Gmsh file.

    solids.py tet10 --elements 3,2,2 --distort 1 box.msh

The elements tet4, tet10, wedge6, wedge15, hex8, hex20, hex27; or hex+wedge (side by side along x) and wedge+tet (one on
the other) with the order 1 or 2: hex+wedge1, wedge+tet2. Volume "bar"; surfaces "left", "right" (least and largest x),
"front", "back" (y), "bottom", "top" (z); curve "edge" (least y and z).

--distort draws new places for the corners inside, within a fifth of an element, and --curve moves all other nodes inside
too. --renumber draws new numbers of nodes and elements, a new order of both, and a new first corner of each element.
--move turns the mesh and shifts it (tests/mesh.py). --damage swaps two mid-side nodes of the first element (swap), gives
a node twice (twice), moves nodes along their edges until the Jacobian is negative (bend), leaves one element of first order (order), or
makes eight hexahedra of first order of the last hexahedron (hang).
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from mesh import CORNERS, MOVE_ROTATION, MOVE_SHIFT, turned_hexahedra

SIZE = np.array([0.06, 0.02, 0.02])
# In the order of Gmsh: corners of the unit cell that each node is the middle of
EDGES = {"tet": "01 12 20 03 23 13", "wedge": "01 02 03 12 14 25 34 35 45",
         "hex": "01 03 04 12 15 23 26 37 45 47 56 67 0321 0154 0473 1265 2376 4567 01234567"}
CELLS = {"hex": [range(8)], "wedge": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]],
         "tet": [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]}
TYPES = {"tet4": 4, "tet10": 11, "wedge6": 6, "wedge15": 18, "hex8": 5, "hex20": 17, "hex27": 12,
         1: 15, 2: 1, "line3": 8, 3: 2, 6: 9, 4: 3, 8: 16, 9: 10}  # of the file
FIRST = {"tet": 4, "wedge": 6, "hex": 8}
SIDES = {"left": (0, 0), "right": (0, 1), "front": (1, 0), "back": (1, 1), "bottom": (2, 0), "top": (2, 1)}


def even_orders(shape):
    """Orders of the corners of a shape that keep its orientation."""
    if shape == "hex":
        return turned_hexahedra().tolist()
    if shape == "wedge":
        return [[0, 1, 2, 3, 4, 5], [1, 2, 0, 4, 5, 3], [2, 0, 1, 5, 3, 4], [3, 5, 4, 0, 2, 1]]
    orders = itertools.permutations(range(4))
    return [list(order) for order in orders if np.linalg.det(np.eye(4)[list(order)]) > 0]


def shape_at(kind, place, cells):
    """The shape of the elements of a cell of the grid."""
    if kind.startswith("hex+wedge"):
        return "hex" if 2 * place[0] < cells[0] else "wedge"
    if kind.startswith("wedge+tet"):
        return "wedge" if 2 * place[2] < cells[2] else "tet"
    return kind.rstrip("0123456789")


def element_nodes(shape, n_nodes, corners):
    """Places of the nodes of an element on the grid of half steps."""
    groups = EDGES[shape].split()[:n_nodes - FIRST[shape]]
    middles = [np.mean([corners[int(c)] for c in group], axis=0) for group in groups]
    return np.array([*corners, *middles]).round().astype(int)


def elements(kind, cells, random):
    """(name of the element, its nodes on the grid of half steps) of all cells."""
    second = kind[-1] == "2" if "+" in kind else kind in ("tet10", "wedge15", "hex20", "hex27")
    for place in itertools.product(*map(range, cells)):
        shape = shape_at(kind, place, cells)
        n_nodes = int(kind[len(shape):]) if "+" not in kind else {
            "tet": (4, 10), "wedge": (6, 15), "hex": (8, 20)}[shape][second]
        for cell in CELLS[shape]:
            corners = 2 * (np.array(place) + CORNERS[list(cell)])
            if random is not None:
                corners = corners[random.choice(even_orders(shape))]
            yield f"{shape}{n_nodes}", element_nodes(shape, n_nodes, corners)


def faces(found, cells):
    """name -> corners of the elements' faces on each side of the box, on the grid of half steps."""
    sides = {name: [] for name in SIDES}
    for name, nodes in found:
        shape = name.rstrip("0123456789")
        corners = nodes[:FIRST[shape]]
        if corners.min() > 0 and (corners.max(0) < 2 * cells).all():
            continue
        for side, (axis, end) in SIDES.items():
            on = corners[corners[:, axis] == 2 * end * cells[axis]]
            if len(on) < 3:
                continue
            middle = on.mean(0)
            a, b = (on - middle)[:, [(axis + 1) % 3, (axis + 2) % 3]].T
            sides[side].append(on[np.argsort(np.arctan2(b, a))])
    return sides


def places(grid, cells, args):
    """Coordinates (m) of places on the grid of half steps."""
    x = {}
    random = np.random.default_rng(args.distort)
    inside = [p for p in grid if all(0 < c < 2 * n for c, n in zip(p, cells))]
    for p in grid:
        x[p] = np.array(p, float) / 2
    for p in inside:
        shift = random.uniform(-0.2, 0.2, 3)
        if args.distort is not None and not any(c % 2 for c in p):
            x[p] = x[p] + shift
    for p in grid:  # the middles of moved corners
        odd = [c % 2 for c in p]
        if any(odd):
            ends = itertools.product(*[(c - o, c + o) if o else (c,) for c, o in zip(p, odd)])
            ends = [e for e in ends if e in x]
            x[p] = np.mean([x[e] for e in ends], axis=0)
    for p in inside:
        if args.curve and any(c % 2 for c in p):
            x[p] = x[p] + random.uniform(-0.05, 0.05, 3)
    return {p: value / cells * SIZE for p, value in x.items()}


def damage(found, x, how):
    """Spoils the first element."""
    name, nodes = found[0]
    shape = name.rstrip("0123456789")
    at = FIRST[shape]
    if how == "swap":
        nodes[[at, at + 1]] = nodes[[at + 1, at]]
    elif how == "twice":
        nodes[1] = nodes[0]
    elif how == "bend":
        for p in nodes[at:]:
            if p[0] == 1:  # in the middle of an edge along x
                x[tuple(p)] = x[tuple(p)] + [0.39 * 2 * x[tuple(p)][0], 0, 0]
    elif how == "hang":
        corners = found[-1][1][0] + CORNERS
        found[-1:] = [("hex8", corners + p) for p in itertools.product((0, 1), repeat=3)]
    elif how == "order":
        found[0] = (f"{shape}{at}", nodes[:at])
    return found


def write(path, version, x, groups, random):
    """The file; groups are (dimension, name, [(type, nodes)])."""
    used = sorted({tuple(p) for _, _, members in groups for _, nodes in members for p in nodes.tolist()})
    tags = np.arange(1, len(used) + 1)
    if random is not None:
        tags = random.permutation(3 * len(used))[:len(used)] + 1
    tag_of = dict(zip(used, tags.tolist()))
    lines = ["$MeshFormat", f"{version} 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dim} {g} "{name}"' for g, (dim, name, _) in enumerate(groups, 1)] + ["$EndPhysicalNames"]
    rows = [f"{tag_of[p]} {' '.join(repr(float(c)) for c in x[p])}" for p in used]
    all_elements = [(g, dim, kind, nodes) for g, (dim, _, members) in enumerate(groups, 1) for kind, nodes in members]
    if version == "2.2":
        lines += ["$Nodes", str(len(used)), *rows, "$EndNodes", "$Elements", str(len(all_elements))]
        for number, (g, _, kind, nodes) in enumerate(all_elements, 1):
            lines.append(f"{number} {TYPES[kind]} 2 {g} {g} " + " ".join(str(tag_of[tuple(p)]) for p in nodes.tolist()))
        path.write_text("\n".join([*lines, "$EndElements"]) + "\n")
        return
    lines += ["$Entities", " ".join(str(sum(dim == d for dim, _, _ in groups)) for d in range(4))]
    for d in range(4):
        lines += [f"{g} {'0 0 0' if d == 0 else '0 0 0 1 1 1'} 1 {g}" + (" 0" if d else "")
                  for g, (dim, _, _) in enumerate(groups, 1) if dim == d]
    volume = next(g for g, (dim, _, _) in enumerate(groups, 1) if dim == 3)
    lines += ["$EndEntities", "$Nodes", f"1 {len(used)} 1 {max(tags)}", f"3 {volume} 0 {len(used)}"]
    lines += [row.split(" ", 1)[0] for row in rows] + [row.split(" ", 1)[1] for row in rows]
    lines += ["$EndNodes", "$Elements", f"{len(all_elements)} {len(all_elements)} 1 {len(all_elements)}"]
    for number, (g, dim, kind, nodes) in enumerate(all_elements, 1):
        lines += [f"{dim} {g} {TYPES[kind]} 1", f"{number} " + " ".join(str(tag_of[tuple(p)]) for p in nodes.tolist())]
    path.write_text("\n".join([*lines, "$EndElements"]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind")
    parser.add_argument("file", type=Path)
    parser.add_argument("--elements", default="3,2,2", help="along x, y, z")
    parser.add_argument("--format", choices=["2.2", "4.1"], default="4.1")
    parser.add_argument("--distort", type=int, metavar="SEED")
    parser.add_argument("--curve", action="store_true")
    parser.add_argument("--renumber", type=int, metavar="SEED")
    parser.add_argument("--move", action="store_true")
    parser.add_argument("--damage", choices=["swap", "twice", "bend", "order", "hang"])
    args = parser.parse_args()
    random = None if args.renumber is None else np.random.default_rng(args.renumber)
    cells = np.array([int(n) for n in args.elements.split(",")])
    found = list(elements(args.kind, cells, random))
    grid = list(itertools.product(*(range(2 * n + 1) for n in cells)))
    x = places(grid, cells, args)
    if args.damage:
        found = damage(found, x, args.damage)
    if random is not None:
        random.shuffle(found)
    if args.move:
        x = {p: MOVE_ROTATION @ value + MOVE_SHIFT for p, value in x.items()}
    groups = [(3, "bar", found)]
    groups += [(2, name, [(len(face), face) for face in side]) for name, side in faces(found, cells).items()]
    edge = [np.array([[2 * i, 0, 0], [2 * i + 2, 0, 0]]) for i in range(cells[0])]
    groups.append((1, "edge", [(2, line) for line in edge]))
    write(args.file, args.format, x, groups, random)


if __name__ == "__main__":
    main()
