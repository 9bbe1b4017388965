#!/usr/bin/env python3
"""Judges superelements that squeal made, without squeal: numpy and scipy on the matrices of the parts.

    made_superelement.py reference SAVED TABLE MADE METHOD CUTOFF   K.bin, M.bin of the part and the table of its unknowns; cut-off, Hz
    made_superelement.py joined SAVED TABLE MADE       what the table says of any structure holds with 60 random ones on the interface
    made_superelement.py same MADE MADE TOLERANCE     matrices and tables of two runs
    made_superelement.py back MADE SAVED              K.bin and M.bin of SAVED are those of MADE, byte for byte
    made_superelement.py formats MADE                 files of all formats, read by scipy and by small readers, are those of squeal
    made_superelement.py among MADE MODES             modes of the superelement are among those of a scene of its bodies and others
    made_superelement.py holds MADE MODES MODES       of two runs of one brake, the part as mesh and as superelement, modes differ by no
                                                      more than the superelement says, 1e-4 of the frequency, 1 % of the growth

reference builds the superelement anew: Craig and Bampton's by a Schur complement and scipy's eigenvectors, the free one from modes and
K^-1 E, none by a permutation. The error of each mode is then looked at: it must hold, and be no more than 30 times too large.
"""

import csv
import sys
from pathlib import Path

import numpy as np
import scipy.io
import scipy.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from scipy.sparse import csr_matrix
from squeal.mesh.petsc_matrix import read_matrix

TOO_LARGE, NOISE = 30, 1e-9  # of an estimate; of a frequency, below which an error is rounding


def matrix(path):
    rows, columns, i, j, value = read_matrix(Path(path))
    return csr_matrix((value, (i, j)), shape=(rows, columns)).toarray()


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def check(text, value, limit):
    print(f"{text}: {value:.3g}, at most {limit:.3g}")
    if not value <= limit:
        sys.exit(f"error: {text}: {value:.3g} exceeds {limit:.3g}")


def hertz(K, M):
    """Frequencies of K x = (2 pi f)^2 M x, those of rigid modes 0 to rounding."""
    return np.sqrt(np.maximum(scipy.linalg.eigh(K, M, eigvals_only=True), 0)) / (2 * np.pi)


def order(lines, made):
    """Unknowns of the part in the order of the superelement: those of the interface, then the others by place."""
    def place(row):
        return tuple(round(float(row[x]), 9) for x in "xyz"), row["direction"]

    places = {place(row): k for k, row in enumerate(lines) if row["direction"] != "internal"}
    on = [places[place(row)] for row in made if row["direction"] != "internal"]
    return on, [k for k in range(len(lines)) if k not in set(on)]


def basis(K, M, on, inside, method, cutoff):
    """T of the method, the interface first."""
    n, b = len(K), len(on)
    kappa = (2 * np.pi * cutoff) ** 2
    T = np.zeros((n, b))
    T[on, range(b)] = 1
    if method == "fixed":
        Kii, Mii = K[np.ix_(inside, inside)], M[np.ix_(inside, inside)]
        T[inside] = -np.linalg.solve(Kii, K[np.ix_(inside, on)])
        phi = np.zeros((n, len(inside)))
        w, phi[inside] = scipy.linalg.eigh(Kii, Mii)
        return np.c_[T, phi[:, w < kappa]]
    w, phi = scipy.linalg.eigh(K, M)
    w, phi = w[w < kappa], phi[:, w < kappa]
    X = np.linalg.solve(K, T) - phi / w @ phi[on].T  # what the modes leave out
    f = np.linalg.solve(X[on], np.c_[np.eye(b), -phi[on]])  # u = X f + Phi eta
    return X @ f + np.c_[np.zeros((n, b)), phi]


def same_sizes(a, b):
    if a.shape != b.shape:
        sys.exit(f"error: {a.shape[0]} unknowns, where {b.shape[0]} were expected")


def errors_hold(rows, exact):
    """Each stated error against what it is."""
    worst = 0
    for kind, values in exact.items():
        stated = [row for row in rows if row["interface"] == kind]
        for row, f in zip(stated, values[values > 1e-3][-len(values):]):
            is_off, said = abs(float(row["freq_hz"]) - f), float(row["error_hz"])
            worst = max(worst, is_off / (said + NOISE * f))
            if is_off > NOISE * f and said > TOO_LARGE * is_off:
                sys.exit(f"error: {kind} mode {row['mode']} is off by {is_off:.3g} Hz, said to be {said:.3g} Hz")
    check("largest error of a mode beside the stated one", worst, 1.05)


def reference(saved, lines, made, method, cutoff):
    K, M = (matrix(Path(saved) / f"{name}.bin") for name in "KM")
    k, m = (matrix(Path(made) / f"superelement_{name}.bin") for name in "km")
    on, inside = order(table(lines), table(Path(made) / "superelement_table.csv"))
    b = len(on)
    if method == "none":
        same_sizes(k, K)
        check("eigenvalues of all unknowns", abs(hertz(k, m) / hertz(K, M) - 1).max(), 1e-11)
        check("the block of the interface", abs(k[:b, :b] - K[np.ix_(on, on)]).max() / abs(K).max(), 1e-15)
        return
    T = basis(K, M, on, inside, method, float(cutoff))
    same_sizes(k, T.T @ T)
    for name, mine, whole in (("K", k, K), ("M", m, M)):
        check(f"interface of {name}", abs(mine[:b, :b] - (T.T @ whole @ T)[:b, :b]).max() / abs(mine).max(), 1e-9)
    check("all its frequencies", abs(hertz(k, m) / hertz(T.T @ K @ T, T.T @ M @ T) - 1).max(), 1e-8)
    exact = {"free": hertz(K, M), "held": hertz(K[np.ix_(inside, inside)], M[np.ix_(inside, inside)])}
    errors_hold(table(Path(made) / "superelement.csv"), exact)


def joined(saved, lines, made):
    K, M = (matrix(Path(saved) / f"{name}.bin") for name in "KM")
    k, m = (matrix(Path(made) / f"superelement_{name}.bin") for name in "km")
    on, _ = order(table(lines), table(Path(made) / "superelement_table.csv"))
    said = [row for row in table(Path(made) / "superelement.csv") if row["interface"] == "any"][0]
    band, relative, worst, random, b = float(said["freq_hz"]), float(said["relative_error"]), 0, np.random.default_rng(1), len(on)
    for _ in range(60):
        few = random.integers(1, b)  # of low rank or full, soft or stiff, light or heavy
        stiff, heavy = (random.normal(size=(b, few)) * 10 ** random.uniform(-3, 1) for _ in range(2))
        adds = np.mean(np.diag(K)) * stiff @ stiff.T, np.mean(np.diag(M)) * heavy @ heavy.T
        whole, used = [], []
        for A, a, add in zip((K, M), (k, m), adds):
            whole.append(A.copy())
            used.append(a.copy())
            whole[-1][np.ix_(on, on)] += add
            used[-1][:b, :b] += add
        f, g = hertz(*whole), hertz(*used)
        inside = (f < band) & (f > 1)
        if inside.any():
            worst = max(worst, (((g[:len(f)] / f[:len(g)]) - 1)[inside[:len(g)]] / (f[inside] / band) ** 2).max() / relative)
    if not worst:
        sys.exit("error: no frequency was in the band")
    check("largest error of a frequency beside what is said of any structure", worst, 1.05)


def same(first, second, tolerance):
    for name in "kmc":
        a, b = (matrix(Path(made) / f"superelement_{name}.bin") for made in (first, second))
        same_sizes(a, b)
        check(f"largest difference of {name}", abs(a - b).max() / abs(a).max(), float(tolerance))
    if table(Path(first) / "superelement_table.csv") != table(Path(second) / "superelement_table.csv"):
        sys.exit("error: the tables differ")


def back(made, saved):
    for name in "KM":
        if (Path(made) / f"superelement_{name.lower()}.bin").read_bytes() != (Path(saved) / f"{name}.bin").read_bytes():
            sys.exit(f"error: {saved}/{name}.bin is not what was written")


def numbers(lines, made):
    """Unknown of each (node, direction), as Nastran and Abaqus have them: direction 1 to 3, 0 of an internal one."""
    nodes = max(int(row["node"]) for row in lines)
    return {(int(row["node"]), 1 + "xyz".index(row["direction"])) if row["direction"] != "internal" else (nodes + 1 + k - made, 0): k
            for k, row in enumerate(lines)}


def dmig(path, number):
    """Matrices, places of GRID points and numbers of SPOINT of bulk data in fields of 16 and 8 columns."""
    found, places, points, column, grid = {}, {}, [], None, None
    for line in path.read_text().splitlines():
        head, wide = line[:8].strip(), [line[8 + 16 * k:24 + 16 * k].strip() for k in range(4)]
        if head == "GRID*":
            grid = int(wide[0])
            places[grid] = [float(wide[2]), float(wide[3])]
        elif head == "SPOINT":
            points = list(range(int(line[8:16]), int(line[24:32]) + 1)) if "THRU" in line else [int(line[8:16])]
        elif head == "DMIG":
            if [int(line[k:k + 8]) for k in (16, 24, 32, 40)] != [0, 6, 2, 0]:
                sys.exit(f"error: {line}")
            found[line[8:16].strip()] = np.zeros((len(number), len(number)))
        elif head == "DMIG*":
            grid, column = None, (found[wide[0]], number[int(wide[1]), int(wide[2])])
        elif head == "*" and grid:
            places[grid].append(float(wide[0]))
        elif head == "*":
            i, (full, j) = number[int(wide[0]), int(wide[1])], column
            full[i, j] = full[j, i] = float(wide[2].replace("D", "E"))
    return found, places, points


def abaqus(path, number):
    rows = [line.split(",") for line in path.read_text().splitlines() if not line.startswith("**")]
    full, last = np.zeros((len(number), len(number))), max(node for node, direction in number if direction)
    for *where, value in rows:
        i, j = ((int(node), int(direction) if int(node) <= last else 0) for node, direction in (where[:2], where[2:]))
        full[number[i], number[j]] = full[number[j], number[i]] = float(value)
    return full


def formats(made):
    made, lines = Path(made), table(Path(made) / "superelement_table.csv")
    interface = [row for row in lines if row["direction"] != "internal"]
    number = numbers(lines, len(interface))
    nastran, places, points = dmig(made / "superelement.pch", number)
    deck = (made / "superelement.inp").read_text()
    for letter, name in zip("kmc", ("KSE", "MSE", "BSE")):
        A = matrix(made / f"superelement_{letter}.bin")
        check(f"{letter} as Matrix Market", abs(scipy.io.mmread(made / f"superelement_{letter}.mtx").toarray() - A).max(), 0)
        check(f"{letter} as Abaqus", abs(abaqus(made / f"superelement_abaqus_{letter}.mtx", number) - A).max(), 0)
        check(f"{letter} as DMIG, of its largest entry", abs(nastran[name] - A).max() / abs(A).max(), 1e-9)
        if f"INPUT=superelement_abaqus_{letter}.mtx" not in deck:
            sys.exit(f"error: superelement.inp does not name superelement_abaqus_{letter}.mtx")
    check("places of nodes", max(abs(places[int(row["node"])][d] - float(row[x])) for row in interface for d, x in enumerate("xyz")), 1e-9)
    words = [line.split(",") for line in deck.splitlines() if not line.startswith("*")]
    check("places in Abaqus", max(abs(float(words[int(row["node"]) - 1][1 + d]) - float(row[x])) for row in interface
                                  for d, x in enumerate("xyz")), 0)
    if points != list(range(len(places) + 1, len(places) + 1 + len(lines) - len(interface))):
        sys.exit("error: SPOINT are not the internal unknowns")


def among(made, modes):
    f = np.array([float(row["freq_hz"]) for row in table(Path(modes) / "modes.csv")])
    own = [row for row in table(Path(made) / "superelement.csv") if row["interface"] == "free"]
    off = [(abs(f - float(row["freq_hz"])).min(), float(row["error_hz"]) + NOISE * float(row["freq_hz"])) for row in own]
    check(f"largest error of {len(off)} modes beside what is said", max(is_off / said for is_off, said in off), 1.05)


def holds(made, whole, used):
    said = max(float(row["relative_error"]) for row in table(Path(made) / "superelement.csv"))
    a, b = (table(Path(folder) / "modes.csv") for folder in (whole, used))
    if len(a) != len(b):
        sys.exit(f"error: {len(a)} and {len(b)} modes")
    f, g = (np.array([float(row["freq_hz"]) for row in rows]) for rows in (a, b))
    check("frequencies", abs(g / f - 1).max(), min(1e-4, said))
    grows = [(float(x["growth_rad_s"]), float(y["growth_rad_s"])) for x, y in zip(a, b) if x["unstable"] == "1"]
    if not grows:
        sys.exit("error: no mode grows")
    check("growth", max(abs(y / x - 1) for x, y in grows), 0.01)


if __name__ == "__main__":
    commands = {each.__name__: each for each in (reference, joined, same, back, formats, among, holds)}
    commands[sys.argv[1]](*sys.argv[2:])
