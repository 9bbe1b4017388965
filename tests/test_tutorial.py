#!/usr/bin/env python3
"""Follows a page for users to the letter: writes its files, gives its commands in its order, in a folder of its own
that has the repository's scripts and options and the program as built. Breaks when a command fails, says something else
than the page, leaves out a file that the page names, or when an error is more than one line.

    test_tutorial.py SQUEAL MPIRUN hour|brake|guides

`hour` is options/tutorial.md, `brake` options/own_brake.md, `guides` options/guides.md. Exit status 77, skipped,
without the program gmsh."""

import csv
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
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


def check_hour(folder):
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
    lines = len((folder / "brake.geo").read_text().splitlines())
    faults += [] if lines == 10 else [f"the mesh takes {lines} lines"]
    return faults + ([] if len(closed) == 35 else [f"{len(closed)} pairs touch"])


def check_brake(folder):
    """What the page says grows, where it begins to, and the files that it names; other versions of gmsh make other
    meshes, hence the widths."""
    def fastest(name):
        with (folder / name / "modes.csv").open() as lines:
            row = max(csv.DictReader(lines), key=lambda row: float(row["growth_rad_s"]))
        return row["label"], float(row["freq_hz"]), float(row["growth_rad_s"])

    with (folder / "results/sweep/onsets.csv").open() as lines:
        onsets = [(float(row["freq_hz"]), float(row["critical_value"])) for row in csv.DictReader(lines)]
    named = [path for path in ("results/modes.png", "results/modes.xmf") if not (folder / path).exists()]
    faults = [f"{path} is missing" for path in named]
    for found, said in ((fastest("results"), (5149, 279)), (fastest("results/fine"), (5105, 272))):
        if found[0] != "(0,6+)" or abs(found[1] / said[0] - 1) > 5e-3 or abs(found[2] / said[1] - 1) > 0.1:
            faults.append(f"grows: {found}, not {said}")
    if len(onsets) != 1 or abs(onsets[0][0] / 5145 - 1) > 5e-3 or abs(onsets[0][1] - 0.203) > 0.02:
        faults.append(f"onsets: {onsets}")
    return faults


def check_guides(folder):
    """The growth that the page asks to be trusted; an onset over friction where growth changes its sign; the files that it names."""
    def rows(name):
        with (folder / "results" / name).open() as lines:
            return list(csv.DictReader(lines))

    named = ["results/modes_causes.csv", "results/modes_feed_in.csv", "results/modes_effects.csv", "results/modes_effects.h5",
             "brake.html", "results/friction/sweep.png", "results/cure/cure.csv", "results/check/check.h5"]
    faults = [f"{path} is missing" for path in named if not (folder / path).exists()]
    grows = [round(float(row["growth_rad_s"])) for row in rows("modes.csv") if row["unstable"] == "1"]
    faults += [] if grows == [298] else [f"grows: {grows}"]
    unstable = {float(row["value"]) for row in rows("friction/sweep.csv") if row["unstable"] == "1"}
    quiet = {float(row["value"]) for row in rows("friction/sweep.csv")} - unstable
    onsets = [float(row["critical_value"]) for row in rows("friction/onsets.csv")]
    if not onsets or not max(quiet) < min(onsets) < min(unstable):
        faults.append(f"onsets {onsets} between {max(quiet)} and {min(unstable)}")
    if not 0.2 < float(rows("sample/probability.csv")[-1]["probability"]) < 0.4:
        faults.append("probability of the oscillator is not 0.3085")
    return faults


# Text, names of the files in it by their language, what is checked at the end
PAGES = {"hour": ((SOURCE / "options/tutorial.md").read_text(), {"geo": "brake.geo", "yaml": "brake.yaml"}, check_hour),
         "brake": ((SOURCE / "options/own_brake.md").read_text(), {"geo": "own.geo", "yaml": "own.yaml"},
                   check_brake),
         "guides": ((SOURCE / "options/guides.md").read_text(), {}, check_guides)}


def main():
    if not shutil.which("gmsh"):
        print("skipped: no gmsh, of scripts/packages.txt")
        return 77
    squeal, mpirun = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    text, files, check = PAGES[sys.argv[3]]
    faults = []
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name) / "share/squeal"  # scripts that are installed take the program of their prefix
        (Path(name) / "bin").mkdir()
        (Path(name) / "bin/squeal").symlink_to(squeal)
        shutil.copytree(SOURCE / "scripts", folder / "scripts")
        shutil.copytree(SOURCE / "options", folder / "options", ignore=shutil.ignore_patterns("*.msh", "*.png"))
        (folder / "scripts/run").write_text(f'#!/bin/sh\nexec "{mpirun}" -n 1 "{squeal}" "$@"\n')
        for kind, content in blocks(text):
            if kind in files:
                (folder / files[kind]).write_text(content)
                continue
            for command in content.splitlines() if kind.startswith("sh") else ():
                faults += follow(folder, kind, command)
        faults += check(folder)
    print("\n".join(faults) or "as the page says")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
