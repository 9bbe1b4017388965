#!/usr/bin/env python3
"""What scripts/import makes of each keyword: small decks, written as the manuals of the codes show them, and the scene that
they should give, worked out by hand; every line that is not understood must be listed with its file and line. The forces
of a run are those of the deck. Breaks when a keyword is read wrongly or passed over in silence.

    test_import_keywords.py SQUEAL MPIRUN"""

import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks.ansys import model as ansys_model
from squeal.decks.nastran import read as nastran
from squeal.decks.abaqus.read import CARDS as ABAQUS
from squeal.decks.convert import convert, read_deck
from squeal.decks.names import RESERVED
from squeal.decks.units import SYSTEMS
from squeal.tables import BadInput

import decks_abaqus
import decks_others
import numpy as np

FAILED = []


def check(about, kept, shown=""):
    print(f"{'ok    ' if kept else 'FAILED'} {about} {'' if kept else shown}")
    if not kept:
        FAILED.append(about)


def scene(folder, name):
    """Lines of a scene without comments, as {option: value}, and the comments at the end."""
    text = (folder / f"{name}.yaml").read_text()
    options, top = {}, ""
    for line in text.splitlines():
        code = re.sub(r"\s+#.*", "", line)
        if not code or code.startswith("#"):
            continue
        indent = code.startswith(" ")
        key, _, value = code.strip().partition(":")
        if value.strip().startswith("{"):
            for pair in re.findall(r"(\w+): (\"[^\"]*\"|[^,}]+)", value):
                options[f"{key}_{pair[0]}"] = pair[1].strip('"')
        elif value.strip():
            options[f"{top}_{key}" if indent else key] = value.strip().strip('"')
        else:
            top = key
    return options, [line[2:] for line in text.partition("# What differs")[2].splitlines()[1:]]


def same(wanted, found):
    """Whether two values are the same words or numbers."""
    try:
        return np.allclose([float(w) for w in wanted.split(",")], [float(w) for w in found.split(",")], rtol=1e-9, atol=1e-12)
    except ValueError:
        return wanted == found


def brought(folder, text, ending="inp"):
    """Lines that are printed when a deck in mm, t, s is brought in, and options of the scene."""
    (folder / f"deck.{ending}").write_text(text)
    lines = convert(folder / f"deck.{ending}", "mm-t-s", folder / "deck")
    return lines, scene(folder, "deck")[0]


def check_scene(folder, case):
    """One case: files, the scene, what is listed."""
    for name, text in case.FILES.items():
        (folder / name).write_text(text)
    main = next(iter(case.FILES))
    convert(folder / main, getattr(case, "UNITS", None), folder / "scene")
    options, listed = scene(folder, "scene")
    for key, value in case.SCENE.items():
        check(f"{main}: {key} is {value}", same(value, options.pop(key, "")), f"found {scene(folder, 'scene')[0].get(key)}")
    options.pop("model_mesh", None), options.pop("mesh", None)
    table = options.pop("model_equations", "")
    rows = Path(table).read_text().splitlines()[1:] if table else []
    check(f"{main}: equations", len({row.partition(",")[0] for row in rows}) == getattr(case, "EQUATIONS", 0), rows)
    check(f"{main}: nothing else", not options, options)
    where = [line.replace(f"{folder}/", "") for line in listed]
    for line in case.LISTED:
        hits = [found for found in where if found.startswith(line)]
        check(f"{main}: listed: {line}", len(hits) == 1, where)
        where = [found for found in where if found not in hits]
    check(f"{main}: nothing else is listed", not where, where)


def forces(folder, words):
    """Total of each load, N, by a run for the sliding state."""
    command = [sys.argv[2], "-n", 1, sys.argv[1], "-options_file", folder / "scene.yaml", "-analysis", "static",
               "-model_mesh", folder / "scene.msh", "-output_dir", folder / "out", "-output_fields", 0, *words]
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    with (folder / "out/reactions.csv").open(newline="") as rows:
        return {row["name"]: [float(row[f"force_{d}_n"]) for d in "xyz"] for row in csv.DictReader(rows) if row["kind"] == "load"}


def check_refused(folder, ending, cases):
    """Decks that are wrong: the message, with file and line."""
    for text, message in cases:
        (folder / f"wrong.{ending}").write_text(text)
        try:
            convert(folder / f"wrong.{ending}", output=folder / "wrong")
            check(f"refused: {message}", False, "it was not")
        except BadInput as error:
            check(f"refused: {message}", message in str(error) and "\n" not in str(error), str(error))
    try:
        convert(folder / f"wrong.{ending}", output=folder / "nowhere/wrong")
        check("refused: a folder that is not there", False, "it was not")
    except BadInput as error:
        check("refused: a folder that is not there", "nowhere: no such folder" in str(error), str(error))


def check_forces(folder, case):
    found = forces(folder, getattr(case, "WORDS", []))
    for name, force in case.FORCES.items():
        check(f"force of {name}: {force} N", np.allclose(found.get(name, np.nan), force, atol=1e-9), found)


def abaqus(folder):
    check_scene(folder, decks_abaqus.Assembly)
    deck = read_deck(folder / next(iter(decks_abaqus.Assembly.FILES)))
    corner = np.array(decks_abaqus.Assembly.PLACE)
    check("instance: moved, then turned", (abs(deck.x - corner).max(axis=1) < 1e-9).any(), deck.x)
    check_forces(folder, decks_abaqus.Assembly)
    check_scene(folder, decks_abaqus.Flat)
    check_refused(folder, "inp", decks_abaqus.REFUSED)


def sections(folder, name, text):
    """Options of the scene of a deck, and what is listed without the folder."""
    (folder / name).write_text(text)
    convert(folder / name, "mm-t-s", folder / "scene")
    options, listed = scene(folder, "scene")
    return options, [line.replace(f"{folder}/", "") for line in listed]


def steps(folder):
    """Loads of a later step replace those of an earlier one (OP=MOD), or all of them (OP=NEW); in one step they add up."""
    one, two, three = "*CLOAD\n7, 3, -1.\nTOP, 1, 2.\n", "*CLOAD{}\n7, 3, -5.\n7, 3, -1.\n", "*DSLOAD{}\nUP, P, 4.\n"
    whole = decks_abaqus.BODY + "*NSET, NSET=TOP\n5, 6\n*SURFACE, NAME=UP\nE, S2\n" + decks_abaqus.STEEL + (
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n")

    def deck(*parts):
        return whole + "".join(f"*STEP\n{part}*END STEP\n" for part in parts)

    options, _ = sections(folder, "steps.inp", deck(one + three.format(""), two.format(""), three.format("").replace("4.", "9.")))
    check("OP=MOD: the force of a node is that of the last step", same("0,0,-6", options["force_force_force"]), options)
    check("OP=MOD: the force of another set stays", same("4,0,0", options["top_force_force"]), options)
    check("OP=MOD: one pressure, the last",
          options["up_pressure_pressure"] == "9000000" and "up_pressure_2" not in options["loads"], options)
    options, _ = sections(folder, "steps.inp", deck(one, two.format(", OP=NEW")))
    check("OP=NEW: other forces are gone", options["loads"] == "force_force" and same("0,0,-6", options["force_force_force"]), options)
    options, _ = sections(folder, "steps.inp", deck(one, "*CLOAD\n7, 3, 0.\n"))
    check("OP=MOD: a force that becomes 0 is gone", options["loads"] == "top_force", options)


def viscous(folder):
    """Stiffness over frequency: E_0 = 210 / (1 - 0.5) = 420 GPa, branches of 0.3 and 0.2 of it; at 1 kHz storage 2.5 and loss 0.4 of
    E_inf."""
    body, section = decks_abaqus.BODY + "*MATERIAL, NAME=M\n*DENSITY\n7.8e-9\n", "*SOLID SECTION, ELSET=E, MATERIAL=M\n"
    series, elastic = "*VISCOELASTIC, TIME=PRONY\n0.3, 0.3, 1e-3\n0.2, {}, 1e-4\n", "*ELASTIC{}\n210000., 0.3\n"
    options, listed = sections(folder, "deck.inp", body + series.format(0.2) + elastic.format("") + section)
    check("a Prony series", same(options["e_young"], "210e9") and same(options["e_prony_modulus"], "126e9,84e9")
          and same(options["e_prony_time"], "1e-3,1e-4") and not any("relax otherwise" in line for line in listed), (options, listed))
    options, listed = sections(folder, "deck.inp", body + series.format(0) + elastic.format(", MODULI=INSTANTANEOUS") + section)
    check("of a modulus of fast motions; bulk that does not relax is said", same(options["e_young"], "105e9")
          and same(options["e_prony_modulus"], "63e9,42e9") and sum("relax otherwise" in line for line in listed) == 1, (options, listed))
    rows = "*VISCOELASTIC, FREQUENCY=TABULAR\n0.4, -1.5, 0.4, -1.5, 1000.\n0.1, -0.2, 0.1, -0.2, 10.\n"
    options, listed = sections(folder, "deck.inp", body + elastic.format("") + rows + section)
    check("a table over frequency", same(options["e_table_frequency"], "10,1000") and same(options["e_table_modulus"], "252e9,525e9")
          and same(options["e_table_loss_factor"], f"{0.1 / 1.2},{0.4 / 2.5}"), options)
    for about, text in (("a sum of 1", series.format(0.2).replace("0.3, 0.3", "0.8, 0.8")),
                        ("a law by a routine", "*VISCOELASTIC, TIME=CREEP\n"),
                        ("a table of one frequency twice", rows.replace("1000.", "10."))):
        options, listed = sections(folder, "deck.inp", body + elastic.format("") + text + section)
        check(f"{about} is listed", not any("prony" in key or "table" in key for key in options)
              and sum("not taken" in line for line in listed) == 1, (options, listed))


def not_taken(folder):
    """What is read in part, or would be something else in squeal, is listed and makes nothing in the scene."""
    body, steel = decks_abaqus.BODY, decks_abaqus.STEEL + "*SOLID SECTION, ELSET=E, MATERIAL=M\n"
    rest = "*SURFACE, NAME=S\nE, S1\n*SURFACE, NAME=T\nE, S2\n*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3, 5e4\n"
    pair = "*CONTACT PAIR, INTERACTION=I\nS, T\n"
    options, listed = sections(folder, "deck.inp", body + steel + rest + pair)
    check("contact is there", options.get("contacts") == "i", options)
    check("*FRICTION: a second number is listed", any(line.startswith("deck.inp:23: *FRICTION: only") for line in listed), listed)
    for about, text in (("SURFACE BEHAVIOR", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e6\n" + pair),
                        ("CONTACT PAIR", pair.replace("=I\n", "=I, TIED\n"))):
        options, listed = sections(folder, "deck.inp", body + steel + rest + text)
        check(f"{about}: tied is no contact, and a tie", "contacts" not in options and options.get("ties") == "i"
              and options["i_surfaces"] == "s,t" and sum("nodes of S follow T" in line for line in listed) == 1, (options, listed))
    table = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n{}" + pair
    options, listed = sections(folder, "deck.inp", body + steel + rest + table.format("0., -0.01\n0.5, 0.\n2., 0.004\n"))
    check("a table of pressure and overclosure", options.get("i_pressure_law") == "table" and "i_law" not in options
          and same(options["i_pressure_table"], "-1e-5,0,0,5e5,4e-6,2e6"), options)
    options, listed = sections(folder, "deck.inp", body + steel + rest + table.format("0., 0.\n0.5, 1e-3\n0.4, 2e-3\n"))
    check("a table that falls is listed", options.get("i_law") == "constraint" and "i_pressure_law" not in options
          and sum("does not rise" in line for line in listed) == 1, (options, listed))
    soft = steel.replace("*SOLID", "*DAMPING, STRUCTURAL=0.02\n*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, 1e-3\n*SOLID")
    options, listed = sections(folder, "deck.inp", body + soft)
    check("a loss factor beside a law is listed", not any(key.endswith("loss_factor") for key in options)
          and any(key.endswith("prony_modulus") for key in options) and sum("loss factor 0.02 beside" in line for line in listed) == 1,
          (options, listed))
    other = "*SURFACE INTERACTION, NAME=J\n*FRICTION\n0.6\n*CONTACT PAIR, INTERACTION=J\nT, S\n"
    _, listed = sections(folder, "deck.inp", body + steel + rest + pair + other)
    check("another friction the other way round is said", sum("is NOT taken" in line for line in listed) == 1, listed)
    options, listed = sections(folder, "deck.inp", body + steel + rest + pair.replace("=I\n", "=I, TIED\n") + "T, S\n")
    check("a tie given both ways is one", options.get("ties") == "i" and sum("other way round" in line for line in listed) == 1,
          (options, listed))
    options, listed = sections(folder, "deck.inp", body + steel + rest + pair + "T, S\n")
    check("a contact given both ways is one", "," not in options["contacts"]
          and sum("other way round" in line for line in listed) == 1, (options, listed))
    tie = "*TIE, NAME=Glue, POSITION TOLERANCE=0.5, ADJUST=NO\nS, T\n"
    options, listed = sections(folder, "deck.inp", body + steel + rest + tie)
    check("TIE of nodes that are apart", options.get("ties") == "glue" and options["glue_surfaces"] == "s,t"
          and float(options["glue_distance"]) == 0.0005 and options["glue_far"] == "free", options)
    _, listed = sections(folder, "deck.inp", f"*PART, NAME=P\n*NODE\n1, 0., 0., 0.\n*END PART\n{body}{steel}")
    check("a part without an instance is listed", any(line.startswith("deck.inp:1: *PART P: no") for line in listed), listed)
    nastran = "CELAS2,5,1.,7,3,,,0.04\nPBUSH,6,K,1.,2.,3.,4.\n,GE,5.\nPELAS,7,1.,0.1\nENDDATA\n"
    text = decks_others.GRIDS + decks_others.HEXA + decks_others.PROPERTY.replace("PSOLID,1,1", "PSOLID,1,1,,2") + nastran
    _, listed = sections(folder, "deck.bdf", text)
    for start in ("deck.bdf:11: PSOLID 1: integration", "deck.bdf:13: CELAS2: only", "deck.bdf:14: PBUSH: only",
                  "deck.bdf:16: PELAS: only"):
        check(f"listed: {start}", sum(line.startswith(start) for line in listed) == 1, listed)
    lossy = "MAT1,9,2.1E5,,.3,7.8E-9,,,0.02\nPARAM,G,0.05\nPARAM,G,0.03\nENDDATA"
    text = text.replace("ENDDATA", lossy).replace("PSOLID,1,1,,2", "PSOLID,1,9,,2")
    options, listed = sections(folder, "deck.bdf", text)
    check("loss factors of Nastran", [f"{float(value):.15g}" for key, value in options.items()
          if key.endswith("_loss_factor")] == ["0.05"], options)
    ansys = "D,1,UX,0,1.5\nD,P51X,UX,0\nF,5,FZ,1,2\nSFE,1,6,PRES,1,10,0,0,10\nSFE,1,1,PRES,1,3,0,0,0\nFINISH\n"
    text = decks_others.NBLOCK + decks_others.EBLOCK + "MP,EX,1,2.1E5\nMP,PRXY,1,0.3\nMP,DENS,1,7.8E-9\n" + ansys
    options, listed = sections(folder, "deck.cdb", text)
    for start in ("deck.cdb:20: D with", "deck.cdb:21: D P51X", "deck.cdb:22: F with", "deck.cdb:23: SFE: a pressure that varies"):
        check(f"listed: {start}", sum(line.startswith(start) for line in listed) == 1, listed)
    damped = "MP,DMPS,1,0.02\nDMPSTR,0.01\nBETAD,3e-7\nBETAD,1e-7\nMP,ALPD,1,3\nFINISH"
    lossy, _ = sections(folder, "deck.cdb", text.replace("FINISH", damped))
    for key, asked in (("loss_factor", 0.03), ("beta", 1e-7), ("alpha", 3)):
        found = [float(value) for name, value in lossy.items() if name.endswith(f"1_{key}")]
        check(f"damping of Ansys: {key}", len(found) == 1 and abs(found[0] / asked - 1) < 1e-14, lossy)
    check("not taken: two parts and what varies", "supports" not in options and options["loads"] == "pressed_pressure", options)
    name = next(iter(decks_others.Ansys.FILES))
    text = decks_others.Ansys.FILES[name].replace("ET,2,174", "ET,2,174\nKEYOPT,2,12,5")
    options, listed = sections(folder, name, text)
    check("bonded contact of Ansys is one mesh where nodes match", "contacts" not in options and "ties" not in options
          and any("KEYOPT(12) = 5, bonded: " in line and "become those" in line for line in listed), (options, listed))
    options, listed = sections(folder, name, text.replace("12,5", "12,4"))
    check("contact of Ansys without separation is none", "contacts" not in options and "ties" not in options
          and sum("KEYOPT(12) = 4" in line for line in listed) == 1, listed)


def preloaded(folder):
    """Modes after a *STATIC that presses a contact are about its state, and damped by friction where the deck asks for it;
    without a load or a contact they are not. Breaks when a step says something and the scene does not, or the reverse."""
    whole = decks_abaqus.BODY + "*NSET, NSET=TOP\n5, 6\n*SURFACE, NAME=S\nE, S1\n*SURFACE, NAME=T\nE, S2\n" + decks_abaqus.STEEL + (
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n*SURFACE INTERACTION, NAME=I\n*FRICTION, SLIP TOLERANCE=0.005\n0.3\n")
    pair, load = "*CONTACT PAIR, INTERACTION=I\nS, T\n", "*CLOAD\n7, 3, -1.\n"

    def deck(before, within, damping, nlgeom="NO"):
        return (f"{whole}{before}*STEP, NLGEOM={nlgeom}, UNSYMM=YES\n*STATIC\n{within}*END STEP\n"
                f"*STEP\n*FREQUENCY, SIM=NO\n9\n*END STEP\n*STEP\n*COMPLEX FREQUENCY, FRICTION DAMPING={damping}\n9\n*END STEP\n")

    for about, text, contact, damping, said in (
            ("pressed", deck(pair, load, "NO", "YES"), "static", None, ("differs: *STEP, NLGEOM", "differs: *FRICTION: slip", )),
            ("damped by friction", deck(pair, load, "YES"), "static", "true", ()),
            ("no load", deck(pair, "", "YES"), None, None, ("*STATIC: without", "*COMPLEX FREQUENCY, FRICTION DAMPING: without")),
            ("no contact", deck("", load, "NO"), None, None, ("*STATIC: without", ))):
        options, listed = sections(folder, "deck.inp", text)
        check(f"{about}: modes about the state {contact}",
              (options.get("modes_contact"), options["modes_count"]) == (contact, "9"), options)
        check(f"{about}: friction damping {damping}", options.get("i_friction_damping") == damping, options)
        for words in said:
            check(f"{about}: listed {words}", sum(words in line for line in listed) == 1, listed)
        kinds = [line.endswith("not needed here") for line in listed if "differs" not in line]
        check(f"{about}: what is not needed comes last", kinds == sorted(kinds) and any(kinds), listed)


def closed_pipe(folder):
    """`scripts/import FILE | head`: no traceback where nobody reads to the end."""
    (folder / "pipe.inp").write_text(decks_abaqus.BODY + decks_abaqus.STEEL + "*SOLID SECTION, ELSET=E, MATERIAL=M\n")
    program = Path(__file__).resolve().parents[1] / "scripts/import"
    with subprocess.Popen([program, "pipe.inp"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as started:
        started.stdout.close()
        said = started.stderr.read()
    check("a closed pipe: nothing on stderr, status 0", not said and started.returncode == 0, said)


def others(folder):
    check_scene(folder, decks_others.NastranCase)
    check_scene(folder, decks_others.AnsysCase)
    for case in (decks_others.Nastran, decks_others.Ansys):
        check_scene(folder, case)
        check_forces(folder, case)
    for ending, cases in decks_others.REFUSED.items():
        check_refused(folder, ending, cases)


def strict(folder):
    """--strict takes output and analyses for what they are, and refuses the rest."""
    plain = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4,ELSET=E\n1,1,2,3,4\n"
    plain += "*MATERIAL,NAME=M\n*ELASTIC\n2e11,0.3\n*DENSITY\n7800\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
    plain += "*STEP\n*STATIC\n*OUTPUT, FIELD\n*END STEP\n"
    for more, expected in (("", None), ("*EXPANSION\n1e-5\n", "strict.inp:18: *EXPANSION: not understood (1 such lines; --strict)")):
        (folder / "strict.inp").write_text(plain + more)
        try:
            convert(folder / "strict.inp", "m-kg-s", folder / "strict", strict=True)
            said = None
        except BadInput as error:
            said = str(error).removeprefix(f"{folder}/")
        check(f"strict: {expected}", said == expected, said)


def page():
    """Every keyword that is read stands in the tables of scripts/import.md."""
    text = " ".join((Path(__file__).resolve().parents[1] / "scripts/import.md").read_text().split())
    known = set(ABAQUS) | nastran.KNOWN
    known |= ansys_model.KNOWN | {f"C3D{n}" for n in (4, 6, 10, 15, 20)} | set(SYSTEMS)
    missing = [word for word in sorted(known) if not re.search(rf"\b{word}\b", text)]
    check("every keyword stands in scripts/import.md", not missing, missing)


def names():
    """Names of parts and contacts that squeal refuses, since its own or its libraries' options begin with them."""
    source = Path(__file__).resolve().parents[1] / "src/base/options"
    library = re.search(r"library_prefixes\[\] = \{(.*?)NULL", (source / "libraries.c").read_text(), re.S)[1]
    own = re.search(r"own\[\] = \{(.*?)\};", (source / "options.c").read_text(), re.S)[1]
    refused = {*re.findall(r'"(\w+)_"', library), *re.findall(r'"(\w+)"', own)}
    check("an import gives no name that is refused", len(refused) > 20 and refused <= RESERVED, refused - RESERVED)


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        abaqus(Path(name))
        others(Path(name))
        steps(Path(name))
        viscous(Path(name))
        not_taken(Path(name))
        preloaded(Path(name))
        closed_pipe(Path(name))
        strict(Path(name))
    names()
    page()
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
