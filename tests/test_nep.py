#!/usr/bin/env python3
"""Modes of a brake whose pad has a law of stiffness against SLEPc's NEP (NLEIGS, rational Krylov of a rational interpolation) on the run's
own matrices, T(lambda) = lambda^2 M + K + mu H + g(lambda) A: all of the band, which shares nothing with the projection. Breaks when a mode
is lost, or a law is evaluated elsewhere than at the mode's own eigenvalue.

    test_nep.py SQUEAL

NLEIGS finds complex eigenvalues in complex arithmetic alone, which the program is not linked with: it runs here by Debian's
python3-slepc4py-complex. Without it the test is skipped (77)."""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "tests/verify")]
from squeal.modes.exact import sparse  # noqa: E402
from viscoelastic import farthest, listed  # noqa: E402

SCENE = """rig: {disc: {elements: "6,20,1"}, pad: {elements: "2,2,2"}, beam: {elements: 6}}
modes: {band: "1000,8000"}
"""
YOUNG, ETA, MU, LOW, HIGH = 25.1e9, 1.5, 0.5, 1000, 8000
GROWTH = 0.1  # of the upper end, as the run's
TOLERANCE = 1e-9
SOLVER = {"ksp_type": "preonly", "pc_type": "lu", "pc_factor_mat_solver_type": "mumps"}
LAWS = {"prony": ["-pad_prony_modulus", 0.2 * YOUNG, "-pad_prony_time", 2e-4],
        "hysteretic": ["-pad_loss_factor", ETA],
        "zener": ["-pad_zener_modulus", YOUNG, "-pad_zener_time", 2e-5, "-pad_zener_order", 0.5]}


def squeal(program, folder, *words):
    options = ["-options_file", SOURCE / "options/massi2005.yaml", "-options_file", "small.yaml", "-output_fields", "0", *words]
    subprocess.run([program, *map(str, options)], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def functions(kind, unit):
    """lambda^2, 1 and g(lambda) as SLEPc's FN, lambda in units of rad/s."""
    square, one, law = (SLEPc.FN().create() for _ in range(3))
    for function, numerator in ((square, [unit**2, 0, 0]), (one, [1.0])):
        function.setType(SLEPc.FN.Type.RATIONAL)
        function.setRationalNumerator(numerator)
    if kind == "prony":
        law.setType(SLEPc.FN.Type.RATIONAL)
        law.setRationalNumerator([0.2 * 2e-4 * unit, 0])
        law.setRationalDenominator([2e-4 * unit, 1])
        return [square, one, law]
    if kind == "hysteretic":
        law.setType(SLEPc.FN.Type.RATIONAL)
        law.setRationalNumerator([1j * ETA])
        return [square, one, law]
    root, share = SLEPc.FN().create(), SLEPc.FN().create()
    root.setType(SLEPc.FN.Type.SQRT)
    root.setScale(2e-5 * unit, 1)
    share.setType(SLEPc.FN.Type.RATIONAL)
    share.setRationalNumerator([1, 0])
    share.setRationalDenominator([1, 1])
    law.setType(SLEPc.FN.Type.COMBINE)
    law.setCombineChildren(SLEPc.FN.CombineType.COMPOSE, root, share)
    return [square, one, law]


def matrix(a):
    a = a.tocsr().sorted_indices()
    return PETSc.Mat().createAIJ(a.shape, csr=(a.indptr.astype("i4"), a.indices.astype("i4"), a.data.astype(complex)))


def by_slepc(kind, terms):
    """Eigenvalues of the band, rad/s."""
    low, high = 2 * math.pi * LOW, 2 * math.pi * HIGH
    unit, nep = (low + high) / 2, SLEPc.NEP().create()
    largest = abs(terms[1]).max()
    nep.setSplitOperator([matrix(a / largest) for a in terms], functions(kind, unit), PETSc.Mat.Structure.DIFFERENT)
    nep.setType(SLEPc.NEP.Type.NLEIGS)
    region = nep.getRG()
    region.setType(SLEPc.RG.Type.INTERVAL)
    region.setIntervalEndpoints(-GROWTH * high / unit, GROWTH * high / unit, 0.9 * low / unit, 1.1 * high / unit)
    nep.setTarget(1j)
    nep.setWhichEigenpairs(SLEPc.NEP.Which.TARGET_MAGNITUDE)
    nep.setDimensions(30, 90)
    nep.setTolerances(1e-12, 100)
    for what, value in SOLVER.items():
        PETSc.Options()[f"nep_nleigs_{what}"] = value
    nep.setFromOptions()
    nep.solve()
    found = [unit * nep.getEigenpair(i) for i in range(nep.getConverged())]
    return [value for value in found if low <= value.imag <= high and abs(value.real) <= GROWTH * high]


def main():
    program = Path(sys.argv[1]).resolve()
    faults = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(SCENE)
        squeal(program, folder, "-analysis", "check", "-operators_save", "soft", "-output_dir", "soft")
        squeal(program, folder, "-analysis", "check", "-operators_save", "stiff", "-output_dir", "stiff", "-pad_young", 2 * YOUNG)
        k, h, m = (sparse(folder / f"soft/{letter}.bin") for letter in "KHM")
        terms = [m, k + MU * h, sparse(folder / "stiff/K.bin") - k]
        for kind, words in LAWS.items():
            squeal(program, folder, *words, "-output_dir", kind)
            found, others = listed(folder / kind), by_slepc(kind, terms)
            worst = farthest(found, others) if len(found) == len(others) and found else np.inf
            print(f"{kind}: {len(found)} modes, {len(others)} by SLEPc, largest relative difference {worst:.3g}, allowed {TOLERANCE:g}")
            if worst > TOLERANCE:
                faults.append(kind)
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        import petsc4py
        import slepc4py

        petsc4py.init([])
        slepc4py.init([])
        from petsc4py import PETSc
        from slepc4py import SLEPc
    except ImportError as error:
        print(f"skipped: {error}; python3-slepc4py-complex has it")
        sys.exit(77)
    if not np.issubdtype(PETSc.ScalarType, np.complexfloating):
        print("skipped: slepc4py of real numbers")
        sys.exit(77)
    sys.exit(main())
