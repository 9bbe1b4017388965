#!/usr/bin/env python3
"""A rigid block that falls on a pressure law, against the oscillator with one degree of freedom.

    bounce.py FOLDER LAW NUMBERS --mass M --area A --force F --speed V --tolerance T

m c'' = F - A P(c), c(0) = 0, c'(0) = V, by an integrator of order 8 with its own error control; the law is that of pressure.py, or
linear k. transient.csv: the normal force at each row, of the largest.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from pressure import Law


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("law")
    parser.add_argument("numbers", nargs="+", type=float)
    for name in ("mass", "area", "force", "speed", "tolerance"):
        parser.add_argument(f"--{name}", type=float, required=True)
    a = parser.parse_args()
    if a.law == "linear":
        def pressure(c):
            return a.numbers[0] * np.maximum(c, 0)
    else:
        law = Law(a.law, a.numbers)

        def pressure(c):
            return law.both(c)[0]
    rows = np.genfromtxt(Path(a.folder) / "transient.csv", delimiter=",", names=True)
    exact = solve_ivp(lambda _, y: [y[1], (a.force - a.area * pressure(y[0])) / a.mass], (0, rows["time_s"][-1]), [0, a.speed],
                      method="DOP853", rtol=1e-10, atol=1e-14, max_step=1e-5, dense_output=True)
    force = a.area * pressure(exact.sol(rows["time_s"])[0])
    off = np.max(np.abs(rows["normal_force_n"] - force)) / np.max(force)
    print(f"normal force off by {off:.3g} of the largest, allowed {a.tolerance:g}; without force at {np.mean(force == 0):.0%} of the rows")
    if not off <= a.tolerance:
        sys.exit("the block moves otherwise")


if __name__ == "__main__":
    main()
