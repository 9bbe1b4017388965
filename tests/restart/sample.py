#!/usr/bin/env python3
"""A run of samples that is killed goes on where it stopped, with the same result: kills it once the contact statuses are kept, after a full
solution, and after some of the points, and compares all tables with those of a run that nobody disturbed: to the last digit on one rank,
to 1e-8 on two, where the order of sums in the factorisation depends on the moment. Then the same of conditions. A run of another scene
begins anew and says what differs. Breaks when what is kept lacks something, or is taken for that of another run."""

import argparse
import csv
import filecmp
import math
import re
import sys
import tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
from served import killed_at, outcome_of, starter  # noqa: E402

SOURCE = Path(__file__).resolve().parents[2]
SMALL = 'rig: {disc: {elements: "6,20,1"}, pad: {elements: "3,3,2"}, beam: {elements: 8}}\nmodes: {band: "100,6000", contact: static}\n'
SAMPLES = """analysis: sample
sample: {variables: "modulus,force,friction", count: 320, rtol: 1e-5}
modulus: {parameters: pad_young, distribution: uniform, lower: 0.8, upper: 1.2, relative: true}
force: {parameters: press_force, distribution: uniform, lower: 0.5, upper: 1.5, relative: true}
friction: {parameters: contact_mu, distribution: uniform, lower: 0.8, upper: 1.2, relative: true}
"""
TABLES = ("samples.csv", "samples_modes.csv", "probability.csv", "indices.csv")
KILLS = ("sample_restart_statuses", "sample_restart_001", "sample_restart_points_00003", "sample_restart_points_00005")
PATIENCE = 400  # seconds


def command(arguments, folder, output, *options):
    """The run, writing to a folder."""
    return [arguments.launcher, "-n", str(arguments.ranks), arguments.squeal, "-options_file", SOURCE / "options/massi2005.yaml",
            "-options_file", folder / "small.yaml", "-output_dir", folder / output, *options]


def complete(arguments, folder, output, *options):
    """Runs to the end; what it printed, then its warnings."""
    outcome = outcome_of(arguments.program, folder, command(arguments, folder, output, *options)[4:], arguments.ranks)
    if outcome.status:
        raise SystemExit(f"FAILED: exit status {outcome.status}: {outcome.stderr}")
    return outcome.stdout + outcome.stderr


def same(arguments, one, other):
    """Whether two tables agree."""
    if arguments.ranks == 1:
        return filecmp.cmp(one, other, shallow=False)
    rows = [list(csv.DictReader(path.open(newline=""))) for path in (one, other)]
    keys = [key for key in ("freq_hz", "probability") if key in rows[0][0]]
    close = [math.isclose(float(a[key] or 0), float(b[key] or 0), rel_tol=1e-8) for a, b in zip(*rows) for key in keys]
    return len(rows[0]) == len(rows[1]) and all(close)


def check(arguments, folder, tables, kills, *options):
    """Kills a run at files that it is about to write, lets it go on, and compares."""
    complete(arguments, folder, "undisturbed", *options)
    for file in kills:
        if not killed_at(command(arguments, folder, "killed", *options), folder / "killed" / file):
            raise SystemExit(f"FAILED: was not killed at {file}")
        if any((folder / "killed" / table).exists() for table in tables):
            raise SystemExit("FAILED: a killed run left a table")
    printed = complete(arguments, folder, "killed", *options)
    if not re.search("^going on with [0-9]+ full solutions", printed, re.M):
        raise SystemExit(f"FAILED: did not go on with the basis:\n{printed}")
    if "_points_" in kills[-1] and not re.search("^going on behind 200 of 320 points of pass 1 kept in ", printed, re.M):
        raise SystemExit(f"FAILED: did not go on with the points:\n{printed}")
    for table in tables:
        if not same(arguments, folder / "undisturbed" / table, folder / "killed" / table):
            raise SystemExit(f"FAILED: {table} differs")
    if list((folder / "killed").glob("sample_restart_*")):
        raise SystemExit("FAILED: files are still kept after the end")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", type=int, default=1)
    arguments = parser.parse_args()
    arguments.program = starter(arguments.squeal, PATIENCE)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SMALL)
        (folder / "samples.yaml").write_text(SAMPLES)
        words = ("-options_file", folder / "samples.yaml")
        check(arguments, folder, TABLES, KILLS, *words)
        if not killed_at(command(arguments, folder, "other", *words), folder / "other/sample_restart_points_00003"):
            raise SystemExit("FAILED: was not killed")
        printed = complete(arguments, folder, "other", *words, "-sample_seed", "2")
        if "going on" in printed or not re.search("is of another scene, which differs in: the points; the run begins anew$", printed, re.M):
            raise SystemExit(f"FAILED: another seed took up what there was:\n{printed}")
        if arguments.ranks == 1:
            rows = [f"c{k},{0.2 + 0.01 * k:.2f},{20 + k % 7}e9" for k in range(24)]
            (folder / "test.csv").write_text("\n".join(["condition,contact_mu,pad_young", *rows]) + "\n")
            words = ("-analysis", "sample", "-sample_conditions", folder / "test.csv")
            check(arguments, folder, ("conditions.csv", "conditions_bands.csv"), ("sample_restart_001",), *words)
    arguments.program.end()
    print("ok: killed five times, all tables alike")
    return 0


if __name__ == "__main__":
    sys.exit(main())
