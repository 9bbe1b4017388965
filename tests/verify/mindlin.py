#!/usr/bin/env python3
"""Stick zone of a cylinder that is pressed on a flat and then pulled along it, against C. Cattaneo (1938) and R. D. Mindlin (1949).

    verify/mindlin.py FOLDER --width W --radius R --modulus E --mu MU [--error 0.02] [--traction 0.03]

static.csv of a slice W (m) thick along y, two bodies of one material, pulled along x. With F the normal and T the tangential force
per length, a^2 = 4 F R / (pi E) (m, Pa) and p0 = 2 F / (pi a), c = a sqrt(1 - T / (mu F)) is half the width of the zone that sticks:

    q = mu p0 sqrt(1 - x^2 / a^2),            c < |x| < a,
    q = mu p0 (sqrt(1 - x^2 / a^2) - sqrt(c^2 - x^2) / a),   |x| < c.

Hence (mu p - q)^2 of the pairs that stick is linear in x^2, and 0 at c^2: c is found by that line, of least squares over the pairs that
stick, weighted by area. It must be within --error of the above, pairs must stick up to c and slip from c on, but for the faces at it,
and q must be within --traction of mu p0 in the root of the mean square. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    for name in ("width", "radius", "modulus", "mu"):
        parser.add_argument(f"--{name}", type=float, required=True)
    parser.add_argument("--error", type=float, default=0.02)
    parser.add_argument("--traction", type=float, default=0.03)
    args = parser.parse_args()
    with (args.folder / "static.csv").open(newline="") as lines:
        rows = [row for row in csv.DictReader(lines) if row["status"] != "open"]
    number = {name: np.array([float(row[name]) for row in rows]) for name in rows[0] if name not in ("status", "interface")}
    sticks = np.array([row["status"] == "stick" for row in rows])
    x, area, p = number["x_m"], number["area_m2"], number["lambda_n_n"] / number["area_m2"]
    b_x = number["n_y"] * number["t_z"] - number["n_z"] * number["t_y"]  # b = n x t
    q = np.abs(number["lambda_t_n"] * number["t_x"] + number["lambda_b_n"] * b_x) / area
    force, pull = np.sum(p * area) / args.width, np.sum(q * area) / args.width
    a = np.sqrt(4 * force * args.radius / (np.pi * args.modulus))
    c = a * np.sqrt(1 - pull / (args.mu * force))
    most = 2 * force / (np.pi * a)
    slope, start = np.polyfit(x[sticks]**2, (args.mu * p - q)[sticks]**2, 1, w=np.sqrt(area[sticks]))
    found = np.sqrt(-start / slope)
    root = np.sqrt(np.maximum(0, 1 - (x / a)**2))
    exact = args.mu * most * (root - np.sqrt(np.maximum(0, (c / a)**2 - (x / a)**2)))
    off = np.sqrt(np.sum(area * (q - exact)**2) / np.sum(area)) / (args.mu * most)
    inner, outer, places = np.abs(x[sticks]).max(), np.abs(x[~sticks]).min(), np.unique(np.abs(x).round(9))
    face = np.diff(places)[np.searchsorted(places, c) - 1]
    print(f"T / (mu F) {pull / (args.mu * force):.4f}, a {a:.5g} m, c {c:.5g} m, c / a {c / a:.4f}; found {found:.5g} m, off by "
          f"{found / c - 1:+.4f}; sticks to {inner:.5g} m, slips from {outer:.5g} m; traction off by {off:.4f}")
    fits = abs(found / c - 1) <= args.error and abs(inner - c) <= face and abs(outer - c) <= face
    return 0 if fits and off <= args.traction and 0.2 < c / a < 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
