"""What a number tends to as the elements shrink: f(h) = f + c h^p, from its values on two meshes with p assumed, or on three
with p observed (Richardson, Phil. Trans. A 210, 1911; Roache, J. Fluids Eng. 116, 1994)."""

import math
from typing import NamedTuple

LEAST_ORDER, MOST_ORDER = 0.5, 16.0
NOISE = 3  # differences below so many errors of the algebra say nothing of the mesh


class Limit(NamedTuple):
    """What it tends to (nan: not known), error of the first mesh with its sign, the order that was used (nan: none), how."""
    value: float
    error: float
    order: float
    how: str


ORDERS = {"observed": "order observed on three meshes", "assumed": "order of the element, assumed",
          "no order": "not of an asymptotic order: largest difference of the meshes, not extrapolated",
          "algebra": "below the error of the algebra", "no partner": "not found again on a finer mesh"}
UNKNOWN = Limit(math.nan, math.nan, math.nan, "no partner")


def ratio(sizes, order):
    """Of the steps between three meshes, (f1 - f2) / (f2 - f3)."""
    first, second, third = (size**order for size in sizes)
    return (first - second) / (second - third)


def observed_order(sizes, values):
    """p of three meshes, nan where no p from LEAST_ORDER gives these values; MOST_ORDER at most."""
    first, second = values[0] - values[1], values[1] - values[2]
    if first * second <= 0 or ratio(sizes, LEAST_ORDER) > first / second:
        return math.nan
    low, high = LEAST_ORDER, MOST_ORDER
    if ratio(sizes, high) <= first / second:
        return high
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if ratio(sizes, middle) < first / second else (low, middle)
    return (low + high) / 2


def limit_of(sizes, values, order, noise, zero=False):
    """The Limit of values on meshes of these sizes of elements, the first the coarsest; order: of the element, which an observed
    one does not exceed in use; noise: error of the algebra; zero: a value that is none on one mesh and not on another, as growth
    of modes that lock in between them, has no order."""
    largest = max(values, key=lambda value: abs(value - values[0]))
    if abs(largest - values[0]) <= NOISE * noise:
        return Limit(values[-1], values[0] - values[-1], math.nan, "algebra")
    if zero and min(map(abs, values)) <= NOISE * noise:
        return Limit(math.nan, values[0] - largest, math.nan, "no order")
    how, used = "assumed", order
    if len(values) > 2:
        seen = observed_order(sizes[-3:], values[-3:])
        if math.isnan(seen):
            return Limit(math.nan, values[0] - largest, math.nan, "no order")
        how, used = "observed", min(seen, order)
        order = seen
    left = (values[-2] - values[-1]) / ((sizes[-2] / sizes[-1])**used - 1)
    value = values[-1] - left
    return Limit(value, values[0] - value, order, how)
