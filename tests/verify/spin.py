#!/usr/bin/env python3
"""Spinning ring and disc in the fixed frame, against closed forms.

    verify/spin.py ring REST SPIN OMEGA
        a free ring of 98..102 mm, 4 mm thick. In its plane a wave exp(i (n theta + w t)) of the turning frame, without
        extension of the centre line, v = -u', has the dispersion

            (n^2 + 1) w^2 - 4 n W w + n^2 (3 - n^2) W^2 - n^2 (n^2 - 1)^2 E I / (rho A R^4) = 0        (G. H. Bryan, 1890)

        and w - n W in the fixed frame; its frequency at rest is that of REST. Across its plane n = 1 is a rigid tilt, which
        nutates at W I_axis / I_across.
    verify/spin.py disc REST SPIN OMEGA
        an annular plate of 60..120 mm, 2 mm thick, its inner edge held. In the turning frame the plate has its bending
        stiffness and the stress of the spin; no force of Coriolis acts along its normal. A wave with n nodal diameters has
        w - n W and w + n W in the fixed frame. w(W)^2 - w(0)^2 is that of Ritz's method with (r - a)^2 r^k.
    verify/spin.py turning REST MODES TRANSIENT OMEGA
        the ring of a mesh that turns, released in the shape of its mode at 256 Hz, with the forces of Coriolis alone: its
        pattern is two waves of the turning frame with (n^2 + 1) w^2 - 4 n W w - n^2 (n^2 - 1)^2 E I / (rho A R^4) = 0. They
        are 4 n W / (n^2 + 1) apart, and those of MODES, at the same spin in the fixed frame, 2 n W less that.
    verify/spin.py waves BACK FORTH OMEGA
        the plate's frf.csv near both waves with one nodal diameter: exp(i (omega t - theta)) runs with a positive spin and is
        the faster one, so that a probe 22.5 degrees on is behind by that angle; before it at the slower one. The force does
        work: Im(u / F) < 0. BACK has the opposite spin, and opposite angles.
    verify/spin.py swept MODES SWEEP VALUE
        modes.csv of MODES against the point of SWEEP's sweep.csv with that value: as many, and the same frequencies.
"""

import cmath
import csv
import math
import sys
from pathlib import Path

import numpy as np

from convergence import Judge, nearest, read_modes

YOUNG, POISSON, DENSITY = 210e9, 0.3, 7800
RING = 0.098, 0.102, 0.004  # inner and outer radius, thickness, m
PLATE = 0.06, 0.12, 0.002
ANGLE = 6  # degrees, for what the other modes add
SPLIT, LEVEL, STIFFENING, TIME, SWEPT = 3e-4, 2e-4, 8e-3, 1e-3, 1e-6
# Stiffening, a difference of squares, has 7.3e-3 by the mesh of 8 x 96 elements; 5.0e-3 with 16 x 96, 5.2e-3 with 8 x 192.
# Of the split 2e-4 is the plate's thickness, 5e-5 that of half of it; of the ring 2.3e-4 its width, 3e-5 half of it


def compare(judge, what, found, expected, tolerance):
    print(f"{what:44} {found:12.4f}  {expected:12.4f}  {found / expected - 1:9.1e}"
          f"{judge.within(found / expected - 1, -tolerance, tolerance)}")


def ring(judge, rest, modes, spin):
    inner, outer, thick = RING
    across = (inner**2 + outer**2) / 4 + thick**2 / 12
    compare(judge, "nutation, Hz", nearest(modes, spin / math.pi), spin / (2 * math.pi) * 2 * (inner**2 + outer**2) / 4 / across,
            LEVEL)
    for n, about in ((2, 256.17), (3, 725.03)):
        at_rest = 2 * math.pi * nearest(rest, about)
        mean = math.sqrt(at_rest**2 + (n * (n**2 - 1) / (n**2 + 1) * spin)**2)
        half = n * (n**2 - 1) / (n**2 + 1) * spin
        expected = (mean - half) / (2 * math.pi), (mean + half) / (2 * math.pi)
        found = [nearest(modes, f) for f in expected]
        for k in range(2):
            compare(judge, f"in its plane, n = {n}, {'against' if k == 0 else 'with'} the spin, Hz", found[k], expected[k], LEVEL)
        compare(judge, "    split, Hz", found[1] - found[0], half / math.pi, SPLIT)


def two_waves(time, motion, guess):
    """Angular frequencies of two undamped waves in a record: Gauss-Newton's method on them, amplitudes by least squares."""
    w = np.array(guess)

    def rest(w):
        basis = np.concatenate([[np.cos(f * time), np.sin(f * time)] for f in w]).T
        return motion - basis @ np.linalg.lstsq(basis, motion, rcond=None)[0]

    for _ in range(20):
        r, step = rest(w), 1e-3
        slopes = np.array([(rest(w + step * unit) - r) / step for unit in np.eye(2)]).T
        w = w - np.linalg.lstsq(slopes, r, rcond=None)[0]
    return w, np.abs(rest(w)).max() / np.abs(motion).max()


def turning(judge, rest, modes, folder, spin):
    with (Path(folder) / "transient.csv").open(newline="") as file:
        rows = [(float(row["time_s"]), float(row["a_x_m"])) for row in csv.DictReader(file)]
    n, at_rest = 2, 2 * math.pi * nearest(rest, 256)
    apart = 4 * n * spin / (n**2 + 1)
    mean = math.hypot(at_rest, apart / 2)
    w, left = two_waves(*np.array(rows).T, (mean - apart / 2, mean + apart / 2))
    print(f"left of the record: {left:.1e}{judge.within(left, 0, 5e-3)}")
    compare(judge, "in time, mean of both waves, Hz", w.mean() / (2 * math.pi), mean / (2 * math.pi), LEVEL)
    compare(judge, "    split in the turning frame, Hz", (w[1] - w[0]) / (2 * math.pi), apart / (2 * math.pi), TIME)
    half = n * spin - apart / 2
    fixed = [nearest(modes, (math.hypot(at_rest, half) + side * half) / (2 * math.pi)) for side in (-1, 1)]
    compare(judge, "    and in the fixed frame, their sum, Hz", (w[1] - w[0]) / (2 * math.pi) + fixed[1] - fixed[0],
            n * spin / math.pi, TIME)


def plate_energies(n, terms=8, points=200):
    """Ritz's matrices of w = sum c_k (r - a)^2 r^k cos n theta: bending, stress per W^2, mass; per thickness and pi."""
    a, b, h = PLATE
    x, weight = np.polynomial.legendre.leggauss(points)
    r, weight = (a + b) / 2 + (b - a) / 2 * x, (b - a) / 2 * weight
    k = np.arange(terms)[:, None]
    s = (r - a) / (b - a)
    w = s**(k + 2)
    w1, w2 = (k + 2) * s**(k + 1) / (b - a), (k + 2) * (k + 1) * s**k / (b - a)**2
    hoop = w1 / r - n**2 * w / r**2
    twist = n * (w1 / r - w / r**2)
    d = YOUNG * h**2 / (12 * (1 - POISSON**2))
    bending = d * ((w2 + hoop) * r * weight @ (w2 + hoop).T
                   - (1 - POISSON) * (w2 * r * weight @ hoop.T + hoop * r * weight @ w2.T - 2 * twist * r * weight @ twist.T))
    sigma_r, sigma_t = plate_stress(r)
    stress = sigma_r * r * weight * w1 @ w1.T + sigma_t * r * weight * (n * w / r) @ (n * w / r).T
    return bending, stress, DENSITY * (r * weight * w @ w.T)


def plate_stress(r):
    """Stress of the spin per W^2: u = A r + B / r - (1 - nu^2) rho r^3 / (8 E), u(a) = 0 and sigma_r(b) = 0."""
    a, b, _ = PLATE
    c = (1 - POISSON**2) * DENSITY / (8 * YOUNG)
    edge = [[a, 1 / a], [(1 + POISSON), -(1 - POISSON) / b**2]]
    A, B = np.linalg.solve(edge, [c * a**3, c * (3 + POISSON) * b**2])
    front = YOUNG / (1 - POISSON**2)
    strain_r, strain_t = A - B / r**2 - 3 * c * r**2, A + B / r**2 - c * r**2
    return front * (strain_r + POISSON * strain_t), front * (strain_t + POISSON * strain_r)


def plate_frequency(n, spin):
    bending, stress, mass = plate_energies(n)
    low = np.linalg.inv(np.linalg.cholesky(mass))
    return math.sqrt(np.linalg.eigvalsh(low @ (bending + spin**2 * stress) @ low.T)[0])


def disc(judge, rest, modes, spin):
    for n in range(4):
        at_rest = min(f for f, label in rest if label == f"(0,{n})")
        stiffening = plate_frequency(n, spin)**2 - plate_frequency(n, 0)**2
        about = math.sqrt((2 * math.pi * at_rest)**2 + stiffening)
        found = [nearest(modes, (about + side * n * spin) / (2 * math.pi)) for side in (-1, 1)]
        mean = math.pi * (found[0] + found[1])
        compare(judge, f"across its plane, n = {n}: w^2 - w_0^2, 1/s^2", mean**2 - (2 * math.pi * at_rest)**2, stiffening, STIFFENING)
        if n:
            compare(judge, "    split, Hz", found[1] - found[0], n * spin / math.pi, SPLIT)


def waves(judge, back, forth):
    for folder, sign in ((forth, 1), (back, -1)):
        with (Path(folder) / "frf.csv").open(newline="") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        for row, expected in zip(rows, (22.5 * sign, -22.5 * sign), strict=True):
            tip, beside = (complex(row[f"{probe}_z_re_m_n"], row[f"{probe}_z_im_m_n"]) for probe in ("tip", "beside"))
            angle = math.degrees(cmath.phase(beside / tip))
            print(f"{row['freq_hz']:.0f} Hz: {angle:.1f} degrees, {expected} expected{judge.within(angle - expected, -ANGLE, ANGLE)}"
                  f"{judge.within(tip.imag, -math.inf, 0)}")


def swept(judge, modes, folder, value):
    with (Path(folder) / "sweep.csv").open(newline="") as file:
        points = sorted(float(row["freq_hz"]) for row in csv.DictReader(file) if math.isclose(float(row["value"]), value))
    expected = sorted(f for f, _ in modes)
    print(f"{len(points)} modes of the sweep{judge.within(len(points), max(1, len(expected)), len(expected))}")
    for found, exact in zip(points, expected):
        compare(judge, "    Hz", found, exact, SWEPT)


def main(what, rest, spinning, *others):
    judge, spin = Judge(), float(others[-1])
    print(f"{'':44} {'computed':>12}  {'closed form':>12}  {'relative':>9}")
    if what == "turning":
        turning(judge, read_modes(rest), read_modes(spinning), others[0], spin)
    elif what == "waves":
        waves(judge, rest, spinning)
    elif what == "swept":
        swept(judge, read_modes(rest), spinning, spin)
    else:
        {"ring": ring, "disc": disc}[what](judge, read_modes(rest), read_modes(spinning), spin)
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
