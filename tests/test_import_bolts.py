#!/usr/bin/env python3
"""Pre-tensioned bolts of decks (tests/bolted.py) beside CalculiX: displacements of all nodes and shortenings of the bolts, in elements
that both programs have alike (nodes of faces of second order have other areas there): tightened by forces, by a length, two bolts at
once, and then loaded with the lengths that they have; clearances and interferences of the joint, in closed form. Breaks when a tension,
an axis, the side of a cut or the lock of a later step is lost. The reference are CalculiX' own equations of *PRE-TENSION SECTION (its
printed digits are 7).

    test_import_bolts.py SQUEAL"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
try:
    import h5py
    import numpy
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

from bolted import REFERENCE, deck, forces, mesh
from served import sooner
from squeal.decks.convert import convert

NEAR = 2e-6  # m, farther apart than any two nodes that are no twins
RTOL = 1e-5  # of the largest displacement, and of a shortening: asked
FAILED = []


def check(about, kept, shown=""):
    print(f"{'ok    ' if kept else 'FAILED'} {about} {shown}")
    if not kept:
        FAILED.append(about)


def calculix(folder, text):
    """The last displacements that CalculiX prints, m, by node."""
    (folder / "job.inp").write_text(text)
    done = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    if "Job finished" not in done.stdout:
        raise SystemExit(f"ccx: {done.stdout[-300:]}")
    found = {}
    for line in (folder / "job.dat").read_text().splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            found[int(words[0])] = [float(word) / 1000 for word in words[1:]]
    return found


def squeal(program, folder, text):
    """Places and displacements of its nodes, and tension and shortening of each bolt."""
    (folder / "deck.inp").write_text(text)
    printed = "\n".join(convert(folder / "deck.inp", "mm-t-s", folder / "deck", strict=False))
    check("balance", "UNBALANCED" not in printed, printed if "UNBALANCED" in printed else "")
    n_bolts = len(re.findall(r"^\*PRE-TENSION", text, re.M | re.I)) or len(re.findall("PRETENSION", text))
    check("balance: number of bolts", not n_bolts or f"\nbolts: {n_bolts}, " in printed, printed)
    done = subprocess.run([program, "-options_file", folder / "deck.yaml", "-analysis", "static", "-output_dir", folder / "out"],
                          capture_output=True, text=True, check=False, timeout=300)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    with h5py.File(folder / "out/static.h5") as file:
        x, u = file["VTKHDF/Points"][:], file["VTKHDF/PointData/displacement_m"][:]
    bolts = [list(map(float, found)) for found in re.findall(r"^bolt \S+: tension (\S+) N, shortened by (\S+) m", done.stdout, re.M)]
    return x, u.reshape(len(x), 3), numpy.array(bolts)


def compare(about, nodes, theirs, x, u):
    """Displacements of all nodes, which are told by their places, of twins in one place by what is nearer."""
    places = numpy.array([[p * size / 2000 for p, size in zip(place, (2.5, 2.5, 4.0))] for place, _ in nodes])
    values = numpy.array([theirs[number] for number in nodes.values()])
    largest, worst = numpy.abs(values).max(), 0.0
    for place, mine in zip(x, u):
        near = numpy.abs(places - place).max(axis=1) < NEAR
        worst = max(worst, numpy.abs(values[near] - mine).max(axis=1).min() / largest)
    check(f"{about}: displacements", len(x) == len(nodes) and worst <= RTOL, f"{worst:.1e} of the largest, {RTOL:g} allowed")


def beside(program, about, kind, bolts, steps, tensions=None):
    """One deck in both programs."""
    with tempfile.TemporaryDirectory() as name:
        folder, text = Path(name), deck(kind, bolts, steps)
        theirs = calculix(folder, text)
        x, u, found = squeal(program, folder, text)
    compare(about, mesh(kind.startswith("C3D20"), bolts)[0], theirs, x, u)
    lengths = numpy.array([theirs[REFERENCE + b][0] for b in range(bolts)])
    off = numpy.abs(found[:, 1] / lengths - 1).max()
    check(f"{about}: shortenings", off <= RTOL, f"{off:.1e}, {RTOL:g} allowed")
    if tensions is not None:
        off = numpy.abs(found[:, 0] / tensions - 1).max()
        check(f"{about}: tensions", off <= 1e-8, f"{off:.1e}, 1e-8 allowed")


def clearances(program):
    """A gap v of the whole joint: the upper flange moves down by v, and the bolt is shortened by v more, all else alike."""
    lengths = []
    for value in (0.0, 2e-7, -1e-7, 3e-4):
        text = deck("C3D8I", 1, (forces([0.1]),))
        text = text.replace("*CONTACT PAIR", f"*CLEARANCE, MASTER=LOW_TOP, SLAVE=UP_BOTTOM, VALUE={value}\n*CONTACT PAIR", 1)
        with tempfile.TemporaryDirectory() as name:
            lengths.append(squeal(program, Path(name), text)[2][0, 1])
    text = deck("C3D8I", 1, (forces([0.1]),))
    table = "\n".join(f"{number}, 2e-7" for (place, body), number in mesh(False, 1)[0].items() if body == "UP" and place[2] == 4)
    text = text.replace("*CONTACT PAIR", f"*CLEARANCE, MASTER=LOW_TOP, SLAVE=UP_BOTTOM, TABULAR\n{table}\n*CONTACT PAIR", 1)
    with tempfile.TemporaryDirectory() as name:
        found = squeal(program, Path(name), text)[2][0, 1]
    check("*CLEARANCE, TABULAR of the same at all nodes", abs(found / lengths[1] - 1) <= 1e-9, f"{found} for {lengths[1]}")
    off = abs((numpy.array(lengths[1:]) - lengths[0]) / numpy.array([2e-10, -1e-10, 3e-7]) - 1).max()
    check("*CLEARANCE of a joint that a bolt closes: its shortening grows by it", off <= 1e-6, f"{off:.1e}, 1e-6 allowed")


def fitted(program):
    """Surfaces that overlap: as the deck says, in closed form (the bolt is longer by it), or in the mesh, beside CalculiX, where an overlap
    presses from the beginning without that card."""
    lengths, place = [], "*CLOAD"
    for cards in ("", "*CONTACT INTERFERENCE, AMPLITUDE=GROWS\nUP_BOTTOM, LOW_TOP, -2e-4\n",
                  "*CONTACT INTERFERENCE, SHRINK\nUP_BOTTOM, LOW_TOP\n"):
        text = deck("C3D8I", 1, (forces([0.1]),)).replace("*STEP", "*AMPLITUDE, NAME=GROWS\n0., 0., 1., 1.\n*STEP", 1)
        with tempfile.TemporaryDirectory() as name:
            lengths.append(squeal(program, Path(name), text.replace(place, cards + place, 1))[2][0, 1])
    off = abs((lengths[1] - lengths[0]) / -2e-7 - 1)
    check("*CONTACT INTERFERENCE of a joint: its bolt is shortened by that less", off <= 1e-6, f"{off:.1e}, 1e-6 allowed")
    check("SHRINK of surfaces that do not overlap changes nothing", lengths[2] == lengths[0], lengths)
    nodes, lines = mesh(False, 1)[0], deck("C3D8I", 1, ("",)).splitlines()
    for (at, body), number in nodes.items():
        if body == "UP" and at[2] == 4:
            lines[number] = lines[number].rpartition(",")[0] + ", 7.999"
    plain = "\n".join(line for line in lines if not line.startswith("*PRE-TENSION")) + "\n"
    shrink = plain.replace("*NODE PRINT", "*CONTACT INTERFERENCE, SHRINK\nUP_BOTTOM, LOW_TOP\n*NODE PRINT", 1)
    with tempfile.TemporaryDirectory() as name:
        theirs = calculix(Path(name), plain)
        x, u, _ = squeal(program, Path(name), shrink)
    compare("SHRINK of a mesh that overlaps", nodes, theirs, x, u)


def main(program):
    fixed = "*CLOAD, OP=NEW\nTOP, 3, 1e-3\nTOP, 1, 3e-4\n*BOUNDARY, FIXED\n" + f"{REFERENCE}, 1, 1\n{REFERENCE + 1}, 1, 1"
    beside(program, "a force, C3D8I", "C3D8I", 1, (forces([0.1]),), [0.1])
    beside(program, "a length", "C3D8I", 1, (f"*BOUNDARY\n{REFERENCE}, 1, 1, 1e-6",))
    beside(program, "two forces", "C3D8I", 2, (forces([0.1, 0.25]),), [0.1, 0.25])
    clearances(program)
    fitted(program)
    beside(program, "two forces, then pulled with their lengths", "C3D8I", 2, (forces([0.1, 0.25]), fixed))


if __name__ == "__main__":
    if not shutil.which("ccx"):
        print("skipped: there is no ccx")
        sys.exit(77)
    with sooner(sys.argv[1]) as quick:
        main(quick)
    sys.exit(1 if FAILED else 0)
