#!/usr/bin/env python3
"""Decks of scripts/export_ccx:

  round trip  a scene with every element, isotropic, orthotropic and transversely isotropic, in turned and in cylinder's axes, with
              supports, springs at nodes, in all and per area, forces and a pressure; brought back by scripts/import it has
              the same frequencies and growth, and its loads do the same work, to 1e-9
  contact     two boxes in sliding contact, the same; the direction of slip, which no deck has, is given again
  CalculiX    finds the frequencies of squeal in the decks of hex20 with springs, to 1e-5, where there is ccx; complex ones of one
              contact and of two
  tie         reaches as far in the deck as in squeal
  rig         the built-in rig, in the file of -rig_save, has the same modes; and in a deck
  notes       what a deck does not have is listed, an option a line
  bad         one line, status 1, and no deck

Breaks when nodes, faces, shares of springs and forces, constants or axes are not what squeal computes with.

    test_export_ccx.py SQUEAL MPIRUN"""

import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from forked import run_command
from squeal.export.calculix import eigenvalues
from squeal.mesh.disc_pad import Mesh, squeal_words
from squeal.mesh.petsc_matrix import read_matrix, read_vector
from squeal.provenance import Provenance
from squeal.sweep.runs import distances

SAME, CALCULIX = 1e-9, 1e-5
MATERIALS = {"isotropic": "young: 2e11, poisson: 0.3",
             "orthotropic": 'young: "60e9,9e9,20e9", poisson: "0.28,0.35,0.31", shear: "5e9,7e9,3e9", axis_1: "0.6,0.5,0.2", '
                            'axis_2: "-0.3,0.8,0.4"',
             "transversely": 'young: "10e9,3e9", poisson: "0.2,0.3", shear: 2.5e9, axis_3: "0.2,0.1,1"',
             "cylinder": 'young: "60e9,9e9,20e9", poisson: "0.28,0.35,0.31", shear: "5e9,7e9,3e9", cylinder_axis: "0,0.1,1", '
                         'cylinder_centre: "-0.05,0,0"'}
SCENE = """model: {{mesh: {mesh}, gravity: "3,0,-9.81"}}
parts: bar
bar: {{{material}, density: 7800, alpha: 3, beta: 1e-8}}
supports: root
root: {{set: left, fix: xyz}}
springs: each,all,area,rim
each: {{set: right, stiffness: "1e5,0,0"}}
all: {{set: top, stiffness_total: "0,1e7,0"}}
area: {{set: front, stiffness_per_area: "0,0,1e10"}}
rim: {{set: edge, stiffness_total: "1e6,0,0"}}
loads: push,press
push: {{set: right, force: "20,0,-100"}}
press: {{set: top, pressure: 1e5}}
modes: {{target: 1, count: 8}}
"""
PAIR = """model: {mesh: pair.msh}
parts: base,block
base: {young: 2e11, poisson: 0.3, density: 7800}
block: {young: 1e10, poisson: 0.3, density: 2500}
supports: ground,back
ground: {set: base_bottom}
back: {set: block_top, fix: xy}
loads: press
press: {set: block_top, force: "0,0,-1000"}
contacts: rub
rub: {surfaces: "block_bottom,base_top", kn_per_area: 1e13, mu: 0.6, slip: "0,1,0"}
dashpots: oil
oil: {set: block_top, viscosity: "0,0,10"}
probes: tip
tip: {at: "0,0,0.03"}
modes: {target: 1, count: 12, growth: 5000, contact: all}
"""
TWO = """model: {mesh: two.msh}
parts: plate,low,high
plate: {young: 1.1e11, poisson: 0.3, density: 7100}
low: {young: 1e10, poisson: 0.3, density: 2500}
high: {young: 1.2e10, poisson: 0.3, density: 2500}
supports: edge,low_back,high_back
edge: {set: plate_left, fix: xyz}
low_back: {set: low_bottom, fix: xy}
high_back: {set: high_top, fix: xy}
contacts: low_rub,high_rub
low_rub: {surfaces: "low_top,plate_bottom", kn_per_area: 1e17, mu: 0.5, slip: "0,1,0"}
high_rub: {surfaces: "high_bottom,plate_top", kn_per_area: 1e17, mu: 0.7, slip: "1,1,0"}
modes: {target: 1, count: 12, growth: 20000, contact: all}
"""
RIG = """model: {source: rig}
rig: {disc_elements: "6,24,1", pad_elements: "2,2,2", beam_elements: 3}
parts: disc,pad,beam
disc: {young: 2.1e11, poisson: 0.3, density: 7800}
pad: {young: 8e9, poisson: 0.3, density: 2500}
beam: {young: 2.1e11, poisson: 0.3, density: 7800}
supports: hub
hub: {set: disc_inner, fix: xyz}
springs: rows
rows: {set: beam_rows, stiffness: "0,8e6,0"}
contacts: contact
contact: {surfaces: "pad_face,disc_face", kn_per_area: 1e13, mu: 0.9, slip: "0,1,0"}
modes: {band: "500,9000", growth: 6000}
"""
FAULTS = []


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


def run(folder, *words):
    """What a command that must succeed says on stderr."""
    done = run_command(words, folder)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stdout[-300:]}{done.stderr}")
    return done.stderr


def squeal(folder, scene, output, *words):
    run(folder, sys.argv[2], "-n", 1, sys.argv[1], "-options_file", scene, "-output_dir", output, *words)


def modes_of(folder):
    """sigma + i omega."""
    with (folder / "modes.csv").open(newline="") as lines:
        return np.array([complex(float(row["growth_rad_s"]), 2 * np.pi * float(row["freq_hz"])) for row in csv.DictReader(lines)])


def compliance(folder):
    """f' K^-1 f of the matrices of a run: the work of its loads, whatever the numbers of its unknowns."""
    rows, columns, row, column, value = read_matrix(folder / "K.bin")
    force = read_vector(folder / "F.bin")
    return np.array([force @ scipy.sparse.linalg.spsolve(scipy.sparse.csc_matrix((value, (row, column)), (rows, columns)), force)])


def apart(one, other):
    return abs(one - other).max() / abs(one).max() if one.shape == other.shape else np.inf


def there_and_back(folder, *words):
    """Exports the run in `out` and brings the deck back as back.yaml; returns what the export says."""
    said = run(folder, SOURCE / "scripts/export_ccx", "out", *words)
    run(folder, SOURCE / "scripts/import", "out/deck.inp", "-o", "back", "--units", "m-kg-s")
    return said


def check_solids(top):
    """Every element; materials in turn."""
    kinds = ["tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20", "hex+wedge2", "wedge+tet1"]
    names = list(MATERIALS)
    for kind, name in [(kind, names[k % len(names)]) for k, kind in enumerate(kinds)] + [("hex20", name) for name in names]:
        folder = Path(tempfile.mkdtemp(dir=top))
        run(folder, sys.executable, SOURCE / "tests/solids.py", kind, "--distort", 1, "--curve", "--renumber", 2, "bar.msh")
        (folder / "scene.yaml").write_text(SCENE.format(mesh="bar.msh", material=MATERIALS[name]))
        squeal(folder, "scene.yaml", "out", "-output_fields", 0, "-operators_save", "one")
        there_and_back(folder)
        squeal(folder, "back.yaml", "again", "-output_fields", 0, "-operators_save", "other")
        modes = modes_of(folder / "out")
        worst = apart(modes, modes_of(folder / "again")), apart(compliance(folder / "one"), compliance(folder / "other"))
        check(len(modes) == 8 and max(worst) < SAME,
              f"round trip: {kind}, {name}: modes apart by {worst[0]:.1e}, work of loads {worst[1]:.1e}")
        if kind == "hex20" and name != "cylinder" and shutil.which("ccx"):
            run(folder / "out", "ccx", "deck")
            theirs = eigenvalues(folder / "out/deck.dat").imag
            check(apart(modes.imag, theirs) < CALCULIX, f"CalculiX: {kind}, {name}: apart by {apart(modes.imag, theirs):.1e}")


def check_contact(top):
    """Sliding boxes."""
    run(top, sys.executable, SOURCE / "tests/boxes.py", "pair.msh", "base:hex8:0,0,0:0.06,0.06,0.02:4,4,2",
        "block:hex8:0.01,0.01,0.02:0.05,0.05,0.04:3,3,2")
    (top / "pair.yaml").write_text(PAIR)
    squeal(top, "pair.yaml", "oiled", "-output_fields", 0)
    (top / "dry.yaml").write_text("\n".join(line for line in PAIR.splitlines() if not line.startswith(("dashpots", "oil"))))
    squeal(top, "dry.yaml", "out", "-output_fields", 0)
    there_and_back(top)
    contact = contact_of(top / "back.yaml")
    squeal(top, "back.yaml", "again", "-output_fields", 0, f"-{contact}_slip", "0,1,0", "-modes_growth", 5000, "-modes_contact", "all")
    modes, again = modes_of(top / "out"), modes_of(top / "again")
    check(apart(modes, again) < SAME and max(modes.real) > 1,
          f"contact: {len(modes)} modes apart by {apart(modes, again):.1e}, growth to {max(modes.real):.1f} 1/s")
    said = run(top, SOURCE / "scripts/export_ccx", "oiled").splitlines()
    named = {line.split(": ")[1].split()[0] for line in said}
    check({"oil_set", "oil_viscosity", "tip_at", "rub_slip", "modes_growth", "modes_contact"} <= named
          and all(line.startswith("export_ccx: ") for line in said),
          f"notes: {len(said)} lines name {', '.join(sorted(named))}")
    head = (top / "oiled/deck.inp").read_text()
    check(all(line.removeprefix("export_ccx: ") in head for line in said), "notes: the deck has them too")
    used = {name for name in Provenance(top / "oiled/scene.yaml").given if name not in named and not name.startswith("output_")}
    check(used == {"model_mesh", "parts", "base_young", "base_poisson", "base_density", "block_young", "block_poisson", "block_density",
                   "supports", "ground_set", "back_set", "back_fix", "loads", "press_set", "press_force", "contacts", "rub_surfaces",
                   "rub_kn_per_area", "rub_mu", "modes_target", "modes_count"} | (used & {"dashpots", "probes"}),
          "notes: all others are in the deck")


def check_rig(top):
    """The built-in rig, its mesh in a file, and its deck."""
    (top / "rig.yaml").write_text(RIG)
    for ranks in (1, 2):
        run(top, sys.argv[2], "-n", ranks, sys.argv[1], "-options_file", "rig.yaml", "-rig_save", f"rig{ranks}.msh", "-output_dir",
            f"rig{ranks}", "-output_fields", 0)
    check((top / "rig1.msh").read_bytes() == (top / "rig2.msh").read_bytes(), "rig: the same file on two ranks")
    (top / "file.yaml").write_text("model: {mesh: rig1.msh}\n" + "".join(
        line + "\n" for line in RIG.splitlines() if not line.startswith(("model", "rig"))))
    squeal(top, "file.yaml", "of_file", "-output_fields", 0)
    modes = modes_of(top / "rig1")
    check(apart(modes, modes_of(top / "of_file")) < 1e-11 and max(modes.real) > 1,
          f"rig: as a file, apart by {apart(modes, modes_of(top / 'of_file')):.1e}")
    run(top, SOURCE / "scripts/export_ccx", "rig1")
    run(top, SOURCE / "scripts/import", "rig1/deck.inp", "-o", "of_deck", "--units", "m-kg-s")
    squeal(top, "of_deck.yaml", "of_deck", "-output_fields", 0, f"-{contact_of(top / 'of_deck.yaml')}_slip", "0,1,0", "-modes_growth", 6000)
    check(apart(modes, modes_of(top / "of_deck")) < SAME,
          f"rig: as a deck and back, apart by {apart(modes, modes_of(top / 'of_deck')):.1e}")
    done = subprocess.run([sys.argv[1], "-options_file", "rig.yaml", "-rig_save", "nowhere/rig.msh", "-output_dir", "no"], cwd=top,
                          capture_output=True, text=True, check=False)
    check(done.returncode == 1 and "cannot write 'nowhere/rig.msh' of -rig_save" in done.stderr, f"rig: {done.stderr.strip()}")


def check_modes_beside(top, name, what):
    """Complex modes of a folder of results beside those of CalculiX on its deck of sliding contacts, each way, one of which grows."""
    run(top, SOURCE / "scripts/export_ccx", name, "--sliding")
    run(top / name, "ccx", "deck")
    modes, theirs = modes_of(top / name), eigenvalues(top / name / "deck.dat")
    worst = max(distances(modes, theirs).max(), distances(theirs, modes).max()) if len(modes) == len(theirs) else np.inf
    check(worst < CALCULIX and max(modes.real) > 1,
          f"CalculiX: {what}, {len(modes)} modes apart by {worst:.1e}, growth to {max(modes.real):.1f} 1/s")


def check_sliding(top):
    """The deck of --sliding, in which CalculiX finds the modes of a disc and a pad that flutter."""
    if not shutil.which("ccx"):
        return
    Mesh((6, 8, 1), 3, 5, 3, 2).write(top / "disc.msh")
    run(top, sys.argv[2], "-n", 1, sys.argv[1], *squeal_words(top / "disc.msh", 0.6, (0, 12000)), "-output_dir", "sliding",
        "-output_fields", 0)
    check_modes_beside(top, "sliding", "--sliding")
    done = run_command([SOURCE / "scripts/export_ccx", "out", "--sliding", "-o", "s.inp", "--mesh", "pair.msh"], top)
    check(done.returncode == 0, "sliding: of boxes on each other too")


def check_two_sliding(top):
    """Pads on both sides of a plate, which slide in two directions with two coefficients."""
    if not shutil.which("ccx"):
        return
    run(top, sys.executable, SOURCE / "tests/boxes.py", "two.msh", "plate:hex20:-0.02,-0.02,-0.004:0.06,0.06,0.004:4,4,1",
        "low:hex20:0,0,-0.024:0.04,0.04,-0.004:2,2,2", "high:hex20:0,0,0.004:0.04,0.04,0.024:2,2,2")
    (top / "two.yaml").write_text(TWO)
    squeal(top, "two.yaml", "two", "-output_fields", 0)
    check_modes_beside(top, "two", "--sliding of two contacts")
    for words, said in ((["-low_rub_surfaces", "plate_bottom,low_top"], "it must stay"),
                        (["-contacts", "high_rub", "-high_rub_law", "constraint"], "high_rub is none")):
        squeal(top, "two.yaml", "wrong", "-output_fields", 0, *words)
        done = run_command([SOURCE / "scripts/export_ccx", "wrong", "--sliding"], top)
        check(done.returncode == 1 and said in done.stderr and done.stderr.count("\n") == 1, f"sliding: {done.stderr.strip()}")


def check_tie(top):
    """A tie across a gap of 0.8 mm, more than the 2.5 % of an element that CalculiX takes by itself, less than 5 % of a facet."""
    run(top, sys.executable, SOURCE / "tests/boxes.py", "tied.msh", "low:hex8:0,0,0:0.06,0.04,0.01:3,2,1",
        "top:hex8:0,0,0.0108:0.06,0.04,0.02:6,3,1")
    run(top, sys.argv[2], "-n", 1, sys.argv[1], "-model_source", "file", "-model_mesh", "tied.msh", "-parts", "low,top", "-low_young",
        "2e11", "-low_poisson", 0.3, "-low_density", 7800, "-top_young", "2e11", "-top_poisson", 0.3, "-top_density", 7800, "-ties", "glue",
        "-glue_surfaces", "top_bottom,low_top", "-modes_target", 1, "-modes_count", 8, "-output_dir", "tied", "-output_fields", 0)
    run(top, SOURCE / "scripts/export_ccx", "tied")
    cards = [line for line in (top / "tied/deck.inp").read_text().splitlines() if line.startswith("*TIE")]
    given = [float(card.split("POSITION TOLERANCE=")[1]) for card in cards if "POSITION TOLERANCE=" in card]
    check(len(given) == 1 and abs(given[0] - 1e-3) < 1e-12, f"tie: reaches over 5 % of a facet of 20 mm: {cards}")


def contact_of(path):
    """Name of the contact of an imported scene."""
    return next(line.split()[1] for line in path.read_text().splitlines() if line.startswith("contacts:"))


def check_bad(top):
    """One line."""
    run(top, sys.executable, SOURCE / "tests/solids.py", "hex27", "hex27.msh")
    (top / "hex27.yaml").write_text(SCENE.format(mesh="hex27.msh", material=MATERIALS["isotropic"]))
    squeal(top, "hex27.yaml", "of27", "-output_fields", 0)
    run(top, sys.argv[2], "-n", 1, sys.argv[1], "-model_source", "rig", "-parts", "disc", "-rig_pad", 0, "-rig_disc_elements", "3,12,1",
        "-rig_disc_mesh", "axisymmetric", "-disc_young", "2e11", "-disc_density", 7800, "-modes_target", 1, "-modes_count", 8,
        "-output_dir", "rig", "-output_fields", 0)
    squeal(top, SOURCE / "options/affine.yaml", "matrices", "-output_fields", 0)
    (top / "empty").mkdir()
    (top / "gone").mkdir()
    scene = (top / "out/scene.yaml").read_text()
    (top / "gone/scene.yaml").write_text(scene.replace("pair.msh", "gone.msh"))
    (top / "torn.msh").write_bytes((top / "pair.msh").read_bytes()[:2000])
    (top / "short.msh").write_bytes((top / "hex27.msh").read_bytes()[:-400])
    (top / "curved").mkdir()
    (top / "curved/scene.yaml").write_text(f'{scene}\nrub_pressure_law: "power"\n')
    for words, said in ((["nowhere"], "no such folder"), (["empty"], "scene.yaml"), (["of27"], "hex27"), (["rig"], "-rig_save"),
                        (["matrices"], "is of matrices"),
                        (["gone"], "gone.msh"), (["curved"], "_pressure_law power"), (["out", "--mesh", "torn.msh"], "torn.msh"),
                        (["out", "--mesh", "short.msh"], "short.msh"), (["out", "--mesh", "pair.yaml"], "no file of Gmsh"),
                        (["out", "--mesh", "hex27.msh"], "no volume named base"), (["out", "-o", "empty/no/deck.inp"], "deck.inp"),
                        (["of27", "--sliding"], "hex27")):
        done = run_command([SOURCE / "scripts/export_ccx", *words], top)
        check(done.returncode == 1 and done.stderr.count("\n") == 1 and said in done.stderr and not done.stdout,
              f"bad: {' '.join(words)}: {done.stderr.strip()[-300:]}")
    check(not list(top.glob("gone/deck*")) and not list(top.glob("of27/deck*")), "bad: no deck is left")


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        check_solids(Path(name))
        check_contact(Path(name))
        check_rig(Path(name))
        check_sliding(Path(name))
        check_two_sliding(Path(name))
        check_tie(Path(name))
        check_bad(Path(name))
    print("\n".join([f"{len(FAULTS)} faults", *FAULTS]))
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main())
