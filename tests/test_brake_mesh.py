#!/usr/bin/env python3
"""Has gmsh mesh options/brake.geo in both formats that squeal reads, and judges the mesh by itself:

  names      the volumes and surfaces that the scene needs, each with elements
  volumes    of the pads' parts and of the disc, by integration over the curved elements, against closed forms
  bonded     a lining shares the nodes of its interface with its back plate; no other bodies share a node
  shape      scaled Jacobian at the corners; the Jacobian of a curved element is positive everywhere, since its Bernstein
             coefficients are

Breaks when the script loses a name, a body overlaps another, or elements are slivers or folded. Exit status 77,
skipped, without the program gmsh."""

import shutil
import sys
import tempfile
from itertools import combinations, product
from math import factorial, pi
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import TET10, TRI6, make_mesh, read_mesh

import numpy as np

SIZES = {"14": (45e3, 55e3), "6.5": (180e3, 220e3)}  # mm -> unknowns
EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))  # that have the nodes 4 to 9
SURFACES = ("bolts", "disc_inner", "disc_outer", "inner_rub", "outer_rub", "inner_lugs", "outer_lugs", "piston", "bore",
            "tips", "fingers", "pins")
WORST_SCALED = 0.08  # 1: a regular tetrahedron's corner is 1
SECTOR = 26 * pi / 180 * (137**2 - 98**2) * 10e-9  # of a lining: m^3


def turned():
    """Volume of the disc: of its profile about the axis by Pappus, less the holes of radius 6.5 in 7 mm, m^3."""
    r, z = np.array([34, 40, 34, 33, 64, 33, 70, 27, 70, -6, 140, -6, 140, 6, 83, 6, 77, 12, 77, 34, 71, 40]).reshape(
        -1, 2).T
    r1, z1 = np.roll(r, -1), np.roll(z, -1)
    return (pi / 3 * ((r + r1) * (r * z1 - r1 * z)).sum() - 5 * 7 * pi * 6.5**2) * 1e-9


def gradients(point):
    """Of the ten shape functions of tet10 by its coordinates, at barycentric coordinates."""
    by = np.vstack([-np.ones(3), np.eye(3)])
    corners = [(4 * point[i] - 1) * by[i] for i in range(4)]
    return np.array(corners + [4 * (point[a] * by[b] + point[b] * by[a]) for a, b in EDGES])


def bernstein(places):
    """Bernstein coefficients [20][n] of the Jacobian, a cubic: its least one bounds it from below, and the mean of all is
    the mean of the Jacobian."""
    powers = [p for p in product(range(4), repeat=4) if sum(p) == 3]
    at = np.array(powers) / 3
    value = [np.linalg.det(np.einsum("cni,nj->cij", places, gradients(point))) for point in at]
    basis = [[6 / np.prod([factorial(k) for k in p]) * np.prod(point**p) for p in powers] for point in at]
    return np.linalg.solve(np.array(basis), np.array(value))


def scaled(places):
    """Least scaled Jacobian of the corners [n] of straight tetrahedra."""
    least = np.inf
    for corner in range(4):
        edge = np.array([places[:, i] - places[:, corner] for i in range(4) if i != corner])
        volume = np.abs(np.einsum("ci,ci->c", np.cross(edge[0], edge[1]), edge[2]))
        least = np.minimum(least, 2**0.5 * volume / np.prod(np.linalg.norm(edge, axis=2), axis=0))
    return least


def judge(places, sets, size):
    """What is wrong with a mesh."""
    body = {name: cells for (name, kind), cells in sets.items() if kind == TET10}
    known = {"disc": turned(), "inner_lining": SECTOR, "outer_lining": SECTOR}
    faults = [f"no {name}" for name in SURFACES if (name, TRI6) not in sets]
    faults += [f"elements of type {kind} in {name}" for name, kind in sets if kind not in (TET10, TRI6)]
    for name, cells in body.items():
        jacobian, worst = bernstein(places[cells]), scaled(places[cells]).min()
        volume = jacobian.mean(axis=0).sum() / 6
        print(f"  {name:13s}{len(cells):7d} elements{len(np.unique(cells)):8d} nodes, {1e9 * volume:8.0f} mm^3, least scaled "
              f"Jacobian {worst:.3f}, least of a curved one over its mean {(jacobian.min(0) / jacobian.mean(0)).min():.3f}")
        faults += [f"{name}: scaled Jacobian {worst}"] if worst < WORST_SCALED else []
        faults += [f"{name}: {(jacobian.min(0) <= 0).sum()} folded elements"] if jacobian.min() <= 0 else []
        if name in known and abs(volume / known[name] - 1) > 1e-4:
            faults.append(f"{name}: volume {volume}, not {known[name]}")
    if sorted(body) != ["caliper", "disc", "inner_lining", "inner_plate", "outer_lining", "outer_plate"]:
        faults.append(f"bodies {sorted(body)}")
    for one, other in combinations(sorted(body), 2):
        bonded = one[:6] == other[:6]
        if bool(len(np.intersect1d(body[one], body[other]))) != bonded:
            faults.append(f"{one} and {other} {'share no node' if bonded else 'share nodes'}")
    unknowns = 3 * len(np.unique(np.concatenate([cells.ravel() for cells in body.values()])))
    print(f"  {unknowns} unknowns")
    return faults if SIZES[size][0] < unknowns < SIZES[size][1] else [*faults, f"{unknowns} unknowns"]


def main():
    if not shutil.which("gmsh"):
        print("skipped: no gmsh, of scripts/packages.txt")
        return 77
    faults = []
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        for size, form in (("14", "msh22"), ("14", "msh41"), ("6.5", "msh41")):
            path = Path(folder) / f"{size}.{form}"
            print(f"size {size}, {form}")
            make_mesh("brake", path, form, size=size)
            faults += [f"{size}, {form}: {fault}" for fault in judge(*read_mesh(path), size)]
    print("\n".join(faults) or "sound")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
