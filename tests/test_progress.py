#!/usr/bin/env python3
"""What a run prints: all of it in the log file too, the stage and the time left on stderr where asked for or on a
terminal, the end by ^C or of a killed rank. Breaks when a stage or a long loop is silent, when progress gets into the log or stays on
the screen, when the log misses an error, when ^C leaves a trace or half a file, or when nothing says which rank was killed.

    test_progress.py SQUEAL LAUNCHER"""

import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from processes import processes_naming
from served import own_words

OPTIONS = Path(__file__).resolve().parents[1] / "options"
COARSE = "-rig_disc_elements 6,12,1 -rig_pad_elements 3,3,2 -rig_beam_elements 4 -modes_band 1000,8000".split()
MEDIUM = "-rig_disc_elements 24,96,3 -rig_pad_elements 10,10,10 -modes_band 0,20000".split()  # some seconds
MANY = [*MEDIUM[:-1], "0,60000"]  # some ten seconds of solutions
SCENE = ["-options_file", OPTIONS / "massi2005.yaml"]
PATIENCE = 240  # seconds


class Runner:
    def __init__(self, squeal, launcher, folder):
        self.squeal, self.launcher, self.folder, self.faults = squeal, launcher, folder, []

    def run(self, *options):
        return subprocess.run([self.squeal, *SCENE, *options], capture_output=True, text=True, cwd=self.folder)

    def check_stop(self, process, number, name):
        """Sends the signal: one line, the exit status of a shell's 128 + number, no file under a final name but scene.yaml."""
        process.send_signal(number)
        rest = process.communicate(timeout=PATIENCE)[1]
        said = [line for line in rest.splitlines() if line.startswith("squeal") or "PETSC" in line]
        sign = signal.Signals(number).name
        self.check(process.returncode == -number and said == [STOPPED.format(sign)], f"{sign} ends it with a line", rest)
        left = [path.name for path in (self.folder / name).iterdir() if path.suffix != ".part"]
        self.check(left == ["scene.yaml"], f"{sign} leaves the scene and no half file {left}")

    def check(self, holds, what, text=""):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)
            print(text)


STOPPED = "squeal: error: stopped by {}; nothing was finished; scene.yaml repeats the run"
FIRST = "# Log of squeal: all that it printed\n"


def check_log(r):
    for name, text in (("victim.yaml", "parts: disc\n"), ("table.csv", "a,b")):
        (r.folder / name).write_text(text)
        done = r.run(*COARSE, "-squeal_log", name)
        r.check(done.returncode and re.fullmatch(rf"squeal: error: -squeal_log {name} would replace .*\n", done.stderr)
                and (r.folder / name).read_text() == text, f"a log never replaces {name}", done.stderr)
    for option in ("-squeal_log", "-log_file"):
        done = r.run(*COARSE, "-squeal_view", option, "all.txt")
        log = (r.folder / "all.txt").read_text()
        r.check(done.returncode == 0 and done.stdout and log == FIRST + done.stdout + done.stderr, f"{option} holds what is printed", log)
    done = r.run(*COARSE, "-pad_young", "-1", "-squeal_log", "all.txt")
    r.check(done.stderr and (r.folder / "all.txt").read_text() == FIRST + done.stderr, "the log holds the error", done.stderr)
    done = r.run(*COARSE, "-squeal_log", "victim.yaml/all.txt")
    r.check(done.returncode and re.fullmatch(r"squeal: error: .*-squeal_log victim.yaml/all.txt: Not a directory.*\n", done.stderr),
            "a log that cannot be written is an error", done.stderr)
    done = r.run(*COARSE, "-output_dir", "new/results", "-squeal_log", "new/results/run.log")
    r.check(done.returncode == 0 and (r.folder / "new/results/run.log").read_text() == FIRST + done.stdout,
            "a log in the folder of the results, which the run makes", done.stderr)


def check_stages(r):
    done = r.run(*COARSE, "-squeal_progress", "1", "-squeal_log", "all.txt")
    stages = re.findall(r"^(\w+) after \d+ s$", done.stderr, re.MULTILINE)
    r.check({"Model", "Contact", "Operators", "Modes", "Results"} <= set(stages), f"stages on stderr: {stages}", done.stderr)
    r.check(r.run(*COARSE).stderr == "", "nothing on stderr where it is no terminal", "")
    master, slave = pty.openpty()
    process = subprocess.Popen([r.squeal, *SCENE, *COARSE], cwd=r.folder, stdout=slave, stderr=slave)
    process.wait()
    os.close(slave)
    text = b""
    while True:
        try:
            piece = os.read(master, 4096)
        except OSError:
            break
        text += piece
    shown = re.sub(r"[^\n]*\r(?!\n)", "", text.decode().replace("\r\n", "\n"))  # what is written over is gone
    r.check(b"\rModes" in text and "Modes  " not in shown and shown.startswith("mode "), "on a terminal the line goes", shown)


def check_left_and_interrupt(r):
    """The time left within a loop of the eigensolver, then ^C."""
    process = subprocess.Popen([r.squeal, *SCENE, *MANY, "-squeal_progress", "1", "-output_dir", "long"],
                               cwd=r.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    lines, begun = [], time.time()
    while time.time() - begun < PATIENCE and not (lines and "left" in lines[-1]):
        lines.append(process.stderr.readline())
        if not lines[-1]:
            break
    r.check(re.fullmatch(r"(right and left|right|left) vectors: \d+ of about \d+, \d+ s left\n", lines[-1]),
            "time left of a loop", "".join(lines))
    r.check_stop(process, signal.SIGINT, "long")


def check_stop_in_statics(r):
    """SIGTERM while the equilibrium is sought."""
    process = subprocess.Popen([r.squeal, *SCENE, "-analysis", "static", "-rig_disc_elements", "16,96,2", "-rig_pad_elements",
                                "12,12,2", "-squeal_progress", "1", "-output_dir", "statics"],
                               cwd=r.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (line := process.stderr.readline()).startswith("Statics"):
        if not line:
            break
    r.check_stop(process, signal.SIGTERM, "statics")


def check_stop_on_ranks(r):
    """mpirun asks all ranks; one speaks, in the log too, which is where it is read of Open MPI 5: its mpirun passes nothing on any more
    after ^C."""
    environment = {**os.environ, "OMPI_MCA_odls_base_sigkill_timeout": "2"}
    process = subprocess.Popen([r.launcher, "-n", "2", r.squeal, *SCENE, *MEDIUM, "-squeal_progress", "1",
                                "-squeal_log", "ranks.log", "-output_dir", "ranks"], cwd=r.folder, env=environment,
                                stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (line := process.stderr.readline()).startswith("Modes"):
        if not line:
            break
    process.send_signal(signal.SIGINT)
    rest = process.communicate(timeout=PATIENCE)[1]
    said, logged = ([line for line in text.splitlines() if line.startswith("squeal: error")]
                    for text in (rest, (r.folder / "ranks.log").read_text()))
    version = subprocess.run([r.launcher, "--version"], capture_output=True, text=True).stdout
    silent = not re.search(r"Open MPI\) 4\.", version)
    r.check(process.returncode and logged == [STOPPED.format("SIGTERM")] and (said == logged or silent and not said),
            "^C of mpirun: one rank says so", f"{rest}\n{logged}\n{version}")


def check_killed_rank(r):
    """One rank of two is killed, by the system or for its time: one line, the launcher's status, nothing left behind."""
    for number, rank in ((signal.SIGKILL, 1), (signal.SIGXCPU, 0)):
        name = f"killed{rank}"
        process = subprocess.Popen([r.launcher, "-n", "2", r.squeal, *SCENE, *MEDIUM, "-squeal_progress", "1", "-output_dir", name],
                                   cwd=r.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while (line := process.stderr.readline()) and not line.startswith("Modes"):
            continue
        mine = f"OMPI_COMM_WORLD_RANK={rank}".encode()
        found = [n for n in processes_naming(name) if mine in Path(f"/proc/{n}/environ").read_bytes().split(b"\0")]
        os.kill(max(found), number)  # the younger of two: the other one watches it
        rest = process.communicate(timeout=PATIENCE)[1]
        said = [line for line in own_words(rest).splitlines() if line.startswith("squeal: error")]
        cause = ", by the system where memory has run out, or by hand" if number == signal.SIGKILL else ""
        wanted = f"squeal: error: rank {rank} was killed by {signal.Signals(number).name}{cause}; files in {name} that bear their " \
            "final name are complete"
        # mpirun of Open MPI 5 leaves the other rank the time to say that it is stopped
        own = [line for line in said if "stopped by SIGTERM" not in line]
        r.check(len(found) == 2 and process.returncode == 128 + number and own == [wanted] and len(said) <= 2,
                f"rank {rank} killed by {number}",
                f"{found} {process.returncode} {rest}")
        begun = time.monotonic()
        while processes_naming(name) and time.monotonic() - begun < PATIENCE:
            time.sleep(0.01)
        r.check(not processes_naming(name), "no rank is left")


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # else what nohup and & ignore, the runs ignore too
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        r = Runner(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), Path(folder))
        check_log(r)
        check_stages(r)
        check_left_and_interrupt(r)
        check_stop_in_statics(r)
        check_stop_on_ranks(r)
        check_killed_rank(r)
    if r.faults:
        print(f"{len(r.faults)} failed: {'; '.join(r.faults)}")
    return 1 if r.faults else 0


if __name__ == "__main__":
    sys.exit(main())
