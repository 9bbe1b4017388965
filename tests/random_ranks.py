#!/usr/bin/env python3
"""Random small scenes of every analysis on 1, 2, 3 and 5 ranks, some of which have few unknowns or none: the same tables, none hangs.

    random_ranks.py build/squeal --kind map,cycle --first 40 --count 40

Scenes are those of random_scenes.py on coarser meshes, with loads in time, rings that hang on nothing, and random matrices. Breaks when a
rank decides from its own rows what all must decide alike, when how far an iteration came or the order of the parts shows in a result, or
when rounding resolves a tie between equal values. Reference: one rank. Numbers agree to 1e-9 of the largest of their unit in the
table; eigenvalues and onsets to 1e-9 or to what both state as their errors; where no left vectors were asked for, a run on one
rank that has them tells the condition of each eigenvalue. Where they do not, one rank runs again with the last
digit of the disc's density changed: what that does to a row of a run in time, or to a map or a cycle, ranks may do a thousand times;
the rest of a run that is chaotic is so not compared. A run with that digit that ends otherwise, or lacks a table or rows, excuses
nothing there. What one number of ranks refuses all refuse, in the same words; --refused says how many may be. --keep DIR keeps the
folders of scenes that differ. Exit status: 0, 1 where ranks differ or too many scenes are refused."""

import argparse
import re
import shutil
import sys
import tempfile
from pathlib import Path

from rank_scenes import IN_TIME, KINDS, scene_of
from rank_tables import compared
from served import own_words, starter

LIMIT = 40  # processor seconds of a run; by the clock five times as many
DIGIT = "-disc_density", "7800.000000000001"


class Runs:
    """Runs of one scene in a folder of its own, and what differs."""

    def __init__(self, start, kind, seed, folder):
        self.start, self.kind, self.folder, self.found, self.chaotic, self.worst = start, kind, folder, [], 0, 0.0
        self.other, self.known = None, None  # folders with another digit and with left vectors, and their outcomes
        text, self.words = scene_of(kind, seed)
        (folder / "scene.yaml").write_text(text)
        (folder / "words").write_text(" ".join(self.words))

    def run(self, name, ranks, *more):
        """Output folder and how the run ended."""
        words = [*self.words, *more, "-output_dir", self.folder / name, "-output_fields", "0"]
        return self.folder / name, self.start.run(self.folder, words) if ranks == 1 else self.start.join(self.folder, words, ranks)

    def digit(self):
        """Folder of one rank with another digit; none where that is another scene's business, or where that run fails: the first
        one did not."""
        if self.kind not in IN_TIME:
            return None
        self.other = self.other or self.run("digit", 1, *DIGIT)
        return self.other[0] if self.other[1].status == 0 else None

    def left(self):
        """Folder of one rank with left vectors where the scene has none, and so no errors."""
        if self.kind != "modes" or "-modes_left" not in self.words:
            return None
        self.known = self.known or self.run("left", 1, "-modes_left", "1")
        return self.known[0] if self.known[1].status == 0 else None

    def beside(self, ranks, first, out):
        """Compares the tables of two folders."""
        tables, missing = compared(first, out)
        if any(table.found for table in tables) and (self.digit() or self.left()):
            tables, missing = compared(first, out, self.digit(), self.left())
        self.chaotic += any(table.first < len(table.one) for table in tables)
        self.worst = max([self.worst, *(table.worst for table in tables)])
        differences = missing + [text for table in tables for text in table.found]
        if differences:
            self.found.append(f"on {ranks} {len(differences)}: {'; '.join(differences[:3])}")

    def judge(self, numbers):
        """Whether one rank succeeded; all others beside it."""
        first, alone = self.run("out1", 1)
        for ranks in numbers:
            out, outcome = self.run(f"out{ranks}", ranks)
            if outcome.status is None:
                self.found.append(f"on {ranks}: no end")
            elif bool(outcome.status) != bool(alone.status) or said(outcome) != said(alone):
                self.found.append(f"on {ranks}: {alone.status} {said(alone)} and {outcome.status} {said(outcome)}")
            elif outcome.status == 0:
                self.beside(ranks, first, out)
        return alone


def said(outcome):
    """Errors and warnings without numbers."""
    lines = [line for line in own_words(outcome.stderr).splitlines() if line.strip()]
    return sorted(re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", line) for line in lines)


def judge(arguments, start, kind, seed):
    """Runs of a scene, and whether one rank solved it."""
    with tempfile.TemporaryDirectory(prefix="squeal-ranks-") as name:
        runs = Runs(start, kind, seed, Path(name))
        alone = runs.judge([int(n) for n in arguments.ranks.split(",")])
        if runs.found and arguments.keep:
            shutil.copytree(name, arguments.keep / f"{kind}-{seed}", dirs_exist_ok=True)
    result = f"same, {runs.worst:.1e}{', chaotic' if runs.chaotic else ''}"
    if alone.status != 0:
        result = f"refused: {(alone.errors or ['killed'])[0][:120]}"
    if runs.found:
        result = f"FAILED: {'; '.join(runs.found)}\n  random_ranks.py {arguments.squeal} --kind {kind} --first {seed} --count 1"
    print(f"{kind} {seed}: {result}", flush=True)
    return runs, alone.status == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("squeal", type=Path)
    parser.add_argument("--kind", default=",".join(KINDS), help=f"of {', '.join(KINDS)}")
    parser.add_argument("--first", type=int, default=0, help="number of the first scene of each kind")
    parser.add_argument("--count", type=int, default=2, help="of each kind")
    parser.add_argument("--scenes", help="KIND:NUMBER,... in place of these")
    parser.add_argument("--ranks", default="2,3,5", help="beside one")
    parser.add_argument("--refused", type=float, default=0, metavar="SHARE", help="of the scenes of a kind that may be refused (0)")
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    start, failed = starter(arguments.squeal, LIMIT), 0
    scenes = {kind: range(arguments.first, arguments.first + arguments.count) for kind in arguments.kind.split(",")}
    if arguments.scenes:
        chosen = [word.split(":") for word in arguments.scenes.split(",")]
        scenes = {kind: [int(number) for other, number in chosen if other == kind] for kind, _ in chosen}
    for kind, seeds in scenes.items():
        judged = [judge(arguments, start, kind, seed) for seed in seeds]
        different, solved = sum(bool(runs.found) for runs, _ in judged), sum(done for _, done in judged)
        failed += different + (len(judged) - solved > arguments.refused * len(judged))
        print(f"{kind}: {len(judged)} scenes, {solved} solved, {sum(runs.chaotic > 0 for runs, _ in judged)} chaotic, {different} differ, "
              f"others by at most {max(runs.worst for runs, _ in judged):.1e}")
    start.end()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
