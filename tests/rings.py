#!/usr/bin/env python3
"""Writes the ring of verify/spin.py, 98..102 mm about z and 4 mm thick, meshed with any element of tests/solids.py, as a
Gmsh file: volume "disc", nodes of second order on the circles.

    rings.py tet10 --elements 1,60,1 ring.msh        along r, around and along z

--block adds a cube of 2 mm, volume "pad", that hangs 8 mm above the ring of hex8 and never touches it, and the surfaces
"disc_face" and "pad_face" that look at each other. --hat makes a volume
"hat" of the upper half of the ring of hex8, one element wide, which shares its nodes with "disc", and the surface "hub"
of its inside.
"""

import argparse
from pathlib import Path

import numpy as np

from mesh import CORNERS
from solids import elements, write

INNER, WIDTH, HEIGHT = 0.098, 0.004, 0.004


def add_block(found, x, cells):
    """Groups of the cube and of both surfaces; nodes of the cube are (-1, k, 0)."""
    corners = [np.array([-1, k, 0]) for k in range(8)]
    for k, corner in enumerate(CORNERS):
        x[(-1, k, 0)] = np.array([INNER + 0.001, -0.001, HEIGHT / 2 + 0.008]) + 0.002 * corner
    top = [(4, nodes[nodes[:, 2] == 2 * cells[2]]) for _, nodes in found]
    top = [face for face in top if len(face[1]) == 4]
    return [(3, "pad", [("hex8", np.array(corners))]), (2, "disc_face", top),
            (2, "pad_face", [(4, np.array(corners[:4]))])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind")
    parser.add_argument("file", type=Path)
    parser.add_argument("--elements", default="1,60,1")
    parser.add_argument("--block", action="store_true")
    parser.add_argument("--hat", action="store_true")
    args = parser.parse_args()
    cells = np.array([int(n) for n in args.elements.split(",")])
    found = [(name, nodes % [10**9, 2 * cells[1], 10**9]) for name, nodes in elements(args.kind, cells, None)]
    x = {}
    for p in {tuple(p) for _, nodes in found for p in nodes.tolist()}:
        r, angle = INNER + WIDTH * p[0] / (2 * cells[0]), np.pi * p[1] / cells[1]
        x[p] = np.array([r * np.cos(angle), r * np.sin(angle), HEIGHT * (p[2] / (2 * cells[2]) - 0.5)])
    pieces = [(3, "disc", found)]
    if args.hat:
        upper = [cell for cell in found if cell[1][:, 2].mean() > cells[2]]
        inside = [nodes[nodes[:, 0] == 0][[0, 1, 3, 2]] for _, nodes in upper]
        pieces = [(3, "disc", [cell for cell in found if cell[1][:, 2].mean() < cells[2]]), (3, "hat", upper),
                  (2, "hub", [(4, nodes) for nodes in inside])]
    groups = pieces + (add_block(found, x, cells) if args.block else [])
    write(args.file, "2.2" if args.block or args.hat else "4.1", x, groups, None)


if __name__ == "__main__":
    main()
