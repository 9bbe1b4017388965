#!/usr/bin/env python3
"""scripts/richardson:

  orders    limits of f + c h^p with known f and p, on two and three meshes; what has no order is not extrapolated
  cuts      boxes in all elements, cut into 2 and 3: nodes as counted, no volume lost, faces as many; distorted ones of tet10 and hex27
            are spaces within spaces, hence no frequency of squeal's rises (Rayleigh)
  limit     a clamped bar without Poisson's ratio: what its stretching lacks to the exact sqrt(E / rho) / (4 L), to a hundredth
  brake     what is per node or pair is divided so that it is the same in all; doublets and labels find their partners; the onset of
            -sweep_parameter is in onsets_mesh.csv
  bad       one line and status 1: matrices, factors that do not fit, too large meshes, folders that cannot be made, per-node
            parameters swept; status 2 before any run: numbers that are none, options that are set for each mesh

Breaks when nodes of neighbours are not the same, when an order is guessed, when modes are matched by number, or when the error
has the wrong sign.

    test_richardson.py SQUEAL MPIRUN"""

import math
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.mesh.gmsh import read_any
from squeal.mesh_error.limits import limit_of
from squeal.mesh_error.subdivide import subdivide, write_mesh
from squeal.tables import optional, read_table

from check import Failure, require
from forked import run_script, run_well
from served import starter
from small_brake import SCENE
from solids import SIZE

ELEMENTS = {"tet4": (5, 1), "tet10": (5, 2), "wedge6": (6, 1), "wedge15": (6, 2), "hex8": (8, 1), "hex20": (8, 2), "hex27": (8, 2)}
STRETCH = math.sqrt(210e9 / 7800) / (4 * 0.1)  # Hz
TETRAHEDRA = {"tet": [[0, 1, 2, 3]], "wedge": [[0, 1, 2, 3], [1, 2, 3, 4], [2, 3, 4, 5]],
              "hex": [[0, 1, 3, 4], [1, 2, 3, 6], [1, 6, 4, 5], [3, 4, 6, 7], [1, 3, 4, 6]]}
BAD = (("oscillator.yaml", [], "matrices have no mesh"), ("cantilever.yaml", ["--refine", "1.5"], "is cut into whole numbers"),
       ("cantilever.yaml", ["--most", "1000"], "no finer mesh has --most 1000"),
       ("plate.yaml", ["-rig_disc_elements", "2,12,1", "--refine", "1.2"], "would be rounded"),
       ("plate.yaml", ["--output", SOURCE / "README.md/out"], "README.md/out/mesh1: Not a directory"))
REFUSED = ["--refine", "nan"], ["--refine", "inf"], ["--ranks", "0"], ["--most", "-1"], ["-analysis", "static"], ["-output_fields", "0"]


def solid(folder, element, *words):
    """Places and sets of a box."""
    path = folder / f"{element}.msh"
    run_well(SOURCE / "tests/solids.py", element, "--elements", "3,2,2", *words, path)
    return read_any(path)


def volume(places, sets):
    """Of all cells by their corners, of which none is negative."""
    total = 0
    for (_, kind), nodes in sets.items():
        family = {4: "tet", 11: "tet", 6: "wedge", 18: "wedge", 5: "hex", 17: "hex", 12: "hex"}.get(kind)
        for corners in TETRAHEDRA.get(family, []):
            x = places[nodes[:, corners]]
            parts = abs(np.linalg.det(x[:, 1:] - x[:, :1])) / 6
            require(parts.min() > 0, "a part has no volume")
            total += parts.sum()
    return total


def orders(_):
    sizes = 1, 1 / 2, 1 / 3
    for p in (0.7, 1, 2, 3.3, 4):
        values = [5 + 0.1 * h**p for h in sizes]
        three, two = limit_of(sizes, values, 4, 1e-12), limit_of(sizes[:2], values[:2], p, 1e-12)
        for found in (three, two):
            require(abs(found.value - 5) < 1e-9 and abs(found.error - 0.1) < 1e-9, f"order {p}: limit {found}")
        require(abs(three.order - p) < 1e-6 and two.how == "assumed", f"order {p}: {three}, {two}")
    for values in ((1, 2, 1.5), (1, 1.1, 1.5), (1, 1.5, 1.5 + 0.4999)):
        found = limit_of(sizes, values, 2, 1e-9)
        require(found.how == "no order" and math.isnan(found.value), f"{values} have no order: {found}")
        require(abs(found.error) == max(abs(v - 1) for v in values), f"{values}: not the largest difference: {found}")
    require(limit_of(sizes, (1, 1 + 1e-9, 1), 2, 1e-9).how == "algebra", "noise is no order")
    require(limit_of(sizes[:2], (0, 7), 2, 1e-9, zero=True).how == "no order", "lock-in between two meshes has no order")


def cuts(work):
    for element, (corners, order) in ELEMENTS.items():
        places, sets = solid(work.folder, element)
        for k in (2, 3):
            fine, cut = subdivide(places, sets, k)
            counted = np.prod([k * order * n + 1 for n in (3, 2, 2)])
            grid = np.unique(np.concatenate([v.ravel() for v in cut.values()])).size
            require(grid == len(fine), f"{element} cut into {k}: nodes of nothing")
            if element not in ("hex20", "wedge15"):
                require(len(fine) == counted, f"{element} cut into {k}: {len(fine)} nodes, not {counted}")
            require(abs(volume(fine, cut) / SIZE.prod() - 1) < 1e-12, f"{element} cut into {k}: volume {volume(fine, cut)}")
            for key, nodes in sets.items():
                dimension = {"bar": 3, "edge": 1}.get(key[0], 2)
                require(len(cut[key]) == k**dimension * len(nodes), f"{element} cut into {k}: {len(cut[key])} parts of {key}")
    for element in ("tet10", "hex27"):
        places, sets = solid(work.folder, element, "--distort", "1", "--renumber", "5")
        values = []
        for k in (1, 2):
            write_mesh(work.folder / "cut.msh", *subdivide(places, sets, k))
            values.append(work.modes(k, "-model_mesh", work.folder / "cut.msh", "-parts", "bar", "-bar_young", 210e9, "-bar_poisson", 0.3,
                                     "-bar_density", 7800, "-modes_band", "1000,45000", "-output_fields", 0))
        n = min(map(len, values))
        require(n > 3 and (values[1][:n] < values[0][:n]).all(), f"{element}: a frequency does not fall: {values}")


def limit(work):
    run_well(SOURCE / "tests/mesh.py", "beam", "--elements", "10,2,1", work.folder / "cantilever.msh")
    rows = work.table(work.done("cantilever.yaml"), "modes_mesh.csv", {"freq_hz": float, "freq_limit_hz": optional,
                                                                      "error_mesh_hz": optional, "order": optional, "how": str})
    stretch = min(rows, key=lambda row: abs(row["freq_hz"] - STRETCH))
    true = stretch["freq_hz"] - STRETCH
    require(abs(stretch["error_mesh_hz"] / true - 1) < 0.01, f"stretching: error {stretch['error_mesh_hz']}, not {true}")
    require(stretch["how"] == "observed" and abs(stretch["order"] - 2) < 0.05, f"stretching: order {stretch['order']}, not 2")
    require(len(rows) == 7 and all(row["how"] != "no partner" for row in rows), "a mode of the bar was not found again")


def brake(work):
    scene = work.folder / "brake.yaml"
    scene.write_text(SCENE + 'modes: {band: "0,6000"}\nsweep: {parameter: contact_mu, values: "0.1:2:4"}\n')
    out = work.done(scene, "--refine", "2")
    for said in ("-rows_stiffness is per node: 12 on the scene's mesh, 20", "-contact_kn is per pair: 9 on the scene's mesh, 25"):
        require(said in out.text, f"'{said}' is not said: {out.text}")
    rows = work.table(out, "modes_mesh.csv", {"how": str, "shape_share": optional, "error_mesh_hz": optional, "label": str})
    found = [row for row in rows if row["how"] != "no partner"]
    require(len(found) >= 0.8 * len(rows) and all(row["shape_share"] > 0.5 for row in found), f"modes were not found again: {rows}")
    onsets = work.table(out, "onsets_mesh.csv", {"critical_value": float, "how": str, "error_mesh": optional})
    require(onsets, "the sweep has no onset, so that nothing was compared")


def bad(work):
    for name, words, said in BAD:
        done = work.run(SOURCE / "options" / name, *words)
        lines = done.stderr.strip().splitlines()
        require(done.returncode == 1 and len(lines) == 1 and said in lines[0], f"{name} {words}: {done.stderr}")
        require(not (work.folder / "out/modes_mesh.csv").exists(), f"{name} {words}: wrote a table")
    for words in REFUSED:
        done = work.run("plate.yaml", *words)
        require(done.returncode == 2 and words[0] in done.stderr and not (work.folder / "out").exists(), f"{words}: {done.stderr}")
    done = work.run(work.folder / "brake.yaml", "-sweep_parameter", "contact_kn", "-sweep_values", "1e8:2e8:2")
    require(done.returncode == 1 and "is per node or pair" in done.stderr, f"a swept kn: {done.stderr}")


class Work:
    """Folder and programs."""

    def __init__(self, folder, program):
        self.folder, self.program, self.start = folder, program, starter(program)

    def modes(self, name, *words):
        """Frequencies of a run of squeal, Hz."""
        done = self.start.run(self.folder, [*words, "-output_dir", self.folder / f"modes{name}"])
        require(done.status == 0, f"modes{name}: {done.stderr}")
        return np.array([row["freq_hz"] for row in read_table(self.folder / f"modes{name}/modes.csv", {"freq_hz": float})])

    def run(self, scene, *words):
        """The script, with results in out."""
        scene = scene if isinstance(scene, Path) else SOURCE / "options" / scene
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        return run_script(SOURCE / "scripts/richardson", [scene, "--program", self.program, "--output", "out", *words], self.folder)

    def done(self, scene, *words):
        """The same, which must succeed."""
        done = self.run(scene, *words)
        require(done.returncode == 0, f"{scene} {words}: {done.stderr}")
        done.text = done.stdout
        return done

    def table(self, _, name, kinds):
        return read_table(self.folder / "out" / name, kinds)


def main():
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(Path(folder), program)
        for part in (orders, cuts, limit, brake, bad):
            part(work)
            print(part.__name__)
        work.start.end()


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(str(failure))
