#!/usr/bin/env python3
"""Damaged decks: for each format files that are cut off, or have bytes, digits, words, lines or whole pieces changed, lost
or put twice. scripts/import must refuse each with one line that names the file and a line of it, or write what the damaged file
still says: the places of the nodes of every element, read back from the mesh file, are those that a plain reading of the
damaged text, line by line, gives (texts; meshio's formats are checked for being whole and finite). A deck that ends early is
never taken without saying so.

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

import decks
import decks_abaqus
import decks_others
import numpy as np
from plain_decks import READ

KEEP = Path(os.environ["SQUEAL_KEEP"]) if "SQUEAL_KEEP" in os.environ else None  # a folder for files that fail
MESSAGE = re.compile(r"[^\n]*deck\.\w+:\d+: [^\n]+$")
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


def cut(random, data):
    return data[:random.integers(1, len(data))], True


def flip(random, data):
    data = bytearray(data)
    for at in random.integers(0, len(data), random.integers(1, 4)):
        data[at] ^= 1 << random.integers(0, 8)
    return bytes(data), False


def digits(random, data):
    """Other digits: wrong counts, numbers, places."""
    data = bytearray(data)
    places = [k for k, letter in enumerate(data) if chr(letter).isdigit()]
    for at in random.choice(places, min(len(places), random.integers(1, 4))) if places else ():
        data[at] = ord("0") + random.integers(0, 10)
    return bytes(data), False


def lines(random, data):
    """A line lost, twice, or in another place."""
    rows = data.split(b"\n")
    a, b, how = random.integers(0, len(rows)), random.integers(0, len(rows)), random.integers(0, 3)
    row = rows[a]
    if how < 2:
        del rows[a]
    if how > 0:
        rows.insert(min(b, len(rows)), row)
    return b"\n".join(rows), a >= len(rows) - 3


def words(random, data):
    """A number becomes a word, nothing, or one that is none."""
    found = list(re.finditer(rb"[-+.\w]+", data))
    at = found[random.integers(0, len(found))]
    new = [b"nan", b"", b"inf", b"1e999", b"-1", b"0", b"99999999999999999999", b"x", b"1,", b"0x10", b"1_0"][random.integers(0, 11)]
    return data[:at.start()] + new + data[at.end():], at.end() > len(data) - 40


def piece(random, data):
    """A piece lost, twice, or random bytes."""
    a = random.integers(0, len(data))
    b = min(len(data), a + random.integers(1, 200))
    how = random.integers(0, 3)
    middle = [b"", data[a:b] * 2, random.bytes(b - a)][how]
    return data[:a] + middle + data[b:], b > len(data) - 40


DAMAGES = (cut, flip, digits, lines, words, piece)


def bases(folder, ending):
    """Whole files of a format."""
    found = []
    if ending in ("inp", "bdf", "cdb"):
        small = decks.Solid("wedge+tet1", folder, "--elements", "2,1,2")
        second = decks.Solid("hex20", folder, "--elements", "2,1,1")
    if ending == "inp":
        found = [decks.abaqus(small), decks.abaqus(second, decks.ORTHOTROPIC),
                 decks_abaqus.Assembly.FILES["brake.inp"].replace(
                     "*INCLUDE, INPUT=material.inc\n", decks_abaqus.Assembly.FILES["material.inc"]).split("\n"),
                 decks_abaqus.Flat.FILES["flat.inp"].split("\n")]
    elif ending == "bdf":
        found = [decks.nastran(small, "free"), decks.nastran(second, "large", decks.ORTHOTROPIC), decks.nastran(small, "small"),
                 decks_others.Nastran.FILES["pair.bdf"].split("\n")]
    elif ending == "cdb":
        found = [decks.ansys(small), decks.ansys(second, decks.ORTHOTROPIC), decks_others.Ansys.FILES["pair.cdb"].split("\n")]
    else:
        for kind in ("hex20", "wedge+tet1"):
            path = folder / f"whole.{ending}"
            decks.meshio_file(decks.Solid(kind, folder, "--elements", "2,1,1"), path)
            found.append(path.read_bytes())
    return [text if isinstance(text, bytes) else ("\n".join(text).rstrip("\n") + "\n").encode() for text in found]


def units_of(ending, number):
    """Those of flat.inp cannot be guessed by the decks of meshio, and are given elsewhere too, now and then."""
    return "mm-kg-ms" if (ending, number % 4) == ("inp", 3) else "mm-t-s"


def judge(folder, path, ending, number, ends):
    """What is wrong with what became of a file, or None; and whether it was refused."""
    for old in folder.glob("out.*"):
        old.unlink()
    try:
        said = convert(path, units_of(ending, number), folder / "out")
    except BadInput as error:
        text = str(error)
        return (None if MESSAGE.match(text) else f"the message is not one line with file and line: {text!r}"), True
    except Exception as error:  # pylint: disable=broad-except
        return f"{type(error).__name__}: {error}", False
    found = read_gmsh(folder / "out.msh")
    if not found or not all(np.isfinite(nodes).all() for nodes in found):
        return "no elements, or places that are not finite", False
    if ends and ending in READ and not any("whole?" in line for line in said):
        return "the file ends early, and nothing says so", False
    if ending in READ:
        text = path.read_bytes().replace(b"\r\n", b"\n").replace(b"\r", b"\n").decode("latin-1")
        try:
            wanted = READ[ending](text)
        except (ArithmeticError, LookupError, ValueError, TypeError) as error:
            return f"accepted, and a plain reading fails: {type(error).__name__}: {error}", False
        wanted = [[[1e-3 * value for value in place] for place in nodes] for nodes in wanted]
        size = max(np.abs(nodes).max() for nodes in found)
        if sorted_rows(wanted, size) != sorted_rows(found, size):
            return f"elements are not those of the file: {len(found)} beside {len(wanted)}", False
    return None, False


def fuzz(folder, ending, count, seed):
    """Whether all files of a format are treated well."""
    whole, refused, faults = bases(folder, ending), 0, []
    path = folder / f"deck.{ending}"
    for number, data in enumerate(whole):
        path.write_bytes(data)
        fault, gone = judge(folder, path, ending, number, False)
        if fault or gone:
            faults.append(f"whole file {number}: {fault or 'refused'}")
    for number in range(count):
        random = np.random.default_rng([seed, number])
        damage = DAMAGES[number % len(DAMAGES)]
        base = whole[number % len(whole)]
        data, _ = damage(random, base)
        path.write_bytes(data)
        fault, gone = judge(folder, path, ending, number % len(whole), damage is cut and len(data) < len(base) - 1)
        refused += gone
        if fault:
            faults.append(f"file {number} ({damage.__name__}): {fault}")
            if KEEP:
                (KEEP / f"{number}.{ending}").write_bytes(data)
    for fault in faults[:20]:
        print(f"FAILED {ending} {fault}")
    print(f"{'FAILED' if faults else 'ok    '} {ending}: {count} damaged files, {refused} refused, {len(faults)} faults")
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
