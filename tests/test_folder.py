#!/usr/bin/env python3
"""What lies in the folder of results, who else writes there, and where nobody reads what is printed. Breaks when a run waits for a pipe,
writes through a link, mixes its rows with another run's, is kept from a folder by one that was killed, follows options that lie beside
a matrix or in the environment without a word, needs /dev/shm or locks of the file system, or leaves no files since `head` had enough.

    test_folder.py SQUEAL MPIRUN LIBFAULT"""

import fcntl
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from served import own_words

SOURCE = Path(__file__).resolve().parents[1]
SMALL = ["-options_file", SOURCE / "options/massi2005.yaml", "-rig_disc_elements", "4,24,1", "-rig_pad_elements", "2,2,1",
         "-rig_beam_elements", "3", "-modes_band", "500,2000"]
LONG = ["-options_file", SOURCE / "options/massi2005_transient.yaml", "-rig_disc_elements", "4,24,1", "-rig_pad_elements", "2,2,1",
        "-rig_beam_elements", "3", "-ts_max_time", "10", "-dynamics_live", "0"]
WRITTEN = ["modes.csv", "modes.h5", "modes.xmf", "modes_causes.csv", "scene.yaml"]
LIMIT = 60  # seconds for runs of less than one


class Runner:
    """Runs squeal in a folder of its own and keeps what is wrong."""

    def __init__(self, squeal, mpirun, library, folder):
        self.squeal, self.mpirun, self.library, self.folder, self.faults = squeal, mpirun, library, folder, []

    def command(self, *options, ranks=1):
        return [self.mpirun, "-n", str(ranks), self.squeal, *options]

    def run(self, *options, ranks=1, before=(), more=None):
        return subprocess.run([*before, *self.command(*options, ranks=ranks)], capture_output=True, text=True, cwd=self.folder,
                              timeout=LIMIT, env={**os.environ, **(more or {})})

    def fresh(self, name="out"):
        shutil.rmtree(self.folder / name, ignore_errors=True)
        (self.folder / name).mkdir()
        return self.folder / name

    def files(self, name="out"):
        return sorted(path.name for path in (self.folder / name).iterdir())

    def check(self, holds, what, done=None):
        print("ok  " if holds else "FAIL", what, flush=True)
        if not holds:
            self.faults.append(what)
            print(done.stdout + done.stderr if done else "")

    def refused(self, done, words, what):
        """One line on stderr with the words, and a status that is not 0."""
        lines = own_words(done.stderr).split("\n")
        lines = [line for line in lines if line]
        self.check(done.returncode == 1 and len(lines) == 1 and all(word in lines[0] for word in words), what, done)


def check_names(r):
    """Pipes and links under the names of files."""
    for ranks in (1, 2):
        os.mkfifo(r.fresh() / "scene.yaml")
        r.refused(r.run(*SMALL, "-output_dir", "out", ranks=ranks), ["out/scene.yaml", "no regular file"],
                  f"a pipe scene.yaml, {ranks} ranks")
    (r.folder / "precious").write_text("mine")
    for name in ("modes.csv.part", "modes.h5.part", "scene.yaml.part"):
        (r.fresh() / name).symlink_to(r.folder / "precious")
        done = r.run(*SMALL, "-output_dir", "out", ranks=1 + (name == "modes.h5.part"))
        r.refused(done, [f"out/{name}", "no regular file"], f"a link {name}")
    os.link(r.folder / "precious", r.fresh() / "modes.csv.part")
    (r.folder / "out/modes.h5").symlink_to(r.folder / "precious")
    done = r.run(*SMALL, "-output_dir", "out", "-output_overwrite", "false")
    r.check(done.returncode == 0 and r.files() == WRITTEN and not (r.folder / "out/modes.h5").is_symlink(),
            "links with the final name are replaced, and a folder without a run's results is written to", done)
    kept = (r.folder / "out/scene.yaml").read_text()
    r.refused(r.run(*SMALL, "-output_dir", "out", "-output_overwrite", "false", ranks=2),
              ["-output_dir out has finished results of an earlier run"], "results that are not to be written over")
    r.check(r.files() == WRITTEN and (r.folder / "out/scene.yaml").read_text() == kept, "they are as they were")
    r.check((r.folder / "precious").read_text() == "mine", "what links lead to stays as it is")
    os.mkfifo(r.fresh() / "checkpoint.bin")
    done = r.run(*LONG, "-output_dir", "out", "-dynamics_checkpoint_interval", "10")
    r.refused(done, ["checkpoint.bin"], "a pipe checkpoint.bin")
    os.mkfifo(r.folder / "pipe")
    r.refused(r.run("-model_mesh", "pipe", "-parts", "a", "-a_young", "1", "-a_density", "1", "-output_dir", "none"),
              ["pipe", "no regular file"], "a pipe for a mesh")
    r.refused(r.run("-operators_load_k", "pipe", "-operators_load_m", "pipe", "-output_dir", "none"), ["pipe", "no regular file"],
              "a pipe for a matrix")
    r.refused(r.run(*SMALL, "-squeal_log", "pipe", "-output_dir", "none"), ["-squeal_log pipe"], "a log that nobody reads")


def check_info(r):
    """K and M of one unknown, with options beside them: f = sqrt(4)/(2 pi)."""
    for name, value in (("k.bin", 4.0), ("m.bin", 1.0)):
        (r.folder / name).write_bytes(struct.pack(">6id", 1211216, 1, 1, 1, 1, 0, value))
        (r.folder / f"{name}.info").write_text("-modes_band 5,6\n-log_view :taken.txt\n-matload_block_size 3\n-help\n")
    done = r.run("-operators_load_k", "k.bin", "-operators_load_m", "m.bin", "-modes_band", "0,1", "-output_dir", "matrices",
                 "-operators_save", "saved")
    frequency = float((r.folder / "matrices/modes.csv").read_text().splitlines()[1].split(",")[1]) if not done.returncode else 0
    r.check(abs(frequency - 1 / 3.141592653589793) < 1e-9 and not (r.folder / "taken.txt").exists()
            and 'modes_band: "0,1"' in (r.folder / "matrices/scene.yaml").read_text(), "no options from files beside a matrix", done)
    r.check(r.files("saved") == ["K.bin", "M.bin"], "none are written")


def wait_for(path):
    end = time.monotonic() + LIMIT
    while not path.exists() and time.monotonic() < end:
        time.sleep(0.02)


def check_lock(r):
    """A second run is refused while the first goes on, on one rank and on two; a killed one keeps nobody off."""
    for ranks in (1, 2):
        out = r.fresh()
        first = subprocess.Popen(r.command(*LONG, "-output_dir", "out", ranks=ranks), cwd=r.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL, start_new_session=True)
        wait_for(out / "transient.csv.part")
        begun = time.monotonic()
        r.refused(r.run(*SMALL, "-output_dir", "out/", ranks=3 - ranks), ["-output_dir out/", "another run", "process"],
                  f"a second run in the folder of one on {ranks}")
        r.check(time.monotonic() - begun < 3, "at once, not after the 3 s in which ranks end whose launcher was killed")
        r.check("modes.csv" not in r.files(), "it has written nothing")
        os.killpg(first.pid, signal.SIGKILL)
        first.wait()
        done = r.run(*SMALL, "-output_dir", "out", ranks=ranks)
        r.check(done.returncode == 0 and ".squeal.lock" not in r.files(), "after a kill the folder is free", done)
    none = {"LD_PRELOAD": str(r.library), "FAULT_NO_LOCKS": "1"}
    out = r.fresh()
    first = subprocess.Popen(r.command(*LONG, "-output_dir", "out"), cwd=r.folder, stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, env={**os.environ, **none})
    wait_for(out / "transient.csv.part")
    r.refused(r.run(*SMALL, "-output_dir", "out", more=none), ["another run", str(first.pid)],
              "the same where the file system has no locks")
    first.kill()
    first.wait()
    done = r.run(*SMALL, "-output_dir", "out", more=none)
    r.check(done.returncode == 0 and set(WRITTEN) <= set(r.files()) and not done.stderr, "which writes all files without", done)
    (r.fresh() / ".squeal.lock").write_text("1 1 elsewhere\n")
    done = r.run(*SMALL, "-output_dir", "out", more=none)
    r.check(done.returncode == 0 and "process 1 on elsewhere may still write into out" in done.stderr,
            "where only another machine knows, a warning", done)
    done = r.run(*SMALL, "-output_dir", "out", "-contact_surfaces", "none,none")
    r.check(done.returncode == 1 and ".squeal.lock" not in r.files(), "a run that fails leaves no lock", done)


def check_saved(r):
    """Matrices of two runs in one folder would be a system of neither."""
    lock = os.open(r.fresh("saved"), os.O_RDONLY)
    fcntl.flock(lock, fcntl.LOCK_EX)
    for ranks in (1, 2):
        r.refused(r.run(*SMALL, "-output_dir", "out", "-operators_save", "saved", ranks=ranks),
                  ["another run", "-operators_save saved"], f"matrices where another run writes them, {ranks} ranks")
    r.check(not r.files("saved"), "none are written")
    os.close(lock)
    done = r.run(*SMALL, "-output_dir", "out", "-operators_save", "saved", "-rig_save", "rig.msh")
    r.check(done.returncode == 0 and r.files("saved") == ["F.bin", "H.bin", "K.bin", "M.bin"] and (r.folder / "rig.msh").exists()
            and not list(r.folder.glob("*.part")), "when it has ended they are", done)


def check_environment(r):
    """Options that are not on the command line count, and are said."""
    words = [*SMALL, "-output_dir", "out"]
    for variable, text in (("PETSC_OPTIONS", "-pad_beta 1e-7"), ("PETSC_OPTIONS_YAML", "pad_beta: 1e-7")):
        done = r.run(*words, more={variable: text})
        r.check(done.returncode == 0 and done.stderr == f"squeal: warning: the environment's {variable} gives options to this run: {text}\n"
                and 'pad_beta: "1e-7"' in (r.folder / "out/scene.yaml").read_text(), f"{variable} is said", done)
    (r.folder / ".petscrc").write_text("-pad_beta 1e-7\n")
    done = r.run(*words, ranks=2)
    r.check(done.returncode == 0 and done.stderr.startswith("squeal: warning: .petscrc gives options to this run") and
            done.stderr.count("\n") == 1 and 'pad_beta: "1e-7"' in (r.folder / "out/scene.yaml").read_text(), ".petscrc is said", done)
    done = r.run(*words, "-skip_petscrc", "true")
    r.check(done.returncode == 0 and not done.stderr and 'pad_beta: "1e-7"' not in (r.folder / "out/scene.yaml").read_text(),
            ".petscrc is left out", done)
    (r.folder / ".petscrc").unlink()


def check_shared_memory(r):
    """A full or read-only /dev/shm, where one may be put there."""
    mount = ["unshare", "-rm", "bash", "-c", "mount -t tmpfs -o size=4k none /dev/shm && { head -c 4096 /dev/zero > /dev/shm/full; "
             "[ $0 = full ] || mount -o remount,ro /dev/shm; exec \"$@\"; }"]
    if subprocess.run([*mount, "full", "true"], capture_output=True, check=False).returncode:
        print("skip: no file system can be mounted here")
        return
    for how in ("full", "read-only"):
        for ranks in (1, 2):
            r.fresh()
            done = r.run(*SMALL, "-output_dir", "out", ranks=ranks, before=[*mount, how])
            r.check(done.returncode == 0 and r.files() == WRITTEN, f"/dev/shm {how}, {ranks} ranks", done)


def check_closed(r):
    """Nobody reads: `squeal | head -1`."""
    for ranks in (1, 2):
        r.fresh()
        run = subprocess.Popen(r.command(*SMALL, "-squeal_view", "-output_dir", "out", ranks=ranks), cwd=r.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        run.stdout.readline()
        run.stdout.close()
        said = run.stderr.read().decode()
        r.check(run.wait(LIMIT) == 0 and not said and r.files() == WRITTEN, f"files although nobody reads, {ranks} ranks")
    r.fresh()
    run = subprocess.Popen(r.command(*SMALL, "-modes_band", "1,2", "-output_dir", "out"), cwd=r.folder, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE)
    run.stderr.close()
    r.check(run.wait(LIMIT) == 1, "an error that nobody reads keeps its status")


def main():
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(*(Path(word).resolve() for word in sys.argv[1:4]), Path(folder))
        for check in (check_names, check_info, check_lock, check_saved, check_environment, check_shared_memory, check_closed):
            check(runner)
    return 1 if runner.faults else 0


if __name__ == "__main__":
    sys.exit(main())
