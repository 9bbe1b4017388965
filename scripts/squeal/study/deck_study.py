"""What becomes of decks of others: each is imported in a process of its own, with a limit of time and memory; CalculiX says
of its own which of them it runs."""

import collections
import concurrent.futures
import csv
import hashlib
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from ..decks.convert import READERS, convert
from ..tables import BadInput, print_table, run, whole

MEMORY, MEMORY_CCX = 4 << 30, 32 << 30  # bytes of addresses of an import, and of ccx, which takes more than it touches
SOLIDS = {".inp": rb"^[ \t]*\*\s*ELEMENT\b[^\n]*C3D(4|6|8|10|15|20|27)", ".cdb": rb"^(ET|UNBL|NBLOCK)",
          ".bdf": rb"^[ \t]*(CTETRA|CPENTA|CHEXA)"}
SOLIDS |= {".nas": SOLIDS[".bdf"], ".dat": SOLIDS[".bdf"]}
OUTCOMES = "imported", "unbalanced", "refused", "trace", "hang", "no solids"
BAD = "unbalanced", "trace", "hang"
NO_SOLIDS = "there are no volume elements"
UNBALANCED = "UNBALANCED"  # the mark of such a line of scripts/import


def found(folders, kinds):
    """Files of all kinds that scripts/import reads; of those with the same bytes and name's end the first."""
    missing = [str(folder) for folder in folders if not folder.is_dir()]
    if missing:
        raise BadInput(f"{missing[0]}: no such folder")
    paths = sorted(path for folder in folders for path in folder.rglob("*") if path.suffix.lower() in kinds and path.is_file())
    first = {}
    for path in paths:
        first.setdefault((path.suffix.lower(), hashlib.sha256(path.read_bytes()).digest()), path)
    return list(first.values())


def has_solids(path, depth=0):
    """Whether a deck, or a file that it includes, has elements of solids."""
    pattern = SOLIDS.get(path.suffix.lower(), SOLIDS[".inp"] if depth else None)
    if pattern is None:
        return True
    data = path.read_bytes()
    if re.search(pattern, data, re.M | re.I):
        return True
    names = re.findall(rb"^[ \t]*\*[^\n]*INPUT\s*=\s*\"?([^,\"\n]+)", data, re.M | re.I) if depth < 3 else []
    inner = [path.parent / name.decode("latin-1").strip() for name in names]
    return any(has_solids(other, depth + 1) for other in inner if other.is_file())


def imported(path, folder, seconds):
    """Exit status (None where time was up), what was said, seconds."""
    said, begin = folder / "said", time.monotonic()
    child = os.fork()
    if not child:
        os.setpgid(0, 0)
        with said.open("w") as out:
            os.dup2(out.fileno(), 1)
            os.dup2(out.fileno(), 2)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        sys.stdout, sys.stderr, status = open(1, "w", closefd=False), open(2, "w", closefd=False), 70
        try:
            status = run("import", lambda: "\n".join(convert(path, "m-kg-s", folder / "deck")))
        except BaseException:  # pylint: disable=broad-except
            sys.__excepthook__(*sys.exc_info())
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(status)
    while not (ended := os.waitpid(child, os.WNOHANG))[0]:
        if time.monotonic() - begin > seconds:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return None, "", seconds
        time.sleep(0.002)
    return os.waitstatus_to_exitcode(ended[1]), said.read_text(errors="replace"), time.monotonic() - begin


def outcome(path, seconds):
    """One of OUTCOMES, the line that tells why, and s."""
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        status, said, took = imported(path, Path(name), seconds)
    lines = said.strip().splitlines()
    if status is None:
        return "hang", f"not ended in {seconds:g} s", took
    if status == 0:
        wrong = [line for line in lines if UNBALANCED in line]
        return ("unbalanced", wrong[0], took) if wrong else ("imported", "", took)
    if NO_SOLIDS in said or not has_solids(path):
        return "no solids", lines[-1] if lines else "", took
    return "refused" if status == 1 and len(lines) == 1 else "trace", lines[-1] if lines else f"status {status}", took


def ccx_runs(path, seconds):
    """Whether CalculiX runs a deck: "runs", "slow" where it was still at it, or the error."""
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name)
        for other in path.parent.iterdir():
            if other.is_file():
                (folder / other.name).symlink_to(other.resolve())
        (folder / "deck.inp").unlink(missing_ok=True)
        shutil.copy(path, folder / "deck.inp")
        limit = f"ulimit -v {MEMORY_CCX >> 10}; exec nice ccx deck"
        try:
            done = subprocess.run(["bash", "-c", limit], cwd=folder, capture_output=True, timeout=seconds, check=False)
        except subprocess.TimeoutExpired:
            return "slow"
    text = done.stdout.decode("latin-1")
    if "Job finished" in text:
        return "runs"
    errors = re.findall(r"\*ERROR[^\n]*", text)
    return f"refused: {errors[0][:100] if errors else f'status {done.returncode}'}"


class Kept:
    """What ccx said, by the bytes of the deck."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        if path.is_file():
            with path.open(newline="") as lines:
                self.rows = dict(csv.reader(lines))

    def ask(self, path, seconds):
        key = hashlib.sha256(path.read_bytes()).hexdigest()
        if key not in self.rows:
            self.rows[key] = ccx_runs(path, seconds)
            with self.path.open("a", newline="") as out:
                csv.writer(out).writerow([key, self.rows[key]])
        return self.rows[key]


def reason(line):
    """What refusals have in common: without file, line, names and numbers."""
    text = re.sub(r"^import: (\S*:\d+: )?", "", line)
    text = re.sub(r"/\S*/(\S+)", r"\1", text)
    return re.sub(r"\s+", " ", re.sub(r"'[^']*'|[-+\d.]+(e[-+]?\d+)?", "#", text))[:90]


def judge(path, args, kept):
    """A row of the table."""
    what, line, took = outcome(path, args.seconds)
    said = kept.ask(path, args.ccx_seconds) if kept and path.suffix.lower() == ".inp" and what != "no solids" else ""
    return {"file": str(path), "kind": path.suffix.lower(), "outcome": what, "ccx": said, "import_s": f"{took:.3g}", "why": line}


def write_rows(path, rows):
    with whole(path) as part, part.open("w", newline="") as out:
        table = csv.DictWriter(out, list(rows[0]))
        table.writeheader()
        table.writerows(rows)


def counts(rows):
    """Lines of the table by kind, and of those that their own program runs."""
    groups = {kind: [row for row in rows if row["kind"] == kind] for kind in sorted({row["kind"] for row in rows})}
    ran = [row for row in rows if row["ccx"] in ("runs", "slow")]
    if ran:
        groups[".inp, ccx runs"] = ran
    table = [("kind", "files", *OUTCOMES, "share")]
    for kind, chosen in groups.items():
        number = collections.Counter(row["outcome"] for row in chosen)
        solid = len(chosen) - number["no solids"]
        share = f"{100 * number['imported'] / solid:.1f} %" if solid else ""
        table.append((kind, str(len(chosen)), *(str(number[what]) for what in OUTCOMES), share))
    return table


def study(args, faults):
    """Prints the table and the reasons, writes decks.csv."""
    args.output.mkdir(parents=True, exist_ok=True)
    paths = found(args.folders, [kind.lower() for kind in args.kind or READERS])
    if not paths:
        raise BadInput(f"{args.folders[0]}: has no deck that scripts/import reads ({', '.join(READERS)})")
    kept = Kept(args.output / "ccx.csv") if shutil.which("ccx") and not args.no_ccx else None
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = list(pool.map(lambda path: judge(path, args, kept), paths))
    write_rows(args.output / "decks.csv", rows)
    print_table(f"{len(rows)} decks (share: imported of those with solids)", *counts(rows))
    alike = collections.defaultdict(list)
    for row in rows:
        if row["outcome"] not in ("imported", "no solids"):
            alike[row["outcome"], row["kind"], reason(row["why"])].append(row)
    for (what, kind, why), same in sorted(alike.items(), key=lambda item: (item[0][:2], -len(item[1]))):
        ran = sum(row["ccx"] in ("runs", "slow") for row in same)
        print(f"{what} {kind} {len(same)}{f' ({ran} that ccx runs)' if ran else ''}: {why}   e.g. {Path(same[0]['file']).name}")
    faults += [row for row in rows if row["outcome"] in BAD]
    return args.output / "decks.csv"
