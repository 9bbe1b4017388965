"""How sure an onset is, by draws from the covariance: each draw with values of the other parameter about the onset is a condition of one
run of -analysis sample, which solves all on one basis. The onset of a draw is where growth begins among the modes near the frequency of
the onset found, of several the one nearest to what the first derivatives tell: between the last value without it and the first with it,
g(m_0) and g(m_1), by

    m = m_0 + (m_1 - m_0) g_0 / (g_0 - g_1)                 of damped modes, g_0 < 0,
    m = m_1 - (m_2 - m_1) g_1^2 / (g_2^2 - g_1^2)           where g_0 = 0: growth goes as the root of m beyond a lock-in."""

import csv
import math

import numpy

from ..tables import BadInput, read_table, whole

VALUES = 15  # of the other parameter
WIDTH = 4  # standard deviations to each side of the onset
NEAR = 0.03  # relative difference of frequency
NONE = 1e-9  # growth of |lambda| that is none
CONDITIONS = {"condition": int, "freq_hz": float, "growth_rad_s": float}


def conditions(path, names, points):
    """A file of conditions."""
    with whole(path) as part, part.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(["condition", *names])
        writer.writerows([f"draw {k}", *(f"{value:.17g}" for value in point)] for k, point in enumerate(points))


def begins_of(values, growth):
    """Where growth begins over rising values; growth -inf is not known."""
    return [begin_at(values, growth, k) for k in numpy.flatnonzero((growth[1:] > 0) & (growth[:-1] <= 0) & numpy.isfinite(growth[:-1]))]


def onset_of(values, growth, near):
    """Of several the one nearest; beyond the values -inf or inf, nan where it is not known."""
    begins, known = begins_of(values, growth), growth[numpy.isfinite(growth)]
    if begins:
        return min(begins, key=lambda m: abs(m - near))
    if not len(known) or ((known[1:] > 0) & (known[:-1] <= 0)).any():
        return math.nan
    return -math.inf if known[0] > 0 else math.inf


def begin_at(values, growth, k):
    """The same between a value without growth and the next one."""
    (m0, m1), (g0, g1) = values[k:k + 2], growth[k:k + 2]
    if g0 < 0:
        return m0 + (m1 - m0) * g0 / (g0 - g1)
    g2 = growth[k + 2] if k + 2 < len(growth) else 0
    return max(m0, m1 - (values[k + 2] - m1) * g1**2 / (g2**2 - g1**2)) if g2 > g1 else (m0 + m1) / 2


def growth_near(rows, count, freq):
    """The largest growth near a frequency at each condition; 0 where it is rounding, -inf where no mode is near."""
    most = numpy.full(count, -math.inf)
    for row in rows:
        if abs(row["freq_hz"] / freq - 1) < NEAR:
            growth = row["growth_rad_s"] if abs(row["growth_rad_s"]) > NONE * 2 * math.pi * freq else 0
            most[row["condition"] - 1] = max(most[row["condition"] - 1], growth)
    return most


def draws_of(model, found, name, onset, count):
    """Critical values of the draws about an onset with its standard deviation; -inf or inf beyond the values, nan where not known."""
    deviation, value = onset.deviation(), onset.row["critical_value"]
    if not 0 < deviation < math.inf:
        return numpy.full(count, math.nan)
    values = value + WIDTH * deviation * numpy.linspace(-1, 1, VALUES)
    t = numpy.random.default_rng(1).multivariate_normal(found.t, found.covariance, count)
    points = [[*model.values(one).values(), other] for one in t for other in values]
    path = model.args.output / "draws.csv"
    conditions(path, [*model.start, name], points)
    also = ("-analysis", "sample", "-sample_conditions", path, "-sample_restart", "false", "-output_fields", 0)
    folder = model.run(model.values(found.t), also, "draws")
    rows = read_table(folder / "conditions.csv", CONDITIONS)
    if not rows:
        raise BadInput(f"{folder}/conditions.csv: has no row")
    growth = growth_near(rows, len(points), onset.row["freq_hz"]).reshape(count, -1)
    return numpy.array([onset_of(values, one, onset.at(x - found.t)) for one, x in zip(growth, t)])
