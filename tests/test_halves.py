#!/usr/bin/env python3
"""A scene with a plane of symmetry by halves: its modes are those of the half that holds the normal displacement of the plane's nodes
(even) and of the half that holds the tangential ones (odd). Reference: the whole scene. A pad that slides on a slab along the
plane, so that growth is among what is compared: modes with damping, modes about all pairs with stiffness by area, of which a
pair in the plane has half. Breaks where supports, contact stiffness or friction of nodes in the plane count other than by area,
or where elements are not their own mirror images.

    test_halves.py SQUEAL LAUNCHER"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)

WIDTH = 0.02  # half of it, m
BODIES = {"slab": ((-0.05, 0.05), (-0.01, 0.0), (10, 4, 2)), "pad": ((-0.02, 0.02), (0.0, 0.015), (4, 4, 3))}  # x, z, cells of a half
SCENE = """-parts slab,pad -slab_young 210e9 -slab_poisson 0.3 -slab_density 7800 -slab_alpha 20 -pad_young 12e9 -pad_poisson 0.3
    -pad_density 2500 -pad_alpha 20 -contacts rub -rub_surfaces pad_bottom,slab_top -rub_law penalty -rub_kn_per_area 2e14
    -rub_mu 0.7 -rub_slip 1,0,0 -springs holder -holder_set pad_top -holder_stiffness_per_area 2e10,3e10,1e11
    -modes_band 500,60000 -output_fields 0"""
RTOL = 1e-9


def body(first, x, y, z, cells):
    """Nodes of a box, its hexahedra and the quadrilaterals of its sides, with numbers from `first` on."""
    n = numpy.array(cells) + 1
    axes = [numpy.linspace(*range_, n[d]) for d, range_ in enumerate((x, y, z))]
    nodes = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    number = first + numpy.arange(len(nodes)).reshape(n)
    a, b = slice(None, -1), slice(1, None)
    ring = [(a, a), (b, a), (b, b), (a, b)]
    hexahedra = numpy.stack([number[i, j, k] for k in (a, b) for i, j in ring], -1).reshape(-1, 8)
    side = {name: numpy.stack([face[i, j] for i, j in ring], -1).reshape(-1, 4) for name, face in
            {"bottom": number[:, :, 0], "top": number[:, :, -1], "start": number[0], "cut": number[:, 0]}.items()}
    return nodes, hexahedra, side


def write_mesh(path, half):
    """Both bodies, whole or the half of positive y, as a file of Gmsh."""
    y, factor = ((0, WIDTH), 1) if half else ((-WIDTH, WIDTH), 2)
    nodes, groups = [], {}
    for name, (x, z, cells) in BODIES.items():
        added, groups[3, name], side = body(1 + sum(map(len, nodes)), x, y, z, (cells[0], factor * cells[1], cells[2]))
        nodes.append(added)
        for set_, quads in side.items():
            key = (2, "cut" if set_ == "cut" else f"{name}_{set_}")
            groups[key] = numpy.concatenate([groups[key], quads]) if key in groups else quads
    nodes = numpy.concatenate(nodes)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {i + 1} "{name}"' for i, (dimension, name) in enumerate(groups)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {' '.join(repr(float(x)) for x in place)}" for i, place in enumerate(nodes)]
    elements = [(5 if dimension == 3 else 3, i + 1, row) for i, ((dimension, _), rows) in enumerate(groups.items()) for row in rows]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k + 1} {kind} 2 {i} {i} {' '.join(map(str, row))}" for k, (kind, i, row) in enumerate(elements)]
    path.write_text("\n".join([*lines, "$EndElements"]) + "\n")


def eigenvalues(folder, squeal, launcher, name, mesh, fix):
    """Of a run that holds the slab's start, and directions of the cut; [rad/s] in order of frequency."""
    words = [*SCENE.split(), "-model_mesh", mesh, "-output_dir", name, "-supports", "clamp,plane" if fix else "clamp",
             "-clamp_set", "slab_start", "-clamp_fix", "xyz", *(["-plane_set", "cut", "-plane_fix", fix] if fix else [])]
    done = subprocess.run([launcher, "-n", "1", squeal, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"FAILED run {name}: {done.stderr}")
    with (folder / name / "modes.csv").open(newline="") as table:
        return [float(row["growth_rad_s"]) + 2j * numpy.pi * float(row["freq_hz"]) for row in csv.DictReader(table)]


def main(squeal, launcher):
    """Whole against both halves."""
    program = str(Path(squeal).resolve()), str(Path(launcher).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_mesh(folder / "whole.msh", False)
        write_mesh(folder / "half.msh", True)
        whole = eigenvalues(folder, *program, "whole", "whole.msh", "")
        even = eigenvalues(folder, *program, "even", "half.msh", "y")
        odd = eigenvalues(folder, *program, "odd", "half.msh", "xz")
    both = [*even, *odd]
    worst = max((min(abs(value - other) for other in both) / abs(value) for value in whole), default=numpy.inf)
    growing = sum(value.real > 1 for value in whole)
    good = len(whole) == len(both) and len(even) and len(odd) and worst <= RTOL and growing > 0
    print(f"{len(whole)} modes of the whole, {len(even)} even, {len(odd)} odd, {growing} unstable: differ by {worst:.1e} at most, "
          f"{RTOL:g} allowed")
    sys.exit(0 if good else "FAILED")


if __name__ == "__main__":
    main(*sys.argv[1:])
