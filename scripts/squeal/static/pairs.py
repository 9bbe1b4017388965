"""Pairs of a sliding state: static.csv in SI, places in the plane of the surface in contact, cells, rows, sums. Used by
plot/static and study/static. Lengths are in mm, along two axes in the plane of the pairs: where z is constant these
are x to the right and y up."""

import math

import numpy
from matplotlib.tri import Triangulation
from ..provenance import Units
from ..tables import BadInput, header, prefixed, read_table

STATUS = ("open", "stick", "slip")
COLUMNS = {"pair": int, "x_m": float, "y_m": float, "z_m": float, "lambda_n_n": float, "lambda_t_n": float}
OPTIONAL = {"interface": str, "gap_m": float, "slip_t_m": float, "area_m2": float, "pressure_pa": float,
            "lambda_b_n": float} | {f"{vector}_{axis}": float for vector in "tn" for axis in "xyz"}
UNITS = {"x_m": "m", "y_m": "m", "z_m": "m", "gap_m": "m", "slip_t_m": "m", "area_m2": "m2", "pressure_pa": "pa"}
MM = 1e3
SAME = 1e-6  # places within this part of the extent are one
MAX_ROWS, BINS = 60, 30  # of the profile: more rows than this are collected in bins, at most so many
NAMES = "xyz"


def status(text):
    """A status of a pair."""
    if text not in STATUS:
        raise ValueError(text)
    return text


def read_surfaces(path):
    """One Surface an interface, in their order in the table."""
    there = header(path)
    kinds = COLUMNS | {"status": status} | {name: kind for name, kind in OPTIONAL.items() if name in there}
    rows = read_table(path, kinds)
    if not rows:
        raise BadInput(f"{path}: has no rows; the model has no contact")
    units = Units(path.parent)
    for row in rows:
        row.update({name: units.factor(unit) * row[name] for name, unit in UNITS.items() if name in row})
    names = dict.fromkeys(row.get("interface", "") for row in rows)
    return [Surface(name, [row for row in rows if row.get("interface", "") == name]) for name in names]


class Surface:
    """The pairs of one interface, with their places in its plane."""

    def __init__(self, name, rows):
        self.name, self.number = name, [row["pair"] for row in rows]
        self.gap, self.slip = (numpy.array([row.get(key, math.nan) for row in rows]) for key in ("gap_m", "slip_t_m"))
        self.x = numpy.array([[row[f"{axis}_m"] for axis in NAMES] for row in rows])
        self.normal_force = numpy.array([row["lambda_n_n"] for row in rows])
        self.friction = numpy.array([math.hypot(row["lambda_t_n"], row.get("lambda_b_n", 0)) for row in rows])
        self.status = numpy.array([row["status"] for row in rows])
        self.sliding = self.sliding_of(rows)
        self.set_values(rows)
        self.set_plane()

    def sliding_of(self, rows):
        """Directions [pairs][3] in which the slave slides, that of its friction on the master, zero where there is none or the pair
        does not slip; None when not given. Friction is lambda_t t + lambda_b b, b = n x t."""
        if not all(f"{vector}_{axis}" in rows[0] for vector in "tn" for axis in NAMES):
            return None
        t, n = (numpy.array([[row[f"{vector}_{axis}"] for axis in NAMES] for row in rows]) for vector in "tn")
        along, across = (numpy.array([row.get(key, 0.0) for row in rows])[:, None] for key in ("lambda_t_n", "lambda_b_n"))
        friction = (along * t + across * numpy.cross(n, t)) * (self.status == "slip")[:, None]
        length = numpy.linalg.norm(friction, axis=1, keepdims=True)
        return numpy.divide(friction, length, out=numpy.zeros_like(friction), where=length > 0)

    def set_values(self, rows):
        """What is coloured: the pressure; the force per pair where pairs have no area, as along a line."""
        area, pressure = (numpy.array([row.get(name, math.nan) for row in rows]) for name in ("area_m2", "pressure_pa"))
        known = (area > 0).all() and numpy.isfinite(pressure).all()
        self.area = area if known else None
        value, unit, self.quantity = ((pressure, "Pa", "pressure") if known else
                                      (self.normal_force, "N", "normal force per pair"))
        self.factor, self.unit = prefixed(value.max(), unit)
        self.value = value * self.factor

    def set_plane(self):
        """Axes in the plane of the pairs: the first along x, or y where that is normal to it; the second turned from
        it by a right angle, towards +y or +z. Of the planes through a line of pairs it is the one most normal to z."""
        self.middle = numpy.average(self.x, axis=0, weights=self.area)
        _, size, axes = numpy.linalg.svd(self.x - self.x.mean(axis=0), full_matrices=True)
        size = numpy.append(size, numpy.zeros(3 - len(size)))
        flat = size <= SAME * max(size[0], 1e-300)
        flat[2] = True
        projections = [axes[flat].T @ (axes[flat] @ axis) for axis in numpy.eye(3)[::-1]]
        normal = next(p for p in projections if numpy.linalg.norm(p) > 1e-3)
        normal = normal / numpy.linalg.norm(normal)
        seed = numpy.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
        right = seed - (seed @ normal) * normal
        right /= numpy.linalg.norm(right)
        up = numpy.cross(normal, right)
        self.axes = numpy.array([right, up if up[1] + up[2] > 0 else -up])
        self.place = MM * self.x @ self.axes.T
        self.size = numpy.ptp(self.place, axis=0)

    def axis_title(self, i):
        """x, mm for an axis along x; else along the surface, mm."""
        along = numpy.flatnonzero(abs(self.axes[i]) > 1 - 1e-6)
        return f"{NAMES[along[0]]}, mm" if len(along) else "along the surface, mm"

    @property
    def closed(self):
        """Which pairs are."""
        return self.status != "open"

    @property
    def centre(self):
        """Of the normal forces, mm in the plane; None without force."""
        total = self.normal_force.sum()
        return self.normal_force @ self.place / total if total > 0 else None

    @property
    def direction(self):
        """Direction of sliding of the slave in the plane, None when there is none or it varies from pair to pair."""
        if self.sliding is None or not self.sliding.any():
            return None
        mean = self.sliding[self.sliding.any(axis=1)].mean(axis=0) @ self.axes.T
        length = numpy.linalg.norm(mean)
        return mean / length if length > 0.99 else None

    @property
    def profile_axis(self):
        """Axis of the plane nearest to the direction of sliding; the second one without."""
        return 1 if self.direction is None else int(numpy.argmax(abs(self.direction)))

    def arrow(self):
        """Tail and head of the arrow of sliding, left of the surface or below it; nothing without one direction."""
        if self.direction is None:
            return numpy.zeros((0, 2))
        aside = numpy.array([-self.direction[1], self.direction[0]])
        aside *= -numpy.sign(aside.sum()) or 1
        extent = self.size.max()
        place = self.centre_of_box + aside * (0.5 * abs(aside) @ self.size + 0.1 * extent)
        return place + 0.25 * extent * numpy.outer([-1, 1], self.direction)

    @property
    def centre_of_box(self):
        """Middle of the extent, mm in the plane."""
        return (self.place.min(axis=0) + self.place.max(axis=0)) / 2

    def limits(self):
        """Lower left and upper right corner of the map, mm."""
        shown = numpy.concatenate([self.place, self.arrow()])
        room = 0.06 * (self.size.max() or 1.0)
        return shown.min(axis=0) - room, shown.max(axis=0) + room

    def lead(self):
        """How far the centre of force lies ahead of the middle, mm along the direction of sliding; None without."""
        if self.direction is None or self.centre is None:
            return None
        return (self.centre - MM * self.middle @ self.axes.T) @ self.direction

    def summary(self):
        """The numbers, in one line."""
        most = self.value.max()
        parts = [f"{self.closed.sum()} of {len(self.closed)} pairs closed",
                 f"normal force {self.normal_force.sum():.4g} N"]
        if self.friction.any():
            parts.append(f"sum of the friction forces {self.friction.sum():.4g} N")
        parts.append(f"largest {self.quantity} {most:.3g} {self.unit}")
        lead = self.lead()
        if lead is not None:
            parts.append(f"centre of force {abs(lead):.2g} mm {'ahead' if lead >= 0 else 'behind'}")
        return ", ".join(parts)


def levels(values, extent):
    """Distinct places along an axis, ascending, and which one each value has."""
    order = numpy.argsort(values, kind="stable")
    ordered = values[order]
    begins = numpy.append(True, numpy.diff(ordered) > SAME * max(extent, 1e-300))
    number = numpy.empty(len(values), int)
    number[order] = numpy.cumsum(begins) - 1
    return ordered[begins], number


def limits_between(places, least):
    """Borders half way between places; the outermost are the places themselves, as of areas about nodes. A single
    place is `least` wide."""
    if len(places) == 1:
        return places[0] + least * numpy.array([-0.5, 0.5])
    return numpy.concatenate([places[:1], (places[1:] + places[:-1]) / 2, places[-1:]])


def grid_cells(surface):
    """Borders along both axes and values [up][right] when the pairs form a grid of rows and columns, else None."""
    extent = surface.size.max() or 1.0
    (x, i), (y, j) = (levels(surface.place[:, k], extent) for k in (0, 1))
    if len(x) * len(y) != len(i) or len(set(zip(i, j))) != len(i):
        return None
    values = numpy.ma.masked_all((len(y), len(x)))
    values[j[surface.closed], i[surface.closed]] = surface.value[surface.closed]
    least = 0.1 * extent
    return limits_between(x, least), limits_between(y, least), values


def triangles(surface):
    """Triangulation of the pairs, without triangles across holes and re-entrant corners."""
    mesh = Triangulation(*surface.place.T)
    corners = surface.place[mesh.triangles]
    longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
    mesh.set_mask(longest > 3 * numpy.median(longest))
    return mesh


def bins_of(surface, n_places):
    """Number of rows of equal width, or 0 where the pairs stand in rows themselves."""
    n_pairs = len(surface.status)
    scattered = 2 * n_places > n_pairs and min(surface.size) > SAME * max(surface.size)  # as on a turned or curved pad
    return min(BINS, math.isqrt(n_pairs)) if scattered else BINS if n_places > MAX_ROWS else 0


def profile(surface):
    """Along the axis of the profile: borders of the rows, mean value of each, closed pairs and all pairs of each."""
    along = surface.place[:, surface.profile_axis]
    extent = surface.size.max() or 1.0
    places, number = levels(along, extent)
    bins = bins_of(surface, len(places))
    if bins:
        borders = numpy.linspace(along.min(), along.max(), bins + 1)
        number = numpy.clip(numpy.searchsorted(borders, along, side="right") - 1, 0, bins - 1)
    else:
        borders = limits_between(places, 0.1 * extent)
    n = len(borders) - 1
    pairs = numpy.bincount(number, minlength=n)
    closed = numpy.bincount(number, weights=surface.closed, minlength=n).astype(int)
    force = numpy.bincount(number, weights=surface.normal_force, minlength=n)
    if surface.area is None:
        return borders, force, closed, pairs
    area = numpy.bincount(number, weights=surface.area, minlength=n)
    return borders, surface.factor * force / numpy.where(area > 0, area, math.inf), closed, pairs
