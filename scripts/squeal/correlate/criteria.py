"""Measured shapes beside computed ones at the sensors.

MAC(a, b) = |a^H b|^2 / (a^H a b^H b): 1 where shapes are alike but for a factor.
Share of a group of computed modes: |P a|^2 / |a|^2, P the projector on their shapes: 1 where a lies in their span, as a pair of close
modes of a disc may be turned.
SEREP (O'Callahan, Avitabile, Riemer 1989): shapes of all nodes X = X_a Y, Y the shapes at the sensors, hence a measured shape a is
expanded to X q with q = Y^+ a, and M reduced to the sensors is (Y^+)^H G Y^+, G = X^H M X.
Cross-orthogonality: |q_a^H G q_b| / (|q_a|_G |q_b|_G), in which q of a computed mode is a unit vector."""

import numpy
from scipy.optimize import linear_sum_assignment

CONDITION = 1e3  # largest, of the shapes at the sensors, with which they are told apart
NEVER = -1e3  # of a pair that must not be


def mac(a, b):
    """MAC of each column of a with each of b."""
    product = abs(a.conj().T @ b)**2
    return product / numpy.maximum(numpy.outer((abs(a)**2).sum(axis=0), (abs(b)**2).sum(axis=0)), 1e-300)


def collinearity(shapes):
    """Modal phase collinearity of each column: 1 where all points move in phase or against it, 0 of a travelling wave."""
    a, b, c = (shapes.real**2).sum(axis=0), (shapes.imag**2).sum(axis=0), (shapes.real * shapes.imag).sum(axis=0)
    return ((a - b)**2 + 4 * c**2) / numpy.maximum((a + b)**2, 1e-300)


def groups_of(freq, near):
    """For each computed mode those within `near` of its frequency, itself included."""
    return [numpy.flatnonzero(abs(freq - one) <= near * one) for one in freq]


def share(a, basis):
    """Part of |a|^2 in the span of the columns of a basis."""
    q, r = numpy.linalg.qr(basis)
    diagonal = abs(numpy.diag(r))
    q = q[:, diagonal > diagonal.max() / CONDITION]
    return float(numpy.linalg.norm(q.conj().T @ a)**2 / max(numpy.linalg.norm(a)**2, 1e-300))


def shares(measured, computed, groups):
    """Of each measured shape in the group of each computed mode. A group fills the space of few sensors, hence counts only where it has
    fewer modes than half the sensors."""
    small = [group if 2 * len(group) <= len(computed) else numpy.array([k]) for k, group in enumerate(groups)]
    return numpy.array([[share(a, computed[:, group]) for group in small] for a in measured.T])


def assign(shares_of, macs, measured_freq, freq, limits):
    """Pairs (measured, computed) with the largest sum of share and MAC less the relative difference of frequencies, among those whose
    frequencies differ by the first limit at most and whose share is the second at least. In a group the MAC decides."""
    near, least = limits
    apart = abs(freq[None, :] / numpy.maximum(measured_freq, 1e-300)[:, None] - 1)
    score = numpy.where((apart <= near) & (shares_of >= least), shares_of + macs - apart + 1, NEVER)
    rows, columns = linear_sum_assignment(numpy.hstack([score, numpy.zeros((len(score), len(score)))]), maximize=True)
    return [(i, k) for i, k in zip(rows, columns) if k < len(freq)]


class Serep:
    """Expansion by some computed modes: `chosen` of them, at most half as many as sensors, those nearest to the measured frequencies, so
    that a residual means something; fewer where the sensors do not tell them apart. gram: X^H M X of all modes."""

    def __init__(self, computed, freq, measured_freq, gram):
        nearest = numpy.argsort(abs(freq[:, None] - measured_freq[None, :]).min(axis=1), kind="stable")
        count = min(len(freq), max(len(computed) // 2, 1))
        while count > 1 and numpy.linalg.cond(scaled(computed[:, nearest[:count]])) > CONDITION:
            count -= 1
        self.chosen = numpy.sort(nearest[:count])
        self.shapes = computed[:, self.chosen]
        self.inverse = numpy.linalg.pinv(self.shapes)
        self.gram = gram[numpy.ix_(self.chosen, self.chosen)]
        self.condition = numpy.linalg.cond(scaled(self.shapes))

    def coordinates(self, measured):
        """q of each measured shape [modes][measured]."""
        return self.inverse @ measured

    def residual(self, measured):
        """|a - Y q| / |a| of each."""
        left = measured - self.shapes @ self.coordinates(measured)
        return numpy.linalg.norm(left, axis=0) / numpy.maximum(numpy.linalg.norm(measured, axis=0), 1e-300)

    def cross(self, measured):
        """Cross-orthogonality of each measured shape with each chosen mode."""
        q = self.coordinates(measured)
        size = numpy.sqrt(abs((q.conj() * (self.gram @ q)).sum(axis=0)))
        of_mode = numpy.sqrt(abs(numpy.diag(self.gram)))
        return abs(q.conj().T @ self.gram) / numpy.maximum(numpy.outer(size, of_mode), 1e-300)


def scaled(shapes):
    """Columns of length 1."""
    return shapes / numpy.maximum(numpy.linalg.norm(shapes, axis=0), 1e-300)


def cross_by_mass(measured, computed, mass):
    """Cross-orthogonality with a mass matrix at the sensors."""
    product = abs(measured.conj().T @ mass @ computed)
    sizes = [numpy.sqrt(abs((a.conj() * (mass @ a)).sum(axis=0))) for a in (measured, computed)]
    return product / numpy.maximum(numpy.outer(*sizes), 1e-300)
