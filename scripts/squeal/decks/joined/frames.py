"""Matrices of a straight beam by Timoshenko's theory, 12 x 12 in the axes of space: displacements and rotations of its two ends.

Shapes are those of J. S. Przemieniecki and of Z. Friedman, J. B. Kosmatka, Computers and Structures 47 (1993) 473: exact for loads at
the ends, with phi = 12 E I / (k G A l^2), which is of second order in vibration; the mass is consistent with them, rotary inertia
included."""

import numpy

AT, WEIGHT = numpy.polynomial.legendre.leggauss(4)  # exact to degree 7: products of cubics have 6


def bending(length, rigidity, shear, mass, inertia):
    """Stiffness and mass [4][4] of w_1, theta_1, w_2, theta_2 in a plane, theta = dw/dx without shear. `rigidity` E I, `shear` k G A
    (infinite for none), `mass` and `inertia` per length."""
    phi = 12 * rigidity / (shear * length**2)
    K, M = numpy.zeros((4, 4)), numpy.zeros((4, 4))
    for at, weight in zip((AT + 1) / 2, WEIGHT * length / 2):
        w = numpy.array([2 * at**3 - 3 * at**2 - phi * at + 1 + phi, length * (at**3 - (2 + phi / 2) * at**2 + (1 + phi / 2) * at),
                         -2 * at**3 + 3 * at**2 + phi * at, length * (at**3 - (1 - phi / 2) * at**2 - phi / 2 * at)]) / (1 + phi)
        turn = numpy.array([6 * (at**2 - at) / length, 3 * at**2 - (4 + phi) * at + 1 + phi, 6 * (at - at**2) / length,
                            3 * at**2 - (2 - phi) * at]) / (1 + phi)
        curvature = numpy.array([6 * (2 * at - 1) / length, 6 * at - 4 - phi, 6 * (1 - 2 * at) / length, 6 * at - 2 + phi]) / (
            (1 + phi) * length)
        slope = numpy.array([6 * at**2 - 6 * at - phi, length * (3 * at**2 - (4 + phi) * at + 1 + phi / 2), -6 * at**2 + 6 * at + phi,
                             length * (3 * at**2 - (2 - phi) * at - phi / 2)]) / ((1 + phi) * length)
        sheared = slope - turn
        K += weight * rigidity * numpy.outer(curvature, curvature)
        if phi > 0:
            K += weight * shear * numpy.outer(sheared, sheared)
        M += weight * (mass * numpy.outer(w, w) + inertia * numpy.outer(turn, turn))
    return K, M


def rod(length, rigidity, mass):
    """Of two ends that move along the beam, or turn about it."""
    return rigidity / length * numpy.array([[1, -1], [-1, 1]]), mass * length / 6 * numpy.array([[2, 1], [1, 2]])


def axes_of(line, along):
    """Rows: along the beam, and axes 1 and 2 across it; None where the direction lies along the beam."""
    third = line / numpy.linalg.norm(line)
    first = along - third * (third @ along)
    if not numpy.linalg.norm(first) > 1e-9 * numpy.linalg.norm(along):
        return None
    first /= numpy.linalg.norm(first)
    return numpy.array([third, first, numpy.cross(third, first)])


def matrices(line, axes, material, profile):
    """K and M in space of a beam along `line`; material: E, G, density."""
    (young, shear, density), length = material, float(numpy.linalg.norm(line))
    K, M = numpy.zeros((12, 12)), numpy.zeros((12, 12))

    def add(rows, signs, own):
        for target, part in zip((K, M), own):
            target[numpy.ix_(rows, rows)] += part * numpy.outer(signs, signs)

    bend = (profile.bend_1, profile.bend_2)
    add([0, 6], [1, 1], rod(length, young * profile.area, density * profile.area))
    add([3, 9], [1, 1], rod(length, shear * profile.torsion, density * sum(bend)))
    for d, (moment, share) in enumerate(zip(bend, (profile.shear_1, profile.shear_2))):
        own = bending(length, young * moment, share * shear * profile.area, density * profile.area, density * moment)
        rows = [1, 5, 7, 11] if d == 0 else [2, 4, 8, 10]
        add(rows, [1, 1, 1, 1] if d == 0 else [1, -1, 1, -1], own)  # w along 2 turns by -dw/dx about 1
    T = numpy.kron(numpy.eye(4), axes)
    return T.T @ K @ T, T.T @ M @ T


def released(K, M, axes, pins):
    """K and M without force at ends' motions `pins`, numbers 0 to 11 along and about `axes`: they move as nothing holds them there."""
    T = numpy.kron(numpy.eye(4), axes)
    K, M = T @ K @ T.T, T @ M @ T.T
    kept = [d for d in range(12) if d not in pins]
    shape = numpy.zeros((12, 12))
    shape[kept, kept] = 1
    shape[numpy.ix_(pins, kept)] = -numpy.linalg.solve(K[numpy.ix_(pins, pins)], K[numpy.ix_(pins, kept)])
    return [T.T @ shape.T @ A @ shape @ T for A in (K, M)]


def carried(K, M, arms):
    """K and M of the nodes that rigid arms [2][3] join to the ends."""
    T = numpy.eye(12)
    for end, r in enumerate(arms):
        T[6 * end:6 * end + 3, 6 * end + 3:6 * end + 6] = -numpy.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    return T.T @ K @ T, T.T @ M @ T
