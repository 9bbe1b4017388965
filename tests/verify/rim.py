#!/usr/bin/env python3
"""Checks the labels (n,m) of a disc's modes by their shapes alone: m is the strongest harmonic of w around the rim, n
the number of sign changes of that harmonic's profile over the radius, w read from modes.h5 at the nodes of the face
z = 0 whose radii are at least R, m. And the participation of the parts, which sums to 100 per cent.

    rim.py FOLDER R"""

import csv
import re
import sys
from pathlib import Path

import h5py
import numpy as np


def rings(points, least):
    """Radii, and for each the nodes on it by angle."""
    radius, theta = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    on_face = (abs(points[:, 2]) < 1e-9) & (radius > least - 1e-9)
    radii = np.unique(np.round(radius[on_face], 9))
    nodes = [np.flatnonzero(on_face & (abs(radius - r) < 1e-8)) for r in radii]
    return [ring[np.argsort(theta[ring])] for ring in nodes]


def main():
    folder, least = Path(sys.argv[1]), float(sys.argv[2])
    with (folder / "modes.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    checked, faults = 0, []
    with h5py.File(folder / "modes.h5") as file:
        data, points = file["VTKHDF/PointData"], file["VTKHDF/Points"][:]
        columns = max(len(ring) for ring in rings(points, least))
        face = [ring for ring in rings(points, least) if len(ring) == columns]  # a pad's nodes double some of others
        for row in rows:
            total = sum(float(value) for name, value in row.items() if re.fullmatch(r"part_\w+_percent", name))
            if abs(total - 100) > 1e-9:
                faults.append(f"mode {row['mode']}: parts sum to {total} per cent")
            label = re.fullmatch(r"\((\d+),(\d+)\+?\)", row["label"])
            if not label:
                continue
            w = data[f"mode_{int(row['mode']):03d}_re"][:, 2]
            spectrum = np.array([np.fft.rfft(w[ring]) for ring in face])
            m = int(np.argmax(abs(spectrum[-1])))
            angle = np.angle(spectrum[-1, m])
            profile = (spectrum[:, m] * np.exp(-1j * angle)).real
            significant = profile[abs(profile) > 0.02 * abs(profile).max()]
            n = int(np.sum(significant[1:] * significant[:-1] < 0))
            checked += 1
            print(f"mode {row['mode']} {row['freq_hz']} Hz: ({n},{m}), labelled {row['label']}")
            if (n, m) != (int(label[1]), int(label[2])):
                faults.append(f"mode {row['mode']} is ({n},{m}), not {row['label']}")
    print("; ".join(faults) or f"{checked} labels as their shapes")
    return 1 if faults or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
