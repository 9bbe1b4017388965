#!/usr/bin/env python3
"""Lowest frequency of a rod of 10 linear elements with consistent mass, clamped at one end, 100 mm, 7800 kg/m^3:

    omega h / c = sqrt(6 (1 - cos k h) / (2 + cos k h)),  k = pi / (2 L),  c = sqrt(modulus / density)

    verify/rod.py FOLDER MODULUS
    verify/rod.py FOLDER E_1,E_2,E_3 NU_12,NU_13,NU_23 I     the modulus is C_ii of the inverse of the compliance, I = 1 to 3
"""

import math
import sys

import numpy as np

from convergence import nearest, read_modes

LENGTH, ELEMENTS, DENSITY, TOLERANCE = 0.1, 10, 7800, 1e-9


def confined(young, poisson, i):
    """C_ii of the engineering constants."""
    young, poisson = (list(map(float, text.split(","))) for text in (young, poisson))
    s = np.diag([1 / e for e in young])
    for (a, b), nu in zip(((0, 1), (0, 2), (1, 2)), poisson):
        s[a, b] = s[b, a] = -nu / young[a]
    return np.linalg.inv(s)[int(i) - 1, int(i) - 1]


modulus = float(sys.argv[2]) if len(sys.argv) == 3 else confined(*sys.argv[2:])
h = LENGTH / ELEMENTS
kh = math.pi / (2 * LENGTH) * h
expected = math.sqrt(modulus / DENSITY) / h * math.sqrt(6 * (1 - math.cos(kh)) / (2 + math.cos(kh))) / (2 * math.pi)
found = nearest(read_modes(sys.argv[1]), expected)
print(f"modulus {modulus:.9g} Pa: {found:.12g} Hz, expected {expected:.12g}")
sys.exit(0 if abs(found / expected - 1) <= TOLERANCE else 1)
