#!/usr/bin/env python3
"""scripts/cure on a small brake with three unstable modes: the cheapest set, added to the matrices, leaves what is stated by scipy's
eigenvalues. Breaks when a direction, a unit or a node is mixed up, a set is called stable that is not, or bad input is not one line.

    test_cure.py SQUEAL"""

import csv
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests/verify"))
from changes import Brake, surfaces  # noqa: E402
from forked import run_script  # noqa: E402
from served import sooner  # noqa: E402
from squeal.provenance import Provenance  # noqa: E402
from test_report import Page  # noqa: E402

SCENE = """
rig: {disc: {elements: "8,24,1"}, pad: {elements: "4,4,2"}, beam: {elements: 10}}
modes: {band: "1,8000"}
contact: {friction_damping: true, speed: 2, force: 500, mu_slope: -0.02}
disc: {beta: 1e-8}
pad: {alpha: 20}
dashpots: hang
hang: {set: pad, viscosity_total: "0,3,0"}
"""
MU = 0.5
LIMIT = 1e-5  # of the eigenvalue: growth that is no instability
OPTION = {"mass": "mass", "spring": "stiffness", "dashpot": "viscosity", "relative_spring": "stiffness", "relative_dashpot": "viscosity",
          "layer_mass": "mass", "layer_spring": "stiffness", "layer_dashpot": "viscosity", "parameter": "percent"}


def call(folder, *words):
    return run_script(SOURCE / "scripts/cure", words, folder)


def moved(squeal, folder, rows, scene):
    """The matrices of a run with the parameters that a set changes, saved anew, and the friction coefficient."""
    options = {}
    for row in rows:
        if row["change"] == "parameter":
            words = scene.value(row["name"]).split(",")
            options[row["name"]] = ",".join(f"{float(word) * (1 + float(row['amount']) / 100):.15g}" for word in words)
    if not options:
        return folder / "matrices", MU
    subprocess.run([squeal, "-options_file", "out/scene.yaml", "-output_dir", "moved", "-operators_save", "moved_matrices",
                    "-output_fields", "0", *(word for name, value in options.items() for word in (f"-{name}", value))],
                   cwd=folder, check=True, capture_output=True)
    return folder / "moved_matrices", float(options.get("contact_mu", MU))


def exact(squeal, folder, rows):
    """Largest growth of the matrices with a set of changes, and its eigenvalue."""
    brake = Brake(folder / "out", *moved(squeal, folder, rows, Provenance(folder / "out/scene.yaml")))
    brake.sets = surfaces(brake)
    rows = [row for row in rows if row["change"] != "parameter"]
    for i, row in enumerate(rows):
        given = {OPTION[row["change"]]: row["amount"], "direction": ",".join(row[f"direction_{axis}"] for axis in "xyz")}
        if row["name"]:
            given["ring" if "," in row["name"] else "set"] = row["name"]
        else:
            given |= {"at": ",".join(row[f"{axis}_m"] for axis in "xyz"), "part": row["part"]}
        if row["to_part"]:
            given |= {"to": ",".join(row[f"to_{axis}_m"] for axis in "xyz"), "to_part": row["to_part"]}
        if i:
            given["with"] = f"c{i - 1}"
        brake.scene.given.update({f"c{i}_{key}": text for key, text in given.items()})
    band = [2 * math.pi * edge for edge in (1.5, 7992)]
    return max(brake.modes(f"c{len(rows) - 1}" if rows else "", band, 60), key=lambda value: value.real)


def check_set(squeal, folder, rows, what):
    """A set of cure.csv beside its matrices; what is wrong."""
    value = exact(squeal, folder, rows)
    stated, error, count = (float(rows[0][name]) for name in ("growth_rad_s", "growth_error_rad_s", "n_unstable"))
    print(f"{what}: {len(rows)} changes, growth {value.real:.6g} of the matrices, {stated:.6g} +- {error:.1g} stated")
    off = abs(value.real - stated) > error + 1e-9 * abs(value)
    return [f"{what}: growth"] if off or (count == 0) != (value.real <= LIMIT * abs(value)) else []


def check_parameters(folder, said):
    """The first parameter that is said, by the largest of -growth / slope over the unstable modes; faults."""
    def rows(name):
        with (folder / "out" / name).open(newline="") as table:
            return list(csv.DictReader(table))

    growth = {row["mode"]: float(row["growth_rad_s"]) for row in rows("modes.csv") if row["unstable"] == "1"}
    needed = {}
    for row in rows("modes_sensitivities.csv"):
        slope = float(row["growth_rad_s_per_percent"])
        if row["mode"] in growth:
            needed.setdefault(row["parameter"], []).append(-growth[row["mode"]] / slope if slope else math.inf)
    one_way = {name: max(own, key=abs) for name, own in needed.items() if min(own) * max(own) > 0 and max(map(abs, own)) < 100}
    name = min(one_way, key=lambda name: abs(one_way[name]))
    return [] if f"  {name} by {one_way[name]:+.3g} % would stop all" in said.splitlines()[0] else [f"parameters: {name}, {one_way}"]


def check_page(folder, sets):
    """The sets that leave none unstable on the page of scripts/report, in g and N s/m; none where modes.csv is newer; faults."""
    def table():
        run_script(SOURCE / "scripts/report", ["out"], folder)
        page = Page(folder / "out/report.html")
        found = [e["id"] for e in page.elements if e.get("id", "").endswith("-cures-table")]
        return page.table(found[0]) if found else []

    calm = [row for own in list(sets.values())[:10] for row in own if own[0]["n_unstable"] == "0"]
    factor = {"mass": 1e3, "spring": 1e-3, "dashpot": 1, "parameter": 1}
    shown = table()
    right = len(shown) == len(calm) > 0 and all(
        math.isclose(float(cell["amount"]), factor[row["change"].split("_")[-1]] * float(row["amount"]), rel_tol=1e-9)
        and (cell["set"], cell["part"]) == (row["set"], row["part"]) for cell, row in zip(shown, calm))
    now = (folder / "out/cure/cure.csv").stat().st_mtime
    os.utime(folder / "out/modes.csv", (now + 10, now + 10))
    return [] if right and not table() else [f"page: {shown}"]


def main(squeal):
    faults = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SCENE)
        subprocess.run([squeal, "-options_file", SOURCE / "options/massi2005.yaml", "-options_file", "small.yaml", "-output_dir", "out",
                        "-operators_save", "matrices", "-modes_sensitivities"], cwd=folder, check=True, capture_output=True)
        done = call(folder, "out", "--program", squeal, "--most", "dashpot=12,mass=60", "--tries", "12")
        print(done.stdout + done.stderr)
        with (folder / "out/cure/cure.csv").open(newline="") as table:
            rows = list(csv.DictReader(table))
        faults += check_parameters(folder, done.stdout)
        sets = {}
        for row in rows:
            sets.setdefault(int(row["set"]), []).append(row)
        costs = [float(own[0]["cost"]) for own in sets.values() if own[0]["n_unstable"] == "0"]
        faults += ["cheapest first"] * (not costs or costs != sorted(costs))
        known = [own for own in sets.values() if all(row["name"] != "beam_rows" for row in own)]
        chosen = {"the cheapest": known[0], "the worst": known[-1]}
        chosen |= {"a layer": own for own in known if any(row["change"].startswith("layer") for row in own)}
        chosen |= {"a pair": own for own in known if len(own) == 2}
        faults += [f"no set is {kind}" for kind in ("a layer", "a pair") if kind not in chosen]
        for what, own in chosen.items():
            faults += check_set(squeal, folder, own, what)
        call(folder, "out", "--program", squeal, "--changes", "parameter", "--most", "parameter=80", "--count", "3", "--output", "percents")
        with (folder / "percents/cure.csv").open(newline="") as table:
            percents = [row for row in csv.DictReader(table) if row["set"] == "1"]
        faults += check_set(squeal, folder, percents, "percents") + ["percents"] * (percents[0]["n_unstable"] != "0")
        faults += check_page(folder, sets)
        for words, said in ((["none"], "none/scene.yaml: no such file"),
                            (["out", "--changes", "glue"], f"must be of {', '.join(OPTION)}"),
                            (["out", "--price", "mass=-1"], "a positive number"), (["out", "--parts", "wheel"], "has no mass"),
                            (["out", "--changes", "mass,spring", "--most", "mass=1e-9,spring=1e-9"], "raise --most")):
            done = call(folder, *words, "--program", squeal)
            faults += [] if done.returncode and said in done.stderr.splitlines()[-1] else [f"{words}: {done.stderr}"]
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    with sooner(sys.argv[1]) as quick:
        sys.exit(main(quick))
