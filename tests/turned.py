#!/usr/bin/env python3
"""Turns one part of a mesh that Gmsh wrote as text (4.1) about the z axis, by degrees: bodies as they were, an interface that is another.

    turned.py FROM TO PART DEGREES
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import read_41, sections


def main():
    source, target, part, degrees = sys.argv[1:]
    _, elements = read_41(sections(Path(source)))
    turns = {node for name, _, nodes in elements if name == part for node in nodes}
    c, s = math.cos(math.radians(float(degrees))), math.sin(math.radians(float(degrees)))
    lines = Path(source).read_text().splitlines()
    at = lines.index("$Nodes") + 2
    while lines[at] != "$EndNodes":
        count = int(lines[at].split()[3])
        for i in range(at + 1, at + 1 + count):
            if int(lines[i]) in turns:
                x, y, z = map(float, lines[i + count].split())
                lines[i + count] = f"{c * x - s * y!r} {s * x + c * y!r} {z!r}"
        at += 2 * count + 1
    Path(target).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
