#!/usr/bin/env python3
"""The sliding state of options/fist_brake.yaml beside what its mesh of first order and the contact laws demand.

    verify/fist_brake.py FOLDER MESH PRESSURE FRICTION
    verify/fist_brake.py FOLDER TRANSIENT

laws       of each pair: sign, k_n area max(0, -gap), Coulomb's cone, its direction along the slip (random_brakes.py)
bodies     the forces on each body sum to nothing: of its pairs from static.csv, of bolts, clips, pins and seal from reactions.csv,
           and the pressure (MPa) times the area of the piston's base, or of the bore's, as the triangles of the mesh have it
start      normal force of each contact in the first row of a transient that begins there, beside its pairs"""

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "scripts"), str(TOP / "tests")]
from convergence import Judge
from random_brakes import Contact, miss, read
from squeal.mesh.gmsh import read_mesh

LAWS, BALANCE = 1e-10, 1e-9  # of the largest force of a pair, of that of the piston
STIFF, HOLDS = 1e4, 0.15  # N/mm^3, mu: fist_brake.yaml
BODIES = {"inner": ("inner pad", "disc"), "outer": ("outer pad", "disc"), "piston_rim": ("piston", "inner pad"),
          "fingers": ("caliper", "outer pad"), "inner_trail": ("inner pad", "bracket"), "outer_trail": ("outer pad", "bracket"),
          "inner_lead": ("inner pad", "bracket"), "outer_lead": ("outer pad", "bracket")}  # slave, master
JOINED = {"trail_pin": ("caliper", "bracket"), "lead_pin": ("caliper", "bracket"), "seal": ("piston", "caliper")}
HELD = {"inner_clip": "inner pad", "outer_clip": "outer pad", "trail_bolt": "bracket", "lead_bolt": "bracket",
        **{f"bolt{i}": "disc" for i in range(5)}}
START = 1e-7  # of the largest normal force
DEPTH = -70  # mm: the piston's base lies above, the bore's below


def vector(row, names):
    return np.array([float(row[name]) for name in names])


def areas(path):
    """Of the piston's base and of the bore's, mm^2, by the triangles of the set `fluid`."""
    places, sets = read_mesh(path)
    triangles = next(cells for (name, _), cells in sets.items() if name == "fluid")
    a, b, c = (places[triangles[:, i]] for i in range(3))
    area, deep = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2, a[:, 2] < DEPTH
    return area[~deep].sum(), area[deep].sum()


def forces(folder, pairs):
    """Sum of all forces on each body but that of the fluid, N; friction on the master is along t and b = n x t, n points to the slave."""
    total = defaultdict(lambda: np.zeros(3))
    for row in pairs:
        n, t = (vector(row, (f"{v}_x", f"{v}_y", f"{v}_z")) for v in "nt")
        force = (np.array((n, t, np.cross(n, t))).T * (-1, 1, 1)) @ vector(row, ("lambda_n_n", "lambda_t_n", "lambda_b_n"))
        slave, master = BODIES[row["interface"]]
        total[master] += force
        total[slave] -= force
    for row in read(folder / "reactions.csv"):
        force = vector(row, ("force_x_n", "force_y_n", "force_z_n"))
        one, other = JOINED.get(row["name"], (HELD.get(row["name"]), None))
        total[one] += force if one else 0
        total[other] -= force if other else 0
    return total


def start(judge, pairs, transient):
    first, total = read(transient / "transient.csv")[0], defaultdict(float)
    for row in pairs:
        total[row["interface"]] += float(row["lambda_n_n"])
    off = max(abs(float(first[f"{name}_normal_force_n"]) - force) for name, force in total.items()) / max(total.values())
    print(f"normal forces of {len(total)} contacts at the start: {off:.1e} of the largest{judge.within(off, 0, START)}")


def main():
    folder, judge = Path(sys.argv[1]), Judge()
    pairs = read(folder / "static.csv")
    if len(sys.argv) == 3:
        start(judge, pairs, Path(sys.argv[2]))
        return 1 if judge.failed else 0
    pressure, friction = map(float, sys.argv[3:])
    most = max(float(row["lambda_n_n"]) for row in pairs)
    kinds = {name: Contact(friction if name in ("inner", "outer") else HOLDS, name in ("inner", "outer"), STIFF, *BODIES[name], "")
             for name in BODIES}
    error = np.max([miss(row, kinds[row["interface"]]) for row in pairs], axis=0)
    print(f"laws of {len(pairs)} pairs, of the largest force {most:.6g} N: {error[0] / most:.1e}{judge.within(error[0] / most, 0, LAWS)}")
    print(f"slip of pairs that stick {error[1]:.1e} mm{judge.within(error[1], 0, LAWS)}")
    area, total = areas(Path(sys.argv[2])), forces(folder, pairs)
    total["piston"][2] += pressure * area[0]
    total["caliper"][2] -= pressure * area[1]
    for body in ("piston", "caliper", "inner pad", "outer pad", "disc", "bracket"):
        left = abs(total[body]).max() / (pressure * area[0])
        print(f"{body:10s} left of all forces, of {pressure * area[0]:.6g} N: {left:.1e}{judge.within(left, 0, BALANCE)}")
    return 1 if judge.failed else 0


if __name__ == "__main__":
    sys.exit(main())
