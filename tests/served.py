"""Runs the program many times, its libraries loaded once, and with the N-th call of a kind failing where that is asked: the Python side
of tests/fault/serve.c and inject.c, which say how."""

import argparse
import contextlib
import errno
import os
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
from pathlib import Path

from processes import processes

LAUNCHER = Path(__file__).resolve().parents[1] / "scripts/mpirun"
OPEN, WRITE, SYNC, RENAME, CLOSE, OWN, PETSC = (1 << bit for bit in range(7))
FILES = OPEN | WRITE | SYNC | RENAME | CLOSE
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
PATIENCE = 5  # a run may take so many times its limit of processor time by the clock, since others work beside it
ENDED = "squeal: error: stopped by SIGTERM"
# What a process alone does not need, and costs half of its start: networks, and to look for devices
LEAN = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_btl": "self", "OMPI_MCA_pml": "ob1", "OMPI_MCA_mtl": "^psm,psm2,ofi",
        "OMPI_MCA_orte_create_session_dirs": "0", "HWLOC_COMPONENTS": "-pci,-linuxio,-opencl,-gl",
        "HWLOC_PLUGINS_PATH": "/nonexistent"}
# Components of Open MPI 4 that each start would load; Open MPI 5 has them in its library
COMPONENTS = re.compile(r"mca_(allocator|bml|btl_(self|sm|vader)|coll|errmgr|ess_(pmi|singleton)|mpool|op|osc_(monitoring|rdma|sm)|pmix|"
                        r"pml_ob1|rcache|reachable|schizo|shmem|state)(_\w+)?\.so")
# Open MPI 5 cannot be told to be quiet: remarks between dashes, each ended by a zero byte, which may come late; and now
# and then a line of its daemon, "[host:pid] PMIX ERROR", or of libevent, "[warn] Epoll"
MPIRUN_REMARK = re.compile(r"^-{40,}\n.*?^-{40,}$|^\[\S+:\d+\] PMIX ERROR[^\n]*$|^\[warn\] Epoll[^\n]*$",
                           re.MULTILINE | re.DOTALL)


def bound_before():
    """The environment by which a loop loads and links, once, what each of its children would."""
    files = Path("/usr/lib").glob("*/openmpi/lib/openmpi*/mca_*.so")
    return {"LD_BIND_NOW": "1", "FAULT_LOAD": ":".join(str(file) for file in sorted(files) if COMPONENTS.fullmatch(file.name))}


def own_words(stderr):
    """What the program itself wrote."""
    return MPIRUN_REMARK.sub("", stderr.replace("\0", ""))


def plan(folder, report, calls, at, **more):
    """The environment of a fault: kinds of calls on files below a folder, and which one fails; more: error, stay, signal, rank."""
    words = {"DIR": folder, "REPORT": report, "CALLS": calls, "AT": at, **{key.upper(): value for key, value in more.items()}}
    words["ERRNO"] = words.pop("ERROR", errno.EIO)
    return {f"FAULT_{key}": str(value) for key, value in words.items()}


def told(report):
    """Of a run under a plan: number of calls, how many failed, and the first of them in words."""
    count, failed, words = struct.unpack("qq240s", Path(report).read_bytes().ljust(256, b"\0"))
    return count, failed, words.split(b"\0")[0].decode(errors="replace")


class Outcome:
    """How a run ended: exit status, negative for a signal, None for no end in time; what it said on both streams. Where one of several
    ranks fails alone, the launcher ends the others, of which the first may say so."""

    def __init__(self, status, stdout, stderr, several=False):
        self.status, self.stdout, self.stderr = status, stdout, stderr
        lines = [line for line in own_words(stderr).split("\n") if line.strip()]
        errors = [line for line in lines if not line.startswith("squeal: warning: ")]
        self.errors = several and [line for line in errors if not line.startswith(ENDED)] or errors

    def refused(self):
        """Whether it failed as it should, with one line."""
        return self.status == 1 and len(self.errors) == 1 and self.errors[0].startswith("squeal: error: ") and \
            len(self.errors[0]) >= 40


def existing(name):
    """A file of the command line."""
    path = Path(name).resolve()
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"{name}: no such file; ninja makes it")
    return path


class Line:
    """A connection to the loop that starts the program: run() may be called from one thread at a time."""

    def __init__(self, program, address, folder, limit):
        self.program, self.folder, self.limit = str(program), folder, limit
        self.connection = socket.socket(socket.AF_UNIX)
        self.connection.connect(address)

    def read(self):
        data = self.connection.recv(4, socket.MSG_WAITALL)
        if len(data) < 4:
            raise SystemExit("FAILED: the loop that starts the program has ended")
        return struct.unpack("i", data)[0]

    def run(self, work, words, environment=()):
        """Runs in a folder; None as the status when it had to be killed."""
        stdout, stderr = self.folder / "stdout", self.folder / "stderr"
        lines = [f"{key}={value}" for key, value in {**LEAN, **dict(environment)}.items()]
        strings = [work, stdout, stderr, len(lines), *lines, self.program, *words]
        data = b"".join(os.fsencode(str(s) if not isinstance(s, bytes) else s) + b"\0" for s in strings)
        self.connection.sendall(struct.pack("i", len(data)) + data)
        child, late = self.read(), []
        with contextlib.suppress(ProcessLookupError):  # it may have ended already
            resource.prlimit(child, resource.RLIMIT_CPU, (int(self.limit), int(self.limit) + 5))
        watch = threading.Timer(PATIENCE * self.limit, lambda: (late.append(1), os.kill(child, signal.SIGKILL)))
        watch.start()
        status = self.read()
        watch.cancel()
        said = [path.read_bytes().decode(errors="replace") for path in (stdout, stderr)]
        return Outcome(None if late else os.waitstatus_to_exitcode(status), *said)


class Served(Line):
    """The program behind a loop that forks, and a connection to it; `socket` is where others may ask as well."""

    def __init__(self, program, library, limit):
        self.library, folder = Path(library), Path(tempfile.mkdtemp(prefix="squeal-served-"))
        self.socket = str(folder / "socket")
        preload = f"{library} {os.environ.get('LD_PRELOAD', '')}".strip()
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(self.socket)
            listener.listen(64)
            environment = {**os.environ, **ONE_THREAD, **bound_before(), "LD_PRELOAD": preload, "FAULT_SERVE": str(listener.fileno())}
            self.loop = subprocess.Popen([str(program)], env=environment, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                         pass_fds=[listener.fileno()])
        super().__init__(program, self.socket, folder, limit)

    def line(self, name, limit):
        """Another connection, whose runs have streams of their own."""
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        return Line(self.program, self.socket, folder, limit)

    def join(self, work, words, ranks, environment=()):
        """The same on several ranks, each a child of the loop."""
        command = [LAUNCHER, "-n", str(ranks), self.library.with_name("join"), self.program, *words]
        return finish(command, work, PATIENCE * self.limit, {"SQUEAL_SERVED": self.socket, **dict(environment)})

    def stand_in(self):
        """A program that begins as its child, for scripts that are given a path; without a launcher it is one rank."""
        path = self.folder / "squeal"
        alone = "; ".join(f"export {key}='{value}'" for key, value in LEAN.items())
        path.write_text(f'#!/bin/sh\n[ -n "$OMPI_COMM_WORLD_SIZE" ] || {{ {alone}; }}\nexport SQUEAL_SERVED="{self.socket}"\n'
                        f'exec "{self.library.with_name("join")}" "{self.program}" "$@"\n')
        path.chmod(0o755)
        return path

    def end(self):
        self.connection.close()
        self.loop.stdin.close()
        self.loop.wait()
        shutil.rmtree(self.folder)


def served_program(program, limit):
    """The program behind such a loop, by the library in the folder that SQUEAL_START names, build/tests; None where it names none, as
    under a sanitizer."""
    folder = os.environ.get("SQUEAL_START")
    return Served(program, Path(folder) / "libfault.so", limit) if folder else None


class Launched:
    """The program started anew each time, on one rank."""

    def __init__(self, program, limit):
        self.program, self.limit = str(program), limit

    def run(self, work, words):
        done = subprocess.run([LAUNCHER, "-n", "1", self.program, *map(str, words)], cwd=work, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=self.limit, check=False)
        return Outcome(done.returncode, done.stdout, done.stderr)

    def join(self, work, words, ranks):
        """On several ranks."""
        return finish([LAUNCHER, "-n", str(ranks), self.program, *words], work, self.limit, {})

    def end(self):
        pass


def starter(program, limit=240):
    """Runs the program in a folder with words of a command line, the cheapest way there is here."""
    program = Path(program).resolve()
    return served_program(program, limit) or Launched(program, limit)


@contextlib.contextmanager
def sooner(program):
    """The path of a program that does what this one does and begins sooner, where the tests have such a loop."""
    program = Path(program).resolve()
    served = served_program(program, 240)
    try:
        yield served.stand_in() if served else program
    finally:
        if served:
            served.end()


def outcome_of(starter, work, words, ranks):
    """How a run on so many ranks ended; one that did not end in time ends the test."""
    outcome = starter.run(work, words) if ranks == 1 else starter.join(work, words, ranks)
    if outcome.status is None:
        raise SystemExit(f"FAILED: no end of {' '.join(map(str, words))}")
    return outcome


def preloading(program, library, words, environment, ranks):
    """The command that starts it anew on some ranks with the library of faults."""
    others = os.environ.get("LD_PRELOAD", "")
    before = ["env", f"LD_PRELOAD={library} {others}".strip(), *(f"{key}={value}" for key, value in environment.items())]
    return [LAUNCHER, "-n", str(ranks), *before, program, *words]


def launch(program, library, work, words, environment, ranks, limit):
    """The same on several ranks, started anew each time."""
    return finish(preloading(program, library, words, environment, ranks), work, limit, {})


def session_of(leader):
    """Processes of the session that one leads, and the parent of each."""
    fields = {number: stat.rpartition(b")")[2].split() for number, stat in processes("stat")}
    return {number: int(field[1]) for number, field in fields.items() if int(field[3]) == leader}


def kill_ranks(leader):
    """Kills all ranks of a launcher at once, of which each has a parent that watches it; the launcher sees to what they leave, since it
    is killed only where it is the one rank itself. How many that were."""
    parents = session_of(leader)
    ranks = [number for number in parents if number not in parents.values()] or [leader]
    for number in ranks:
        os.kill(number, signal.SIGKILL)
    return len(ranks)


def killed_at(command, file, work=".", calls=OPEN, at=1):
    """Whether a run by the launcher was killed as it should, all of its ranks at once: as rank 0 stops before its call number `at` of
    some kinds on files whose names begin with `file`, whatever else the machine does. A rank that was asked to end would say so."""
    _, _, ranks, program, *words = map(str, command)
    program, begun = Path(program).resolve(), time.monotonic()
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        report, said = Path(folder) / "report", Path(folder) / "said"
        stop = plan(file, report, calls, at, signal=int(signal.SIGSTOP))
        with said.open("wb") as stream:
            process = subprocess.Popen(preloading(program, program.parent / "tests/libfault.so", words, stop, ranks), cwd=work,
                                       start_new_session=True, stdin=subprocess.DEVNULL, stdout=stream, stderr=stream)
            while process.poll() is None and time.monotonic() - begun < 240 and not (report.exists() and told(report)[1]):
                time.sleep(0.002)
            killed = kill_ranks(process.pid) if process.poll() is None else 0
            process.wait()
        return killed == int(ranks) and told(report)[1] > 0 and b"stopped by" not in said.read_bytes()


def finish(command, work, limit, more):
    """Outcome of a command of several processes, with more in their environment, all of which are killed at the limit of time."""
    process = subprocess.Popen(command, cwd=work, env={**os.environ, **more}, start_new_session=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        stdout, stderr = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return Outcome(None, "", "")
    return Outcome(process.returncode, stdout.decode(errors="replace"), stderr.decode(errors="replace"), several=True)
