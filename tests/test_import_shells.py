#!/usr/bin/env python3
"""Shells of imported decks as solids of their thickness: a simply supported plate against Navier's frequency, plates, a fold and a
curved panel beside CalculiX' own shells, the same plate in Nastran's cards, a branch, an offset, pressures and moments. Breaks when a
fibre points the wrong way, an edge opens, or a thickness, side or offset is taken wrongly.

    test_import_shells.py SQUEAL

Comparisons with CalculiX are left out without `ccx`."""

import csv
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks import written
from squeal.decks.balance import sums
from squeal.decks.convert import convert
from squeal.export.calculix import run_calculix
from squeal.tables import BadInput

import numpy as np
from served import starter
from test_import_keywords import FAILED, check

LENGTH, WIDTH, THICK, COUNT = 200.0, 100.0, 2.0, 6
SAME = 1e-7
YOUNG, POISSON, DENSITY = 210e3, 0.3, 7.8e-9


def flat(u, v):
    return LENGTH * u, WIDTH * v, 0.0


def panel(u, v):
    """Of a cylinder, radius 60."""
    return 60 * np.cos(2 * u), 60 * np.sin(2 * u), WIDTH * v


def folded(u, v):
    return flat(u, v) if u <= 0.5 else (LENGTH / 2, WIDTH * v, LENGTH * (u - 0.5))


class Plate:
    """Places and elements of a grid of shells."""

    def __init__(self, kind, counts, place):
        self.kind, self.ids, self.x, self.elements = kind, {}, [], []
        step = 2 if kind == "S8R" else 1
        for i, j in np.ndindex(*counts):
            a, b = step * i, step * j
            ring = [(a, b), (a + step, b), (a + step, b + step), (a, b + step)]
            ring += [(a + 1, b), (a + 2, b + 1), (a + 1, b + 2), (a, b + 1)] if step == 2 else []
            self.elements.append([self.node(p, (step * counts[0], step * counts[1]), place) for p in ring])
        self.ends = step * counts[0], step * counts[1]

    def node(self, at, ends, place):
        if at not in self.ids:
            self.ids[at] = len(self.ids) + 1
            self.x.append(place(at[0] / ends[0], at[1] / ends[1]))
        return self.ids[at]

    def ansys(self, holds, section, real="", kind=181):
        """An archive; hold of a side (axis, end) and labels."""
        lines = ["/PREP7", f"ET,1,{kind}", f"NBLOCK,6,SOLID,{len(self.x)},{len(self.x)}", "(3i9,6e21.13e3)",
                 *(f"{k:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in x) for k, x in enumerate(self.x, 1)), "N,R5.3,LOC,       -1,",
                 f"EBLOCK,19,SOLID,{len(self.elements)},{len(self.elements)}", "(19i8)"]
        lines += ["".join(f"{v:8d}" for v in (1, 1, 1, 1, 0, 0, 0, 0, len(row), 0, k, *row)) for k, row in enumerate(self.elements, 1)]
        lines += ["      -1", f"MP,EX,1,{YOUNG}", f"MP,PRXY,1,{POISSON}", f"MP,DENS,1,{DENSITY}", *section, *([real] if real else [])]
        lines += [f"D,{n},{label},0" for axis, end, labels in holds for n in self.side(axis, end) for label in labels]
        return "\n".join([*lines, "MODOPT,LANB,6", "FINISH"]) + "\n"

    def side(self, axis, end):
        return [number for at, number in self.ids.items() if at[axis] == (self.ends[axis] if end else 0)]

    def abaqus(self, holds, section="", more="", step="*STEP\n*FREQUENCY\n6\n*END STEP"):
        lines = ["*NODE", *(f"{k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(self.x, 1))]
        lines += [f"*ELEMENT, TYPE={self.kind}, ELSET=E", *(", ".join(map(str, (k, *row))) for k, row in enumerate(self.elements, 1))]
        for name, axis, end in (("L", 0, 0), ("R", 0, 1), ("B", 1, 0), ("T", 1, 1)):
            lines += [f"*NSET, NSET={name}", *(f"{number}," for number in self.side(axis, end))]
        lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{DENSITY}"]
        lines += [f"*SHELL SECTION, ELSET=E, MATERIAL=M{section}", f"{THICK}", *more.splitlines(), "*BOUNDARY", *holds, *step.splitlines()]
        return "\n".join(lines) + "\n"

    def nastran(self):
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK"]
        lines += [f"GRID,{k},,{x:.9f},{y:.9f},{z:.9f}" for k, (x, y, z) in enumerate(self.x, 1)]
        lines += [",".join(map(str, ("CQUAD4", k, 7, *row))) for k, row in enumerate(self.elements, 1)]
        lines += [f"PSHELL,7,3,{THICK},3", f"MAT1,3,{YOUNG},,{POISSON},{DENSITY}", "EIGRL,1,,,6"]
        return "\n".join([*lines, *(f"SPC1,1,123456,{number}" for number in self.side(0, 0)), "ENDDATA"]) + "\n"


def brought(folder, text, ending="inp"):
    (folder / f"deck.{ending}").write_text(text)
    lines = convert(folder / f"deck.{ending}", "mm-t-s", folder / "deck")
    check(f"deck.{ending}: balance", any(line.startswith("balance: the scene has") for line in lines), lines)
    return lines


def frequencies(folder, program, text, ending="inp"):
    brought(folder, text, ending)
    done = program.run(folder, ["-options_file", "deck.yaml", "-output_dir", "out", "-output_fields", "0", "-modes_count", str(COUNT)])
    if done.status:
        return np.full(COUNT, np.nan), done.stderr
    with (folder / "out/modes.csv").open(newline="") as rows:
        return np.array([float(row["freq_hz"]) for row in csv.DictReader(rows)][:COUNT]), ""


def beside(folder, program, about, text, limit):
    """Frequencies, and how far CalculiX' are."""
    ours, said = frequencies(folder, program, text)
    check(f"{about}: runs", np.isfinite(ours).all(), said)
    if shutil.which("ccx"):
        theirs = run_calculix(folder, text.splitlines())[0].imag[:COUNT] / (2 * np.pi)
        worst = max(abs(ours / theirs - 1))
        check(f"{about}: CalculiX' shells, apart by {worst:.1e}, {limit:g} allowed", worst < limit, (ours, theirs))
    return ours


def acts(folder):
    """Pressures on both sides and as CalculiX' P push along the normal or against it; a moment is a couple; a force at an edge's end."""
    plate = Plate("S4", (4, 2), flat)
    surfaces = "*SURFACE, NAME=UP\nE, SPOS\n*SURFACE, NAME=DOWN\nE, SNEG\n"
    area = 1e-6 * LENGTH * WIDTH
    corner = plate.ids[4, 2]
    for about, load, force, moment in (
            ("P", "*DLOAD\nE, P, 0.5", (0, 0, 0.5e6 * area), None), ("SPOS", "*DSLOAD\nUP, P, 0.5", (0, 0, -0.5e6 * area), None),
            ("SNEG", "*DSLOAD\nDOWN, P, 0.5", (0, 0, 0.5e6 * area), None),
            ("a moment", f"*CLOAD\n{corner}, 4, 30.\n{corner}, 5, -20.", (0, 0, 0), (0.03, -0.02, 0)),
            ("a force", f"*CLOAD\n{corner}, 3, 7.", (0, 0, 7), (0.7, -1.4, 0))):
        brought(folder, plate.abaqus(["L, 1, 6"], more=surfaces, step=f"*STEP\n*STATIC\n{load}\n*END STEP"))
        total = sums(written.of_scene(folder / "deck.msh", folder / "deck.yaml"))[1]
        check(f"{about}: force", np.allclose(total.force, force, atol=1e-9), total.force)
        check(f"{about}: moment", moment is None or np.allclose(total.moment, moment, atol=1e-9), total.moment)
    check("mass", abs(total.mass - 1e3 * LENGTH * WIDTH * THICK * DENSITY) < 1e-12, total.mass)


def archives(folder, program, plain, clamped):
    """Shells of Ansys with thickness by section or real constant beside those of Abaqus; layers have a line."""
    side, block = [(0, 0, ("ALL",))], ["SECTYPE,1,SHELL,,", "SECOFFSET,MID", "SECBLOCK,     1", f"  {THICK}, 1, 0.0, 3"]
    for about, section, real, kind, counts, other in (
            ("SHELL181 with SECBLOCK is S4", block, "", 181, (24, 12), plain),
            ("SHELL63 with R is S4", [], f"R,1,{THICK}", 63, (24, 12), plain),
            ("SHELL281 with SECDATA is S8R", ["SECTYPE,1,SHELL", f"SECDATA,{THICK},1,0,5", "SECOFFSET,TOP"], "", 281, (16, 8), clamped)):
        plate = Plate("S8R" if kind == 281 else "S4", counts, flat)
        found, said = frequencies(folder, program, plate.ansys(side, section, real, kind), "cdb")
        check(about, np.allclose(found, other, rtol=SAME, atol=0), (found, other, said))
    (folder / "deck.cdb").write_text(Plate("S4", (4, 2), flat).ansys(side, [*block, "SECDATA,1.0,1,0,3"]))
    try:
        lines = str(convert(folder / "deck.cdb", "mm-t-s", folder / "deck"))
    except BadInput as error:
        lines = str(error)
    check("two layers have a line", "2 layers: not taken; let Ansys write a superelement" in lines or "no volume elements" in lines, lines)


def main():
    program = starter(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        holds = ["L,3,3", "R,3,3", "B,3,3", "T,3,3", "L,1,1", "B,2,2"]
        stiffness = YOUNG * THICK**3 / 12 / (1 - POISSON**2)
        navier = np.pi / 2 * np.sqrt(stiffness / (DENSITY * THICK)) * (1 / LENGTH**2 + 1 / WIDTH**2)
        for kind in ("S4", "S8R"):
            first = frequencies(folder, program, Plate(kind, (16, 8), flat).abaqus(holds))[0][0]
            check(f"{kind}, simply supported: {first:.1f} Hz, Navier {navier:.1f}", abs(first / navier - 1) < 3e-3)
        clamped = beside(folder, program, "S8R, clamped", Plate("S8R", (16, 8), flat).abaqus(["L, 1, 6"]), 0.011)
        off = frequencies(folder, program, Plate("S8R", (16, 8), flat).abaqus(["L, 1, 6"], ", OFFSET=SPOS"))[0]
        check("an offset of a flat plate changes nothing", np.allclose(off, clamped, rtol=SAME, atol=0), (off, clamped))
        plain = beside(folder, program, "S4, clamped", Plate("S4", (24, 12), flat).abaqus(["L, 1, 6"]), 0.013)
        nastran = frequencies(folder, program, Plate("S4", (24, 12), flat).nastran(), "bdf")[0]
        check("CQUAD4 is S4", np.allclose(nastran, plain, rtol=SAME, atol=0), (nastran, plain))
        archives(folder, program, plain, clamped)
        beside(folder, program, "S4, a panel of a cylinder", Plate("S4", (24, 16), panel).abaqus(["L, 1, 6"]), 0.006)
        beside(folder, program, "S8R, a fold", Plate("S8R", (16, 8), folded).abaqus(["L, 1, 6"]), 0.014)
        branch, rows = Plate("S4", (24, 12), flat), 13
        levels = [[branch.ids[12, j] for j in range(rows)]]
        for z in (10.0, 20.0, 30.0):
            levels.append([len(branch.x) + j + 1 for j in range(rows)])
            branch.x += [(LENGTH / 2, WIDTH * j / (rows - 1), z) for j in range(rows)]
        branch.elements += [[low[j], low[j + 1], high[j + 1], high[j]] for low, high in zip(levels, levels[1:]) for j in range(rows - 1)]
        beside(folder, program, "S4, a rib", branch.abaqus(["L, 1, 6"]), 0.012)
        acts(folder)
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
