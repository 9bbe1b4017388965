"""Decks in which something joins nodes: a bar of hex20 (C3D20, 27 points in CalculiX too), clamped on its left side, with a reference
node 9001 off its right one. mm, t, s. Each: name, cards before *STEP, what CalculiX should agree to."""

import decks
import numpy as np

REF = "*NODE, NSET=REF\n9001, 47., 3., 9.\n"
MASS = "*ELEMENT, TYPE=MASS, ELSET=LUMP\n90001, 9001\n*MASS, ELSET=LUMP\n2.e-5\n"
RIGID = "*RIGID BODY, NSET=RIGHT, REF NODE=9001\n"
COUPLED = "*COUPLING, REF NODE=9001, SURFACE=RIGHT_FACE, CONSTRAINT NAME=C1\n"


def deck(solid, extra, hold="LEFT, 1, 3\n", step=None):
    """The bar with more cards."""
    cards = [*decks.abaqus_mesh(solid), *decks.abaqus_material(), "*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL", extra.rstrip(),
             "*BOUNDARY", hold.rstrip(), step or "*STEP\n*FREQUENCY\n8\n*END STEP"]
    return "\n".join(card for card in cards if card) + "\n"


# Name -> cards, supports
CASES = {
    "rigid body": (REF + RIGID, "LEFT, 1, 3\n"),
    "rigid body with a mass": (REF + RIGID + MASS, "LEFT, 1, 3\n"),
    "kinematic coupling with a mass": (REF + MASS + COUPLED + "*KINEMATIC\n1, 3\n", "LEFT, 1, 3\n"),
    "kinematic coupling, its node held along y": (REF + COUPLED + "*KINEMATIC\n1, 3\n", "LEFT, 1, 3\n9001, 2, 2\n"),
    "rigid body, its node held along x and z": (REF + RIGID, "LEFT, 1, 3\n9001, 1, 1\n9001, 3, 3\n"),
    "rigid body that is held": (REF + RIGID.replace("=9001", "=9001, ROT NODE=9002") + "*NODE\n9002, 47., 3., 9.\n",
                                "LEFT, 1, 3\n9001, 1, 3\n9002, 1, 3\n"),
    "rigid body that may turn": (REF + RIGID.replace("=9001", "=9001, ROT NODE=9002") + "*NODE\n9002, 47., 3., 9.\n",
                                 "LEFT, 1, 3\n9001, 1, 3\n9002, 1, 2\n"),
    "a spring at the node": (REF + RIGID + "*ELEMENT, TYPE=SPRING1, ELSET=S\n90002, 9001\n*SPRING, ELSET=S\n2\n300.\n", "LEFT, 1, 3\n"),
    "turned supports": ("*TRANSFORM, NSET=LEFT\n2., 1., 0., -1., 2., 0.5\n", "LEFT, 1, 1\nLEFT, 3, 3\nRIGHT, 1, 3\n"),
    "supports about a cylinder": ("*TRANSFORM, NSET=LEFT, TYPE=C\n-3., -2., -7., 10., -2., -7.\n", "LEFT, 1, 1\nRIGHT, 1, 3\n"),
}
# Springs and dashpots between nodes, equations: two bars, of which the second, beyond a gap, is the first one moved; both clamped
SPRING2 = "*ELEMENT, TYPE=SPRING2, ELSET=S2\n90010, {a}, {b}\n*SPRING, ELSET=S2\n2, 2\n4000.\n"
SPRINGA = "*ELEMENT, TYPE=SPRINGA, ELSET=SA\n90011, {a}, {b}\n*SPRING, ELSET=SA\n\n9000.\n"
EQUATIONS = "".join("*EQUATION\n3\n{a}, %d, 1., {b}, %d, -0.7, {c}, %d, 0.4\n" % (d, d, 4 - d) for d in (1, 3))
MPC = "*MPC\nBEAM, {a}, 9001\nBEAM, {b}, 9001\nBEAM, {c}, 9001\n"
TIED = "*MPC\nTIE, {a}, {b}\n"
BETWEEN = {"a spring along y": SPRING2, "a spring along a line": SPRINGA, "equations": EQUATIONS}


def between(solid, text):
    """The bar with something between nodes of its right side."""
    a, b, c = (node + 1 for node in solid.nodes("right")[:3])
    return deck(solid, text.format(a=a, b=b, c=c))


HELD_BY = "".join(f"*ELEMENT, TYPE=SPRING1, ELSET=H{d}\n9000{d}, 9001\n*SPRING, ELSET=H{d}\n{d}\n{k}.\n"
                  for d, k in ((1, 3000), (2, 900), (3, 700)))


def explicit(solid, about):
    """Springs at a point that follows the right side in the mean, for CalculiX: equations by least squares."""
    nodes = solid.nodes("right")
    x = decks.MM * solid.x[nodes]
    phi = np.zeros((len(x), 3, 6))
    phi[:, :, :3] = np.eye(3)
    for d, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        phi[:, d, 3 + i], phi[:, d, 3 + j] = (x - about)[:, j], -(x - about)[:, i]
    B = np.linalg.lstsq(phi.reshape(-1, 6), np.eye(3 * len(x)), rcond=None)[0]
    cards = [f"*NODE\n9001, {', '.join(map(str, about))}"]
    for d in range(3):
        terms = [(9001, d + 1, -1.0), *((nodes[k // 3] + 1, k % 3 + 1, value) for k, value in enumerate(B[d]) if abs(value) > 1e-15)]
        cards += ["*EQUATION", str(len(terms))]
        cards += [", ".join(f"{node}, {e}, {value:.11g}" for node, e, value in terms[at:at + 4]) for at in range(0, len(terms), 4)]
    return deck(solid, "\n".join(cards) + "\n" + HELD_BY)


def nastran(solid, cards):
    """The bar as a deck of Nastran, with more cards in free fields; grid point 9001 off its right side."""
    lines = decks.nastran(solid, "large")
    lines = [line for line in lines if not line.startswith("CELAS2")]
    case = ["SOL 103", "CEND", "SPC = 1", "MPC = 7", "BEGIN BULK"]
    return "\n".join([*case, *lines[lines.index("BEGIN BULK") + 1:-1], "GRID,9001,,47.,3.,9.", *cards, "ENDDATA"]) + "\n"


def continued(name, *fields):
    """A card in free fields over several lines."""
    rows = [fields[at:at + 8] for at in range(0, len(fields), 8)]
    return [",".join([name if k == 0 else "", *map(str, row)]) for k, row in enumerate(rows)]


def ansys(solid, elements, commands, types=()):
    """The bar as an archive of Ansys, with node 9001, more elements (numbers of EBLOCK) and commands."""
    lines = decks.ansys(solid)
    at = next(k for k, line in enumerate(lines) if line.startswith("N,R5.3"))
    lines.insert(at, f"{9001:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in (47.0, 3.0, 9.0)))
    head = next(k for k, line in enumerate(lines) if line.startswith("NBLOCK"))
    n = len(solid.x) + 1
    lines[head] = f"NBLOCK,6,SOLID,{9001:9d},{n:9d}"
    lines[head:head] = list(types)
    end = next(k for k, line in enumerate(lines) if line.strip() == "-1")
    block = next(k for k, line in enumerate(lines) if line.startswith("EBLOCK"))
    total = sum(len(nodes) for nodes in solid.cells.values()) + len(elements)
    lines[block] = f"EBLOCK,19,SOLID,{90999:9d},{total:9d}"
    lines[end:end] = ["".join(f"{v:9d}" for v in element) for element in elements]
    at = lines.index("/SOLU")
    return "\n".join([*lines[:at], *commands, *lines[at:]]) + "\n"
