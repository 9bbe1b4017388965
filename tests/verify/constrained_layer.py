#!/usr/bin/env python3
"""Modes of a simply supported beam or plate with a constrained layer against D. Ross, E. E. Ungar, E. M. Kerwin (Structural
Damping, ASME, 1959).

    constrained_layer.py MODES.csv --length 0.3 --thickness 2e-3,2e-4,5e-4 --young 210e9,20e6,210e9 --density 7800,1200,7800 \\
                         --loss 0.5 --modes 4
    constrained_layer.py ... --width 0.2 --modes 1,1 3,1 1,3

Layers 1 base, 2 viscoelastic with a loss factor at every frequency, 3 cover, all without Poisson's effect. Mode n has the wave number
p = n pi / L, mode (m, n) of a plate p^2 = (m pi / L)^2 + (n pi / width)^2 (the displacements along its layers are gradients), the
bending stiffness of their formula with complex E_2 and G_2 = E_2 / 2, and lambda^2 = - EI p^4 / (mass per length). Prints the largest
relative differences of omega and of the modal loss factor Im lambda^2 / Re lambda^2. Exit status 0 up to --tolerance, or 1."""

import argparse
import cmath
import csv
import math
import sys


def stiffness(young, h, p):
    """EI per width."""
    e1, e2, e3 = young
    h1, h2, h3 = h
    g = e2 / 2 / (e3 * h3 * h2 * p**2)
    h31, h21 = (h1 + h3) / 2 + h2, (h1 + h2) / 2
    d = (e2 * h2 * (h21 - h31 / 2) + g * (e2 * h2 * h21 + e3 * h3 * h31)) / (e1 * h1 + e2 * h2 / 2 + g * (e1 * h1 + e2 * h2 + e3 * h3))
    return (e1 * h1**3 / 12 + e2 * h2**3 / 12 + e3 * h3**3 / 12 - e2 * h2**2 / 12 * (h31 - d) / (1 + g) + e1 * h1 * d**2
            + e2 * h2 * (h21 - d)**2 + e3 * h3 * (h31 - d)**2
            - (e2 * h2 / 2 * (h21 - d) + e3 * h3 * (h31 - d)) * (h31 - d) / (1 + g))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table")
    for name in ("length", "loss"):
        parser.add_argument(f"--{name}", type=float, required=True)
    for name in ("thickness", "young", "density"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--width", type=float, help="of a plate")
    parser.add_argument("--modes", nargs="+", default=["4"], help="how many of a beam; pairs of half waves of a plate")
    parser.add_argument("--tolerance", type=float, default=0.01)
    args = parser.parse_args()
    h, young, density = ([float(word) for word in text.split(",")] for text in (args.thickness, args.young, args.density))
    with open(args.table, newline="") as lines:
        found = [complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in csv.DictReader(lines)]
    mass, worst = sum(r * t for r, t in zip(density, h)), [0, 0]
    waves = [[int(word) for word in text.split(",")] for text in args.modes]
    for name in waves if args.width else range(1, waves[0][0] + 1):
        p = math.pi * (math.hypot(name[0] / args.length, name[1] / args.width) if args.width else name / args.length)
        value = cmath.sqrt(-stiffness((young[0], young[1] * (1 + 1j * args.loss), young[2]), h, p) * p**4 / mass)
        value = value if value.imag > 0 else -value
        mode = min(found, key=lambda other: abs(other - value))
        loss = [(v**2).imag / (v**2).real for v in (mode, value)]
        hertz = [v.imag / 2 / math.pi for v in (mode, value)]
        print(f"mode {name}: {hertz[0]:.5g} Hz and loss factor {loss[0]:.5g}, by the formula {hertz[1]:.5g} Hz and {loss[1]:.5g}")
        worst = [max(worst[0], abs(mode.imag / value.imag - 1)), max(worst[1], abs(loss[0] / loss[1] - 1))]
    print(f"largest relative differences {worst[0]:.3g} and {worst[1]:.3g}, allowed {args.tolerance:g}")
    return 0 if max(worst) <= args.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
