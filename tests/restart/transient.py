#!/usr/bin/env python3
"""A run of explicit dynamics that is killed at random moments, also while it writes a checkpoint, stopped by signals, or
out of room on the disk, and goes on each time from its last checkpoint, ends with the tables and fields of a run that
nobody disturbed, to the last bit: of a brake whose pad chatters, on a mesh that stays and on one that turns, with central
differences and the dissipative scheme. Breaks when something that the next step or the next row depends on is not kept,
is kept at another moment than the rest, a row is written twice or lost, or a checkpoint that is not whole, or of another
run, is taken."""

import argparse
import csv
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py

SOURCE = Path(__file__).resolve().parents[2]
SMALL = """
rig: {disc: {elements: "4,24,1"}, pad: {elements: "4,4,2"}, beam: {elements: 5}}
pad: {young: 39.8e9}
loads: press
press: {ramp: 2e-4}
impulses: tap
tap: {time: 3e-4, impulse: "0,0,-1e-3"}
motions: nudge
nudge: {set: beam_top, displacement: "0,1e-7,0", directions: y, ramp: 5e-4}
contact: {speed: 0.02}
dynamics: {history_interval: 1e-6, pairs_interval: 1e-5, snapshot_interval: 2e-4, live: 0}
"""
TURNS = "-contact_kinematics turning -contact_slip 0,0,0 -contact_speed 0 -contact_rotation 0,0,-2 -contact_mu 0.9" \
        " -dynamics_gravity 0,-9.81,0 -dynamics_coriolis -dynamics_centrifugal"
SCENES = {
    "stays": "-contact_ramp 1e-3 -ts_central_b 0.5",
    "stays dissipative": "-contact_ramp 1e-3 -ts_central_b 0.8",
    "turns": TURNS,
    "turns dissipative": TURNS + " -ts_central_b 0.8",
}
TABLES = ("transient.csv", "contact_pairs.csv", "transient.xmf")
RESTART = "-dynamics_restart"
OFTEN = 200  # steps between checkpoints
PATIENCE = 60  # seconds


def fail(message):
    raise SystemExit(f"FAILED: {message}")


class Runs:
    """Runs of one scene, each in a folder of its own."""

    def __init__(self, arguments, folder, scene):
        self.arguments, self.folder, self.scene = arguments, folder, scene

    def command(self, name, *options):
        (self.folder / "small.yaml").write_text(SMALL)
        return [self.arguments.launcher, "-n", str(self.arguments.ranks), self.arguments.squeal, "-options_file",
                SOURCE / "options/massi2005_transient.yaml", "-options_file", self.folder / "small.yaml",
                *SCENES[self.scene].split(), "-output_dir", self.folder / name, "-ts_max_time", str(self.arguments.end),
                *options]

    def start(self, name, *options):
        return subprocess.Popen(self.command(name, *options), start_new_session=True, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def complete(self, name, *options):
        """Runs to the end; seconds that it took."""
        begun = time.monotonic()
        process = self.start(name, *options)
        stderr = process.communicate(timeout=PATIENCE)[1]
        if process.returncode:
            fail(f"{self.scene}, {name}: exit status {process.returncode}: {stderr}")
        return time.monotonic() - begun

    def path(self, name, file):
        return self.folder / name / file


# --- what is equal


def arrays(path):
    """All datasets of a file, as bytes."""
    with h5py.File(path) as file:
        keys = []
        file.visit(keys.append)
        found = {key: file[key][()].tobytes() for key in keys if isinstance(file[key], h5py.Dataset)}
    return found


def compare(runs, one, other):
    """Tables by bytes, fields by the bytes of their values; nothing temporary is left."""
    for table in TABLES:
        if runs.path(one, table).read_bytes() != runs.path(other, table).read_bytes():
            difference = first_difference(runs, one, other, table)
            fail(f"{runs.scene}: {table} of {other} differs from that of {one}: {difference}")
    frames = [sorted(path.name for path in (runs.folder / name).glob("snapshot_*.h5")) for name in (one, other)]
    if frames[0] != frames[1] or len(frames[0]) < 3:
        fail(f"{runs.scene}: snapshots {frames[1]} of {other}, {frames[0]} of {one}")
    for frame in frames[0]:
        if arrays(runs.path(one, frame)) != arrays(runs.path(other, frame)):
            fail(f"{runs.scene}: values in {frame} of {other} differ from those of {one}")
    left = [path.name for path in (runs.folder / other).glob("*.part")]
    if left:
        fail(f"{runs.scene}: {' '.join(left)} left behind in {other}")


def first_difference(runs, one, other, table):
    """Column and cells of the first row that differs."""
    rows = [list(csv.reader(runs.path(name, table).open(newline=""))) for name in (one, other)]
    for row in zip(*rows):
        for column, cells in enumerate(zip(*row)):
            if cells[0] != cells[1]:
                return f"{rows[0][0][column]} {cells[1]} instead of {cells[0]} at {row[0][0]} s"
    return f"{len(rows[1])} rows instead of {len(rows[0])}"


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


def ranks_of(folder):
    """Processes that write to a folder: ranks and launcher."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if str(folder).encode() in entry.read_bytes().split(b"\0"):
                found.append(int(entry.parent.name))
        except OSError:
            pass  # ended meanwhile
    return found


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


def stamp(path):
    """What tells two checkpoints apart, None without one."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_mtime_ns


def wait(process, happened):
    """Waits until something happened; whether it did before the process ended."""
    begun = time.monotonic()
    while not happened():
        if process.poll() is not None:
            return False
        if time.monotonic() - begun > PATIENCE:
            fail("nothing happened")
        time.sleep(0.001)
    return True


def time_at(path):
    """Simulated time of the last whole row, s."""
    rows = path.read_text().splitlines()[1:-1] if path.exists() else []
    return float(rows[-1].split(",")[0]) if rows else 0.0


def go_on(runs, name):
    """The option of a restart, if there is what to go on from."""
    return [RESTART] if runs.path(name, "checkpoint.bin").exists() else []


def kill_once(runs, name, interval, delay, of_checkpoint):
    """Starts or goes on, waits for a sign of life and then for `delay` seconds, and kills. What the kill met: time of the
    last row, and whether a checkpoint was being written; None when the run was over before."""
    sign = runs.path(name, "checkpoint.bin" if of_checkpoint else "transient.csv.part")
    before = stamp(sign)
    process = runs.start(name, "-dynamics_checkpoint_interval", str(interval), *go_on(runs, name))
    met = wait(process, lambda: stamp(sign) != before)
    time.sleep(delay)
    if not met or process.poll() is not None:
        stderr = process.communicate()[1]
        if process.returncode:
            fail(f"{runs.scene}: restart in {name}: {stderr}")
        return None
    kill(runs, name, process)
    if runs.path(name, "transient.csv").exists() and not runs.path(name, "transient.csv.part").exists():
        return None
    return time_at(runs.path(name, "transient.csv.part")), runs.path(name, "checkpoint.bin.part").exists()


def kill_often(runs, name, chance, n, interval, longest):
    """Kills n times, or until the run is over; the moments."""
    moments = []
    for i in range(n):
        met = kill_once(runs, name, interval, chance.uniform(0, longest), i > 0)
        if met is None:
            break
        moments.append(met)
    return moments


def check_kills(runs, chance):
    """At random moments; then with a checkpoint every few steps, until one was cut off while it was written."""
    seconds = runs.complete("undisturbed")
    n = changes(runs.path("undisturbed", "contact_pairs.csv"))
    if n < 100:
        fail(f"{runs.scene}: only {n} changes of status")
    moments = kill_often(runs, "killed", chance, 5, OFTEN, 0.25 * seconds)
    runs.complete("killed", "-dynamics_checkpoint_interval", str(OFTEN), *go_on(runs, "killed"))
    compare(runs, "undisturbed", "killed")
    if len(moments) < 2 or len({moment for moment, _ in moments}) < 2:
        fail(f"{runs.scene}: {len(moments)} kills came before the end")
    torn = sum(cut for _, cut in moments)
    print(f"{runs.scene}: {n} changes of status, killed at {', '.join(f'{1e3 * moment:.4g}' for moment, _ in moments)} ms,"
          f" {torn} within a checkpoint: bitwise the same", flush=True)


def check_torn(runs, chance):
    """Kills while checkpoints are written, one every other step."""
    torn = 0
    tries = 0
    while torn < 2 and tries < 12:
        met = kill_once(runs, "torn", 2, chance.uniform(0, 0.05), True)
        if met is None:
            break
        torn += met[1]
        tries += 1
    runs.complete("torn", "-dynamics_checkpoint_interval", str(OFTEN), *go_on(runs, "torn"))
    compare(runs, "undisturbed", "torn")
    if not torn:
        fail(f"{runs.scene}: none of {tries} kills met a checkpoint that was being written")
    print(f"{runs.scene}: {torn} of {tries} kills met a checkpoint that was being written: bitwise the same", flush=True)


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
    """Without the option a run starts anew, and what is there of an earlier one, of another load, has no effect: neither now
    nor on a later restart."""
    runs.complete("anew", "-press_force", "0,0,-50", "-dynamics_checkpoint_interval", str(OFTEN))
    other = runs.path("anew", "transient.csv").read_bytes()
    if other == runs.path("undisturbed", "transient.csv").read_bytes():
        fail(f"{runs.scene}: another load has no effect")
    runs.complete("anew")
    compare(runs, "undisturbed", "anew")
    process = runs.start("anew", RESTART)
    stderr = process.communicate(timeout=PATIENCE)[1]
    if not process.returncode or "there is no checkpoint.bin" not in stderr:
        fail(f"{runs.scene}: took up the checkpoint of the run before the last: {stderr}")
    print(f"{runs.scene}: started anew beside another run's checkpoint: bitwise the same", flush=True)


# --- what is refused


def refuse(runs, name, expected, *options):
    """A restart that must fail with one line, and leave the checkpoint as it is."""
    before = runs.path(name, "checkpoint.bin").read_bytes()
    process = runs.start(name, RESTART, *options)
    stderr = process.communicate(timeout=PATIENCE)[1]
    lines = [line for line in stderr.splitlines() if line.startswith("squeal:")]
    if not process.returncode or len(lines) != 1 or expected not in lines[0]:
        fail(f"{runs.scene}: restart with {' '.join(options)}: exit status {process.returncode}: {stderr}")
    if runs.path(name, "checkpoint.bin").read_bytes() != before:
        fail(f"{runs.scene}: a restart that was refused changed the checkpoint")


def check_refused(runs):
    """Another model, load, step, kinematics, number of ranks, and a file that is cut short; last of all the right one."""
    name, other = "refused", "is of another model or other parameters: "
    runs.complete(name, "-ts_max_time", "1e-3", "-dynamics_checkpoint_interval", str(OFTEN))
    refuse(runs, name, other, "-pad_young", "20e9")
    refuse(runs, name, other, "-press_force", "0,0,-50")
    refuse(runs, name, other, "-tap_time", "2e-3")
    refuse(runs, name, other, "-contact_delay", "1e-3")
    refuse(runs, name, "-ts_dt 1e-07 is another step than that of the run", "-ts_dt", "1e-7")
    ranks = runs.arguments.ranks
    runs.arguments.ranks = 3 - ranks
    refuse(runs, name, f"was written by {ranks} rank{'s' * (ranks > 1)}, this run has {3 - ranks}")
    runs.arguments.ranks = ranks
    file = runs.path(name, "checkpoint.bin")
    whole = file.read_bytes()
    file.write_bytes(whole[:-1])
    refuse(runs, name, "is truncated")
    file.write_bytes(whole)
    runs.complete(name, RESTART)
    compare(runs, "undisturbed", name)
    print(f"{runs.scene}: seven restarts refused, then gone on: bitwise the same", flush=True)


# --- full disks


def limit_table(runs, name, process):
    """Lets no file of the ranks grow beyond what the table has, and a little more."""
    room = runs.path(name, "transient.csv.part").stat().st_size + 20000
    for rank in ranks_of(runs.folder / name):
        if rank != process.pid:
            resource.prlimit(rank, resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))


def fill(runs, name, file):
    """Puts a full disk in place of the file that is to be written, once it is not being written."""
    while True:
        try:
            runs.path(name, f"{file}.part").symlink_to("/dev/full")
            return
        except FileExistsError:
            time.sleep(0.0005)


def check_full(runs):
    """A row of the table, a checkpoint or a snapshot finds no room: one line; the last checkpoint serves, with more."""
    for file in ("transient.csv", "checkpoint.bin", "snapshot_000012.h5"):
        name = f"full_{file.split('.')[0]}"
        process = runs.start(name, "-dynamics_checkpoint_interval", str(OFTEN))
        wait(process, lambda: runs.path(name, "checkpoint.bin").exists())
        if file == "transient.csv":
            table = runs.path(name, "transient.csv.part")
            wait(process, lambda: table.stat().st_size > 200000)  # more than a checkpoint has
            limit_table(runs, name, process)
        else:
            fill(runs, name, file)
        stderr = process.communicate(timeout=PATIENCE)[1]
        lines = [line for line in stderr.splitlines() if line.startswith("squeal:")]
        if not process.returncode or len(lines) != 1 or f"cannot write {runs.path(name, file)}: " not in lines[0]:
            fail(f"{runs.scene}: no room for {file}: exit status {process.returncode}: {stderr}")
        runs.complete(name, "-dynamics_checkpoint_interval", str(OFTEN), RESTART)
        compare(runs, "undisturbed", name)
    print(f"{runs.scene}: no room for a row, a checkpoint, a snapshot, gone on with more: bitwise the same", flush=True)


# --- signals


def ask(runs, name, number, whom, *options):
    """Asks a run to stop; what it says."""
    process = runs.start(name, *options)
    sign = runs.path(name, "transient.csv.part")
    wait(process, lambda: sign.exists() and sign.stat().st_size > 100000)
    ranks = [rank for rank in ranks_of(runs.folder / name) if rank != process.pid]
    os.kill(process.pid if whom == "launcher" else ranks[0], number)
    stderr = process.communicate(timeout=PATIENCE)[1]
    lines = [line for line in stderr.splitlines() if line.startswith("squeal:")]
    if not process.returncode or len(lines) != 1 or "stopped by a signal after step" not in lines[0]:
        fail(f"{runs.scene}: {signal.Signals(number).name} to the {whom}: exit status {process.returncode}: {stderr}")
    return lines[0]


def check_signals(runs):
    """One rank is asked, all stop at one step: with a checkpoint, from which the run goes on; or with the rows so far."""
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
    if "transient.csv holds the rows until then" not in line or runs.path("cut", "checkpoint.bin").exists():
        fail(f"{runs.scene}: stopped without a checkpoint: {line}")
    if len(rows) < 50000 or not runs.path("undisturbed", "transient.csv").read_bytes().startswith(rows):
        fail(f"{runs.scene}: stopped without a checkpoint: the rows are not the first ones of the whole run")
    print(f"{runs.scene}: stopped by {', '.join(number.name for number, _ in cases)}, gone on: bitwise the same", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6))
    parser.add_argument("--end", type=float, default=3e-3, help="simulated time, s")
    parser.add_argument("--scene", action="append", choices=SCENES, help="instead of all")
    arguments = parser.parse_args()
    arguments.squeal = str(Path(arguments.squeal).resolve())
    print(f"seed {arguments.seed}", flush=True)
    chance = random.Random(arguments.seed)
    scenes = arguments.scene or list(SCENES)
    for scene in scenes:
        with tempfile.TemporaryDirectory(prefix="squeal-") as name:
            runs = Runs(arguments, Path(name), scene)
            check_kills(runs, chance)
            if scene == scenes[-1]:
                check_torn(runs, chance)
                check_longer(runs)
                check_full(runs)
            if scene == scenes[0]:
                check_signals(runs)
                check_refused(runs)
                check_anew(runs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
