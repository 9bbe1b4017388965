#!/usr/bin/env python3
"""Beams of imported decks, which become a superelement by Timoshenko's theory. Breaks when an axis, a sign or a unit of a rotation is
wrong, or when an unknown is taken for another's.

  matrices   rigid motions, exact deflection of a tip, mass; frequencies of a simply supported beam against the closed form
  halves     a bar of hex20 whose outer half is beams beside the whole bar of hex20: to 1 %
  codes      CBAR of Nastran beside *BEAM GENERAL SECTION; CMASS2 in three directions beside *MASS
  not read   what has a line

    test_import_beams.py SQUEAL"""

import csv
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks.abaqus.beams import circle, pipe, profile_of, rectangle
from squeal.decks.convert import convert
from squeal.decks.joined.frames import axes_of, carried, matrices, released

import numpy as np
from scipy.linalg import eigh
from served import starter
from test_import_keywords import FAILED, check

YOUNG, POISSON, DENSITY = 210000.0, 0.3, 7.8e-9
A, B, PIECES = 10.0, 6.0, 10  # mm, along y and z; elements and beams of each half of the bar


def one_beam(length, along=(0, 1, 0), line=(1, 0, 0), n=1):
    """K and M of n pieces in a row, and the profile."""
    profile = rectangle(A, B)
    line = np.array(line) * length / n / np.linalg.norm(line)
    parts = matrices(line, axes_of(line, np.array(along, float)), (YOUNG, YOUNG / (2 + 2 * POISSON), DENSITY), profile)
    K, M = np.zeros((6 * n + 6,) * 2), np.zeros((6 * n + 6,) * 2)
    for k in range(n):
        for whole, part in zip((K, M), parts):
            whole[6 * k:6 * k + 12, 6 * k:6 * k + 12] += part
    return K, M, profile


def by_hand():
    length, shear = 50.0, YOUNG / (2 + 2 * POISSON)
    line = np.array([2.0, -1.0, 0.5]) / math.sqrt(5.25)
    K, M, profile = one_beam(length, (0.3, 0.2, 0.9), line)
    rigid = np.zeros((12, 6))
    for end, x in enumerate((0 * line, length * line)):
        rigid[6 * end:6 * end + 3, :3] = rigid[6 * end + 3:6 * end + 6, 3:] = np.eye(3)
        rigid[6 * end:6 * end + 3, 3:] = -np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    check("rigid motions without force", abs(K @ rigid).max() < 1e-12 * abs(K).max() * length, abs(K @ rigid).max())
    mass = rigid.T @ M @ rigid
    m = DENSITY * A * B * length
    axes = axes_of(line, np.array([0.3, 0.2, 0.9]))
    tensor = axes.T @ np.diag([profile.bend_1 + profile.bend_2, profile.bend_2, profile.bend_1]) @ axes * DENSITY * length
    tensor += m * length**2 / 3 * (np.eye(3) - np.outer(line, line))
    check("mass and inertia", np.allclose(mass[:3, :3], m * np.eye(3), rtol=1e-12) and np.allclose(mass[3:, 3:], tensor, rtol=1e-11), mass)
    K, _, _ = one_beam(length)
    for d, moment in ((1, profile.bend_1), (2, profile.bend_2)):
        tip = np.linalg.inv(K[6:, 6:])[d, d]
        exact = length**3 / (3 * YOUNG * moment) + length / (0.85 * shear * A * B)
        check(f"a tip's deflection along {'xyz'[d]}", abs(tip / exact - 1) < 1e-12, (tip, exact))
    ends(length, shear)
    check("torsion of a square, a pipe", abs(rectangle(2, 2).torsion / 2.2492 - 1) < 5e-3 and
          abs(pipe(5, 5 - 1e-9).torsion / circle(5).torsion - 1) < 1e-6)
    supported()


def ends(length, shear):
    """A beam with a hinge at its end and rigid arms: K of the tip 1 / (l^3 / 3 E I + l / k G A); an arm h turns a force into h times it."""
    K, M, profile = one_beam(length)
    axes = axes_of(np.array([length, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    hinged = released(K, M, axes, [11])
    exact = 1 / (length**3 / (3 * YOUNG * profile.bend_1) + length / (0.85 * shear * A * B))
    check("a hinge: stiffness of the tip, no moment, the mass", abs(hinged[0][7, 7] / exact - 1) < 1e-12 and
          abs(hinged[0][11]).max() < 1e-9 * exact * length and
          abs(hinged[1][[0, 6, 0, 6], [0, 0, 6, 6]].sum() / (DENSITY * A * B * length) - 1) < 1e-12, (hinged[0][7, 7], exact))
    arms = np.array([[0.0, 2.0, -1.0], [0.5, 3.0, 4.0]])
    moved, mass = carried(K, M, arms)
    rigid = np.zeros((12, 6))
    for end, x in enumerate((-arms[0], np.array([length, 0, 0]) - arms[1])):
        rigid[6 * end:6 * end + 3, :3] = rigid[6 * end + 3:6 * end + 6, 3:] = np.eye(3)
        rigid[6 * end:6 * end + 3, 3:] = -np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    inertia = rigid.T @ mass @ rigid
    check("rigid arms: no force of rigid motions, the centre of mass on the beam", abs(moved @ rigid).max() < 1e-11 * length *
          abs(moved).max() and abs(inertia[4, 2] / (-DENSITY * A * B * length * length / 2) - 1) < 1e-12 and
          abs(inertia[5, 0]) < 1e-12 * inertia[0, 0], inertia)


def supported():
    """Timoshenko's equation of a simply supported beam, k = n pi / l, r^2 = I / A: rho^2 r^2 / (k G) w^4
    - rho (1 + r^2 k^2 (1 + E / kG)) w^2 + E r^2 k^4 = 0; the shear, constant in an element, makes the error of order 2."""
    length, shear, found = 100.0, 0.85 * YOUNG / (2 + 2 * POISSON), []
    for n in (20, 40):
        K, M, profile = one_beam(length, n=n)
        free = np.setdiff1d(np.concatenate([6 * np.arange(n + 1) + 1, 6 * np.arange(n + 1) + 5]), [1, 6 * n + 1])
        found.append(np.sqrt(eigh(K[np.ix_(free, free)], M[np.ix_(free, free)], eigvals_only=True)[:3]))
    for number, (coarse, fine) in enumerate(zip(*found), 1):
        k, r2 = number * math.pi / length, profile.bend_1 / profile.area
        a, b, c = DENSITY**2 * r2 / shear, -DENSITY * (1 + r2 * k**2 * (1 + YOUNG / shear)), YOUNG * r2 * k**4
        exact = math.sqrt((-b - math.sqrt(b * b - 4 * a * c)) / (2 * a))
        limit = (4 * fine - coarse) / 3
        check(f"simply supported, mode {number}: order 2, its limit", 3.8 < (coarse - exact) / (fine - exact) < 4.2 and
              abs(limit / exact - 1) < 1e-5, (coarse, fine, exact))


def bar(pieces, tail=""):
    """A bar of C3D20 from x = 0, 10 mm each, clamped there; the corners first."""
    node, lines, number = {}, [], 1
    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    middles = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1),
               (0, 2, 1)]
    for i in range(pieces):
        for j in range(2):
            names = []
            for a, b, c in corners + middles:
                names.append(node.setdefault((2 * i + a, 2 * j + b, c), len(node) + 1))
            lines.append(f"{number}, " + ", ".join(map(str, names[:10])) + ",\n" + ", ".join(map(str, names[10:])))
            number += 1
    text = "*HEADING\nbar\n*NODE\n" + "".join(f"{n}, {5.0 * i}, {j * A / 4 - A / 2}, {k * B / 2 - B / 2}\n"
                                              for (i, j, k), n in node.items())
    text += "*ELEMENT, TYPE=C3D20, ELSET=BAR\n" + "\n".join(lines) + "\n"
    for name, at in (("LEFT", 0), ("RIGHT", 2 * pieces)):
        text += f"*NSET, NSET={name}\n" + "".join(f"{n}\n" for (i, _, _), n in node.items() if i == at)
    text += f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n"
    return text + tail + "*BOUNDARY\nLEFT, 1, 3\n*STEP\n*FREQUENCY\n8\n*END STEP\n", node


def rods(section):
    """Beams from a node that the right end of the half bar moves with."""
    places = "".join(f"{9000 + k}, {10.0 * (PIECES + k)}, 0., 0.\n" for k in range(PIECES + 1))
    beams = "".join(f"{9000 + k}, {9000 + k}, {9001 + k}\n" for k in range(PIECES))
    return (f"*NODE\n{places}*RIGID BODY, NSET=RIGHT, REF NODE=9000\n*ELEMENT, TYPE=B31, ELSET=ROD\n{beams}{section}")


SECTION = f"*BEAM SECTION, ELSET=ROD, MATERIAL=M, SECTION=RECT\n{A}, {B}\n0., 1., 0.\n"


def frequencies(folder, program, text, ending="inp", words=()):
    """Hz of a deck, and the lines of its import."""
    (folder / f"deck.{ending}").write_text(text)
    lines = convert(folder / f"deck.{ending}", "mm-t-s", folder / "deck")
    done = program.run(folder, ["-options_file", "deck.yaml", "-output_dir", "out", "-output_fields", "0", "-modes_count", "8", *words])
    check(f"runs {done.stderr}", done.status == 0)
    if done.status:
        return np.full(8, np.nan), lines
    with (folder / "out/modes.csv").open(newline="") as rows:
        return np.array([float(row["freq_hz"]) for row in csv.DictReader(rows)][:8]), lines


def halves(folder, program):
    whole, _ = frequencies(folder, program, bar(2 * PIECES)[0])
    half, lines = frequencies(folder, program, bar(PIECES, rods(SECTION))[0])
    worst = max(abs(half / whole - 1))
    check(f"half of beams beside the whole of hex20, apart by {worst:.1e}", worst < 1e-2, (half, whole))
    mean, _ = frequencies(folder, program, bar(PIECES, rods(SECTION).replace("*RIGID BODY, NSET=RIGHT, REF NODE=9000", (
        "*SURFACE, NAME=END, TYPE=NODE\nRIGHT\n*COUPLING, REF NODE=9000, SURFACE=END, CONSTRAINT NAME=C\n*DISTRIBUTING")))[0])
    check("beams on the mean of the end", max(abs(mean / half - 1)) < 2e-2 and (mean < half).all(), (mean, half))
    mass = DENSITY * A * B * 10 * PIECES * 1000
    check("balance, and the mass of the beams", any(line.startswith("balance: the scene has") for line in lines) and
          any(f"{6 * PIECES + 6} unknowns, {mass:.6g} kg" in line for line in lines), lines)
    turned, _ = frequencies(folder, program, bar(PIECES, rods(SECTION.replace("0., 1., 0.", "0., 0., 1.")))[0])
    other, _ = frequencies(folder, program, bar(PIECES, rods(SECTION.replace("0., 1., 0.", "0., 0., 1.").replace(
        f"{A}, {B}", f"{B}, {A}")))[0])
    check("axis 1 turned by a quarter is another beam, with its sides swapped the same", max(abs(turned / half - 1)) > 0.01 and
          max(abs(other / half - 1)) < 1e-9, (turned, other, half))
    heavy = bar(PIECES, rods(SECTION) + f"*ELEMENT, TYPE=MASS, ELSET=L\n8000, {9000 + PIECES}\n*MASS, ELSET=L\n2e-5\n")[0]
    loaded, _ = frequencies(folder, program, heavy)
    check("a mass at the end of the beams", loaded[0] < 0.9 * half[0], (loaded, half))
    return half, loaded


def nastran(folder, program, half, loaded):
    """The same bar in cards of Nastran; I and J as numbers."""
    _, node = bar(PIECES)
    cards = ["SOL 103", "CEND", "SPC = 1", "METHOD = 5", "BEGIN BULK", "EIGRL,5,,,8", f"MAT1,1,{YOUNG},,{POISSON},{DENSITY}"]
    cards += [f"GRID,{n},,{5.0 * i},{j * A / 4 - A / 2},{k * B / 2 - B / 2}" for (i, j, k), n in node.items()]
    text = [line for line in bar(PIECES)[0].split("*ELEMENT")[1].split("*NSET")[0].replace(",\n", ",").splitlines()[1:] if line]
    for line in text:
        number, *names = [word.strip() for word in line.split(",")]
        names = names[:12] + names[16:20] + names[12:16]
        cards += [f"CHEXA,{number},1," + ",".join(names[:6]), "," + ",".join(names[6:14]), "," + ",".join(names[14:])]
    right = [str(n) for (i, _, _), n in node.items() if i == 2 * PIECES]
    left = [str(n) for (i, _, _), n in node.items() if i == 0]
    cards += ["PSOLID,1,1"] + [f"SPC1,1,123,{n}" for n in left]
    cards += [f"GRID,{9000 + k},,{10.0 * (PIECES + k)},0.,0." for k in range(PIECES + 1)]
    fields = ["RBE2", "8001", "9000", "123456", *right]
    cards += [",".join(fields[:9])] + [",".join(["", *fields[at:at + 8]]) for at in range(9, len(fields), 8)]
    profile = rectangle(A, B)
    cards += [f"CBAR,{8100 + k},7,{9000 + k},{9001 + k},0.,1.,0." for k in range(PIECES)]
    cards += [f"PBAR,7,1,{profile.area:.6f},{profile.bend_1:.6f},{profile.bend_2:.6f},{profile.torsion:.6f},", ",,,,,,,,", ",.85,.85"]
    found, lines = frequencies(folder, program, "\n".join([*cards, "ENDDATA"]) + "\n", "bdf")
    check("CBAR beside *BEAM SECTION", max(abs(found / half - 1)) < 1e-6, (found, half, lines))
    beams = [card.replace("CBAR", "CBEAM") for card in cards if not card.startswith(("PBAR", ",,,,,,,,", ",.85"))]
    beams += [f"PBEAM,7,1,{profile.area:.6f},{profile.bend_1:.6f},{profile.bend_2:.6f},,{profile.torsion:.6f},", ",,,,,,,,", ",.85,.85"]
    found, lines = frequencies(folder, program, "\n".join([*beams, "ENDDATA"]) + "\n", "bdf")
    check("CBEAM with K1, K2 beside *BEAM SECTION", max(abs(found / half - 1)) < 1e-6, (found, half, lines))
    shifted = [card.replace(",0.,0.", ",1.5,-2.") if card.startswith("GRID,9") else card for card in cards]
    shifted = [card + "\n,,,0.,-1.5,2.,0.,-1.5,2." if card.startswith("CBAR") else card for card in shifted]
    found, lines = frequencies(folder, program, "\n".join([*shifted, "ENDDATA"]) + "\n", "bdf")
    check("CBAR with offsets from points beside it", max(abs(found / half - 1)) < 1e-6, (found, half, lines))
    shape = [card for card in cards if not card.startswith(("PBAR", ",,,,,,,,", ",.85"))] + [f"PBARL,7,1,,BAR\n,{B},{A}"]
    found, lines = frequencies(folder, program, "\n".join([*shape, "ENDDATA"]) + "\n", "bdf")
    check("PBARL of a BAR", max(abs(found / half - 1)) < 1e-6, (found, half, lines))
    hinge = [card + "\n,,456" if card.startswith(f"CBAR,{8100 + PIECES // 2},") else card for card in cards]
    found, lines = frequencies(folder, program, "\n".join([*hinge, "ENDDATA"]) + "\n", "bdf")
    check("CBAR with pins is a hinge: a lower first mode", found[0] < 0.5 * half[0] and
          not any("not in the scene" in line for line in lines), (found, half))
    masses = [f"CMASS2,{8300 + d},2.e-5,{9000 + PIECES},{d}" for d in (1, 2, 3)]
    found, _ = frequencies(folder, program, "\n".join([*cards, *masses, "ENDDATA"]) + "\n", "bdf")
    check("CMASS2 in three directions beside *MASS", max(abs(found / loaded - 1)) < 1e-6, (found, loaded))
    along = [f"CMASS2,8301,2.e-5,{right[0]},1"]
    one, _ = frequencies(folder, program, "\n".join([*cards, *along, "ENDDATA"]) + "\n", "bdf")
    check("CMASS2 along the bar, at a node of a solid, in no mode across it", (one <= half * (1 + 1e-9)).all() and
          abs(one[0] / half[0] - 1) < 1e-3 and max(abs(one / half - 1)) > 1e-4, (one, half))


def ansys(folder, program, half):
    """The same bar as an archive of Ansys: SOLID186, a rigid region, BEAM188 in a row."""
    _, node = bar(PIECES)
    text = bar(PIECES)[0].split("*ELEMENT")[1].split("*NSET")[0].replace(",\n", ",").splitlines()[1:]
    solids = [[int(word) for word in line.split(",")] for line in text if line]
    rods_at = {9000 + k: (10.0 * (PIECES + k), 0.0, 0.0) for k in range(PIECES + 1)} | {9500: (10.0 * PIECES, 0.0, 50.0)}
    places = {n: (5.0 * i, j * A / 4 - A / 2, k * B / 2 - B / 2) for (i, j, k), n in node.items()} | rods_at
    rows = []
    for number, *nodes in solids:
        head = (1, 1, 1, 1, 0, 0, 0, 0, 20, 0, number, *nodes[:8])
        rows += ["".join(f"{v:8d}" for v in head), "".join(f"{v:8d}" for v in nodes[8:])]
    rows += ["".join(f"{v:8d}" for v in (1, 2, 1, 2, 0, 0, 0, 0, 3, 0, 8100 + k, 9000 + k, 9001 + k, 9500)) for k in range(PIECES)]
    count = len(solids) + PIECES
    lines = ["/PREP7", "ET,1,186", "ET,2,188", f"NBLOCK,6,SOLID,9500,{len(places)}", "(3i9,6e21.13e3)",
             *(f"{n:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in x) for n, x in sorted(places.items())), "N,R5.3,LOC,       -1,",
             f"EBLOCK,19,SOLID,{count},{count}", "(19i8)", *rows, "      -1", f"MP,EX,1,{YOUNG}", f"MP,PRXY,1,{POISSON}",
             f"MP,DENS,1,{DENSITY}", "SECTYPE,2,BEAM,RECT,ROD", f"SECDATA,{A},{B}"]
    lines += [f"D,{n},ALL,0" for (i, _, _), n in node.items() if i == 0]
    lines += [f"CERIG,9000,{n},ALL" for (i, _, _), n in node.items() if i == 2 * PIECES]
    found, said = frequencies(folder, program, "\n".join([*lines, "MODOPT,LANB,8", "FINISH"]) + "\n", "cdb")
    check("BEAM188 beside *BEAM SECTION", max(abs(found / half - 1)) < 1e-6, (found, half, said))
    found, said = frequencies(folder, program, "\n".join([*lines, "MODOPT,LANB,8", "FINISH"]).replace("RECT", "T") + "\n", "cdb")
    check("a section that is not read has a line", any("a section that is not read (RECT" in line for line in said), said)


def not_read(folder):
    for about, section, said in (
            ("a section that is not read", SECTION.replace("RECT", "L").replace(f"{A}, {B}", "1., 1., 1., 1."),
             "that is not read (RECT, CIRC"),
            ("a material that is not there", SECTION.replace("MATERIAL=M,", "MATERIAL=N,"), "its material N has no modulus or no density"),
            ("axis 1 along the beam", SECTION.replace("0., 1., 0.", "1., 0., 0."), "no length, or axis 1 lies along it"),
            ("no section", "", "has no *BEAM SECTION")):
        (folder / "deck.inp").write_text(bar(PIECES, rods(section))[0])
        lines = convert(folder / "deck.inp", "mm-t-s", folder / "deck")
        check(f"{about}: has a line", any(said in line for line in lines), lines)
    check("walls thicker than the section", profile_of("PIPE", [5.0, 6.0]) is None and profile_of("BOX", [10.0, 10.0, 6.0]) is None)


def main():
    program = starter(sys.argv[1])
    by_hand()
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        half, loaded = halves(Path(name), program)
        nastran(Path(name), program, half, loaded)
        ansys(Path(name), program, half)
        not_read(Path(name))
    program.end()
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
