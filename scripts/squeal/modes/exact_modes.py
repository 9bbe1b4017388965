"""The coarse brake of the studies of speed against error, its exact eigenvalues, and the error of a run beside them."""

import numpy

from .exact import refined
from ..run.program import scene
from ..tables import BadInput, read_table

BRAKE = (*scene("massi2005"), "-rig_disc_elements", "12,56,1", "-rig_pad_elements", "5,5,5", "-rig_beam_elements", 10,
         "-output_fields", 0, "-squeal_progress", 0)
BAND = "-modes_band", "1000,9000"
MU = 0.5  # of the scene, which its stiffness has with friction
REFERENCE = ("The reference are eigenvalues of the matrices that the program saves, refined in extended precision (64 bits) "
             "by two-sided Rayleigh quotients; their digits know nothing of the eigensolver, which only says near what to look.")
SAME = 1e-13  # relative distance of eigenvalues that are one
EIGENVALUE = {"freq_hz": float, "growth_rad_s": float}


def eigenvalues(path, keep=lambda row: True, **more):
    """sigma + i omega of the rows of a table."""
    rows = read_table(path, EIGENVALUE | more)
    return numpy.array([complex(row["growth_rad_s"], 2 * numpy.pi * row["freq_hz"]) for row in rows if keep(row)])


def exact(bench, words, name):
    """The exact eigenvalues of a scene in its band, from one run that gives guesses and matrices."""
    matrices = bench.folder / name / "matrices"
    folder, *_ = bench.once([*words, "-operators_save", matrices], name)
    guesses = eigenvalues(folder / "modes.csv")
    values = refined(matrices, MU, guesses)
    if numpy.isnan(values).any():
        raise BadInput(f"{name}: an eigenvalue was not refined in extended precision")
    if any(abs(other - value) < SAME * abs(value) for i, value in enumerate(values) for other in values[:i]):
        raise BadInput(f"{name}: two of the eigenvalues found are the same exact one")
    return values


def worst(found, true):
    """Largest relative distance of a true eigenvalue from the nearest one found; 1 where their numbers differ."""
    if len(found) != len(true):
        return 1.0
    return float((abs(found[:, None] - true[None]).min(axis=0) / abs(true)).max())
