#!/usr/bin/env python3
"""Contributions of component modes, modes_components.csv, beside free modes by LAPACK, body by body, and inverse iteration:

    verify/components.py RESULTS OPEN MU
    verify/components.py found RESULTS EXACT

RESULTS has the tables of modes and the saved matrices K.bin, H.bin, M.bin; OPEN the K.bin of the same scene whose contact has next to
no stiffness, and whose bodies are the connected parts of that matrix. Free modes of one frequency are summed, as in the table. Shares
and energies of complex modes and of each third one agree within the errors that the rows state; those of a mode sum to 100.

The second way: free modes from the modes found, beside those of -modes_components 1.5. Labels of all modes are the same; frequencies
agree within the errors that rows state, shares and energies within these and 1 % of the whole."""

import csv
import sys
from pathlib import Path

import numpy as np
from dense import matrix
from scipy.linalg import eigh
from scipy.sparse import csc_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

MOST = 120  # modes of a body, more than a table has
ERROR = 1e-3  # per cent, the largest that a row states
LINE = 1e-3  # Hz, rounding of frequencies
SHARE, SMALL = 1, 0.1  # per cent of the whole: of any free mode; of those that have no row of exact ones
CONTACT = 1e-9  # of the largest entry: what the open contact leaves is far below, what holds a body together above


def read(folder, name):
    with (folder / name).open(newline="") as file:
        return list(csv.DictReader(file))


def bodies(stiffness, mass):
    """Of each body its unknowns, frequencies (Hz), and the products of its mass with its vectors."""
    n, of = connected_components(abs(stiffness) > CONTACT * abs(stiffness).max(), directed=False)
    for b in range(n):
        at = np.flatnonzero(of == b)
        own = mass[np.ix_(at, at)]
        values, vectors = eigh(stiffness[np.ix_(at, at)], own, subset_by_index=[0, min(len(at), MOST) - 1])
        yield at, np.sqrt(np.maximum(values, 0)) / (2 * np.pi), own @ vectors


def block_of(rows, blocks):
    """The block whose frequencies a body of the table has."""
    def off(block):
        return max(abs(block[1][int(row["component"]) - 1] - float(row["freq_hz"])) for row in rows if row["name"] != "rigid")
    return min(blocks, key=off)


def vectors_of(stiffness, mass, kappa):
    """Right and left vector of K x = kappa M x, y^T K = kappa y^T M, both sparse, from a number next to kappa."""
    near = kappa * (1 + 1e-9) if kappa else -1.0
    factors, found = splu((stiffness - near * mass).astype(complex), permc_spec="MMD_AT_PLUS_A"), []
    for transposed in "NT":
        x = np.random.default_rng(1).standard_normal(mass.shape[0]) + 0j
        for _ in range(4):
            x = factors.solve(mass @ (x / np.linalg.norm(x)), transposed)
        found.append(x / np.linalg.norm(x))
    return found


def compare(folder, exact):
    """Free modes from the modes found beside exact ones."""
    pairs = list(zip(read(folder, "modes.csv"), read(exact, "modes.csv"), strict=True))
    failed = [f"mode {a['mode']}: {a['label']}, not {b['label']}" for a, b in pairs if a["label"] != b["label"]]
    rows, others = [row for row in read(folder, "modes_components.csv") if row["component"]], read(exact, "modes_components.csv")
    worst, off = 0, 0
    for row in rows:
        low, width = float(row["freq_hz"]), float(row["freq_error_hz"]) + LINE
        same = [other for other in others if other["component"] and (other["mode"], other["body"]) == (row["mode"], row["body"])
                and abs(float(other["freq_hz"]) - low) <= width]
        if not same:
            failed.append(f"no {row['body']} {row['name']} at {low} Hz")
            continue
        off = max(off, min(abs(float(other["freq_hz"]) - low) for other in same) / low if low else 0)
        difference = max(abs(sum(float(other[key]) for other in same) - float(row[key])) for key in ("share_percent", "energy_percent"))
        worst = max(worst, difference)
        if difference > min(float(row["error_percent"]) + SMALL, SHARE):
            failed.append(f"{row['body']} {row['name']}: {row['share_percent']} %, off by {difference}")
    unstable = {a["mode"] for a, _ in pairs if a["unstable"] == "1"}
    if {row["mode"] for row in rows} != unstable or not unstable:
        failed.append(f"rows of modes {sorted({row['mode'] for row in rows})}, not {sorted(unstable)}")
    print("; ".join(failed[:5]) or f"{len(rows)} rows: largest difference {worst:.1e} %, of frequencies {off:.1e}")
    return 1 if failed else 0


def main():
    if sys.argv[1] == "found":
        return compare(Path(sys.argv[2]), Path(sys.argv[3]))
    folder, opened, mu = Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3])
    mass, stiffness = matrix(folder / "M.bin"), matrix(folder / "K.bin") + mu * matrix(folder / "H.bin")
    blocks = list(bodies(matrix(opened / "K.bin"), mass))
    mass, stiffness = csc_matrix(mass), csc_matrix(stiffness)
    table = read(folder, "modes_components.csv")
    names = sorted({row["body"] for row in table})
    block = {name: block_of([row for row in table if row["body"] == name and row["component"]], blocks) for name in names}
    worst, failed, complex_modes = 0, [], 0
    for mode in read(folder, "modes.csv"):
        wanted = -complex(float(mode["growth_rad_s"]), 2 * np.pi * float(mode["freq_hz"])) ** 2
        complex_modes += abs(wanted.imag) > 0
        rows = [row for row in table if row["mode"] == mode["mode"]]
        sums = np.sum([[float(row["share_percent"]), float(row["energy_percent"])] for row in rows], axis=0)
        if max(abs(sums - 100)) > 1e-9:
            failed.append(f"mode {mode['mode']} sums to {sums}")
        if not wanted.imag and int(mode["mode"]) % 3:
            continue
        x, y = vectors_of(stiffness, mass, wanted)
        whole, energy = y @ mass @ x, (x.conj() @ mass @ x).real
        for row in rows:
            if not row["component"]:
                continue
            at, _, weighted = block[row["body"]]
            first = int(row["component"]) - 1
            mass_phi = weighted[:, first:first + int(row["modes"])]
            on_x, on_y = mass_phi.T @ x[at], mass_phi.T @ y[at]
            found = 100 * (on_y @ on_x / whole).real, 100 * (on_x.conj() @ on_x).real / energy
            off = max(abs(found[0] - float(row["share_percent"])), abs(found[1] - float(row["energy_percent"])))
            worst = max(worst, off)
            if not off <= float(row["error_percent"]) < ERROR:
                failed.append(f"mode {mode['mode']}, {row['body']} {row['name']}: {found}, not {row['share_percent']}")
    said = f"{len(names)} bodies, {len(table)} rows, {complex_modes} complex modes: largest difference {worst:.1e} %"
    print("; ".join(failed[:5]) or said)
    return 1 if failed or len(names) != len(blocks) or not complex_modes else 0


if __name__ == "__main__":
    sys.exit(main())
