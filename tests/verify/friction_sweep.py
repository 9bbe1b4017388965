#!/usr/bin/env python3
"""Growth of the block of tests/cases/friction_law.toml over parameters of its friction law, and its derivatives, against

    growth = -mu'(v) N / (2 m) = (mu_s - mu_k) exp(-v / s_0) N / (2 m s_0)

    verify/friction_sweep.py FOLDER PARAMETER [PARAMETER_2] --count NUMBERS [--tolerance 1e-4]

FOLDER is that of a sweep or a map; a sweep with sensitivities.csv has these looked at too. The block is rigid to 1e-4."""

import argparse
import csv
import math
from pathlib import Path

M, N = 1.0, 50.0
SCENE = {"contact_mu_static": 0.5, "contact_mu_kinetic": 0.3, "contact_mu_decay_speed": 0.05, "contact_speed": 0.1}
STEP = 1e-5  # relative, of central differences of the closed form
BAND = 21.1, 21.5  # Hz, where the block moves along the slip


def growth(values):
    static, kinetic, decay, speed = (values[name] for name in SCENE)
    return (static - kinetic) * math.exp(-speed / decay) * N / (2 * M * decay)


def derivative(values, name):
    less, more = ({**values, name: values[name] * (1 + side * STEP)} for side in (-1, 1))
    return (growth(more) - growth(less)) / (2 * STEP * values[name])


def read(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def values_of(row, names):
    given = [float(row["value"])] + ([float(row["value_2"])] if len(names) > 1 else [])
    return {**SCENE, **dict(zip(names, given))}


def compared(folder, names):
    """Pairs of numbers: found, expected."""
    if (folder / "map.csv").exists():
        return [(float(row["growth_rad_s"]), growth(values_of(row, names))) for row in read(folder / "map.csv")]
    rows = {row["point"]: row for row in read(folder / "sweep.csv") if BAND[0] < float(row["freq_hz"]) < BAND[1]}
    found = [(float(row["growth_rad_s"]), growth(values_of(row, names))) for row in rows.values()]
    if (folder / "sensitivities.csv").exists():
        found += [(float(row["growth_rad_s_per_unit"]), derivative(values_of(rows[row["point"]], names), row["parameter"]))
                  for row in read(folder / "sensitivities.csv")
                  if row["branch"] == rows[row["point"]]["branch"] and row["parameter"] in SCENE]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="+")
    parser.add_argument("--count", type=int, required=True)
    parser.add_argument("--tolerance", type=float, default=1e-4)
    args = parser.parse_args()
    found = compared(args.folder, args.names)
    off = max((abs(a - b) / abs(b) for a, b in found), default=math.inf)
    print(f"{len(found)} numbers, off by {off:.2e}")
    if len(found) != args.count or not off <= args.tolerance:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
