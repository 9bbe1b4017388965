#!/usr/bin/env python3
"""Derivatives of the eigenvalues of options/affine.yaml by the speed, beside those of its closed form

    P(l, w) = l^2 + (c / w - i g w) l + k - i n + w^2 e = 0,   dl/dw = -(dP/dw) / (dP/dl)

whose roots with a negative imaginary part stand for their conjugates.

    affine_slopes.py RESULTS"""

import csv
import sys
from pathlib import Path

import numpy

c, g, k, n, e = 0.25, 0.1, 1, 0.1, 0.01


def exact(w):
    """Eigenvalues of the upper half plane and their derivatives."""
    roots = numpy.roots([1, c / w - 1j * g * w, k - 1j * n + w**2 * e])
    slope = -((-c / w**2 - 1j * g) * roots + 2 * e * w) / (2 * roots + c / w - 1j * g * w)
    down = roots.imag < 0
    return numpy.where(down, roots.conj(), roots), numpy.where(down, slope.conj(), slope)


def main():
    folder, worst, n_rows = Path(sys.argv[1]), 0, 0
    with (folder / "sensitivities.csv").open(newline="") as table:
        for row in csv.DictReader(table):
            values, slopes = exact(float(row["value"]))
            mine = complex(float(row["growth_rad_s_per_unit"]), 2 * numpy.pi * float(row["freq_hz_per_unit"]))
            at = abs(values.imag - 2 * numpy.pi * float(row["freq_hz"])).argmin()
            worst, n_rows = max(worst, abs(mine - slopes[at])), n_rows + 1
    print(f"{n_rows} derivatives within {worst:.1e}")
    if n_rows != 82 or not worst < 1e-10:
        sys.exit("FAILED")


if __name__ == "__main__":
    main()
