#!/usr/bin/env python3
"""Writes static.csv of a made-up sliding state: a square pad whose pressure rises linearly along the sliding direction
and which is open where the line is below zero, as of a rigid block on a bed of springs under a tilting moment.

Pairs form a grid of n x n nodes with their tributary areas; the pressure at the place s along the sliding direction,
-1 to 1, is proportional to max(0, 1 + tilt s). The total normal force is FORCE.

usage: made_up_static.py FOLDER [tilt]
"""

import csv
import sys
from pathlib import Path

import numpy

FORCE, MU, SIDE, N = 100.0, 0.5, 0.04, 11  # N, -, m, -
HEADER = ("pair,x_m,y_m,z_m,gap_m,lambda_n_n,lambda_t_n,status,interface,area_m2,pressure_pa,lambda_b_n,t_x,t_y,t_z,n_x,n_y,n_z")


class State:
    """Pairs of a pad in a plane spanned by `across` and `along`; it slides along `along`."""

    def __init__(self, n=N, tilt=1.6, mu=MU, middle=(0.11, 0, 0), across=(1, 0, 0), along=(0, 1, 0), stuck=0):
        s = numpy.linspace(-1, 1, n)
        across, along = numpy.asarray(across, float), numpy.asarray(along, float)
        half = SIDE / 2
        self.x = numpy.array([middle + half * a * across + half * b * along for b in s for a in s])
        width = numpy.full(n, SIDE / (n - 1))
        width[[0, -1]] /= 2
        self.area = numpy.outer(width, width).ravel()
        self.pressure = numpy.maximum(0, 1 + tilt * numpy.repeat(s, n))
        self.pressure *= FORCE / (self.pressure @ self.area)
        self.normal = self.pressure * self.area
        self.status = numpy.where(self.normal > 0, "slip", "open").astype(object)
        self.status[numpy.flatnonzero(self.normal > 0)[-1:-1 - stuck:-1]] = "stick"
        self.gap = 1e-6 * numpy.maximum(0, -1 - tilt * numpy.repeat(s, n))
        self.mu, self.along, self.normal_vector = mu, along, numpy.cross(across, along)
        self.turn = 0.0

    def rows(self, interface="contact", first=0):
        """Records of the table, whose friction is turned from `along` by an angle (rad) about the normal."""
        along, aside = numpy.cos(self.turn), numpy.sin(self.turn)
        return [(first + i, *x, self.gap[i], self.normal[i], self.mu * self.normal[i] * along, self.status[i], interface,
                 self.area[i], self.pressure[i], self.mu * self.normal[i] * aside, *self.along, *self.normal_vector)
                for i, x in enumerate(self.x)]


def write_rows(folder, rows, columns=None):
    """static.csv of records, with the first `columns` of them (None: all)."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "static.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows(row[:columns] for row in [HEADER.split(","), *rows])


if __name__ == "__main__":
    write_rows(Path(sys.argv[1]), State(tilt=float(sys.argv[2]) if len(sys.argv) > 2 else 1.6).rows())
