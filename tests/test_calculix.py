#!/usr/bin/env python3
"""Frequencies of clamped bodies beside CalculiX's on the same mesh, elastic ones of steel and of an orthotropic material
in turned axes:

  hex20   a piece of a ring that climbs, with curved sides. Both integrate with 27 points
  tet10   free tetrahedra with straight sides in a skewed block. The stiffness of both is exact. CalculiX integrates the
          mass of C3D10 with 4 points as well, which moves these frequencies by up to 4e-3; squeal's, with 15 points, is exact.
          Hence tests/tetrahedra.py stands between them: with exact mass it must agree with squeal, with CalculiX's 4 points
          with CalculiX
  ties    two boxes whose meshes do not match
  friction  a disc and a pad in sliding contact, of hex20, where modes flutter: complex eigenvalues, see
          scripts/squeal/mesh/disc_pad.py

Breaks when shape functions, the order of the nodes of a file, engineering constants or their axes differ from what
others take them for, or when friction acts with another force or along another direction. CalculiX prints 7 digits of
an eigenvalue.

    test_calculix.py SQUEAL MPIRUN

Exit status 77, skipped, without the programs ccx (Debian's calculix-ccx) and gmsh."""

import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.export.calculix import run_calculix
from squeal.mesh.disc_pad import Mesh, calculix_cards, squeal_words
from squeal.export.inp import deck_cards
from squeal.export.options import Options
from squeal.export.scene_deck import scene_deck
from squeal.sweep.runs import distances, eigenvalues
from squeal.tables import read_table

import numpy as np
from tetrahedra import frequencies, rotated

COUNT = 12
RTOL, EXACT = 1e-5, 1e-9
DENSITY = 7800
MATERIALS = {"isotropic": ([210e9], [0.3], None),
             "orthotropic": ([60e9, 9e9, 20e9], [0.28, 0.35, 0.31], [5e9, 7e9, 3e9])}  # 1,2,3; 12,13,23
AXES = [0.6, 0.5, 0.2], [-0.3, 0.8, 0.4]  # axis 1, and another in the plane of 1 and 2
BLOCK = """Point(1) = {0, 0, 0};
line[] = Extrude {0.05, 0, 0} {Point{1};};
face[] = Extrude {0.006, 0.03, 0} {Line{line[1]};};
body[] = Extrude {0, 0.004, 0.02} {Surface{face[1]};};
Physical Volume("body") = {body[1]};
Physical Surface("root") = {body[5]};
"""
RING = """Point(1) = {0.05, 0, 0};
line[] = Extrude {0.03, 0, 0} {Point{1}; Layers{3};};
face[] = Extrude {0, 0.004, 0.02} {Line{line[1]}; Layers{2}; Recombine;};
body[] = Extrude {{0, 0, 0.01}, {0, 0, 1}, {0, 0, 0}, 1.2} {Surface{face[1]}; Layers{6}; Recombine;};
Physical Volume("body") = {body[1]};
Physical Surface("root") = {face[1]};
"""
# name -> geometry, options of gmsh
MESHES = {"tet10": (BLOCK, "-clmin 0.011"), "hex20": (RING, "-setnumber Mesh.SecondOrderIncomplete 1")}


def made(command, folder):
    """What a program prints; a failure ends the test."""
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{command[0]}: exit status {done.returncode}: {done.stdout[-500:]} {done.stderr[-500:]}")
    return done.stdout


def words_of(folder, mesh, material):
    """The scene."""
    young, poisson, shear = (",".join(map(str, values or [])) for values in MATERIALS[material])
    words = ["-model_mesh", folder / f"{mesh}.msh", "-parts", "body", "-body_young", young, "-body_poisson", poisson,
             "-body_density", DENSITY, "-supports", "clamp", "-clamp_set", "root", "-clamp_fix", "xyz", "-modes_target", 1,
             "-modes_count", COUNT]
    if shear:
        words += ["-body_shear", shear]
        words += [word for k in (0, 1) for word in (f"-body_axis_{k + 1}", ",".join(map(str, AXES[k])))]
    return words


def exported(folder, mesh, material):
    """Its deck."""
    deck, _ = scene_deck(Options.of_words(words_of(folder, mesh, material)), folder / f"{mesh}.msh")
    return deck


def calculix(folder, mesh, material):
    """Hz, ascending."""
    return run_calculix(folder, deck_cards(exported(folder, mesh, material)))[0].imag[:COUNT] / (2 * np.pi)


def squeal(folder, mesh, material):
    """The same."""
    made([sys.argv[2], "-n", 1, sys.argv[1], *words_of(folder, mesh, material), "-output_dir", "out", "-output_fields", 0], folder)
    with (folder / "out/modes.csv").open(newline="") as lines:
        return np.array([float(row["freq_hz"]) for row in csv.DictReader(lines)][:COUNT])


def compliance(material):
    """[6, 6], engineering shear, order 11 22 33 12 13 23."""
    young, poisson, shear = MATERIALS[material]
    shear = shear or [young[0] / (2 * (1 + poisson[0]))] * 3
    young, poisson = (np.broadcast_to(values, 3) for values in (young, poisson))
    full = np.diag([*(1 / young), *(1 / np.array(shear))])
    for (i, j), nu in zip(((0, 1), (0, 2), (1, 2)), poisson):
        full[i, j] = full[j, i] = -nu / young[i]
    return full


def turned():
    """Local axes, in rows."""
    first = np.array(AXES[0]) / np.linalg.norm(AXES[0])
    second = AXES[1] - first * (first @ AXES[1])
    second /= np.linalg.norm(second)
    return np.array([first, second, np.cross(first, second)])


def between(folder, mesh, material):
    """Frequencies of the third: with exact mass, with that of 4 points."""
    deck = exported(folder, mesh, material)
    stiffness = rotated(compliance(material), turned())
    cells, held = deck.blocks[0].nodes, deck.supports[0].nodes
    return [frequencies(deck.x, cells, held, stiffness, DENSITY, four)[:COUNT] for four in (False, True)]


def judge(names, one, other, rtol=RTOL):
    """Whether they agree; prints it."""
    worst = max(abs(one / other - 1)) if len(one) == len(other) == COUNT else np.inf
    print(f"{'ok    ' if worst < rtol else 'FAILED'} {names}: {COUNT} frequencies from {one[0]:.1f} to {one[-1]:.1f} Hz, apart "
          f"by {worst:.1e} at most, {rtol:g} allowed")
    return worst < rtol


def compare(folder, mesh, material):
    """Whether all agree that should."""
    ours, theirs = squeal(folder, mesh, material), calculix(folder, mesh, material)
    name = f"{mesh}, {material}: squeal"
    if mesh == "hex20":
        return judge(f"{name}, CalculiX", ours, theirs)
    exact, four_points = between(folder, mesh, material)
    print(f"       mass of 4 points: {max(abs(theirs / ours - 1)):.1e} between squeal and CalculiX")
    kept = judge(f"{name}, exact mass", ours, exact, EXACT)
    return judge(f"{mesh}, {material}: CalculiX, mass of 4 points", theirs, four_points) and kept


def tied(folder):
    """Whether all frequencies agree of two boxes whose meshes do not match, by a tie."""
    boxes = "low:hex20:0,0,0:0.06,0.02,0.01:4,2,1", "top:hex20:0,0,0.01:0.06,0.02,0.02:6,3,1"
    made([sys.executable, Path(__file__).resolve().parent / "boxes.py", "tied.msh", *boxes], folder)
    words = ["-model_mesh", folder / "tied.msh", "-parts", "low,top", "-supports", "clamp", "-clamp_set", "low_bottom", "-ties", "glue",
             "-glue_surfaces", "top_bottom,low_top", "-modes_target", 1, "-modes_count", COUNT]
    for part, young in (("low", 210e9), ("top", 70e9)):
        words += [f"-{part}_young", young, f"-{part}_poisson", 0.3, f"-{part}_density", DENSITY]
    deck, _ = scene_deck(Options.of_words(words), folder / "tied.msh")
    theirs = run_calculix(folder, deck_cards(deck))[0].imag[:COUNT] / (2 * np.pi)
    made([sys.argv[2], "-n", 1, sys.argv[1], *words, "-output_dir", "out", "-output_fields", 0], folder)
    ours = np.array([row["freq_hz"] for row in read_table(folder / "out/modes.csv", {"freq_hz": float})])
    return judge("ties: squeal, CalculiX", ours, theirs)


def friction(folder):
    """Whether all eigenvalues to 12 kHz agree, one by one, and some of them have left the imaginary axis."""
    mesh, mu = folder / "pair.msh", 0.6
    Mesh((6, 8, 1), 3, 5, 3, 2).write(mesh)
    made([sys.argv[2], "-n", 1, sys.argv[1], *squeal_words(mesh, mu, (0, 12000)), "-output_dir", "out", "-output_fields", 0],
         folder)
    ours = eigenvalues(read_table(folder / "out/modes.csv", {"freq_hz": float, "growth_rad_s": float}))
    theirs, *_ = run_calculix(folder, calculix_cards(mesh, mu, len(ours)))
    worst = max(distances(ours, theirs).max(), distances(theirs, ours).max()) if len(ours) == len(theirs) else np.inf
    growth = max(ours.real)
    kept = worst < RTOL and growth > 100
    print(f"{'ok    ' if kept else 'FAILED'} friction: squeal, CalculiX: {len(ours)} eigenvalues, apart by {worst:.1e} at "
          f"most, {RTOL:g} allowed; largest growth {growth:.1f} 1/s, 100 asked")
    return kept


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    absent = [name for name in ("ccx", "gmsh") if not shutil.which(name)]
    if absent:
        print(f"skipped: no {' '.join(absent)}, of scripts/packages.txt")
        return 77
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        kept = friction(folder)
        kept &= tied(folder)
        for mesh, (geometry, options) in MESHES.items():
            (folder / f"{mesh}.geo").write_text(geometry)
            made(["gmsh", "-3", "-order", 2, *options.split(), "-format", "msh22", f"{mesh}.geo", "-o", f"{mesh}.msh"],
                 folder)
            for material in MATERIALS:
                kept &= compare(folder, mesh, material)
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
