#!/usr/bin/env python3
"""Damaged inputs: options, YAML (also of maps, cycles and terms), meshes in four formats and of second order, PETSc matrices alone and as
terms, checkpoints, tables of a run that goes on, shapes, and what sweeps and maps keep. Each is damaged in one way (damage.py), drawn
from a seed, and run on one rank, one in twenty on two. Judged is

  end      no signal, and an end within the limit of processor time
  message  on failure exactly one line, "squeal: error: ...", and nothing of PETSc, MPI or the C library
  files    on failure no table or field in a folder that was empty
  answer   on success numbers that are finite; where the damage keeps the meaning, those of the undamaged input; where the file has a
           checksum, too, whatever was changed; of options, matrices, terms and meshes what other readers find (judges.py)

    fuzz.py build/squeal build/tests/libfault.so --first 2500 --count 2500 --passed FILE

--only KIND runs one kind, --one N one input alone and keeps its folder; with --passed a test that was stopped goes on. Exit status: 0,
1 when an input was not handled."""

import argparse
import collections
import csv
import math
import random
import shutil
import signal
import struct
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import judges
import scenes

sys.path.append(str(Path(__file__).resolve().parents[1]))
import served  # noqa: E402
from passed import Passed  # noqa: E402

FINAL = {".csv", ".h5", ".xmf", ".bin"}
TOLERANCE = 1e-9


def numbers(path):
    """All cells of a table that are numbers, by column."""
    with path.open(newline="", errors="replace") as file:
        rows = list(csv.DictReader(file))
    found = collections.defaultdict(list)
    for row in rows:
        for key, cell in row.items():
            try:
                found[key].append(float(cell))
            except (TypeError, ValueError):
                found[key].append(cell)
    return found


def largest(column):
    """Of the numbers in a column, by size."""
    return max((abs(x) for x in column if isinstance(x, float) and x == x), default=0)


def same(one, other, rtol):
    """Whether two tables agree, but for rounding."""
    skip = {"backward_error", "condition", "error_hz", "error_estimate", "energy_error_j", "projector_residual", "residual"}
    if set(one) != set(other):
        return False
    energy = max((largest(other[key]) for key in other if key.endswith("_j")), default=0)  # works are differences of them
    for key in set(one) - skip:
        if len(one[key]) != len(other[key]):
            return False
        scale = energy if key.endswith("_j") else largest(other[key])
        for a, b in zip(one[key], other[key]):
            numbers = isinstance(a, float) and isinstance(b, float)
            if a != b and not (numbers and (abs(a - b) <= rtol * scale or a != a and b != b)):  # nan: no frequency
                return False
    return True


def finite(table):
    """Whether the eigenvalues and histories are numbers; what may be unknown is left out."""
    unknown = {"condition", "error_hz", "onset_distance", "error_estimate"}
    if "regime" in table:  # of a map: a point that does not vibrate has no frequency
        unknown |= {"freq_hz", "freq_error_hz", "freq_2_hz", "freq_2_error_hz", "growth_freq_hz"}
    done = [status != "failed" for status in table.get("status", [])]  # a point of a map that failed says so, and has no numbers
    return all(math.isfinite(x) for key, column in table.items() if key not in unknown
               for i, x in enumerate(column) if isinstance(x, float) and (not done or done[i]))


def other_analysis(path, name):
    """Whether scene.yaml of a run says that this is another analysis."""
    try:
        return path.exists() and judges.wanted_keys(path).get("analysis", "modes") != name
    except (ValueError, judges.yaml.YAMLError):  # then it says nothing
        return False


def all_failed(path):
    """Whether a map has rows that say so: its points failed one by one, and the table is what is left of them."""
    rows = list(csv.DictReader(path.open())) if path.exists() else []
    return bool(rows) and all(row["status"] == "failed" for row in rows)


class Fuzz:
    """Inputs of all kinds, and the verdict on each."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.made = folder / "made"
        self.made.mkdir()
        self.bases = [base for base in scenes.bases(arguments.squeal, self.made)
                      if not arguments.only or arguments.only in base.name]
        self.answers, self.passed = {}, Passed(arguments.passed, arguments.squeal, arguments.library)
        self.mine, self.loops = threading.local(), []

    def launch(self, work, words, ranks=1, folder="out"):
        """Behind the loop of this thread, which has the libraries already."""
        words = (*words, "-output_dir", folder, "-output_fields", "0")
        if not hasattr(self.mine, "loop"):
            self.mine.loop = served.Served(self.arguments.squeal, self.arguments.library, self.arguments.limit)
            self.loops.append(self.mine.loop)
        result = self.mine.loop.run(work, words) if ranks == 1 else self.mine.loop.join(work, words, ranks)
        return result.status, served.own_words(result.stderr)

    def answer(self, base):
        """Of the undamaged input."""
        work = self.folder / f"base {base.name}"
        scenes.lay_out(base, self.made, work)
        status, stderr = self.launch(work, base.words)
        if status != 0:
            raise SystemExit(f"the undamaged {base.name} fails: {stderr}")
        found = numbers(work / "out" / base.table)
        shutil.rmtree(work)
        return found

    def damage(self, base, work, draw):
        """Damages one file, or one word of the options; what was done, whether the meaning stays, the words."""
        change = draw.choice(base.damages)
        words = list(base.words)
        if base.files:
            path = work / draw.choice(base.files)
            before = path.read_bytes()
            after, kept = change(draw, before)
            name = change.__name__
            if draw.random() < 0.25:  # two faults at once
                more = draw.choice(base.damages)
                after, kept_too = more(draw, after)
                name, kept = f"{name} and {more.__name__}", kept and kept_too
            path.write_bytes(after)
            return f"{name} of {path.name}", kept or after == before, words
        if draw.random() < 0.1:  # the order of options tells nothing
            pairs = [words[i:i + 2] for i in range(0, len(words), 2)]
            draw.shuffle(pairs)
            return "options in another order", True, [word for pair in pairs for word in pair]
        at = draw.randrange(len(words))
        after, kept = change(draw, words[at].encode())
        after = after.replace(b"\0", b"0")
        kept = after == words[at].encode()
        words[at] = after
        return f"{change.__name__}: {words[at]!r} for {base.words[at]}", kept, words

    def judge(self, base, work, kept, words, ranks, result):
        """What is wrong, empty for nothing."""
        status, stderr = result
        lines = [line for line in stderr.split("\n") if line.strip() and not line.startswith("squeal: warning: ")]
        if status is None or status == -signal.SIGXCPU:
            return f"no end within {self.arguments.limit:g} s of a processor, or {served.PATIENCE} times that"
        if status < 0 or status > 100:
            return f"signal or abort {status}: {stderr[-300:]}"
        if status:
            if len(lines) != 1 or not lines[0].startswith("squeal: error: ") or len(lines[0]) < 25:
                return f"message of {len(lines)} lines: {stderr[:300]}"
            left = [] if base.folder else [path.name for path in work.glob("out/*")
                                           if path.suffix in FINAL and path.name not in base.complete]
            return f"{left} left behind" if left and not all_failed(work / "out/map.csv") else ""
        if lines:
            return f"words of a run that succeeds: {stderr[:300]}"
        return self.judge_answer(base, work, kept, words, ranks)

    def judge_answer(self, base, work, kept, words, ranks):
        path = work / "out" / base.table
        if not path.exists():
            other = not kept and (base.name == "options" or base.name in ("map", "cycle")
                                  and other_analysis(work / "out/scene.yaml", base.name))
            return "" if other else f"success without {base.table}"
        found = numbers(path)
        if not finite(found):
            return f"{base.table} holds what is not finite"
        rtol = TOLERANCE if ranks == 1 else base.rtol
        if (kept or base.sealed) and not same(found, self.answers[base.name], rtol):
            return "another answer"
        return self.judge_meaning(base, work, words, found)

    def judge_meaning(self, base, work, words, found):
        """By readers of our own (judges.py); what they cannot read and squeal can is one too."""
        def again(name):
            at = words.index("-model_mesh") + 1
            status, stderr = self.launch(work, [*words[:at], name, *words[at + 1:]], folder="again")
            return stderr if status else numbers(work / "again/modes.csv")

        try:
            if base.name.startswith("mesh"):
                return judges.mesh(work, found, words, again)
            wrong = judges.keys(work, words) if "-options_file" in words else ""
            judge = {"matrix": judges.matrices, "affine": judges.affine, "affine files": judges.affine, "options": judges.words}
            return wrong or (judge[base.name](work, found, words) if base.name in judge else "")
        except (ArithmeticError, LookupError, ValueError, TypeError, np.linalg.LinAlgError, struct.error, judges.yaml.YAMLError) as error:
            return f"accepted, and a plain reading fails: {type(error).__name__}: {error}"

    def make(self, n):
        """Input n: its kind, what was done, and what is wrong."""
        base = self.bases[n % len(self.bases)]
        work = self.folder / f"input {n}"
        draw = random.Random(f"{self.arguments.seed} {n}")
        scenes.lay_out(base, self.made, work)
        done, kept, words = self.damage(base, work, draw)
        ranks = 2 if n // len(self.bases) % 20 == 19 and not base.folder else 1  # what a run left is of as many ranks
        result = self.launch(work, words, ranks)
        wrong = self.judge(base, work, kept, words, ranks, result)
        if self.arguments.one is None:
            shutil.rmtree(work)
        done = done if ranks == 1 else f"{done}, on {ranks} ranks"
        if wrong:
            print(f"FAILED input {n}, {base.name}, {done}: {wrong}", flush=True)
        else:
            self.passed.add(str(n))
        return n, base.name, done, wrong, result[0]

    def run(self):
        with ThreadPoolExecutor(self.arguments.jobs) as pool:
            self.answers = dict(zip((base.name for base in self.bases), pool.map(self.answer, self.bases)))
            first, one = self.arguments.first, self.arguments.one
            chosen = range(first, first + self.arguments.count) if one is None else [one]
            results = list(pool.map(self.make, [n for n in chosen if str(n) not in self.passed]))
        self.passed.end()
        for loop in self.loops:
            loop.end()
        kinds = collections.Counter((name, "ends well" if not status else "refused") for _, name, _, _, status in results)
        for (name, how), n in sorted(kinds.items()):
            print(f"{name:20} {how:10} {n}")
        if self.arguments.list:
            for n, name, done, _, status in results:
                print(f"input {n}, {name}, {done}: exit status {status}")
        wrong = [result for result in results if result[3]]
        before = len(chosen) - len(results)
        print(f"{len(results)} inputs{f', {before} before' if before else ''}, {len(wrong)} not handled")
        return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=served.existing)
    parser.add_argument("library", type=served.existing, help="build/tests/libfault.so")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    parser.add_argument("--passed", type=Path, help="a file to note what passed, from which a test that was stopped goes on")
    parser.add_argument("--seed", default="2005")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=90, help="seconds of a processor that a run may take")
    parser.add_argument("--only", help="one kind")
    parser.add_argument("--list", action="store_true", help="say what was done to each input, and its exit status")
    parser.add_argument("--one", type=int, help="one input, whose folder is kept")
    arguments = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="squeal-fuzz-"))
    try:
        return Fuzz(arguments, folder).run()
    finally:
        if arguments.one is None:
            shutil.rmtree(folder, ignore_errors=True)
        else:
            print(folder)


if __name__ == "__main__":
    sys.exit(main())
