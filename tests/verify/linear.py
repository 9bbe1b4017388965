#!/usr/bin/env python3
"""Whether a sliding state is one of uniform stress along z: linear.py FOLDER SHORTENING POISSON DEPTH [--rtol 1e-10]

Displacements of static.h5 are (POISSON x, POISSON y, -(z + DEPTH)) SHORTENING at all nodes, to rtol of the largest. Exit status: 0, or 1.
"""

import argparse
import sys
from pathlib import Path

import h5py
import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    for name in ("shortening", "poisson", "depth"):
        parser.add_argument(name, type=float)
    parser.add_argument("--rtol", type=float, default=1e-10)
    args = parser.parse_args()
    fields = []
    with h5py.File(args.folder / "static.h5") as file:
        x = file["VTKHDF/Points"][:]
        file.visititems(lambda name, item: fields.append(item[:]) if name.endswith("displacement_m") else None)
    true = args.shortening * np.array([args.poisson, args.poisson, -1]) * (x + [0, 0, args.depth])
    off = abs(fields[0].reshape(-1, 3) - true).max() / abs(true).max()
    print(f"{len(x)} nodes: displacement off by {off:.1e}")
    return 0 if off < args.rtol and abs(true).max() > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
