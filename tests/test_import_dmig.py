#!/usr/bin/env python3
"""scripts/import_matrices on DMIG of Nastran's bulk data, written as its manual has it: fields, complex ones, choice by case
control, what is refused.

    test_import_dmig.py SQUEAL LAUNCHER"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy
    import h5py  # noqa: F401, for foreign_matrices
    import scipy.sparse  # noqa: F401
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

import foreign_matrices as foreign
from test_import_matrices import SORTED, SOURCE, check, failed, importer, read_petsc, refused

CONTROL = """SOL 103
CEND
K2GG = {k}
M2GG = MX
SUBCASE 1
METHOD = 1
BEGIN BULK
PARAM,CM2,0.5
GRID,7,,1.,2.,3.
GRID,3,,0.,0.,1.
GRID,12,,0.,1.,1.
GRID,5,,2.,1.,1.,9
CORD2R,9,,0.,0.,0.,0.,0.,1.
,0.,1.,0.
CTETRA,1,1,7,3,12,5
"""


def rounded(A, step):
    """Values of few digits, which fit in a field."""
    return numpy.round(A / step) * step


def columns(table):
    """Rows of a table."""
    with table.open(newline="") as rows:
        return list(csv.DictReader(rows))


def test_fields(folder):
    """Small, large and free fields, complex ones in two matrices. Breaks when a column, a triangle or a part is lost."""
    model = foreign.model()
    K, M, U = (rounded(model[name], 1 / 16) for name in "KMU")
    Z = U + 1j * rounded(model["G"], 1 / 16)
    ordered = {name: A[SORTED][:, SORTED] for name, A in (("K", K), ("M", M), ("U", U), ("Z", Z))}
    for number, lines in enumerate((foreign.small_fields, foreign.large_fields, foreign.free_fields)):
        path, out = folder / f"dmig{number}.pch", folder / f"dmig{number}"
        cards = [card for name, A, form, kind in (("KX", K, 6, 2), ("MX", M, 6, 1), ("BX", U, 1, 2), ("ZX", Z, 1, 4))
                 for card in foreign.dmig_cards(name, A, form, kind, 0, lines)]
        path.write_text("$TITLE\n" + "\n".join(cards) + "\nDMIG,PX,0,9,1,0,,,2\nDMIG,PX,1,0,,7,1,2.5\n")
        command = [SOURCE / "scripts/import_matrices", path, "-o", out]
        status = subprocess.run(command, capture_output=True, text=True)
        pairs = ("KX", ordered["K"]), ("MX", ordered["M"]), ("BX", ordered["U"]), ("ZX", ordered["Z"].real), ("ZX_IMAG", ordered["Z"].imag)
        check(f"DMIG, {lines.__name__}: to the last bit", status.returncode == 0 and
              all(numpy.array_equal(read_petsc(out / f"{name}.bin"), A) for name, A in pairs), status.stderr)
        check(f"DMIG, {lines.__name__}: what is rectangular or imaginary is said",
              "DMIG PX: rectangular (IFO 9), not read" in status.stdout and "imaginary part of ZX" in status.stdout)


def test_polar(folder):
    """Amplitude and phase in degrees."""
    P = numpy.diag(numpy.arange(1.0, 13) + 30j)  # amplitude and phase
    (folder / "polar.bdf").write_text("\n".join(foreign.dmig_cards("KP", P, 1, 4, 1)) + "\n")
    one, other = importer.read(str(folder / "polar.bdf"))
    off = abs(one.matrix().diagonal() + 1j * other.matrix().diagonal() - (numpy.diag(P).real * numpy.exp(1j * numpy.pi / 6))[SORTED]).max()
    check("DMIG: amplitude and phase", off < 1e-14, f"off by {off:.1e}")


def test_case(folder, squeal, launcher):
    """What case control chooses, with factors, against dense eigenvalues; --take. Breaks when a factor is lost."""
    K, M, U = (foreign.model()[name] for name in "KMU")
    cards = [card for name, A, form in (("KX", K, 6), ("KY", M, 6), ("MX", M, 6), ("OTHER", U, 1))
             for card in foreign.dmig_cards(name, A, form)]
    deck = folder / "case.bdf"
    deck.write_text(CONTROL.format(k="2.0*KX, 3.0*KY") + "\n".join(cards) + "\nENDDATA\n")
    status = subprocess.run([SOURCE / "scripts/import_matrices", deck, "--nodes", deck, "-o", folder / "case"],
                            capture_output=True, text=True)
    check("DMIG: what is not taken is said", "OTHER: not taken, since case control names others" in status.stdout and
          "1 CTETRA" in status.stdout and "has no place: node 5 x" in status.stdout, status.stderr)
    check("DMIG: places", (folder / "case/nodes.csv").read_text().splitlines()[1] == "1,3,1,0,0,1")
    run = subprocess.run([launcher, "-n", "1", squeal, "-options_file", "case/matrices.yaml", "-modes_target", "0", "-modes_count", "5",
                          "-output_dir", "case/modes"], cwd=folder, capture_output=True, text=True)
    values = numpy.linalg.eigvals(numpy.linalg.solve(0.5 * M, 2 * K + 3 * M))
    exact = numpy.sqrt(numpy.sort(values.real))[:5] / (2 * numpy.pi)
    rows = columns(folder / "case/modes/modes.csv") if run.returncode == 0 else []
    found = numpy.array([float(row["freq_hz"]) for row in rows]) if rows else numpy.zeros(5)
    check("DMIG: frequencies of what case control chooses", abs(found / exact - 1).max() < 1e-9, f"{found} {exact} {run.stderr}")
    status = subprocess.run([SOURCE / "scripts/import_matrices", deck, "--take", "K=KX,M=KY", "-o", folder / "taken"],
                            capture_output=True, text=True)
    check("DMIG: --take", status.returncode == 0 and numpy.array_equal(read_petsc(folder / "taken/M.bin"), M[SORTED][:, SORTED]) and
          "scale" not in (folder / "taken/matrices.yaml").read_text(), status.stderr)


def test_refused(folder):
    """What is wrong in a DMIG is said with its line."""
    head, entry = "DMIG,K,0,6,2,0\n", "DMIG,K,1,1,,1,1,2.\n"
    bad = {"no head": (entry, "bad.bdf:1: DMIG K has no head"), "form": (head.replace("6", "7") + entry, "bad.bdf:1: DMIG K: form 7"),
           "both sides": (head + "DMIG,K,1,1,,1,2,2.\nDMIG,K,1,2,,1,1,2.\n", "on both sides of the diagonal"),
           "twice": (head + entry + entry, "stands twice"),
            "imaginary": (head + "DMIG,K,1,1,,1,1,2.,3.\n", "bad.bdf:2: DMIG K: an imaginary"),
           "component": (head + "DMIG,K,1,1,,1,7,2.\n", "components of 0 to 6"), "rectangular": ("DMIG,K,0,9,2,0,,,1\nDMIG,K,1,,,1,1,2.\n",
           "no square matrix"), "unknown": ("K2GG = KX\nBEGIN BULK\n" + head + entry, "bad.bdf:1: KX: there is no such DMIG"),
           "complex factor": ("K2GG = (1.,2.)*K\nBEGIN BULK\n" + head + entry, "no list of names with real factors"),
           "none": ("GRID,1\nENDDATA\n" + head, "has no DMIG before its ENDDATA")}
    for name, (text, why) in bad.items():
        (folder / "bad.bdf").write_text(text)
        refused(f"refused DMIG, {name}", why, [folder / "bad.bdf"], folder / "refused")


def main():
    squeal, launcher = (str(Path(word).resolve()) for word in sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        test_fields(folder)
        test_polar(folder)
        test_case(folder, squeal, launcher)
        test_refused(folder)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
