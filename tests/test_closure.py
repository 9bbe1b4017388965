#!/usr/bin/env python3
"""The balance of growth of every mode of the scenes of options/ that have modes, coarse where they are long, and with damping, spin,
falling friction and exact contact: the shares of modes_causes.csv add up to the growth of modes.csv, with nothing left, and the pairs of
modes_feed_in.csv to the powers of their contacts. A cause below the rounding of the eigenvalue, that of an absorber at a node of the mode,
is none. With --full all scenes are as their files have them.

    test_closure.py PROGRAM [--full]
"""

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import make_mesh  # noqa: E402
from squeal.run.program import ROOT, scene  # noqa: E402

CLOSED = 1e-12  # of the largest cause of a mode, or of the largest power of a pair of it
SMALL = "-rig_disc_elements 8,40,1 -rig_pad_elements 4,4,2"
FALLING = "-contact_friction_damping -contact_speed 2 -contact_force 500 -contact_mu_slope -0.02"
SPIN = "-disc_spin 60 -disc_spin_axis 0,0,1 -disc_spin_centre 0,0,0"
KINDS = {"friction": "friction_w", "friction damping": "friction_damping_w", "falling friction": "falling_friction_w"}
MESHES = {"brake": {"size": 24}, "fist_brake": {"size": 30, "vanes": 4, "order": 1}, "cantilever": {}}
# name: files, words, those that make it coarse; what has neither friction nor damping has no causes, and damping is put on it
SCENES = {
    "affine: matrices": ("affine", "", ""),
    "oscillator": ("oscillator", "", ""),
    "cantilever, damped": ("cantilever", "-beam_beta 1e-8 -beam_alpha 2", ""),
    "plate, damped": ("plate", "-disc_beta 1e-7", "-rig_disc_elements 8,48,1"),
    "plate_absorber: a superelement": ("plate plate_absorber", "", "-rig_disc_elements 8,48,1"),
    "free_ring, damped": ("free_ring", "-disc_alpha 5", "-rig_disc_elements 8,48,1"),
    "massi2005": ("massi2005", "", SMALL),
    "massi2005, loaded": ("massi2005", "-modes_contact static", SMALL),
    "massi2005, exact, falling friction": ("massi2005", f"{FALLING} -contact_law constraint", SMALL),
    "massi2005, spin, damped": ("massi2005", f"{SPIN} -pad_beta 1e-7 -disc_alpha 2", SMALL),
    "massi2005_coarse": ("massi2005 massi2005_coarse", "", "-rig_disc_elements 9,67,1 -rig_pad_elements 4,4,2"),
    "massi2005_fitted_sweep: its modes": ("massi2005 massi2005_fitted_sweep", "", SMALL),
    "massi2005_frf": ("massi2005 massi2005_frf", "", SMALL),
    "brake: three contacts": ("brake", "", ""),
    "brake_sweep: its modes": ("brake", "-modes_contact static -modes_band 4200,4900 -inner_mu 0.6 -outer_mu 0.6", ""),
    "fist_brake: ties, bushings, contacts that hold": ("fist_brake", "", ""),
}


def read(path):
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def closure(folder):
    """Modes with causes; the worst rest, of the largest cause; the worst sum of pairs beside its contact, of the largest power."""
    causes, growth = defaultdict(list), {row["mode"]: float(row["growth_rad_s"]) for row in read(folder / "modes.csv")}
    rounded = {row["mode"]: sys.float_info.epsilon * 2 * math.pi * float(row["freq_hz"]) for row in read(folder / "modes.csv")}
    powers, pairs = {}, defaultdict(float)
    for row in read(folder / "modes_causes.csv"):
        causes[row["mode"]].append((row["kind"], float(row["growth_rad_s"])))
        powers[row["mode"], row["cause"], row["kind"]] = float(row["power_w"])
    worst = 0
    for mode, shares in causes.items():
        largest = max(rounded[mode], *(abs(share) for _, share in shares))
        rest = sum(abs(share) for kind, share in shares if kind == "rest")
        off = abs(sum(share for _, share in shares) - growth[mode])
        worst = max(worst, max(rest, off) / largest if largest else 0)
    largest = defaultdict(float)
    for row in read(folder / "modes_feed_in.csv"):
        for kind, column in KINDS.items():
            pairs[row["mode"], row["contact"], kind] += float(row[column])
            largest[row["mode"]] += abs(float(row[column]))
    parts = max((abs(value - powers.get(key, 0)) / largest[key[0]] for key, value in pairs.items() if largest[key[0]]), default=0)
    return len(causes), worst, parts


def meshed(files, full, folder):
    """Words that give the mesh of a scene that has one."""
    if files not in MESHES:
        return []
    mesh = folder / f"{files}.msh"
    make_mesh(files, mesh, **({} if full else MESHES[files]))
    return ["-model_mesh", mesh]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--full", action="store_true", help="none is made coarse")
    args, failed, total = parser.parse_args(), 0, [0, 0, 0]
    with tempfile.TemporaryDirectory() as made:
        for i, (name, (files, words, coarse)) in enumerate(SCENES.items()):
            folder = Path(made) / str(i)
            command = [args.program, *scene(*files.split()), *meshed(files, args.full, Path(made)), *words.split(),
                       *([] if args.full else coarse.split()), "-output_fields", 0, "-output_dir", folder]
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
            n, worst, pairs = closure(folder) if not done.returncode else (0, 0, 0)
            good = n > 0 and worst <= CLOSED and pairs <= CLOSED
            failed += not good
            total = [total[0] + n, max(total[1], worst), max(total[2], pairs)]
            print(f"{'ok    ' if good else 'FAILED'} {name}: {n} modes, {worst:.1e} of the largest cause, pairs {pairs:.1e} "
                  f"{done.stderr.strip()[-200:] if done.returncode else ''}", flush=True)
    print(f"{total[0]} modes of {len(SCENES)} scenes: {total[1]:.1e} of the largest cause at most, pairs {total[2]:.1e}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
