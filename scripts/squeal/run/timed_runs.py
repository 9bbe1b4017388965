"""Timed runs of the modes: PETSc's log, MUMPS' figures and the modes of each, and the limits of the
machine. What is not correct is not timed: a failed run, or runs that disagree, end the benchmark."""

import csv
import functools
import multiprocessing
import re
import tempfile
import time
from pathlib import Path

import numpy

from .program import measured_run, scene

SINGLE = "MatSolve", "MatSolveTranspos"  # events of one solution with the factors
SOLVES = *SINGLE, "MatMatSolve", "MatMatTrSolve"  # and of many at once
COLUMN = "ShiftInvColumn"  # event of each right-hand side of the latter
SAME = 1e-9  # frequencies of two runs, relative


def best_time(work, tries):
    """Shortest time of a function, s."""
    times = []
    for _ in range(tries):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def triad(_):
    """Bandwidth of a = b + s c in GB/s, 24 bytes an entry, on 480 MB in blocks whose product stays in cache."""
    block = 8192
    n = 2441 * block
    a, b, c, product = numpy.zeros(n), numpy.ones(n), numpy.ones(n), numpy.empty(block)

    def work():
        for i in range(0, n, block):
            numpy.multiply(c[i:i + block], 3.0, out=product)
            numpy.add(b[i:i + block], product, out=a[i:i + block])

    return 24e-9 * n / best_time(work, 5)


def dgemm(order=1500):
    """Gflop/s of the BLAS's product of matrices."""
    a = numpy.ones((order, order))
    return 2e-9 * order**3 / best_time(lambda: a.dot(a), 6)


@functools.cache
def machine_limits():
    """Triad on one and two cores, GB/s, and the BLAS's product of matrices of order 1500 on one core, Gflop/s."""
    with multiprocessing.Pool(2) as pool:
        bandwidth = [triad(0), sum(pool.map(triad, range(2), chunksize=1))]
    with multiprocessing.get_context("spawn").Pool(1) as pool:  # numpy anew, with the kernels that squeal is run with
        return bandwidth, pool.apply(dgemm)


class Run:
    """One run: wall and processor time of the process (s), PETSc's log, MUMPS' last factorisation, memory (MB) after each
    stage and at most, modes.

    n_solves counts right-hand sides, n_calls what they were solved in, ms_solve is the time of one right-hand side."""

    def __init__(self, program, ranks, options):
        with tempfile.TemporaryDirectory() as folder:
            words = ["-squeal_view", "-squeal_progress", 0, *scene("massi2005"), "-st_mat_mumps_icntl_4", 2,
                     "-output_dir", folder, "-log_view", f":{folder}/log.csv:ascii_csv", *options.split()]
            begun = time.perf_counter()
            self.text, self.cpu, _ = measured_run(program, ranks, words, f"options {options}")
            self.wall, self.ranks, self.options = time.perf_counter() - begun, ranks, options
            self.read_log(Path(folder) / "log.csv")
            with (Path(folder) / "modes.csv").open(newline="") as file:
                self.modes = [(float(row["freq_hz"]), row["label"]) for row in csv.DictReader(file)]
        self.unknowns = int(self.last(r"operators: (\d+) unknowns"))
        self.entries = self.last(r"INFOG\(29\).*= *(\S+)")
        self.flops = self.last(r"\(3\) +Operations in node elimination.*= *(\S+)")
        peak = re.findall(r"^the most at any time +(\d+)$", self.text, re.MULTILINE)
        self.memory = [(name, float(mb)) for name, mb in re.findall(r"^(\w+) +[\d.]+ +(\d+)$", self.text, re.MULTILINE)]
        self.peak = max(float(mb) for mb in (*peak, *(mb for _, mb in self.memory)))
        self.ms_solve = 1e3 * self.seconds(*SOLVES) / self.n_solves

    def read_log(self, path):
        """Time of the slowest rank, and count, by stage and event; the event "summary" is the whole stage."""
        self.log = {}
        with path.open(newline="") as file:
            next(file)
            for stage, event, _, count, seconds in (row[:5] for row in csv.reader(file)):
                old = self.log.get((stage, event.strip()), (0, 0))
                self.log[stage, event.strip()] = max(old[0], float(seconds)), max(old[1], int(count))
        self.n_calls, self.n_solves = self.count(*SOLVES), self.count(*SINGLE, COLUMN)

    def last(self, pattern):
        """The last number of the output that a pattern finds."""
        found = re.findall(pattern, self.text)
        if not found:
            raise SystemExit(f"options {self.options}: the output lacks {pattern}")
        return float(found[-1].replace("D", "e"))

    def count(self, *events, stage=None):
        """How often they happened, in one stage or in all."""
        return sum(value[1] for (s, e), value in self.log.items() if e in events and stage in (None, s))

    def seconds(self, *events, stage=None):
        """Time in events, of one stage or of all."""
        return sum(value[0] for (s, e), value in self.log.items() if e in events and stage in (None, s))


def require_same(first, other):
    """Largest relative difference of the frequencies; rigid modes are exact zeros."""
    if len(first.modes) != len(other.modes):
        raise SystemExit(f"{len(first.modes)} modes on {first.ranks} ranks, {len(other.modes)} on {other.ranks}")
    worst = max(abs(a - b) / max(a, 1e-3) for (a, _), (b, _) in zip(first.modes, other.modes))
    if worst > SAME:
        raise SystemExit(f"options {first.options}: two runs on {first.ranks} and {other.ranks} ranks give frequencies "
                         f"that differ by {worst:.1e}, more than {SAME:g}")
    return worst


def median_run(program, n_runs, ranks=1, options="", complete=True):
    """The run of median wall time, when all agree and, where asked for, confirm that no mode is missing."""
    runs = [Run(program, ranks, options) for _ in range(n_runs)]
    for run in runs:
        require_same(runs[0], run)
        if complete and not re.search("^completeness: (?!not )", run.text, re.MULTILINE):
            raise SystemExit(f"options {options}: modes may be missing")
    return sorted(runs, key=lambda run: run.wall)[n_runs // 2]
