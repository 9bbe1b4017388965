#!/usr/bin/env python3
"""Whether a contact carries a uniform pressure: uniform.py FOLDER PRESSURE [--rtol 1e-9] [--force-only] [--nodes 2]

static.csv has the pressure at all pairs, and the normal forces add up to it times the area of the slaves; static.h5 has it
on both surfaces. --force-only leaves the pressures out. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path

import h5py
import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("pressure", type=float)
    parser.add_argument("--rtol", type=float, default=1e-9)
    parser.add_argument("--force-only", action="store_true")
    parser.add_argument("--nodes", type=float, default=2, help="so many times the pairs carry pressure, at least: both sides of each")
    args = parser.parse_args()
    with (args.folder / "static.csv").open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    area, force = (sum(float(row[c]) for row in rows) for c in ("area_m2", "lambda_n_n"))
    pairs = np.array([float(row["pressure_pa"]) for row in rows])
    fields = []
    with h5py.File(args.folder / "static.h5") as file:
        file.visititems(lambda name, item: fields.append(np.ravel(item)) if name.endswith("contact_pressure_pa") else None)
    nodes = fields[0][fields[0] != 0]
    off = [abs(force / (args.pressure * area) - 1), *(abs(p / args.pressure - 1).max() for p in (pairs, nodes))]
    print(f"{len(pairs)} pairs, {len(nodes)} nodes: force off by {off[0]:.1e}, pressure of pairs {off[1]:.1e}, of nodes {off[2]:.1e}")
    good = len(nodes) >= args.nodes * len(pairs) or args.force_only
    return 0 if good and max(off[:1] if args.force_only else off) < args.rtol else 1


if __name__ == "__main__":
    sys.exit(main())
