#!/usr/bin/env python3
"""scripts/response --damping on a small brake whose parts have loss factors: at each clear peak the loss factor of the damped mode itself,
Im lambda^2 / Re lambda^2 by -analysis modes, and the materials' own from shares of energy. Breaks when the circle is fitted with a wrong
sign or weight, when shares are those of another mode, or when a peak of two modes counts.

    test_damping.py SQUEAL"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
SCENE = """rig: {disc: {elements: "6,20,1"}, pad: {elements: "2,2,2"}, beam: {elements: 6}}
modes: {band: "1000,12000"}
contact: {mu: 0}
probes: tip,edge
tip: {at: "0.11,0,0.11", part: beam}
edge: {at: "-0.12,0,0", part: disc}
"""
LOSS = {"disc": 0.01, "pad": 0.03, "beam": 0.005}
CLEAR = 1e-3  # misfit, below which the circle knows the loss factor to CLOSE
CLOSE, MATERIAL = 2e-3, 0.02


def rows_of(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def squeal(program, folder, *words):
    options = ["-options_file", SOURCE / "options/massi2005.yaml", "-options_file", "small.yaml", "-output_fields", "0", *words]
    subprocess.run([program, *map(str, options)], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def response(folder, *words):
    return subprocess.run([sys.executable, SOURCE / "scripts/response", *map(str, words)], cwd=folder, capture_output=True, text=True,
                          check=False)


def check(folder):
    """What is wrong."""
    true = {}
    for row in rows_of(folder / "damped/modes.csv"):
        square = complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))**2
        true[float(row["freq_hz"])] = square.imag / square.real
    clear = [row for row in rows_of(folder / "frf/damping.csv") if row["misfit"] and float(row["misfit"]) < CLEAR]
    if len(clear) < 3:
        yield f"{len(clear)} clear peaks, not three"
    for row in clear:
        near = true[min(true, key=lambda freq: abs(freq - float(row["freq_hz"])))]
        if abs(float(row["loss_factor"]) / near - 1) > CLOSE:
            yield f"{row['freq_hz']} Hz: loss factor {row['loss_factor']}, not {near:g}"
    found = {row["part"]: float(row["loss_factor"]) for row in rows_of(folder / "frf/damping_parts.csv")}
    for part in ("disc", "pad"):
        if abs(found[part] / LOSS[part] - 1) > MATERIAL:
            yield f"{part}: loss factor {found[part]:g}, not {LOSS[part]:g}"


def main():
    program = Path(sys.argv[1]).resolve()
    losses = [word for part, loss in LOSS.items() for word in (f"-{part}_loss_factor", loss)]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SCENE)
        squeal(program, folder, *losses, "-analysis", "frf", "-frf_force", "tip,1,1,1", "-frf_frequencies", "2000:10000:2001",
               "-output_dir", "frf")
        squeal(program, folder, *losses, "-output_dir", "damped")
        squeal(program, folder, "-modes_sensitivities", "-output_dir", "undamped")
        done = response(folder, "frf", "--damping", "--modes", "undamped")
        print(done.stdout, done.stderr, sep="", end="")
        faults = [f"exit status {done.returncode}"] if done.returncode else list(check(folder))
        bad = response(folder, "frf", "--damping", "--modes", "damped")
        if bad.returncode == 0 or "is missing: shares of energy need a run with -modes_sensitivities" not in bad.stderr:
            faults.append(f"without shares: {bad.stderr}")
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
