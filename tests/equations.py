#!/usr/bin/env python3
"""Writes the table of -model_equations that makes the nodes of a set one rigid body: six displacements of three nodes are
kept, u_k = Phi_k q, and all others follow them, u = Phi Phi_k^-1 u_k.

    equations.py MESH SET FILE [--fault round|held|nowhere|twice]"""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import read_mesh

import numpy as np


def rows_of(place):
    """Phi of a node [3][6]: u = t + w x r."""
    x, y, z = place
    return np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])


def kept_rows(x):
    """Six displacements (node, direction) that tell the motion: all of the first node, two of the farthest one from it, one of the
    node farthest from the line through both."""
    a, b = x[0], x[np.linalg.norm(x - x[0], axis=1).argmax()]
    off = np.linalg.norm(np.cross(x - a, b - a), axis=1)
    nodes = [0, int(np.linalg.norm(x - a, axis=1).argmax()), int(off.argmax())]
    along, normal = abs(b - a).argmax(), abs(np.cross(x[nodes[2]] - a, b - a)).argmax()
    return [(0, 0), (0, 1), (0, 2), *((nodes[1], d) for d in range(3) if d != along), (nodes[2], int(normal))]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("set")
    parser.add_argument("file", type=Path)
    parser.add_argument("--fault", choices=["round", "nowhere", "twice", "direction"])
    args = parser.parse_args()
    x, sets = read_mesh(args.mesh)
    x = x[np.unique(np.concatenate([np.ravel(nodes) for (name, _), nodes in sets.items() if name == args.set]))]
    kept = kept_rows(x)
    phi = np.concatenate([rows_of(place) for place in x])
    T = phi @ np.linalg.inv(np.array([phi[3 * i + d] for i, d in kept]))
    lines, n = ["equation,coefficient,direction,x_m,y_m,z_m"], 0

    def line(coefficient, i, d):
        lines.append(",".join([str(n), repr(float(coefficient)), str(d + 1), *map(repr, x[i].tolist())]))

    for i, d in np.ndindex(len(x), 3):
        if (i, d) in kept:
            continue
        n += 1
        line(-2.5, i, d)  # any factor
        for value, (j, e) in zip(T[3 * i + d], kept):
            if abs(value) > 1e-12:
                line(2.5 * value, j, e)
    last = next((i, d) for i, d in np.ndindex(len(x), 3) if (i, d) not in kept)
    if args.fault == "round":
        n += 1
        line(1, *kept[0])
        line(-1, *last)
    if args.fault == "twice":
        n += 1
        line(1, *last)
        line(-1, *kept[0])
    if args.fault == "nowhere":
        x[0] += 1e-4
        line(1, 0, 0)
    if args.fault == "direction":
        line(1, 0, 3)
    args.file.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
