#!/usr/bin/env python3
"""A sweep that is killed goes on where it stopped, with the same result: kills it after each full solution that it has kept,
and compares all tables with those of a sweep that nobody disturbed: to the last digit on one rank, to 1e-9 on two, where
the order of sums in the factorisation depends on the moment. Breaks when what is kept lacks something, is read in another
order, or is taken for that of another sweep."""

import argparse
import csv
import filecmp
import math
import re
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
from served import killed_at, outcome_of, starter  # noqa: E402

SOURCE = Path(__file__).resolve().parents[2]
SMALL = 'rig: {disc: {elements: "6,20,1"}, pad: {elements: "3,3,2"}, beam: {elements: 8}}\nmodes: {band: "100,6000"}\n'
TABLES = ("sweep.csv", "onsets.csv", "parameters.csv")
# What differs, and the options that make it so
CHANGES = (("contact contact", "-contact_mu", "0.4"), ("materials", "-beam_poisson", "0.29"),
           ("modes", "-modes_band", "100,5500"),
           ("supports", "-supports", "hub,foot", "-foot_set", "beam_rows", "-foot_fix", "x"),
           ("contact contact", "-contact_slip", "1,0,0", "-rows_stiffness", "1e6,8.422e6,0"),
           ("the mesh", "-model_element", "full"),
           ("spring rows", "-rows_stiffness", "0,8.422e6,1"), ("the mesh", "-rig_disc_spread", "0.5"))
# Places in the second file, and bits that change there: another kind of file, lengths in the head, a bit of a vector; an end
DAMAGE = ((0, b"\x20"), (72, b"\xff\xff\xff\xff"), (-1000, b"\x01"), (-8, None))
# Pairs that are closed at some places only, groups of them among the parameters; fewer groups without the last place
GROUPS = ("-sweep_parameter", "contact_mu", "-sweep_verify", "0", "-sweep_values")
STATUSES, FEWER = "0.05,0.06,0.07,0.5", "0.05,0.06,0.07"
PLAIN = ("-sweep_onsets", "0")  # where onsets are not looked at
PATIENCE = 400  # seconds


def command(arguments, folder, output, *options):
    """The sweep, writing to a folder."""
    return [arguments.launcher, "-n", str(arguments.ranks), arguments.squeal, "-options_file", SOURCE / "options/massi2005.yaml",
            "-options_file", folder / "small.yaml", "-analysis", "sweep", "-sweep_parameter", "pad_young",
            "-sweep_values", "6.5e9:80e9:12", "-output_dir", folder / output, "-modes_contact", arguments.contact, *options]


def complete(arguments, folder, output, *options):
    """Runs to the end; what it printed, then its warnings."""
    outcome = outcome_of(arguments.program, folder, command(arguments, folder, output, *options)[4:], arguments.ranks)
    if outcome.status:
        raise SystemExit(f"FAILED: exit status {outcome.status}: {outcome.stderr}")
    return outcome.stdout + outcome.stderr


def kept(folder, output):
    """Full solutions that the sweep has kept."""
    return len(list((folder / output).glob("sweep_restart_[0-9][0-9][0-9]")))


def same(arguments, one, other):
    """Whether two tables agree."""
    if arguments.ranks == 1:
        return filecmp.cmp(one, other, shallow=False)
    rows = [list(csv.DictReader(path.open(newline=""))) for path in (one, other)]
    keys = [key for key in ("freq_hz", "critical_value", "value") if key in rows[0][0]] if rows[0] else []  # as onsets.csv without an onset
    close = [math.isclose(float(a[key]), float(b[key]), rel_tol=1e-9) for a, b in zip(*rows) for key in keys]
    return len(rows[0]) == len(rows[1]) and all(close)


def kill_after(arguments, folder, output, n, *options):
    """Starts the sweep, which is killed when it has kept n full solutions and begins to keep the next one."""
    killed = killed_at(command(arguments, folder, output, *options), folder / output / f"sweep_restart_{n:03d}")
    if not killed or kept(folder, output) != n:
        raise SystemExit(f"FAILED: no {n} solutions were kept before the end")
    if any((folder / output / table).exists() for table in TABLES):
        raise SystemExit("FAILED: a killed sweep left a table")


def begin_anew(arguments, folder, output, parts, *options):
    """A sweep that finds the solutions of another scene, of which it says what differs."""
    printed = complete(arguments, folder, output, *PLAIN, *options)
    if "going on" in printed:
        raise SystemExit(f"FAILED: took up the solutions of another scene: {' '.join(options)}")
    if not re.search(f"is of another scene, which differs in: .*{parts}.*; the sweep begins anew$", printed, re.M):
        raise SystemExit(f"FAILED: {' '.join(options)} is not said to differ in {parts}:\n{printed}")


def check_damage(arguments, folder):
    """Damaged files: each is named and left out, and the sweep ends as if it had not been there."""
    for number, (place, bits) in enumerate(DAMAGE):
        output = f"damaged{number}"
        shutil.copytree(folder / "other", folder / output)
        file = folder / output / "sweep_restart_001"
        data = bytearray(file.read_bytes())
        if bits is None:
            del data[place:]
        for i, mask in enumerate(bits or b"", place):
            data[i] ^= mask
        file.write_bytes(data)
        printed = complete(arguments, folder, output)
        if not re.search("sweep_restart_001 is .*(damaged|truncated).*; the sweep goes on without it$", printed, re.M):
            raise SystemExit(f"FAILED: damage {number} was not seen:\n{printed}")
        if kept(folder, output):
            raise SystemExit(f"FAILED: damage {number}: files are left")
        if not same(arguments, folder / "undisturbed/sweep.csv", folder / output / "sweep.csv"):
            raise SystemExit(f"FAILED: damage {number}: sweep.csv differs")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--contact", default="all", help="all pairs closed, or static: those of the sliding state")
    arguments = parser.parse_args()
    arguments.program = starter(arguments.squeal, PATIENCE)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SMALL)
        complete(arguments, folder, "undisturbed")
        for n in (1, 2, 3):
            kill_after(arguments, folder, "killed", n)
        printed = complete(arguments, folder, "killed", "-output_overwrite", "false")
        if not re.search("^going on with [3-9] full solutions", printed):
            raise SystemExit(f"FAILED: did not go on where it stopped:\n{printed}")
        for table in TABLES:
            if not same(arguments, folder / "undisturbed" / table, folder / "killed" / table):
                raise SystemExit(f"FAILED: {table} differs")
        if kept(folder, "killed"):
            raise SystemExit("FAILED: solutions are still kept after the end")

        kill_after(arguments, folder, "other", 2)
        alone = arguments.contact == "all" and arguments.ranks == 1
        for parts, *change in CHANGES if alone else CHANGES[::4]:
            shutil.copytree(folder / "other", folder / change[0])
            begin_anew(arguments, folder, change[0], parts, *change)
        if alone:
            check_damage(arguments, folder)
        if arguments.contact == "static":
            kill_after(arguments, folder, "groups", 1, *GROUPS, STATUSES)
            begin_anew(arguments, folder, "groups", "the sweep", *GROUPS, FEWER)
    arguments.program.end()
    print("ok: killed three times, all tables alike")
    return 0


if __name__ == "__main__":
    sys.exit(main())
