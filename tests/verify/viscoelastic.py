#!/usr/bin/env python3
"""Modes of materials whose stiffness depends on the eigenvalue, K (1 + g(lambda)), against what knows nothing of squeal's solver.

    viscoelastic.py closed UNDAMPED RUN hysteretic,0.02             all of the stiffness has the law: lambda^2 = -omega^2 (1 + g(lambda)) of
    viscoelastic.py closed UNDAMPED RUN prony,E1,E2,t1,t2           each undamped omega, by fixed-point iteration
    viscoelastic.py closed UNDAMPED RUN zener,E1,tau,a
    viscoelastic.py closed UNDAMPED RUN table,FILE,E,TEMPERATURE    by SciPy's PchipInterpolator in log frequency; not in its first and last
                                                                    interval, whose end it makes otherwise
    viscoelastic.py flutter RUN LAW --friction 1.3                  two masses of 1 with K = (1 + g(lambda)) [2 1; 1 2] - [0 1.3; 0 0]
    viscoelastic.py matrices SOFT STIFF RUN LAW --mu 0.5            one part has the law: its stiffness is the difference of the matrices of
                                                                    SOFT and STIFF (-operators_save), in which its modulus is E and 2 E.
        hysteretic: K + i eta A is a complex linear problem. prony: with velocities and internal displacements z_j, lambda z_j = v -
        z_j / t_j, a larger linear one. zener: Newton's method on the bordered T(lambda), and no count. By SuperLU and ARPACK about
        several shifts, which must give the same list as RUN within the band.

Moduli E_j are in units of E. RUN and UNDAMPED are folders with modes.csv, RUN with --point N one of a sweep. Prints the largest
relative difference; exit status 0 below --tolerance and as many modes, or 1."""

import argparse
import cmath
import csv
import math
import sys
from pathlib import Path

import numpy as np
import scipy.interpolate
import scipy.sparse
import scipy.sparse.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.modes.exact import sparse

STEPS = 200
NEWTON = 6  # steps from what is to be checked, the first two of the vector alone
NEAR = 12  # eigenvalues about a shift
SHIFTS = 9


def table_of(path, young, temperature):
    """g(lambda) of the rows of one temperature, or between two with linear logarithms, to first order off the axis."""
    tables, t = {}, float(temperature)
    with open(path, newline="") as lines:
        for row in csv.DictReader(lines):
            values = [float(row[name]) for name in ("frequency_hz", "modulus", "loss_factor")]
            tables.setdefault(float(row["temperature"]), []).append(values)
    about = [max(key for key in tables if key <= t), min(key for key in tables if key >= t)]
    share = (t - about[0]) / (about[1] - about[0]) if about[1] > about[0] else 0
    parts = []
    for key in about:
        hertz, e, eta = np.array(tables[key]).T
        parts.append([scipy.interpolate.PchipInterpolator(np.log(2 * np.pi * hertz), y) for y in (e, e * eta)])

    def at(x):
        first, second = (complex(real(x), imaginary(x)) for real, imaginary in parts)
        return cmath.exp((1 - share) * cmath.log(first) + share * cmath.log(second))

    def slope(x):
        relative = [complex(real(x, 1), imaginary(x, 1)) / complex(real(x), imaginary(x)) for real, imaginary in parts]
        return at(x) * ((1 - share) * relative[0] + share * relative[1])

    def g(s):
        x = math.log(abs(s))
        return (at(x) + 1j * (cmath.phase(s) - math.pi / 2) * slope(x)) / float(young) - 1
    return g


def flutter(g, friction):
    """Eigenvalues of the two masses, omega > 0: the one that grows and the other, each by fixed-point iteration."""
    values = []
    for sign in (1, -1):
        value = 1j
        for _ in range(STEPS):
            b = 1 + g(value)
            value = cmath.sqrt(-(2 * b + sign * 1j * cmath.sqrt(b * (friction - b))))
            value = value if value.imag > 0 else -value
        values.append(value)
    return values


def law_of(text):
    """g(lambda), and its derivative, of a law."""
    kind, *words = text.split(",")
    if kind == "table":
        return table_of(*words), None
    value = [float(word) for word in words]
    n = len(value) // 2
    if kind == "hysteretic":
        return lambda s: 1j * value[0], lambda s: 0
    if kind == "prony":
        return (lambda s: sum(e * s / (s + 1 / t) for e, t in zip(value[:n], value[n:])),
                lambda s: sum(e / t / (s + 1 / t)**2 for e, t in zip(value[:n], value[n:])))
    e, t, a = value
    return lambda s: e * (s * t)**a / (1 + (s * t)**a), lambda s: e * a * (s * t)**a / s / (1 + (s * t)**a)**2


def listed(folder, point=None):
    """Eigenvalues of modes.csv, or of a point of sweep.csv, that oscillate."""
    with (folder / ("sweep.csv" if point else "modes.csv")).open(newline="") as lines:
        rows = [complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])) for row in csv.DictReader(lines)
                if not point or row["point"] == point]
    return [value for value in rows if value.imag > 0]


def farthest(values, among):
    """Largest relative distance of a value from its own nearest among others, each of which serves once."""
    left, worst = list(among), 0
    for value in values:
        nearest = min(left, key=lambda other: abs(other - value))
        left.remove(nearest)
        worst = max(worst, abs(nearest - value) / abs(value))
    return worst


def closed(omega, g):
    """The eigenvalue that an undamped one becomes."""
    value = 1j * omega
    for _ in range(STEPS):
        root = cmath.sqrt(-omega**2 * (1 + g(value)))
        value = root if root.imag > 0 else -root
    return value


def nearest(matrix, mass, shift):
    """Eigenvalues of matrix x = lambda mass x next to a shift."""
    factors = scipy.sparse.linalg.splu((matrix - shift * mass).tocsc(), permc_spec="MMD_AT_PLUS_A")
    inverse = scipy.sparse.linalg.LinearOperator(matrix.shape, matvec=lambda x: factors.solve(mass @ x), dtype=complex)
    rng = np.random.default_rng(1)
    start = rng.standard_normal(matrix.shape[0]) + 0j
    return shift + 1 / scipy.sparse.linalg.eigs(inverse, k=NEAR, return_eigenvectors=False, tol=1e-14, v0=start)


def gather(of_shift, low, high):
    """Distinct eigenvalues about shifts along the band: those that lie nearer than the farthest one found about the shift."""
    found = []
    for k in range(SHIFTS):
        for value in of_shift(low + (high - low) * (k + 0.5) / SHIFTS):
            if all(abs(value - other) > 1e-7 * abs(value) for other in found):
                found.append(value)
    return found


def hysteretic(k, a, m, eta, low, high):
    def of_shift(omega):
        roots = np.sqrt(-nearest((k + 1j * eta * a).tocsc(), m.tocsc(), omega**2 + 0j))
        return np.where(roots.imag < 0, -roots, roots)
    return gather(of_shift, low, high)


def prony(k, a, m, moduli, times, low, high):
    """States x, v, z_j, of z_j those where the part is alone: lambda M v = -K x - sum E_j A z_j, lambda z_j = v - z_j / t_j; lambda in
    units of the middle of the band, so that all are displacements."""
    unit = (low + high) / 2
    n, m, times = k.shape[0], unit**2 * m, [unit * time for time in times]
    rows = np.flatnonzero(np.diff(a.indptr))
    pick = scipy.sparse.csr_matrix((np.ones(len(rows)), (np.arange(len(rows)), rows)), shape=(len(rows), n))
    one, largest = scipy.sparse.identity(n), abs(k).max()
    k, a, m = k / largest, a / largest, m / largest
    blocks = [[None, one] + [None] * len(moduli), [-k, None] + [-e * a @ pick.T for e in moduli]]
    for j, time in enumerate(times):
        blocks.append([None, pick] + [-scipy.sparse.identity(len(rows)) / time if i == j else None for i in range(len(moduli))])
    system = scipy.sparse.bmat(blocks).tocsc()
    mass = scipy.sparse.block_diag([one, m] + [scipy.sparse.identity(len(rows))] * len(moduli)).tocsc()
    return [value for value in gather(lambda omega: unit * nearest(system, mass, 1j * omega / unit), low, high) if value.imag > 0]


def newton(k, a, m, law, value):
    """The eigenvalue of T(lambda) next to a guess, by Newton's method on T(lambda) x = 0, c'x = 1, c the last x."""
    g, slope = law
    rng = np.random.default_rng(2)
    x = rng.standard_normal(k.shape[0]) + 0j
    for step in range(NEWTON):
        factors = scipy.sparse.linalg.splu((value**2 * m + k + g(value) * a).tocsc(), permc_spec="MMD_AT_PLUS_A")
        y = factors.solve((2 * value * m + slope(value) * a) @ x)
        if step > 1:
            value -= np.vdot(x, x) / np.vdot(x, y)
        x = y / np.linalg.norm(y)
    return value


def other_eigenvalues(args, found, low, high):
    """Of found: those of strong damping beyond the growth are listed for their undamped frequency, and each is looked at by itself."""
    a = sparse(args.stiff / "K.bin") - sparse(args.soft / "K.bin")
    a.data[abs(a.data) <= 1e-9 * abs(a.data).max()] = 0
    a.eliminate_zeros()
    k, m = sparse(args.soft / "K.bin"), sparse(args.soft / "M.bin")
    if (args.soft / "H.bin").exists():
        k = k + args.mu * sparse(args.soft / "H.bin")
    kind, *words = args.law.split(",")
    value = [float(word) for word in words]
    beyond = [newton(k, a, m, law_of(args.law), value) for value in found if kind == "zener" or abs(value.real) > args.growth]
    if kind == "zener":
        return beyond
    if kind == "hysteretic":
        within = hysteretic(k, a, m, value[0], low, high)
    else:
        n = len(value) // 2
        within = prony(k, a, m, value[:n], value[n:], low, high)
    return [value for value in within if abs(value.real) <= args.growth] + [value for value in beyond if abs(value.real) > args.growth]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ways = parser.add_subparsers(dest="way", required=True)
    one = ways.add_parser("closed")
    one.add_argument("undamped", type=Path)
    two = ways.add_parser("matrices")
    two.add_argument("soft", type=Path)
    two.add_argument("stiff", type=Path)
    two.add_argument("--mu", type=float, default=0)
    three = ways.add_parser("flutter")
    three.add_argument("--friction", type=float, required=True)
    for way in (one, two, three):
        way.add_argument("run", type=Path)
        way.add_argument("law")
        way.add_argument("--band", help="Hz, low,high of the run", default="0,inf")
        way.add_argument("--growth", type=float, default=math.inf, help="1/s, of the run")
        way.add_argument("--point", help="of a sweep")
        way.add_argument("--tolerance", type=float, default=1e-10)
    args = parser.parse_args()
    low, high = (2 * math.pi * float(word) for word in args.band.split(","))
    found = listed(args.run, args.point)
    if args.way == "flutter":
        others = flutter(law_of(args.law)[0], args.friction)
    elif args.way == "closed":
        others = [closed(value.imag, law_of(args.law)[0]) for value in listed(args.undamped)]
    else:
        others = other_eigenvalues(args, found, low, high)
    beyond = args.way == "matrices"
    others = [value for value in others if low <= value.imag <= high and (beyond or abs(value.real) <= args.growth)]
    worst = farthest(found, others) if len(found) == len(others) else math.inf
    print(f"{len(found)} modes, {len(others)} otherwise, largest relative difference {worst:.3g}, allowed {args.tolerance:g}")
    return 0 if worst <= args.tolerance else 1


if __name__ == "__main__":
    sys.exit(main())
