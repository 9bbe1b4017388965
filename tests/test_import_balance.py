#!/usr/bin/env python3
"""The balance of scripts/import: integrals over elements and faces against closed forms, and what it says where a scene is not
the deck. References are volumes, first moments, areas and forces of boxes and of bodies that are their images under an affine or
quadratic map. Breaks when an element is integrated wrongly, or when a part, support or load could be lost without a word.

    test_import_balance.py"""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks import balance, convert as conversion
from squeal.decks.mesh import integrals
from squeal.decks.mesh.elements import SHAPES
from squeal.tables import BadInput

import decks_abaqus
import numpy as np
from test_import_keywords import FAILED, check

SAME = 1e-12  # relative: rounding of sums over at most 64 points


def close(one, other, scale=1.0):
    return np.all(abs(np.asarray(one) - other) <= SAME * scale)


def elements():
    """The natural element under x = a + B r: volume |det B| V, centre a + B c. V and c of the unit tetrahedron are 1/6 and 1/4, of
    the wedge 1 and (1/3, 1/3, 0), of the cube 8 and 0. Second order also with r_1 + e r_3^2 for r_1, a shear, which leaves the volume
    and moves the centre by e <r_3^2> B e_1: of the tetrahedron <r_3^2> is 1/10, of the others 1/3."""
    plain = {"tet": (1 / 6, (1 / 4,) * 3, 1 / 10), "wedge": (1, (1 / 3, 1 / 3, 0), 1 / 3), "hex": (8, (0, 0, 0), 1 / 3)}
    b, a = np.array([[2.0, 0.3, -0.1], [0.2, 1.5, 0.4], [-0.3, 0.1, 0.7]]), np.array([3.0, -1.0, 2.0])
    for shape in SHAPES.values():
        volume, centre, square = plain[shape.family]
        local = integrals.nodes_of(shape)
        x = local @ b.T + a
        for about, places, moved in (("straight", x, 0), ("curved", x + np.outer(local[:, 2]**2, 0.05 * b[:, 0]), 0.05 * square)):
            if about == "curved" and not shape.second:
                continue
            wanted, middle = abs(np.linalg.det(b)) * volume, b @ centre + a + moved * b[:, 0]
            image = places[shape.mirror_order()] if about == "straight" else places
            found, moment, second = integrals.volumes(shape, np.stack([places, image]))
            check(f"{shape.name}, {about}: volume", close(found, wanted, wanted), (found, wanted))
            if about == "straight":  # J = int r r' of the natural element by a rule of another degree
                values, _, weights = integrals.rule(shape.family, shape.n_nodes, 4)
                at = values @ local
                wanted_second = abs(np.linalg.det(b)) * np.einsum("p,pi,pj->ij", weights, at @ b.T + a, at @ b.T + a)
                check(f"{shape.name}: second moments", close(second, wanted_second[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]], 100), second)
            check(f"{shape.name}, {about}: centre", close(moment / found[:, None], middle, 10), (moment / found[:, None], middle))


def faces():
    """Area vectors of plane faces, and of curved ones that have the same edge: int n dA depends on the edge alone. The moment
    about the origin of a plane face is its centre x its area vector."""
    for n in (3, 6, 4, 8, 9):
        local = integrals.nodes_of_face(n)
        e1, e2, a = np.array([2.0, 0.5, 0.1]), np.array([-0.2, 1.0, 0.4]), np.array([1.0, 2.0, 3.0])
        x = np.outer(local[:, 0], e1) + np.outer(local[:, 1], e2) + a
        scale, centre = (1 / 2, (e1 + e2) / 3 + a) if n in (3, 6) else (4, a)
        wanted = scale * np.cross(e1, e2)
        area, moment = integrals.areas(x[None])
        check(f"face of {n} nodes: area", close(area[0], wanted, 10), (area, wanted))
        check(f"face of {n} nodes: moment", close(moment[0], np.cross(centre, wanted), 100), (moment, np.cross(centre, wanted)))
    bulged = integrals.nodes_of_face(9) @ np.array([[1.0, 0, 0], [0, 1.0, 0]])
    bulged[8, 2] = 0.7
    check("a bulge leaves the area vector", close(integrals.areas(bulged[None])[0][0], [0, 0, 4], 10))


BOX = decks_abaqus.BODY + "*NSET, NSET=FOOT\n1, 2, 3, 4\n*SURFACE, NAME=TOP\nE, S2\n" + decks_abaqus.STEEL + (
    "*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\nFOOT, 1, 3\n*STEP\n*STATIC\n*DSLOAD\nTOP, P, 2.\n*CLOAD\n7, 1, 3.\n"
    "*DLOAD\nE, GRAV, 9810., 0., 0., -1.\n*END STEP\n")


def box(folder):
    """A box of 10 mm of 7.8e-9 t/mm^3: 7.8e-3 kg about its middle; 2 MPa on 100 mm^2 press it by 200 N, its weight is 7.8e-3 x
    9.81 N. Moment about the origin: (5, 5, 10) mm x (0, 0, -200) N, the middle x the weight, (10, 10, 10) mm x (3, 0, 0) N."""
    (folder / "box.inp").write_text(BOX)
    lines = conversion.convert(folder / "box.inp", "mm-t-s", folder / "box")
    check("box: agrees", any(line.startswith("balance: the scene has") for line in lines), lines)
    seen = []
    kept, conversion.compared = conversion.compared, lambda deck, scene: seen.append((deck, scene)) or kept(deck, scene)
    conversion.convert(folder / "box.inp", "mm-t-s", folder / "box")
    conversion.compared = kept
    weight = 7.8e-3 * 9.81
    for about, model in zip(("deck", "scene"), seen[0]):
        _, row, lost = balance.sums(model)
        check(f"box, {about}: mass", close(row.mass, 7.8e-3), row.mass)
        check(f"box, {about}: centre", close(row.centre, 0.005), row.centre)
        check(f"box, {about}: counts", (row.cells, row.held, row.directions, row.loaded, lost) == (1, 4, 12, 4, None), row)
        check(f"box, {about}: force", close(row.force, [3, 0, -200 - weight], 200), row.force)
        moment = [-1 - 0.005 * weight, 1 + 0.005 * weight + 0.03, -0.03]
        check(f"box, {about}: moment", close(row.moment, moment, 2), (row.moment, moment))
    return seen[0]


def differences(deck):
    """Each thing that a scene could lose is said, by its name."""
    def without(**changed):
        model = balance.Model(deck.x, deck.blocks, deck.parts, pressed=deck.pressed, gravity=deck.gravity)
        model.held, model.springs, model.forces = deck.held.copy(), deck.springs.copy(), deck.forces.copy()
        model.touching = deck.touching
        for name, value in changed.items():
            setattr(model, name, value)
        return model

    (name, density, cells), = deck.parts
    for about, changed, word in (
            ("density", {"parts": [(name, density * (1 + 1e-8), cells)]}, "mass"), ("no density", {"parts": [(name, None, cells)]}, "mass"),
            ("a part", {"parts": []}, "parts: 1 in the deck, 0"), ("supports", {"held": 0 * deck.held}, "held nodes"),
            ("one direction", {"held": deck.held & [True, True, False]}, "held directions"),
            ("a force", {"forces": 0 * deck.forces}, "force"), ("a pressure", {"pressed": []}, "loaded nodes"),
            ("gravity", {"gravity": None}, "force"), ("a place", {"x": deck.x + [1e-7, 0, 0]}, "centre"),
            ("springs", {"springs": deck.springs + 1.0}, "stiffness"),
            ("a contact", {"touching": deck.touching | {"contacts": (1, np.array([1e-4, 1e-4]))}}, "contacts: 0"),
            ("a bolt", {"touching": deck.touching | {"bolts": (1, np.array([1e3, 0]))}}, "1, 1000 N in the scene")):
        lines, differs = balance.compared(deck, without(**changed))
        kept = differs is not None and lines[0] == differs and differs.startswith(balance.MARK) and word in differs
        check(f"said: {about}", kept, differs)
    check("nothing said where nothing differs", balance.compared(deck, without())[1] is None)


def strict(folder):
    """--strict fails on a difference: a scene that is written wrongly; what is on nodes of no element has a line."""
    (folder / "box.inp").write_text(BOX.replace("*CLOAD\n", "*CLOAD\n9, 1, 100.\n").replace("*ELEMENT", "9, 50., 50., 50.\n*ELEMENT"))
    lines = conversion.convert(folder / "box.inp", "mm-t-s", folder / "box")
    said = "balance: nodes of no volume element: 0 held, 1 loaded with 100, 0, 0 N; not in the scene"
    check("nodes of no element have a line", said in lines, lines)
    (folder / "box.inp").write_text(BOX)
    kept, conversion.of_scene = conversion.of_scene, lambda *paths: halved(kept(*paths))
    try:
        conversion.convert(folder / "box.inp", "mm-t-s", folder / "box", strict=True)
        check("--strict fails on a difference", False)
    except BadInput as error:
        check("--strict fails on a difference", f"{balance.MARK}: force of" in str(error) and "--strict" in str(error), error)
    lines = conversion.convert(folder / "box.inp", "mm-t-s", folder / "box")
    check("a difference is the first line of the balance", sum(line.startswith(balance.MARK) for line in lines) == 1, lines)
    conversion.of_scene = kept


def alone(folder):
    """--part writes the mesh and the masses that a deck of this part alone gives, whatever else the deck has."""
    other = "*NODE\n" + "".join(f"{n + 10}, {x}, {y}, {z}\n" for n, x, y, z in (
        (1, 0, 0, 10), (2, 10, 0, 10), (3, 10, 10, 10), (4, 0, 10, 10), (5, 0, 0, 30), (6, 10, 0, 30), (7, 10, 10, 30), (8, 0, 10, 30)))
    other += "*ELEMENT, TYPE=C3D8I, ELSET=F\n2, 11,12,13,14,15,16,17,18\n*SURFACE, NAME=LOW\nF, S1\n*SOLID SECTION, ELSET=F, MATERIAL=M\n"
    touch = "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I\nLOW, TOP\n"
    body, steps = BOX[:BOX.index("*BOUNDARY")], BOX[BOX.index("*BOUNDARY"):]
    for name, text in (("plain", body), ("both", body + other + touch + steps)):
        (folder / f"{name}.inp").write_text(text)
    conversion.convert(folder / "plain.inp", "mm-t-s", folder / "plain")
    lines = conversion.convert(folder / "both.inp", "mm-t-s", folder / "both")
    check("a contact of 10 x 10 mm on 10 x 10 mm", "contacts: 1, 0.0001 m^2 of slaves, 0.0001 m^2 of masters" in lines, lines)
    lines = conversion.convert(folder / "both.inp", "mm-t-s", folder / "one", part="e")
    check("--part: the mesh of the part alone", (folder / "one.msh").read_bytes() == (folder / "plain.msh").read_bytes())
    scene = (folder / "one.yaml").read_text()
    listed = [word for word in ("supports:", "loads:", "contacts:", "gravity:") if f"\n{word}" in scene or f" {word}" in scene]
    check("--part: nothing holds, loads or touches it", not listed and "parts: e\n" in scene, scene)
    check("--part: the balance is that of the part", any(line.startswith("balance: the scene has") for line in lines), lines)
    check("--part: says what it leaves out",
          "e alone, free (--part): without f, and without supports, loads, contacts, ties, joints and "
          "masses, 4 in all" in scene, scene)
    for wrong in ("disc", ""):
        try:
            conversion.convert(folder / "both.inp", "mm-t-s", folder / "one", part=wrong)
            check("--part that is none", False)
        except BadInput as error:
            check("--part that is none", str(error) == f"--part {wrong}: the parts of {folder}/both.inp are e, f", error)
    (folder / "alike.inp").write_text((body + other).replace("ELSET=F", "ELSET=E-").replace("F, S1", "E-, S1"))
    conversion.convert(folder / "alike.inp", "mm-t-s", folder / "second", part="e_2")
    check("--part: a part keeps the name by which it was asked for", "parts: e_2\n" in (folder / "second.yaml").read_text())


def halved(model):
    model.forces /= 2
    return model


def main():
    elements()
    faces()
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        deck, _ = box(Path(name))
        differences(deck)
        strict(Path(name))
        alone(Path(name))
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
