"""Runs of a small brake in time, made to be killed: their scenes, how they are started, watched and killed, and whether
two of them ended alike to the last bit."""

import csv
import os
import signal
import subprocess
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
