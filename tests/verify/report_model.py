#!/usr/bin/env python3
"""The page of scripts/report of a reduced model whose files are damaged, each in one way: one line names the file, sliders stay where
the model itself is whole, and shapes only where they are whole too.

    report_model.py RESULTS"""

import re
import shutil
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from forked import run_script

REPORT = Path(__file__).resolve().parents[2] / "scripts/report"
MODEL, SHAPES = "reduced_model.bin", "reduced_shapes.h5"


def cut(name):
    """Its first 5000 bytes."""
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:5000])


def numbers(change):
    """The numbers of the matrices changed."""
    def damage(folder):
        data = (folder / MODEL).read_bytes()
        first = data.index(b"\n") + 1
        values = numpy.frombuffer(data[first:]).copy()
        change(values)
        (folder / MODEL).write_bytes(data[:first] + values.tobytes())
    return damage


def head(pattern, text):
    """The line in front of the matrices changed."""
    return lambda folder: (folder / MODEL).write_bytes(re.sub(pattern, text, (folder / MODEL).read_bytes(), count=1))


def damped(folder):
    """Damping in proportion to the mass: terms are K, whole, C and M, triangles, then those that vary."""
    n = int(re.search(rb'"n": (\d+)', (folder / MODEL).read_bytes())[1])
    first, size = n**2, n * (n + 1) // 2
    numbers(lambda v: v.__setitem__(slice(first, first + size), 10 * v[first + size:first + 2 * size]))(folder)
    head(rb'"C", "scale": 0', b'"C", "scale": 1')(folder)


def third(change):
    """The third shape changed."""
    def damage(folder):
        with h5py.File(folder / SHAPES, "r+") as file:
            data, name = file["VTKHDF/PointData"], "vector_003"
            values = change(data[name][:])
            del data[name]
            data[name] = values
    return damage


def gone(folder):
    (folder / SHAPES).unlink()


# What is done; whether there are sliders, moving shapes; what is said on the page, and beside it but for a file that need not be
CASES = {
    "whole": (lambda folder: None, 1, 1, ""),
    "damped": (damped, 1, 1, ""),
    "no shapes": (gone, 1, 0, "No shapes: reduced_shapes.h5 is not there. It is left out above 96 MB"),
    "shapes cut": (cut(SHAPES), 1, 0, f"{SHAPES}: cannot be read"),
    "shape short": (third(lambda v: v[:-5]), 1, 0, r"vector_003 is \(\d+, 3\), must be \(\d+, 3\)"),
    "shape long": (third(lambda v: numpy.vstack([v, v])), 1, 0, r"vector_003 is \(\d+, 3\), must be \(\d+, 3\)"),
    "shape flat": (third(numpy.ravel), 1, 0, r"vector_003 is \(\d+,\), must be \(\d+, 3\)"),
    "shape NaN": (third(lambda v: v * numpy.nan), 1, 0, "vector_003 has values that are no numbers"),
    "model cut": (cut(MODEL), 0, 0, f"{MODEL}: is no reduced model"),
    "model NaN": (numbers(lambda v: v.__setitem__(0, numpy.nan)), 0, 0, f"{MODEL}: a matrix has values that are no numbers"),
    "model inf": (numbers(lambda v: v.__setitem__(-1, numpy.inf)), 0, 0, f"{MODEL}: a matrix has values that are no numbers"),
    "model zero": (numbers(lambda v: v.fill(0)), 0, 0, f"{MODEL}: has no modes at some values"),
    "more in use": (head(rb'"n_used": \d+', b'"n_used": 9999'), 0, 0, f"{MODEL}: is no reduced model"),
    "no band": (head(rb'"high": [^,]+', b'"high": NaN'), 0, 0, f"{MODEL}: is no reduced model"),
    "no kind": (head(rb'"kind": "K"', b'"kind": "Q"'), 0, 0, f"{MODEL}: is no reduced model"),
}


def holds(folder, name, sliders, moving, said):
    """Whether page and lines are as they must be."""
    page = folder.with_suffix(".html")
    done = run_script(REPORT, [folder, "-o", page])
    text = page.read_text() if page.exists() else ""
    there = text.count('class="sliders"'), text.count('id="r1-vectors-viewer"')
    told = done.stderr.splitlines()
    kept = (done.returncode == 0 and there == (sliders, moving) and re.search(said, text) and "foreseen" not in done.stderr and
            len(told) == (0 if name in ("whole", "damped", "no shapes") else 1) and (not told or re.search(said, told[0])))
    print("ok  " if kept else "FAIL", name, done.returncode, there, done.stderr.strip())
    return kept


def main(results):
    """All cases."""
    kept = []
    with tempfile.TemporaryDirectory(prefix="squeal-") as place:
        for name, (damage, *expected) in CASES.items():
            folder = Path(place, name.replace(" ", "_"))
            shutil.copytree(results, folder)
            damage(folder)
            kept.append(holds(folder, name, *expected))
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
