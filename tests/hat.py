#!/usr/bin/env python3
"""Writes the mesh of a hat disc and a pad as a Gmsh file (4.1): a friction ring, r 80..140 mm, z -12..0, whose inner
edge hangs on a cylinder, r 74..80 mm, z -12..40, closed by a plate, r 30..80 mm, z 40..46; and a pad on the ring.
Volumes "disc", "pad", surfaces "hub" (the plate's edge), "disc_face" (the ring's, z = 0), "pad_face", "pad_top".

    hat.py hat.msh [NAME of the volume "disc"]"""

import sys
from pathlib import Path

import numpy as np

from mesh import Grid, merged, polar, write

COLUMNS = 36


def ring(radii, heights, names):
    """A closed piece of rings; names: surface -> (axis, index)."""
    grid = Grid([len(radii) - 1, COLUMNS, len(heights) - 1], closed=True)
    theta = 2 * np.pi * np.arange(COLUMNS) / COLUMNS
    sides = {name: grid.side(*where) for name, where in names.items()}
    return polar(grid.places(grid.nodes), np.array(radii), theta, np.array(heights)), {"disc": grid.hexahedra(), **sides}


def main():
    ring_r, wall_r, plate_r = np.linspace(0.08, 0.14, 6), [0.074, 0.08], [0.03, 0.05, 0.074, 0.08]
    low, wall, plate = [-0.012, -0.006, 0], [0, 0.013, 0.027, 0.04], [0.04, 0.046]
    nodes, groups = merged([ring(ring_r, low, {"disc_face": (2, 2)}), ring(wall_r, low, {}), ring(wall_r, wall, {}),
                            ring(plate_r, plate, {"hub": (0, 0)})])
    pad = Grid([2, 4, 2], first=len(nodes))
    theta = 2 * np.pi * np.arange(COLUMNS) / COLUMNS
    pad_nodes = polar(pad.places(pad.nodes), ring_r[2:5], theta[:5], np.linspace(0, 0.012, 3))
    groups |= {"pad": pad.hexahedra(), "pad_face": pad.side(2, 0), "pad_top": pad.side(2, 2)}
    nodes = np.concatenate([nodes, pad_nodes])
    if len(sys.argv) > 2:
        groups[sys.argv[2]] = groups.pop("disc")
    write(Path(sys.argv[1]), "4.1", False, nodes, groups, list(range(1, len(nodes) + 1)),
          list(range(1, sum(map(len, groups.values())) + 1)))


if __name__ == "__main__":
    main()
