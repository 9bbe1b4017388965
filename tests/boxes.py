#!/usr/bin/env python3
"""Writes boxes, each of one kind of element and without nodes in common, as one Gmsh file.

    boxes.py FILE NAME:KIND:x0,y0,z0:x1,y1,z1:nx,ny,nz [...] [--cylinder R] [--join NAME=SET,SET] [--crown NAME,R]

Places in m, numbers of cells. A box makes the sets NAME (volume), NAME_left, NAME_right (least and largest x),
NAME_front, NAME_back (y), NAME_bottom and NAME_top (z), and NAME_inside, the faces between the first two layers of
cells along x. KIND as in tests/solids.py. --cylinder bends planes of equal z into cylinders, that of z = 0 to the
radius R: with s = R + z and angle = y / R, y becomes s sin(angle), z s cos(angle) - R. --lean L,COT leans planes of x >= L
above z = 0 over to the left, by z COT, and those before in proportion to x, so that what ends at L is a wedge.
--join NAME=SET,SET makes a set of all faces of others. --flush SET,FILE writes gaps of 0 at its nodes, as -contact_gap reads them.
--crown NAME,R makes the bottom of a box a parabola, z higher by x^2 / (2 R), less above it and nothing at its top; --dome NAME,R likewise
with x^2 + y^2. --grade KX,KY,KZ makes cells smaller towards x, y, z = 0 along axes whose K is not 0: x = L sinh(K s) / sinh(K) in place of
x = L s, L the largest |x| of the box.
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from solids import FIRST, elements, faces, write


def inside(found):
    """Corners of the faces between the first two layers along x, each once."""
    once = {}
    for kind, nodes in found:
        on = nodes[:FIRST[kind.rstrip("0123456789")]]
        on = on[on[:, 0] == 2]
        if len(on) >= 3:
            b, a = (on - on.mean(0))[:, 1:].T
            once[frozenset(map(tuple, on.tolist()))] = on[np.argsort(np.arctan2(b, a))]
    return list(once.values())


def box(text, shift):
    """Groups of one box, its places on the grid of half steps shifted along x, and their coordinates."""
    name, kind, low, high, counts = text.split(":")
    low, high = (np.array([float(v) for v in t.split(",")]) for t in (low, high))
    cells = np.array([int(n) for n in counts.split(",")])
    found = list(elements(kind, cells, None))
    sides = {**faces(found, cells), "inside": inside(found)}
    away = np.array([shift, 0, 0])
    grid = np.array(list(itertools.product(*(range(2 * n + 1) for n in cells))))
    groups = [(3, name, [(k, nodes + away) for k, nodes in found])]
    groups += [(2, f"{name}_{side}", [(len(f), (f + away).astype(int)) for f in members]) for side, members in sides.items()]
    return groups, grid + away, low + (high - low) * grid / (2 * cells)


def grade(x, grades, text):
    """Coordinates with smaller cells towards 0."""
    corners = np.array([[float(v) for v in corner.split(",")] for corner in text.split(":")[2:4]])
    length, k = np.abs(corners).max(0), np.where(grades > 0, grades, 1)
    return np.where(grades > 0, length * np.sinh(k * x / np.where(length > 0, length, 1)) / np.sinh(k), x)


def crown(x, axes, radius, text):
    """Coordinates of a box whose lower side is round about one axis or two; the upper one stays flat."""
    low, high = (float(corner.split(",")[2]) for corner in text.split(":")[2:4])
    height = np.sum(x[:, :axes]**2, axis=1) / (2 * radius) * (high - x[:, 2]) / (high - low)
    return x + height[:, None] * [0, 0, 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("boxes", nargs="+")
    parser.add_argument("--cylinder", type=float, metavar="R")
    parser.add_argument("--lean", default="0,0", metavar="L,COT")
    parser.add_argument("--crown", default=",1", metavar="NAME,R")
    parser.add_argument("--dome", default=",1", metavar="NAME,R")
    parser.add_argument("--grade", default="0,0,0", metavar="KX,KY,KZ")
    parser.add_argument("--flush", metavar="SET,FILE")
    parser.add_argument("--join", action="append", default=[], metavar="NAME=SET,SET")
    args = parser.parse_args()
    groups, x = [], {}
    grades = np.array([float(k) for k in args.grade.split(",")])
    for i, text in enumerate(args.boxes):
        more, grid, places = box(text, 100000 * i)
        places = grade(places, grades, text)
        for axes, (curved, radius) in ((1, args.crown.split(",")), (2, args.dome.split(","))):
            if text.split(":")[0] == curved:
                places = crown(places, axes, float(radius), text)
        groups += more
        x.update(zip(map(tuple, grid.tolist()), places))
    for name, sets in (text.split("=") for text in args.join):
        groups.append((2, name, [member for _, other, members in groups if other in sets.split(",") for member in members]))
    length, slope = map(float, args.lean.split(","))
    if slope:
        x = {p: np.array([a - max(z, 0) * slope * min(a / length, 1), y, z]) for p, (a, y, z) in x.items()}
    if args.cylinder:
        for p, (a, y, z) in x.items():
            s, angle = args.cylinder + z, y / args.cylinder
            x[p] = np.array([a, s * np.sin(angle), s * np.cos(angle) - args.cylinder])
    if args.flush:
        name, file = args.flush.split(",")
        kind = next(text.split(":")[1] for text in args.boxes if name.startswith(text.split(":")[0] + "_"))
        corners = [face for _, other, members in groups if other == name for _, face in members]
        places = [np.concatenate([f, (f + np.roll(f, 1, 0)) // 2, f.mean(0, keepdims=True).astype(int)]) for f in corners]
        nodes = {tuple(node) for face in places for node in face[:{"hex8": 4, "hex20": 8, "hex27": 9}[kind]].tolist()}
        Path(file).write_text("x_m,y_m,z_m,gap_m\n" + "".join("{:.17g},{:.17g},{:.17g},0\n".format(*x[node]) for node in sorted(nodes)))
    write(args.file, "2.2", x, groups, None)


if __name__ == "__main__":
    main()
