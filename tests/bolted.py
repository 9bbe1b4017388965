#!/usr/bin/env python3
"""Decks of two flanges on each other that bolts press together, of 4 x 4 x 4 hexahedra each: the bolt is the 2 x 2 in the middle, has
nodes of its own but at its ends, where it is one with the flanges, and is cut in the plane of the joint. In millimetres, tonnes and
seconds. Contact as squeal has it: CalculiX' springs at slave nodes, whose pull on open ones is next to nothing; no friction.

    bolted.py FILE --kind C3D8I --forces 100,50     a deck of CalculiX, or where FILE ends in .cdb an archive of Ansys
"""

import argparse
import itertools
from pathlib import Path

N, BOLT, JOINT, PLANE = 4, (1, 2), 2, 2
SIZE = 2.5, 2.5, 4.0  # of an element, mm
CORNERS = (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)
MIDDLES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
REFERENCE = 900001  # node of the first bolt


def body_of(i, j, k):
    """Whose element it is."""
    return f"BOLT{i // N + 1}" if i % N in BOLT and j in BOLT else "LOW" if k < JOINT else "UP"


def mesh(second, bolts):
    """Nodes, by places in half steps and what keeps them apart, and elements of each body."""
    nodes, elements = {}, {}

    def number(body, place):
        end = body[:4] == "BOLT" and place[2] in (0, 2 * N)
        key = place, ("LOW" if place[2] == 0 else "UP") if end else body
        return nodes.setdefault(key, len(nodes) + 1)

    for k, j, i in itertools.product(range(N), range(N), range(N * bolts)):
        body = body_of(i, j, k)
        places = [tuple(2 * (a + b) for a, b in zip((i, j, k), corner)) for corner in CORNERS]
        places += [tuple((places[a][d] + places[b][d]) // 2 for d in range(3)) for a, b in MIDDLES] if second else []
        elements.setdefault(body, []).append(((i, j, k), [number(body, place) for place in places]))
    return nodes, elements


def surfaces(elements):
    """Faces of the cuts and the joint: name -> (numbers of elements, face); numbers go through the bodies."""
    found, count = {"LOW_TOP": ([], 2), "UP_BOTTOM": ([], 1)}, 0
    for body, members in elements.items():
        for (_, _, k), _ in members:
            count += 1
            if body[:4] == "BOLT" and k == PLANE - 1:
                found.setdefault(f"CUT{body[4:]}", ([], 2))[0].append(count)
            if (body, k) in (("LOW", JOINT - 1), ("UP", JOINT)):
                found["LOW_TOP" if body == "LOW" else "UP_BOTTOM"][0].append(count)
    return found


def deck(kind="C3D8I", bolts=1, steps=("",), normal=""):
    """The text with the cards of each step."""
    nodes, elements = mesh(kind.startswith("C3D20"), bolts)
    lines = ["*NODE"] + [f"{number}, {x * SIZE[0] / 2:.12g}, {y * SIZE[1] / 2:.12g}, {z * SIZE[2] / 2:.12g}"
                         for ((x, y, z), _), number in nodes.items()]
    lines += [f"{REFERENCE + b}, 0, 0, 50" for b in range(bolts)]
    for name, z in (("BASE", 0), ("TOP", 2 * N)):
        lines += [f"*NSET, NSET={name}", *(f"{number}," for ((_, _, w), _), number in nodes.items() if w == z)]
    lines += ["*NSET, NSET=ALL, GENERATE", f"1, {len(nodes)}", "*NSET, NSET=REF, GENERATE", f"{REFERENCE}, {REFERENCE + bolts - 1}"]
    count = 0
    for body, found in elements.items():
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET={body}")
        for _, members in found:
            count += 1
            lines.append(", ".join(map(str, [count, *members[:10]])) + ("," if len(members) > 10 else ""))
            lines += [", ".join(map(str, members[10:]))] if len(members) > 10 else []
    for name, (members, face) in surfaces(elements).items():
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{number}, S{face}" for number in members)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e5, 0.3", "*DENSITY", "7.8e-9"]
    lines += [f"*SOLID SECTION, ELSET={body}, MATERIAL=STEEL" for body in elements] + ["*BOUNDARY", "BASE, 1, 3"]
    for b in range(bolts):
        lines += [f"*PRE-TENSION SECTION, SURFACE=CUT{b + 1}, NODE={REFERENCE + b}"] + ([normal] if normal else [])
    lines += ["*SURFACE INTERACTION, NAME=JOINT", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1e6, 1e-16",
              "*CONTACT PAIR, INTERACTION=JOINT, TYPE=NODE TO SURFACE", "UP_BOTTOM, LOW_TOP"]
    for step in steps:
        lines += ["*STEP", "*STATIC, DIRECT", "1., 1.", "*CONTROLS, PARAMETERS=FIELD", "1e-10, 1e-10", *step.splitlines(),
                  "*NODE PRINT, NSET=ALL", "U", "*NODE PRINT, NSET=REF", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def archive(tensions):
    """The same as an archive of Ansys: cells above the cuts have nodes of their own there, which PRETS179 joins."""
    nodes, elements = mesh(False, len(tensions))
    x = {number: [p * size / 2 for p, size in zip(place, SIZE)] for (place, _), number in nodes.items()}
    count, sides, rows, types = 0, {}, [], {"UP_BOTTOM": (2, 11), "LOW_TOP": (3, 11)}
    facets = {name: [] for name in types}
    for body, found in elements.items():
        for (_, _, k), members in found:
            count += 1
            if body[:4] == "BOLT" and k == PLANE:
                below = [sides.setdefault(n, (max(x) + len(sides) + 1, body))[0] for n in members[:4]]
                members = below + members[4:]
            rows.append((1, 1, 1, 1, 0, 0, 0, 0, 8, 0, count, *members))
            if (body, k) == ("UP", JOINT):
                facets["UP_BOTTOM"].append(members[3::-1])
            if (body, k) == ("LOW", JOINT - 1):
                facets["LOW_TOP"].append(members[4:])
    x |= {new: x[old] for old, (new, _) in sides.items()} | {REFERENCE + b: [0, 0, 50] for b in range(len(tensions))}
    for name, (kind, real) in types.items():
        rows += [(1, kind, real, 1, 0, 0, 0, 0, 4, 0, len(rows) + k, *nodes) for k, nodes in enumerate(facets[name], 1)]
    rows += [(1, 4, 1, 1 + int(body[4:]), 0, 0, 0, 0, 3, 0, len(rows) + k, old, new, REFERENCE - 1 + int(body[4:]))
             for k, (old, (new, body)) in enumerate(sides.items(), 1)]
    lines = ["/PREP7", "ET,1,185", "KEYOPT,1,2,3", "ET,2,173", "ET,3,170", "ET,4,179",
             f"NBLOCK,6,SOLID,{max(x)},{len(x)}", "(3i9,6e21.13e3)",
             *(f"{n:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place) for n, place in x.items()), "N,R5.3,LOC,       -1,",
             f"EBLOCK,19,SOLID,{len(rows)},{len(rows)}", "(19i8)", *("".join(f"{v:8d}" for v in row) for row in rows), "      -1",
             "MP,EX,1,2.1e5", "MP,PRXY,1,0.3", "MP,DENS,1,7.8e-9"]
    lines += [f"D,{n},ALL,0" for ((_, _, z), _), n in nodes.items() if z == 0]
    for b, tension in enumerate(tensions):
        lines += [f"SECTYPE,{2 + b},PRETENSION,,BOLT", f"SECDATA,{REFERENCE + b},0,0,1", f"SLOAD,{2 + b},PL01,LOCK,FORC,{tension},1,2"]
    return "\n".join([*lines, "FINISH"]) + "\n"


def forces(values):
    """Cards of a step that tightens the bolts."""
    return "\n".join(["*CLOAD", *(f"{REFERENCE + b}, 1, {value}" for b, value in enumerate(values))])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--kind", default="C3D8I")
    parser.add_argument("--forces", default="100")
    parser.add_argument("--then", default="", help="cards of a second step, lines divided by ;")
    args = parser.parse_args()
    given = args.forces.split(",")
    steps = (forces(given), *([args.then.replace(";", "\n")] if args.then else []))
    if args.file.suffix == ".cdb":
        args.file.write_text(archive(given), encoding="utf-8")
        raise SystemExit
    args.file.write_text(deck(args.kind, len(given), steps), encoding="utf-8")
