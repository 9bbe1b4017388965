#!/usr/bin/env python3
"""A map that is killed goes on where it stopped, with the same bytes, also on another number of ranks; that of another scene begins
anew and says so. Breaks when a number of the bodies, of the state or of a row is not kept, when a point depends on more than
these, when memory of kept bodies is left, or when files of another scene are taken.

    map.py SQUEAL LAUNCHER"""

import sys
import tempfile
from pathlib import Path

from runs import SOURCE, fail, killed_at, outcome_of, starter

OPTIONS = "-map_values 0.3,0.5,0.6 -map_values_2 100,200 -ts_max_time 16e-3 -map_window 2e-3 -map_view".split()
TABLES = "map.csv", "map_modes.csv"


# Disturbed runs, with which the map itself is complete and written
DISTURBED = ("-map_values 0.3,0.6 -map_direction apart -map_twins 0 -map_disturbances 5 -ts_max_time 16e-3 -map_window 2e-3 "
             "-map_view").split()
DISTURBED_TABLES = "map.csv", "map_modes.csv", "map_disturbed.csv", "map_basins.csv"


def command(squeal, launcher, ranks, folder, *options):
    return [launcher, "-n", str(ranks), squeal, "-options_file", SOURCE / "options/small_brake_map.yaml",
            "-output_dir", folder, *options]


def main(squeal, launcher):
    program = starter(squeal)
    with tempfile.TemporaryDirectory() as root:

        def run(ranks, folder, *options):
            outcome = outcome_of(program, root, command(squeal, launcher, ranks, folder, *options)[4:], ranks)
            if outcome.status:
                fail(outcome.stderr)
            return outcome.stdout + outcome.stderr

        def goes_on(options, tables, kept, has_map, says):
            whole, parts = Path(root) / f"whole{has_map}", Path(root) / f"parts{has_map}"
            run(1, whole, *options)
            killed = killed_at(command(squeal, launcher, 1, parts, *options), parts / kept)
            if not killed or (parts / "map.csv").exists() != has_map or (parts / tables[-1]).exists():
                fail(f"the map was not killed after {kept}, or map.csv is not there as it must be")
            said = run(2, parts, *options, "-malloc_coalesce", "-malloc_debug", "-malloc_dump")
            if " bytes " in said:
                fail(f"memory of what was kept is left: {said}")
            if says not in said or "warning" in said or "0 reductions" not in said:
                fail(f"it did not go on: {said}")
            for table in tables:
                if (whole / table).read_bytes() != (parts / table).read_bytes():
                    fail(f"{table} differs")
            if list(parts.glob("map_restart_*")):
                fail("files of the restart are left")
            return parts

        goes_on(DISTURBED, DISTURBED_TABLES, "map_restart_runs_000016", True, "  16 of these runs kept by an earlier run")
        parts = goes_on(OPTIONS, TABLES, "map_restart_chain_000002", False, " of them kept by an earlier run")
        (parts / "map_restart_bodies_000000").write_bytes(b"none")
        (parts / "map_restart_chain_000099").write_bytes(b"of a larger map")
        if "is truncated: 4 bytes are less than its head; the map begins anew there" not in run(1, parts, *OPTIONS, "-map_direction", "up"):
            fail("a damaged file is not named")
        if list(parts.glob("map_restart_*")):
            fail("files of a larger map that was killed are left")
        program.end()
        print("the same bytes on two ranks as on one that was not killed")


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
