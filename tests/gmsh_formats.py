#!/usr/bin/env python3
"""One mesh in all the forms in which Gmsh writes it: gmsh_formats.py FOLDER

Two boxes share a face; the group "bottom" has the lower face of both, one of them reversed (with `reversed` both)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import run_gmsh

SCRIPT = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.05, 0.06, 0.01};
Box(2) = {0.05, 0, 0, 0.05, 0.06, 0.01};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMax = 0.02; Mesh.ElementOrder = 2; Mesh.SecondOrderLinear = 1;
Physical Volume("plate") = {1, 2};
left[] = Surface In BoundingBox{-1e-5, -1e-5, -1e-5, 0.05001, 0.06001, 1e-5};
right[] = Surface In BoundingBox{0.04999, -1e-5, -1e-5, 0.10001, 0.06001, 1e-5};
Physical Surface("bottom") = {-left[], SIGNright[]};
"""
FORMS = {"text22": "-format msh22", "text41": "-format msh41", "binary41": "-format msh41 -bin", "parts22": "-format msh22 -part 3",
         "parts41": "-format msh41 -part 3", "binaryparts41": "-format msh41 -part 3 -bin",
         "ghosts": "-format msh41 -part 3 -part_ghosts", "parametric22": "-format msh22 -setnumber Mesh.SaveParametric 1",
         "parametric41": "-format msh41 -part 2 -setnumber Mesh.SaveParametric 1", "all": "-format msh41 -save_all"}


def main():
    folder = Path(sys.argv[1])
    for sign in "", "-":
        (folder / f"plate{sign}.geo").write_text(SCRIPT.replace("SIGN", sign))
    for name, options in FORMS.items():
        words = options.split()
        run_gmsh(folder / "plate.geo", folder / f"{name}.msh", *words[2:], form=words[1])
    run_gmsh(folder / "plate-.geo", folder / "reversed.msh")


if __name__ == "__main__":
    main()
