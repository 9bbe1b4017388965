#!/usr/bin/env python3
"""A scene with a plane of symmetry by halves: its modes are those of the half that holds the normal displacement of the plane's nodes
(even) and of the half that holds the tangential ones (odd). Reference: the whole scene. A pad that slides on a slab along the
plane, so that growth is among what is compared: modes with damping, modes about all pairs with stiffness by area, of which a
pair in the plane has half. Breaks where supports, contact stiffness or friction of nodes in the plane count other than by area,
or where elements are not their own mirror images.

    test_halves.py SQUEAL"""

import csv
import re
import sys
import tempfile
from pathlib import Path

try:
    import numpy
except ImportError as error:
    print(f"skipped: no Python module {error.name}")
    sys.exit(77)
from served import outcome_of, starter

WIDTH = 0.02  # half of it, m
BODIES = {"slab": ((-0.05, 0.05), (-0.01, 0.0), (10, 4, 2)), "pad": ((-0.02, 0.02), (0.0, 0.015), (4, 4, 3))}  # x, z, cells of a half
SCENE = """-parts slab,pad -slab_young 210e9 -slab_poisson 0.3 -slab_density 7800 -slab_alpha 20 -pad_young 12e9 -pad_poisson 0.3
    -pad_density 2500 -pad_alpha 20 -contacts rub -rub_surfaces pad_bottom,slab_top
    -rub_mu 0.7 -rub_slip 1,0,0 -rub_law penalty -rub_kn_per_area 2e14 -springs holder -holder_set pad_top
    -holder_stiffness_per_area 2e10,3e10,1e11 -modes_band 500,60000 -clamp_set slab_start -clamp_fix xyz -output_fields 0"""
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
            {"bottom": number[:, :, 0], "top": number[:, :, -1], "start": number[0], "end": number[-1], "cut": number[:, 0]}.items()}
    return nodes, hexahedra, side


def write_mesh(path, half):
    """Both bodies, whole or the half of positive y, as a file of Gmsh."""
    y, factor = ((0, WIDTH), 1) if half else ((-WIDTH, WIDTH), 2)
    nodes, groups = [], {}
    for name, (x, z, cells) in BODIES.items():
        added, groups[3, name], side = body(1 + sum(map(len, nodes)), x, y, z, (cells[0], factor * cells[1], cells[2]))
        nodes.append(added)
        for set_, quads in side.items():
            key = (2, set_ if set_ == "cut" else f"{name}_{set_}")
            groups[key] = numpy.concatenate([groups[key], quads]) if key in groups else quads
    nodes = numpy.concatenate(nodes)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {i + 1} "{name}"' for i, (dimension, name) in enumerate(groups)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {' '.join(f'{x:.17g}' for x in place)}" for i, place in enumerate(nodes)]
    elements = [(5 if dimension == 3 else 3, i + 1, row) for i, ((dimension, _), rows) in enumerate(groups.items()) for row in rows]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k + 1} {kind} 2 {i} {i} {' '.join(map(str, row))}" for k, (kind, i, row) in enumerate(elements)]
    path.write_text("\n".join([*lines, "$EndElements"]) + "\n")


def eigenvalues(program, folder, name, mesh, supports):
    """Of a run [rad/s]."""
    done = outcome_of(program, folder, ["-options_file", "scene.txt", "-model_mesh", mesh, "-output_dir", name, *supports.split()], 1)
    if done.status:
        sys.exit(f"FAILED run {name}, exit status {done.status}: {done.stderr}")
    with (folder / name / "modes.csv").open(newline="") as file:
        return numpy.array([float(row["growth_rad_s"]) + 2j * numpy.pi * float(row["freq_hz"]) for row in csv.DictReader(file)])


def apart(found, reference):
    """Largest relative difference of the eigenvalues; infinite where their numbers differ."""
    if len(found) != len(reference) or not len(reference):
        return numpy.inf
    return max(abs(found - value).min() / abs(value) for value in reference)


def main(squeal):
    with tempfile.TemporaryDirectory() as name:
        folder, program = Path(name), starter(squeal)
        write_mesh(folder / "whole.msh", False)
        write_mesh(folder / "half.msh", True)
        (folder / "scene.txt").write_text(re.sub(r"\s(-[a-z])", r"\n\1", SCENE) + "\n")
        whole = eigenvalues(program, folder, "whole", "whole.msh", "-supports clamp")
        even, odd = (eigenvalues(program, folder, fix, "half.msh", f"-supports clamp,plane -plane_set cut -plane_fix {fix}")
                     for fix in ("y", "xz"))
    error, growing = apart(numpy.concatenate([even, odd]), whole), int((whole.real > 1).sum())
    print(f"{len(whole)} modes by halves, {len(even)} even, {len(odd)} odd, {growing} unstable: {error:.1e}, asked {RTOL:g}")
    return 0 if error <= RTOL and growing else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
