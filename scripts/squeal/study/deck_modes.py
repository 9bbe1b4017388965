"""Frequencies of decks of others: those of CalculiX beside those of squeal after scripts/import, and why they differ where they do."""

import collections
import csv
import hashlib
import itertools
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy

from ..tables import BadInput, print_row
from .deck_study import found, has_solids, imported, write_rows

SAME = 1e-5  # of a frequency
RIGID = 1e-4  # of the largest: less is a rigid motion
MORE = 8  # modes of squeal beyond those of CalculiX: rigid ones, and ends of equal ones
ASKS = re.compile(r"^[ \t]*\*\s*FREQUENCY\b", re.M | re.I)
TYPES = re.compile(r"^[ \t]*\*\s*ELEMENT\b[^\n]*?TYPE\s*=\s*(\w+)", re.M | re.I)
INCLUDE = re.compile(r"^[ \t]*\*\s*INCLUDE\s*,\s*INPUT\s*=\s*\"?([^,\"\n]+)\"?[ \t]*$", re.M | re.I)
BEGIN, END = "E I G E N V A L U E   O U T P U T", "P A R T I C I P A T I O N"
ROW = re.compile(r"^\s+(?:\d+\s+)?\d+\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", re.M)
# What is written in place of what, and what that means
CHANGES = ((re.compile(r"\bC3D20R\b", re.I), "C3D20", "C3D20 for C3D20R"),
           (re.compile(r"\bC3D8R\b", re.I), "C3D8", "C3D8 for C3D8R"),
           (re.compile(r"^([ \t]*\*\s*STEP\b[^\n]*?),\s*PERTURBATION\b", re.M | re.I), r"\1", "no stress of an earlier step"))
FULL = ["-model_element", "full"]
OWN = {"C3D8I": "incompatible modes of CalculiX are not QM6", "C3D4": "its mass has 1 point in CalculiX",
       "C3D10": "its mass has 4 points in CalculiX", "C3D6": "its mass has 2 points in CalculiX",
       "C3D15": "its mass has 9 points in CalculiX"}
FAULT, NOTE = "unexplained", re.compile(r"^\S+:\d+: (.*)")
IDLE = re.compile("output, not needed|analysis|not needed|not written|are taken, as CalculiX does")


def frequencies_of(text):
    """Hz of the last *FREQUENCY that a .dat file holds; below 0 where the square is negative."""
    _, begun, last = text.rpartition(BEGIN)
    rows = [tuple(map(float, row)) for row in ROW.findall(last.partition(END)[0])] if begun else []
    return numpy.array([row[2] if row[0] >= 0 else -row[3] for row in rows])


def ccx(path, text, seconds):
    """Frequencies that CalculiX finds in a deck of this text, beside the other files of its folder; or why there are none."""
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        for other in path.parent.iterdir():
            if other.is_file() and other.suffix not in (".frd", ".dat") and other.name != "deck.inp":
                (folder / other.name).symlink_to(other.resolve())
        (folder / "deck.inp").write_text(text, encoding="latin-1")
        try:
            done = subprocess.run(["nice", "ccx", "deck"], cwd=folder, capture_output=True, timeout=seconds, check=False)
        except subprocess.TimeoutExpired:
            return None, f"not ended in {seconds:g} s"
        said = done.stdout.decode("latin-1")
        dat = folder / "deck.dat"
        if "Job finished" not in said or not dat.is_file():
            errors = re.findall(r"\*ERROR[^\n]*(?:\n[^\n]+)?", said)
            return None, " ".join(errors[0].split())[:120] if errors else f"status {done.returncode}"
        return frequencies_of(dat.read_text(encoding="latin-1")), ""


def squeal(path, args, count, options=()):
    """Frequencies of the scene of a deck with options, and what scripts/import said; None and why where one of both refused it."""
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        status, said, _ = imported(path, folder, args.seconds)
        if status != 0:
            return None, said.strip().splitlines()[-1:] or ["not ended in time"]
        scene = folder / "deck.yaml"
        lines = [re.sub(r'band: "[^"]*"|target: \S+, count: \d+', f"target: 1, count: {count + MORE}", line)
                 if line.startswith("modes:") else line for line in scene.read_text(encoding="utf-8").splitlines()]
        scene.write_text("\n".join(lines) + "\n", encoding="utf-8")
        try:
            done = subprocess.run([args.program, "-options_file", "deck.yaml", "-output_dir", "out", "-output_fields", "0", *options],
                                  cwd=folder, capture_output=True, text=True, timeout=args.seconds, check=False)
        except subprocess.TimeoutExpired:
            return None, [f"squeal: not ended in {args.seconds:g} s"]
        if done.returncode:
            return None, done.stderr.strip().splitlines()[:1] or [f"squeal: status {done.returncode}"]
        with (folder / "out/modes.csv").open(newline="") as rows:
            return numpy.array(sorted(float(row["freq_hz"]) for row in csv.DictReader(rows))), said.splitlines()


def apart(theirs, ours):
    """Largest relative difference of frequencies of no rigid motion, infinite where some are missing."""
    limit = RIGID * max(theirs)
    theirs, ours = numpy.sort(theirs[theirs > limit]), ours[ours > limit]
    return numpy.inf if len(ours) < len(theirs) else float(max(abs(ours[:len(theirs)] / theirs - 1)))


def changes(text):
    """The deck with each choice of changes that it has something for, fewest first, and what was changed."""
    some = [change for change in CHANGES if change[0].search(text)]
    for n in range(1, len(some) + 1):
        for chosen in itertools.combinations(some, n):
            other = text
            for pattern, by, _ in chosen:
                other = pattern.sub(by, other)
            yield other, [meaning for _, _, meaning in chosen]


def best_changed(path, args, text, theirs, ours):
    """The least that both are apart with changes, up to the first that is enough, and these changes."""
    full = None
    if re.search(r"\bC3D8R?\b", text, re.I):
        full, _ = squeal(path, args, len(theirs), FULL)
    least, said = apart(theirs, full) if full is not None else numpy.inf, ["-model_element full"]
    for other, words in changes(text):
        if least <= SAME:
            break
        found_by, _ = ccx(path, other, args.seconds)
        for own, more in ((ours, []), (full, ["-model_element full"])):
            if own is not None and found_by is not None and len(found_by) and max(found_by) > 0:
                least, said = min((least, said), (apart(found_by, own), words + more))
    return least, said


def reasons(said, kinds):
    """What changes a frequency: elements that differ, things that are not in the scene."""
    notes = [match[1] for match in map(NOTE.match, said) if match]
    own = [f"{kind}: {OWN[kind]}" for kind in kinds if kind in OWN]
    return own + [note.removeprefix("differs: ") for note in notes if not IDLE.search(note)]


def whole_text(path, depth=0):
    """A deck with the files that it includes in their places."""
    text = path.read_text(encoding="latin-1")
    if depth > 3:
        return text
    inner = lambda found: whole_text(path.parent / found[1].strip(), depth + 1) if (path.parent / found[1].strip()).is_file() else found[0]
    return INCLUDE.sub(inner, text)


def judge(path, args):
    """A row of the table."""
    text = whole_text(path)
    kinds = sorted({kind.upper() for kind in TYPES.findall(text)})
    row = {"file": str(path), "elements": " ".join(kinds), "outcome": "no ccx", "modes": "", "apart": "", "apart_changed": "", "why": ""}
    theirs, why = ccx(path, text, args.seconds)
    if theirs is None:
        return row | {"why": why}
    if not len(theirs) or max(theirs) <= 0:
        return row | {"outcome": "no mode"}
    ours, said = squeal(path, args, len(theirs))
    row["modes"] = str(len(theirs))
    if ours is None:
        return row | {"outcome": "refused", "why": said[0][:200] if said else ""}
    worst = apart(theirs, ours)
    row["apart"] = f"{worst:.2g}"
    if worst <= SAME:
        return row | {"outcome": "same"}
    least, words = best_changed(path, args, text, theirs, ours)
    row["apart_changed"] = f"{least:.2g}" if numpy.isfinite(least) else ""
    if least <= SAME:
        return row | {"outcome": "as same", "why": "; ".join(words)}
    notes = reasons(said, kinds)
    return row | {"outcome": "explained" if notes else FAULT, "why": "; ".join(dict.fromkeys(notes))}


def decks(folders):
    """Decks that ask for frequencies of solids, each content once."""
    seen = {}
    for path in found(folders, [".inp"]):
        if ASKS.search(path.read_text(encoding="latin-1")) and has_solids(path):
            seen.setdefault(hashlib.sha256(path.read_bytes()).digest(), path)
    return list(seen.values())


def study(args, faults):
    """Prints a row of each deck and the sums, writes deck_modes.csv."""
    if not shutil.which("ccx"):
        raise BadInput("no ccx here: install calculix-ccx")
    args.output.mkdir(parents=True, exist_ok=True)
    paths = decks(args.folders)
    if not paths:
        raise BadInput(f"{args.folders[0]}: has no .inp with solids that asks for *FREQUENCY")
    rows = []
    print_row("deck", "elements", "outcome", "modes", "apart", "changed", "why")
    print_row(*7 * ["---"])
    for path in paths:
        rows.append(judge(path, args))
        row = rows[-1]
        print_row(path.name, row["elements"], row["outcome"], row["modes"], row["apart"], row["apart_changed"], row["why"][:160])
    write_rows(args.output / "deck_modes.csv", rows)
    number = collections.Counter(row["outcome"] for row in rows)
    print(f"\n{len(rows)} decks: " + ", ".join(f"{number[what]} {what}" for what in sorted(number)))
    faults += [row for row in rows if row["outcome"] == FAULT]
    return args.output / "deck_modes.csv"
