#!/usr/bin/env python3
"""squeal from Python: the cells of options/twenty_designs.ipynb, run in a folder of their own; tables and fields of scripts/squeal/api.py
beside the files read by csv and h5py; what fails is one line; a program that uses the package keeps its own ^C and its own pictures.
Breaks when a column loses its kind, a cell of the notebook fails, or a reader hides what is wrong.

    test_python.py SQUEAL MPIRUN"""

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

SOURCE = Path(__file__).resolve().parents[1]
CHECKS = '''
import signal, sys
before = signal.getsignal(signal.SIGINT), sys.excepthook
from squeal import api
assert (signal.getsignal(signal.SIGINT), sys.excepthook) == before, "the package changed what ^C or an error does"
import os
assert "MPLBACKEND" not in os.environ, "the package chose where pictures go"
def fails(text, call, *words, **options):
    try:
        call(*words, **options)
    except api.Failed as error:
        assert text in str(error) and "\\n" not in str(error), error
    else:
        raise AssertionError(f"{words} {options} was taken")
fails("contact_muu", api.run, "options/oscillator.yaml", contact_muu=1)
fails("nan", api.run, "options/oscillator.yaml", contact_mu=float("nan"))
fails("none.yaml", api.run, "none.yaml")
fails("no results of squeal", api.read, "nowhere")
small = api.run("options/oscillator.yaml", contact_mu=1, folder="small", program=os.environ["PROGRAM"], output_fields=False)
fails("no such table; there are modes", small.table, "mode")
fails("-output_fields 0", small.shape, 1)
(small.folder / "modes.h5").write_bytes(b"no HDF5")
fails("modes.h5: cannot be read", small.shape, 1)
fails("is no kind of picture", small.picture, "mode")
assert small.scene["contact_mu"] == "1" and small.table("modes")["label"][0] == "u2" and "UNSTABLE" in small.printed
shapes = api.run("options/free_ring.yaml", folder="shapes", rig_disc_elements=(6, 32, 1))
numpy.save("shape.npy", shapes.shape(8)); numpy.save("points.npy", shapes.points())
cells, parts = shapes.cells()
assert len(cells) == len(parts) == 192 and set(parts) == {"disc"} and all(len(cell) == 8 for cell in cells)
'''


def cells():
    """The code of the notebook."""
    book = json.loads((SOURCE / "options/twenty_designs.ipynb").read_text())
    return "\n".join("".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code")


def column(path, name):
    """A column of a table, as csv reads it."""
    with path.open() as lines:
        return [float(row[name]) for row in csv.DictReader(lines)]


def design_faults(folder, printed):
    """What the notebook printed beside its tables."""
    rows = [line.split() for line in printed.splitlines() if "(" in line and "young" not in line and "quiet" not in line]
    growth = [max(column(folder / f"results/designs/{i:02d}/modes.csv", "growth_rad_s")) for i in range(20)]
    if len(rows) != 20 or any(abs(float(row[2]) - value) > 0.0051 for row, value in zip(rows, growth)):
        yield f"growth {growth}, printed {rows}"
    if not (folder / "results/designs/growth.png").stat().st_size > 10000:
        yield "the picture is empty"
    shares = [float(line.split()[-2]) for line in printed.splitlines() if line.endswith(" 1/s") and "young" not in line]
    if not shares or abs(sum(shares) - max(growth)) > 0.02:
        yield f"causes {shares} of {max(growth)}"
    if not any(value > 100 for value in growth) or not any(value == 0 for value in growth):
        yield f"growth of the designs: {growth}"


def field_faults(folder):
    """Fields beside the file."""
    with h5py.File(folder / "shapes/modes.h5") as file:
        data = file["VTKHDF/PointData"]
        if not numpy.array_equal(data["mode_008_re"][:] + 1j * data["mode_008_im"][:], numpy.load(folder / "shape.npy")):
            yield "a shape is not that of the file"
        if not numpy.array_equal(file["VTKHDF/Points"][:], numpy.load(folder / "points.npy")):
            yield "points are not those of the file"


def main():
    squeal = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        folder = Path(name) / "share/squeal"  # the package takes the program of its prefix
        (Path(name) / "bin").mkdir()
        (Path(name) / "bin/squeal").symlink_to(squeal)
        for part in ("scripts", "options"):
            shutil.copytree(SOURCE / part, folder / part, ignore=shutil.ignore_patterns("*.msh", "*.png"))
        environment = {**os.environ, "PYTHONPATH": str(folder / "scripts"), "PROGRAM": str(squeal)}
        environment.pop("MPLBACKEND", None)
        done = subprocess.run([sys.executable, "-c", CHECKS.replace("import signal,", "import numpy, signal,") + cells()], cwd=folder,
                              env=environment, capture_output=True, text=True, check=False)
        print(done.stdout, done.stderr)
        faults = [done.stderr.strip()[-500:]] if done.returncode else [*design_faults(folder, done.stdout), *field_faults(folder)]
    print("\n".join(faults) or "as the files have it")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
