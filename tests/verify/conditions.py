#!/usr/bin/env python3
"""Conditions beside what stands for itself.

    conditions.py modes RESULTS CONDITION MODES  modes of a condition beside -analysis modes of the scene with its values
    conditions.py bands RESULTS                  counts of conditions_bands.csv, from conditions.csv
    conditions.py statuses RESULTS LEAST         samples have several statuses, and those verified their own"""

import csv
import sys
from pathlib import Path


def read(path):
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def check(what, holds, value):
    print(f"{'ok  ' if holds else 'FAIL'} {what}: {value}")
    return bool(holds)


def modes(folder, condition, full):
    own = [row for row in read(folder / "conditions.csv") if row["name"] == condition]
    rows = read(full / "modes.csv")
    worst = max(abs(complex(float(a["growth_rad_s"]), 6.283185307179586 * (float(a["freq_hz"]) - float(b["freq_hz"]))) -
                    complex(float(b["growth_rad_s"]))) / (6.283185307179586 * float(b["freq_hz"])) for a, b in zip(own, rows))
    return [check("as many modes", len(own) == len(rows) > 5, f"{len(own)} and {len(rows)}"), check("eigenvalues", worst < 1e-6, worst),
            check("classes", [row["class"] for row in own] == [row["state"] for row in rows], len(rows))]


def bands(folder):
    rows, found = read(folder / "conditions.csv"), []
    n = len({row["condition"] for row in rows})
    counted = read(folder / "conditions_bands.csv")
    for band in counted:
        low, high = float(band["freq_from_hz"]), float(band["freq_to_hz"])
        unstable = [row for row in rows if row["class"] == "unstable" and low <= float(row["freq_hz"]) < high]
        squeals = len({row["condition"] for row in unstable})
        worst = max(unstable, key=lambda row: float(row["growth_rad_s"]), default=None)
        found.append(check(f"{low:.6g} to {high:.6g} Hz", int(band["conditions"]) == squeals and int(band["modes"]) == len(unstable) and
                           abs(float(band["occurrence_percent"]) - 100 * squeals / n) < 1e-9 and
                           band["worst"] == (worst["name"] if worst else ""), f"{squeals} conditions"))
    found.append(check("bands join", all(a["freq_to_hz"] == b["freq_from_hz"] for a, b in zip(counted, counted[1:-1])), len(counted)))
    found.append(check("some squeal, some do not", 0 < int(counted[-1]["conditions"]) < n, counted[-1]["conditions"]))
    return found


def statuses(folder, least):
    closed = {row["n_closed"] for row in read(folder / "samples.csv")}
    verified = read(folder / "samples_verify.csv")
    return [check("statuses by their pairs", len(closed) >= int(least), len(closed)),
            check("statuses on the mesh", all(row["same_status"] == "1" for row in verified), len(verified)),
            check("errors within what is stated", all(float(row["worst_ratio"]) <= 1 for row in verified),
                  max(float(row["worst_ratio"]) for row in verified))]


if __name__ == "__main__":
    kind, folder, *more = sys.argv[1:]
    done = {"modes": lambda: modes(Path(folder), more[0], Path(more[1])), "bands": lambda: bands(Path(folder)),
            "statuses": lambda: statuses(Path(folder), more[0])}[kind]()
    sys.exit(0 if all(done) else 1)
