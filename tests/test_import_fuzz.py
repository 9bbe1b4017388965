#!/usr/bin/env python3
"""Damaged decks: for each format files that are cut off, or have bytes, digits, words, lines or whole pieces changed, lost
or put twice, also of decks of several files and steps, and of what current versions of Ansys write (damaged_decks.py).
scripts/import must refuse each with one line that names the file and a line of it, or write what the damaged file
still says: the places of the nodes of every element, read back from the mesh file, are those that a plain reading of the
damaged text, line by line, gives (texts; meshio's formats are checked for being whole and finite). A deck that ends early is
never taken without saying so. Where a letter of a keyword, parameter or label is wrong, or an object of a file of MED is gone, another
scene or balance comes with another list of what is not in it.

    test_import_fuzz.py [--count 500] [--seed 1] [--format inp]

All damage comes from seeds, so that a failure can be made again: it prints format and number of the file."""

import argparse
import os
import re
import struct
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.decks.convert import convert
from squeal.tables import BadInput

import numpy as np
from damaged_decks import bases, damaged
from plain_decks import READ

KEEP = Path(os.environ["SQUEAL_KEEP"]) if "SQUEAL_KEEP" in os.environ else None  # a folder for files that fail
GMSH_NODES = {15: (0, 1), 2: (2, 3), 9: (2, 6), 3: (2, 4), 16: (2, 8), 10: (2, 9), 4: (3, 4), 11: (3, 10), 6: (3, 6),
              18: (3, 15), 5: (3, 8), 17: (3, 20), 12: (3, 27)}


def read_gmsh(path):
    """Places [nodes][3] of the nodes of each volume element of a binary file of Gmsh 4.1, in m."""
    data = path.read_bytes()

    def section(name):
        begin = data.index(b"$" + name + b"\n") + len(name) + 2
        return data[begin:data.index(b"$End" + name)]

    nodes = section(b"Nodes")
    _, n, _, _ = struct.unpack_from("<4Q", nodes)
    at = 32 + 12 + 8 + 8 * n
    x = np.frombuffer(nodes, "<f8", 3 * n, at).reshape(-1, 3)
    elements, at, found = section(b"Elements"), 32, []
    n_blocks = struct.unpack_from("<Q", elements)[0]
    for _ in range(n_blocks):
        _, _, kind = struct.unpack_from("<3i", elements, at)
        count = struct.unpack_from("<Q", elements, at + 12)[0]
        dimension, n_nodes = GMSH_NODES[kind]
        rows = np.frombuffer(elements, "<u8", count * (n_nodes + 1), at + 20).reshape(count, -1)
        at += 20 + rows.size * 8
        found += [x[row[1:].astype(int) - 1] for row in rows] if dimension == 3 else []
    return found


def sorted_rows(elements, size):
    """Elements, each with its nodes sorted by place, in one order; places to nine digits of the size of all."""
    return sorted(sorted(map(tuple, (np.round(np.asarray(nodes, float) / size, 9) + 0.0).tolist())) for nodes in elements)


def outcome(folder, said):
    """What a scene has, whatever it is called: its numbers, directions and models, those of the balance, and counts."""
    scene = [line.partition("#")[0] for line in (folder / "out.yaml").read_text().split("\n")]
    values = re.findall(r"(?m)(\w+): *\"?([-+.\d][-+.,\de]*|[xyz]{1,3}|constraint|penalty)\"?(?=[ ,}]|$)", "\n".join(scene))
    at = next((k for k, line in enumerate(said) if "balance" in line), len(said))
    return sorted(values), sorted(" ".join(line.split()[1:]) for line in said[at + 1:-1]), said[1:2]


def notes(said):
    """The lines of what is lost or differs, without their places."""
    return sorted(line.partition(": ")[2] for line in said if re.match(r"[^ ]+:\d+: ", line))


class Judge:
    """What is wrong with what became of a deck."""

    def __init__(self, folder, ending):
        self.folder, self.ending, self.whole = folder, ending, {}

    def judge(self, base, ends=False, key=None):
        """What is wrong, or None; and whether it was refused. `key`: only words of the deck were changed, the base of that number."""
        for old in self.folder.glob("out.*"):
            old.unlink()
        try:
            said = convert(self.folder / base.main, base.units, self.folder / "out")
        except BadInput as error:
            text = str(error)
            half = [path.name for path in self.folder.glob("out.*")]
            return (None if base.names.match(text) and not half
                    else f"the message is not one line with file and line, or {half} are left: {text!r}"), True
        except Exception as error:  # pylint: disable=broad-except
            return f"{type(error).__name__}: {error}", False
        found = read_gmsh(self.folder / "out.msh")
        if not found or not all(np.isfinite(nodes).all() for nodes in found):
            return "no elements, or places that are not finite", False
        if ends and self.ending in READ and not any("whole?" in line for line in said):
            return "the file ends early, and nothing says so", False
        return self.elements(base, found) or self.words(key, said), False

    def elements(self, base, found):
        """Beside a plain reading."""
        if self.ending not in READ or not base.plain:
            return None
        try:
            wanted = READ[self.ending](base.text(self.folder))
        except (ArithmeticError, LookupError, ValueError, TypeError) as error:
            return f"accepted, and a plain reading fails: {type(error).__name__}: {error}"
        wanted = [[[1e-3 * value for value in place] for place in nodes] for nodes in wanted]
        size = max(np.abs(nodes).max() for nodes in found)
        return f"elements are not those of the file: {len(found)} beside {len(wanted)}" \
            if sorted_rows(wanted, size) != sorted_rows(found, size) else None

    def words(self, key, said):
        """Of a keyword, parameter or label that is none: another scene is told."""
        if key is None:
            return None
        now = outcome(self.folder, said), notes(said)
        whole = self.whole.setdefault(key, now)
        return f"another scene, and no line says so: {whole[0]} became {now[0]}" if now[0] != whole[0] and now[1] == whole[1] else None


def fuzz(folder, ending, count, seed):
    """Whether all decks of a format are treated well."""
    whole, refused, faults, judge = bases(folder, ending), 0, [], Judge(folder, ending)
    for number, base in enumerate(whole):
        base.write(folder)
        fault, gone = judge.judge(base, key=number)
        if fault or gone:
            faults.append(f"whole deck {number}: {fault or 'refused'}")
    for number in range(count):
        random, at = np.random.default_rng([seed, number]), number // 7 % len(whole)
        damage, ends, told = damaged(random, whole[at], number, folder, ending)
        fault, gone = judge.judge(whole[at], ends, at if told else None)
        refused += gone
        if fault:
            faults.append(f"deck {number} ({whole[at].main}, {damage.__name__}): {fault}")
            for name in whole[at].files if KEEP else ():
                (KEEP / f"{number}.{name}").write_bytes((folder / name).read_bytes())
    for fault in faults[:20]:
        print(f"FAILED {ending} {fault}")
    print(f"{'FAILED' if faults else 'ok    '} {ending}: {count} damaged decks, {refused} refused, {len(faults)} faults")
    return not faults and refused > count // 5


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--format", action="append", choices=["inp", "bdf", "cdb", "vtk", "vtu", "med"])
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        kept = [fuzz(Path(name), ending, args.count, args.seed) for ending in args.format or ["inp", "bdf", "cdb", "vtk", "vtu", "med"]]
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
