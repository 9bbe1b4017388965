"""Parameters from measurements by least squares with a prior.

With t = ln(p / start) of the parameters, measured frequencies f_i and damping ratios z_i with standard deviations s_i, and a prior of
mean m and covariance P of t, the most probable parameters minimise

    chi^2(t) = sum_i (y_i - Y_i(t))^2 / s_i^2 + (t - m)' P^-1 (t - m),        y = ln f, or z.

Gauss and Newton: J' W J + P^-1 is solved for each step, J = dY/dt of exact derivatives; a step that does not lower chi^2 is halved. The
covariance of t is C = (J' W J + P^-1)^-1 at the end, and the 95 % interval p exp(-+ 1.96 sqrt(C_kk)). Directions of t whose standard
deviation is above `wide` are not identified: they are held at the start and said. Reference: A. Tarantola, Inverse Problem Theory, 2005."""

from dataclasses import dataclass

import numpy

LONGEST = 0.3  # of a step, in t
HALVINGS = 6
MOST = 20  # steps
ENOUGH = 1e-2  # of its standard deviation, or
LEAST = 1e-7  # of t, by which the last step moves each parameter at most


@dataclass
class Predicted:
    """Differences measured less computed, in standard deviations; their derivatives by t; anything else of the model."""
    residual: numpy.ndarray
    slope: numpy.ndarray
    what: object


@dataclass
class Prior:
    """Mean of t and inverse of its covariance, zero where nothing is known."""
    mean: numpy.ndarray
    weight: numpy.ndarray


@dataclass
class Fit:
    """Parameters t with covariance, chi^2 of the measurements and with the prior; directions that were held, with the standard deviation
    of each; the number of models that were computed."""
    t: numpy.ndarray
    covariance: numpy.ndarray
    misfit: float
    chi2: float
    held: list
    models: int
    converged: bool
    first: Predicted
    last: Predicted


def chi_squared(predicted, prior, t):
    """The sum of squares."""
    return float(predicted.residual @ predicted.residual + (t - prior.mean) @ prior.weight @ (t - prior.mean))


def decomposed(predicted, prior, wide):
    """Eigenvectors of J' W J + P^-1, their standard deviations, and which are identified."""
    values, vectors = numpy.linalg.eigh(predicted.slope.T @ predicted.slope + prior.weight)
    deviation = 1 / numpy.sqrt(numpy.maximum(values, 1e-30))
    return vectors, deviation, deviation <= wide


def step_of(predicted, prior, t, wide):
    """Gauss and Newton's step in the directions that are identified, no longer than LONGEST."""
    vectors, deviation, known = decomposed(predicted, prior, wide)
    downhill = predicted.slope.T @ predicted.residual - prior.weight @ (t - prior.mean)
    step = vectors[:, known] @ ((vectors[:, known].T @ downhill) * deviation[known]**2)
    return step * min(1, LONGEST / max(abs(step).max(initial=0), 1e-300))


def search(model, prior, t, step, now):
    """The first of halved steps that lowers chi^2, None where none does; and how many models that took."""
    for k in range(HALVINGS):
        trial = model(t + step)
        if trial is not None and chi_squared(trial, prior, t + step) < chi_squared(now, prior, t):
            return t + step, trial, k + 1
        step = step / 2
    return None, None, HALVINGS


def fit(model, prior, wide, tell=lambda *what: None):
    """The most probable parameters. model(t) is Predicted, or None where there is none."""
    t, models, converged = numpy.zeros(len(prior.mean)), 1, False
    first = now = model(t)
    for number in range(MOST):
        tell(number, now, chi_squared(now, prior, t))
        vectors, deviation, known = decomposed(now, prior, wide)
        spread = numpy.sqrt(((vectors[:, known] * deviation[known])**2).sum(axis=1))
        step = step_of(now, prior, t, wide)
        if (abs(step) <= numpy.maximum(ENOUGH * spread, LEAST)).all():
            converged = True
            break
        moved, better, count = search(model, prior, t, step, now)
        models += count
        if better is None:
            converged = bool((abs(step) <= spread).all())  # rounding, or pairs that change, within the interval
            break
        t, now = moved, better
    vectors, deviation, known = decomposed(now, prior, wide)
    covariance = (vectors[:, known] * deviation[known]**2) @ vectors[:, known].T
    held = [(deviation[k], vectors[:, k]) for k in numpy.flatnonzero(~known)]
    return Fit(t, covariance, float(now.residual @ now.residual), chi_squared(now, prior, t), held, models, converged, first, now)
