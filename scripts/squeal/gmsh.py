"""Meshes that the program gmsh makes of the scripts of options/."""

import subprocess

from .program import ROOT
from .tables import BadInput


def run_gmsh(script, path, *options, form="msh41"):
    """Has gmsh mesh a script into a file; what it calls an error is one."""
    words = ["gmsh", "-3", "-format", form, script, "-o", path, *options]
    try:
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    except OSError:
        raise BadInput("gmsh cannot be run: apt-get install gmsh") from None
    errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error") and "---" not in line]
    if done.returncode or errors:
        raise BadInput(f"gmsh {script}: {errors[0] if errors else done.stderr.strip()}")


def make_mesh(name, path, form="msh41", **numbers):
    """Has gmsh mesh options/NAME.geo into a file, with numbers of the script set."""
    options = [word for key, value in numbers.items() for word in ("-setnumber", key, value)]
    run_gmsh(ROOT / f"options/{name}.geo", path, *options, form=form)
