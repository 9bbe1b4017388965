"""A clamped body that is hit: all of its free nodes start with one velocity. Linear, so that its motion is known exactly from the
matrices that the program saves: of the equations in time, M x'' + K x = 0, and of central differences with a step h, whose modes are
v sin(n theta) h / sin(theta), 2 sin(theta / 2) = omega h."""

import numpy
import scipy.linalg

from ..modes.exact import sparse
from ..tables import BadInput, read_table

MATERIAL = ("-parts", "body", "-body_young", 210e9, "-body_poisson", 0.3, "-body_density", 7800)
TRANSIENT = ("-body_velocity", "0,0,1", "-analysis", "transient", "-output_fields", 0, "-squeal_progress", 0, "-probes", "tip")
LUMPED = ("-analysis", "modes", "-modes_target", 1000, "-modes_count", 1, "-operators_mass", "lumped", "-output_fields", 0)
HISTORY = {"time_s": float, "tip_z_m": float}
SAME = 0.02  # how near one unknown's motion must be to that of the probe in the run that tells it


def struck(bench, body, motion, fine):
    """The Struck of a scene: body words for all runs, motion those of a transient, and fine what makes it exact enough to tell which
    unknown its probe records."""
    matrices = bench.folder / "matrices"
    bench.once([*body, *LUMPED, "-operators_save", matrices], "lumped")
    made = Struck(matrices)
    made.find(rows_of(bench.once([*body, *motion, *fine], "fine")[0]))
    return made


class Struck:
    """Modes of the body, and which unknown the probe records."""

    def __init__(self, matrices):
        stiffness, mass = (sparse(matrices / f"{name}.bin").toarray() for name in "KM")
        if abs(mass - numpy.diag(mass.diagonal())).max() > 0:
            raise BadInput(f"{matrices}: the mass is not lumped")
        values, self.shapes = scipy.linalg.eigh(stiffness, mass)
        self.omega = numpy.sqrt(values)
        direction = numpy.zeros(len(mass))
        direction[2::3] = 1
        self.start = self.shapes.T @ (mass @ direction)
        self.tip = None

    def at(self, times, rows=slice(None)):
        """Exact displacements [time][unknown]."""
        return (numpy.sin(numpy.outer(times, self.omega)) * (self.start / self.omega)) @ self.shapes[rows].T

    def stepped(self, n, step, rows=slice(None)):
        """Those of central differences after n steps each."""
        theta = 2 * numpy.arcsin(self.omega * step / 2)
        return (numpy.sin(numpy.outer(n, theta)) * (self.start * step / numpy.sin(theta))) @ self.shapes[rows].T

    def find(self, rows):
        """Sets the unknown whose motion the history of a run shows: the nearest one, which must be near."""
        times, tip = history(rows)
        some = slice(None, None, max(1, len(times) // 200))
        far = relative(tip[some, None], self.at(times[some])[:, 2::3])
        if far.min() > SAME:
            raise BadInput(f"no unknown moves as the probe does; the nearest is {far.min():.1g} away")
        self.tip = 2 + 3 * int(numpy.argmin(far))

    def error(self, rows):
        """Of a history, beside the equations in time."""
        times, tip = history(rows)
        return float(relative(tip, self.at(times, [self.tip])[:, 0]))

    def error_of_steps(self, rows, step):
        """Beside central differences with a step of which some digits are known; the table has all."""
        times, tip = history(rows)
        n = numpy.round(times / step)
        return float(relative(tip, self.stepped(n, times[-1] / n[-1], [self.tip])[:, 0]))


def history(rows):
    """Times and displacements."""
    return numpy.array([row["time_s"] for row in rows]), numpy.array([row["tip_z_m"] for row in rows])


def relative(found, true):
    """Root mean square of the difference over that of the truth, along the first axis."""
    return numpy.sqrt(((found - true)**2).mean(axis=0) / (true**2).mean(axis=0))


def rows_of(folder):
    """The history of a run."""
    return read_table(folder / "transient.csv", HISTORY)
