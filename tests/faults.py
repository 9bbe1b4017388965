#!/usr/bin/env python3
"""Plants faults, one at a time, in a copy of the sources, and asks that the tests named beside each of them notice: a suite
that passes with a planted fault holds nothing there. Not part of the suite, since each fault compiles anew.

    faults.py FOLDER [WORD...]    the copy with its build is made in FOLDER, and used again; only faults that hold a WORD

Exit status: 0 when each fault is noticed by all the tests named, else 1."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
TOPS = ("src", "include", "tests", "scripts", "options", "meson.build", "meson_options.txt", "README.md")

# What is wrong; file, its words, the words instead; tests that notice
FAULTS = (
    ("friction has the other sign in H", "src/operators/contact/friction.c", "MatScale(WN, -1)", "MatScale(WN, 1)",
     "closed-1 preload"),
    ("pairs at the limit of friction hold as those that stick do", "src/operators/contact/friction.c", "if (!pencil->slips[p])",
     "if (row >= 0)", "static_two_contacts"),
    ("the arm of a tie turns the other way", "src/kernels/contact/arm.h", "Vec3Cross(omega, g, moved)", "Vec3Cross(g, omega, moved)",
     "tie arm-1"),
    ("a chain of ties ends after one step", "src/operators/points/dependents.c", "    if (left > 0) PetscCall(MatAXPY(o->Z",
     "    if (left > 0 && power == o->E) PetscCall(MatAXPY(o->Z", "tie"),
    ("loads on nodes that follow are lost in a reduced model", "src/reduced/bodies/ports.c",
     "    PetscCall(ReducedPortSetNodal(r, nodal, i));\n",
     """    Mat E;
    Vec q, column;
    PetscCall(ReducedPortSetNodal(r, nodal, i));
    PetscCall(OperatorsGetDependents(r->run.operators, NULL, &E));
    if (E) {
      PetscCall(MatCreateVecs(E, &q, NULL));
      PetscCall(MatDenseGetColumnVec(r->reduction.others, i, &column));
      PetscCall(MatMultTranspose(E, column, q));
      PetscCall(MatMult(E, q, column));
      PetscCall(MatDenseRestoreColumnVec(r->reduction.others, i, &column));
      PetscCall(VecDestroy(&q));
    }
""", "reduced_tie"),
    ("tied bodies give way 1e-6 more above the modes", "src/reduced/bodies/residual.c", "&r->reduction.inverse, Z, B, X));",
     "&r->reduction.inverse, Z, B, X));\n  if (Z) PetscCall(MatScale(X, 1 + 1e-6));", "reduced_tie"),
    ("tied bodies that part at the start have all their energy", "src/reduced/run/start.c", "VecDot(f, y, &product)",
     "VecDot(Mx, x, &product)", "reduced_tie"),
    ("forces on slaves of a tie do not reach supports", "src/contact/nodal.c",
     "part[e] += link->master[i].follow[3 * d + e] * force[d];", "part[e] += 0 * force[d];", "tie"),
    ("0.99 mu in the cone of dynamics", "src/kernels/contact/cone.h", ".mu = mu};", ".mu = 0.99 * mu};", "cone-1 project-1"),
    ("0.99 mu in the cone of statics", "src/kernels/contact/coulomb.h", "-slope * e[i] * law->P", "-0.99 * slope * e[i] * law->P",
     "coulomb-1 static_stick"),
    ("gap of the wrong side", "src/contact/surface/foot.c", "  return gap;\n", "  return -gap;\n", "static_motions"),
    ("mu is 1e-6 less in the step of dynamics: the balance of energy closes", "src/contact/projector/sliding.c",
     "  pair->mu = factor * FrictionSteady(&c->friction);\n",
     "  pair->mu = (1 - 1e-6) * factor * FrictionSteady(&c->friction);\n", "transient_laws"),
    ("mu is 1e-6 less in a reduced model", "src/reduced/run/pairs.c",
     "    r->motion.pairs[i].gap         = r->reduction.model.gap[i];\n",
     "    r->motion.pairs[i].gap         = r->reduction.model.gap[i];\n"
     "    FrictionScale(&r->reduction.model.friction[i], 1 - 1e-6);\n", "transient_laws"),
    ("friction drives: it has the sign of the slip", "src/kernels/contact/friction.h",
     "return square <= radius * radius ? 1 : radius / sqrt(square)",
     "return square <= radius * radius ? 1 : -radius / sqrt(square)", "transient_laws"),
    ("heat of friction that the ledger does not need, 1e-6 more", "src/contact/projector/record.c", "sums->heat += dt *",
     "sums->heat += (1 + 1e-6) * dt *", "transient_laws"),
    ("heat of friction in a reduced model, 2e-4 more", "src/reduced/step/step.c", "? -0.5 * (1 +", "? -(0.5 + 1e-4) * (1 +",
     "transient_laws"),
    ("kernels are 1e-6 too stiff, elements not", "src/dynamics/bodies/bodies.c", ".dt = step->dt,", ".dt = (1 + 1e-6) * step->dt,",
     "bodies-1"),
    ("weights on the master sum to 1 - 1e-6", "src/contact/projector/record.c", "-= pair->weight[j] * lambda[d];",
     "-= (1 - 1e-6) * pair->weight[j] * lambda[d];", "transient_laws"),
    ("a left mode is lost", "src/modes/left.c", "  PetscCall(PetscCalloc1(left->n, &used));\n",
     "  if (left->n > 3) left->n--;\n  PetscCall(PetscCalloc1(left->n, &used));\n", "massi2005_small"),
    ("inertia counts one more", "src/solver/factor/inertia.c", "omega * *omega, si, n, &n_null));\n",
     "omega * *omega, si, n, &n_null));\n    *n += 1;\n", "verification_doublets completeness"),
    ("friction on factors: entries of the inverse are taken 1e-6 too large", "src/solver/factor/capacitance.c",
     "L->entry[k].value * a[", "(1 + 1e-6) * L->entry[k].value * a[", "shiftinvert-1 shiftinvert-2"),
    ("multipliers count as modes", "src/modes/window/window.c", "*n -= window->known.massless;", "*n -= 0 * window->known.massless;",
     "singular"),
    ("lumped mass is 1 % more in the matrices than in the step", "src/operators/bodies/bodies.c", "? lumped[i / n / 3] : 0",
     "? 1.01 * lumped[i / n / 3] : 0", "transient_growth"),
    ("lumped masses of second order are equal, not the scaled diagonal", "src/model/element.c",
     "mass[3 * a * (3 * n) + 3 * a] * all / trace", "all / n", "element-1"),
    ("the ledger leaves the integrator out", "src/dynamics/history/ledger.c", "ledger->damping - ledger->integrator;",
     "ledger->damping;", "transient_bars"),
    ("left vectors are not made biorthogonal", "src/modes/left.c", "inverse[i * m + j], y", "i == j, y", "oscillator"),
    ("a sweep in full guesses which mode goes on", "src/sweep/track/step.c", "STEP_JUMP ? UNIQUE : PETSC_MAX_REAL",
     "STEP_JUMP ? UNIQUE : 0", "sweep_full"),
    ("products of a point have the damping of the next one", "src/sweep/full/follow.c", "{(PetscReal[]){0, 1}, ", "{(PetscReal[]){1, 0}, ",
     "sweep_full"),
    ("a restart loses the forces before", "src/dynamics/run/keep.c", "a[FORCE_OLD] ? n : 0, a[FORCE_OLD]",
     "0, a[FORCE_OLD]", "transient_restart-transient-1"),
    ("one nodal diameter more in labels", "src/modes/label/name.c", "family.circles, diameters,", "family.circles, diameters + 1,",
     "hat_disc"),
    ("loads are a step early", "src/dynamics/external/loadforce.c", "RampValue(&load->ramp, step->time)",
     "RampValue(&load->ramp, step->time + step->dt)", "transient_free"),
    ("motions are a step early", "src/dynamics/external/motion.c",
     "step->time);\n    const PetscReal rate   = (RampValue(&motion->ramp, step->time +",
     "step->time + step->dt);\n    const PetscReal rate = (RampValue(&motion->ramp, step->time + 2 *", "transient_free"),
    ("changes after an impulse are not counted", "src/contact/projector/record.c", "sums->changed += most > 0 ? 1 : 0;", "",
     "transient_response"),
    ("a window's damping stays in the response", "scripts/squeal/response/transform.py", "if self.window.decay:",
     "if not self.window.decay:", "response"),
    ("nu_12 stands for nu_21", "src/kernels/element/orthotropic.h", "n21 = n12 * E2 / E1,", "n21 = n12 * E1 / E2,",
     "orthotropic-1 orthotropic"),
    ("a cylinder's axes turn the wrong way", "src/model/material.c", "Vec3Cross(axis[2], axis[0], axis[1]);",
     "axis[0][1] *= -1, Vec3Cross(axis[2], axis[0], axis[1]);", "orthotropic"),
    ("the stress of the spin is lost", "src/operators/bodies/spin.c", "PetscCall(MatAXPY(S, -1, Q,",
     "PetscCall(MatZeroEntries(S));\n  PetscCall(MatAXPY(S, -1, Q,", "spin"),
    ("half of the gyroscopic term", "src/kernels/element/spin.h", "dV * (N[a] * flow[b] - N[b] * flow[a])",
     "0.5 * dV * (N[a] * flow[b] - N[b] * flow[a])", "spin-1 spin"),
    ("the gyroscopic term has the other sign", "src/kernels/element/spin.h", "dV * (N[a] * flow[b] - N[b] * flow[a])",
     "dV * (N[b] * flow[a] - N[a] * flow[b])", "spin"),
    ("residues are those of the first row, not of the blow", "scripts/squeal/response/identify.py", "numpy.outer(part, time)",
     "numpy.outer(part, time - time[0])", "response"),
    ("the time without contact is none in the verification of a reduced run", "src/reduced/run/verify.c",
     "(force[i] <= 0)", "(force[i] < 0)",
     "transient_reduced"),
    ("the critical step is 0.4 % longer", "src/dynamics/criticalstep.c", "  critical->assembled = dt;",
     "  critical->assembled = 1.004 * dt;", "transient_free"),
    ("the place of a probe that the analysis does not use is accepted", "src/model/quantities.c",
     "#define RECORDED RUN_TRANSIENT | RUN_CYCLE | RUN_FRF", "#define RECORDED RUN_MODES | RUN_TRANSIENT | RUN_CYCLE | RUN_FRF",
     "bad_probes"),
)


def copy(folder):
    """Brings the copy up to date, files that changed alone."""
    for top in TOPS:
        for path in [SOURCE / top] if (SOURCE / top).is_file() else sorted((SOURCE / top).rglob("*")):
            to = folder / path.relative_to(SOURCE)
            if path.is_file() and (not to.exists() or to.read_bytes() != path.read_bytes()):
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, to)
    if not (folder / "build").exists():
        subprocess.run(["meson", "setup", folder / "build", folder], check=True, stdout=subprocess.DEVNULL)


def failing(folder, tests):
    """Those of the tests that fail."""
    log = folder / "build/meson-logs/testlog.json"
    log.unlink(missing_ok=True)
    subprocess.run(["meson", "test", "-C", folder / "build", "--no-rebuild", "-t", "6", *tests], check=False,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    results = [json.loads(line) for line in log.read_text().splitlines()]
    return [test["name"].split(" / ")[-1] for test in results if test["result"] == "FAIL"]


def programs(tests):
    """Targets of the unit tests among the tests, whose names end in their ranks."""
    names = [test.rpartition("-")[0] for test in tests.split()]
    return [f"tests/test_{name}" for name in names if (SOURCE / f"tests/unit/test_{name}.c").exists()]


def plant(folder, fault):
    """Plants a fault, runs its tests, takes it out; whether all tests noticed."""
    what, name, words, instead, tests = fault
    path, text = folder / name, (SOURCE / name).read_text()
    if text.count(words) < 1:
        print(f"FAILED {what}: {name} does not hold {words!r}")
        return False
    path.write_text(text.replace(words, instead))
    try:
        built = subprocess.run(["ninja", "-C", folder / "build", "squeal", *programs(tests)], capture_output=True, check=False)
        noticed = failing(folder, tests.split()) if not built.returncode else []
    finally:
        path.write_text(text)
    missed = sorted(set(tests.split()) - set(noticed))
    print(f"{'FAILED' if missed else 'ok'} {what}: noticed by {' '.join(noticed) or 'none'}"
          f"{', not by ' + ' '.join(missed) if missed else ''}{' (does not compile)' if built.returncode else ''}", flush=True)
    return not missed


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder, words = Path(sys.argv[1]).resolve(), sys.argv[2:]
    chosen = [fault for fault in FAULTS if not words or any(word in fault[0] for word in words)]
    copy(folder)
    return 0 if chosen and all([plant(folder, fault) for fault in chosen]) else 1


if __name__ == "__main__":
    sys.exit(main())
