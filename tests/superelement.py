#!/usr/bin/env python3
"""Writes a scene twice: whole, and with one body, a carrier on top of a block that rubs on a base, to be a superelement.

    superelement.py FOLDER

whole.msh    base, block and carrier; the block and the carrier share nodes
rest.msh     without the carrier
carrier.msh  the carrier alone, nodes in the order in which squeal numbers those of one rank
carrier.csv  table of its unknowns, those of its nodes on the block by place, all others internal; its top is held
bad_FAULT.csv  the same with a fault, of FAULTS
above.msh, above.csv  the carrier 1 mm above the block and turned by half a face, whose places follow the block's top
touching.csv  two unknowns where the block and the base have a node each
point.csv, point.bin  the six motions of a point, and their stiffness
two.csv      two internal unknowns; even.bin, skew.bin, flat.bin, negative.bin, light.bin matrices for it
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from mesh import BLOCK_SIZE, Grid, blocks
from mesh_file import write

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from scipy.sparse import csr_matrix
from squeal.mesh.petsc_matrix import write_matrix

FAULTS = "twice", "number", "nowhere", "direction", "missing", "places", "mm", "turns"
MATRICES = {"even": [[2, 1], [1, 2]], "skew": [[2, 1], [0, 2]], "flat": [[2, 1, 0], [1, 2, 0]], "negative": [[1, 2], [2, 1]],
            "light": [[1, 0], [0, 0]]}
ELEMENTS, LAYERS, HEIGHT = [3, 4, 2], 2, 0.04


def carrier():
    """Nodes and groups of the carrier alone."""
    grid = Grid([*ELEMENTS[:2], LAYERS])
    x = (grid.places(grid.nodes) / grid.cells - [0.5, 0.5, 0]) * [*BLOCK_SIZE[:2], HEIGHT] + [0, 0, BLOCK_SIZE[2]]
    return x, {"carrier": grid.hexahedra(), "carrier_bottom": grid.side(2, 0), "carrier_top": grid.side(2, LAYERS)}


def joined(first, second):
    """Two meshes, with nodes of the second at nodes of the first made one."""
    x, groups = first
    place = [np.flatnonzero((abs(x - node) < 1e-9).all(1)) for node in second[0]]
    new = np.cumsum([len(at) == 0 for at in place]) - 1 + len(x)
    number = np.array([at[0] if len(at) else k for at, k in zip(place, new)])
    return (np.concatenate([x, second[0][[len(at) == 0 for at in place]]]),
            groups | {name: number[cells] for name, cells in second[1].items()})


def save(path, body):
    x, groups = body
    write(path, "4.1", False, x, groups, list(range(1, len(x) + 1)), list(range(1, sum(map(len, groups.values())) + 1)))


def table(x, low):
    """Lines unknown,node,direction,x,y,z of the nodes that are not held."""
    free = np.flatnonzero(x[:, 2] < x[:, 2].max() - 1e-9)
    lines = []
    for k, (node, d) in enumerate((node, d) for node in free for d in range(3)):
        on = x[node, 2] < low + 1e-9
        lines.append([str(k + 1), str(node + 1), "xyz"[d] if on else "internal", *(map(repr, x[node].tolist()) if on else "000")])
    return lines


def spoil(lines, fault):
    """The same with one fault."""
    if fault == "twice":
        lines[1][0] = lines[0][0]
    if fault == "number":
        lines[3][2] = "y"
        lines[3][1], lines[3][3:] = lines[4][1], lines[4][3:]
    if fault == "nowhere":
        for line in lines[:3]:
            line[5] = repr(float(line[5]) + 0.003)
    if fault == "direction":
        lines[2][2] = "w"
    if fault == "missing":
        del lines[5]
    if fault == "places":
        lines[1][3] = "0.5"
    if fault == "mm":
        for line in lines:
            line[3:] = [repr(1000 * float(x)) for x in line[3:]]
    if fault == "turns":
        lines[0][2] = "rx"
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    rest, body = blocks(ELEMENTS, [0, 0, 0]), carrier()
    rest[1].update(block_side=np.concatenate([rest[1].pop("block_left"), rest[1].pop("block_right")]))
    above = body[0] * [0.9, 0.95, 1] + [0.003, -0.001, 0.001], body[1]
    save(folder / "whole.msh", joined(rest, body))
    save(folder / "apart.msh", (np.concatenate([rest[0], above[0]]),
                                rest[1] | {name: cells + len(rest[0]) for name, cells in body[1].items()}))
    for name, one in (("rest", rest), ("carrier", body), ("above", above)):
        save(folder / f"{name}.msh", one)
    for name, x, fault in [("carrier", body[0], ""), ("above", above[0], ""), *((f"bad_{fault}", body[0], fault) for fault in FAULTS)]:
        lines = spoil(table(x, x[:, 2].min()), fault)
        (folder / f"{name}.csv").write_text("unknown,node,direction,x,y,z\n" + "\n".join(map(",".join, lines)) + "\n")
    corner = rest[0][rest[1]["block_bottom"][0, 0]]
    (folder / "touching.csv").write_text("unknown,node,direction,x,y,z\n1,1,x,{0},{1},{2}\n2,1,y,{0},{1},{2}\n".format(*corner))
    (folder / "nan.bin").write_bytes(np.array([1211216, 1, 1, 1, 1, 0], ">i4").tobytes() + np.array([np.nan], ">f8").tobytes())
    write_matrix(folder / "point.bin", csr_matrix(np.diag([1e7, 2e7, 3e7, 1e4, 2e4, 3e4])))
    (folder / "point.csv").write_text("unknown,node,direction,x,y,z\n" + "".join(
        f"{6 - i},7,{direction},0.01,0.02,0.13\n" for i, direction in enumerate("rz ry rx z y x".split())))
    (folder / "middle.csv").write_text((folder / "point.csv").read_text().replace("0.01,0.02,0.13", "0,0,0.1"))
    (folder / "two.csv").write_text("unknown,node,direction,x,y,z\n1,1,internal,,,\n2,1,0,,,\n")
    for name, values in MATRICES.items():
        write_matrix(folder / f"{name}.bin", csr_matrix(np.array(values, float)))


if __name__ == "__main__":
    main()
