#!/usr/bin/env python3
"""Frequencies of imported decks beside those of the same scene in squeal's own words on a mesh file, and beside
CalculiX's on the same deck. Elements of every shape, distorted, curved and renumbered, so that an order of nodes that is
wrong is an inverted element or another frequency. Breaks when nodes, faces, sets, constants, axes or units are not what
the deck says.

    test_import.py SQUEAL MPIRUN

The comparison with CalculiX is left out without `ccx`."""

import csv
import functools
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.export.calculix import run_calculix
from squeal.decks.convert import convert

import decks
import numpy as np
from served import starter

SAME, CALCULIX, COUNT = 1e-9, 1e-5, 8
FAILED = []


@functools.cache
def program():
    """squeal, on one rank."""
    return starter(sys.argv[1])


def modes(folder, words, ranks=1):
    """Hz, of a run of squeal: the lowest."""
    words = [str(word) for word in [*words, "-output_dir", folder / "out", "-output_fields", 0]]
    if ranks == 1:
        done = program().run(folder, words)
        status, stderr = done.status, done.stderr
    else:
        done = subprocess.run([sys.argv[2], "-n", str(ranks), sys.argv[1], *words], cwd=folder, capture_output=True, text=True, check=False)
        status, stderr = done.returncode, done.stderr
    if status != 0:
        raise SystemExit(f"{' '.join(words)}: {stderr}")
    with (folder / "out/modes.csv").open(newline="") as rows:
        return np.array([float(row["freq_hz"]) for row in csv.DictReader(rows)][:COUNT])


def judge(about, one, other, limit):
    worst = max(abs(one / other - 1)) if len(one) == len(other) == COUNT else np.inf
    print(f"{'ok    ' if worst < limit else 'FAILED'} {about}: apart by {worst:.1e}, {limit:g} allowed")
    if not worst < limit:
        FAILED.append(about)


def imported(folder, name, text):
    """Hz, of a deck that is brought in."""
    path = folder / name
    path.write_text("\n".join(text) + "\n")
    convert(path, output=folder / path.stem)
    return modes(folder, ["-options_file", f"{path.stem}.yaml"])


def materials(kind):
    """Constants: hex20 with both, of the others those of first order isotropic, those of second order orthotropic."""
    isotropic = decks.YOUNG, decks.POISSON
    if kind == "hex20":
        return isotropic, decks.ORTHOTROPIC
    return [decks.ORTHOTROPIC if kind[-1] in "025" else isotropic]


def abaqus(folder):
    """All shapes as decks of Abaqus; CalculiX on those of hex20."""
    for kind, options in (("hex8", ()), ("hex20", ("--curve",)), ("tet10", ("--curve",)), ("tet4", ()), ("wedge15", ("--curve",)),
                          ("wedge6", ()), ("hex+wedge2", ()), ("wedge+tet1", ())):
        solid = decks.Solid(kind, folder, "--distort", "3", "--renumber", "5", *options)
        for constants in materials(kind):
            deck = decks.abaqus(solid, constants)
            about = f"{kind}, {'isotropic' if len(constants) == 2 else 'orthotropic'}"
            ours = imported(folder, "deck.inp", deck)
            judge(f"{about}: deck of Abaqus, own scene", ours, modes(folder, decks.scene_words(solid.path, constants)), SAME)
            if kind == "hex20" and shutil.which("ccx"):
                theirs = run_calculix(folder, deck)[0].imag[:COUNT] / (2 * np.pi)
                judge(f"{about}: deck of Abaqus, CalculiX", ours, theirs, CALCULIX)


def middles(folder):
    """Springs at nodes in the middle of edges alone, without the corners beside them: as CalculiX has it, on one rank and two."""
    solid = decks.Solid("hex20", folder, "--elements", "4,2,2")
    corners = set(solid.cells["hex20"][:, :8].ravel().tolist())
    deck = decks.abaqus(solid, springs=[node for node in solid.nodes("right") if node not in corners])
    ours = imported(folder, "deck.inp", deck)
    whole = modes(folder, decks.scene_words(solid.path))
    judge("springs in the middle of edges: one rank, two", ours, modes(folder, ["-options_file", "deck.yaml"], 2), SAME)
    apart = max(abs(ours / whole - 1))
    print(f"       and by {apart:.1e} from springs at all nodes")
    if not apart > 1e-3:
        FAILED.append("springs in the middle of edges do nothing of their own")
    if shutil.which("ccx"):
        judge("springs in the middle of edges: CalculiX", ours, run_calculix(folder, deck)[0].imag[:COUNT] / (2 * np.pi), CALCULIX)


def nastran(folder):
    """The same of Nastran, in its three kinds of fields; small ones hold the numbers of a box that is not distorted."""
    for kind, form, options in (("hex8", "small", ()), ("hex20", "large", ("--curve",)), ("tet10", "free", ("--curve",)),
                                ("hex+wedge2", "large", ()), ("wedge+tet1", "free", ())):
        shaken = () if form == "small" else ("--distort", "3", "--renumber", "5", *options)
        solid = decks.Solid(kind, folder, *shaken)
        for constants in materials(kind):
            ours = imported(folder, "deck.bdf", decks.nastran(solid, form, constants))
            about = f"{kind}, {'isotropic' if len(constants) == 2 else 'orthotropic'}: deck of Nastran, {form} fields"
            judge(f"{about}, own scene", ours, modes(folder, decks.scene_words(solid.path, constants)), SAME)


def ansys(folder):
    """The same of Ansys: tetrahedra of their own types, or folded hexahedra, as are wedges."""
    for kind, plain in (("hex8", False), ("hex20", False), ("tet10", True), ("tet10", False), ("wedge15", False), ("tet4", True),
                        ("hex+wedge2", False), ("wedge+tet1", False)):
        solid = decks.Solid(kind, folder, "--distort", "3", "--renumber", "5", *(("--curve",) if kind[-1] in "05" else ()))
        for constants in materials(kind):
            ours = imported(folder, "deck.cdb", decks.ansys(solid, constants, plain=plain))
            words = decks.scene_words(solid.path, constants)
            words[words.index("-springs"):words.index("-modes_target")] = []
            about = f"{kind}, {'isotropic' if len(constants) == 2 else 'orthotropic'}: archive of Ansys"
            judge(f"{about}{'' if plain else ', folded'}, own scene", ours, modes(folder, words), SAME)


def meshio(folder):
    """Meshes that meshio reads: free bodies from VTK and VTU; from MED, whose elements are the other way round, the scene of
    the other decks, with its groups of cells, faces and nodes."""
    material = ["young", 210e9, "poisson", 0.3, "density", 7800]
    for kind, ending in (("hex20", ".vtk"), ("wedge15", ".vtu"), ("wedge+tet1", ".vtu"), ("tet10", ".vtk"), ("hex8", ".med"),
                         ("hex20", ".med"), ("wedge15", ".med"), ("wedge+tet1", ".med")):
        solid = decks.Solid(kind, folder, "--distort", "3", "--renumber", "5")
        path = folder / f"mesh{ending}"
        decks.meshio_file(solid, path, half=kind in ("hex20", "wedge15"))
        convert(path, "mm-t-s", folder / "mesh")
        if ending == ".med":
            words = decks.scene_words(solid.path)
            theirs = [{"-model_mesh": "mesh.msh"}.get(before, word) for before, word in zip(["", *words], words)]
        else:
            words = ["-parts", "bar", *(word for key, value in zip(material[::2], material[1::2]) for word in (f"-bar_{key}", value)),
                     "-model_mesh", solid.path, "-modes_band", "1000,200000"]
            theirs = [str(word).replace("bar", "part_4") if word != solid.path else "mesh.msh" for word in words]
        judge(f"{kind}: {ending} by meshio, own mesh", modes(folder, theirs), modes(folder, words), SAME)


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        for compare in (abaqus, middles, nastran, ansys, meshio):
            if len(sys.argv) < 4 or compare.__name__ in sys.argv[3]:
                compare(Path(name))
    program().end()
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
