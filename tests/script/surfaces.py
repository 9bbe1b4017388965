#!/usr/bin/env python3
"""Surfaces of all types of cells that scripts/squeal/mesh/cells.py knows, with VTK's own places of their nodes: the volume
that the faces enclose, by Gauss' theorem, hence every face once and seen from outside, with the middle nodes moved
outward too; and two cells on top of each other, whose common face is inside. Breaks when a node stands in the wrong
place of a table, or a face is turned."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.mesh.cells import CELLS, boundary_faces, triangles_of

import numpy

SKIPPED = 77
VOLUME = {4: 1 / 6, 6: 1 / 2, 8: 1}  # of VTK's cells, by their corners


def places():
    """Type -> places of the nodes of VTK's cell in its own coordinates."""
    from vtkmodules.vtkCommonDataModel import vtkGenericCell
    found, cell = {}, vtkGenericCell()
    for kind in CELLS:
        cell.SetCellType(kind)
        found[kind] = numpy.array(cell.GetParametricCoords()).reshape(-1, 3)
    return found


def enclosed(points, faces):
    """Volume in a closed surface seen from outside."""
    a, b, c = (points[triangles_of(faces)[:, i]] for i in range(3))
    return (numpy.cross(a, b) * c).sum() / 6


def judge(kind, points):
    """What is wrong with one type."""
    n, volume = len(points), VOLUME[CELLS[kind][0]]
    one = boundary_faces({kind: numpy.arange(n)[None]})
    faults = [] if abs(enclosed(points, one) - volume) < 1e-12 else [f"volume {enclosed(points, one)}, not {volume}"]
    swollen = points + 0.2 * (points - points[:CELLS[kind][0]].mean(axis=0)) * (numpy.arange(n) >= CELLS[kind][0])[:, None]
    if n > CELLS[kind][0] and not volume < enclosed(swollen, one) < 2 * volume:
        faults.append(f"middle nodes moved outward enclose {enclosed(swollen, one)}")
    if len(numpy.unique(one)) != n - (n == 27):
        faults.append(f"{len(numpy.unique(one))} of {n} nodes on the surface")
    # on it another one, or its mirror image, with the face z = 0 in common
    low = points * [1, 1, -1] if CELLS[kind][0] != 8 else points - [0, 0, 1]
    both, index = numpy.unique(numpy.round(numpy.concatenate([points, low]), 12), axis=0, return_inverse=True)
    pair = boundary_faces({kind: index.reshape(2, n)})
    inside = [face for face in pair if (both[face, 2] == 0).all() and numpy.ptp(both[face, :2], axis=0).min() > 0]
    return faults + ([f"{len(inside)} pieces of the common face are left"] if inside else [])


def main():
    try:
        cells = places()
    except ImportError:
        print("skipped: no vtkmodules, of python3-vtk9")
        return SKIPPED
    faults = [f"type {kind}: {fault}" for kind, points in cells.items() for fault in judge(kind, points)]
    print("\n".join(faults) or f"{len(cells)} types of cells")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
