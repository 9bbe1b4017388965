#!/usr/bin/env python3
"""Friction of tests/cases/friction_table.toml beside mu(s, p) = (0.5 - s)(1 - p / 20 kPa):

    verify/friction_table.py static FOLDER                       mu N = 15 N of the cube's sliding state, to 1e-9
    verify/friction_table.py time FOLDER --tolerance NUMBER      of the block with one node of 0.0025 m^2 in contact, in each row of
                                                                 transient.csv, of the largest friction force"""

import argparse
import csv
from pathlib import Path

AREA, SPEED, STATIC = 0.0025, 0.1, 1e-9


def friction(normal, speed):
    return (0.5 - speed) * (1 - normal / AREA / 20e3) * normal


def rows(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def static(folder):
    """Largest relative difference of the pairs' friction."""
    pairs = [(float(row["lambda_n_n"]), float(row["lambda_t_n"])) for row in rows(folder / "static.csv")]
    total = sum(normal for normal, _ in pairs), sum(tangential for _, tangential in pairs)
    print(f"{len(pairs)} pairs, {total[0]:.12g} N, friction {total[1]:.12g} N, must be 15")
    return abs(total[1] / 15 - 1) if len(pairs) == 4 else 1


def in_time(folder):
    """The same in time, at the speed of the node."""
    found = [(float(row["normal_force_n"]), float(row["friction_force_n"]), float(row["tip_vy_m_s"]))
             for row in rows(folder / "transient.csv")]
    largest = max(force for _, force, _ in found)
    off = max(abs(force - friction(normal, SPEED + velocity)) for normal, force, velocity in found) / largest
    print(f"{len(found)} rows, friction to {largest:.4g} N, off by {off:.2e} of it")
    return off if len(found) > 1000 and largest > 5 else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["static", "time"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tolerance", type=float, default=STATIC)
    args = parser.parse_args()
    raise SystemExit(not (static if args.what == "static" else in_time)(args.folder) <= args.tolerance)


if __name__ == "__main__":
    main()
