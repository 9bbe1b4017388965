#!/usr/bin/env python3
"""Frequencies of imported decks beside those of the same scene in squeal's own words on a mesh file, and beside
CalculiX's on the same deck. Elements of every shape, distorted, curved and renumbered, so that an order of nodes that is
wrong is an inverted element or another frequency. Breaks when nodes, faces, sets, constants, axes or units are not what
the deck says.

    test_import.py SQUEAL MPIRUN

The comparison with CalculiX is left out without `ccx`."""

import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.calculix import run_calculix
from squeal.decks.convert import convert

import decks
import numpy as np

SAME, CALCULIX, COUNT = 1e-9, 1e-5, 8
FAILED = []


def modes(folder, words):
    """Hz, of a run of squeal."""
    command = [sys.argv[2], "-n", 1, sys.argv[1], *words, "-output_dir", folder / "out", "-output_fields", 0]
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr}")
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


def abaqus(folder):
    """All shapes as decks of Abaqus; CalculiX on those of hex20."""
    for kind, options in (("hex8", ()), ("hex20", ("--curve",)), ("tet10", ("--curve",)), ("tet4", ()), ("wedge15", ("--curve",)),
                          ("wedge6", ()), ("hex+wedge2", ()), ("wedge+tet1", ())):
        solid = decks.Solid(kind, folder, "--distort", "3", "--renumber", "5", *options)
        for constants in ((decks.YOUNG, decks.POISSON), decks.ORTHOTROPIC):
            deck = decks.abaqus(solid, constants)
            about = f"{kind}, {'isotropic' if len(constants) == 2 else 'orthotropic'}"
            ours = imported(folder, "deck.inp", deck)
            judge(f"{about}: deck of Abaqus, own scene", ours, modes(folder, decks.scene_words(solid.path, constants)), SAME)
            if kind == "hex20" and shutil.which("ccx"):
                theirs = run_calculix(folder, deck)[0].imag[:COUNT] / (2 * np.pi)
                judge(f"{about}: deck of Abaqus, CalculiX", ours, theirs, CALCULIX)


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        abaqus(Path(name))
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
