#!/usr/bin/env python3
"""A cube on a superelement that acts on every node along x and y with k, c and the skew a of its stiffness and g of its damping,
m the mass of a node: translations obey m lambda^2 + (c +- i g) lambda + k +- i a = 0; a turn about z has neither a nor g.

    skew_superelement.py files FOLDER      table.csv, k.bin, c.bin for the cube of 0.1 m; half.bin, one triangle of k.bin; even.bin
    skew_superelement.py modes FILE [KEY=FACTOR ...]  modes.csv has both with a positive frequency; factors of K (k, a) and of C (c, g)
    skew_superelement.py sweep FILE KEY=FACTOR ...    the same of sweep.csv where the parameter has that factor
    skew_superelement.py response FILE     frf.csv at the corner 0.1,0.1,0.1 for 1 N along x there
"""

import csv
import itertools
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from scipy.sparse import coo_matrix
from squeal.mesh.petsc_matrix import write_matrix

M, K, A, C, G = 1000 * 1e-3 / 8, 3000.0, 400.0, 0.05, 3.0  # kg, N/m, N/m, N s/m, N s/m of a node
SAME, ROOM = 1e-6, 1e-5  # the cube is 1e8 times as stiff; of a response, which has places where parts cancel


def write(folder):
    x = list(itertools.product((0, 0.1), repeat=3))
    lines = [f"{2 * n + d + 1},{n + 1},{d + 1},{a:g},{b:g},{c:g}" for n, (a, b, c) in enumerate(x) for d in range(2)]
    (folder / "table.csv").write_text("\n".join(["unknown,node,direction,x,y,z", *lines]) + "\n")
    for name, even, skew in (("k", K, A), ("c", C, G), ("even", K, 0)):
        write_matrix(folder / f"{name}.bin", coo_matrix(np.kron(np.eye(8), [[even, skew], [-skew, even]])).tocsr())
    write_matrix(folder / "half.bin", coo_matrix(np.kron(np.eye(8), [[K, A], [0, K]])).tocsr())


def modes(path, factors):
    k, c = (float(factors.get(key, 1)) for key in "kc")
    wanted = [root for sign in (1, -1) for root in np.roots([M, c * (C + sign * 1j * G), k * (K + sign * 1j * A)]) if root.imag > 0]
    with path.open(newline="") as rows:
        found = [complex(float(row["growth_rad_s"]), 2 * np.pi * float(row["freq_hz"])) for row in csv.DictReader(rows)
                 if all(abs(float(row.get(f"gyro_{key}_scale", value)) - float(value)) < 1e-9 for key, value in factors.items())]
    off = [min(abs(value - root) for value in found) / abs(root) for root in wanted]
    print(f"{len(wanted)} translations {wanted}, off by {max(off):.1e}")
    return len(wanted) == 2 and max(off) < SAME and max(root.real for root in wanted) > 1


def response(path):
    with path.open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    worst = 0
    for row in rows:
        w = 2 * np.pi * float(row["freq_hz"])
        D = np.array([[K - M * w * w + 1j * w * C, A + 1j * w * G], [-A - 1j * w * G, K - M * w * w + 1j * w * C]])
        turn = 0.05 / (8 * 2 * 0.05**2) / (K - M * w * w + 1j * w * C)  # the corner is 0.05, 0.05 m from the middle
        wanted = np.linalg.solve(D, [1 / 8, 0]) + turn * np.array([0.05, -0.05])
        for name, value in zip("xy", wanted):
            found = complex(float(row[f"tip_{name}_re_m_n"]), float(row[f"tip_{name}_im_m_n"]))
            worst = max(worst, abs(found - value) / np.linalg.norm(wanted))
    print(f"{len(rows)} frequencies, off by {worst:.1e}")
    return len(rows) == 5 and worst < ROOM


def main():
    what, path = sys.argv[1], Path(sys.argv[2])
    if what == "files":
        write(path)
        return 0
    return 0 if (response(path) if what == "response" else modes(path, dict(word.split("=") for word in sys.argv[3:]))) else 1


if __name__ == "__main__":
    sys.exit(main())
