"""Runs of squeal on the paper's brake for study/static: pairs of the sliding state, unstable modes, closed pairs."""

import re
import tempfile
from pathlib import Path

import numpy

from ..run.program import launch, scene
from ..tables import flag, read_table
from .pairs import read_surfaces

MODES = {"freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str}
MIDDLE = 0.110  # m, x of the plane of symmetry, along which the pad slides
NODE = 1e-6  # m, two places within this are one


def run_squeal(program, ranks, files, options, folder):
    """Writes the tables into the folder; returns the output. The options files of options/ stack in their order."""
    words = ["-squeal_progress", 0, "-output_fields", 0, *scene(*files), "-output_dir", folder, *options.split()]
    return launch(program, ranks, words, f"{', '.join(files)}, options {options}")


def static_state(program, ranks, options):
    """The surface in contact of a static run."""
    with tempfile.TemporaryDirectory() as folder:
        run_squeal(program, ranks, ["massi2005"], f"-analysis static {options}", folder)
        return read_surfaces(Path(folder) / "static.csv")[0]


def unstable_modes(program, ranks, options):
    """Unstable modes by frequency, and the number of pairs closed, None where the output does not say it."""
    with tempfile.TemporaryDirectory() as folder:
        text = run_squeal(program, ranks, ["massi2005"], f"-analysis modes -modes_left 0 {options}", folder)
        rows = [row for row in read_table(Path(folder) / "modes.csv", MODES) if row["unstable"]]
    closed = re.findall(r"(\d+) of \d+ pairs closed", text)
    return sorted(rows, key=lambda row: row["freq_hz"]), int(closed[-1]) if closed else None


def unlike_mirrors(surface):
    """How many pairs have another status than their mirror image about the plane of symmetry."""
    mirrored = surface.x * [-1, 1, 1] + [2 * MIDDLE, 0, 0]
    apart = numpy.linalg.norm(mirrored[:, None] - surface.x, axis=2)
    if apart.min(axis=1).max() > NODE:
        raise SystemExit(f"a pair has no mirror image about x = {MIDDLE:g} m")
    return int((surface.status != surface.status[apart.argmin(axis=1)]).sum())
