#!/usr/bin/env python3
"""scripts/study/deck_modes on decks of one box in elements that squeal and CalculiX have alike, or not. Breaks when a frequency is
taken from the wrong column or step, when a swap of elements is lost, or when what differs is called the same.

    test_deck_modes.py SQUEAL

Exit status 77, skipped, without ccx."""

import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.study.deck_modes import RIGID, apart, changes, frequencies_of, reasons

import decks
import numpy as np

FAILED = []
SCRIPT = Path(__file__).resolve().parents[1] / "scripts/study/deck_modes"
SECTOR = """
     E I G E N V A L U E   O U T P U T

    2          1   0.4000000E+02   0.6324555E+01   0.1006584E+01   0.0000000E+00
    2          2  -0.9000000E+02   0.0000000E+00   0.0000000E+00   0.1509876E+01

     P A R T I C I P A T I O N   F A C T O R S

      1   0.1000000E+01   0.2000000E+01   0.3000000E+01   0.4000000E+01
"""


def check(about, kept, shown=""):
    print(f"{'ok    ' if kept else 'FAILED'} {about} {'' if kept else shown}")
    if not kept:
        FAILED.append(about)


def parts():
    """What is read and compared, by hand."""
    found = frequencies_of("     E I G E N V A L U E   O U T P U T\n\n      1   0.1E+02   0.3162278E+01   0.5E+00   0.0E+00\n" + SECTOR)
    check("the last step's frequencies alone, below 0 of a negative square", found.tolist() == [1.006584, -1.509876], found)
    both = apart(np.array([RIGID / 2, 1.0, 0.5]), np.array([0.0, 0.5, 1.001]))
    check("in their order, without rigid motions", abs(both - 1e-3) < 1e-12, both)
    check("one that is missing", apart(np.array([1.0, 2.0]), np.array([1.0])) == np.inf)
    found = [words for _, words in changes("*ELEMENT, TYPE=C3D20R\n*STEP, PERTURBATION\n")]
    check("each change, then both", [len(words) for words in found] == [1, 1, 2], found)
    found = reasons(["deck.inp:3: *OUTPUT: output, not needed here", "deck.inp:4: *EXPANSION: not understood"], [])
    check("what is left out explains, output does not", found == ["*EXPANSION: not understood"], found)


def folder_of_decks(folder):
    """One deck of each kind, one of them twice."""
    for kind, names in (("hex20", ("C3D20", "C3D20R")), ("hex8", ("C3D8", "C3D8I"))):
        text = "\n".join(decks.abaqus(decks.Solid(kind, folder, "--distort", "3"))) + "\n"
        written = next(name for name in ("C3D20R", "C3D20", "C3D8I", "C3D8R", "C3D8") if name in text)
        for name in names:
            (folder / f"{name}.inp").write_text(text.replace(written, name))
    shutil.copy(folder / "C3D20.inp", folder / "again.inp")
    (folder / "soft.inp").write_text((folder / "C3D20.inp").read_text().replace("*ELASTIC", "*PLASTIC"))


def main():
    if not shutil.which("ccx"):
        print("no ccx")
        return 77
    parts()
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        folder_of_decks(folder)
        done = subprocess.run([SCRIPT, folder, "--program", sys.argv[1], "-o", folder / "out"], capture_output=True, text=True, check=False)
        check("status", done.returncode == 0, done.stderr)
        with (folder / "out/deck_modes.csv").open(newline="") as lines:
            rows = {Path(row["file"]).stem: row for row in csv.DictReader(lines)}
    found = {name: row["outcome"] for name, row in rows.items()}
    first = "again" if "again" in found else "C3D20"
    check("outcomes", found == {first: "same", "C3D20R": "as same", "C3D8": "as same", "C3D8I": "explained", "soft": "no ccx"}, found)
    check("swaps are said", rows["C3D20R"]["why"] == "C3D20 for C3D20R" and rows["C3D8"]["why"] == "-model_element full", rows)
    check("to 1e-6", all(float(rows[name][column]) < 1e-6 for name, column in (
        (first, "apart"), ("C3D20R", "apart_changed"), ("C3D8", "apart_changed"))), rows)
    check("not before the swap", all(float(rows[name]["apart"]) > 1e-4 for name in ("C3D20R", "C3D8", "C3D8I")), rows)
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
