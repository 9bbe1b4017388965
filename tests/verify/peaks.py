#!/usr/bin/env python3
"""Every plus mode of a run of modes must be a peak of a frequency response in time.

    verify/peaks.py RESPONSE MODES [--below 15000] [--rtol 3e-3] [--damping 0.05] [--mac 0.98]

RESPONSE has peaks_modes.csv of `scripts/response --modes MODES`. Below that frequency (Hz) each mode across the disc whose label ends in
+) must have a peak with the relative difference of frequency, and of damping ratio where this is above 0.05 %, with the
least MAC of the two shapes, and with its own label. Exit status: 0, or 1.
"""

import argparse
import csv
import sys
from pathlib import Path

LEAST_DAMPING = 5e-4


def rows(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("response", type=Path)
    parser.add_argument("modes", type=Path)
    for name, default in (("above", 1000), ("below", 15000), ("rtol", 3e-3), ("damping", 0.05), ("mac", 0.98)):
        parser.add_argument(f"--{name}", type=float, default=default)
    args = parser.parse_args()
    plus = [row for row in rows(args.modes / "modes.csv")
            if row["label"].startswith("(") and row["label"].endswith("+)") and args.above <= float(row["freq_hz"]) <= args.below]
    peaks = {row["mode"]: row for row in rows(args.response / "peaks_modes.csv")}
    faults, worst = [], [0.0, 0.0, 1.0]
    for mode in plus:
        name = f"mode {mode['mode']}, {mode['label']} at {float(mode['freq_hz']):.2f} Hz"
        peak = peaks.get(mode["mode"])
        if not peak:
            faults.append(f"{name}: no peak")
            continue
        freq = abs(float(peak["freq_hz"]) / float(mode["freq_hz"]) - 1)
        ratio = float(mode["damping_ratio"])
        damping = abs(float(peak["damping_ratio"]) / ratio - 1) if ratio > LEAST_DAMPING else 0.0
        mac = float(peak["mac"])
        worst = [max(worst[0], freq), max(worst[1], damping), min(worst[2], mac)]
        if freq > args.rtol or damping > args.damping or mac < args.mac or peak["label"] != mode["label"]:
            faults.append(f"{name}: frequency {freq:.2e}, damping {damping:.2e}, MAC {mac:.5f}, label {peak['label']}")
    print("\n".join(faults) or f"{len(plus)} plus modes: frequency {worst[0]:.1e}, damping {worst[1]:.1e}, MAC {worst[2]:.5f}")
    return 1 if faults or not plus else 0


if __name__ == "__main__":
    sys.exit(main())
