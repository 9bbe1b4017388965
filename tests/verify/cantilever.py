#!/usr/bin/env python3
"""Bending frequencies of options/cantilever.yaml on three meshes against Timoshenko's beam, and their order.

    verify/cantilever.py COARSE MEDIUM FINE [E,G_xy,G_xz]   output folders, length of the elements halved from one to the
                                                            next; moduli of an orthotropic bar, Pa

With w the deflection, phi the rotation of the section, M the moment, V the shear force and frequency omega,

    w' = phi + V / (kappa G A),   phi' = M / (E I),   M' = -V - rho I omega^2 phi,   V' = -rho A omega^2 w,

w = phi = 0 at the clamped end and M = V = 0 at the free one; kappa = 5/6 for a rectangle without Poisson's effect
(G. R. Cowper, J. Appl. Mech. 33, 1966). Trilinear and incompatible elements have an error of order h^2.
"""

import math
import sys

import numpy as np

from convergence import Judge, limit_of_order_2, nearest, observed_order, read_modes

DENSITY, LENGTH, WIDTH, HEIGHT = 7800, 0.1, 0.01, 0.005  # kg/m^3, m
STEEL = "210e9,105e9,105e9"  # Poisson's ratio 0
ORDER = (1.9, 2.1)
LIMIT = 1.5e-3  # of the extrapolated frequency beside Timoshenko's: what 4 or 8 elements over the section leave


def free_end_determinant(omega, depth, young, shear):
    """Zero at a frequency of the beam that bends across `depth`; per unit of its other dimension."""
    area, inertia = depth, depth**3 / 12
    a = np.zeros((4, 4))
    a[0, 1], a[0, 3] = 1, 1 / (5 / 6 * shear * area)
    a[1, 2] = 1 / (young * inertia)
    a[2, 1], a[2, 3] = -DENSITY * inertia * omega**2, -1
    a[3, 0] = -DENSITY * area * omega**2
    values, vectors = np.linalg.eig(a)
    transfer = vectors @ np.diag(np.exp(values * LENGTH)) @ np.linalg.inv(vectors)
    return np.linalg.det(transfer[2:, 2:]).real


def timoshenko(depth, young, shear, highest):
    """Frequencies up to `highest`, Hz: sign changes of the determinant, then bisection."""
    grid, found = np.arange(10, highest, 10), []
    values = [free_end_determinant(2 * math.pi * f, depth, young, shear) for f in grid]
    for low, high, at_low, at_high in zip(grid, grid[1:], values, values[1:]):
        if at_low * at_high > 0:
            continue
        for _ in range(50):
            middle = (low + high) / 2
            if free_end_determinant(2 * math.pi * middle, depth, young, shear) * at_low > 0:
                low = middle
            else:
                high = middle
        found.append(low)
    return found


def main(folders, moduli=STEEL):
    meshes, judge = [read_modes(folder) for folder in folders], Judge()
    young, shear_y, shear_z = map(float, moduli.split(","))
    print("bends across     theory Hz   computed / theory             order   limit / theory")
    for depth, shear in ((HEIGHT, shear_z), (WIDTH, shear_y)):
        for theory in timoshenko(depth, young, shear, 8000):
            f = [nearest(modes, theory) for modes in meshes]
            order, limit = observed_order(*f), limit_of_order_2(*f[1:]) / theory
            ratios = "  ".join(f"{value / theory:.5f}" for value in f)
            verdict = judge.within(order, *ORDER) + judge.within(limit, 1 - LIMIT, 1 + LIMIT)
            print(f"{1e3 * depth:9.0f} mm  {theory:12.3f}   {ratios}  {order:6.2f}   {limit:.5f}{verdict}")
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(sys.argv[1:4], *sys.argv[4:]) else 0)
