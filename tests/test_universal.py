#!/usr/bin/env python3
"""Universal files as scripts/correlate reads them:

  round     nodes, trace lines, units, shapes and functions of every form, of text and binary, come back as they were written
            (tests/universal.py), to the digits of the form
  gmsh      nodes that the program gmsh wrote
  left      what is not understood has a line: other datasets, functions and analyses
  damage    damaged files, and tables: one line that names file and line or byte, or all is there that was, or a line says what is not

Breaks when numbers are lost in silence, or a damaged file ends in a traceback. `--files FOLDER` prints what each file of a folder holds.

    test_universal.py [--count 500] [--files FOLDER]"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from random import Random

import numpy as np
import universal
from fuzz.damage import BYTES, LINES

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.correlate.datasets import read_universal  # noqa: E402
from squeal.correlate.measured import read_measured  # noqa: E402
from squeal.tables import BadInput  # noqa: E402

FAULTS = []
PLACES = {1: (0.1, 0.2, -0.3), 7: (1e-3, -2e3, 0.0), 120: (1 / 3, 0.0, 5e-7)}
FREQ = np.linspace(10.0, 90.0, 17)


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


def values(count, seed):
    random = np.random.default_rng(seed)
    return random.normal(size=count) + 1j * random.normal(size=count)


def read(data, folder, name="x.unv"):
    """Contents of a file."""
    path = folder / name
    path.write_bytes(data)
    return read_universal(path)


def check_round(folder):
    """Every form of every dataset."""
    for number, digits in ((15, 1e-5), (2411, 1e-15)):
        found = read(universal.nodes(PLACES, number), folder)
        check(list(found.nodes) == list(PLACES) and np.allclose(list(found.nodes.values()), list(PLACES.values()), rtol=digits, atol=0),
              f"round: nodes of dataset {number}")
    found = read(universal.units(1e3, 2.0) + universal.nodes(PLACES) + universal.trace([1, 7, 0, 120, 1]), folder)
    check(found.factors == (1e3, 2.0) and found.traces[0][1] == [1, 7, 0, 120, 1], "round: units and trace lines")
    one = {label: values(3, label) for label in PLACES}
    for number in (55, 2414):
        found = read(universal.shape(one, 123.456, 0, 1, growth=-7.5, dataset=number), folder).shapes[0]
        lam = complex(-7.5, 2 * np.pi * 123.456)
        check(all(np.allclose(found.values[label], row, rtol=0, atol=1e-5) for label, row in one.items())
              and np.isclose(found.freq, 123.456, rtol=1e-5) and found.title == "MODE 1"
              and np.isclose(found.damping, 7.5 / abs(lam), rtol=1e-5), f"round: a complex shape of dataset {number}, its eigenvalue")
        found = read(universal.shape({label: row.real for label, row in one.items()}, 50.0, 0.012, 2, dataset=number), folder).shapes[0]
        check(all(np.allclose(found.values[label], row.real, rtol=0, atol=1e-5) for label, row in one.items())
              and (found.freq, found.damping) == (50, 0.012), f"round: a real shape of dataset {number}")
    wave = values(len(FREQ), 3) * 1e-7
    for binary in ("", "<", ">"):
        for form, digits in ((5, 1e-7 if binary else 1e-5), (6, 0 if binary else 1e-12)):
            for even in (True, False):
                data = universal.function(FREQ, wave, (7, -3), (1, 2), form, even, 12, binary)
                found = read(data + universal.units(1.0), folder).functions[0]
                near = abs(found.values - wave).max() <= digits * abs(wave).max()
                check(near and np.allclose(found.freq, FREQ, rtol=1e-5)
                      and (found.response, found.reference, found.numerator) == ((7, -3), (1, 2), 12),
                      f"round: functions of form {form}, {'even' if even else 'uneven'}, {f'binary {binary}' if binary else 'text'}, to "
                      f"{digits:g}")
    data = universal.function(FREQ, wave, (7, 3), (1, 2)).replace(b" -", b"-")
    check(abs(read(data, folder).functions[0].values - wave).max() < 1e-11 * abs(wave).max(), "round: columns that touch")


def check_gmsh(folder):
    """Nodes of gmsh, beside those of its own form."""
    if not shutil.which("gmsh"):
        print("skip gmsh: no program of that name")
        return
    (folder / "ball.geo").write_text('SetFactory("OpenCASCADE"); Sphere(1) = {0.1, 0.2, 0.3, 1}; Mesh.MeshSizeMax = 0.4;\n')
    for form in ("unv", "msh22"):
        subprocess.run(["gmsh", "-3", "-v", "0", "ball.geo", "-format", form, "-o", f"ball.{form}"], cwd=folder, check=True,
                       capture_output=True)
    lines = (folder / "ball.msh22").read_text().split("$Nodes\n")[1].split("$EndNodes")[0].splitlines()[1:]
    own = {int(line.split()[0]): tuple(map(float, line.split()[1:])) for line in lines}
    found = read_universal(folder / "ball.unv")
    check(set(found.nodes) == set(own) and np.allclose([found.nodes[k] for k in own], list(own.values()), atol=1e-12)
          and "2412 (elements)" in found.said[0],
          f"gmsh: {len(own)} nodes as gmsh has them, its elements have a line")


def check_left(folder):
    """A line for what is left out."""
    wave = values(len(FREQ), 3)
    other = universal.function(FREQ, wave, (7, 3), (1, 2)).replace(f"{4:5d}{1:10d}{1:5d}".encode(), f"{6:5d}{1:10d}{1:5d}".encode())
    still = universal.shape({1: np.ones(3)}, 0, 0, 1).replace(universal.whole(1, 2, 2, 8, 2, 3).encode(),
                                                              universal.whole(1, 1, 2, 8, 2, 3).encode())
    still += universal.shape({1: np.ones(3)}, 0, 0, 1, dataset=2414).replace(universal.whole(1).encode() + b"MODE 1",
                                                                             universal.whole(2).encode() + b"MODE 1")
    said = read(universal.block(2412, "a\n") + universal.block(4711, "b\n") + 2 * other + still, folder).said
    check([line.split(":", 2)[2] for line in said] == [" dataset 2412 (elements) left out", " dataset 4711 (not understood) left out",
                                                      " function of type 6 (coherence) and 1 more left out",
                                                      " dataset 55 of analysis 1 (static), no modes left out",
                                                      " dataset 2414 on elements, not at nodes left out"], f"left: {len(said)} lines")


def examples():
    """Files to damage."""
    wave = values(len(FREQ), 3)
    one, two = ({label: values(3, label + k) for label in PLACES} for k in (0, 50))
    head = universal.units(1.0) + universal.nodes(PLACES) + universal.trace(PLACES)
    shapes = universal.shape(one, 50.0, 0.01, 1, growth=-1.0) + universal.shape(two, 60.0, 0.01, 2, growth=-1.0)
    yield "text.unv", head + shapes + universal.function(FREQ, wave, (7, -3), (1, 2)) + universal.function(FREQ, wave, (1, 1), (1, 2),
                                                                                                           even=False), LINES
    yield "binary.unv", head + universal.function(FREQ, wave, (7, -3), (1, 2), binary="<") \
        + universal.function(FREQ, wave, (1, 1), (1, 2), 5, False, binary=">") + shapes, BYTES + LINES
    newer = universal.shape(one, 50.0, 0.01, 1, growth=-1.0, dataset=2414) \
        + universal.shape({label: row.real for label, row in two.items()}, 60.0, 0.01, 2, dataset=2414)
    yield "newer.unv", head + newer, LINES
    yield "old.unv", universal.nodes(PLACES, 15, 4) + universal.cylinder(4, 18) + shapes, LINES
    yield "modes.csv", b"freq_hz,damping_ratio\n100,0.01\n200,\n300,0.02\n", LINES
    yield "frf.csv", b"freq_hz,a_re_m_n,a_im_m_n\n1,2,3\n2,3,4\n3,4,5\n4,5,6\n", LINES


def amount(found):
    """How many things there are: places, shapes, their values, functions, their values."""
    return np.array([len(found.points), len(found.modes), sum(mode.shape.size for mode in found.modes if mode.shape is not None),
                     len(found.responses), sum(len(response.values) for response in found.responses), len(found.lines)])


def outcome(path, whole):
    """refused, as it was, said or less in silence; a text of what went wrong for the last."""
    try:
        found = read_measured([path], None, "displacement")
    except BadInput as error:
        named = re.match(rf"{re.escape(str(path))}(:\d+)?: .", str(error))
        return "refused" if named and "\n" not in str(error) else f"no place: {error}"
    except OSError as error:
        return f"{type(error).__name__}: {error}"
    except Exception as error:  # what the script would call not foreseen
        return f"{type(error).__name__}: {error}"
    if not all(np.isfinite(values).all() for one in (*found.responses, *found.modes)
               for values in (one.values if hasattr(one, "freq") and hasattr(
            one, "values") else one.shape,) if values is not None):
        return "not finite"
    if (amount(found) >= amount(whole)).all():
        return "all is there"
    return "said" if len(found.said) > len(whole.said) else "less"


def is_shorter_file(data, damaged):
    """Whether damage left whole lines or datasets of the file out and nothing else, which no reader can see: a table that ends earlier, a
    dataset that is not there."""
    if data.startswith(damaged) and (damaged.rstrip(b"\n").endswith(b"    -1") or data.startswith(b"freq_hz")):
        return True
    pieces = [data[i:j] for i, j in zip([0, *[m.end() for m in re.finditer(rb"\n", data)]], [m.end() for m in re.finditer(rb"\n", data)])]
    return damaged in [b"".join(pieces[:k] + pieces[k + 1:]) for k in range(len(pieces))] + [b"".join(pieces[:k])
                                                                                             for k in range(len(pieces))]


def check_damage(folder, count):
    """So many damaged files."""
    random, counts, cases = Random(7), {}, list(examples())
    wholes = {}
    for name, data, _ in cases:
        (folder / name).write_bytes(data)
        wholes[name] = read_measured([folder / name], None, "displacement")
    for k in range(count):
        name, data, kinds = cases[k % len(cases)]
        damage = random.choice(kinds)
        damaged, _ = damage(random, data)
        (folder / name).write_bytes(damaged)
        found = outcome(folder / name, wholes[name])
        if found == "less" and is_shorter_file(data, damaged):
            found = "a shorter file"
        if found not in ("refused", "all is there", "said", "a shorter file"):
            (Path(tempfile.gettempdir()) / f"damaged_{k}_{name}").write_bytes(damaged)
            check(False, f"damage {k}: {damage.__name__} of {name}: {found}")
        counts[found] = counts.get(found, 0) + 1
    check(counts.get("refused", 0) > count / 4, f"damage: of {count} files "
          + ", ".join(f"{n} {what}" for what, n in sorted(counts.items())))


def print_files(folder):
    """What each file of a folder holds."""
    for path in sorted(path for path in folder.iterdir() if path.is_file()):
        try:
            found = read_universal(path)
            print(f"{path.name}: {len(found.nodes)} nodes, {len(found.traces)} trace lines, {len(found.shapes)} shapes, "
                  f"{len(found.functions)} functions; "
                  f"{len(found.said)} lines of what is left out")
        except BadInput as error:
            print(f"{path.name}: refused: {error}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--files", type=Path)
    args = parser.parse_args()
    if args.files:
        return print_files(args.files)
    with tempfile.TemporaryDirectory() as folder:
        for part in (check_round, check_gmsh, check_left):
            part(Path(folder))
        check_damage(Path(folder), args.count)
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main())
