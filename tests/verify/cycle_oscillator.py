#!/usr/bin/python3
"""The limit cycle of tests/unit/test_cycle.c without steps: an oscillator of two modes whose friction couples them, and which lifts
off in each period. Between the events the motion is linear, and matrix exponentials are exact:

   eta'' + C eta' + Omega^2 eta = -P_n f + (P_n - mu P_t) lambda,   lambda = max(0, -P_n . eta / W)

Unknown are the state when contact begins and how long the contact and the flight last. The vector field is continuous at
the events, so that the monodromy matrix is the product of the two exponentials.

    cycle_oscillator.py           prints the onset and its period; then period, force when contact is deepest, multipliers for each mu
"""

import numpy
from scipy.linalg import expm
from scipy.optimize import brentq, root

SQUARES, DAMPING = numpy.array([1, 2.2]), 0.04  # Omega^2, C
NORMAL, TANGENT, STIFFNESS, LOAD = numpy.array([0.8, 0.6]), numpy.array([-0.6, 0.8]), 1.0, 1.0


def generator(mu, closed):
    """A of y' = A y, y = (eta, eta', 1)."""
    a = numpy.zeros((5, 5))
    a[:2, 2:4] = numpy.eye(2)
    a[2:4, :2] = -numpy.diag(SQUARES) - (STIFFNESS * numpy.outer(NORMAL - mu * TANGENT, NORMAL) if closed else 0)
    a[2:4, 2:4] = -DAMPING * numpy.eye(2)
    a[2:4, 4] = -LOAD * NORMAL
    return a


def settle(mu):
    """A state at the beginning of contact and the times, near the cycle."""
    step = 1e-3
    steps = [expm(step * generator(mu, closed)) for closed in (False, True)]
    y, marks = numpy.array([0.1, 0, 0, 0, 1]), []
    for i in range(1000000):
        before = NORMAL @ y[:2]
        y = steps[int(before < 0)] @ y
        if (before < 0) != (NORMAL @ y[:2] < 0):
            marks.append((i * step, before >= 0, y.copy()))
    marks = marks[-4:] if marks[-4][1] else marks[-5:-1]
    return marks[0][2][:4], marks[1][0] - marks[0][0], marks[2][0] - marks[1][0]


def cycle(mu):
    """Period, largest force, multipliers in descending order of modulus."""
    closed, flight = generator(mu, True), generator(mu, False)

    def miss(z):
        begin = numpy.append(z[:4], 1)
        lift = expm(z[4] * closed) @ begin
        end = expm(z[5] * flight) @ lift
        return numpy.concatenate([[NORMAL @ begin[:2], NORMAL @ lift[:2]], (end - begin)[:4]])

    state, contact, away = settle(mu)
    found = root(miss, numpy.concatenate([state, [contact, away]]), tol=1e-15)
    z = found.x
    assert abs(miss(z)).max() < 1e-13, (found, abs(miss(z)).max())
    begin = numpy.append(z[:4], 1)
    rate = lambda t: NORMAL @ (expm(t * closed) @ begin)[2:4]
    deepest = brentq(rate, 0.05 * z[4], 0.95 * z[4], xtol=1e-15)
    force = -STIFFNESS * NORMAL @ (expm(deepest * closed) @ begin)[:2]
    values = numpy.linalg.eigvals(expm(z[5] * flight)[:4, :4] @ expm(z[4] * closed)[:4, :4])
    return z[4] + z[5], force, values[numpy.argsort(-abs(values))]


def onset():
    """mu at which an eigenvalue of the closed oscillator is imaginary, and the period of that motion."""
    values = lambda mu: numpy.linalg.eigvals(generator(mu, True)[:4, :4])
    mu = brentq(lambda mu: values(mu).real.max(), 0.7, 0.9, xtol=1e-15)
    return mu, 2 * numpy.pi / abs(values(mu)[values(mu).real.argmax()].imag)


if __name__ == "__main__":
    print("onset", *(f"{value:.12g}" for value in onset()))
    for mu in (0.8, 1.0):
        period, force, values = cycle(mu)
        print(mu, f"{period:.14g} {force:.14g}", *(f"{value:.12g}" for value in values), f"{abs(values[1]):.12g}")
