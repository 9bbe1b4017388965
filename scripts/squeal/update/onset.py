"""How sure an onset is: sweeps of another parameter, as friction, at the parameters found and one standard deviation to each side along
each principal direction of their covariance. With m(t) the critical value, to first order

    var m = sum_k ((m(t + s_k v_k) - m(t - s_k v_k)) / 2)^2,     C = sum_k s_k^2 v_k v_k',

exact where m is linear; half the sum of the second differences is what the curve of m moves its mean by, to second order."""

import math
from dataclasses import dataclass, field

import numpy
from scipy.optimize import linear_sum_assignment

from ..tables import BadInput, read_table

KINDS = {"critical_value": float, "freq_hz": float, "kind": str, "label": str, "error_estimate": float}
ENDS = "lock_out", "positive_damping", "restabilisation"  # what ends a growth
NEAR = 0.1  # relative difference of frequency of what may be one onset
TINY = 1e-9  # of the largest variance: directions that are left out


@dataclass
class Onset:
    """A row of onsets.csv with the differences of its critical value by direction, nan where it is not there, and the steps they are of."""
    row: dict
    first: list = field(default_factory=list)
    second: list = field(default_factory=list)
    steps: list = field(default_factory=list)
    draws: numpy.ndarray | None = None  # critical values of scripts/update --draws

    def deviation(self):
        """Standard deviation."""
        return math.sqrt(sum(x**2 for x in self.first))

    def at(self, t):
        """Critical value at t from the parameters found, to first order."""
        return self.row["critical_value"] + sum(x * (step @ t) / (step @ step) for x, step in zip(self.first, self.steps))

    def bend(self):
        """By how much the mean is moved."""
        return sum(self.second) / 2


def sweep(model, t, name, values):
    """Onsets over a parameter."""
    folder = model.run(model.values(t), ("-analysis", "sweep", "-sweep_parameter", name, "-sweep_values", values), "sweep")
    path = folder / "onsets.csv"
    return [row for row in read_table(path, KINDS) if row["kind"] not in ENDS] if path.exists() else []


def partners(onsets, rows):
    """For each onset the row that is it in another sweep, or None."""
    if not rows:
        return [None] * len(onsets)
    cost = numpy.array([[abs(math.log(row["freq_hz"] / one.row["freq_hz"])) if row["freq_hz"] * one.row["freq_hz"] > 0 else 0
                         for row in rows] for one in onsets])
    cost += numpy.array([[abs(row["critical_value"] / one.row["critical_value"] - 1) if one.row["critical_value"] else 0
                          for row in rows] for one in onsets])
    cost += 1e3 * numpy.array([[row["kind"] != one.row["kind"] for row in rows] for one in onsets])
    found = [None] * len(onsets)
    for i, k in zip(*linear_sum_assignment(cost)):
        if cost[i, k] < 2 * NEAR + 1 and abs(math.log((rows[k]["freq_hz"] or 1) / (onsets[i].row["freq_hz"] or 1))) < NEAR:
            found[i] = rows[k]
    return found


def onsets_of(model, found, text):
    """Onsets at the parameters found, with their spread; text: NAME=LOW:HIGH:N."""
    name, _, values = text.partition("=")
    if not values or name in model.start:
        raise BadInput(f"--onset {text}: must be PARAMETER=LOW:HIGH:N, of a parameter that is not among --parameters")
    onsets = [Onset(row) for row in sweep(model, found.t, name, values)]
    variances, vectors = numpy.linalg.eigh(found.covariance)
    for k in numpy.flatnonzero(variances > TINY * variances.max(initial=0)) if onsets else []:
        step = math.sqrt(variances[k]) * vectors[:, k]
        sides = [partners(onsets, sweep(model, found.t + sign * step, name, values)) for sign in (1, -1)]
        for one, up, down in zip(onsets, *sides):
            one.steps.append(step)
            both = up is not None and down is not None
            one.first.append((up["critical_value"] - down["critical_value"]) / 2 if both else math.nan)
            one.second.append(up["critical_value"] + down["critical_value"] - 2 * one.row["critical_value"] if both else math.nan)
    return name, onsets
