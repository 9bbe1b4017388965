#!/usr/bin/env python3
"""One call of a run fails: each allocation that squeal asks for, each opening, writing, flushing, renaming and closing of a file of its
results, in turn; from one write on, all of them, as on a full disk; or the run is killed, or asked to end, at one of these calls. Judged is

  end      no signal, and an end within the time limit
  message  a failure says one line, "squeal: error: ...", with exit status 1; a run that does without what failed has the results of one
           that nobody disturbed
  files    what has a final name is whole: that of an undisturbed run, beside the scene.yaml of this run, or that of the earlier run
           that was in the folder, which is there as long as nothing new has taken its place
  later    the same command, going on from what a killed or stopped run has kept, ends with the results of an undisturbed run

    fault.py build/squeal build/tests/libfault.so [--most 7] [--ranks 2] [--scene modes] [--kind memory] [--one N] [--passed FILE]

On one rank the calls of a kind fail in copies of one run (branches.py). --most takes an even sample of the calls. With --passed a test
that was stopped goes on. Exit status: 0, or 1."""

import argparse
import csv
import errno
import filecmp
import math
import re
import shutil
import signal
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py

sys.path.append(str(Path(__file__).resolve().parents[1]))
import scenes  # noqa: E402
import served  # noqa: E402
from branches import Branches  # noqa: E402
from passed import Passed  # noqa: E402

# Kinds of faults: calls that are counted, and the rest of the plan
KINDS = {
    "memory": (served.OWN, {"error": errno.ENOMEM}),
    "library": (served.PETSC, {"error": errno.ENOMEM}),
    "files": (served.FILES, {"error": errno.EIO}),
    "disk": (served.OPEN | served.WRITE | served.SYNC, {"error": errno.ENOSPC, "stay": 1}),
    "kill": (served.FILES, {"signal": int(signal.SIGKILL)}),
    "stop": (served.FILES, {"signal": int(signal.SIGTERM)}),
}
EARLIER = ("-contact_mu", "0.2")  # of the run that was in the folder before
CHANGING = re.compile(r"^# (completeness|cost|end|stages|in|command|repeat|files|.*seconds).*$", re.MULTILINE)
MATRICES = ("K.bin", "M.bin", "C.bin", "H.bin", "F.bin")  # of -operators_save, which may be any folder
UNDER_WAY = "# end: not yet"  # in the scene.yaml of a run that has not ended
TOLERANCE = 1e-6  # between runs on several ranks, where the order of sums depends on the moment
LOOSER = {"condition": 1e-5}  # of close modes, which change by 2e-6


def options(text):
    """Lines of a scene.yaml that are options."""
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def content(path, ranks):
    """What is compared of a file: bytes, values of datasets, lines that do not tell of the run itself; None where it cannot be read."""
    try:
        if path.suffix == ".h5":
            found = {}
            with h5py.File(path) as file:
                file.visititems(lambda key, it: found.update({key: it[()].tobytes() if ranks == 1 else it.shape})
                                if isinstance(it, h5py.Dataset) else None)
            return found
        if path.suffix == ".yaml":
            text = path.read_text()
            return text if UNDER_WAY in text else CHANGING.sub("", text)
        if path.suffix == ".csv" and ranks > 1:
            return Table(path)
        return path.read_bytes() if ranks == 1 or path.suffix == ".xmf" else path.stat().st_size
    except (OSError, ValueError, KeyError, RuntimeError):
        return None


class Table:
    """A table that is equal to another one but for rounding, on which numbers of iterations depend."""

    def __init__(self, path):
        self.rows = list(csv.reader(path.open(newline="")))
        if any(len(row) != len(self.rows[0]) for row in self.rows):
            raise ValueError("rows of different lengths")
        if "projector_sweeps" in self.rows[0]:
            at = self.rows[0].index("projector_sweeps")
            self.rows = [row[:at] + row[at + 1:] for row in self.rows]

    def __eq__(self, other):
        return len(self.rows) == len(other.rows) and all(self.near(*cells) for rows in zip(self.rows, other.rows)
                                                         for cells in zip(*rows, self.rows[0]))

    @staticmethod
    def near(one, other, column):
        tolerance = LOOSER.get(column, TOLERANCE)
        try:
            return math.isclose(float(one), float(other), rel_tol=tolerance, abs_tol=tolerance)
        except ValueError:
            return one == other


def contents(folder, ranks):
    """Files with final names."""
    paths = [path for path in folder.glob("*") if path.suffix not in (".part", ".lock") and "_restart_" not in path.name]
    return {path.name: content(path, ranks) for path in paths}


class Faults:
    """One scene, its undisturbed results, and what becomes of it when calls fail."""

    def __init__(self, arguments, scene, folder, passed):
        self.arguments, self.scene, self.folder, self.ranks, self.passed = arguments, scene, folder, arguments.ranks, passed
        folder.mkdir()
        scenes.make(folder)
        self.report = folder / "report"
        self.serve = served.Served(arguments.squeal, arguments.library, arguments.limit)
        self.well = self.undisturbed()
        self.before = folder / "before"
        self.earlier = self.undisturbed(*EARLIER)
        (folder / "out").rename(self.before)
        self.failed, self.numbers = 0, {}

    def run(self, environment, *more):
        words = (*self.scene.words, *more)
        if self.ranks == 1:
            return self.serve.run(self.folder, words, environment)
        return self.serve.join(self.folder, words, self.ranks, environment)

    def undisturbed(self, *more):
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        outcome = self.run({}, *more)
        if outcome.status != 0:
            raise SystemExit(f"FAILED: {self.scene.name} without faults: {outcome.stderr}")
        return contents(self.folder / "out", self.ranks)

    def lay_out(self):
        """The folder of results as the earlier run left it."""
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        shutil.copytree(self.before, self.folder / "out")

    def disturbed(self, kind, at):
        """A run whose call number `at` of that kind fails, none for 0; how it ended, and which call that was."""
        calls, more = KINDS[kind]
        rank = 1 if self.ranks > 1 and at % 2 == 0 and kind in ("memory", "library") else 0
        self.lay_out()
        outcome = self.run(served.plan("out", self.report, calls, at, rank=rank, **more))
        return outcome, served.told(self.report)

    def whole(self, name, value):
        """Whether a file is one of an undisturbed run; of those that change during a run, the list of snapshots names what is there,
        and the next run tells of the checkpoint."""
        if self.scene.goes_on and name == "transient.xmf":
            named = re.findall(r"(snapshot_\d+\.h5):", value.decode())
            ElementTree.fromstring(value)
            return named and all((self.folder / "out" / h5).exists() for h5 in named)
        if name == "scene.yaml" and UNDER_WAY in value:
            return options(value) == options(self.well[name])
        return value in (self.well.get(name), self.earlier.get(name)) or (self.scene.goes_on and name == "checkpoint.bin")

    def judge_files(self, outcome):
        found = contents(self.folder / "out", self.ranks)
        torn = [name for name, value in found.items() if value is None or not self.whole(name, value)]
        if torn:
            return f"{' '.join(sorted(torn))} neither as before nor as of a run to the end"
        new = [name for name in found if found[name] == self.well.get(name) != self.earlier.get(name) and name not in MATRICES]
        if new and options(found.get("scene.yaml", "")) != options(self.well["scene.yaml"]):
            return f"{' '.join(sorted(new))} without the scene.yaml of the run"
        gone = [name for name in self.earlier if name not in found and name not in self.scene.loses
                and (outcome.status != 0 or name in self.well)]
        if gone:
            return f"{' '.join(sorted(gone))} of the earlier run gone"
        if outcome.status == 0 and {name: found.get(name) for name in self.well} != self.well:
            return "exit status 0 with other results"
        return ""

    def judge_later(self):
        """The next run takes up what is there."""
        now, before = (folder / "checkpoint.bin" for folder in (self.folder / "out", self.before))
        kept = now.exists() and not (before.exists() and filecmp.cmp(now, before, shallow=False))
        later = self.run({}, *([self.scene.goes_on] if self.scene.goes_on and kept else []))
        if later.status != 0:
            return f"the next run: exit status {later.status}: {later.stderr[-300:]}"
        found = contents(self.folder / "out", self.ranks)
        apart = [name for name in self.well if found.get(name) != self.well[name]]
        return f"the next run: {' '.join(sorted(apart))} differ" if apart else ""

    def judge(self, kind, outcome, failed):
        if outcome.status is None:
            return "no end"
        done = outcome.status == 0 and not outcome.errors  # also where the call did not come: not all runs make as many
        if kind == "kill" and failed:
            well = outcome.status in (-signal.SIGKILL, 128 + signal.SIGKILL) or self.ranks > 1
        elif kind == "stop" and failed:
            well = done or outcome.refused() or (len(outcome.errors) == 1 and outcome.status in
                                                 (-signal.SIGTERM, 128 + signal.SIGTERM))
        else:
            well = done or (failed and outcome.refused())
        if not well:
            return f"exit status {outcome.status}: {outcome.stderr[:400]!r}"
        wrong = self.judge_files(outcome)
        later = kind in ("kill", "stop") or (kind == "disk" and self.scene.goes_on)
        return wrong or (self.judge_later() if later else "")

    def note(self, kind, at, outcome, failed, words):
        wrong = self.judge(kind, outcome, failed)
        if wrong:
            self.failed += 1
            print(f"FAILED {self.scene.name}, {kind} {at}, {words}: {wrong}", flush=True)
            return
        self.passed.add(f"{self.scene.name} {kind} {at}")
        if self.arguments.list:
            print(f"{self.scene.name}, {kind} {at}, {words}: {outcome.status} {outcome.stderr.strip()}", flush=True)

    def one_by_one(self, kind, chosen):
        """A run for each call; how many came."""
        for at in chosen:
            outcome, (_, failed, words) = self.disturbed(kind, at)
            self.note(kind, at, outcome, failed, words)
        return len(chosen)

    def in_copies(self, kind, chosen):
        """All of them in copies of one run, which itself must end as if nothing had been; how many came."""
        calls, more = KINDS[kind]
        self.lay_out()
        run, n = Branches(self.serve, self.folder, self.scene.words, served.plan("out", self.report, calls, 0, **more)), 0
        for at, words, outcome in run.each(chosen):
            self.note(kind, at, outcome, True, words)
            n += 1
        if run.outcome.status != 0 or contents(self.folder / "out", self.ranks) != self.well:
            raise SystemExit(f"FAILED: {self.scene.name}, {kind}: the run itself changed, exit status {run.outcome.status}: "
                             f"{run.outcome.stderr[-300:]}")
        return n

    def number(self, kind):
        """How many calls of that kind a run makes."""
        calls = KINDS[kind][0]
        if calls not in self.numbers:
            outcome, (self.numbers[calls], _, _) = self.disturbed(kind, 0)
            if outcome.status != 0 or not self.numbers[calls]:
                raise SystemExit(f"FAILED: {self.scene.name}, {kind}, undisturbed: exit status {outcome.status}: {outcome.stderr}")
        return self.numbers[calls]

    def all(self, kind):
        n = self.number(kind)
        wanted = self.arguments.one or self.chosen(n)
        chosen = [at for at in wanted if f"{self.scene.name} {kind} {at}" not in self.passed]
        before = len(wanted) - len(chosen)
        tried = self.in_copies(kind, chosen) if self.ranks == 1 else self.one_by_one(kind, chosen)
        print(f"{self.scene.name}, {kind}: {n} calls, {tried} of them tried{f', {before} before' if before else ''}", flush=True)

    def chosen(self, n):
        """Numbers of the calls to try: all, or an even sample whose places differ from scene to scene."""
        most = min(self.arguments.most or n, n)
        shift = sum(map(ord, self.scene.name)) % 10 / 10
        return sorted({1 + int((i + shift) * n / most) for i in range(most)})

    def end(self):
        self.serve.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=served.existing)
    parser.add_argument("library", type=served.existing, help="build/tests/libfault.so")
    parser.add_argument("--scene", action="append", choices=[scene.name for scene in scenes.SCENES])
    parser.add_argument("--kind", action="append", choices=list(KINDS))
    parser.add_argument("--most", type=int, help="calls of each kind and scene")
    parser.add_argument("--one", type=int, nargs="+", help="these calls alone")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--limit", type=float, default=90, help="seconds a run may take")
    parser.add_argument("--list", action="store_true", help="say how each run ended")
    parser.add_argument("--passed", type=Path, help="a file to note what passed, from which a test that was stopped goes on")
    arguments = parser.parse_args()
    passed, failed = Passed(arguments.passed, arguments.squeal, arguments.library), 0
    with tempfile.TemporaryDirectory(prefix="squeal-fault-") as name:
        for scene in scenes.SCENES:
            if arguments.scene and scene.name not in arguments.scene:
                continue
            faults = Faults(arguments, scene, Path(name) / scene.name, passed)
            for kind in arguments.kind or ["memory", "files", "disk", "kill", "stop"]:
                faults.all(kind)
            faults.end()
            failed += faults.failed
    passed.end()
    print(f"{failed} faults not handled")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
