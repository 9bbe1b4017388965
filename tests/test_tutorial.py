#!/usr/bin/env python3
"""Follows options/tutorial.md to the letter: writes its files, gives its commands in its order, in a folder of its own
that has the repository's scripts and the program as built. Breaks when a command fails, says something else than the
page, leaves out a file that the page names, or when an error is more than one line.

    test_tutorial.py SQUEAL MPIRUN

Exit status 77, skipped, without the program gmsh."""

import csv
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
FILES = {"geo": "brake.geo", "yaml": "brake.yaml"}
MINUTES = 15


def blocks(text):
    """Language and content of each fenced block, in order."""
    return re.findall(r"^```([\w-]+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def follow(folder, kind, command):
    """Gives one command; returns what is wrong."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, timeout=60 * MINUTES)
    print(f"$ {command}\n{done.stdout}{done.stderr}")
    ours = [line for line in done.stderr.splitlines() if line.startswith("squeal:")]
    if kind == "sh-error":
        return [] if done.returncode and len(ours) == 1 else [f"no error of one line: {command}"]
    if done.returncode:
        return [f"failed: {command}"]
    return [] if bool(ours) == (kind == "sh-warning") else [f"warnings {ours}: {command}"]


def check_decay(folder):
    """Growth and frequency in time against the eigenvalue, both as the page states them."""
    with (folder / "results/time/transient_summary.csv").open() as lines:
        told = {row["quantity"]: float(row["value"]) for row in csv.DictReader(lines)}
    with (folder / "results/same/modes.csv").open() as lines:
        modes = [(float(row["growth_rad_s"]), float(row["freq_hz"])) for row in csv.DictReader(lines)]
    growth, frequency = told["growth"], told["growth_frequency"]
    nearest = min(modes, key=lambda mode: abs(mode[0] - growth) + abs(mode[1] - frequency))
    same = abs(nearest[0] / growth - 1) < 5e-3 and abs(nearest[1] / frequency - 1) < 2e-5
    right = round(growth) == -20 and round(frequency) == 5886
    return [] if same and right else [f"in time {growth} 1/s at {frequency} Hz, the mode {nearest}"]


def check_numbers(folder):
    """The numbers that the page states."""
    with (folder / "results/modes.csv").open() as lines:
        unstable = [row for row in csv.DictReader(lines) if row["unstable"] == "1"]
    with (folder / "results/sweep/onsets.csv").open() as lines:
        onsets = [float(row["critical_value"]) for row in csv.DictReader(lines)]
    with (folder / "results/static/static.csv").open() as lines:
        closed = [row for row in csv.DictReader(lines) if row["status"] != "open"]
    named = [path for path in ("results/modes.png", "results/scene.yaml", "results/time/transient_forces.png",
                               "results/time/transient.csv", "results/sweep/sweep.csv") if not (folder / path).exists()]
    grows = [(round(float(row["freq_hz"]), -1), round(float(row["growth_rad_s"])), row["label"]) for row in unstable]
    faults = [f"{path} is missing" for path in named]
    if grows != [(4680, 76, "(0,4)")]:
        faults.append(f"grows: {grows}")
    if [round(value, 3) for value in onsets] != [0.263, 0.473]:
        faults.append(f"onsets: {onsets}")
    faults += check_decay(folder)
    return faults + ([] if len(closed) == 35 else [f"{len(closed)} pairs touch"])


def main():
    if not shutil.which("gmsh"):
        print("skipped: no gmsh, of scripts/packages.txt")
        return 77
    squeal, mpirun = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    faults = []
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        shutil.copytree(SOURCE / "scripts", folder / "scripts")
        (folder / "scripts/run").write_text(f'#!/bin/sh\nexec "{mpirun}" -n 2 "{squeal}" "$@"\n')
        for kind, content in blocks((SOURCE / "options/tutorial.md").read_text()):
            if kind in FILES:
                (folder / FILES[kind]).write_text(content)
                continue
            for command in content.splitlines():
                faults += follow(folder, kind, command)
        lines = len((folder / "brake.geo").read_text().splitlines())
        faults += [] if lines == 10 else [f"the mesh takes {lines} lines"]
        faults += check_numbers(folder)
    print("\n".join(faults) or "as the page says")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
