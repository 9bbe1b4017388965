#!/usr/bin/env python3
"""A transient on modes that goes on from a checkpoint ends with the same bytes as one that was never stopped: tables, states of pairs,
snapshots; and another cut-off is refused. Factors on several ranks are the same to rounding only: there two runs that go on from
the same checkpoint end with the same tables. Breaks when a number of the model, of the state, of the contact laws' factors or
of the ledger is not kept. The scene is a small brake, the block of tests/cases/reduced_tie.toml with its tied
plate, or a stop, whose speed falls to 0 after the checkpoint, with static and kinetic friction.

    reduced.py SQUEAL LAUNCHER [--ranks 1] [--scene brake]"""

import argparse
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from runs import SOURCE, arrays, fail, outcome_of, starter

OPTIONS = """-press_ramp 2e-4 -dynamics_compare false -dynamics_live 0 -dynamics_checkpoint_interval 37
             -dynamics_pairs_interval 1e-4 -dynamics_snapshot_interval 5e-4"""
BRAKE = """-rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 5 -contact_speed 0.02 -dynamics_cutoff 20e3
           -tap_time 3e-4"""
TIED = """-options_file brake.yaml -analysis transient -dynamics_model reduced -dynamics_cutoff 40e3 -touch_speed 0.02 -impulses tap
          -tap_at 0,0.02,0.032 -tap_part top -tap_impulse 1e-3,0,-1e-3 -tap_time 3e-4 -output_fields 1"""
STOP = "-contact_history fast.csv -press_ramp 4e-4 -sound_microphones front -dynamics_snapshot_interval 2.5e-4"
FAST = "time_s,factor\n0,1\n5e-4,1\n1.3e-3,0\n"
TABLES = ("transient.csv", "contact_pairs.csv", "impulses.csv", "sound_time.csv")  # the first two are of all scenes


def scene(name, folder):
    """Options of a scene; what it needs is made in the folder."""
    if name == "brake":
        return ["-options_file", SOURCE / "options/massi2005_reduced.yaml", *BRAKE.split()]
    if name == "stop":
        (folder / "fast.csv").write_text(FAST, encoding="utf-8")
        return ["-options_file", SOURCE / "options/small_brake_stop.yaml", *STOP.split()]
    case = tomllib.loads((SOURCE / "tests/cases/reduced_tie.toml").read_text(encoding="utf-8"))
    (folder / "brake.yaml").write_text(case["file"]["brake.yaml"], encoding="utf-8")
    subprocess.run([sys.executable, *shlex.split(case["make"][0].format(source=SOURCE))], cwd=folder, check=True)
    return TIED.split()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", default="1")
    parser.add_argument("--scene", choices=("brake", "tied", "stop"), default="brake")
    parser.add_argument("--dense", default="2500", help="-dynamics_dense")
    arguments = parser.parse_args()
    program = starter(arguments.squeal)

    def run(folder, *options):
        words = [*scene(arguments.scene, folder.parent), *OPTIONS.split(), "-dynamics_dense", arguments.dense, "-output_dir", folder,
                 *options]
        return outcome_of(program, folder.parent, words, int(arguments.ranks))

    with tempfile.TemporaryDirectory() as folder:
        whole, parts = Path(folder) / "whole", Path(folder) / "parts"
        outcome = [run(parts, "-ts_max_time", "1e-3")]
        if arguments.ranks != "1":
            shutil.copytree(parts, whole)
        outcome += [run(whole, "-ts_max_time", "2e-3", *(["-dynamics_restart"] if whole.exists() else [])),
                   run(parts, "-ts_max_time", "2e-3", "-dynamics_restart", "-dynamics_cutoff", "21e3", "-ts_dt", "7e-6"),
                   run(parts, "-ts_max_time", "2e-3", "-dynamics_restart")]
        if [end.status > 0 for end in outcome] != [False, False, True, False]:
            fail("\n".join(end.stderr for end in outcome))
        if "-dynamics_cutoff" not in outcome[2].stderr:
            fail(f"the other cut-off is not named: {outcome[2].stderr}")
        tables = [table for table in TABLES if table in TABLES[:2] or (whole / table).exists()]
        for table in tables:
            if (whole / table).read_bytes() != (parts / table).read_bytes():
                fail(f"{table} differs")
        frames = sorted(path.name for path in whole.glob("snapshot_*.h5"))
        if len(frames) < 4 or frames != sorted(path.name for path in parts.glob("snapshot_*.h5")):
            fail(f"snapshots {frames}")
        for frame in frames:
            if arguments.ranks == "1" and arrays(whole / frame) != arrays(parts / frame):
                fail(f"{frame} differs")
        rows = (whole / "contact_pairs.csv").read_text()
        print(f"{len(frames)} snapshots, {rows.count(',slip')} pairs slip, {rows.count(',stick')} stick, "
              f"{rows.count(',open')} are open: the same")
    program.end()


if __name__ == "__main__":
    sys.exit(main())
