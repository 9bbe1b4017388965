#!/usr/bin/env python3
"""What joins nodes of imported decks - couplings, rigid bodies, masses, springs between nodes, equations, supports in turned axes -
beside CalculiX on the same deck, to 1e-8, by the matrices that it stores with 14 digits (of frequencies it prints seven), from which
its constraints are eliminated: hex20 and C3D20 with 27 points are one element. CalculiX 2.20 takes
loads alone on a node of *DISTRIBUTING; springs on one are written as equations for it. Breaks when an arm,
a sign, a share or an axis is wrong, or when something is lost without a word.

    test_import_joined.py SQUEAL

Comparisons are left out without `ccx`."""

import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))

import decks
import decks_joined
import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import eigsh
from served import starter
from test_import_keywords import FAILED, brought, check

CALCULIX, SAME, COUNT = 1e-8, 1e-9, 8


def frequencies(folder, program):
    """Hz, of the scene."""
    done = program.run(folder, ["-options_file", "deck.yaml", "-output_dir", "out", "-output_fields", "0", "-modes_count", str(COUNT)])
    if done.status:
        return np.zeros(0), done.stderr
    with (folder / "out/modes.csv").open(newline="") as rows:
        return np.array([float(row["freq_hz"]) for row in csv.DictReader(rows)][:COUNT]), ""


def stored(path):
    """A symmetric matrix of CalculiX: row, column, value of one triangle."""
    rows = np.loadtxt(path)
    i, j = (rows[:, :2].T - 1).astype(int)
    A = coo_matrix((rows[:, 2], (i, j)), shape=2 * [int(rows[:, :2].max())]).tocsc()
    return A + A.T - diags(A.diagonal())


def run_calculix(folder, text):
    """Hz, of the matrices that CalculiX stores."""
    (folder / "kept.inp").write_text(text.replace("*FREQUENCY\n", "*FREQUENCY, SOLVER=MATRIXSTORAGE\n"))
    subprocess.run(["ccx", "kept"], cwd=folder, capture_output=True, check=False)
    kappa = eigsh(stored(folder / "kept.sti"), COUNT, stored(folder / "kept.mas"), sigma=0, return_eigenvectors=False)
    return np.sqrt(np.sort(kappa)) / (2 * np.pi)


def beside(folder, program, about, text, other=None):
    """A deck in squeal and CalculiX, or another deck in CalculiX."""
    lines, _ = brought(folder, text)
    check(f"{about}: balance", any(line.startswith("balance: the scene has") for line in lines), lines)
    check(f"{about}: nothing is left out", not any("not in the scene" in line or "not understood" in line for line in lines), lines)
    ours, said = frequencies(folder, program)
    check(f"{about}: runs", len(ours) == COUNT, said)
    if shutil.which("ccx") and len(ours) == COUNT:
        theirs = run_calculix(folder, other or text)
        worst = max(abs(ours / theirs - 1))
        check(f"{about}: CalculiX, apart by {worst:.1e}, {CALCULIX:g} allowed", worst < CALCULIX, (ours, theirs))


def same(folder, program, about, text, other):
    """A deck of another code and one of Abaqus: the same frequencies."""
    found = []
    for ending, deck in ((text[0], text[1]), ("inp", other)):
        lines, _ = brought(folder, deck, ending)
        check(f"{about}, {ending}: balance", any(line.startswith("balance: the scene has") for line in lines), lines)
        left = [line for line in lines if "not in the scene" in line or "not taken" in line]
        check(f"{about}, {ending}: nothing is left out", not left, left)
        found.append(frequencies(folder, program))
    ours, theirs = found[0][0], found[1][0]
    worst = max(abs(ours / theirs - 1)) if len(ours) == len(theirs) == COUNT else np.inf
    check(f"{about}: as the deck of Abaqus, apart by {worst:.1e}, {SAME:g} allowed", worst < SAME, found)


def nastran(folder, program, solid):
    """RBE2, RBE3, CONM2, CELAS2, CBUSH, MPC beside *KINEMATIC, *DISTRIBUTING, *MASS and *ROTARY INERTIA, *SPRING, *EQUATION."""
    right = [node + 1 for node in solid.nodes("right")]
    ref, coupled = decks_joined.REF, decks_joined.COUPLED
    lump = decks_joined.MASS + ("*ELEMENT, TYPE=ROTARYI, ELSET=T\n90003, 9001\n"
                                "*ROTARY INERTIA, ELSET=T\n3e-3, 4e-3, 5e-3, 1e-3, -5e-4, 2e-4\n")
    heavy = decks_joined.continued("CONM2", 90001, 9001, 0, "2.E-5", "", "", "", "", "3.E-3", "-1.E-3", "4.E-3", "5.E-4", "-2.E-4", "5.E-3")
    rigid = decks_joined.continued("RBE2", 90002, 9001, 123456, *right)
    spread = decks_joined.continued("RBE3", 90002, "", 9001, 123456, "1.0", 123, *right)
    same(folder, program, "RBE2 with CONM2", ("bdf", decks_joined.nastran(solid, rigid + heavy)),
         decks_joined.deck(solid, ref + lump + coupled + "*KINEMATIC\n"))
    same(folder, program, "RBE3 with CONM2", ("bdf", decks_joined.nastran(solid, spread + heavy)),
         decks_joined.deck(solid, ref + lump + coupled + "*DISTRIBUTING\n"))
    uneven = decks_joined.continued("RBE3", 90002, "", 9001, 123456, "1.0", 123, *right[:-1], "3.0", 123, right[-1])
    lines, _ = brought(folder, decks_joined.nastran(solid, uneven + heavy), "bdf")
    check("RBE3 of unequal weights: said", sum("its nodes have unequal weights" in line for line in lines) == 1, lines)
    held = "".join(decks_joined.HELD_BY.splitlines(True)[5:10])
    same(folder, program, "RBE2 with CBUSH", ("bdf", decks_joined.nastran(solid, rigid + [
        "CBUSH,90005,5,9001,,,,,0", "PBUSH,5,K,0.,900.,0."])), decks_joined.deck(solid, ref + coupled + "*KINEMATIC\n" + held))
    a, b, c = right[:3]
    same(folder, program, "CELAS2 between points", ("bdf", decks_joined.nastran(solid, [f"CELAS2,90006,4000.,{a},2,{b},2"])),
         decks_joined.between(solid, decks_joined.SPRING2))
    equations = [line for d in (1, 3) for line in decks_joined.continued("MPC", 7, a, d, "1.", b, d, "-0.7", "", "", c, 4 - d, "0.4")]
    same(folder, program, "MPC", ("bdf", decks_joined.nastran(solid, equations)), decks_joined.between(solid, decks_joined.EQUATIONS))


def ansys(folder, program, solid):
    """MASS21, COMBIN14, MPC184, CERIG, CE, CP, a pilot node of contact by MPC, beside cards of Abaqus."""
    right = [node + 1 for node in solid.nodes("right")]
    ref, coupled = decks_joined.REF, decks_joined.COUPLED
    lump = decks_joined.MASS + ("*ELEMENT, TYPE=ROTARYI, ELSET=T\n90003, 9001\n*ROTARY INERTIA, ELSET=T\n3e-3, 4e-3, 5e-3\n")
    types = ["ET,        11,21", "ET,        12,14", "ET,        13,184", "KEYOP,      13, 1, 1", "KEYOP,      12, 2, 2"]
    heavy = [1, 11, 5, 1, 0, 0, 0, 0, 1, 0, 90001, 9001]
    real = ["R,5,2e-5,2e-5,2e-5,3e-3,4e-3,5e-3"]
    members = ["".join(f"{v:10d}" for v in right[at:at + 8]) for at in range(0, len(right), 8)]
    component = [f"CMBLOCK,RIGHT   ,NODE,{len(right):8d}", "(8i10)", *members]
    rigid = decks_joined.deck(solid, ref + lump + coupled + "*KINEMATIC\n")
    region = [*component, *real, "CERIG,9001,RIGHT,ALL"]
    same(folder, program, "MASS21 on CERIG", ("cdb", decks_joined.ansys(solid, [heavy], region, types)), rigid)
    beams = [[1, 13, 1, 1, 0, 0, 0, 0, 2, 0, 90100 + k, 9001, node] for k, node in enumerate(right)]
    arrays = [f"*DIM,SL,ARRAY,{len(right)}", f"*DIM,WT,ARRAY,{len(right)},1,1", "*SET,SL(1,1,1)," + ",".join(map(str, right[:3])),
              *(f"SL({k})={node}" for k, node in enumerate(right[3:], 4)), *(f"*SET,WT({k}),2." for k in range(1, len(right) + 1))]
    spread = decks_joined.deck(solid, ref + lump + coupled + "*DISTRIBUTING\n")
    whole = decks_joined.ansys(solid, [heavy], [*real, *arrays, "RBE3,9001,ALL,SL(1),WT(1)"], types)
    same(folder, program, "MASS21 on RBE3", ("cdb", whole), spread)
    lines, _ = brought(folder, decks_joined.ansys(solid, [heavy], [*real, *arrays[:-1], "RBE3,9001,ALL,SL(1),WT(1)"], types), "cdb")
    check("RBE3: a weight of 0 is listed", sum("positive weights are needed" in line for line in lines) == 1, lines)
    lines, _ = brought(folder, decks_joined.ansys(solid, [heavy], [*real, "RBE3,9001,ALL,SL(1)"], types), "cdb")
    check("RBE3: an array that is not there is listed", sum("an array that is not there" in line for line in lines) == 1, lines)
    same(folder, program, "MASS21 on MPC184", ("cdb", decks_joined.ansys(solid, [heavy, *beams], real, types)), rigid)
    rows = []
    for node in right:
        arm = decks.MM * solid.x[node - 1] - [47.0, 3.0, 9.0]
        for d in range(3):  # u = t + w x r
            a, b = (d + 1) % 3, (d + 2) % 3
            terms = [(node, "U" + "XYZ"[d], -1.0), (9001, "U" + "XYZ"[d], 1.0), (9001, "ROT" + "XYZ"[a], arm[b]),
                     (9001, "ROT" + "XYZ"[b], -arm[a])]
            terms = [term for term in terms if term[2]]
            rows.append(f"CE,R5.0,DEFI,{len(terms):8d},       1,  0.00000000    ")
            for at in range(0, len(terms), 2):
                rows.append("CE,R5.0,NODE," + ",".join(f"{n:10d},{label:4s},{float(value)!r}" for n, label, value in terms[at:at + 2]))
    same(folder, program, "MASS21 on CE of a rigid region", ("cdb", decks_joined.ansys(solid, [heavy], [*real, *rows], types)), rigid)
    a, b, c = right[:3]
    spring = [1, 12, 6, 1, 0, 0, 0, 0, 2, 0, 90050, a, b]
    same(folder, program, "COMBIN14", ("cdb", decks_joined.ansys(solid, [spring], ["R,6,4000."], types)),
         decks_joined.between(solid, decks_joined.SPRING2))
    equations = [f"CE,{d},0,{a},U{'XYZ'[d - 1]},1.,{b},U{'XYZ'[d - 1]},-0.7,{c},U{'XYZ'[3 - d]},0.4" for d in (1, 3)]
    same(folder, program, "CE", ("cdb", decks_joined.ansys(solid, [], equations)), decks_joined.between(solid, decks_joined.EQUATIONS))
    coupled_nodes = [f"CP,{d},U{'XYZ'[d - 1]},{b},{a}" for d in (1, 2, 3)]
    same(folder, program, "CP", ("cdb", decks_joined.ansys(solid, [], coupled_nodes)), decks_joined.between(solid, decks_joined.TIED))
    types = ["ET,        14,175", "ET,        15,170", "ET,        11,21", "KEYOP,      14, 12, 5", "KEYOP,      14, 2, 2"]
    pair = [[1, 14, 9, 1, 0, 0, 0, 0, 1, 0, 90200 + k, node] for k, node in enumerate(right)] + [
        [1, 15, 9, 1, 0, 0, 0, 0, 1, 0, 90300, 9001]]
    for about, kind, other in (("rigid", 2, rigid), ("spread", 1, rigid.replace("*KINEMATIC", "*DISTRIBUTING"))):
        same(folder, program, f"a pilot node, {about}", ("cdb", decks_joined.ansys(
            solid, [heavy, *pair], real, [*types, f"KEYOP,      14, 4, {kind}"])), other)


def connectors(folder, program, solid):
    """Connectors beside what does the same: a rigid body, springs, equations."""
    right = decks_joined.REF + decks_joined.COUPLED + "*KINEMATIC\n"
    pair = "*NODE\n9002, 47., 3., 9.\n*ELEMENT, TYPE=CONN3D2, ELSET=CN\n90020, 9001, 9002\n"
    far = right + decks_joined.MASS.replace("9001", "9002") + pair
    rigid = decks_joined.deck(solid, right + decks_joined.MASS)
    for kind in ("BEAM", "WELD"):
        text = decks_joined.deck(solid, far + f"*CONNECTOR SECTION, ELSET=CN\n{kind},\n")
        same(folder, program, f"a connector, {kind}", ("inp", text), rigid)
    held = decks_joined.HELD_BY
    node = right + pair
    bush = "*CONNECTOR SECTION, ELSET=CN, BEHAVIOR=B\nCARTESIAN,\n*CONNECTOR BEHAVIOR, NAME=B\n" + "".join(
        f"*CONNECTOR ELASTICITY, COMPONENT={d}\n{k}.\n" for d, k in ((1, 3000), (2, 900), (3, 700)))
    same(folder, program, "a connector, CARTESIAN", ("inp", decks_joined.deck(solid, node + bush, "LEFT, 1, 3\n9002, 1, 6\n")),
         decks_joined.deck(solid, right + held))
    pinned = decks_joined.deck(solid, node + "*CONNECTOR SECTION, ELSET=CN\nJOIN,\n", "LEFT, 1, 3\n9002, 1, 6\n")
    same(folder, program, "a connector, JOIN", ("inp", pinned), decks_joined.deck(solid, right, "LEFT, 1, 3\n9001, 1, 3\n"))
    hinge = decks_joined.deck(solid, node + "*ORIENTATION, NAME=O\n0., 0., 1., 1., 0., 0.\n*CONNECTOR SECTION, ELSET=CN\nHINGE,\nO,\n",
                              "LEFT, 1, 3\n9002, 1, 6\n")
    same(folder, program, "a connector, HINGE", ("inp", hinge), decks_joined.deck(solid, right, "LEFT, 1, 3\n9001, 1, 5\n"))


def supports_and_loads(folder, solid):
    """What a reference node carries in the scene: force and moment, in the axes of space and turned ones."""
    step = "*STEP\n*STATIC\n*CLOAD\n9001, 1, 3.\n9001, 5, 20.\n*END STEP"
    for about, how, join in (("kinematic", "*KINEMATIC\n", "rigid"), ("distributing", "*DISTRIBUTING\n", None)):
        lines, options = brought(folder, decks_joined.deck(solid, decks_joined.REF + decks_joined.COUPLED + how, step=step))
        point, = (value for key, value in options.items() if key == "points")
        check(f"{about}: force and moment", (options.get(f"{point}_force_force"), options.get(f"{point}_force_moment"),
                                             options.get(f"{point}_join")) == ("3,0,0", "0,0.02,0", join), options)
        check(f"{about}: balance of the load", any(line.startswith("balance: the scene has") for line in lines), lines)
    turned = "*NSET, NSET=R\n9001\n*TRANSFORM, NSET=R\n0., 1., 0., -1., 0., 0.\n"
    _, options = brought(folder, decks_joined.deck(solid, decks_joined.REF + turned + decks_joined.COUPLED + "*KINEMATIC\n", step=step))
    check("in turned axes", (options["c1_force_force"], options["c1_force_moment"]) == ("0,3,0", "-0.02,0,0"), options)


def not_taken(folder, solid):
    """What cannot be in the scene has a line."""
    ref, mass, coupled = decks_joined.REF, decks_joined.MASS, decks_joined.COUPLED
    for about, cards, said in (
            ("a mass that nothing joins", ref + mass, "*MASS LUMP: at a node that no volume element has, and nothing joins"),
            ("a coupling without its kind", ref + coupled, "*COUPLING without *KINEMATIC or *DISTRIBUTING"),
            ("rotations alone", ref + coupled + "*KINEMATIC\n4, 6\n", "of rotations alone, which solids do not have"),
            ("a connector of another kind", ref + coupled + "*KINEMATIC\n*NODE\n9002, 47., 3., 9.\n*ELEMENT, TYPE=CONN3D2, ELSET=CN\n"
             "90020, 9001, 9002\n*CONNECTOR SECTION, ELSET=CN\nSLOT,\n", "*CONNECTOR SECTION CN: SLOT, not read: not in the scene"),
            ("an unknown constraint", "*MPC\nSLIDER, 1, 2, 3\n", "*MPC, SLIDER: not understood"),
            ("a mass without its value", ref + "*ELEMENT, TYPE=MASS, ELSET=L\n90001, 9001\n", "element 90001 has no *MASS"),
            ("inertia of a solid's node", "*ELEMENT, TYPE=ROTARYI, ELSET=L\n90001, 1\n*ROTARY INERTIA, ELSET=L\n1., 1., 1.\n",
             "on a node that has no rotation")):
        lines, _ = brought(folder, decks_joined.deck(solid, cards))
        check(f"{about}: listed", sum(said in line for line in lines) == 1, lines)


def main():
    program = starter(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        solid = decks.Solid("hex20", folder, "--elements", "4,2,2")
        for about, (cards, hold) in decks_joined.CASES.items():
            beside(folder, program, about, decks_joined.deck(solid, cards, hold))
        for about, text in decks_joined.BETWEEN.items():
            beside(folder, program, about, decks_joined.between(solid, text))
        ref, lump = decks_joined.REF, decks_joined.MASS
        spread = decks_joined.deck(solid, ref + decks_joined.COUPLED + "*DISTRIBUTING\n1, 6\n" + decks_joined.HELD_BY)
        beside(folder, program, "springs on a distributing coupling", spread, decks_joined.explicit(solid, [47.0, 3.0, 9.0]))
        rigid = decks_joined.deck(solid, ref + lump + "*RIGID BODY, NSET=RIGHT, REF NODE=9001\n")
        beside(folder, program, "beams to a node", decks_joined.deck(solid, ref + lump + "*MPC\nBEAM, RIGHT, 9001\n"), rigid)
        a, b = (node + 1 for node in solid.nodes("right")[:2])
        equal = "".join(f"*EQUATION\n2\n{a}, {d}, 1., {b}, {d}, -1.\n" for d in (1, 2, 3))
        beside(folder, program, "tied nodes", decks_joined.between(solid, decks_joined.TIED), decks_joined.deck(solid, equal))
        nastran(folder, program, solid)
        ansys(folder, program, solid)
        connectors(folder, program, solid)
        supports_and_loads(folder, solid)
        not_taken(folder, solid)
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
