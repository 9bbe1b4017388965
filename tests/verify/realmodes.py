#!/usr/bin/env python3
"""The projection on real modes against LAPACK: verify/realmodes.py RUN MATRICES MU N symmetrised|frictionless LOW HIGH RTOL. RUN has the
sweep.csv of one value by -sweep_method real, MATRICES K.bin, M.bin and H.bin at that value. The N real modes x of the lowest kappa,
A x = kappa M x, A = K + MU (H + H') / 2 or K, span V; -lambda^2 are then the eigenvalues of V' (K + MU H) V beside V' M V. The
frequencies and growth rates of the table must be among them within RTOL of the frequency, and all of LOW to HIGH Hz in it whose growth
is within the default of -modes_growth, a tenth of the angular frequency HIGH."""

import csv
import sys
from pathlib import Path

import numpy as np
import scipy.linalg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from squeal.modes.exact import sparse


def projected(folder, mu, n, symmetrised):
    """Eigenvalues with positive frequency, rad/s."""
    stiffness, mass, friction = (sparse(folder / f"{name}.bin").toarray() for name in "KMH")
    whole = stiffness + mu * friction
    values, V = scipy.linalg.eigh((whole + whole.T) / 2 if symmetrised else stiffness, mass, subset_by_index=[0, n + n // 4])
    V = V[:, np.argsort(np.abs(values))[:n]]
    assert np.sort(np.abs(values))[n - 1] <= values[-1], "not the n of least magnitude"
    kappa = scipy.linalg.eigvals(V.T @ whole @ V, V.T @ mass @ V)
    found = np.concatenate([np.sqrt(-kappa + 0j), -np.sqrt(-kappa + 0j)])
    return found[found.imag > 0]


def main():
    run, folder, mu, n, kind, low, high, tolerance = sys.argv[1:]
    low, high = 2 * np.pi * float(low), 2 * np.pi * float(high)
    found = projected(Path(folder), float(mu), int(n), kind == "symmetrised")
    with (Path(run) / "sweep.csv").open(newline="") as file:
        modes = [float(row["growth_rad_s"]) + 2j * np.pi * float(row["freq_hz"]) for row in csv.DictReader(file)]
    there, expected = (sum(low <= value.imag <= high and abs(value.real) <= 0.1 * high for value in values) for values in (modes, found))
    worst = max((min(abs(found - mode)) / mode.imag for mode in modes), default=np.inf)
    print(f"{there} of {expected} modes, {sum(mode.real > 0 for mode in modes)} grow: worst difference {worst:.2g}")
    if there != expected or worst > float(tolerance):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
