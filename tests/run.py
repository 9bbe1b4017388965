#!/usr/bin/env python3
"""Runs one application test: squeal on every run of a case file, then numeric checks of the tables that they wrote.

A case is a TOML file. Only `run` is required.

    options = "-options_file {source}/options/oscillator.yaml"   # of all runs; {source} is the top of the repository
    ranks = [1, 2]           # all runs and checks are made on each of these; default [1]
    make = ["{source}/tests/mesh.py rig rig.msh"]    # Python scripts, run first in the working folder of all runs
    night_make = ["..."]     # after these, with --night
    needs = ["vtkmodules", "gmsh"]   # Python modules and programs, without which the case is skipped

    [file]
    "cube.msh" = "text"      # written into the working folder of all runs

    [run.NAME]               # made in the order of the file
    options = "-contact_mu 1"    # {OTHER} is the output folder of an earlier run
    night_options = "-sweep_verify 4"    # after these, with --night
    ranks = [1]                  # of the case's; checks of runs that are not made on a number of ranks are left out there
    night = [2]                  # on these too with --night, of the case's or not, when a day's run proves the same with less
    stdout = ["regex"]           # found in the output
    files = ["modes.csv"]        # written, not empty
    link = {"modes.csv.part" = "/dev/full"}    # symbolic links put into the output folder before
    file_limit = 8_000_000       # largest file that the run may write, bytes
    warning = "regex"            # each warning matches; without it there must be none
    error = "regex"              # the run must fail: status not 0, one line on stderr, which matches; no rank and no
                                 # file left behind but `files`

    [[check]]
    run = "NAME"                 # default: the only run
    ranks = [1]                  # of those of its run; default all
    table = "modes.csv"          # default
    column = "freq_hz"           # or "eigenvalue", the complex growth_rad_s + 2 pi i freq_hz
    where = "freq_hz > 100 and unstable == 1"    # which rows; default all
    # then one reference or more of:
    equals = [1.0, 2.0]          # in row order; eigenvalues as [growth_rad_s, freq_hz] in any order
    equals = {"(0,4)" = 3918}    # by label: the nearest of the rows with that label
    equals_run = "OTHER"         # the same rows of another run
    across_ranks = true          # the same run on ranks[0]
    pairs = true                 # rows 1 and 2, 3 and 4, ... are equal
    min = 0                      # bounds of every value
    max = 1e-8
    count = 2                    # number of rows
    # with tolerances |a - b| <= atol + rtol |b|:
    rtol = 1e-10
    atol = 0                     # or one for each value, in their order

    hard = "a scene in mm"       # a hard case that this check is the answer to, in a run: that it fails as it should;
    wrong = "a constant has a unit"    # what can go wrong in it: scripts/study/hard lists both, `why` and the margin

    [[check]]
    run = "NAME"
    command = "{source}/tests/verify/fields.py {NAME}/modes.xmf"   # a Python script that must succeed

Every run that succeeds must leave no memory allocated and no option unused, and every sweep that is verified must
state errors that hold. Exit status: 0, 1 failed, 77 skipped.
"""

import argparse
import csv
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

from check import Checker, Failure, Line, require
from cores import CORES, MIXED, choose_core, mixed
from forked import run_command
from keys import fault_of_keys
from processes import processes_naming
from ranks import fault_of_ranks, ranks_of_runs, runs_of
from served import own_words, served_program

SOURCE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.run.launched import end

FINAL_SUFFIXES = {".csv", ".h5", ".xmf", ".bin", ".info"}
SKIPPED = 77
MOST_BEYOND, WORST_RATIO = 0.01, 3  # of the errors that a sweep states


class Runner:
    """Makes the runs of a case on a number of ranks, each with an output folder of its own."""

    def __init__(self, arguments, case, folder, ranks):
        self.arguments, self.case, self.folder, self.ranks = arguments, case, folder, ranks
        self.made = [name for name, run in case["run"].items() if ranks in run["ranks"]]
        self.served = arguments.served

    def output(self, name):
        return self.folder / f"{name}-{self.ranks}"

    def expand(self, text):
        """Words of an options string, with folders in place of {source} and {RUN}."""
        folders = {name: self.output(name) for name in self.case["run"]}
        return [word.format(source=SOURCE, **folders) for word in shlex.split(text)]

    def link(self, name, run):
        """Puts the links of a run into its output folder."""
        for link, target in run.get("link", {}).items():
            self.output(name).mkdir(exist_ok=True)
            (self.output(name) / link).symlink_to(target)

    def execute(self, name, run):
        program = mixed(self.arguments.squeal) if self.arguments.core == MIXED else [self.arguments.squeal]
        command = [self.arguments.launcher, "-n", str(self.ranks), *program]
        words = ["-output_dir", str(self.output(name)), "-malloc_dump", "-options_left"]
        night = run.get("night_options", "") if self.arguments.night else ""
        words += self.expand(" ".join((self.case.get("options", ""), run.get("options", ""), night)))
        if "file_limit" in run:
            command = ["prlimit", f"--fsize={run['file_limit']}", *command]
        self.link(name, run)
        print("$", shlex.join(map(str, [*command, *words])), flush=True)
        if "file_limit" in run:
            return self.launch([*command, *words], {"OMPI_MCA_btl_sm_segment_size": "4194304"})  # Open MPI 5 shares memory by files
        if not self.served:
            return self.launch([*command, *words], {})
        return self.fork(words) if self.ranks == 1 else self.join(command, words)

    def fork(self, words):
        """Runs it on one rank, as a child of a process in which the libraries are loaded, most of what a short run costs."""
        outcome = self.served.run(self.folder, words)
        require(outcome.status is not None, f"no end within {self.arguments.timeout:g} s")
        return outcome.status, outcome.stdout, outcome.stderr

    def join(self, command, words):
        """Runs it by the launcher, each rank as such a child."""
        joined = Path(os.environ["SQUEAL_START"]) / "join"
        return self.launch([*command[:-1], joined, command[-1], *words], {"SQUEAL_SERVED": self.served.socket})

    def launch(self, command, more):
        """Runs it by the launcher, with more in its environment."""
        process = subprocess.Popen(command, cwd=self.folder, env={**os.environ, **more}, text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            stdout, stderr = process.communicate(timeout=self.arguments.timeout)
        except subprocess.TimeoutExpired:
            end(process)
            raise Failure(f"no end within {self.arguments.timeout:g} s") from None
        return process.returncode, stdout, stderr

    def make(self, name):
        run = self.case["run"][name]
        status, stdout, stderr = self.execute(name, run)
        try:
            if "error" in run:
                self.check_error(name, run, status, stderr)
            else:
                self.check_success(name, run, status, stdout, stderr)
        except Failure:
            print(stdout, stderr, sep="\n")
            raise

    def check_error(self, name, run, status, stderr):
        lines = [line for line in own_words(stderr).splitlines() if line.strip()]
        lines = [line for line in lines if "warning" not in run or not re.search(run["warning"], line)]
        require("warning" not in run or re.search(run["warning"], stderr, re.MULTILINE), f"no warning {run.get('warning')!r}")
        require(status != 0, "exit status 0, but an error was expected")
        require(len(lines) == 1, f"{len(lines)} lines on stderr, but one was expected")
        require(re.search(run["error"], lines[0]), f"the message does not match {run['error']!r}")
        left = {path.name for path in self.output(name).rglob("*") if path.suffix in FINAL_SUFFIXES}
        left -= set(run.get("files", []))
        require(not left, f"files left behind: {' '.join(sorted(left))}")
        alive = processes_naming(str(self.output(name)))
        require(not alive, f"processes left behind: {*alive,}")

    def check_success(self, name, run, status, stdout, stderr):
        require(status == 0, f"exit status {status}")
        leaks = re.findall(r"^\[ *\d+\] ?\d+ bytes .*", stdout, re.MULTILINE)
        require(not leaks, f"{len(leaks)} pieces of memory left allocated, the first: {leaks[0] if leaks else ''}")
        unused = re.findall(r"Option left: name:(-\S+)", stdout)
        require(not unused, f"options not used: {' '.join(unused)}")
        for line in stderr.splitlines():
            expected = "warning" in run and re.search(run["warning"], line)
            require(expected or not line.startswith("squeal:"), f"unexpected on stderr: {line}")
        require("warning" not in run or re.search(run["warning"], stderr), f"no warning {run.get('warning')!r}")
        for pattern in run.get("stdout", []):
            require(re.search(pattern, stdout, re.MULTILINE), f"the output does not hold {pattern!r}")
        for file in run.get("files", []):
            path = self.output(name) / file
            require(path.is_file() and path.stat().st_size, f"{file} was not written")
        self.check_errors(self.output(name) / "verify.csv")

    def check(self, checker):
        """Whether each check of runs that were made here passed."""
        results = []
        for index, check in enumerate(self.case.get("check", []), 1):
            if runs_of(check, self.case["run"]) <= set(self.made) and self.ranks in check.get("ranks", [self.ranks]):
                title = check.get("why", f"check {index}")
                results.append(attempt(f"{title} on {self.ranks}", checker.make, check))
                self.write_margin(check, title, results[-1])
        return results

    def write_margin(self, check, title, result):
        """Adds a line about a hard case to the file of --margins."""
        if not self.arguments.margins or "hard" not in check:
            return
        line = result if isinstance(result, Line) else Line(result)
        with self.arguments.margins.open("a", newline="") as file:
            csv.writer(file).writerow([check["hard"], check.get("wrong", ""), title, self.arguments.case.stem,
                                       self.ranks, line.measured, line.allowed, int(result.passed)])

    @staticmethod
    def check_errors(path):
        """A verified sweep: every mode errs by less than three times its printed error, and one in a hundred by more than
        that error, over all verified points of the run together; a single one where these have fewer than a hundred."""
        rows = []
        if path.is_file():
            with path.open(newline="") as lines:
                rows = [row for row in csv.DictReader(lines) if row["error_estimate"]]
        beyond = sum(int(row["modes_beyond_error"]) for row in rows)
        modes = sum(int(row["modes_full"]) for row in rows)
        worst = max((float(row["worst_ratio"]) for row in rows), default=0)
        require(beyond <= max(1, MOST_BEYOND * modes), f"{beyond} of {modes} modes err by more than is printed")
        require(worst <= WORST_RATIO, f"a mode errs by {worst:.1f} times what is printed")


class Result(Line):
    """What an action found; true where it passed."""

    def __bool__(self):
        return self.passed


def attempt(title, action, *arguments):
    """What the action found, true where it passed; prints it, and how long it took by the clock."""
    begun = time.monotonic()
    try:
        line, passed = action(*arguments) or "as expected", True
    except Failure as failure:
        line, passed = failure.args[0], False
    print(f"{'ok    ' if passed else 'FAILED'} {title}, {time.monotonic() - begun:.1f} s: {line}")
    result = Result(line)
    result.passed = passed
    result.measured, result.allowed = getattr(line, "measured", None), getattr(line, "allowed", None)
    return result


def keep_hard(case):
    """Leaves the checks of hard cases alone, and the runs that these look at or come from."""
    runs, case["check"] = case["run"], [check for check in case.get("check", []) if "hard" in check]
    default = next(iter(runs))
    text = " ".join(f"{{{check.get('run', default)}}} {{{check.get('equals_run', '')}}} {check.get('command', '')}"
                    for check in case["check"])
    kept, more = set(), {name for name in runs if f"{{{name}}}" in text}
    while more - kept:
        kept |= more
        more = {name for name in runs for other in kept if f"{{{name}}}" in runs[other].get("options", "")}
    case["run"] = {name: run for name, run in runs.items() if name in kept or "hard" in run}


def command_line():
    """The parser of the command line."""
    parser = argparse.ArgumentParser(description="Runs one application test of squeal.")
    parser.add_argument("case", type=Path)
    parser.add_argument("--squeal", type=Path, required=True, help="the program")
    parser.add_argument("--launcher", type=Path, default=SOURCE / "scripts/mpirun", help="mpirun")
    parser.add_argument("--ranks", type=int, action="append", help="instead of the ranks of the case")
    parser.add_argument("--timeout", type=float, default=os.environ.get("SQUEAL_TEST_SECONDS", "240"),
                        help="seconds allowed to each run")
    parser.add_argument("--core", choices=(*CORES, MIXED), help="processor whose kernels OpenBLAS takes; mixed: another one on each rank")
    parser.add_argument("--night", action="store_true", help="runs on the ranks of the night as well")
    parser.add_argument("--margins", type=Path, help="only checks of hard cases, about each of which a line is added here")
    return parser


def make_files(case, folder, night):
    """Files of a case, and those that its scripts make."""
    for name, text in case.get("file", {}).items():
        (folder / name).write_text(text)
    for command in case.get("make", []) + (case.get("night_make", []) if night else []):
        made = run_command(shlex.split(command.format(source=SOURCE)), folder)
        if made.returncode:
            sys.exit(f"{command}: {made.stderr}")


def results_of(arguments, case, folder):
    """Whether each run and check of a case passed, on all of its numbers of ranks; the first is what others are compared with."""
    results, first = [], None
    for ranks in ranks_of_runs(case, arguments.ranks or case.get("ranks", [1]), arguments.night):
        runner = Runner(arguments, case, folder, ranks)
        first = first or runner
        for name in runner.made:
            results.append(attempt(f"run {name} on {ranks}", runner.make, name))
            runner.write_margin(case["run"][name], case["run"][name].get("why", f"run {name}"), results[-1])
        results += runner.check(Checker(runner, first))
    return results


def main():
    parser = command_line()
    arguments = parser.parse_args()
    arguments.squeal, arguments.launcher = arguments.squeal.resolve(), arguments.launcher.resolve()
    os.environ.pop("PETSC_OPTIONS", None)
    case = tomllib.loads(arguments.case.read_text())
    if arguments.margins:
        keep_hard(case)
    absent = [name for name in case.get("needs", []) if not (importlib.util.find_spec(name) or shutil.which(name))]
    reason = f"no module or program {' '.join(absent)}" if absent else arguments.core and choose_core(arguments.core)
    if reason:
        print(f"skipped: {reason}")
        return SKIPPED
    fault = fault_of_keys(case) or fault_of_ranks(case)
    if fault:
        parser.error(fault)
    arguments.served = None if arguments.core == MIXED else served_program(arguments.squeal, arguments.timeout)  # has its kernels already
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        make_files(case, Path(folder), arguments.night)
        results = results_of(arguments, case, Path(folder))
    if arguments.served:
        arguments.served.end()
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
