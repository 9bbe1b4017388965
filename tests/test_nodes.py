#!/usr/bin/env python3
"""-operators_nodes: matrices with a table of their nodes have the shapes and names of the mesh that they are from. Reference: the
same disc from its mesh, whose matrices are written and read again, with unknowns in the order of the mesh and shuffled. Breaks
when an unknown is taken for another, a node is lost between ranks, or the disc is not found in a cloud.

    test_nodes.py SQUEAL LAUNCHER"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import h5py
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

from served import own_words, sooner

SOURCE = Path(__file__).resolve().parents[1]
INNER = 0.06  # m, where the disc is clamped
SCENE = ["-options_file", SOURCE / "options/plate.yaml", "-rig_disc_elements", "8,64,1", "-modes_band", "0,900"]
failed = []


def check(name, good, text=""):
    """Prints, and keeps what failed."""
    print(f"{'ok    ' if good else 'FAILED'} {name}{': ' if text else ''}{text}")
    if not good:
        failed.append(name)


class Runs:
    """Runs of squeal in one folder."""

    def __init__(self, folder, squeal, launcher):
        self.folder, self.squeal, self.launcher = folder, str(Path(squeal).resolve()), str(Path(launcher).resolve())

    def run(self, ranks, *options):
        """Exit status and what it says."""
        return subprocess.run([self.launcher, "-n", str(ranks), self.squeal, *map(str, options)], cwd=self.folder,
                              capture_output=True, text=True)

    def modes(self, name, ranks, *options):
        """Rows of modes.csv, places and displacements."""
        done = self.run(ranks, "-output_dir", name, "-malloc_dump", *options)
        if done.returncode or "[ 0]" in done.stdout:
            check(f"run {name}", False, done.stderr + done.stdout[-400:])
            return None
        with (self.folder / name / "modes.csv").open(newline="") as table:
            rows = list(csv.DictReader(table))
        with h5py.File(self.folder / name / "modes.h5") as file:
            data = file["VTKHDF/PointData"]
            shapes = [data[f"mode_{i + 1:03d}_re"][()] for i in range(len(rows))]
            return rows, file["VTKHDF/Points"][()], shapes


def write_nodes(path, places, part=None, drop=0):
    """The table of the free nodes, three unknowns each, node numbers counting down."""
    free = numpy.flatnonzero(numpy.hypot(places[:, 0], places[:, 1]) > INNER * 1.001)
    with path.open("w") as out:
        out.write("unknown,node,direction,x,y,z" + (",part\n" if part else "\n"))
        for i, node in enumerate(free):
            for d in range(3):
                if i >= drop:
                    place = ",".join(f"{x:.17g}" for x in places[node])
                    out.write(f"{3 * i + d + 1},{10000 - node},{d + 1},{place}{',' + part(places[node]) if part else ''}\n")
    return free


def same_shape(mesh, cloud):
    """Whether each shape of the points is one of the mesh, or of a pair of equal frequency a mixture of both, up to a factor."""
    rows, places, shapes = mesh
    order = {tuple(place): i for i, place in enumerate(places)}
    at = numpy.array([order[tuple(place)] for place in cloud[1]])
    worst = 0
    for row, shape in zip(cloud[0], cloud[2]):
        near = [i for i, other in enumerate(rows) if abs(float(other["freq_hz"]) / float(row["freq_hz"]) - 1) < 1e-6]
        basis = numpy.array([shapes[i][at].ravel() for i in near]).T
        fit = numpy.linalg.lstsq(basis, shape.ravel(), rcond=None)[0]
        worst = max(worst, abs(basis @ fit - shape.ravel()).max() / abs(shape).max())
    return worst


def test_disc(runs):
    """Shapes and names."""
    mesh = runs.modes("mesh", 1, *SCENE, "-operators_save", "saved")
    free = write_nodes(runs.folder / "nodes.csv", mesh[1])
    loaded = ["-operators_load_k", "saved/K.bin", "-operators_load_m", "saved/M.bin", "-modes_band", "0,900", "-operators_nodes"]
    labels = [row["label"] for row in mesh[0]]
    for ranks in (1, 2, 3):
        cloud = runs.modes(f"cloud{ranks}", ranks, *loaded, "nodes.csv")
        if not cloud:
            continue
        check(f"names on {ranks}", [row["label"] for row in cloud[0]] == labels and "(0,3)" in labels, " ".join(labels))
        check(f"nodes on {ranks}", len(cloud[1]) == len(free))
        check(f"shapes on {ranks}", same_shape(mesh, cloud) < 1e-6, f"{same_shape(mesh, cloud):.1e}")
    reader = vtkHDFReader()
    reader.SetFileName(str(runs.folder / "cloud2/modes.h5"))
    reader.Update()
    grid = reader.GetOutput()
    check("VTK sees points", {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {1} and grid.GetNumberOfPoints() == len(free)
          and abs(vtk_to_numpy(grid.GetPointData().GetArray("mode_001_re"))).max() > 0)
    text = (runs.folder / "cloud2/modes.xmf").read_text()
    check("XDMF is of points", f'TopologyType="Polyvertex" NumberOfElements="{len(free)}" NodesPerElement="1"' in text)
    page = subprocess.run([SOURCE / "scripts/report", "cloud2"], cwd=runs.folder, capture_output=True, text=True)
    check("scripts/report writes its page without bodies", page.returncode == 0 and "which have no faces" in page.stderr + page.stdout,
          page.stderr)
    write_nodes(runs.folder / "parts.csv", mesh[1], lambda x: "disclike" if numpy.hypot(x[0], x[1]) > 0.11 else "inside")
    parts = runs.modes("parts", 2, *loaded, "parts.csv")
    shares = [float(row["part_disclike_percent"]) + float(row["part_inside_percent"]) for row in parts[0]]
    check("parts of a table, none with a disc's name", {row["label"] for row in parts[0]} <= {"disclike", "inside"}
          and max(abs(share - 100) for share in shares) < 1e-9)
    ring = runs.modes("ring", 1, *loaded, "parts.csv", "-modes_disc", "disclike")
    check("-modes_disc of a table", [row["label"] for row in ring[0]] == labels)
    other = runs.run(1, *loaded, "parts.csv", "-modes_disc", "disc", "-output_dir", "other")
    check("-modes_disc of no part", "-modes_disc 'disc' is none of the -parts" in other.stderr, other.stderr)
    sweep = runs.run(1, "-terms", "k,m,g", "-k_file", "saved/K.bin", "-k_kind", "stiffness", "-m_file", "saved/M.bin", "-m_kind", "mass",
                     "-g_file", "saved/K.bin", "-g_kind", "stiffness", "-g_parameter", "warmth", "-g_scale", "-1e-3", "-warmth", 1,
                     "-operators_nodes", "nodes.csv", "-modes_band", "0,700", "-analysis", "sweep", "-sweep_parameter", "warmth",
                     "-sweep_values", "1:10:3", "-output_dir", "sweep")
    with (runs.folder / "sweep/sweep.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    kept = [(float(row["freq_hz"]) / (1 - 1e-3 * float(row["value"]))**0.5, row["label"]) for row in rows]
    at_zero = [(float(row["freq_hz"]), row["label"]) for row in mesh[0]]
    check("names in a sweep, frequencies of (1 - 0.001 w) K", not sweep.returncode and len(rows) >= 15 and all(
        any(abs(f / g - 1) < 1e-8 and label == other for g, other in at_zero) for f, label in kept), sweep.stderr)


def test_bad(runs):
    """One line, on two ranks."""
    good = (runs.folder / "nodes.csv").read_text().splitlines()
    cases = {
        "a column that lacks": (["unknown,node,x,y,z", "1,1,0,0,0"], "has no column direction"),
        "no number": ([*good[:3], good[3].replace("0.", "O.", 1)], "line 4: x "),
        "nan": ([*good[:2], good[2].rsplit(",", 1)[0] + ",nan"], "line 3: z 'nan' is no number"),
        "an unknown beyond": ([*good[:2], "99999,1,1,0,0,0"], "line 3: unknown 99999 of node 1"),
        "an unknown twice": ([*good[:3], good[1]], "line 4: unknown 1 stands twice"),
        "a direction twice": ([good[0], "1,1,1,0,0,0", "2,1,1,0,0,0"], "direction 1 of node 1 stands twice"),
        "two places": ([good[0], "1,1,1,0,0,0", "2,1,2,0,0,1"], "node 1 has two places or parts"),
        "a column too few": ([*good[:3], "4,1,1"], "line 4 has 3 columns, its first line 6"),
        "half an unknown": ([good[0], "1.5,1,1,0,0,0"], "line 2: unknown '1.5' is no whole number"),
        "nothing": ([good[0]], "it has no nodes"),
    }
    loaded = ["-operators_load_k", "saved/K.bin", "-operators_load_m", "saved/M.bin", "-modes_band", "0,900", "-operators_nodes"]
    for name, (lines, why) in cases.items():
        (runs.folder / "bad.csv").write_text("\n".join(lines) + "\n")
        done = runs.run(2, *loaded, "bad.csv", "-output_dir", "bad")
        said = own_words(done.stderr).strip()
        check(f"refused: {name}", done.returncode != 0 and "\n" not in said and why in said and "bad.csv" in said, done.stderr.strip())
    done = runs.run(2, *loaded, "none.csv", "-output_dir", "bad")
    check("refused: no file", done.returncode != 0 and "cannot read 'none.csv' of -operators_nodes: No such file" in done.stderr)
    done = runs.run(1, *SCENE, "-operators_nodes", "nodes.csv", "-output_dir", "bad")
    check("refused: beside a mesh", done.returncode != 0 and "is of matrices that are loaded" in done.stderr, done.stderr.strip())


def main():
    with tempfile.TemporaryDirectory() as folder, sooner(sys.argv[1]) as squeal:
        runs = Runs(Path(folder), squeal, sys.argv[2])
        test_disc(runs)
        test_bad(runs)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
