#!/usr/bin/env python3
"""Decks of strangers: what their own programs take in ways that few decks use, and what squeal has not. Small decks and files, and
what must become of them, worked out by hand; frequencies of a bar of two cubes in each way of writing it.

    test_import_odd.py SQUEAL MPIRUN"""

import csv
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks.convert import convert, read_deck
from squeal.decks.deck import Block, Deck, Place
from squeal.decks.mesh.elements import EDGES, SHAPES, signed_volumes
from squeal.decks.mesh.faces import nodes_by_kind
from squeal.decks.mesh.orientation import set_orientation
from squeal.tables import BadInput

import decks
import decks_others
import numpy as np
import odd_meshes as odd
from test_import import modes, program
from test_import_keywords import FAILED, check, scene, sections

# The bar of two cubes of 10 mm in steel, clamped at one end: the lowest frequency (Hz) of its deck in Abaqus' words, hex8 of squeal
BAR, SAME = 18898.561492685, 1e-9


def chosen(folder):
    """--subcase; bulk data alone, of which the lowest set is taken and the others are said; a subcase that is not there."""
    name = next(iter(decks_others.NastranCase.FILES))
    for other, text in decks_others.NastranCase.FILES.items():
        (folder / other).write_text(text)
    convert(folder / name, "mm-t-s", folder / "scene", subcase=1)
    options = scene(folder, "scene")[0]
    check("--subcase 1 has the loads, and any method", "loads" in options and options["modes_count"] == "7", options)
    try:
        convert(folder / name, "mm-t-s", folder / "scene", subcase=3)
        check("--subcase 3 is refused", False)
    except BadInput as error:
        check("--subcase 3 is refused", "case.bdf:6: there is no SUBCASE 3; those of the file are 1, 2" in str(error), error)
    bulk = decks_others.GRIDS + decks_others.HEXA + decks_others.PROPERTY + "SPC1,1,123,1,2,3,4\nSPC1,3,123,5\nENDDATA\n"
    options, listed = sections(folder, "deck.bdf", bulk)
    check("bulk data alone: the lowest set", options.get("supports") == "support" and any(
        line.startswith("deck.bdf:13: differs: no case control: SPC = 1 is taken, not 3") for line in listed), (options, listed))
    options, listed = sections(folder, "deck.bdf", "CEND\nBEGIN BULK\n" + bulk)
    check("case control without SPC holds nothing", "supports" not in options and
          any(line.startswith("deck.bdf:15: SPC1 of set 1: case control has no SPC = 1") for line in listed), (options, listed))


def middles(folder):
    """Middles of straight edges that are left out are made where they were, once for all elements of an edge: of a box of hex20
    without some, the same nodes as with all."""
    solid = decks.Solid("hex20", folder, "--elements", "2,1,1")
    whole = decks.nastran(solid, "free")
    lines, random = [], np.random.default_rng(3)
    for line in whole:
        words = line.split(",")
        if words[0] == "" and len(lines) and lines[-1].split(",")[0] in ("CHEXA", "") and len(words) > 5:
            words = [word if k < 3 or random.random() < 0.6 else "" for k, word in enumerate(words)]
        lines.append(",".join(words))
    places = []
    for text in (whole, lines):
        (folder / "deck.bdf").write_text("\n".join(text))
        deck = read_deck(folder / "deck.bdf")
        places.append(np.concatenate([deck.x[block.nodes] for block in deck.blocks]))
    used = len({node for block in deck.blocks for node in block.nodes.ravel().tolist()})
    check("middles that are left out", lines != whole and np.allclose(*places, atol=1e-9) and used == len(solid.x),
          (used, len(solid.x)))
    check("middles that are left out are said", any("CHEXA without some" in text for text in deck.differs), deck.differs)


def odd_meshes(folder):
    """Files of MED with elements that squeal has not, families without groups, groups of what is no face, several meshes, fields of
    what is not there; faces alone, nodes alone: read and said, or one line."""
    for name, (meshes, wanted) in odd.MED.items():
        odd.write_med(folder / "odd.med", meshes, fields=name == "odd")
        try:
            said = [line.replace(f"{folder}/odd.med:1: ", "") for line in convert(folder / "odd.med", "m-kg-s", folder / "scene")]
        except BadInput as error:
            check(f"MED: {name}: one line", wanted is None and re.fullmatch(r"[^\n]*odd\.med:1: [^\n]+", str(error)), error)
            continue
        check(f"MED: {name}", wanted is not None and all(any(line.startswith(start) for line in said) for start in wanted), said)
        if name == "odd":
            check("MED: odd: parts and sets", scene(folder, "scene")[0]["parts"] == "both"
                  and said[1] == "16 nodes, 2 elements, 2 volumes, 1 surfaces, 0 sets of nodes", said)


def orientation():
    """Faces of surfaces stay where they are when elements are mirrored, of every shape."""
    random = np.random.default_rng(7)
    for name, corners in (("tet10", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]),
                          ("wedge15", [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (0, 1))]),
                          ("hex20", decks_others.CORNERS)):
        shape, corners = SHAPES[name], np.array(corners, float) + 0.1 * random.random((len(corners), 3))
        x = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in EDGES[shape.family]]])
        deck = Deck("none", "test")
        deck.add_nodes(np.vstack([x, x * (1, 1, -1) + (5, 0, 0)]))
        deck.add_block(Block(shape, name, np.array([1, 2]), np.array([range(len(x)), range(len(x), 2 * len(x))]), Place("none", 1)))
        faces = np.array([(cell, face) for cell in (0, 1) for face in range(len(shape.faces()))])
        deck.surfaces["all"] = faces.copy(), Place("none", 1)
        before = {tuple(faces[row]): set(nodes) for rows, found in nodes_by_kind(deck, faces) for row, nodes in zip(rows, found.tolist())}
        set_orientation(deck)
        after = deck.surfaces["all"][0]
        same_nodes = all(before[tuple(faces[row])] == set(nodes)
                         for rows, found in nodes_by_kind(deck, after) for row, nodes in zip(rows, found.tolist()))
        volumes = signed_volumes(shape, deck.x[deck.blocks[0].nodes[:, :shape.n_corners]])
        check(f"mirrored {name}: faces, orientation, a line", same_nodes and (volumes > 0).all() and len(deck.differs) == 1
              and (after[:len(faces) // 2] == faces[:len(faces) // 2]).all(), (faces, after, volumes))


def frequency(folder, name, text, words=()):
    """Hz, the lowest of a deck."""
    (folder / name).write_text(text)
    convert(folder / name, "mm-t-s", folder / "bar")
    return modes(folder, ["-options_file", "bar.yaml", *words])[0]


def bars(folder):
    """The same bar as decks of Nastran and Ansys: sets that are not chosen, tabulators, E by G, and versions of CDWRITE."""
    points = [(x, y, z) for x in (0, 10, 20) for y, z in ((0, 0), (10, 0), (10, 10), (0, 10))]
    fixed = decks_others.fixed
    cells = [range(1, 9), range(5, 13)]
    grids = [fixed("GRID", k, "", *(f"{v}." for v in place)) for k, place in enumerate(points, 1)]
    grids += [fixed("CHEXA", k, 1, *nodes[:6]) + "\n" + fixed("+", *nodes[6:]) for k, nodes in enumerate(cells, 1)]
    grids.append(fixed("PSOLID", 1, 1))
    steel = {"E": fixed("MAT1", 1, "210000.", "", ".3", "7.8-9"), "G": fixed("MAT1", 1, "", "80769.23", ".3", "7.8-9")}
    held = {"blanks": fixed("SPC1", 1, 123, 1, 2, 3, 4), "tabulators": "SPC1\t1\t123\t1\t2       3\t4"}
    other = fixed("SPC1", 2, 123, 9, 10, 11, 12)
    for about, control, material, support, limit in (
            ("a set that is not chosen", ["SPC = 1"], "E", "blanks", SAME), ("tabulators", ["SPC = 1"], "E", "tabulators", SAME),
            ("E by G and nu", ["SPC = 1"], "G", "blanks", 2e-7)):
        text = ["SOL 103", "CEND", *control, "BEGIN BULK", *grids, steel[material], held[support], other, "ENDDATA"]
        found = frequency(folder, "bar.bdf", "\n".join(text) + "\n")
        check(f"Nastran, {about}: {BAR:.3f} Hz", abs(found / BAR - 1) < limit, found)
    for version in ("R5.3", "UNBL"):
        block = f"ETBLOCK,        1,        1\n(2i9,19a9)\n{1:9d}{185:9d}" + f"{0:9d}" * 19 + "\n       -1"
        for types in ("ET,        1,185", "ET,1,SOLID185", block):
            text = ["/PREP7", types, "NBLOCK,6,SOLID,        12,        12", "(3i9,6e21.13e3)"]
            text += [f"{k:9d}{0:9d}{0:9d}" + "".join(f"{v:21.13E}" for v in place) for k, place in enumerate(points, 1)]
            text += [f"N,{version},LOC,       -1,", "EBLOCK,19,SOLID,         2,         2", "(19i9)"]
            text += ["".join(f"{v:9d}" for v in (1, 1, 1, 1, 0, 0, 0, 0, 8, 0, k, *nodes)) for k, nodes in enumerate(cells, 1)]
            text.append("       -1")
            for label, value in (("EX", 210e3), ("NUXY", 0.3), ("DENS", 7.8e-9)):
                text += [f"MPTEMP,{version}, 1, 1,  0.00000000    ,", f"MPDATA,{version}, 1,{label:4},       1, 1, {value!r}    ,"]
            found = frequency(folder, "bar.cdb", "\n".join([*text, "D,1,ALL,0,,4", "FINISH"]) + "\n")
            check(f"Ansys, {version}, {types[:12]}: {BAR:.3f} Hz", abs(found / BAR - 1) < SAME, found)


TABLE = ("SOL 111\nCEND\nSPC = 1\nMETHOD = 4\nSDAMPING = 9\nBEGIN BULK\n" + decks_others.GRIDS + decks_others.HEXA + decks_others.PROPERTY +
         "SPC1,1,123,1,2,3,4\nEIGRL,4,,,3\nTABDMP1,9,CRIT\n,0.,.005,1.E5,.01,2.E5,.02,ENDT\nENDDATA\n")


def damped(folder):
    """A table of damping over frequency: half the loss factor is the damping ratio sin(arctan(eta) / 2) of each mode."""
    sections(folder, "deck.bdf", TABLE)
    done = program().run(folder, ["-options_file", "scene.yaml", "-output_dir", "damped", "-output_fields", "0"])
    check("TABDMP1: runs", done.status == 0, done.stderr)
    with (folder / "damped/modes.csv").open(newline="") as rows:
        found = [(float(row["freq_hz"]), float(row["damping_ratio"])) for row in csv.DictReader(rows)]
    wanted = [np.sin(np.arctan(2 * np.interp(f, (0, 1e5, 2e5), (.005, .01, .02))) / 2) for f, _ in found]
    off = max(abs(ratio / own - 1) for (_, ratio), own in zip(found, wanted))
    check(f"TABDMP1: {len(found)} modes, damping off by {off:.1e}, 3e-4 allowed", len(found) == 3 and off < 3e-4, (found, wanted))
    rows = "CRIT\n,0.,.005,1.E5,.01,2.E5,.02"
    for about, new, loss in (("one value", "CRIT\n,0.,.005,1.E5,.005", 0.01), ("G", "G\n,0.,.03,1.E5,.03", 0.03),
                             ("Q", "Q\n,0.,50.,1.E5,50.", 0.02)):
        options, _ = sections(folder, "deck.bdf", TABLE.replace(rows, new))
        check(f"TABDMP1 of {about}: a loss factor", abs(float(options.get("part_1_loss_factor", 0)) - loss) < 1e-15, options)
    options, listed = sections(folder, "deck.bdf", TABLE.replace("SDAMPING = 9", "SDAMPING = 8"))
    told = [line for line in listed if "TABDMP1 9: case control has no SDAMPING = 9" in line or "SDAMPING = 8: there is no" in line]
    check("TABDMP1 that is not chosen is said", not any("loss" in key for key in options) and len(told) == 2, listed)
    for old, new in (("2.E5", "5.E4"), (".01,", "-.01,"), ("0.,.005", "-1.,.005")):
        options, listed = sections(folder, "deck.bdf", TABLE.replace(old, new))
        check(f"TABDMP1 with {new}: said", sum("TABDMP1 9: up to 64 rising" in line for line in listed) == 1 and
              not any("loss" in key for key in options), listed)
    try:
        sections(folder, "deck.bdf", TABLE.replace("CRIT", "X"))
        check("TABDMP1 of type X: refused", False, "it was not")
    except BadInput as error:
        check("TABDMP1 of type X: refused", "type X is none of" in str(error), str(error))


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        for case in (chosen, middles, odd_meshes, bars, damped):
            case(Path(name))
    orientation()
    program().end()
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
