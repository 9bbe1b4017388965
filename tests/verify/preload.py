#!/usr/bin/env python3
"""Frequencies of two rigid cubes, one on the other, under a load, against their exact equations of motion.

    verify/preload.py FOLDER:LOAD:MU ...      output folders of tests/cases/preload.toml, load (N), friction coefficient

The table stands on springs and carries the block, which springs hold sideways. A cube turned by theta (a vector) and
shifted by X has its points at X + R(theta) x; nothing is linear but the springs:

    normal force   k_n (-g),  g = n . (x_slave - x_master),  n = R e_z of the table; on the table where the slave is
    friction       mu times it, along the projection of e_y on the plane across n; on the table where it was at rest
    loads          LOAD (-e_z) on the block's top, and MU LOAD e_y at the contact, on the block along e_y, on the table
                   against: they balance friction, so that the cubes neither turn nor shift sideways at rest

Equilibrium by Newton's method, then the eigenvalues of the derivative of the forces.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

from convergence import Judge

SIZE, MASS = 0.1, 1.0  # m, kg
LEGS, SIDES = np.array([2e6, 2.5e6, 5e6]), np.array([1e6, 1.5e6, 0])  # N/m per corner: table's bottom, all of the block
CONTACT = 1e9  # N/m per pair
LIMIT = 3e-6   # of a frequency: what the elasticity of the cubes leaves
CORNERS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) * SIZE / 2
BOTTOM, TOP = CORNERS[:4], CORNERS[4:]
STEP = 1e-20


def rotation(theta):
    """exp of the matrix of theta x, to the fourth power."""
    x, y, z = theta
    spin = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + spin @ (np.eye(3) + spin @ (np.eye(3) / 2 + spin @ (np.eye(3) / 6 + spin / 24)))


def derivative(function, q):
    """Of a real function of 12 variables, by complex steps."""
    return np.array([function(q + STEP * 1j * e).imag / STEP for e in np.eye(12)])


def places(q, body, points):
    """Points of the table (0) or the block (1), from the centre of the cube at rest."""
    q = q[6 * body:6 * body + 6]
    return q[:3] + points @ rotation(q[3:]).T


def gaps(q):
    normal = rotation(q[3:6])[:, 2]
    return (places(q, 1, BOTTOM) + [0, 0, SIZE] - places(q, 0, TOP)) @ normal


def potential(q, load, mu):
    stretch = (places(q, 0, BOTTOM) - BOTTOM)**2 @ LEGS, (places(q, 1, CORNERS) - CORNERS)**2 @ SIDES
    apart = np.mean(places(q, 1, BOTTOM)[:, 1] - places(q, 0, TOP)[:, 1])
    return ((sum(map(np.sum, stretch)) + CONTACT * np.sum(gaps(q)**2)) / 2
            + load * (np.mean(places(q, 1, TOP)[:, 2]) - mu * apart))


def residual(q, load, mu):
    """Internal less external forces."""
    normal = rotation(q[3:6])[:, 2]
    along = np.array([0, 1, 0]) - normal[1] * normal
    friction = mu * CONTACT * np.outer(-gaps(q), along / np.linalg.norm(along))  # on the table
    slid = derivative(lambda p: np.sum(friction * (places(p, 0, TOP) - places(p, 1, BOTTOM))), q)
    return derivative(lambda p: potential(p, load, mu), q) - slid


def stiffness(q, load, mu):
    """Derivative of the residual, by central differences."""
    step = 1e-6 * np.eye(12)
    return np.array([(residual(q + e, load, mu) - residual(q - e, load, mu)) / 2e-6 for e in step]).T


def eigenvalues(load, mu):
    """sigma + i omega of the motions about equilibrium, 1/s, omega > 0."""
    q = np.zeros(12)
    for _ in range(8):
        q -= np.linalg.solve(stiffness(q, load, mu), residual(q, load, mu))
    mass = np.tile([MASS] * 3 + [MASS * SIZE**2 / 6] * 3, 2)
    squares = np.linalg.eigvals(stiffness(q, load, mu) / mass[:, None]).astype(complex)  # - (sigma + i omega)^2
    return 1j * np.sqrt(squares)


def main(arguments):
    judge = Judge()
    for folder, load, mu in (argument.split(":") for argument in arguments):
        exact = eigenvalues(float(load), float(mu))
        print(f"load {load} N, mu {mu}\n   growth 1/s  frequency Hz  distance from exact, relative")
        with (Path(folder) / "modes.csv").open(newline="") as file:
            for row in csv.DictReader(file):
                value = float(row["growth_rad_s"]) + 2j * math.pi * float(row["freq_hz"])
                error = np.min(abs(exact - value)) / abs(value)
                fault = judge.within(error, 0, LIMIT)
                print(f"{value.real:13.4f} {value.imag / (2 * math.pi):13.4f}  {error:.1e}{fault}")
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(sys.argv[1:]) else 0)
