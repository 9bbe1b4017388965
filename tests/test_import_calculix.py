#!/usr/bin/env python3
"""Decks that CalculiX runs, which are written in another way than scripts/import once took for granted: each gives the scene
and mesh of the same deck in plain words. Loads of several steps against the reactions of CalculiX 2.20, names of files, inputs
that are no files, and exceptions. Breaks when a line is dropped without a word, or when one that is not needed stops an import.

    test_import_calculix.py SQUEAL MPIRUN"""

import contextlib
import csv
import io
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal import tables
from squeal.decks import written
from squeal.decks.balance import sums
from squeal.decks.convert import convert
from squeal.tables import BadInput

import h5py
import numpy as np
from served import starter
from test_import_keywords import FAILED, check, scene

HEAD = "*HEADING\nbar\n"
NODES = "*NODE\n" + "".join(f"{4 * k + i}, {10 * k}, {y}, {z}\n" for k in range(3)
                            for i, (y, z) in enumerate(((0, 0), (10, 0), (10, 10), (0, 10)), 1))
ELEMENTS = "*ELEMENT, TYPE=C3D8I, ELSET=E\n1, 1,2,3,4, 5,6,7,8\n2, 5,6,7,8, 9,10,11,12\n"
SETS = "*NSET, NSET=FIX, GENERATE\n1, 4\n"
MATERIAL = "*MATERIAL, NAME=M\n*ELASTIC\n210000., .3\n*DENSITY\n7.8E-9\n"
SECTION = "*SOLID SECTION, ELSET=E, MATERIAL=M\n"
HELD = "*BOUNDARY\nFIX, 1, 3\n"
STEP = "*STEP\n*FREQUENCY\n6\n*END STEP\n"
PLAIN = HEAD + NODES + ELEMENTS + SETS + MATERIAL + SECTION + HELD + STEP
FIRST = 18898.56  # Hz, of squeal with these two elements; CalculiX 2.20 has 19073 with its own incompatible modes


def brought(folder, text, name="deck"):
    """Options of the scene, lines that were printed, and the model that the two files hold."""
    (folder / f"{name}.inp").write_bytes(text if isinstance(text, bytes) else text.encode())
    printed = convert(folder / f"{name}.inp", "mm-t-s", folder / name)
    options, _ = scene(folder, name)
    options.pop("model_mesh", None)
    return options, printed, written.of_scene(folder / f"{name}.msh", folder / f"{name}.yaml")


def spellings():
    """About, deck, and the beginnings of lines that must be printed; all else must be as in the plain deck."""
    yield "blanks before a keyword", PLAIN.replace(HELD, "").replace(
        "*END STEP", "*NODE FILE\nU\n   *BOUNDARY\n\t FIX, 1, 3\n*END STEP"), ()
    yield "a keyword cut short", PLAIN.replace("*BOUNDARY", "*BOUND"), ()
    yield "a parameter cut short", PLAIN.replace("GENERATE", "GEN"), ()
    yield "no blank in a keyword", PLAIN.replace("*END STEP", "*ENDSTEP").replace("*SOLID SECTION", "*SOLIDSECTION"), ()
    yield "blanks in a keyword and in a name", PLAIN.replace("*ELASTIC", "* E LASTIC ").replace("MATERIAL=M", "MATER IAL = \tm"), ()
    yield "a value cut short", PLAIN.replace("*ELASTIC", "*ELASTIC, TYPE=ISO"), ()
    yield "coordinates left out", NODES.replace(", 0\n", "\n").replace("1, 0, 0\n", "1\n").join(PLAIN.split(NODES)), ()
    yield "coordinates left blank", NODES.replace(", 0,", ", ,").join(PLAIN.split(NODES)), ()
    yield "*DENSITY behind *CREEP", PLAIN.replace("*DENSITY", "*CREEP, LAW=NORTON\n1e-10, 5., 0.\n*DENSITY"), ("*CREEP: not understood",)
    yield "degree of freedom 0", PLAIN.replace(HELD, HELD + "FIX, 0, 0, 20.\n"), ("*BOUNDARY: degrees of freedom 0 to 0",)
    yield "a surface without rows", PLAIN.replace(MATERIAL, MATERIAL + "*SURFACE, NAME=UNUSED\n"), ("*SURFACE UNUSED has no faces",)
    yield "a number that is no node", PLAIN.replace("1, 4\n", "1, 4\n*NSET, NSET=FIX\n1, 9999\n"), (
        "*NSET: 1 of its numbers are no nodes of the file, the first 9999",)
    yield "a number that is no element", PLAIN.replace(SECTION, "*ELSET, ELSET=E\n1, 77\n" + SECTION), (
        "*ELSET: 1 of its numbers are no elements of the file, the first 77",)
    yield "numbers behind those of an element", PLAIN.replace("6,7,8\n", "6,7,8, 1,2,\n").replace("11,12\n", "11,12, 1,2,\n"), (
        "*ELEMENT: lines with more than the 9 numbers",)
    yield "the mark of UTF-8", b"\xef\xbb\xbf" + PLAIN.encode(), ()
    yield "text before the first keyword", ">**\n" + PLAIN, ("'>**': of no keyword",)
    yield "a star alone", PLAIN.replace("*STEP", "*\n*STEP"), ("'*': of no keyword",)
    yield "a support of a node that is not there", PLAIN.replace(HELD, HELD + "99, 1, 3\n"), ("node 99 is not in the file",)
    yield "directions held one by one", PLAIN.replace("FIX, 1, 3\n", "FIX, 1\nFIX, 2\nFIX, 3\n"), ()
    yield "what a contact has of its own", PLAIN.replace(HELD, (
        "*SURFACE, NAME=A\nE, S1\n*SURFACE, NAME=B\nE, S2\n*CLEARANCE, MASTER=A, SLAVE=B, TABULAR\n1, 0.1\n*CLEARANCE, MASTER=A, SLAVE=B, "
        "TABULAR, BOLT\n1, 0.1\n") + HELD).replace("*END STEP", "*CONTACT INTERFERENCE\nA, B, 0.01\n*END STEP"), (
            "*CONTACT INTERFERENCE: there is no *CONTACT PAIR of A, B: not taken",
            "*CLEARANCE: there is no *CONTACT PAIR of B, A: not taken",
            "*CLEARANCE: only MASTER, SLAVE and VALUE or TABULAR are read: not taken; give the contact a `gap`")
    yield "an element with temperature", PLAIN.replace("C3D8I", "C3D8T"), ("C3D8T: its temperature is no unknown of squeal",)
    yield "a beam beside solids", PLAIN.replace(HELD, (
        "*ELEMENT, TYPE=B31, ELSET=ROD\n101, 9,11\n*BEAM SECTION, ELSET=ROD, MATERIAL=M, SECTION=HEX\n0.5, 0.5\n1., 0., 0.\n"
        "*SURFACE, NAME=SS\nROD, SPOS\n") + HELD), (
            "the elements of ROD are none", "*SURFACE SS has no faces", "*BEAM SECTION ROD: a section, or a direction")
    yield "cyclic symmetry is no glue", PLAIN.replace(HELD, (
        "*SURFACE, NAME=A\nE, S1\n*SURFACE, NAME=B\nE, S2\n*TIE, NAME=T, CYCLIC SYMMETRY\nA, B\n") + HELD), (
            "*TIE, CYCLIC SYMMETRY: not read",)
    yield "axes of a supported node", PLAIN.replace(HELD, "*TRANSFORM, NSET=FIX\n1., 1., 0., -1., 1., 0.\n" + HELD), ()
    yield "axes that an isotropic material does not need", PLAIN.replace(SECTION, (
        "*ORIENTATION, NAME=O, SYSTEM=SPHERICAL\n0., 0., 0., 1., 0., 0.\n" + SECTION.replace("E,", "E, ORIENTATION=O,"))), ()


def same_model(one, other):
    """Whether nodes, elements, supports and parts are the same."""
    cells = [np.concatenate([nodes for _, nodes in model.blocks]) for model in (one, other)]
    return (np.array_equal(one.x, other.x) and np.array_equal(one.held, other.held) and np.array_equal(*cells)
            and [part[:2] for part in one.parts] == [part[:2] for part in other.parts])


def ways(folder):
    options, printed, model = brought(folder, PLAIN, "plain")
    n_printed = len(printed)
    for about, text, said in spellings():
        found, lines, other = brought(folder, text)
        check(f"{about}: the scene", found == options and same_model(model, other), found)
        for words in said:
            check(f"{about}: listed {words}", sum(words in line for line in lines) == 1, lines)
        extra = ("*NODE FILE",) if "*NODE FILE" in str(text) else ()
        check(f"{about}: nothing else is listed", len(lines) == n_printed + len(said) + len(extra), lines)


def included(folder):
    """Data of a keyword that go on in another file, and behind the line that names it."""
    rows = NODES.split("\n")
    (folder / "rows.txt").write_text("\n".join(rows[3:7]) + "\n")
    (folder / "more.txt").write_text("2, 5,6,7,8, 9,10,11,12\n" + SETS)
    text = PLAIN.replace(NODES, "\n".join([*rows[:3], "*INCLUDE, INPUT=rows.txt", *rows[7:]]))
    text = text.replace(ELEMENTS + SETS, ELEMENTS.replace("2, 5,6,7,8, 9,10,11,12\n", "*INCLUDE, INPUT=more.txt\n"))
    options, _, model = brought(folder, PLAIN)
    found, _, other = brought(folder, text)
    check("data in other files: the scene", found == options and same_model(model, other), found)
    try:
        brought(folder, PLAIN.replace("210000., .3\n", "*INCLUDE, INPUT=rows.txt\n"))
        check("data of a material in another file", False, "it was not refused")
    except BadInput as error:
        check("data of a material in another file", "rows.txt:1: *INCLUDE within the data of *ELASTIC" in str(error), error)


def overlapping(folder):
    """A later section counts for the elements that it names; squeal's frequency is that of the plain deck."""
    text = PLAIN.replace(SECTION, SECTION + "*MATERIAL, NAME=N\n*ELASTIC\n70000., .3\n*DENSITY\n2.7E-9\n*ELSET, ELSET=TOP\n2\n"
                                            "*SOLID SECTION, ELSET=TOP, MATERIAL=N\n")
    options, lines, model = brought(folder, text)
    rows, total, _ = sums(model)
    check("a later section: its part", (options["parts"], options["top_density"], [row.cells for row in rows]) == ("e,top", "2700", [1, 1]),
          options)
    check("a later section: mass of 1000 mm^3 of each", abs(total.mass - (7.8e-3 + 2.7e-3)) < 1e-15, total.mass)
    check("a later section: listed", sum("1 elements of E have the later section of TOP" in line for line in lines) == 1, lines)
    wedges = PLAIN.replace("C3D8I", "C3D6").replace("1, 1,2,3,4, 5,6,7,8\n2, 5,6,7,8, 9,10,11,12", "1, 1,2,3, 5,6,7\n2, 1,3,4, 5,7,8")
    _, lines, _ = brought(folder, wedges)
    check("C3D6: differs", sum("differs: C3D6: squeal has 6 points, CalculiX 2" in line for line in lines) == 1, lines)


def distributed(folder):
    """Axes that a distribution gives to elements: a part for each, with the axes of its row."""
    material = MATERIAL.replace("*ELASTIC\n210000., .3\n", (
        "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n9e4, 7e4, 5e4, .2, .2, .2, 3e4, 3e4,\n3e4\n"))
    axes = "*DISTRIBUTION, NAME=D\n, 1., 0., 0., 0., 1., 0.\n2, 0., 0., 1., 1., 0., 0.\n*ORIENTATION, NAME=O\nD\n"
    options, _, model = brought(folder, PLAIN.replace(MATERIAL + SECTION, material + axes + SECTION.replace("E,", "E, ORIENTATION=O,")))
    found = [(row.name, options[f"{row.name}_axis_1"], options[f"{row.name}_axis_2"], round(1e3 * row.centre[0], 6))
             for row in sums(model)[0]]
    check("axes by a distribution", found == [("e", "1,0,0", "0,1,0", 5), ("e_2", "0,0,1", "1,0,0", 15)], found)


# Loads of steps, and the total reaction at x = 0 in the last one by CalculiX 2.20, *NODE PRINT, TOTALS=ONLY. Pressures are on
# faces whose nodes are half at x = 0; CalculiX leaves out what acts on held nodes, here half of 2 MPa on the 100 mm^2 of element 1
PICKED = "*NSET, NSET=L\n9, 10, 11, 12\n*NSET, NSET=L2\n9, 10\n*ELSET, ELSET=B\n2\n*SURFACE, NAME=SA\nE, S3\n*SURFACE, NAME=SB\nB, S3\n"
AT_HELD, WEIGHT = 100, 0.0156 * 9.81  # N
STEPS = [("a node of a set", ["*CLOAD\nL, 2, 1.", "*CLOAD\n9, 2, 0."], (0, 3, 0)),
         ("another set with the same nodes", ["*CLOAD\nL, 2, 1.", "*CLOAD\nL2, 2, 5."], (0, 12, 0)),
         ("OP=NEW", ["*CLOAD\nL, 2, 1.", "*CLOAD, OP=NEW\nL2, 2, 5."], (0, 10, 0)),
         ("pressure on a face of a set", ["*DLOAD\nE, P3, 2.", "*DLOAD\n2, P3, 5."], (0, 0, 600 + AT_HELD)),
         ("pressure on a surface over another", ["*DSLOAD\nSA, P, 2.", "*DSLOAD\nSB, P, 5."], (0, 0, 600 + AT_HELD)),
         ("*DLOAD over *DSLOAD", ["*DSLOAD\nSA, P, 2.", "*DLOAD\nB, P3, 5."], (0, 0, 600 + AT_HELD)),
         ("*DLOAD, OP=NEW ends *DSLOAD", ["*DSLOAD\nSA, P, 2.\n*CLOAD\nL, 2, 1.", "*DLOAD, OP=NEW\nB, P3, 5."], (0, 4, 500)),
         ("*DSLOAD, OP=NEW ends *DLOAD", ["*DLOAD\nE, P3, 2.\n", "*DSLOAD, OP=NEW\nSB, P, 5."], (0, 0, 500)),
         ("within a step pressures add up", ["*DLOAD\nE, P3, 2.\nB, P3, 1."], (0, 0, 400 + AT_HELD)),
         ("gravity of the last step", ["*DLOAD\nE, GRAV, 1000., 0., -1., 0.", "*DLOAD\nE, GRAV, 9810., 0., -1., 0."], (0, -WEIGHT, 0))]


def steps(folder):
    for about, parts, wanted in STEPS:
        text = HEAD + NODES + ELEMENTS + SETS + PICKED + MATERIAL + SECTION + HELD
        _, lines, model = brought(folder, text + "".join(f"*STEP\n*STATIC\n{part}\n*END STEP\n" for part in parts))
        total = sums(model)[1]
        check(f"steps: {about}: {wanted} N", np.allclose(total.force, wanted, rtol=0, atol=1e-9), total.force)
        check(f"steps: {about}: balance", any(line.startswith("balance: the scene has") for line in lines), lines)


def supports(folder):
    """Of a node and direction the last line counts, whichever set named it; OP=NEW ends the supports of earlier steps."""
    options, _, model = brought(folder, PLAIN.replace("FIX, 1, 3\n", "FIX, 1, 3\n1, 1, 1, 0.01\n"))
    moved = options["motions"]
    check("a node of a set is moved", (options[f"{moved}_displacement"], options[f"{moved}_directions"]) == ("1e-05,0,0", "x"), options)
    fixed = sorted((options[f"{name}_fix"]) for name in options["supports"].split(","))
    check("the others are held", fixed == ["xyz", "yz"] and model.held[:4].all() and model.held.sum() == 12, options)
    text = PLAIN.replace(STEP, "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n*BOUNDARY, OP=NEW\nFIX, 1, 1\n*END STEP\n")
    options, lines, model = brought(folder, text)
    check("OP=NEW: what earlier steps held is free", options["fix_fix"] == "x" and model.held.sum() == 4, options)
    check("OP=NEW: listed", sum("OP=NEW: supports of earlier steps act no longer" in line for line in lines) == 1, lines)


def stated(folder):
    """Amplitudes, temperatures, damping and laws of contact that are values of the scene."""
    ramp = "*AMPLITUDE, NAME=A\n0., 0., 2., 4.\n"
    pressed = "*STEP\n*STATIC\n0.1, 0.5\n*CLOAD, AMPLITUDE=A\n9, 1, 3.\n*DLOAD, AMPLITUDE=A\n2, P2, 7.\n*END STEP\n"
    options, lines, model = brought(folder, PLAIN.replace(STEP, ramp + pressed))
    check("amplitude: 4/2 x 0.5 of loads", abs(sums(model)[1].force - [3 - 7 * 100, 0, 0]).max() < 1e-9, sums(model)[1].force)
    check("amplitude: said", sum("times 1, the value of *AMPLITUDE A" in line for line in lines) == 2, lines)
    warm = MATERIAL.replace("210000., .3", "200000., .3, 0.\n100000., .2, 100.").replace("7.8E-9", "8.E-9, 0.\n7.E-9, 100.")
    for about, given, young, poisson, density in (
            ("initial temperature", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nFIX, 25.\n", 175e9, 0.275, 7750),
            ("a temperature beyond the table", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nFIX, 250.\n", 100e9, 0.2, 7000),
            ("no temperature", "", 200e9, 0.3, 8000)):
        options, _, _ = brought(folder, PLAIN.replace(MATERIAL, warm + given))
        found = [float(options[f"e_{key}"]) for key in ("young", "poisson", "density")]
        check(f"{about}: material", np.allclose(found, (young, poisson, density), rtol=1e-12), found)
    lossy = PLAIN.replace("7.8E-9\n", "7.8E-9\n*DAMPING, STRUCTURAL=0.02\n").replace("*FREQUENCY\n6", "*FREQUENCY\n6, 1000., 4000.")
    options, _, _ = brought(folder, lossy)
    twice = lossy.replace("*END STEP", "*GLOBAL DAMPING, ALPHA=5., STRUCTURAL=0.01\n*END STEP", 1)
    more, _, _ = brought(folder, twice)
    later = twice + "*STEP\n*DYNAMIC\n1.\n*GLOBAL DAMPING, ALPHA=50.\n*END STEP\n"
    other, lines, _ = brought(folder, later)
    check("global damping of a step without modes", other["e_alpha"] == more["e_alpha"] and
          sum("of a step without modes" in line for line in lines) == 1, (other, lines))
    check("global damping", abs(float(more["e_loss_factor"]) - 0.03) < 1e-15 and float(more["e_alpha"]) == 5, more)
    check("structural damping", options["e_loss_factor"] == "0.02" and "model_loss_frequency" not in options, options)
    law = GAP.replace("=LINEAR\n1.e5", "=EXPONENTIAL\n0.01, 3.\n*FRICTION, EXPONENTIAL DECAY\n0.5, 0.3, 0.002")
    options, _, _ = brought(folder, law)
    found = [options[f"i_{key}"] for key in ("pressure_law", "pressure_c0", "pressure_p0", "friction_law", "mu_static", "mu_kinetic")]
    check("exponential law and decay of friction", found == ["exponential", "1e-05", "3000000", "static_kinetic", "0.5", "0.3"] and
          abs(float(options["i_mu_decay_speed"]) - 0.5) < 1e-12, options)
    _, lines, _ = brought(folder, GAP.replace("1.e5\n", "1.e5\n*FRICTION\n0.5, 0., 0.\n0.4, 0., 10.\n"))
    check("a table of friction is said", sum("as a table over slip rate and pressure" in line for line in lines) == 1, lines)


def modes(folder, program):
    """The plain deck by squeal."""
    brought(folder, PLAIN, "plain")
    done = program.run(folder, ["-options_file", "plain.yaml", "-output_dir", "out", "-output_fields", "0"])
    check("the plain deck runs", done.status == 0, done.stderr)
    with (folder / "out/modes.csv").open(newline="") as rows:
        first = float(next(csv.DictReader(rows))["freq_hz"])
    check("the plain deck: first frequency", abs(first - FIRST) < 0.01 and abs(first / 19073 - 1) < 0.01, first)


GAP = HEAD + NODES + (
    "".join(f"{12 + i}, {x}, {y}, {z}\n" for x in (20.02, 25.02) for i, (y, z) in
            [(j + (4 if x > 21 else 0), p) for j, p in enumerate(((0, 0), (10, 0), (10, 10), (0, 10)), 1)])) + ELEMENTS + (
    "*ELEMENT, TYPE=C3D8I, ELSET=HIGH\n3, 13,14,15,16, 17,18,19,20\n") + SETS + "*NSET, NSET=TOP\n17, 18, 19, 20\n" + (
    "*SURFACE, NAME=MASTER\n2, S2\n*SURFACE, NAME=SLAVE\nHIGH, S1\n") + MATERIAL + SECTION + SECTION.replace("=E", "=HIGH") + (
    "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.e5\n*CONTACT PAIR, INTERACTION=I\nSLAVE, MASTER\n"
    ) + HELD + "TOP, 2, 3\n*STEP\n*STATIC\n*CLOAD\nTOP, 1, -100.\n*END STEP\n"


def gap(folder, program):
    """Surfaces that are 0.02 mm apart: a tolerance that finds all four pairs, which close and carry the 400 N, and a line that says
    so. The block beyond the gap moves by the gap and the compression of pairs, 4 MPa / 1e14 N/m^3, and of the bar."""
    options, lines, _ = brought(folder, GAP, "gap")
    check("gap: its tolerance", 2e-5 < float(options["i_tolerance"]) < 2.2e-5, options)
    check("gap: listed", sum("apart by 0.02 to 0.02" in line for line in lines) == 1, lines)
    done = program.run(folder, ["-options_file", "gap.yaml", "-analysis", "static", "-output_dir", "gap"])
    check("gap: statics run", done.status == 0, done.stderr)
    if done.status == 0:
        with (folder / "gap/static.csv").open(newline="") as rows:
            force = [float(row["lambda_n_n"]) for row in csv.DictReader(rows)]
        check("gap: four pairs of 100 N", np.allclose(force, 4 * [100], atol=1e-6), force)
        with h5py.File(folder / "gap/static.h5") as file:
            moved = -file["VTKHDF/PointData/displacement_m"][:, 0].min()
        check("gap: it closes", 2e-5 + 4e6 / 1e14 < moved < 2e-5 + 4e6 / 1e14 + 4e6 / 210e9 * 0.025, moved)
    closed = GAP.replace("20.02", "20").replace("25.02", "25")
    options, lines, _ = brought(folder, closed)
    check("no gap: no tolerance", "i_tolerance" not in options and not any("apart by" in line for line in lines), options)


NAMES = ["brake, v2", "brake #2", "a: b", "[2] brake", "{x", "*x", "&x", "'x'", '"x"', "bremse \u00fc", "-x", "true"]
WRONG = ["line\nbreak", "next\u0085line", "separator\u2028", "tab\t", "escape\x1b"]


def names(folder, program):
    """Any name of a deck is that of a mesh which squeal finds; line breaks and control characters are refused."""
    for name in NAMES:
        brought(folder, PLAIN, name)
        done = program.run(folder, ["-options_file", f"./{name}.yaml", "-model_view", "-output_dir", "named", "-output_fields", "0"])
        check(f"a deck named {name!r} runs", done.status == 0, done.stderr)
    for name in WRONG:
        (folder / f"{name}.inp").write_text(PLAIN)
        for path, output in ((folder / f"{name}.inp", folder / "out"), (folder / "plain.inp", folder / name)):
            try:
                convert(path, "mm-t-s", output)
                check(f"refused: {name!r}", False, "it was not")
            except BadInput as error:
                check(f"refused: {name!r}", "control character" in str(error), str(error))
    try:
        convert(folder / "plain.inp", "mm-t-s", folder / "back\\slash")
        check("refused: a backslash", False, "it was not")
    except BadInput as error:
        check("refused: a backslash", "PETSc takes" in str(error), str(error))


def no_files(folder):
    """Devices and pipes are no input: a line, and no reading without end."""
    os.mkfifo(folder / "pipe.inp")
    (folder / "device.inp").write_text(PLAIN + "*INCLUDE, INPUT=/dev/zero\n")
    (folder / "linked.inp").symlink_to("/dev/zero")
    (folder / "table").mkdir()
    os.mkfifo(folder / "table/modes.csv")
    root = Path(__file__).resolve().parents[1] / "scripts"
    for words in (["import", "pipe.inp"], ["import", "device.inp"], ["import", "linked.inp"], ["plot/modes", "table"],
                  ["plot/sweep", "table"], ["export", "vtu", "table"], ["import_matrices", "K=pipe.mtx"]):
        done = subprocess.run([root / words[0], *words[1:]], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
        check(f"{' '.join(words)}: one line", done.returncode == 1 and done.stderr.count("\n") == 1, done.stderr)


def infinite(folder):
    """A table with inf is one line that names its place, but for errors, which may be unknown."""
    (folder / "modes.csv").write_text("mode,freq_hz,error_hz\n1,100,inf\n2,inf,0\n")
    kinds = {"mode": int, "freq_hz": float, "error_hz": float}
    try:
        tables.read_table(folder / "modes.csv", kinds)
        check("inf in a table", False, "it was not refused")
    except BadInput as error:
        check("inf in a table", "modes.csv: line 3: freq_hz is 'inf', which is not finite" in str(error), error)
    kinds.pop("freq_hz")
    check("inf of an error", tables.read_table(folder / "modes.csv", kinds)[0]["error_hz"] == np.inf)


def study(folder):
    """scripts/study/decks: what becomes of a deck that is right, of one that is refused, and of one without solids."""
    (folder / "decks").mkdir()
    for name, text in (("right", PLAIN), ("refused", PLAIN.replace("8\n2, 5", "8\n2, 55")), ("shells", PLAIN.replace(ELEMENTS, (
            "*ELEMENT, TYPE=S4, ELSET=E\n1, 1,2,6,5\n")).replace("SOLID", "SHELL"))):
        (folder / f"decks/{name}.inp").write_text(text)
    done = subprocess.run([Path(__file__).resolve().parents[1] / "scripts/study/decks", "decks", "--no-ccx", "-o", "out"], cwd=folder,
                          capture_output=True, text=True, timeout=100, check=False)
    check("study: status", done.returncode == 0, done.stderr)
    with (folder / "out/decks.csv").open(newline="") as rows:
        found = {Path(row["file"]).stem: row["outcome"] for row in csv.DictReader(rows)}
    check("study: outcomes", found == {"right": "imported", "refused": "refused", "shells": "no solids"}, found)
    check("study: share and reason", "50.0 %" in done.stdout and "node # is not in the file" in done.stdout, done.stdout)


def unforeseen():
    """An exception of a script is one line with its command line, and its trace where SQUEAL_TRACE is set."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        status = tables.run("name", lambda: [][0])
    check("an exception: one line", status == 1 and said.getvalue().count("\n") == 1 and "IndexError" in said.getvalue(), said.getvalue())
    os.environ[tables.TRACE] = "1"
    try:
        tables.run("name", lambda: [][0])
        check("an exception: its trace", False)
    except IndexError:
        check("an exception: its trace", True)
    del os.environ[tables.TRACE]


def main():
    program = starter(str(Path(sys.argv[1]).resolve()))
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        for part in (ways, included, overlapping, distributed, steps, supports, stated, infinite, study, no_files):
            part(Path(name))
        for part in (modes, gap, names):
            part(Path(name), program)
    unforeseen()
    program.end()
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
