#!/usr/bin/env python3
"""Errors of modes_changed.csv: masses, springs, dashpots and absorbers at random on a small brake, layers over sets and rings, and
percents of parameters, each beside scipy's eigenvalues of the changed matrices; those of a parameter are saved by a run with another
value of it. Breaks when a true error is larger than the stated one, or a mode is missing or too many.

    test_changes.py SQUEAL [--count 60] [--seed 1]"""

import argparse
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests/verify"))
from changes import SURFACES, Brake, matrices, surfaces, table  # noqa: E402
from test_cure import MU, SCENE  # noqa: E402

ROUNDING = 1e-10  # of an eigenvalue: what both leave
DOUBTFUL = 0.3  # of the stated error: from here on scipy's eigenvalue is made better
EDGE = 1e-3  # of the band
CORNERS = {"pad": ((0.105, 0.115), (-0.005, 0.005), (0, 0.005)), "beam": ((0.105, 0.115), (-0.005, 0.005), (0.05, 0.06, 0.11))}


# parameters that all matrices are linear in, and their option's value
PARAMETERS = {"disc_young": 210e9, "disc_density": 7800, "disc_beta": 1e-8, "pad_young": 25.1e9, "pad_density": 2500, "pad_alpha": 20,
              "beam_young": 2100e9, "beam_density": 78000, "contact_mu": MU, "contact_kn": 2.5895e8, "contact_force": 500,
              "rows_stiffness": "0,8.422e6,0", "hang_viscosity_total": "0,3,0"}


def doubled(value):
    """Twice a number, or a list of them."""
    return ",".join(f"{2 * float(word):.15g}" for word in str(value).split(","))


def slopes(squeal, folder, names, base):
    """What a percent of each parameter adds to K, C and M."""
    found = {}
    for name in names:
        subprocess.run([squeal, *base, f"-{name}", doubled(PARAMETERS[name]), "-output_dir", f"of_{name}",
                        "-operators_save", f"{name}_matrices", "-output_fields", "0"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        both = [matrices(folder / of, mu) for of, mu in ((f"{name}_matrices", 2 * MU if name == "contact_mu" else MU), ("matrices", MU))]
        found[name] = [(new - old) / 100 for new, old in zip(*both)]
    return found


def place(part, some):
    """A node of a part that moves."""
    if part != "disc":
        return [some.choice(axis) for axis in CORNERS[part]]
    radius, angle = some.uniform(0.08, 0.12), some.uniform(0, 2 * math.pi)
    return [radius * math.cos(angle), radius * math.sin(angle), 0]


def written(vector):
    return '"' + ",".join(f"{x:.6g}" for x in vector) + '"'


def layer(some, words):
    """One over a set or a ring."""
    inner = some.uniform(0.04, 0.12)
    outer = some.uniform(inner + 0.01, 0.14)
    words.append(f"set: {some.choice(list(SURFACES))}" if some.random() < 0.5 else f'ring: "{inner:.4g},{outer:.4g}"')
    if some.random() < 0.5:
        return words + [f"mass: {10**some.uniform(-3, -0.3):.4g}"]
    return words + [f"stiffness: {10**some.uniform(4, 9):.4g}", f"viscosity: {10**some.uniform(0, 3):.4g}",
                    f"direction: {written([some.uniform(-1, 1) for _ in range(3)])}"]


def parameter_in(entries, name):
    """Whether a change or one that it is made with moves a parameter."""
    text = entries[name]
    return "parameter:" in text or ("with: " in text and parameter_in(entries, text.split("with: ")[1].rstrip("}")))


def change(some, entries):
    """One change as an entry of an options file; small and large ones, some with another one, but a parameter not with another
    parameter, for what they add is no sum."""
    before = list(entries)[-3:]
    wide = some.random()
    if wide < 0.4:
        words = layer(some, []) if wide < 0.2 else [f"parameter: {some.choice(list(PARAMETERS))}", f"percent: {some.uniform(-20, 20):.4g}"]
        if wide >= 0.2:
            before = [name for name in before if not parameter_in(entries, name)]
        if before and some.random() < 0.5:
            words.append(f"with: {some.choice(before)}")
        return "{" + ", ".join(words) + "}"
    part, kind = some.choice(("disc", "pad", "beam")), some.choice(("mass", "spring", "dashpot", "both", "absorber"))
    words = [f"at: {written(place(part, some))}", f"part: {part}"]
    stiffness, viscosity, mass = 10**some.uniform(4, 9), 10**some.uniform(0, 3), 10**some.uniform(-3, -0.5)
    if kind == "absorber":
        omega = 2 * math.pi * some.uniform(500, 8000)
        mass, stiffness, viscosity = mass / 3, mass / 3 * omega**2, 0.1 * mass / 3 * omega
    words += [f"mass: {mass:.4g}"] * (kind in ("mass", "absorber"))
    words += [f"stiffness: {stiffness:.4g}"] * (kind in ("spring", "both", "absorber"))
    words += [f"viscosity: {viscosity:.4g}"] * (kind in ("dashpot", "both", "absorber"))
    if kind != "mass":
        words.append(f"direction: {written([some.uniform(-1, 1) for _ in range(3)])}")
    if kind not in ("mass", "absorber") and some.random() < 0.5:
        other = some.choice([name for name in ("disc", "pad", "beam") if name != part])
        words += [f"to: {written(place(other, some))}", f"to_part: {other}"]
    if before and some.random() < 0.3:
        words.append(f"with: {some.choice(before)}")
    return "{" + ", ".join(words) + "}"


def compare(brake, name, rows, band):
    """True errors over stated ones of one change, and what is wrong."""
    exact = brake.modes(name, [0.5, band[1] * (1 + EDGE)], 2 * len(rows) + 8)
    found = []
    for value, error, _ in rows:
        if not exact:
            return found, [f"{name}: modes too many"]
        other = min(exact, key=lambda one: abs(one - value))
        exact.remove(other)
        if abs(other - value) > DOUBTFUL * error:
            other = brake.refined(name, other)
        found.append((abs(other - value) / (error + ROUNDING * abs(value)), error / abs(value), name, value))
    growth = 0.1 * band[1]
    lost = [value for value in exact if band[0] < value.imag < band[1] * (1 - EDGE) and abs(value.real) < 0.99 * growth]
    return found, [f"{name}: {lost} are missing"] * bool(lost)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=Path)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    some, entries, found, faults = random.Random(args.seed), {}, [], []
    for i in range(args.count):
        entries[f"c{i}"] = change(some, entries)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SCENE)
        (folder / "changes.yaml").write_text(f'modes_changes: "{",".join(entries)}"\n' + "".join(f"{key}: {text}\n"
                                                                                               for key, text in entries.items()))
        base = ["-options_file", SOURCE / "options/massi2005.yaml", "-options_file", "small.yaml"]
        subprocess.run([args.squeal.resolve(), *base, "-options_file", "changes.yaml", "-output_dir", "out", "-operators_save", "matrices"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL)
        names = [name for name in PARAMETERS if any(f"parameter: {name}," in text for text in entries.values())]
        brake = Brake(folder / "out", folder / "matrices", MU, slopes=slopes(args.squeal.resolve(), folder, names, base))
        brake.sets = surfaces(brake)
        band = [2 * math.pi * float(edge) for edge in brake.scene.value("modes_band").split(",")]
        for key, rows in table(folder / "out").items():
            own, wrong = compare(brake, key, rows, band)
            found, faults = found + own, faults + wrong
    found.sort(key=lambda entry: -entry[0])
    for ratio, stated, key, value in found[:5]:
        print(f"{ratio:.2g} of the stated error, which is {stated:.1e} of {value:.6g}: {key} {entries[key]}")
    largest = max(entry[1] for entry in found)
    print(f"{len(found)} modes of {args.count} changes, the largest stated error is {largest:.1e} of an eigenvalue")
    print("\n".join(faults))
    return 1 if faults or not found or found[0][0] > 1 else 0


if __name__ == "__main__":
    sys.exit(main())
