#!/usr/bin/env python3
"""Writes the ring of verify/spin.py, 98..102 mm about z and 4 mm thick, meshed with any element of tests/solids.py, as a
Gmsh file: volume "disc", nodes of second order on the circles.

    rings.py tet10 --elements 1,60,1 ring.msh        along r, around and along z
"""

import argparse
from pathlib import Path

import numpy as np

from solids import elements, write

INNER, WIDTH, HEIGHT = 0.098, 0.004, 0.004


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind")
    parser.add_argument("file", type=Path)
    parser.add_argument("--elements", default="1,60,1")
    args = parser.parse_args()
    cells = np.array([int(n) for n in args.elements.split(",")])
    found = [(name, nodes % [10**9, 2 * cells[1], 10**9]) for name, nodes in elements(args.kind, cells, None)]
    x = {}
    for p in {tuple(p) for _, nodes in found for p in nodes.tolist()}:
        r, angle = INNER + WIDTH * p[0] / (2 * cells[0]), np.pi * p[1] / cells[1]
        x[p] = np.array([r * np.cos(angle), r * np.sin(angle), HEIGHT * (p[2] / (2 * cells[2]) - 0.5)])
    write(args.file, "4.1", x, [(3, "disc", found)], None)


if __name__ == "__main__":
    main()
