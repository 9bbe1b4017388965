"""What the tests of restarts in time share: scenes, runs in folders of their own, what must be equal, and waiting for
the processes of a run."""

import argparse
import csv
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py

sys.path.append(str(Path(__file__).resolve().parents[1]))
from processes import processes  # noqa: E402
from served import RENAME, SYNC, WRITE, killed_at, outcome_of, starter  # noqa: E402, F401, for the tests

SOURCE = Path(__file__).resolve().parents[2]
SMALL = """
rig: {disc: {elements: "4,24,1"}, pad: {elements: "4,4,2"}, beam: {elements: 5}}
pad: {young: 39.8e9}
loads: press
press: {ramp: 2e-4}
impulses: tap
tap: {time: 3e-4, impulse: "0,0,-1e-3"}
circles: rim
rim: {radius: 0.12, count: 12}
motions: nudge
nudge: {set: beam_top, displacement: "0,1e-7,0", directions: y, ramp: 5e-4}
contact: {speed: 0.02}
dynamics: {history_interval: 1e-6, pairs_interval: 1e-5, snapshot_interval: 2e-4, live: 0}
"""
TURNS = "-contact_kinematics turning -contact_slip 0,0,0 -contact_speed 0 -contact_rotation 0,0,-2 -contact_mu 0.9" \
        " -model_gravity 0,-9.81,0 -dynamics_coriolis -dynamics_centrifugal"
SCENES = {
    "stays": "-contact_ramp 1e-3 -ts_central_b 0.5",
    "stays watched": "-contact_ramp 1e-3 -ts_central_b 0.5",
    "stays dissipative": "-contact_ramp 1e-3 -ts_central_b 0.8 -contact_mu_slope -5",
    "turns": TURNS,
    "turns dissipative": TURNS + " -ts_central_b 0.8",
}
WATCHED = ("stays watched",)  # scenes with amplitudes of modes
TABLES = ("transient.csv", "contact_pairs.csv", "circles.csv", "impulses.csv", "transient.xmf")
RESTART = "-dynamics_restart"
OFTEN = 200  # steps between checkpoints
PATIENCE = 240  # seconds


def fail(message):
    raise SystemExit(f"FAILED: {message}")


class Runs:
    """Runs of one scene, each in a folder of its own."""

    def __init__(self, arguments, folder, scene, program):
        self.arguments, self.folder, self.scene, self.program = arguments, folder, scene, program

    def command(self, name, *options):
        (self.folder / "small.yaml").write_text(SMALL)
        return [self.arguments.launcher, "-n", str(self.arguments.ranks), self.arguments.squeal, "-options_file",
                SOURCE / "options/massi2005_transient.yaml", "-options_file", self.folder / "small.yaml",
                *SCENES[self.scene].split(), "-output_dir", self.folder / name, "-ts_max_time", str(self.arguments.end),
                *(self.watch("1,2") if self.scene in WATCHED else ()), *options]

    def watch(self, modes):
        """Options that record the amplitudes of some modes, whose filters are made once."""
        folder = self.folder / "modes"
        if not folder.exists():
            words = ["-options_file", SOURCE / "options/massi2005_transient.yaml", "-options_file",
                     self.folder / "small.yaml", "-analysis", "modes", "-operators_mass", "lumped", "-modes_filters",
                     "-modes_band", "1000,4000", "-output_dir", folder]
            subprocess.run([self.arguments.launcher, "-n", "1", self.arguments.squeal, *words], check=True,
                           capture_output=True)
        return "-dynamics_filters", folder, "-dynamics_filters_modes", modes

    def start(self, name, *options):
        return subprocess.Popen(self.command(name, *options), start_new_session=True, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def end(self, name, *options):
        """How a run that nobody disturbs ends."""
        return outcome_of(self.program, self.folder, self.command(name, *options)[4:], self.arguments.ranks)

    def complete(self, name, *options):
        """Runs to the end."""
        outcome = self.end(name, *options)
        if outcome.status:
            fail(f"{self.scene}, {name}: exit status {outcome.status}: {outcome.stderr}")

    def path(self, name, file):
        return self.folder / name / file

    def ranks(self, name, process):
        """Processes of a run without its launcher, which one rank has not (scripts/mpirun), and what that starts beside the ranks."""
        programs = dict(processes("cmdline"))
        own = [rank for rank in ranks_of(self.folder / name) if self.arguments.ranks == 1 or rank != process.pid]
        return [rank for rank in own if not programs.get(rank, b"").split(b"\0")[0].endswith(b"sh")]

    def restart(self, name, *options):
        """Tries to go on: exit status, and the lines that complain."""
        outcome = self.end(name, RESTART, *options)
        return outcome.status, [line for line in outcome.stderr.splitlines() if line.startswith("squeal:")]


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
    for table in (*TABLES, "amplitudes.csv") if runs.scene in WATCHED else TABLES:
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


# --- processes


def ranks_of(folder):
    """Processes that write to a folder: ranks and launcher."""
    return [number for number, line in processes("cmdline") if str(folder).encode() in line.split(b"\0")]


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


def scenes(description, check):
    """Calls check(runs, chance) for each scene that the command line names."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6))
    parser.add_argument("--end", type=float, default=3e-3, help="simulated time, s")
    parser.add_argument("--scene", action="append", choices=SCENES, help="instead of all")
    arguments = parser.parse_args()
    arguments.squeal = str(Path(arguments.squeal).resolve())
    print(f"seed {arguments.seed}", flush=True)
    chance, program = random.Random(arguments.seed), starter(arguments.squeal, PATIENCE)
    for scene in arguments.scene or list(SCENES):
        with tempfile.TemporaryDirectory(prefix="squeal-") as name:
            check(Runs(arguments, Path(name), scene, program), chance)
    program.end()
    return 0
