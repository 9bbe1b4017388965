#!/usr/bin/env python3
"""Hard cases against exact answers; each prints what it measured and what is allowed.

    hard.py eigenvalues RESULTS EXACT.csv F   true errors of modes.csv below F Hz over stated ones, error_hz; exact eigenvalues by
                                              tests/hard.py; all must be there, and none twice; as of any solution
                                              one in a hundred may be beyond, by three times at most
    hard.py pair RESULTS MU DAMPING           the two modes of tests/hard.py's pencil `defective` at MU, C = DAMPING M: true errors
                                              within the stated ones, these within a hundred times the true ones or what a
                                              relative change of 2.2e-16 of K does, the root of it at a defective pair
    hard.py matrices RESULTS SAVED            true errors over stated ones, on the matrices of -operators_save: as many modes as
                                              LAPACK has, refined in extended precision
    hard.py nearly RESULTS F                  distance of F, Hz, from the mode that may be it, over its stated error
    hard.py scaled RESULTS OTHER FACTOR LIMIT frequencies against FACTOR times those of another run, relative
    hard.py ledger RESULTS LIMIT              energy that is left over, of the largest work or energy
    hard.py cycles RESULTS PAIRS TIME F LIMIT onsets of PAIRS sticking pairs a second against F, Hz, relative
    hard.py last RESULTS OTHER COLUMN LIMIT   a column of the last row of transient.csv against that of another run, relative
    hard.py force RESULTS FROM FORCE LIMIT    mean normal force after FROM, s, against FORCE, N
    hard.py even RESULTS NAME PA LIMIT        pressures of all pairs of the contact NAME against PA, relative
    hard.py total RESULTS NAME FORCE LIMIT    sum of the normal forces of the contact NAME against FORCE, N, relative
    hard.py bar RESULTS N L C KN DENSITY LIMIT  frequencies of a bar of N linear elements, length L (m), wave speed C (m/s), on
                                              springs of KN (N/m^3) at one end, those in the band, four at least, against
                                              the nearest ones found, relative
    hard.py rests RESULTS PROBE TIME WAY LIMIT  a probe that stops at TIME, s, after WAY, m, along y: the way, and what it moves after"""

import csv
import math
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))


def cell(text):
    """A number, or a word as it stands."""
    try:
        return float(text)
    except ValueError:
        return text


def rows(path):
    with Path(path).open(newline="") as table:
        return [{key: cell(text) for key, text in row.items()} for row in csv.DictReader(table)]


def judge(measured, allowed):
    print(f"measured {measured:.3e}, allowed {allowed:g}")
    return 0 if measured <= allowed else 1


def eigenvalues(results, exact, top):
    import scipy.optimize
    truth = numpy.array([complex(row["growth_rad_s"], row["omega_rad_s"]) for row in rows(exact)])
    truth = truth[truth.imag < 2 * math.pi * float(top)]
    table = [row for row in rows(Path(results) / "modes.csv") if row["freq_hz"] < float(top)]
    found = numpy.array([complex(row["growth_rad_s"], 2 * math.pi * row["freq_hz"]) for row in table])
    if len(found) != len(truth):
        print(f"{len(found)} eigenvalues, must be {len(truth)}")
        return 1
    distance = abs(found[:, None] - truth)
    place, exact_place = scipy.optimize.linear_sum_assignment(distance)
    error, stated = distance[place, exact_place], 2 * math.pi * numpy.array([table[i]["error_hz"] for i in place])
    ratio = error / stated
    print(f"{len(found)} eigenvalues, errors up to {error.max():.1e} rad/s, stated up to {stated.max():.1e}, "
          f"{(ratio > 1).sum()} beyond what is stated; worst over that")
    return judge(ratio.max(), 3 if len(found) >= 100 and (ratio > 1).mean() <= 0.01 else 1)


def pair(results, mu, damping):
    """(lambda + c / 2)^2 = z, z = c^2 / 4 - kappa, kappa = 4096 -+ d, d^2 = 256 - mu^2, the roots of (kappa - 4080) (kappa - 4112) +
    mu^2. With z = a + i b and q^2 = (|z| - a) / 2 the upper root is b / (2 q) + i q; in 50 digits."""
    from decimal import Decimal, getcontext
    getcontext().prec = 50
    half, square, exact = Decimal(float(damping)) / 2, 256 - Decimal(float(mu))**2, []
    for d in (abs(square).sqrt(), -abs(square).sqrt()):
        a, b = half**2 - 4096 - (d if square > 0 else 0), d if square < 0 else 0
        q = (((a * a + b * b).sqrt() - a) / 2).sqrt()
        exact.append((b / (2 * q) - half, q))
    turn = 2 * Decimal("3.14159265358979323846264338327950288419716939937510")
    table = [row for row in rows(Path(results) / "modes.csv") if row["freq_hz"] < 14]
    if len(table) != 2:
        print(f"{len(table)} modes, must be 2")
        return 1
    worst, loose = 0, 0
    for row in table:
        value, stated = (Decimal(row["growth_rad_s"]), turn * Decimal(row["freq_hz"])), 2 * math.pi * row["error_hz"]
        true = min(math.hypot(*(float(x - y) for x, y in zip(value, each))) for each in exact)
        change = min(math.sqrt(32 * 4096 * 2.2e-16), 4096 * 2.2e-16 * row["condition"]) / 128
        worst, loose = max(worst, true / stated), max(loose, stated / max(true, change))
        print(f"{row['freq_hz']:.9g} Hz: true {true:.1e}, stated {stated:.1e} rad/s, change {change:.1e}, condition {row['condition']:.1e}")
    print(f"stated over the larger of true and change: {loose:.3g}, allowed 100; true over stated:")
    return judge(worst, 1) or loose > 100


def matrices(results, saved):
    import scipy.linalg
    from squeal.modes.exact import Pencil
    pencil, table = Pencil(Path(saved), 0), rows(Path(results) / "modes.csv")
    count = numpy.sqrt(abs(scipy.linalg.eigh(pencil.k.toarray(), pencil.m.toarray(), eigvals_only=True))) / (2 * math.pi)
    found = numpy.array([row["freq_hz"] for row in table])
    count = (count > found.min() / 2) & (count < found.max() * (1 + 1e-6))
    if count.sum() != len(found):
        print(f"{len(found)} modes, LAPACK has {count.sum()}")
        return 1
    exact = numpy.array([abs(complex(pencil.refine(2j * math.pi * f)[0])) / (2 * math.pi) for f in found])
    if len(numpy.unique(exact.round(9))) != len(found):
        print("two modes are one")
        return 1
    stated = numpy.array([row["error_hz"] for row in table])
    print(f"{len(found)} frequencies, errors up to {abs(found - exact).max():.1e} Hz; over what is stated")
    return judge((abs(found - exact) / stated).max(), 1)


def nearly(results, frequency):
    row = min(rows(Path(results) / "modes.csv"), key=lambda row: abs(row["freq_hz"] - float(frequency)) / row["error_hz"])
    return judge(abs(row["freq_hz"] - float(frequency)) / row["error_hz"], 1)


def scaled(results, other, factor, limit):
    found, exact = ([row["freq_hz"] for row in rows(Path(folder) / "modes.csv")] for folder in (results, other))
    if len(found) != len(exact):
        print(f"{len(found)} modes, must be {len(exact)}")
        return 1
    return judge(max(abs(a / (float(factor) * b) - 1) for a, b in zip(found, exact)), float(limit))


def ledger(results, limit):
    table = rows(Path(results) / "transient.csv")
    names = [name for name in table[0] if name.endswith("_j") and name not in ("energy_error_j", "friction_heat_j")]
    largest = max(abs(row[name]) for row in table for name in names)
    return judge(max(abs(row["energy_error_j"]) for row in table) / largest, float(limit))


def force(results, begin, expected, limit):
    table = [row for row in rows(Path(results) / "transient.csv") if row["time_s"] > float(begin)]
    mean = sum(row["normal_force_n"] for row in table) / len(table)
    return judge(abs(mean / float(expected) - 1), float(limit))


def pairs(results, name):
    with (Path(results) / "static.csv").open(newline="") as table:
        found = [row for row in csv.DictReader(table) if row["interface"] == name]
    if not found:
        raise SystemExit(f"no pair of {name}")
    return found


def even(results, name, pressure, limit):
    return judge(max(abs(float(row["pressure_pa"]) / float(pressure) - 1) for row in pairs(results, name)), float(limit))


def total(results, name, expected, limit):
    return judge(abs(sum(float(row["lambda_n_n"]) for row in pairs(results, name)) / float(expected) - 1), float(limit))


def bar(results, n, length, speed, stiffness, density, limit):
    """Linear elements, consistent mass: of unit area, K = rho c^2 / h [1 -1; -1 1], M = rho h / 6 [2 1; 1 2]."""
    import scipy.linalg
    n, h = int(n), float(length) / int(n)
    off = numpy.eye(n + 1, k=1) + numpy.eye(n + 1, k=-1)
    inner = numpy.diag([1, *[2] * (n - 1), 1])
    K = float(density) * float(speed)**2 / h * (inner - off)
    K[0, 0] += float(stiffness)
    exact = numpy.sqrt(scipy.linalg.eigh(K, float(density) * h / 6 * (2 * inner + off), eigvals_only=True)) / (2 * math.pi)
    found = numpy.array([row["freq_hz"] for row in rows(Path(results) / "modes.csv")])
    exact = exact[exact < found.max()]
    if len(exact) < 4:
        raise SystemExit("the band has fewer than four")
    print(f"{len(exact)} frequencies from {exact[0]:.6g} to {exact[-1]:.6g} Hz among {len(found)}")
    return judge(max(abs(found / f - 1).min() for f in exact), float(limit))


def rests(results, probe, time, way, limit):
    table = rows(Path(results) / "transient.csv")
    after = [row[f"{probe}_y_m"] for row in table if row["time_s"] > 1.05 * float(time)]
    if len(after) < 10:
        raise SystemExit("the run ends before it rests")
    return judge(max(abs(value / float(way) - 1) for value in after), float(limit))


def cycles(results, pairs, time, frequency, limit):
    sticks = [row["n_stick"] == float(pairs) for row in rows(Path(results) / "transient.csv")]
    onsets = sum(after and not before for before, after in zip(sticks, sticks[1:]))
    return judge(abs(onsets / float(time) / float(frequency) - 1), float(limit))


def last(results, other, column, limit):
    found, exact = (rows(Path(folder) / "transient.csv")[-1][column] for folder in (results, other))
    return judge(abs(found / exact - 1), float(limit))


if __name__ == "__main__":
    sys.exit(globals()[sys.argv[1]](*sys.argv[2:]))
