#!/usr/bin/env python3
"""Contact forces in static.csv and reactions.csv against what statics alone demands.

    verify/static.py press FOLDER FORCE AXES        pressed by FORCE (N): sum of lambda_n, forces alike where x or y or
                                                    both (AXES) change sign, balance of all reactions
    verify/static.py lean FOLDER FORCE RATIO OPEN   friction RATIO FORCE along y, balanced at the height 0.1 m, moves
                                                    the resultant of lambda_n by RATIO times the height above the slave
                                                    nodes that it acts on; whether part is "open", or all "closed"
    verify/static.py bed FOLDER FORCE MU            forces of a rigid block of height 0.1 m on equal springs that only
                                                    push
    verify/static.py stiffer LIMIT K1 K2 K3         penalty forces of three folders, k_n a thousandfold each time, tend
                                                    to those of the constraint
    verify/static.py friction FOLDER MU FY STICK [TOLERANCE]
                                                    sum of the friction on the slave along -y (N), 0 along x; the cone
                                                    of every pair; which pairs stick: "all", "some" or "none"
    verify/static.py column FOLDER FORCE AREA       even pressure
    verify/static.py under FOLDER FORCE X OFF       the resultant of lambda_n acts at X (m), by at most OFF off
"""

import csv
import sys
from pathlib import Path

import numpy as np

from convergence import Judge

NUMBERS = ("x_m", "y_m", "z_m", "lambda_n_n", "lambda_t_n", "lambda_b_n", "area_m2", "t_x", "t_y")
SUM, PLACE, ALIKE = 1e-10, 1e-8, 1e-9  # relative: of forces, of a resultant to 0.1 m, of forces that are symmetric
WIDTH = HEIGHT = 0.1  # m


class Pairs:
    """Columns of static.csv; friction as x and y of the force on the slave (the contact's normal is z)."""

    def __init__(self, folder):
        with (Path(folder) / "static.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.status = np.array([row["status"] for row in rows])
        columns = (np.array([float(row[name]) for row in rows]) for name in NUMBERS)
        self.x, self.y, self.z, self.force, t, b, self.area, tx, ty = columns
        self.friction = -np.array([t * tx - b * ty, t * ty + b * tx])


def line(judge, what, value, low, high):
    print(f"{what:55s} {value:.12g}{judge.within(value, low, high)}")


def reactions(folder):
    """Sum of all rows but those of the contact, which is between bodies."""
    with (Path(folder) / "reactions.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] != "contact on master"]
    return sum(np.array([float(row[f"force_{d}_n"]) for d in "xyz"]) for row in rows)


def mirrored(pairs, sign_x, sign_y):
    """Forces of the pairs at (sign_x x, sign_y y)."""
    place = np.round(np.array([pairs.x, pairs.y]) / 1e-7)
    other = place * np.array([[sign_x], [sign_y]])
    order = [int(np.argmin(abs(place[0] - x) + abs(place[1] - y))) for x, y in other.T]
    assert sorted(order) == list(range(len(order))), "the pairs are not symmetric"
    return pairs.force[order]


def press(judge, folder, force, axes):
    pairs, force = Pairs(folder), float(force)
    line(judge, "sum of lambda_n / load - 1", pairs.force.sum() / force - 1, -SUM, SUM)
    line(judge, "sum of reactions and loads / load", np.abs(reactions(folder)).max() / force, 0, SUM)
    for axis in axes:
        other = mirrored(pairs, -1 if axis == "x" else 1, -1 if axis == "y" else 1)
        apart = np.ptp([pairs.force, other], 0).max() / pairs.force.max()
        line(judge, f"lambda_n unlike its mirror image in {axis}", apart, 0, ALIKE)
    line(judge, "largest over mean lambda_n: not even", pairs.force.max() / pairs.force.mean(), 1.01, 1e3)


def lean(judge, folder, force, ratio, status):
    pairs, total = Pairs(folder), float(force)
    y = float(ratio) * (HEIGHT - pairs.z @ pairs.force / total)
    for name, at, expected in (("x", pairs.x, 0), ("y", pairs.y, y)):
        line(judge, f"resultant of lambda_n, {name}, from where it should be / 0.1 m",
             (at @ pairs.force / total - expected) / WIDTH, -PLACE, PLACE)
    line(judge, "sum of lambda_n / load - 1", pairs.force.sum() / total - 1, -SUM, SUM)
    n_open = np.sum(pairs.status == "open")
    line(judge, "open pairs", n_open, *((1, len(pairs.status) - 1) if status == "open" else (0, 0)))
    line(judge, "sum of reactions and loads / load", np.abs(reactions(folder)).max() / total, 0, SUM)


def bed(judge, folder, force, mu):
    """lambda_n = max(0, a + b y) at every pair, sum F, moment mu F h: Newton's method from all pairs closed."""
    pairs, force, mu = Pairs(folder), float(force), float(mu)
    shape = np.array([np.ones_like(pairs.y), pairs.y])
    wanted = force * np.array([1, mu * HEIGHT])
    ab = np.linalg.solve(shape @ shape.T, wanted)
    for _ in range(50):
        closed = ab @ shape > 0
        ab = np.linalg.solve(shape[:, closed] @ shape[:, closed].T, wanted)
    exact = np.maximum(0, ab @ shape)
    apart = np.abs(pairs.force - exact).max() / exact.max()
    line(judge, "lambda_n unlike those of a bed of springs / largest", apart, 0, 1e-6)
    line(judge, "open pairs, less those of the bed", np.sum(pairs.status == "open") - np.sum(exact == 0), 0, 0)


def stiffer(judge, limit, *folders):
    exact = Pairs(limit).force
    errors = [np.abs(Pairs(folder).force - exact).max() / exact.max() for folder in folders]
    print("distances from the constraint / largest lambda_n: " + ", ".join(f"{error:.3e}" for error in errors))
    line(judge, "the softest is not there yet", errors[0], 1e-3, 1)
    line(judge, "distance falls as 1 / k_n, by a thousand", errors[1] / errors[2], 990, 1010)


def friction(judge, folder, mu, along, stick, tolerance=SUM):
    pairs, mu, along, tolerance = Pairs(folder), float(mu), float(along), float(tolerance)
    total, size = pairs.friction.sum(1), np.hypot(*pairs.friction)
    slipping, sticking = pairs.status == "slip", pairs.status == "stick"
    scale = pairs.force.max()
    line(judge, "friction on the slave along y, error / N", (total[1] + along) / pairs.force.sum(), -tolerance,
         tolerance)
    line(judge, "friction on the slave along x / N", total[0] / pairs.force.sum(), -SUM, SUM)
    line(judge, "friction beyond mu lambda_n / largest lambda_n", (size - mu * pairs.force).max() / scale, -1, SUM)
    if slipping.any():
        off = np.abs(size - mu * pairs.force)[slipping].max() / scale
        line(judge, "friction of slipping pairs off mu lambda_n / largest", off, 0, SUM)
    bounds = {"all": (len(size), len(size)), "some": (1, len(size) - 1), "none": (0, 0)}[stick]
    line(judge, "sticking pairs", sticking.sum(), *bounds)
    image = np.abs(np.ptp([pairs.force, mirrored(pairs, -1, 1)], 0)).max() / scale
    line(judge, "lambda_n unlike its mirror image in x", image, 0, ALIKE)


def column(judge, folder, force, area):
    pairs, force, area = Pairs(folder), float(force), float(area)
    line(judge, "sum of lambda_n / exact - 1", pairs.force.sum() / force - 1, -1e-9, 1e-9)
    line(judge, "pressure unlike the even one", np.abs(pairs.force / pairs.area * area / force - 1).max(), 0, 1e-9)


def under(judge, folder, force, x, off):
    pairs, off = Pairs(folder), float(off)
    line(judge, "resultant of lambda_n, x, from where it should be / m", (pairs.x - float(x)) @ pairs.force / float(force),
         -off, off)


CHECKS = {check.__name__: check for check in (press, lean, bed, stiffer, friction, column, under)}


def main(what, *arguments):
    judge = Judge()
    CHECKS[what](judge, *arguments)
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
