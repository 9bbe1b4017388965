#!/usr/bin/env python3
"""Friction of imported decks that depends on slip rate, pressure and temperature: squeal's statics of the scene beside the deck's table,
interpolated here one line after the other, at each pair. Decks of Abaqus and Ansys. Breaks when a table is read across, when a
temperature, a step or a unit is taken wrongly, or when something is lost without a word.

    test_import_friction.py SQUEAL"""

import csv
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.tables import BadInput

import decks_others
import numpy as np
from served import starter
from test_import_calculix import GAP
from test_import_keywords import FAILED, brought, check

AREA, SAME = 25e-6, 1e-9
BLOCKS = GAP.replace("20.02", "20").replace("25.02", "25")


def balanced(folder, text, ending="inp"):
    """Options of the scene, and lines that were printed, with a balance."""
    lines, options = brought(folder, text, ending)
    check("balance", any(line.startswith("balance: the scene has") for line in lines), lines)
    return options, lines


def abaqus(friction, more="", step=""):
    """The two blocks, 400 N on four pairs."""
    return BLOCKS.replace("1.e5\n", f"1.e5\n{friction}").replace("*STEP\n", f"{more}*STEP\n").replace("*CLOAD", f"{step}*CLOAD")


def straight(at, pairs):
    """Value at `at` of pairs (x, value): straight between, constant beyond."""
    pairs = sorted(pairs)
    if at <= pairs[0][0]:
        return pairs[0][1]
    for (a, low), (b, high) in zip(pairs, pairs[1:]):
        if at <= b:
            return low + (high - low) * (at - a) / (b - a)
    return pairs[-1][1]


def mu_of(lines, speed, pressure, temperature=0.0):
    """mu of lines (mu, slip rate, pressure, temperature), mm/s and MPa."""
    warm = {}
    for mu, s, p, t in lines:
        warm.setdefault(t, {}).setdefault(p, []).append((s, mu))
    return straight(temperature, [(t, straight(pressure, [(p, straight(speed, curve)) for p, curve in pressed.items()]))
                                  for t, pressed in warm.items()])


def slid(folder, program, about, law, speeds):
    """Friction of each pair at slip speeds, mm/s, is law(speed, pressure) of its normal force."""
    for speed in speeds:
        done = program.run(folder, ["-options_file", "deck.yaml", "-analysis", "static", "-i_slip", "0,1,0", "-i_speed",
                                    f"{speed / 1e3:.15g}", "-output_dir", "out"])
        check(f"{about}: statics run at {speed:g} mm/s", done.status == 0, done.stderr)
        if done.status:
            continue
        with (folder / "out/static.csv").open(newline="") as rows:
            pairs = [(float(row["lambda_n_n"]), math.hypot(float(row["lambda_t_n"]), float(row.get("lambda_b_n") or 0)))
                     for row in csv.DictReader(rows)]
        off = max(abs(force / (normal * law(speed, normal / AREA / 1e6)) - 1) for normal, force in pairs)
        check(f"{about}: {len(pairs)} pairs at {speed:g} mm/s, off by {off:.1e}", len(pairs) == 4 and off < SAME and
              abs(sum(normal for normal, _ in pairs) - 400) < 1e-6, pairs)


def text_of(lines):
    return "*FRICTION\n" + "".join(", ".join(f"{value:g}" for value in line) + "\n" for line in lines)


UNEVEN = [(0.5, 0, 1, 0), (0.4, 100, 1, 0), (0.45, 20, 6, 0), (0.3, 50, 6, 0), (0.25, 300, 6, 0)]
PRESSED = [(0.5, 0, 0, 0), (0.35, 0, 4, 0), (0.3, 0, 10, 0)]
WARM = [(0.5, 0, 0, 20), (0.4, 100, 0, 20), (0.4, 0, 10, 20), (0.2, 100, 10, 20), (0.7, 0, 0, 120), (0.1, 50, 0, 120)]


def of_abaqus(folder, program):
    options, lines = balanced(folder, abaqus(text_of(UNEVEN)))
    check("a table: its law", options["i_friction_law"] == "table" and "i_mu" not in options and "i_speed" not in options, options)
    check("a table: what is missing is said", "# speed: ?" in (folder / "deck.yaml").read_text(), options)
    slid(folder, program, "other slip rates at each pressure", lambda s, p: mu_of(UNEVEN, s, p), (10, 37, 75, 250, 5000))
    balanced(folder, abaqus(text_of(PRESSED)))
    slid(folder, program, "over pressure alone", lambda s, p: mu_of(PRESSED, s, p), (10,))
    _, lines = balanced(folder, abaqus(text_of(WARM), "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nFIX, 45.\n"))
    check("temperature: said", sum("*FRICTION: at the temperature 45 of" in line for line in lines) == 1, lines)
    slid(folder, program, "at one temperature", lambda s, p: mu_of(WARM, s, p, 45), (20, 80))
    _, lines = balanced(folder, abaqus(text_of(WARM)))
    check("no temperature: said", sum("*FRICTION: at 20, the first temperature" in line for line in lines) == 1, lines)
    slid(folder, program, "at the first temperature", lambda s, p: mu_of(WARM[:4], s, p), (20,))
    changed = "*CHANGE FRICTION, INTERACTION=I\n"
    options, _ = balanced(folder, abaqus("*FRICTION\n0.2\n", step=changed + text_of(PRESSED)))
    slid(folder, program, "*CHANGE FRICTION to a table", lambda s, p: mu_of(PRESSED, s, p), (10,))
    options, _ = balanced(folder, abaqus("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.3, 0.002\n", step=f"{changed}*FRICTION\n0.2\n"))
    check("*CHANGE FRICTION of a decay to one number", options["i_mu"] == "0.2" and "i_friction_law" not in options, options)
    back = f"{changed}*FRICTION\n0.2\n*CHANGE FRICTION, INTERACTION=I, RESET\n"
    balanced(folder, abaqus(text_of(PRESSED), step=back))
    slid(folder, program, "*CHANGE FRICTION, RESET", lambda s, p: mu_of(PRESSED, s, p), (10,))
    _, lines = balanced(folder, abaqus("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.3, 0.002\n0.4, 0.2, 0.002\n"))
    check("a second line of a decay is said", sum("only the first line is taken" in line for line in lines) == 1, lines)
    refused(folder, "a table of more lines than squeal's", abaqus(text_of([(0.3 + 0.1 * p, s, p) for s in range(10000) for p in (0, 1)])),
            "at most 20000")
    balanced(folder, abaqus("*FRICTION, EXPONENTIAL DECAY, TEST DATA\n0.5\n0.35, 40.\n0.3\n"))
    slid(folder, program, "exponential decay by three points", lambda s, _: 0.3 + 0.2 * (0.05 / 0.2)**(s / 40), (40, 100))
    fields = "*FRICTION, DEPENDENCIES=1\n0.5, 0., 0., 0., 1.\n0.3, 90., 0., 0., 1.\n0.9, 0., 0., 0., 2.\n"
    _, lines = balanced(folder, abaqus(fields))
    check("fields are said", sum("depends on field variables" in line for line in lines) == 1, lines)
    slid(folder, program, "first values of a field", lambda s, _: 0.5 - 0.2 * s / 90, (30,))
    options, lines = balanced(folder, abaqus("*FRICTION, ANISOTROPIC\n0.4, 0.2\n"))
    check("another mu across is said", options["i_mu"] == "0.4" and sum("ANISOTROPIC" in line for line in lines) == 1, lines)
    for about, rows, said in (("negative", [(0.5, 0, 0), (-0.1, 5, 0)], "must not be negative, and -0.1 stands there"),
                              ("twice", [(0.5, 0, 0), (0.4, 0, 0), (0.4, 1, 0)], "two lines are of the same slip rate"),
                              ("not a number", [(0.5, 0, 0), (math.nan, 5, 0)], "nan")):
        refused(folder, f"a table with {about}", abaqus(text_of(rows)), said)


def refused(folder, about, text, said):
    try:
        balanced(folder, text)
        check(f"{about}: refused", False, "it was not")
    except BadInput as error:
        check(f"{about}: refused", said in str(error) and "deck.inp:" in str(error), str(error))


def of_ansys(folder):
    """The law of a pair by the file that is written, in SI, and its real constants."""
    plain = next(iter(decks_others.Ansys.FILES.values()))  # contact elements of material 3, real constants 5
    table = ["CID=3", "TB,FRIC,CID,,,ISO", "TBFIELD,SLRV,0", "TBFIELD,NPRES,1", "TBDATA,1,0.5", "TBFIELD,NPRES,5", "TBDATA,1,0.4",
             "TBFIELD,SLRV,200", "TBFIELD,NPRES,1", "TBDATA,1,0.3", "TBFIELD,NPRES,5", "TBDATA,1,0.1"]
    options, lines = balanced(folder, plain.replace("MODOPT", "\n".join(table) + "\nMODOPT"), "cdb")
    check("TB,FRIC: nothing of it is left out", not any("TB" in line and "differs" not in line for line in lines), lines)
    rows = [tuple(map(float, line.split(","))) for line in (folder / "deck_pair_5_mu.csv").read_text().splitlines()[1:]]
    lines = [(0.5, 0, 1, 0), (0.4, 0, 5, 0), (0.3, 200, 1, 0), (0.1, 200, 5, 0)]
    check("TB,FRIC over slip rate and pressure", options["pair_5_friction_law"] == "table" and len(rows) == 12 and
          all(abs(mu - mu_of(lines, s * 1e3, p / 1e6)) < 1e-12 for s, p, mu in rows), rows)
    warm = ["TB,FRIC,3,2", "TBTEMP,20", "TBDATA,1,0.35", "TBTEMP,200", "TBDATA,1,0.2"]
    options, lines = balanced(folder, plain.replace("MODOPT", "\n".join(warm) + "\nMODOPT"), "cdb")
    check("TB,FRIC over temperature: the first, said", options["pair_5_mu"] == "0.35" and
          sum("TB,FRIC,3: at 20, the first temperature" in line for line in lines) == 1, (options, lines))
    other = ["TB,FRIC,3", "TBFIELD,SLDI,0", "TBDATA,1,0.35", "TBFIELD,SLDI,1", "TBDATA,1,0.3"]
    _, lines = balanced(folder, plain.replace("MODOPT", "\n".join(other) + "\nMODOPT"), "cdb")
    check("TB,FRIC over the sliding distance: said", sum("depends on SLDI" in line for line in lines) == 1, lines)
    for about, words, mu, said in (("a parameter", ["MUVAL=0.3", "TB,FRIC,3", "TBDATA,1,MUVAL"], "0.3", ""),
                                   ("TBDELE", ["TB,FRIC,3", "TBDATA,1,0.3", "TBDELE,FRIC,3"], "0.45", "TBDELE: the table TB,FRIC,3"),
                                   ("two tables", ["TB,FRIC,3", "TBDATA,1,0.3", "TB,FRIC,3", "TBDATA,1,0.2"], "0.2",
                                    "the place of the one")):
        options, lines = balanced(folder, plain.replace("MODOPT", "\n".join([*words, "MODOPT"])), "cdb")
        check(f"TB,FRIC by {about}", options["pair_5_mu"] == mu and (not said or sum(said in line for line in lines) == 1), lines)
    decay = "R,5\nRMORE\nRMORE\nRMORE,,,1.5,0.01\nMODOPT"
    options, _ = balanced(folder, plain.replace("MODOPT", decay), "cdb")
    found = [options.get(f"pair_5_mu_{key}") for key in ("static", "kinetic", "decay_speed")]
    check("FACT and DC", None not in found and np.allclose(np.array(found, float), (0.675, 0.45, 0.1)), options)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        of_abaqus(Path(name), starter(str(Path(sys.argv[1]).resolve())))
        of_ansys(Path(name))
    sys.exit(1 if FAILED else 0)
