#!/usr/bin/env python3
"""Random brakes of up to ten boxes: pads on a disc that slides, presses and a shim that hold by friction, stops behind gaps before and
behind each pad. Each has an equilibrium that obeys the laws, or a proof that there is none; or the run says that the bodies jam, which
nothing here proves: these are counted.

    random_brakes.py build/squeal --first 1 --count 200 --solved 100
    random_brakes.py build/squeal --seeds 73 146 154

The laws are checked here from static.csv: sign, gap and complementarity of each pair, or k_n area max(0, -gap) where it has a stiffness;
the cone of friction and its direction along the slip, friction of what slides. So is the balance of each body: forces of its pairs from
static.csv, of its supports, loads and springs from reactions.csv. Prints a line a brake: seed, bodies, what was found, largest error.
--keep DIR keeps the folders of what fails. Exit status:
0; 1 where another one fails, or fewer than --solved have an equilibrium."""

import argparse
import csv
import random
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict, namedtuple
from pathlib import Path

import numpy as np

BOXES = Path(__file__).resolve().parent / "boxes.py"
KKT = 1e-9  # of the largest force, of the largest gap or slip
NONE = "no equilibrium: ", "no sliding equilibrium: "  # proven
JAMS = "the bodies jam"
LIMIT = 300  # s of a run


Contact = namedtuple("Contact", "mu slides kn slave master text")  # kn in N/m^3, None where exact


def body(name):
    """The body of a set of faces."""
    return name.split("_")[0]


class Brake:
    """Boxes, and the scene in YAML, drawn from a seed."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.boxes, self.text = [], {"ground": []}
        self.parts, self.contacts, self.loads, self.springs, self.held = [], {}, [], [], {}
        self.exact = self.draw.random() < 0.3
        self.mu, self.slip = self.draw.choice((0, 0.1, 0.3, 0.45, 0.7)), self.draw.choice((-1, 1))
        n_pads = self.draw.choice((1, 2, 2))
        self.box("disc", (0, 0, 0), (0.08 * n_pads, 0.12, 0.02), (3 * n_pads, 5, 1), 1e11)
        self.held["disc_bottom"] = "xyz"
        for i in range(n_pads):
            self.pad(i, 0.08 * i)

    def box(self, name, low, high, cells, young):
        places = ":".join(",".join(f"{v:.9g}" for v in p) for p in (low, high))
        self.boxes.append(f"{name}:hex8:{places}:{','.join(map(str, cells))}")
        self.parts.append(f"{name}: {{young: {young:g}, poisson: 0.3, density: 3000}}")

    def contact(self, name, slave, master, mu, slip=None):
        kn = None if self.exact else f"{10 ** self.draw.uniform(10, 13):.3g}"
        stiff = f"kn_per_area: {kn}" if kn else "law: constraint"
        along = f', slip: "0,{slip},0"' if slip else ""
        text = f'{{surfaces: "{slave},{master}", tolerance: 3e-4, {stiff}, mu: {mu}{along}}}'
        self.contacts["c_" + name] = Contact(mu, bool(slip), kn and float(kn), body(slave), body(master), text)

    def pad(self, i, x):
        """A pad with its press, a shim on the first one, and stops behind gaps."""
        draw, cells = self.draw, self.draw.choice((2, 3, 4))
        low, high = (x + 0.01, 0.03, 0.02), (x + 0.07, 0.09, 0.035)
        self.box(f"pad{i}", low, high, (cells, cells, draw.choice((1, 2))), 10 ** draw.uniform(9, 11.3))
        self.contact(f"rub{i}", f"pad{i}_bottom", "disc_top", self.mu, self.slip)
        below, z, edge = f"pad{i}", 0.035, 0
        if i == 0 and draw.random() < 0.5:
            self.box("shim", (low[0] - 0.001, 0.029, z), (high[0] + 0.001, 0.091, z + 0.002), (cells, cells, 1), 5e9)
            self.contact("shim", f"{below}_top", "shim_bottom", draw.choice((0.05, 0.15, 0.4)))
            below, z, edge = "shim", z + 0.002, 0.001
        self.box(f"press{i}", (low[0] - 0.002, 0.028, z), (high[0] + 0.002, 0.092, z + 0.015), (2, draw.choice((2, 3)), 1), 2e11)
        self.contact(f"back{i}", f"{below}_top", f"press{i}_bottom", draw.choice((0.05, 0.15, 0.4)))
        self.held[f"press{i}_top"] = "xy"
        self.loads.append(f"press{i}_top")
        for side, face, at in (("front", "back", -1), ("back", "front", 1)):
            if draw.random() < 0.15:
                continue
            gap, stop = draw.choice((0, 2e-5, 1e-4)), f"{'lead' if at < 0 else 'trail'}{i}"
            y = (0.03 - gap - 0.012, 0.03 - gap) if at < 0 else (0.09 + gap, 0.09 + gap + 0.012)
            self.box(stop, (low[0] - 0.002, y[0], 0.019), (high[0] + 0.002, y[1], 0.036), (2, 1, 2), 2e11)
            self.held[f"{stop}_{side}"] = "xyz"
            self.contact(f"{stop}", f"pad{i}_{side}", f"{stop}_{face}", draw.choice((0.05, 0.15, 0.4)))
        if draw.random() < 0.6:
            self.springs.append((f"pad{i}", 10 ** draw.uniform(3, 6)))

    def yaml(self):
        force = 10 ** self.draw.uniform(1, 4)
        names = [part.split(":")[0] for part in self.parts]
        lines = ["analysis: static", "static_view_kkt: 1", "output_fields: 0", "model: {mesh: brake.msh}", f"parts: {','.join(names)}"]
        lines += self.parts + [f"contacts: {','.join(self.contacts)}"]
        lines += [f"{name}: {contact.text}" for name, contact in self.contacts.items()]
        lines += [f"supports: {','.join('on_' + name for name in self.held)}"]
        lines += [f"on_{name}: {{set: {name}, fix: {fix}}}" for name, fix in self.held.items()]
        lines += [f"loads: {','.join('at_' + name for name in self.loads)}"]
        lines += [f'at_{name}: {{set: {name}, force: "0,0,{-force:g}"}}' for name in self.loads]
        if self.springs:
            lines += [f"springs: {','.join('of_' + name for name, _ in self.springs)}"]
            lines += [f'of_{name}: {{set: {name}, stiffness_total: "{k:g},{k:g},0"}}' for name, k in self.springs]
        return "\n".join(lines) + "\n"


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def miss(row, contact):
    """What one pair misses of each law: of forces (N), and of places (m)."""
    gap, normal, t, b, slip_t, slip_b, area = (float(row[k]) for k in (
        "gap_m", "lambda_n_n", "lambda_t_n", "lambda_b_n", "slip_t_m", "slip_b_m", "area_m2"))
    mu, force, place = contact.mu, [max(0, -normal)], [0]
    if contact.kn is None:
        place += [max(0, -gap), gap if normal > 0 else 0]
    else:
        force += [abs(normal - contact.kn * area * max(0, -gap))]
    if contact.slides:
        return max(force + [abs(t - mu * normal), abs(b)]), max(place)
    force += [max(0, np.hypot(t, b) - mu * normal)]
    slip, friction = np.array([slip_t, slip_b]), np.array([t, b])
    if row["status"] == "stick":
        place += [np.hypot(*slip)]
    if row["status"] == "slip" and np.hypot(*slip) > 1e-13:
        force += [np.hypot(*(friction - mu * normal * slip / np.hypot(*slip)))]
    return max(force), max(place)


def unbalance(brake, pairs, reactions):
    """Largest sum of the forces on a body, N; friction on the master is along t and b = n x t, and n points to the slave."""
    total = defaultdict(lambda: np.zeros(3))
    for row in pairs:
        n, t = (np.array([float(row[f"{v}_{c}"]) for c in "xyz"]) for v in "nt")
        force = (np.array((n, t, np.cross(n, t))).T * (-1, 1, 1)) @ [float(row[f"lambda_{c}_n"]) for c in "ntb"]
        total[brake.contacts[row["interface"]].master] += force
        total[brake.contacts[row["interface"]].slave] -= force
    for row in reactions:
        if row["kind"] in ("support", "load", "spring"):
            total[body(row["name"].split("_", 1)[1])] += [float(row[f"force_{c}_n"]) for c in "xyz"]
    return max(abs(force).max() for force in total.values())


def judge(brake, folder):
    """Largest error of the laws beside the largest force and the largest gap or slip."""
    rows = read(folder / "static.csv")
    most = max(float(row["lambda_n_n"]) for row in rows)
    far = max(max(abs(float(row[k])) for k in ("gap_m", "slip_t_m", "slip_b_m")) for row in rows)
    error = [miss(row, brake.contacts[row["interface"]]) for row in rows]
    force = max(unbalance(brake, rows, read(folder / "reactions.csv")), *(force for force, _ in error))
    return max(force / most, max(place for _, place in error) / max(far, 1e-7))


def run(seed, squeal, folder):
    """A line about a brake, and how it ends."""
    brake = Brake(seed)
    subprocess.run([sys.executable, BOXES, folder / "brake.msh", *brake.boxes], check=True)
    (folder / "brake.yaml").write_text(brake.yaml())
    done = subprocess.run([squeal, "-options_file", "brake.yaml", "-output_dir", "."], cwd=folder, capture_output=True,
                          text=True, timeout=LIMIT)
    said = next((line for line in done.stderr.splitlines() if line.startswith("squeal: error: ")), "")
    about = f"{seed} {len(brake.parts)} bodies: "
    if done.returncode == 0:
        error = judge(brake, folder)
        return f"{about}equilibrium, laws to {error:.1e}", "solved" if error <= KKT else "FAILS"
    if any(text in said for text in NONE):
        return about + said[15:], "none"
    return about + said[15:], "jams" if JAMS in said else "FAILS"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=Path)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seeds", type=int, nargs="+", metavar="SEED", help="these, in the place of --first and --count")
    parser.add_argument("--solved", type=int, default=0, metavar="N", help="so many must have an equilibrium, at least")
    parser.add_argument("--keep", type=Path)
    args = parser.parse_args()
    found = {"solved": [], "none": [], "jams": [], "FAILS": []}
    seeds = args.seeds or range(args.first, args.first + args.count)
    for seed in seeds:
        with tempfile.TemporaryDirectory() as folder:
            line, ending = run(seed, args.squeal.resolve(), Path(folder))
            print(line, "  FAILS" if ending == "FAILS" else "", flush=True)
            found[ending].append(seed)
            if ending == "FAILS" and args.keep:
                shutil.copytree(folder, args.keep / str(seed), dirs_exist_ok=True)
    solved, none, jams, failed = found.values()
    print(f"{len(solved)} of {len(seeds)} have an equilibrium, at least {args.solved} must; {len(none)} provably none; {len(jams)} jam; "
          f"failed: {failed}")
    return 1 if failed or len(solved) < args.solved else 0


if __name__ == "__main__":
    sys.exit(main())
