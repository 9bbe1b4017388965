"""Sound of a closed surface by boundary elements: a check of Rayleigh's integral, for small meshes.

Flat triangles of constant pressure p and velocity v_n along the normal out of the body, e^{i omega t}, G = e^{-ikR} / (4 pi R). At the
middles of the triangles, and with 0 in place of p / 2 at points inside the body, which take out what has no one solution at the
frequencies of the air inside (Schenck's CHIEF, 1968), by least squares:

    p / 2 - int p dG/dn_y = -int G q,     q = dp/dn = -i omega rho v_n.

On the triangle itself int dG/dn_y is 0, and with R(t) its border seen from the middle int G = int (1 - e^{-ikR(t)}) / (4 pi i k) dt.
Others are by a rule of seven points, of those nearer than twice their size on sixteen parts of the triangle.
"""

import numpy

MOST = 4000  # triangles: 256 MB of a matrix
NEAR = 2  # sizes of a triangle
INNER = 24  # points inside
RULE = numpy.array([[1 / 3, 1 / 3, 0.225],
                    *[[a, b, 0.132394152788506] for a, b in ((0.059715871789770, 0.470142064105115), (0.470142064105115, 0.059715871789770),
                                                             (0.470142064105115, 0.470142064105115))],
                    *[[a, b, 0.125939180544827] for a, b in ((0.797426985353087, 0.101286507323456), (0.101286507323456, 0.797426985353087),
                                                             (0.101286507323456, 0.101286507323456))]])


class Surface:
    """Triangles of a closed surface: middles, normals, areas, sizes."""

    def __init__(self, corners):
        self.corners = numpy.asarray(corners, float)  # [n][3][3] m, anticlockwise seen from outside
        cross = numpy.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        self.area = numpy.linalg.norm(cross, axis=1) / 2
        self.normal = cross / (2 * self.area[:, None])
        self.middle = self.corners.mean(axis=1)
        self.size = numpy.sqrt(self.area)

    def points(self, parts=1):
        """Points and weights [n][m] of the rule on each of parts^2 pieces of every triangle."""
        bary, weight = [], []
        for i in range(parts):
            for j in range(parts - i):
                for up in ((0, 1), (1, -1)) if j < parts - i - 1 else ((0, 1),):
                    origin, sign = (i + up[0], j + up[0]), up[1]
                    bary += [((origin[0] + sign * a) / parts, (origin[1] + sign * b) / parts) for a, b, _ in RULE]
                    weight += list(RULE[:, 2] / parts**2)
        a, b = numpy.array(bary).T
        x = numpy.einsum("m,nd->nmd", 1 - a - b, self.corners[:, 0])
        x += numpy.einsum("m,nd->nmd", a, self.corners[:, 1]) + numpy.einsum("m,nd->nmd", b, self.corners[:, 2])
        return x, self.area[:, None] * numpy.array(weight)


def kernels(k, x, y, normal_y):
    """G and dG/dn_y from y to x."""
    r = x - y
    R = numpy.sqrt(numpy.einsum("...d,...d->...", r, r))
    g = numpy.exp(-1j * k * R) / (4 * numpy.pi * R)
    return g, g * (1j * k + 1 / R) * numpy.einsum("...d,...d->...", r, normal_y) / R


def own(surface, k):
    """int G of each triangle over itself, by Gauss's rule along its border."""
    t, w = numpy.polynomial.legendre.leggauss(12)
    total = 0
    for i in range(3):
        a, edge = surface.corners[:, i], surface.corners[:, (i + 1) % 3] - surface.corners[:, i]
        for s, weight in zip((t + 1) / 2, w / 2):
            r = a + s * edge - surface.middle
            R2 = numpy.einsum("nd,nd->n", r, r)
            turn = weight * numpy.linalg.norm(numpy.cross(r, edge), axis=1) / R2  # dt of the angle
            total = total + turn * (1 - numpy.exp(-1j * k * numpy.sqrt(R2))) / (4j * numpy.pi * k)
    return total


def inner_points(surface):
    """Points inside: below middles of triangles that are spread over the surface, at several depths."""
    chosen = numpy.linspace(0, len(surface.area) - 1, INNER).astype(int)
    depth = numpy.sqrt(surface.area.sum() / (4 * numpy.pi)) * numpy.linspace(0.2, 0.9, INNER)
    x = surface.middle[chosen] - depth[:, None] * surface.normal[chosen]
    y, weight = surface.points()
    angle = [-numpy.einsum("nm,nm->", kernels(0, place, y, surface.normal[:, None])[1].real, weight) for place in x]
    return x[numpy.abs(numpy.array(angle) - 1) < 0.1]  # the solid angle of a point inside is the whole one


def matrices(surface, k):
    """The left and right side: [n + inner][n] of p and of q."""
    n = len(surface.area)
    inside = inner_points(surface)
    left, right = numpy.empty((n + len(inside), n), complex), numpy.empty((n + len(inside), n), complex)
    coarse, fine = surface.points(), surface.points(4)
    for i, x in enumerate(numpy.concatenate([surface.middle, inside])):
        distance = numpy.linalg.norm(surface.middle - x, axis=1)
        near = distance < NEAR * surface.size
        near[i:i + 1] = False
        for chosen, (y, weight) in ((~near, coarse), (near, fine)):
            chosen[i:i + 1] = False
            g, slope = kernels(k, x, y[chosen], surface.normal[chosen][:, None])
            left[i, chosen], right[i, chosen] = (-numpy.einsum("nm,nm->n", value, weight[chosen]) for value in (slope, g))
    left[numpy.diag_indices(n)], right[numpy.diag_indices(n)] = 0.5, -own(surface, k)
    return left, right


def radiate(surface, velocity, omega, places, air):
    """Pressure at places [m][3] outside, Pa, and the power, W, of the velocity along the normal [n], m/s; air: density, speed."""
    density, speed = air
    k, q = omega / speed, -1j * omega * density * numpy.asarray(velocity, complex)
    left, right = matrices(surface, k)
    pressure = numpy.linalg.lstsq(left, right @ q, rcond=None)[0]
    y, weight = surface.points(2)
    heard = []
    for place in numpy.asarray(places, float):
        g, slope = kernels(k, place, y, surface.normal[:, None])
        heard.append(numpy.einsum("n,nm,nm->", pressure, slope, weight) - numpy.einsum("n,nm,nm->", q, g, weight))
    power = (pressure * numpy.conj(velocity)).real @ surface.area / 2
    return numpy.array(heard), power
