#!/usr/bin/env python3
"""Shares of growth, modes_causes.csv, beside independent numbers:

    causes.py terms RESULTS N SPEED    the model of tests/affine.py: vectors of LAPACK's companion form, dense matrices
    causes.py uniform RESULTS A B      C = A M + B K: -A / 2 and -B |lambda|^2 / 2
    causes.py limit RESULTS OTHER TOL  an exact contact beside a stiff penalty: the same causes, TOL of the largest share
    causes.py spin RESULTS MATRICES MU a part that spins, matrices of -operators_save, vectors of LAPACK: friction, damping, spin
    causes.py closes RESULTS           their sum alone
"""

import csv
import math
import sys
from collections import defaultdict
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from affine import companion, model
from squeal.mesh.petsc_matrix import read_matrix

SPIN = 1e-7  # of the largest: the rounding of LAPACK goes with the largest eigenvalue
SHARE = 1e-8  # of the largest share of a mode


def read(folder, name):
    with (Path(folder) / name).open(newline="") as table:
        return list(csv.DictReader(table))


def eigenvalues(folder):
    return {int(row["mode"]): complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))
            for row in read(folder, "modes.csv")}


def shares(folder):
    """Mode -> cause -> 1/s, which add up to the growth: the rest is 1e-12 of the largest at most."""
    found = defaultdict(dict)
    for row in read(folder, "modes_causes.csv"):
        found[int(row["mode"])][row["cause"], row["kind"]] = float(row["growth_rad_s"])
    values = eigenvalues(folder)
    errors = {int(row["mode"]): 2 * math.pi * float(row["error_hz"]) for row in read(folder, "modes.csv")}
    for mode, causes in found.items():
        largest = max(map(abs, causes.values()))
        if abs(sum(causes.values()) - values[mode].real) > 1e-12 * largest:
            sys.exit(f"mode {mode}: {causes} do not add up to {values[mode].real}")
        rest = abs(causes.pop(("", "rest")))
        if rest > (1e-12 * largest if errors[mode] >= 0 else 1e-9 * largest):  # without left vectors no error is known
            sys.exit(f"mode {mode}: the rest is {rest / largest} of the largest")
    if set(found) != {mode for mode, value in values.items() if value.imag > 0}:
        sys.exit(f"{sorted(found)} of {sorted(values)} have causes")
    return found


def errors(folder):
    """Mode -> stated error of a share, 1/s."""
    return {int(row["mode"]): float(row["error_rad_s"]) for row in read(folder, "modes_causes.csv")}


def compare(mode, found, exact, tolerance, stated=math.inf):
    largest = max(map(abs, exact.values()))
    worst = max(abs(found.get(name, 0) - exact.get(name, 0)) for name in set(found) | set(exact))
    if worst > min(tolerance * largest, stated + 1e-13 * largest):
        sys.exit(f"mode {mode}: {found}, must be {exact}")
    return worst / largest


def exact_terms(matrices, w, eigenvalue):
    """Shares by the vector of LAPACK that belongs to the eigenvalue."""
    values, vectors = numpy.linalg.eig(companion(matrices, w))
    at = numpy.argmin(abs(values - eigenvalue))
    x, n = vectors[: len(matrices["M"].toarray()), at], {"M": 0, "DG": 1, "D1": 1, "DR": 1}
    value, form = values[at], {name: x.conj() @ (matrix.toarray() @ x) for name, matrix in matrices.items()}
    scale = {"DR": 1 / w, "DG": w, "KGEO": w**2}
    form = {name: scale.get(name, 1) * number for name, number in form.items()}
    whole = 2 * value.imag * form["M"].real + sum(form[name].imag for name in ("DG", "D1", "DR"))
    damping = {name.lower(): -value.imag * form[name].real / whole for name in n if n[name]}
    return damping | {"kr": -form["KR"].imag / whole}


def exact_spin(folder, mu, eigenvalues_found):
    """Mode -> shares by LAPACK's vector of friction, of all damping, and of the spin, whose terms are skew or symmetric. The companion
    form is of the time 1 / scale, for the rounding of LAPACK goes with its largest number."""
    def matrix(name):
        rows, columns, row, column, value = read_matrix(Path(folder) / f"{name}.bin")
        dense = numpy.zeros((rows, columns))
        numpy.add.at(dense, (row, column), value)
        return dense

    M, C, K, H = (matrix(name) for name in "MCKH")
    n, scale = len(M), max(abs(value) for value in eigenvalues_found.values())
    both = numpy.linalg.solve(M, numpy.hstack([(K + mu * H) / scale**2, C / scale]))
    values, vectors = numpy.linalg.eig(numpy.block([[numpy.zeros((n, n)), numpy.eye(n)], [-both[:, :n], -both[:, n:]]]))
    for mode, eigenvalue in eigenvalues_found.items():
        at = numpy.argmin(abs(values * scale - eigenvalue))
        x, omega = vectors[:n, at], values[at].imag * scale
        whole = 2 * omega * (x.conj() @ M @ x).real + (x.conj() @ C @ x).imag
        yield mode, {"friction": -mu * (x.conj() @ H @ x).imag / whole, "damping": -omega * (x.conj() @ C @ x).real / whole, "spin": 0}


def main():
    what, folder, *rest = sys.argv[1:]
    found, stated, worst = shares(folder), errors(folder), 0
    values = eigenvalues(folder)
    if what == "terms":
        matrices = model(int(rest[0]))
        for mode, causes in found.items():
            exact, own = exact_terms(matrices, float(rest[1]), values[mode]), {name: value for (name, _), value in causes.items()}
            worst = max(worst, compare(mode, own, exact, SHARE, stated[mode]))
    elif what == "uniform":
        alpha, beta = map(float, rest)
        for mode, causes in found.items():
            sums = defaultdict(float)
            for (name, _), value in causes.items():
                sums[name.rsplit("_", 1)[1]] += value
            exact = {"alpha": -alpha / 2, "beta": -beta * abs(values[mode]) ** 2 / 2}
            worst = max(worst, compare(mode, sums, exact, SHARE, stated[mode]))
    elif what == "spin":
        if not any(kind == "spin" for causes in found.values() for _, kind in causes):
            sys.exit("no cause is a spin")
        for mode, exact in exact_spin(rest[0], float(rest[1]), {mode: values[mode] for mode in found}):
            sums = defaultdict(float)
            for (_, kind), value in found[mode].items():
                sums[kind if kind in exact else "damping"] += value
            worst = max(worst, compare(mode, sums, exact, SPIN))
    elif what == "limit":
        other = shares(rest[0])
        if set(found) != set(other):
            sys.exit(f"{sorted(found)} and {sorted(other)} have causes")
        for mode, causes in found.items():
            worst = max(worst, compare(mode, causes, other[mode], float(rest[1])))
    elif what != "closes" or not found:
        sys.exit(f"{what}: no such comparison, or no mode has causes")
    print(f"{len(found)} modes, worst {worst:.1e} of the largest share")


if __name__ == "__main__":
    main()
