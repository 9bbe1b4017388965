#!/usr/bin/env python3
"""Writes the disc and block of tests/mesh.py (rig) with a patch of the disc under the block as a part of its own: the rest of the disc is
to be a superelement.

    split_disc.py FOLDER

whole.msh   volumes "disc" without its patch, "patch", "block"; set "seam" of the faces that both share, on the side of the disc
rest.msh    the same without the disc; disc_face is what the patch has of it
"""

import sys
from pathlib import Path

import numpy as np

from mesh import rig
from mesh_file import write

MARGIN = 0.012  # m, of the patch beyond the block


def save(path, x, groups):
    """The nodes that cells have, numbered anew."""
    used = np.unique(np.concatenate([cells.ravel() for cells in groups.values()]))
    new = np.searchsorted(used, np.arange(len(x)))
    groups = {name: new[cells] for name, cells in groups.items()}
    write(path, "4.1", False, x[used], groups, list(range(1, len(used) + 1)), list(range(1, sum(map(len, groups.values())) + 1)))


def main():
    x, groups = rig()
    box = x[groups["block"].ravel()]
    low, high, middle = box.min(0)[:2] - MARGIN, box.max(0)[:2] + MARGIN, x[groups["disc"]].mean(1)[:, :2]
    patch = ((middle > low) & (middle < high)).all(1)
    cells = {name: groups.pop(name) for name in ("disc", "block")}
    disc, patch = cells["disc"][~patch], cells["disc"][patch]
    sides = [0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]
    faces = np.concatenate([patch[:, side] for side in sides])
    seam = faces[np.isin(faces, np.intersect1d(disc, patch)).all(1)]
    on_patch = np.isin(groups["disc_face"], patch).all(1)
    save(Path(sys.argv[1]) / "whole.msh", x, {"disc": disc, "patch": patch, "block": cells["block"], "seam": seam, **groups})
    rest = {name: faces for name, faces in groups.items() if name not in ("disc_inner", "disc_face")}
    save(Path(sys.argv[1]) / "rest.msh", x, {"patch": patch, "block": cells["block"], **rest, "disc_face": groups["disc_face"][on_patch]})


if __name__ == "__main__":
    main()
