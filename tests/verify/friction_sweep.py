#!/usr/bin/env python3
"""Growth of the block of tests/cases/friction_law.toml over parameters of its friction law, and its derivatives, against

    growth = -mu'(v) N / (2 m),  -mu'(v) = (mu_s - mu_k) exp(-v / s_0) / s_0
    with --stribeck              -mu'(v) = 2 (mu_s - mu_k) exp(-(v / s_0)^2) v / s_0^2 - b

    verify/friction_sweep.py FOLDER PARAMETER [PARAMETER_2] --count NUMBERS [--stribeck] [--tolerance 1e-4]

FOLDER is that of a sweep or a map; a sweep with sensitivities.csv has these looked at too. The block is rigid to 1e-4."""

import argparse
import csv
import math
from pathlib import Path

M, N = 1.0, 50.0
SCENE = {"contact_mu_static": 0.5, "contact_mu_kinetic": 0.3, "contact_mu_decay_speed": 0.05, "contact_speed": 0.1}
STRIBECK = {"contact_mu_static": 0.32, "contact_mu_kinetic": 0.3, "contact_mu_stribeck_speed": 0.05, "contact_mu_viscous": 0.05,
            "contact_speed": 0.03}
STEP = 1e-5  # relative, of central differences of the closed form
BAND = 21.1, 21.5  # Hz, where the block moves along the slip


def growth(values):
    if "contact_mu_viscous" in values:
        static, kinetic, scale, viscous, speed = (values[name] for name in STRIBECK)
        return (2 * (static - kinetic) * math.exp(-(speed / scale)**2) * speed / scale**2 - viscous) * N / (2 * M)
    static, kinetic, decay, speed = (values[name] for name in SCENE)
    return (static - kinetic) * math.exp(-speed / decay) * N / (2 * M * decay)


def derivative(values, name):
    less, more = ({**values, name: values[name] * (1 + side * STEP)} for side in (-1, 1))
    return (growth(more) - growth(less)) / (2 * STEP * values[name])


def read(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def values_of(row, scene, names):
    given = [float(row["value"])] + ([float(row["value_2"])] if len(names) > 1 else [])
    return {**scene, **dict(zip(names, given))}


def compared(folder, scene, names):
    """Pairs of numbers: found, expected."""
    if (folder / "map.csv").exists():
        return [(float(row["growth_rad_s"]), growth(values_of(row, scene, names))) for row in read(folder / "map.csv")]
    rows = {row["point"]: row for row in read(folder / "sweep.csv") if BAND[0] < float(row["freq_hz"]) < BAND[1]}
    found = [(float(row["growth_rad_s"]), growth(values_of(row, scene, names))) for row in rows.values()]
    if (folder / "sensitivities.csv").exists():
        found += [(float(row["growth_rad_s_per_unit"]), derivative(values_of(rows[row["point"]], scene, names), row["parameter"]))
                  for row in read(folder / "sensitivities.csv")
                  if row["branch"] == rows[row["point"]]["branch"] and row["parameter"] in scene]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="+")
    parser.add_argument("--count", type=int, required=True)
    parser.add_argument("--stribeck", action="store_true")
    parser.add_argument("--tolerance", type=float, default=1e-4)
    args = parser.parse_args()
    found = compared(args.folder, STRIBECK if args.stribeck else SCENE, args.names)
    off = max((abs(a - b) / abs(b) for a, b in found), default=math.inf)
    print(f"{len(found)} numbers, off by {off:.2e}")
    if len(found) != args.count or not off <= args.tolerance:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
