"""Meshes that the program gmsh makes of the scripts of options/."""

import subprocess

from .program import ROOT
from .tables import BadInput


def make_mesh(name, path, form="msh41", **numbers):
    """Has gmsh mesh options/NAME.geo into a file, with numbers of the script set; what it calls an error is one."""
    words = ["gmsh", "-3", "-format", form, ROOT / f"options/{name}.geo", "-o", path]
    for key, value in numbers.items():
        words += ["-setnumber", key, value]
    try:
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    except OSError:
        raise BadInput("gmsh cannot be run: apt-get install gmsh") from None
    errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error") and "---" not in line]
    if done.returncode or errors:
        raise BadInput(f"gmsh options/{name}.geo: {errors[0] if errors else done.stderr.strip()}")
