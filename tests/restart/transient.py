#!/usr/bin/env python3
"""A run of explicit dynamics that is killed at random moments, also while it writes a checkpoint, and goes on each
time from its last checkpoint, ends with the tables and fields of a run that nobody disturbed, to the last bit: of a
brake whose pad chatters, on a mesh that stays and on one that turns, with central differences and the dissipative
scheme. Breaks when something that the next step or the next row depends on is not kept, is kept at another moment
than the rest, a row is written twice or lost, or a checkpoint that is not whole, or of another run, is taken."""

import csv
import os
import shutil
import signal
import sys
import time

from runs import OFTEN, PATIENCE, RENAME, RESTART, SYNC, WRITE, compare, fail, killed_at, ranks_of, scenes, wait

TRIES = 5  # of runs, until two kills come before the end


def changes(path):
    """How often a pair changed its status from one state to the next; all of them must have been met."""
    last, n, met = {}, 0, set()
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            n += row["pair"] in last and last[row["pair"]] != row["status"]
            last[row["pair"]] = row["status"]
            met.add(row["status"])
    if met != {"open", "stick", "slip"}:
        fail(f"pairs met only {met}")
    return n


# --- killing


def kill(runs, name, process):
    """Kills launcher and ranks, in one go."""
    for number in ranks_of(runs.folder / name):
        try:
            os.kill(number, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.communicate()
    begun = time.monotonic()
    while ranks_of(runs.folder / name):
        if time.monotonic() - begun > PATIENCE:
            fail("a rank outlived its kill")
        time.sleep(0.005)


def size(path):
    """Of a file, bytes; 0 without one."""
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return 0


def time_at(path):
    """Simulated time of the last whole row, s."""
    rows = path.read_text().splitlines()[1:-1] if path.exists() else []
    return float(rows[-1].split(",")[0]) if rows else 0.0


def go_on(runs, name):
    """The option of a restart, if there is what to go on from."""
    return [RESTART] if runs.path(name, "checkpoint.bin").exists() else []


def kill_once(runs, name, rows):
    """Starts or goes on, and kills when the table has so many bytes of rows. What the kill met: time of the last row, and whether a
    checkpoint was being written; None when the run was over before."""
    process = runs.start(name, "-dynamics_checkpoint_interval", str(OFTEN), *go_on(runs, name))
    met = wait(process, lambda: size(runs.path(name, "transient.csv.part")) >= rows)
    if not met or process.poll() is not None:
        stderr = process.communicate()[1]
        if process.returncode:
            fail(f"{runs.scene}: restart in {name}: {stderr}")
        return None
    kill(runs, name, process)
    if runs.path(name, "transient.csv").exists() and not runs.path(name, "transient.csv.part").exists():
        return None
    return time_at(runs.path(name, "transient.csv.part")), runs.path(name, "checkpoint.bin.part").exists()


def kill_often(runs, name, chance, n):
    """Kills n times, or until the run is over; the moments. A run that was over before it met two begins anew: on a busy machine
    it may end before its rows are seen."""
    whole = size(runs.path("undisturbed", "transient.csv"))
    for _ in range(TRIES):
        moments = []
        for part in sorted(chance.uniform(0.05, 0.85) for _ in range(n)):
            met = kill_once(runs, name, part * whole)
            if met is None:
                break
            moments.append(met)
        if len({moment for moment, _ in moments}) >= 2:
            return moments
        shutil.rmtree(runs.folder / name)
    fail(f"{runs.scene}: in {TRIES} runs kills came after the end")


def check_kills(runs, chance):
    """At random moments."""
    runs.complete("undisturbed")
    n = changes(runs.path("undisturbed", "contact_pairs.csv"))
    if n < 100:
        fail(f"{runs.scene}: only {n} changes of status")
    moments = kill_often(runs, "killed", chance, 3)
    runs.complete("killed", "-dynamics_checkpoint_interval", str(OFTEN), *go_on(runs, "killed"))
    compare(runs, "undisturbed", "killed")
    torn = sum(cut for _, cut in moments)
    times = ", ".join(f"{1e3 * moment:.4g}" for moment, _ in moments)
    print(f"{runs.scene}: {n} changes of status, killed at {times} ms,"
          f" {torn} within a checkpoint: bitwise the same", flush=True)


def check_torn(runs, chance):
    """Kills while checkpoints are written, one every other step: before a random call that writes, flushes or renames one."""
    for _ in range(2):
        command = runs.command("torn", "-dynamics_checkpoint_interval", "2", *go_on(runs, "torn"))
        at = chance.randrange(40, 400)
        if not killed_at(command, runs.path("torn", "checkpoint.bin"), calls=WRITE | SYNC | RENAME, at=at):
            fail(f"{runs.scene}: no kill at call {at} on checkpoints")
        if not runs.path("torn", "checkpoint.bin").exists() or not runs.path("torn", "checkpoint.bin.part").exists():
            fail(f"{runs.scene}: the kill at call {at} did not leave a checkpoint and part of the next one")
    runs.complete("torn", "-dynamics_checkpoint_interval", str(OFTEN), *go_on(runs, "torn"))
    compare(runs, "undisturbed", "torn")
    print(f"{runs.scene}: killed twice while a checkpoint was being written: bitwise the same", flush=True)


# --- going on


def check_longer(runs):
    """A run that is over goes on to a later end; its last row, of a shorter run, is taken back."""
    short = str(0.4371 * runs.arguments.end)
    runs.complete("longer", "-ts_max_time", short, "-dynamics_checkpoint_interval", str(OFTEN))
    shorter = runs.path("longer", "transient.csv").read_bytes()
    runs.complete("longer", "-ts_max_time", short, RESTART)
    if runs.path("longer", "transient.csv").read_bytes() != shorter:
        fail(f"{runs.scene}: a run that is over, taken up with the same end, has another table")
    runs.complete("longer", RESTART)
    compare(runs, "undisturbed", "longer")
    print(f"{runs.scene}: taken up after its end, and again with a later one: bitwise the same", flush=True)


def check_anew(runs):
    """Without the option a run starts anew, and what is there of an earlier one, of another load, has no effect:
    neither now nor on a later restart."""
    runs.complete("anew", "-press_force", "0,0,-50", "-dynamics_checkpoint_interval", str(OFTEN))
    other = runs.path("anew", "transient.csv").read_bytes()
    if other == runs.path("undisturbed", "transient.csv").read_bytes():
        fail(f"{runs.scene}: another load has no effect")
    runs.complete("anew")
    compare(runs, "undisturbed", "anew")
    status, lines = runs.restart("anew")
    if not status or len(lines) != 1 or "there is no checkpoint.bin" not in lines[0]:
        fail(f"{runs.scene}: took up the checkpoint of the run before the last: {lines}")
    print(f"{runs.scene}: started anew beside another run's checkpoint: bitwise the same", flush=True)


def check(runs, chance):
    check_kills(runs, chance)
    check_torn(runs, chance)
    check_longer(runs)
    check_anew(runs)


if __name__ == "__main__":
    sys.exit(scenes(__doc__, check))
