#!/usr/bin/env python3
"""What balance demands of static.csv for a block between a floor that slides and a ceiling that holds it by friction.

    verify/two_contacts.py FOLDER N MU_FLOOR MU_CEILING HEIGHT     (N, m)

lower  the contact with the floor: friction on the block mu N along -y, mu lambda_n at every pair
upper  the contact with the ceiling, under Coulomb's law: friction on the block mu N of the lower one along y, at most
       mu lambda_n at every pair, and that where it slips
both   sum of lambda_n = N; moments about x: the resultants are mu HEIGHT apart along y
"""

import csv
import sys
from pathlib import Path

import numpy as np

from convergence import Judge

SMALL = 1e-10  # of N, and of the height


class Side:
    """Pairs of one contact; friction as x and y of the force on the slave, the block. The normal is up or down (-1)."""

    def __init__(self, rows, name, up):
        rows = [row for row in rows if row["interface"] == name]
        self.y, self.force, along, across, tx, ty = (
            np.array([float(row[key]) for row in rows])
            for key in ("y_m", "lambda_n_n", "lambda_t_n", "lambda_b_n", "t_x", "t_y"))
        self.status = np.array([row["status"] for row in rows])
        self.friction = -np.array([along * tx - up * across * ty, along * ty + up * across * tx])


def main(folder, normal, mu_floor, mu_ceiling, height):
    judge = Judge()
    normal, mu_floor, mu_ceiling, height = map(float, (normal, mu_floor, mu_ceiling, height))
    with (Path(folder) / "static.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    lower, upper = Side(rows, "lower", 1), Side(rows, "upper", -1)

    def line(what, value):
        print(f"{what:55s} {value:.12g}{judge.within(value, -SMALL, SMALL)}")

    for name, side, sign in (("lower", lower, -1), ("upper", upper, 1)):
        line(f"{name}: sum of lambda_n / N - 1", side.force.sum() / normal - 1)
        line(f"{name}: friction along y, error / N", side.friction[1].sum() / normal - sign * mu_floor)
        line(f"{name}: friction along x / N", side.friction[0].sum() / normal)
    line("lower: friction of a pair off mu lambda_n / N",
         np.abs(lower.friction[1] + mu_floor * lower.force).max() / normal)
    room = (mu_ceiling * upper.force - np.hypot(*upper.friction)) / normal
    line("upper: friction of a pair beyond mu lambda_n / N", max(0, -room.min()))
    if (upper.status == "slip").any():
        line("upper: friction of slipping pairs off mu lambda_n / N", np.abs(room[upper.status == "slip"]).max())
    shift = (lower.y @ lower.force - upper.y @ upper.force) / normal
    line("resultants apart along y, error / height", shift / height - mu_floor)
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
