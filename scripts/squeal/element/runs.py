"""Modes of one body by one element on one mesh: frequencies, unknowns, processor time and peak memory of the whole run."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy

from .meshes import ELEMENTS, mesh_body
from ..run.kept_runs import KeptRun
from ..run.program import measured
from ..tables import read_table

# What an element may end with that is so stiff that no mode is left in the band, or that bends too much on a coarse mesh
HOPELESS = "contains no mode", "is inverted or has no volume"
STEEL = "-body_young 210e9 -body_poisson 0.3 -body_density 7800"


@dataclass(frozen=True)
class Problem:
    """A body, the band in Hz that holds the lowest elastic modes with room above them, and more words."""
    name: str
    body: object
    band: tuple
    options: str = ""


@dataclass(frozen=True)
class Result:
    """Of a run: element, its size in m, unknowns (0: no mesh without inverted elements), s of processor, MB, Hz ascending, where."""
    element: str
    size: float
    unknowns: int
    seconds: float
    megabytes: float
    frequencies: numpy.ndarray
    folder: Path

    def error(self, reference):
        """The worst of the lowest modes, relative; nan where the band lacks some of them."""
        if len(self.frequencies) < len(reference):
            return numpy.nan
        return abs(self.frequencies[:len(reference)] / reference - 1).max()


def is_hopeless(text):
    """Whether the run ended so."""
    return any(end in text for end in HOPELESS)


def solve(args, problem, element, size, counts=None, more=""):
    """The run of an element of a size, or with counts of elements; taken from its folder where it is there."""
    options = ELEMENTS[element][0]
    mesh_name = "x".join(map(str, counts)) if counts else f"{1e3 * size:.3g}"
    name = f"{problem.name}_{element}_{mesh_name}{more}"
    folder = args.runs / re.sub(r"[^\w.]+", "_", name)
    folder.mkdir(parents=True, exist_ok=True)
    mesh = folder / "mesh.msh"
    if not mesh.exists():
        mesh_body(mesh, problem.body, element, size, counts)
    words = ["-model_mesh", mesh, "-parts", "body", *STEEL.split(), *options.split(), *problem.options.split(),
             "-modes_band", ",".join(map(str, problem.band)), "-output_fields", 0, "-squeal_progress", 0, "-squeal_view",
             *more.split()]
    run = KeptRun(args.program, 1, folder, words)
    if not run.is_complete():
        text, seconds, megabytes = measured(run.begin(), name, is_hopeless)
        run.end(f"{seconds} s {megabytes} MB\n{text}")
    seconds, megabytes = map(float, run.text().split()[0:4:2])
    count = re.search(r" (\d+) unknowns", run.text())
    rows = [] if is_hopeless(run.text()) else read_table(folder / "modes.csv", {"freq_hz": float})
    return Result(element, size, int(count[1]) if count else 0, seconds, megabytes, numpy.array([row["freq_hz"] for row in rows]),
                  folder)
