#!/usr/bin/env python3
"""Has the program gmsh mesh a script of options/ for a case, with numbers of the script set.

    gmsh_mesh.py brake brake.msh size=24"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from squeal.mesh.gmsh import make_mesh


if __name__ == "__main__":
    make_mesh(sys.argv[1], sys.argv[2], **dict(word.split("=") for word in sys.argv[3:]))
