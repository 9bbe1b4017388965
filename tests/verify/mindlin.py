#!/usr/bin/env python3
"""Stick zone of a cylinder or sphere that is pressed on a flat and then pulled along it, against C. Cattaneo (1938), R. D. Mindlin (1949).

    verify/mindlin.py FOLDER (--width W | --sphere) --radius R --modulus E --mu MU [--error 0.02] [--traction 0.03]

static.csv of a slice W (m) thick along y, two bodies of one material, pulled along x. With F the normal and T the tangential force
per length, a^2 = 4 F R / (pi E) (m, Pa) and p0 = 2 F / (pi a), c = a sqrt(1 - T / (mu F)) is half the width of the zone that sticks:

    q = mu p0 sqrt(1 - x^2 / a^2),            c < |x| < a,
    q = mu p0 (sqrt(1 - x^2 / a^2) - sqrt(c^2 - x^2) / a),   |x| < c.

With --sphere half of the bodies, y >= 0: r^2 = x^2 + y^2 for x^2, a^3 = 3 F R / (4 E), p0 = 3 F / (2 pi a^2), c = a (1 - T / (mu F))^(1/3),
F and T the forces of both halves; all of q along x, which is exact for a Poisson's ratio of 0.

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
    for name in ("radius", "modulus", "mu"):
        parser.add_argument(f"--{name}", type=float, required=True)
    shape = parser.add_mutually_exclusive_group(required=True)
    shape.add_argument("--width", type=float)
    shape.add_argument("--sphere", action="store_true")
    parser.add_argument("--error", type=float, default=0.02)
    parser.add_argument("--traction", type=float, default=0.03)
    args = parser.parse_args()
    with (args.folder / "static.csv").open(newline="") as lines:
        rows = [row for row in csv.DictReader(lines) if row["status"] != "open"]
    number = {name: np.array([float(row[name]) for row in rows]) for name in rows[0] if name not in ("status", "interface")}
    sticks = np.array([row["status"] == "stick" for row in rows])
    x, area, p = number["x_m"], number["area_m2"], number["lambda_n_n"] / number["area_m2"]
    x = np.hypot(x, number["y_m"]) if args.sphere else x
    b_x = number["n_y"] * number["t_z"] - number["n_z"] * number["t_y"]  # b = n x t
    q = np.abs(number["lambda_t_n"] * number["t_x"] + number["lambda_b_n"] * b_x) / area
    share = 0.5 if args.sphere else args.width
    force, pull = np.sum(p * area) / share, np.sum(q * area) / share
    if args.sphere:
        a = (3 * force * args.radius / (4 * args.modulus))**(1 / 3)
        c, most = a * (1 - pull / (args.mu * force))**(1 / 3), 3 * force / (2 * np.pi * a**2)
    else:
        a = np.sqrt(4 * force * args.radius / (np.pi * args.modulus))
        c, most = a * np.sqrt(1 - pull / (args.mu * force)), 2 * force / (np.pi * a)
    slope, start = np.polyfit(x[sticks]**2, (args.mu * p - q)[sticks]**2, 1, w=np.sqrt(area[sticks]))
    found = np.sqrt(-start / slope)
    root = np.sqrt(np.maximum(0, 1 - (x / a)**2))
    exact = args.mu * most * (root - np.sqrt(np.maximum(0, (c / a)**2 - (x / a)**2)))
    off = np.sqrt(np.sum(area * (q - exact)**2) / np.sum(area)) / (args.mu * most)
    inner, outer, places = np.abs(x[sticks]).max(), np.abs(x[~sticks]).min(), np.unique(np.abs(number["x_m"]).round(9))
    face = np.diff(places)[np.searchsorted(places, c) - 1]
    print(f"T / (mu F) {pull / (args.mu * force):.4f}, a {a:.5g} m, c {c:.5g} m, c / a {c / a:.4f}; found {found:.5g} m, off by "
          f"{found / c - 1:+.4f}; sticks to {inner:.5g} m, slips from {outer:.5g} m; traction off by {off:.4f}")
    fits = abs(found / c - 1) <= args.error and abs(inner - c) <= face and abs(outer - c) <= face
    return 0 if fits and off <= args.traction and 0.2 < c / a < 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
