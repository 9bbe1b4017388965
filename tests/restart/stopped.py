#!/usr/bin/env python3
"""A run of explicit dynamics that is stopped by signals, or finds no room for a file, and goes on from its last
checkpoint, ends with the tables and fields of a run that nobody disturbed, to the last bit. Breaks when a rank stops
at another step than the rest, a file that is not whole replaces a good one, or rows are lost."""

import os
import resource
import signal
import sys
import time

from runs import OFTEN, PATIENCE, RESTART, compare, fail, scenes, wait

# --- full disks


def limit_table(runs, name, process):
    """Lets no file of the ranks grow beyond what the table has, and a little more."""
    room = runs.path(name, "transient.csv.part").stat().st_size + 20000
    for rank in runs.ranks(name, process):
        resource.prlimit(rank, resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))


def occupy(runs, name, file):
    """Puts a link in place of the file that is to be written, once it is not being written."""
    while True:
        try:
            runs.path(name, f"{file}.part").symlink_to("/dev/full")
            return
        except FileExistsError:
            time.sleep(0.0005)


def check_full(runs):
    """A row of the table finds no room, or the name of a checkpoint or a snapshot is a link: one line; the last checkpoint serves, with
    more."""
    for file in ("transient.csv", "checkpoint.bin", "snapshot_000012.h5"):
        name = f"full_{file.split('.')[0]}"
        process = runs.start(name, "-dynamics_checkpoint_interval", str(OFTEN))
        wait(process, lambda: runs.path(name, "checkpoint.bin").exists())
        if file == "transient.csv":
            table = runs.path(name, "transient.csv.part")
            wait(process, lambda: table.stat().st_size > 200000)  # more than a checkpoint has
            limit_table(runs, name, process)
        else:
            occupy(runs, name, file)
        stderr = process.communicate(timeout=PATIENCE)[1]
        lines = [line for line in stderr.splitlines() if line.startswith("squeal:")]
        if not process.returncode or len(lines) != 1 or f"cannot write {runs.path(name, file)}" not in lines[0]:
            fail(f"{runs.scene}: no room for {file}: exit status {process.returncode}: {stderr}")
        if file != "transient.csv":
            runs.path(name, f"{file}.part").unlink()
        runs.complete(name, "-dynamics_checkpoint_interval", str(OFTEN), RESTART)
        compare(runs, "undisturbed", name)
    print(f"{runs.scene}: no room for a row, no place for a checkpoint or a snapshot, gone on with it: bitwise the same", flush=True)


# --- signals


def ask(runs, name, number, whom, *options):
    """Asks a run to stop; what it says."""
    process = runs.start(name, *options)
    sign = runs.path(name, "transient.csv.part")
    wait(process, lambda: sign.exists() and sign.stat().st_size > 100000)
    os.kill(process.pid if whom == "launcher" else runs.ranks(name, process)[0], number)
    stderr = process.communicate(timeout=PATIENCE)[1]
    lines = [line for line in stderr.splitlines() if line.startswith("squeal:")]
    if not process.returncode or len(lines) != 1 or "stopped by a signal after step" not in lines[0]:
        fail(f"{runs.scene}: {signal.Signals(number).name} to the {whom}: exit status {process.returncode}: {stderr}")
    return lines[0]


def check_signals(runs):
    """One rank is asked, all stop at one step, with a checkpoint from which the run goes on; where none were asked for,
    also with the rows so far."""
    cases = [(signal.SIGUSR1, "launcher"), (signal.SIGINT, "rank"), (signal.SIGTERM, "rank")]
    for i, (number, whom) in enumerate(cases):
        line = ask(runs, f"stopped_{i}", number, whom, "-dynamics_checkpoint_interval", "1000000000")
        if "-dynamics_restart goes on from there" not in line or runs.path(f"stopped_{i}", "transient.csv").exists():
            fail(f"{runs.scene}: stopped with a checkpoint: {line}")
    for i in range(len(cases)):
        runs.complete(f"stopped_{i}", RESTART)
        compare(runs, "undisturbed", f"stopped_{i}")
    line = ask(runs, "cut", signal.SIGUSR1, "launcher")
    rows = runs.path("cut", "transient.csv").read_bytes()
    if "transient.csv holds the rows until then" not in line or "-dynamics_restart goes on from there" not in line:
        fail(f"{runs.scene}: stopped without a checkpoint: {line}")
    if len(rows) < 50000 or not runs.path("undisturbed", "transient.csv").read_bytes().startswith(rows):
        fail(f"{runs.scene}: stopped without a checkpoint: the rows are not the first ones of the whole run")
    runs.complete("cut", RESTART)
    compare(runs, "undisturbed", "cut")
    names = ", ".join(number.name for number, _ in cases)
    print(f"{runs.scene}: stopped by {names}, gone on: bitwise the same", flush=True)


def check(runs, _):
    runs.complete("undisturbed")
    check_full(runs)
    check_signals(runs)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # else what nohup and & ignore, the runs ignore too
    sys.exit(scenes(__doc__, check))
