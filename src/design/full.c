/* Designs in full, and what they weigh */
#include "designimpl.h"
#include "sample/draw/sequence.h"

PetscErrorCode DesignFull(Design d, const PetscReal z[], const PetscReal t[], DesignCorner *corner)
{
  const ModesLimit in_force = ModesLimitInForce(&d->box.limit);
  BoxFull          full;
  PetscReal       *p;

  PetscFunctionBeginUser;
  *corner = (DesignCorner){.excess = PETSC_NINFINITY, .sigma = NAN, .omega = NAN, .error = NAN};
  PetscCall(PetscArraycpy(corner->t, t, d->uncertain.n));
  PetscCall(PetscMalloc1(d->cube.n_parameters, &p));
  DesignParameters(d, z, t, p);
  PetscCall(BoxSolveFull(&d->box, p, &full));
  corner->n_modes  = full.n;
  corner->n_closed = full.n_closed;
  for (PetscInt i = 0; i < full.n; i++) {
    const Mode     *mode   = &full.mode[i];
    const PetscReal excess = mode->sigma - ModesLimitGrowth(&in_force, hypot(mode->sigma, mode->omega));

    if (mode->rigid) continue;
    corner->n_unstable += ModesLimitJudge(&d->box.limit, mode->sigma, mode->omega, mode->error) == MODE_UNSTABLE;
    if (excess <= corner->excess) continue;
    corner->excess = excess;
    corner->sigma = mode->sigma, corner->omega = mode->omega, corner->error = mode->error;
  }
  d->n_full++;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Corners of the uncertain box, spread evenly over all of them; where there are fewer, points inside behind them */
PetscErrorCode DesignCorners(Design d, DesignCorner *unstable)
{
  const DesignPoint *best = &d->point[d->best];
  const PetscInt     n = d->uncertain.n, n_all = n ? 1 << n : 0;
  Sequence           sequence = {SEQUENCE_RANDOM, 1, PetscMax(1, d->n_corners), PetscMax(1, n), NULL};
  PetscReal          t[CUBE_MAX_VARIABLES];

  PetscFunctionBeginUser;
  unstable->n_unstable = 0;
  if (!n) d->n_corners = 0;
  PetscCall(PetscCalloc1(d->n_corners, &d->corner));
  PetscCall(SequenceSetUp(&sequence));
  for (PetscInt i = 0; i < d->n_corners && !unstable->n_unstable; i++) {
    const PetscInt which = d->n_corners >= n_all ? i : (PetscInt)(((int64_t)i * n_all) / d->n_corners);

    SequencePoint(&sequence, i, t);
    for (PetscInt k = 0; k < n; k++) t[k] = i >= n_all ? 2 * t[k] - 1 : which >> k & 1 ? 1 : -1;
    PetscCall(DesignFull(d, best->z, t, &d->corner[i]));
    if (d->probability == 0 && d->corner[i].n_unstable) *unstable = d->corner[i];
  }
  PetscCall(SequenceDestroy(&sequence));
  PetscFunctionReturn(0);
}

/* Of rigid motions along all three axes at once e: e' M e is three times the mass, of the unknowns that move */
PetscErrorCode DesignMass(Design d)
{
  const OperatorsTerm *term;
  PetscInt             n;
  PetscReal           *slope;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(d->box.pencil, &n, &term));
  PetscCall(PetscCalloc1(d->cube.n_parameters, &slope));
  d->mass = 0;
  for (PetscInt t = 0; t < n; t++) {
    Vec         one, M_one;
    PetscScalar product;

    if (term[t].kind != OPERATORS_MASS) continue;
    PetscCall(MatCreateVecs(term[t].A, &one, &M_one));
    PetscCall(VecSet(one, 1));
    PetscCall(MatMult(term[t].A, one, M_one));
    PetscCall(VecDot(one, M_one, &product));
    PetscCall(VecDestroy(&one));
    PetscCall(VecDestroy(&M_one));
    d->mass += OperatorsTermCoefficient(&term[t], d->box.nominal) * product / 3;
    for (PetscInt i = 0; i < d->cube.n_parameters; i++)
      slope[i] += OperatorsTermDerivative(&term[t], d->box.nominal, i) * product / 3;
  }
  for (PetscInt k = 0; k < d->cube.n; k++) {
    d->mass_slope[k] = 0;
    for (PetscInt m = 0; m < d->cube.n_moved[k] && d->mass > 0; m++)
      d->mass_slope[k] += slope[d->cube.moved[k][m]] * 0.5 * (d->cube.upper[k][m] - d->cube.lower[k][m]) / d->mass;
  }
  PetscCall(PetscFree(slope));
  PetscFunctionReturn(0);
}
