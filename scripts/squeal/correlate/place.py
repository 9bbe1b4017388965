"""Sensors on the mesh: the axes of the test are turned and moved into those of the mesh, then each sensor is put on the nearest point of
the surface, or on a node within a body where that is nearer. Its motion is that of the corners of the triangle there, weighted as the
point lies between them."""

import numpy
from scipy.spatial import cKDTree

from ..mesh.cells import triangles_of
from ..tables import BadInput

SAME = 1e-6  # of the largest extent: distances that are alike
FLAT = 1e-6  # least ratio of extents of points that fix a turn


def rotation(angles):
    """About x, then y, then z, degrees."""
    (cx, cy, cz), (sx, sy, sz) = numpy.cos(numpy.radians(angles)), numpy.sin(numpy.radians(angles))
    x = numpy.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    y = numpy.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return numpy.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ y @ x


def best_turn(test, mesh):
    """Turn and shift with the least sum of squares of mesh - (turn @ test + shift), by the singular values of their product (Kabsch), and
    the distances that are left."""
    a, b = test - test.mean(axis=0), mesh - mesh.mean(axis=0)
    sizes = numpy.linalg.svd(a, compute_uv=False)
    if len(test) < 3 or sizes[1] <= FLAT * sizes[0]:
        raise BadInput("--points: must be three or more points that are not on a line")
    left, _, right = numpy.linalg.svd(b.T @ a)
    turn = left @ numpy.diag([1, 1, numpy.sign(numpy.linalg.det(left @ right))]) @ right
    shift = mesh.mean(axis=0) - turn @ test.mean(axis=0)
    return turn, shift, numpy.linalg.norm(mesh - test @ turn.T - shift, axis=1)


def nearest_on(point, triangles):
    """Nearest point of each triangle [n][3][3]: its weights of the corners [n][3], and the distance."""
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    ap = point - a
    d11, d12, d22 = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    p1, p2 = (ap * ab).sum(1), (ap * ac).sum(1)
    size = numpy.maximum(d11 * d22 - d12**2, 1e-300)
    v, w = (d22 * p1 - d12 * p2) / size, (d11 * p2 - d12 * p1) / size
    best = numpy.stack([1 - v - w, v, w], axis=1)
    out = (best < 0).any(axis=1)
    distance = numpy.linalg.norm(ap - v[:, None] * ab - w[:, None] * ac, axis=1)
    distance[out] = numpy.inf
    for i, j in ((0, 1), (1, 2), (2, 0)):
        edge = triangles[:, j] - triangles[:, i]
        share = (((point - triangles[:, i]) * edge).sum(1) / numpy.maximum((edge * edge).sum(1), 1e-300)).clip(0, 1)
        apart = numpy.linalg.norm(point - triangles[:, i] - share[:, None] * edge, axis=1)
        nearer = out & (apart < distance)
        weights = numpy.zeros((len(triangles), 3))
        weights[:, i], weights[:, j] = 1 - share, share
        best[nearer], distance[nearer] = weights[nearer], apart[nearer]
    return best, distance


class Found:
    """A sensor on the mesh: corners and their weights, direction, part, distance (m), angle between the direction and the surface's normal
    (degrees), parts that are as near."""

    def __init__(self, channel, nodes, weights, place):
        self.channel, self.nodes, self.weights, self.place = channel, nodes, weights, place
        self.part, self.distance, self.angle, self.others = "", 0.0, 0.0, []

    def moves(self, shape):
        """Motion along its direction of a shape [nodes][3]."""
        return self.channel.direction @ (self.weights @ shape[self.nodes])


class Surface:
    """Triangles of the parts of a scene (mesh/bodies.py), places in m."""

    def __init__(self, scene, parts=()):
        absent = [name for name in parts if name not in scene.surfaces]
        if absent:
            raise BadInput(f"--parts {absent[0]}: no such part; there are {', '.join(scene.surfaces)}")
        chosen = {name: triangles_of(faces) for name, faces in scene.surfaces.items() if not parts or name in parts}
        self.names = list(chosen)
        self.triangles = numpy.concatenate(list(chosen.values()))
        self.part = numpy.repeat(numpy.arange(len(chosen)), [len(one) for one in chosen.values()])
        self.corners = scene.points[self.triangles]
        normal = numpy.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        size = numpy.linalg.norm(normal, axis=1)
        solid = size > 0
        self.triangles, self.part, self.corners = self.triangles[solid], self.part[solid], self.corners[solid]
        self.normal = normal[solid] / size[solid][:, None]
        middle = self.corners.mean(axis=1)
        self.reach = numpy.linalg.norm(self.corners - middle[:, None], axis=2).max()
        self.tree = cKDTree(middle)
        self.extent = numpy.ptp(self.corners.reshape(-1, 3), axis=0).max()
        self.points, self.nodes = scene.points, scene.nodes_of(parts)
        self.inside = cKDTree(self.points[self.nodes])
        self.last = (None, None, None)

    def nearest(self, place):
        """Triangles as near as any, their weights of the place, and the distance."""
        first = self.tree.query(place)[0]
        near = numpy.array(self.tree.query_ball_point(place, first + self.reach + SAME * self.extent))
        weights, distance = nearest_on(numpy.array(place), self.corners[near])
        alike = distance <= distance.min() + SAME * self.extent
        return near[alike], weights[alike], float(distance.min())

    def find(self, channel):
        """The nearest point; of several as near, on several parts or edges, that whose normal is most along the direction."""
        key = tuple(channel.place)
        if self.last[0] != key:  # the directions of a sensor follow one another
            self.last = key, self.nearest(key), self.inside.query(key)
        _, (near, weights, distance), (apart, node) = self.last
        if apart < distance - SAME * self.extent:
            return self.at_node(channel, self.nodes[node], float(apart))
        cosine = abs(self.normal[near] @ channel.direction)
        best = cosine.argmax()
        found = Found(channel, self.triangles[near[best]], weights[best], weights[best] @ self.corners[near[best]])
        found.part, found.distance = self.names[self.part[near[best]]], distance
        found.angle = float(numpy.degrees(numpy.arccos(min(cosine[best], 1.0))))
        found.others = sorted({self.names[i] for i in self.part[near]} - {found.part})
        return found

    def at_node(self, channel, node, distance):
        """A sensor at a node within a body."""
        found = Found(channel, numpy.array([node]), numpy.ones(1), self.points[node])
        found.part, found.distance, found.angle = "inside", distance, float("nan")
        return found

    def find_all(self, channels, tolerance):
        """All of them; one beyond the tolerance (m) is refused."""
        found = [self.find(channel) for channel in channels]
        far = max(found, key=lambda one: one.distance)
        if far.distance > tolerance:
            at, there = (", ".join(f"{1e3 * x:.4g}" for x in place) for place in (far.channel.place, far.place))
            raise BadInput(f"sensor {far.channel.name} at {at} mm is {1e3 * far.distance:.4g} mm from the mesh, whose nearest point "
                           f"is {there} mm on {far.part}; --tolerance is {1e3 * tolerance:.4g} mm: give --units, --transform or --points, "
                           "or a larger one")
        return found
