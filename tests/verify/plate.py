#!/usr/bin/env python3
"""Annular plates against Kirchhoff's theory, and the order of convergence of a thick one.

    verify/plate.py limit --edge clamped --hole 0.3 THICK MEDIUM THIN      thickness 8, 4 and 2 mm
    verify/plate.py order COARSE MEDIUM FINE

THICK .. FINE are output folders of runs of options/plate.yaml or options/free_ring.yaml, radius a = 120 mm.

limit   Thickness h and size of the elements are halved together. The error of the mesh falls as h^2; a solid disc
        differs from Kirchhoff's plate by c1 h + c2 h^2, where c1 is the layer along the free edges that carries the
        twisting moment (K. O. Friedrichs and R. F. Dressler, Comm. Pure Appl. Math. 14, 1961; zero without nodal
        diameters). Fitting c1 and c2,

            f(0) = (8 f(h) - 6 f(2 h) + f(4 h)) / 3

        must agree with omega = lambda^2 sqrt(D / (rho h)) / a^2, D = E h^3 / (12 (1 - nu^2)); lambda^2 from the
        roots of the frequency equation in J_n, Y_n, I_n, K_n, nu = 0.3.
order   Only the elements' size in the plane is halved, the thickness stays: the differences fall as h^2.
"""

import argparse
import math
import sys

from convergence import Judge, limit_of_order_2, lowest, observed_order, read_modes

RADIUS, YOUNG, POISSON, DENSITY = 0.12, 210e9, 0.3, 7800  # m, Pa, -, kg/m^3
LABELS = {"clamped": ["(0,0)", "(0,1)", "(0,2)", "(0,3)", "(0,4)", "(0,5)"],
          "free": ["(1,0)", "(1,1)", "(0,2)", "(0,3)", "(0,4)", "(0,5)"]}  # below are rigid modes
LAMBDA_SQUARE = {("clamped", "0.3"): [6.6604, 6.5523, 7.9565, 13.2757, 22.0738, 33.5574],
                 ("clamped", "0.5"): [13.0243, 13.2898, 14.7038, 18.5620, 25.5958, 35.7301],
                 ("free", "0.3"): [8.3535, 18.2918, 4.9060, 12.2658, 21.7834, 33.4813],
                 ("free", "0.5"): [9.3135, 17.1982, 4.2711, 11.4254, 21.0672, 32.9815]}
THICKNESS = 0.008, 0.004, 0.002  # m
LIMIT = 1.5e-3     # of the extrapolated frequency
THIN = 1e-2         # of the thinnest plate computed, h/a = 1/60
ORDER = (1.8, 2.2)


def kirchhoff(lambda_square, thickness):
    """Frequency in Hz."""
    stiffness = YOUNG * thickness**3 / (12 * (1 - POISSON**2))
    return lambda_square / RADIUS**2 * math.sqrt(stiffness / (DENSITY * thickness)) / (2 * math.pi)


def check_limit(meshes, edge, hole, judge):
    print(f"{edge}, b/a = {hole}: mode, lambda^2, computed / theory at h = {THICKNESS} m and in the limit h = 0")
    for label, theory in zip(LABELS[edge], LAMBDA_SQUARE[edge, hole]):
        r = [lowest(modes, label) / kirchhoff(theory, h) for modes, h in zip(meshes, THICKNESS)]
        limit = (8 * r[2] - 6 * r[1] + r[0]) / 3
        verdict = judge.within(limit, 1 - LIMIT, 1 + LIMIT) + judge.within(r[2], 1 - THIN, 1 + THIN)
        print(f"  {label}  {theory:8.4f}   {r[0]:.5f}  {r[1]:.5f}  {r[2]:.5f}   {limit:.5f}{verdict}")


def check_order(meshes, judge):
    print("mode, Hz on three meshes and in the limit of order 2, order observed")
    for label in LABELS["clamped"]:
        f = [lowest(modes, label) for modes in meshes]
        order = observed_order(*f)
        print(f"  {label}  {f[0]:.3f}  {f[1]:.3f}  {f[2]:.3f}   {limit_of_order_2(*f[1:]):.3f}   {order:.2f}"
              + judge.within(order, *ORDER))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("check", choices=["limit", "order"])
    parser.add_argument("--edge", choices=LABELS, default="clamped", help="the inner edge")
    parser.add_argument("--hole", choices=["0.3", "0.5"], default="0.5", help="inner radius over outer radius")
    parser.add_argument("folders", nargs=3)
    arguments = parser.parse_args()
    meshes, judge = [read_modes(folder) for folder in arguments.folders], Judge()
    if arguments.check == "limit":
        check_limit(meshes, arguments.edge, arguments.hole, judge)
    else:
        check_order(meshes, judge)
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
