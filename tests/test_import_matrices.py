#!/usr/bin/env python3
"""scripts/import_matrices: every form, written by scipy or from its manual, comes back to the last bit and in one order of unknowns;
frequencies of CalculiX's matrices are CalculiX's; damaged files are refused in one line, or differ in one entry alone.

    test_import_matrices.py SQUEAL LAUNCHER [--count N]    N damaged files of each form, default 100"""

import argparse
import csv
import importlib.util
import random
import shutil
import subprocess
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from pathlib import Path

try:
    import h5py  # noqa: F401, for matrices of Matlab
    import numpy
    import scipy.sparse  # noqa: F401, for foreign_matrices
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
import foreign_matrices as foreign
from squeal.matrices.together import write
from squeal.matrices.op4_columns import string_head
from squeal.tables import BadInput

loader = SourceFileLoader("import_matrices", str(SOURCE / "scripts/import_matrices"))
importer = importlib.util.module_from_spec(importlib.util.spec_from_loader("import_matrices", loader))
loader.exec_module(importer)

FORMS = {
    "market": (".mtx", foreign.market), "market array": (".mtx", foreign.market_array), "harwell": (".matrix", foreign.harwell),
    "abaqus": (".mtx", foreign.abaqus), "dmig": (".bdf", foreign.dmig), "calculix": (".sti", foreign.calculix),
    "op4 text": (".op4", lambda path, A: foreign.op4_text(path, A, path.stem)),
    "op4 text sparse": (".op4", lambda path, A: foreign.op4_text(path, A, path.stem, "strings")),
    "op4 text bigmat": (".op4", lambda path, A: foreign.op4_text(path, A, path.stem, "bigmat")),
    "op4 binary": (".op4", lambda path, A: foreign.op4_binary(path, A, path.stem)),
    "op4 binary sparse": (".op4", lambda path, A: foreign.op4_binary(path, A, path.stem, "strings", ">")),
    "op4 binary bigmat": (".op4", lambda path, A: foreign.op4_binary(path, A, path.stem, "bigmat")),
    "matlab": (".mat", lambda path, A: foreign.matlab(path, A, path.stem)),
    "matlab compressed": (".mat", lambda path, A: foreign.matlab(path, A, path.stem, True)),
    "matlab 7.3": (".mat", lambda path, A: foreign.matlab_hdf5(path, A, path.stem)),
}
SORTED = numpy.argsort([node * 10 + direction for node, direction in foreign.unknowns()])
LABELLED = "abaqus", "dmig"  # whose unknowns are sorted by node and direction
NO_CALCULIX = ("G", "U")
failed = []


def check(name, good, text=""):
    """Prints, and keeps what failed."""
    print(f"{'ok    ' if good else 'FAILED'} {name}{': ' if text else ''}{text}")
    if not good:
        failed.append(name)


def read_petsc(path):
    """Dense, by numpy alone."""
    data = path.read_bytes()
    _, rows, columns, n = numpy.frombuffer(data, ">i4", 4)
    count, column = numpy.split(numpy.frombuffer(data, ">i4", rows + n, 16), [rows])
    A = numpy.zeros((rows, columns))
    A[numpy.repeat(numpy.arange(rows), count), column] = numpy.frombuffer(data, ">f8", n, 16 + 4 * (rows + n))
    return A


def written(folder, form, names):
    """Files of some matrices in one form."""
    ending, writer = FORMS[form]
    files = []
    for name in names:
        path = folder / f"{name}{'.mas' if form == 'calculix' and name == 'M' else ending}"
        writer(path, foreign.model()[name])
        files.append(path)
    return files


def convert(files, out):
    """As the command does."""
    return write(out, [one for file in files for one in importer.read(f"{file.stem}={file}")], None)


def test_round(folder):
    """Breaks when an index is off by one, a triangle is not expanded, or K and M come in different orders."""
    check("head of a string of OUTPUT4, as MSC's example has it", string_head(1376257) == (20, 1))
    for form in FORMS:
        names = [name for name in foreign.model() if form != "calculix" or name not in NO_CALCULIX]
        here = folder / form.replace(" ", "_")
        here.mkdir()
        convert(written(here, form, names), here / "out")
        order = SORTED if form in LABELLED else numpy.arange(12)
        same = [numpy.array_equal(read_petsc(here / f"out/{name}.bin"), foreign.model()[name][order][:, order]) for name in names]
        check(f"{form}: {', '.join(names)} to the last bit", all(same))


def refused(name, why, files, out, **extra):
    """A message that holds some words."""
    try:
        write(out, [one for file in files for one in importer.read(str(file))], None, **extra)
        check(name, False, "accepted")
    except BadInput as error:
        check(name, why in str(error) and "\n" not in str(error), str(error))


def test_unknowns(folder):
    """Other nodes in K and M, held unknowns, multipliers, rows without anything, places."""
    K, M = folder / "job_STIF1.mtx", folder / "job_MASS1.mtx"
    K.write_text("1,1,1,1, 2.\n1,2,1,2, 1e36\n2,1,1,1, -1.\n2,1,2,1, 2.\n-3,1,2,1, 1.\n")
    M.write_text("2,1,2,1, 1.\n1,1,1,1, 4.\n5,1,5,1, 0.\n")
    deck = folder / "job.inp"
    deck.write_text("*HEADING\n*NODE\n1, 0., 0., 0.5\n2, 1., 0.\n*ELEMENT, TYPE=T2D2\n1, 1, 2\n")
    status = subprocess.run([SOURCE / "scripts/import_matrices", K, M, "--nodes", deck, "-o", folder / "job"],
                            capture_output=True, text=True)
    check("Abaqus: the command", status.returncode == 0, status.stderr)
    check("Abaqus: what was left out is named", "1e+36 on the diagonal holds it: node 1 y" in status.stdout and
          "zero in all matrices: node 5 x" in status.stdout and "Lagrange multiplier is: node -3 x" in status.stdout and
          "has no place: node -3" in status.stdout)
    check("Abaqus: K", numpy.array_equal(read_petsc(folder / "job/K.bin"), [[0, 0, 1], [0, 2, -1], [1, -1, 2]]))
    check("Abaqus: M", numpy.array_equal(read_petsc(folder / "job/M.bin"), numpy.diag([0, 4, 1])))
    check("Abaqus: places", (folder / "job/nodes.csv").read_text() == "unknown,node,direction,x,y,z\n2,1,1,0,0,0.5\n3,2,1,1,0,0\n")
    mapping = folder / "k.mapping"
    lines = [f"{i + 1} {node} {'UX UY UZ'.split()[d - 1]}\n" for i, (node, d) in enumerate(foreign.unknowns())]
    mapping.write_text("Matrix Eqn   Node   DOF\n" + "".join(lines))
    foreign.harwell(folder / "K.matrix", foreign.model()["K"])
    status = subprocess.run([SOURCE / "scripts/import_matrices", folder / "K.matrix", "--mapping", mapping, "-o", folder / "hb"],
                            capture_output=True, text=True)
    check("Ansys: mapping", status.returncode == 0
          and (folder / "hb/unknowns.csv").read_text().splitlines()[1:3] == ["1,7,1", "2,7,2"], status.stderr)


def test_refused(folder):
    """What is wrong is said in a line."""
    out = folder / "refused"
    bad = {"missing.mtx": None, "x.txt": "", "complex.mtx": "%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1 0\n",
           "nan.mtx": "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 nan\n2 2 1\n",
           "twice.mtx": "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1\n1 1 2\n",
           "few.mtx": "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1\n2 2 1\n",
           "wide.mtx": "%%MatrixMarket matrix coordinate real general\n2 3 1\n1 3 1\n",
           "both.mtx": "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 1\n1 2 1\n",
           "lost.sti": "1 1 1.\n1 3 1.\n3 3 1.\n", "end.sti": "1 1 1.\n2 2 1."}
    words = ["no such file", "is no ending", "its field is complex", "line 3: 'nan'", "entry (1, 1) stands twice",
             "2 entries, its size says 3",
             "it must be square", "above the diagonal", "its diagonal has not one entry", "its last line has no end"]
    for (name, text), why in zip(bad.items(), words):
        if text is not None:
            (folder / name).write_text(text)
        refused(f"refused {name}", why, [folder / name], out)
    (folder / "two.mtx").write_text("%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1\n2 2 1\n")
    (folder / "three.mtx").write_text("%%MatrixMarket matrix coordinate real general\n3 3 1\n3 3 1\n")
    refused("refused sizes that differ", "three has 3 rows, two has 2", [folder / "two.mtx", folder / "three.mtx"], out)
    check("nothing is written for what is refused", not out.exists())


def damaged(data, dice):
    """A file cut off, with bytes changed, or with lines or blocks lost or repeated."""
    kind, at = dice.randrange(5), dice.randrange(len(data))
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + bytes([dice.randrange(256)]) + data[at + 1:]
    if kind == 2:
        return data[:at] + bytes(data[at + i] ^ 1 << dice.randrange(8) for i in range(min(8, len(data) - at))) + data[at + 8:]
    size = dice.choice([1, 4, 8, 16])  # whole lines are not missed where a form has no counts
    return data[:at] + data[at + size:] if kind == 3 else data[:at] + data[at:at + size] + data[at:]


def as_read(folder):
    """K by the names of its unknowns: (unknown, unknown) -> value."""
    A, names = read_petsc(folder / "K.bin"), folder / "unknowns.csv"
    labels = [tuple(line.split(",")[1:]) for line in names.read_text().splitlines()[1:]] if names.exists() else range(len(A))
    return {(labels[i], labels[j]): A[i, j] for i, j in zip(*numpy.nonzero(A))}


def entries_apart(A, B):
    """In how many entries two matrices differ."""
    return sum(A.get(key) != B.get(key) for key in {*A, *B})


def test_damage(folder, count):
    """Breaks on an exception that is no message, a message of two lines, or a matrix that is another one in many places."""
    for form in FORMS:
        dice, here = random.Random(form), folder / f"damage_{form.replace(' ', '_')}"
        here.mkdir()
        files = written(here, form, ["K", "M"])
        whole = files[0].read_bytes()
        convert(files, here / "out")
        good, counts, worst = as_read(here / "out"), {"refused": 0, "same": 0, "one entry": 0}, ""
        for i in range(count):
            data = damaged(whole, dice)
            files[0].write_bytes(data)
            shutil.rmtree(here / "out", ignore_errors=True)
            try:
                convert(files, here / "out")
            except BadInput as error:
                counts["refused"] += 1
                worst = worst or (f"{i}: {error}" if "\n" in str(error) or (here / "out/K.bin").exists() else "")
                continue
            except Exception as error:
                worst = worst or f"{i}: {type(error).__name__} {error}"
                continue
            apart = entries_apart(as_read(here / "out"), good)
            counts["same" if not apart else "one entry"] += 1
            if apart > (24 if form == "dmig" else 4):  # a column of DMIG moves with its head
                worst = worst or f"{i}: {apart} entries differ"
                (here / f"accepted_{i}").write_bytes(data)
        check(f"{count} damaged files, {form}", not worst and counts["refused"] > count / 4,
              ", ".join(f"{n} {what}" for what, n in counts.items()) + f" {worst}")


DECK = """*NODE,NSET=ALL
{nodes}
*ELEMENT,TYPE=C3D8,ELSET=E
{cells}
*MATERIAL,NAME=S
*ELASTIC
2.1e11,0.3
*DENSITY
7800
*SOLID SECTION,ELSET=E,MATERIAL=S
*BOUNDARY
{held}
*STEP
*FREQUENCY{solver}
6
*END STEP
"""


def test_calculix(folder, squeal, launcher):
    """Frequencies of squeal on CalculiX's matrices, beside those that CalculiX prints. Breaks when a triangle is lost."""
    number = {(i, j, k): 1 + i + 5 * (j + 3 * k) for i in range(5) for j in range(3) for k in range(3)}
    nodes = "\n".join(f"{n},{0.1 * i},{0.03 * j},{0.02 * k}" for (i, j, k), n in number.items())
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = "\n".join(",".join(map(str, [1 + i + 4 * (j + 2 * k), *(number[i + a, j + b, k + c] for a, b, c in corners)]))
                      for i in range(4) for j in range(2) for k in range(2))
    held = "\n".join(f"{number[0, j, k]},1,3" for j in range(3) for k in range(3))
    for name, solver in (("bar", ""), ("stored", ",SOLVER=MATRIXSTORAGE")):
        (folder / f"{name}.inp").write_text(DECK.format(nodes=nodes, cells=cells, held=held, solver=solver))
        subprocess.run(["ccx", name], cwd=folder, capture_output=True, timeout=240)
    rows = [line.split() for line in (folder / "bar.dat").read_text().splitlines()]
    exact = [float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()][:6]
    convert([folder / "stored.sti"], folder / "bar")  # alone, then with the mass
    command = [SOURCE / "scripts/import_matrices", "stored.sti", "stored.mas", "--nodes", "stored.inp", "-o", "bar"]
    status = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    run = subprocess.run([launcher, "-n", "1", squeal, "-options_file", "bar/matrices.yaml", "-modes_target", "0",
                          "-modes_count", "6", "-output_dir", "modes"],
                         cwd=folder, capture_output=True, text=True)
    check("CalculiX: shapes at the nodes of the deck",
          (folder / "modes/modes.xmf").exists() and "nodes.csv" in (folder / "bar/matrices.yaml").read_text())
    check("CalculiX: matrices", status.returncode == run.returncode == 0, status.stderr + run.stderr)
    with (folder / "modes/modes.csv").open(newline="") as table:
        found = numpy.array([float(row["freq_hz"]) for row in csv.DictReader(table)])
    off = abs(found / exact - 1).max()
    check("CalculiX: frequencies", len(exact) == 6 and off < 1e-6, f"off by {off:.1e}; it prints 7 digits")


def test_rank(folder, squeal, launcher):
    """A mass of lower rank, M = G' G, as CalculiX has of C3D20R, with the rounding of its digits: frequencies by the eigenvalues
    1 / kappa of G K^-1 G', on one rank and three. With a direction of less than no mass it is refused."""
    dice, n, rank = numpy.random.default_rng(11), 60, 40
    A, G = dice.standard_normal((n, n)), dice.standard_normal((rank, n))
    K, M, w = A @ A.T + n * numpy.eye(n), G.T @ G, numpy.linalg.svd(G)[2][-1]
    exact = numpy.sqrt(1 / numpy.linalg.eigvalsh(G @ numpy.linalg.solve(K, G.T))[::-1]) / (2 * numpy.pi)
    for name, mass in (("low", M), ("negative", M - 1e-6 * numpy.outer(w, w))):
        foreign.market(folder / "K.mtx", K)
        foreign.market(folder / "M.mtx", mass)
        convert([folder / "K.mtx", folder / "M.mtx"], folder / name)
        for ranks in ("1", "3"):
            words = ["-options_file", f"{name}/matrices.yaml", "-modes_band", f"0,{1.01 * exact[9]}", "-output_dir", "modes"]
            run = subprocess.run([launcher, "-n", ranks, squeal, *words], cwd=folder, capture_output=True, text=True)
            if name == "negative":
                check(f"a mass that is negative, {ranks} ranks",
                      run.returncode == 1 and "has 1 negative eigenvalues: it must be" in run.stderr, run.stderr)
                continue
            with (folder / "modes/modes.csv").open(newline="") as table:
                found = numpy.array([float(row["freq_hz"]) for row in csv.DictReader(table)])
            off = abs(found / exact[:10] - 1).max() if len(found) == 10 else numpy.inf
            check(f"a mass of rank {rank} of {n}, {ranks} ranks", run.returncode == 0 and off < 1e-9, f"off by {off:.1e} {run.stderr}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("squeal")
    parser.add_argument("launcher")
    parser.add_argument("--count", type=int, default=100)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        test_round(folder)
        test_unknowns(folder)
        test_refused(folder)
        test_damage(folder, args.count)
        test_rank(folder, str(Path(args.squeal).resolve()), str(Path(args.launcher).resolve()))
        if shutil.which("ccx"):
            test_calculix(folder, str(Path(args.squeal).resolve()), args.launcher)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
