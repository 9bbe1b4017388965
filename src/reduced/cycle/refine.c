/*
   The errors of a cycle, by the same one with other steps: twice as many, and as many that begin elsewhere.

   Steps in which pairs open and close are off by where in the step that happens, so that the cycle of N steps, its
   period above all, depends on where in the motion the steps lie: x(theta), T(theta), theta the shift in time, with the
   period T / N in theta (cycle.h). The spread is found from two further places, a third of a step apart, which no part
   that goes as cos(2 pi theta N / T) can hide from.
*/
#include "cycleimpl.h"

#define REFINE_PLACES 3 /* in a step, that of the cycle among them */

static void SpreadGrow(PetscReal found, PetscReal other, PetscReal *spread)
{
  *spread = PetscMax(*spread, PetscAbsReal(other - found));
}

/* A cycle whose steps begin elsewhere, in numbers */
static PetscErrorCode CycleAddSpread(LimitCycle c, const ShootingCycle *other, CyclePoint *p)
{
  CycleMeasure      measure;
  ShootingStability stability;
  CycleProbe       *probe;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->flow.n_looked, &probe));
  PetscCall(CycleFlowMeasure(&c->flow, other, &measure, probe));
  PetscCall(ShootingGetStability(&c->shooting, other, &stability));
  SpreadGrow(p->found.freq, measure.freq, &p->spread.freq);
  SpreadGrow(p->found.rms, measure.rms, &p->spread.rms);
  SpreadGrow(p->found.peak, measure.peak, &p->spread.peak);
  SpreadGrow(CycleMultiplier(&p->stability), CycleMultiplier(&stability), &p->multiplier_spread);
  for (PetscInt i = 0; i < c->flow.n_looked; i++) {
    const CycleProbe *a = &p->probe[i], *b = &probe[i];
    CycleProbe       *spread = &p->spread_probe[i];

    SpreadGrow(a->displacement_rms, b->displacement_rms, &spread->displacement_rms);
    SpreadGrow(a->displacement_peak, b->displacement_peak, &spread->displacement_peak);
    SpreadGrow(a->velocity_rms, b->velocity_rms, &spread->velocity_rms);
    SpreadGrow(a->velocity_peak, b->velocity_peak, &spread->velocity_peak);
  }
  PetscCall(PetscFree(probe));
  PetscFunctionReturn(0);
}

/* The cycle `at`, begun `share` of a step later: one step of that length from its start. */
static PetscErrorCode CycleShift(LimitCycle c, PetscReal share, const ShootingCycle *at, ShootingCycle *shifted)
{
  const PetscInt steps = c->flow.n_steps;

  PetscFunctionBeginUser;
  PetscCall(ShootingCopy(c->flow.n, at, shifted));
  c->flow.n_steps = 1;
  PetscCall(CycleFlowRun(&c->flow, at->x, share * at->period / (PetscReal)steps, at->value, shifted->x, NULL));
  c->flow.n_steps = steps;
  PetscFunctionReturn(0);
}

static PetscErrorCode CycleSolveAgain(LimitCycle c, const ShootingTangent *along, ShootingCycle *cycle)
{
  PetscFunctionBeginUser;
  cycle->converged = PETSC_FALSE;
  if (PetscIsInfOrNanReal(cycle->x[0])) PetscFunctionReturn(0);
  if (along)
    PetscCall(ShootingAdvance(&c->shooting, 0, along, cycle));
  else
    PetscCall(ShootingSolve(&c->shooting, cycle));
  PetscFunctionReturn(0);
}

/* Steps that begin elsewhere; has_finer is lost where there is no such cycle */
static PetscErrorCode CycleSpread(LimitCycle c, const ShootingCycle *at, const ShootingTangent *along, CyclePoint *p,
                                  ShootingCycle *other)
{
  PetscReal value = 0;

  PetscFunctionBeginUser;
  for (int k = 1; k < REFINE_PLACES && p->has_finer; k++) {
    PetscCall(CycleShift(c, (PetscReal)k / REFINE_PLACES, at, other));
    PetscCall(CycleSolveAgain(c, along, other));
    p->has_finer = other->converged;
    if (!other->converged) continue;
    PetscCall(CycleAddSpread(c, other, p));
    SpreadGrow(at->value, other->value, &value);
  }
  if (along) p->value_error += value;
  PetscFunctionReturn(0);
}

/* 2 N + 1 steps, odd as N is. value_error adds up what the steps, their place and the cut-off each make of a fold's
   parameter. */
PetscErrorCode CycleRefine(LimitCycle c, const ShootingCycle *at, const ShootingTangent *along, CyclePoint *point)
{
  const PetscInt n = c->flow.n, steps = c->flow.n_steps;
  ShootingCycle  other;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &other.x, n * n, &other.M));
  PetscCall(ShootingCopy(n, at, &other));
  c->flow.n_steps = 2 * steps + 1;
  PetscCall(CycleSolveAgain(c, along, &other));
  point->has_finer = other.converged;
  if (other.converged) {
    PetscCall(CycleListen(c));
    PetscCall(CycleFlowMeasure(&c->flow, &other, &point->finer, point->finer_probe));
    PetscCall(CycleHear(c, other.period, c->reduced->request.cutoff, &point->finer_sound));
    PetscCall(ShootingGetStability(&c->shooting, &other, &point->finer_stability));
    if (along) point->value_error += CycleError(at->value, other.value, 0);
  }
  c->flow.n_steps = steps;
  PetscCall(CycleSpread(c, at, along, point, &other));
  PetscCall(PetscFree2(other.x, other.M));
  PetscFunctionReturn(0);
}
