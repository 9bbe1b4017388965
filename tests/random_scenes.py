#!/usr/bin/env python3
"""Random scenes of a small brake, each computed in several ways that share as little as may be; what they answer must agree:

  modes    one rank beside two; factors of the symmetric part beside LU; projection beside PEP; one shift beside two
  sweep    a reduced basis beside a full solution at each point; where only that is offered, on one rank beside two
  static   the dense system of the pairs beside GMRES; one rank beside two
  frf      superposition of modes beside the whole system at each frequency

    random_scenes.py build/squeal scripts/mpirun --first 40 --count 40

A scene has friction or none, both laws of contact, pairs that stick (_kt), friction damping, Rayleigh damping, loss factors, bushings,
dashpots, points with mass, a disc that spins, orthotropic linings, weight, modes about all pairs or about the sliding state. What one
way refuses in words the other must refuse too, or be known not to offer. --keep DIR keeps the folders of scenes that disagree. Exit
status: 0, 1 where two ways disagree."""

import argparse
import csv
import math
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MASSI = Path(__file__).resolve().parents[1] / "options/massi2005.yaml"
LIMIT = 240  # s of a run
SAME = 1e-8  # relative difference of eigenvalues of one problem, or twice what both state
SLOW = 1  # rad/s
SWEEP = 2e-6  # of a sweep to 1e-6
FORCE = 1e-6  # of the largest force of a pair
RESPONSE = 1e-6, 1e-7  # relative, and beside the largest displacement
NOT_OFFERED = "-modes_shifts 2 is not offered with damping", "give -sweep_method full", "or -sweep_method full"
SWEPT = {"contact_mu": "0.1:0.8:4", "pad_young": "1e10:6e10:4", "disc_density": "7000:8000:4", "rows_stiffness": "4e6:1.2e7:4",
         "contact_kn": "1e7:1e9:4:log", "press_force": "50:200:4"}
ONLY_MODES = {"modes_contact", "modes_band", "static_geometric", "contact_kt", "contact_friction_damping", "contact_speed",
              "contact_mu_slope", "contact_force", "operators_mass", "disc_spin", "disc_spin_axis", "disc_spin_centre",
              "model_loss_frequency", "pad_loss_factor", "disc_alpha", "disc_beta", "pad_alpha", "pad_beta", "beam_alpha", "beam_beta"}


class Scene:
    """Options by name, without values where they are flags, and bodies in YAML, drawn from a seed."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.options, self.text = {}, ""
        self.mu = self.draw.choice((0, 0.2, 0.5, 0.9))
        self.static = self.happens(0.35)
        self.rig()
        self.contact()
        self.damping()
        self.bodies()
        low = self.draw.choice((0, 0, 500, 1500))
        self.band = low, self.draw.choice((3000, 6000, 10000))
        self.options |= {"modes_band": f"{self.band[0]},{self.band[1]}"}
        if self.static:
            self.options |= {"modes_contact": "static"} | ({"static_geometric": None} if self.happens(0.3) else {})
            self.options |= {"model_gravity": "0,0,-9.81"} if self.happens(0.3) else {}

    def happens(self, share):
        return self.draw.random() < share

    def power(self, low, high):
        """A number between two powers of ten."""
        return f"{10 ** self.draw.uniform(low, high):.6g}"

    def rig(self):
        pad, disc = self.draw.choice((2, 3, 4)), (self.draw.choice((7, 8, 9)), self.draw.choice((20, 24, 28)))
        self.text += (f'rig: {{disc: {{elements: "{disc[0]},{disc[1]},{self.draw.choice((1, 1, 2))}"}}, '
                      f'pad: {{elements: "{pad},{pad},{self.draw.choice((1, 2))}"}}, beam: {{elements: {self.draw.choice((5, 8))}}}}}\n')

    def contact(self):
        exact, slip = self.happens(0.25), self.draw.choice(("0,1,0", "0,1,0", "1,0,0", "0,-1,0", "1,1,0"))
        self.options |= {"contact_mu": self.mu, "contact_slip": slip}
        self.options |= {"contact_law": "constraint"} if exact else {"contact_kn": self.power(5, 11)}
        if self.static and self.mu and self.happens(0.25):
            self.options |= {"contact_slip": "0,0,0", "contact_kt": self.power(5, 9)}

    def damping(self):
        self.damped = self.happens(0.5)
        if not self.damped:
            return
        for part in ("disc", "pad", "beam"):
            self.options |= {f"{part}_alpha": self.power(-1, 2)} if self.happens(0.6) else {}
            self.options |= {f"{part}_beta": self.power(-9, -6)} if self.happens(0.6) else {}
        if self.happens(0.3):
            self.options |= {"pad_loss_factor": 0.05, "model_loss_frequency": 3000}
        if self.mu and "contact_kt" not in self.options and self.happens(0.4):
            self.options |= {"contact_friction_damping": None, "contact_speed": f"{self.draw.uniform(0.05, 5):.4g}"}
            self.options |= {} if self.static else {"contact_force": 100}
            self.options |= {"contact_mu_slope": f"{self.draw.uniform(-0.02, 0.02):.4g}"} if self.happens(0.5) else {}

    def bodies(self):
        if self.happens(0.3):
            ways = ",".join(self.power(4, 8) for _ in range(3))
            viscous = ', viscosity: "5,5,5"' if self.damped else ""
            self.text += f'joints: bush\nbush: {{a: beam_top, stiffness: "{ways}", turn_stiffness: "{self.power(0, 4)},0,10"{viscous}}}\n'
        if self.happens(0.3):
            join = self.draw.choice(("", ", join: rigid"))
            self.text += f'points: tip\ntip: {{set: beam_top, mass: {self.power(-3, 1)}, inertia: "1e-4,1e-4,2e-4"{join}}}\n'
        if self.happens(0.25):
            self.text += f'dashpots: dash\ndash: {{set: beam_rows, viscosity: "{self.power(-2, 1)},0,1"}}\n'
        if self.happens(0.25):
            self.options |= {"disc_spin": f"{self.draw.uniform(-300, 300):.5g}", "disc_spin_axis": "0,0,1", "disc_spin_centre": "0,0,0"}
        if self.happens(0.25):
            self.options |= {"pad_young": f"{self.power(9.7, 10.5)},{self.power(9, 9.9)}", "pad_poisson": "0.2,0.3", "pad_shear": "2e9",
                             "pad_axis_3": "0,0,1"}
        self.options |= {"model_element": "full"} if self.happens(0.2) else {}
        self.options |= {"operators_mass": "lumped"} if self.happens(0.2) else {}

    def swept(self):
        """A parameter that the scene has."""
        names = ["pad_young", "disc_density", "rows_stiffness"]
        names += ["contact_mu"] if self.mu else []
        names += ["contact_kn"] if "contact_kn" in self.options else []
        names += ["press_force"] if self.static else []
        return self.draw.choice(names)

    def words(self, without=()):
        chosen = {name: value for name, value in self.options.items() if name not in without}
        return [word for name, value in chosen.items() for word in (f"-{name}", *([] if value is None else [str(value)]))]


class Ways:
    """Runs of one scene in a folder of its own, and what was found to disagree."""

    def __init__(self, arguments, seed, folder):
        self.arguments, self.folder, self.scene = arguments, folder, Scene(seed)
        self.found, self.n = [], 0
        (folder / "scene.yaml").write_text(self.scene.text)

    def run(self, *more, ranks=1, without=()):
        """Output folder, or the error in words, and with it a complaint where it is none of squeal's."""
        self.n += 1
        out = self.folder / f"out{self.n}"
        start = [self.arguments.squeal] if ranks == 1 else [self.arguments.launcher, "-n", str(ranks), self.arguments.squeal]
        command = [*start, "-options_file", MASSI, "-options_file", "scene.yaml", *self.scene.words(without), *map(str, more),
                   "-output_dir", out, "-output_fields", "0"]
        try:
            done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=LIMIT, check=False)
        except subprocess.TimeoutExpired:
            self.found.append(f"{' '.join(map(str, more))}: no end in {LIMIT} s")
            return None, "no end"
        errors = [line for line in done.stderr.splitlines() if line.startswith("squeal: error: ")]
        if done.returncode and (done.returncode < 0 or len(errors) != 1):
            self.found.append(f"{' '.join(map(str, more))}: status {done.returncode}, {done.stderr[-300:]}")
        return (None, errors[0] if errors else "no message") if done.returncode else (out, "")

    def beside(self, name, one, other, compare):
        """Complains of two runs, one of which failed alone, or whose tables differ."""
        (a, why), (b, why_not) = one, other
        if a and b:
            self.found += [f"{name}: {difference}" for difference in compare(a, b) if difference]
        elif why.split(":")[-1] != why_not.split(":")[-1] and not any(word in why + why_not for word in NOT_OFFERED):
            self.found.append(f"{name}: '{why}' beside '{why_not}'")

    def modes(self):
        first = self.run("-analysis", "modes")
        friction = self.scene.mu and "contact_law" not in self.scene.options and "contact_kt" not in self.scene.options
        others = {"two ranks": {"ranks": 2}, **({"lu": {"more": ("-operators_factors", "lu")}} if friction else {})}
        others["two shifts"] = {"more": ("-modes_shifts", "2")}
        if any(word in " ".join(self.scene.words()) for word in ("alpha", "beta", "loss")):
            others["pep"] = {"more": ("-modes_damping", "pep")}
        for name, way in others.items():
            other = self.run("-analysis", "modes", *way.get("more", ()), ranks=way.get("ranks", 1))
            self.beside(name, first, other, lambda a, b: [differ(eigenvalues(a / "modes.csv"), eigenvalues(b / "modes.csv"), SAME)])
            if not first[0]:
                break  # two ranks have judged whether there are modes
        return first[0] is not None

    def sweep(self):
        name = self.scene.swept()
        words = "-analysis", "sweep", "-sweep_parameter", name, "-sweep_values", SWEPT[name]

        def compare(a, b):
            for point in "1234":
                both = (eigenvalues(folder / "sweep.csv", point=point) for folder in (a, b))
                yield differ(*both, SWEEP)

        one, full = self.run(*words), self.run(*words, "-sweep_method", "full")
        if not one[0] and "give -sweep_method full" in one[1]:
            one = self.run(*words, "-sweep_method", "full", ranks=2)
        self.beside(f"sweep over {name}", one, full, compare)

    def statics(self):
        first = self.run("-analysis", "static", without=ONLY_MODES)
        for name, more, ranks in (("GMRES", ("-static_dense", "1"), 1), ("statics on two ranks", (), 2)):
            self.beside(name, first, self.run("-analysis", "static", *more, ranks=ranks, without=ONLY_MODES), forces)

    def response(self):
        frequencies = ",".join(f"{self.scene.draw.uniform(self.scene.band[0] + 50, self.scene.band[1]):.6g}" for _ in range(3))
        words = ("-analysis", "frf", "-probes", "top", "-top_at", "0.11,0,0.1", "-frf_force", "top,y", "-frf_frequencies", frequencies)
        self.beside("frf", self.run(*words), self.run(*words, "-frf_method", "direct"), responses)


def rows(path, **where):
    with path.open(newline="") as file:
        return [row for row in csv.DictReader(file) if all(row[name] == value for name, value in where.items())]


def eigenvalues(path, **where):
    """lambda, rad/s, and the error that is stated, of each mode that moves; a motion that is only damped is one zero beside a slow
    decay, which rounding may hide."""
    found = [(complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])), 2 * math.pi * float(row["error_hz"] or 0))
             for row in rows(path, **where)]
    return [(value, error) for value, error in found if abs(value) > SLOW]


def differ(one, other, rtol):
    """The largest difference in words, or none."""
    if len(one) != len(other):
        return f"{len(one)} and {len(other)} modes"
    free, worst = list(other), (1, "")
    for value, error in one:
        near = min(free, key=lambda mode: abs(mode[0] - value))
        free.remove(near)
        stated = error + near[1]
        allowed = max(rtol * abs(value), 2 * stated if math.isfinite(stated) else 0, sys.float_info.min)
        worst = max(worst, (abs(near[0] - value) / allowed, f"{value:.9g} and {near[0]:.9g}"))
    return f"{worst[1]}, {worst[0]:.3g} times what is allowed" if worst[1] else ""


def forces(a, b):
    """Forces of the pairs, which ranks may list in another order."""
    one, other = ({(f"{float(row['x_m']):.9f}", f"{float(row['y_m']):.9f}"): row for row in rows(folder / "static.csv")}
                  for folder in (a, b))
    if set(one) != set(other):
        yield "other pairs"
        return
    largest = max(abs(float(row["lambda_n_n"])) for row in one.values())
    for column in ("lambda_n_n", "lambda_t_n", "lambda_b_n"):
        difference = max(abs(float(one[place][column]) - float(other[place][column])) for place in one)
        if difference > FORCE * largest:
            yield f"{column} differs by {difference:.3g} N of {largest:.3g} N"


def responses(a, b):
    one, other = rows(a / "frf.csv"), rows(b / "frf.csv")
    columns = [name for name in one[0] if "_re_" in name or "_im_" in name]
    largest = max(abs(float(row[name])) for row in other for name in columns)
    for p, q in zip(one, other, strict=True):
        for name in columns:
            u, v = float(p[name]), float(q[name])
            if abs(u - v) > RESPONSE[0] * max(abs(u), abs(v)) + RESPONSE[1] * largest:
                yield f"{name} {u:.6g} and {v:.6g}"


def judge(arguments, seed):
    """What disagrees in one scene."""
    with tempfile.TemporaryDirectory(prefix="squeal-random-") as name:
        ways = Ways(arguments, seed, Path(name))
        solved = ways.modes()
        if solved:
            ways.sweep()
            ways.response()
        if ways.scene.static:
            ways.statics()
        if ways.found and arguments.keep:
            shutil.copytree(name, arguments.keep / str(seed), dirs_exist_ok=True)
    print(f"{seed}: {'; '.join(ways.found) or ('agree' if solved else 'no modes')}", flush=True)
    return ways.found, solved


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=Path)
    parser.add_argument("launcher", type=Path)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    arguments.squeal, arguments.launcher = arguments.squeal.resolve(), arguments.launcher.resolve()
    judged = [judge(arguments, seed) for seed in range(arguments.first, arguments.first + arguments.count)]
    failed, solved = sum(bool(found) for found, _ in judged), sum(solved for _, solved in judged)
    print(f"{len(judged)} scenes, {solved} with modes, {failed} disagree")
    if solved < len(judged) / 2:
        print("too few scenes have modes")
    return 1 if failed or solved < len(judged) / 2 else 0


if __name__ == "__main__":
    sys.exit(main())
