"""Labels (n,m+) of a disc's shape from what the nodes of some circles do, as the label of a mode is found: n nodal
circles, m nodal diameters, + for an antinode at the contact.

On each circle w(theta) = sum_m a_m cos(m theta) + b_m sin(m theta), theta from the contact. The nodal circles are the
sign changes of a harmonic from circle to circle; the family of harmonics with most energy decides. The nodal diameters
are half the antinodes of that family on the outer circle. Circles of less than half as many nodes as another are left
out.
"""

import numpy

MOST = 16  # harmonics
PER_WAVE = 3  # nodes to a wave at least
SMALL = 0.05  # of the largest: values without a sign
RIPPLE = 0.005  # of the largest: turns that do not count
ANGLES = 360


def harmonics(angle, values, n):
    """Coefficients [m][cosine, sine] of a circle by least squares."""
    orders = numpy.arange(n + 1)
    basis = numpy.hstack([numpy.cos(numpy.outer(angle, orders)), numpy.sin(numpy.outer(angle, orders[1:]))])
    found = numpy.linalg.lstsq(basis, values, rcond=None)[0]
    return numpy.array([found[:n + 1], numpy.concatenate([[0], found[n + 1:]])]).T


def nodal_circles(profile):
    """Sign changes of a harmonic, profile [circle][cosine, sine], along its principal direction."""
    parts = numpy.hstack([profile.real, profile.imag])
    principal = parts @ numpy.linalg.svd(parts, full_matrices=False)[2][0]
    clear = principal[abs(principal) >= SMALL * abs(principal).max()]
    return int((numpy.diff(numpy.sign(clear)) != 0).sum())


def diameters(rim, family):
    """Half the antinodes of the harmonics of a family around a circle, rim [m][cosine, sine]."""
    angle = numpy.linspace(0, 2 * numpy.pi, ANGLES, endpoint=False)
    wave = sum(rim[m, 0] * numpy.cos(m * angle) + rim[m, 1] * numpy.sin(m * angle) for m in family)
    shape = (wave * numpy.exp(-0.5j * numpy.angle((wave**2).sum()))).real
    ripple, extreme, direction, extrema = RIPPLE * abs(shape).max(), shape[0], 0, 0
    for turn, value in enumerate([*shape, *shape]):
        if direction * (value - extreme) > 0:
            extreme = value
        elif abs(value - extreme) > ripple:
            direction, extreme = (-1 if value < extreme else 1), value
            extrema += turn >= ANGLES
    return (extrema + 1) // 2


def name_shape(circles, from_contact):
    """Label of a shape from circles (radius, angles, values), and the harmonics of the outer one."""
    most = max(len(angle) for _, angle, _ in circles)
    circles = sorted([circle for circle in circles if 2 * len(circle[1]) > most], key=lambda circle: circle[0])
    n = min(MOST, min(len(angle) for _, angle, _ in circles) // PER_WAVE)
    found = numpy.array([harmonics(angle, values, n) for _, angle, values in circles])
    weights = numpy.array([radius for radius, _, _ in circles])[:, None] * numpy.where(numpy.arange(n + 1) == 0, 2, 1)
    energy = weights[:, :, None] * abs(found)**2
    family = numpy.array([nodal_circles(found[:, m]) for m in range(n + 1)])
    best = max(set(family), key=lambda k: energy[:, family == k].sum())
    own = numpy.flatnonzero(family == best)
    strongest = own[energy[:, own].sum(axis=(0, 2)).argmax()]
    count = diameters(found[-1], own) if strongest and from_contact else strongest
    even, odd = energy[:, own].sum(axis=(0, 1))
    return f"({best},{count}{'+' if from_contact and count and even > odd else ''})"
