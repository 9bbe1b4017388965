/*
   The error of a run after it, on request: the same run with half the step, and with 2.25 times the cut-off, whose
   normal forces f' at the times of the steps are put beside those of the run, f. Where an instability has grown into a
   cycle, phases drift and the difference says little; then the level of the vibration and the time without contact are
   the answer. Where the cycle does not repeat itself these scatter: a standard error is told from equal pieces of the
   time, of both runs together.
*/
#include "reduced/reducedimpl.h"

/* Of the last half of the time: few, since each must be longer than what the motion remembers; eight still tell a
   standard error to a quarter. */
#define PIECES       8
#define VERIFY_MOST  0.1  /* of the rms, and of the time: what a run may be off by, beyond twice the standard errors */
#define VERIFY_SMALL 1e-3 /* of the largest force: a vibration whose rms nobody asks for */

PetscErrorCode ReducedKeepForce(ReducedRun r)
{
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) sum += r->motion.state.p[3 * i];
  if (r->result.n_force % 1024 == 0)
    PetscCall(PetscRealloc((size_t)(r->result.n_force + 1024) * sizeof(PetscReal), &r->result.force));
  r->result.force[r->result.n_force++] = sum;
  PetscFunctionReturn(0);
}

/* The run with another cut-off and step, n steps of which every `every`-th is kept */
static PetscErrorCode VerifyRun(ReducedRun r, PetscReal cutoff, PetscInt every, ReducedRun *other)
{
  ReducedDrive drive;
  ReducedRun   o;

  PetscFunctionBeginUser;
  PetscCall(ReducedReduceAt(r, cutoff, r->request.p, NULL, other));
  o            = *other;
  o->motion.dt = r->motion.dt / (PetscReal)every;
  PetscCall(ReducedStart(o));
  PetscCall(ReducedStepperCreate(&o->reduction.model, o->motion.dt, REDUCED_RTOL, &o->motion.stepper));
  for (PetscInt i = 1; i <= every * r->result.n_force; i++) {
    PetscCall(ReducedDriveSet(o, &drive));
    PetscCall(ReducedStep(o->motion.stepper, &drive, &o->motion.state, &o->motion.report));
    if (i % every == 0) PetscCall(ReducedKeepForce(o));
  }
  PetscFunctionReturn(0);
}

/* Rms of n forces about their mean, and the share of them that vanishes */
static void ForceMeasure(PetscInt n, const PetscReal force[], PetscReal *rms, PetscReal *open)
{
  PetscReal mean = 0;

  *rms = *open = 0;
  for (PetscInt i = 0; i < n; i++) mean += force[i] / (PetscReal)n;
  for (PetscInt i = 0; i < n; i++) {
    *rms += PetscSqr(force[i] - mean) / (PetscReal)n;
    *open += (force[i] <= 0) / (PetscReal)n;
  }
  *rms = PetscSqrtReal(*rms);
}

/* Standard errors of both over the n forces, were their pieces independent: sqrt(sum (value_i - mean)^2 / (k (k -
   1))), k = PIECES. */
static void ForceScatter(PetscInt n, const PetscReal force[], PetscReal *rms, PetscReal *open)
{
  const PetscInt length = n / PIECES;
  PetscReal      value[2][PIECES], error[2];

  for (PetscInt i = 0; i < PIECES; i++) ForceMeasure(length, &force[i * length], &value[0][i], &value[1][i]);
  for (int k = 0; k < 2; k++) {
    PetscReal mean = 0, square = 0;

    for (int i = 0; i < PIECES; i++) mean += value[k][i] / PIECES;
    for (int i = 0; i < PIECES; i++) square += PetscSqr(value[k][i] - mean);
    error[k] = PetscSqrtReal(square / (PIECES * (PIECES - 1)));
  }
  *rms  = error[0];
  *open = error[1];
}

/* Differences of the force at the same times: rms over that of the run, largest over the largest; and of level and
   open time in the last half, with their standard errors, of both runs together. */
static PetscErrorCode VerifyOne(ReducedRun r, PetscReal cutoff, PetscInt every, ReducedDifference *d)
{
  const PetscInt n = r->result.n_force, half = n / 2;
  PetscReal      rms[3], open[3], error[2][2], largest = 0, miss = 0, square = 0;
  ReducedRun     other;

  PetscFunctionBeginUser;
  PetscCall(VerifyRun(r, cutoff, every, &other));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal difference = other->result.force[i] - r->result.force[i];

    largest = PetscMax(largest, PetscAbsReal(r->result.force[i]));
    miss    = PetscMax(miss, PetscAbsReal(difference));
    square += difference * difference / (PetscReal)n;
  }
  ForceMeasure(n, r->result.force, &rms[0], &open[0]);
  ForceMeasure(n - half, &r->result.force[half], &rms[1], &open[1]);
  ForceMeasure(n - half, &other->result.force[half], &rms[2], &open[2]);
  ForceScatter(n - half, &r->result.force[half], &error[0][0], &error[0][1]);
  ForceScatter(n - half, &other->result.force[half], &error[1][0], &error[1][1]);
  *d = (ReducedDifference){.cutoff      = cutoff,
                           .dt          = r->motion.dt / (PetscReal)every,
                           .rms         = rms[0] > 0 ? PetscSqrtReal(square) / rms[0] : 0,
                           .largest     = largest > 0 ? miss / largest : 0,
                           .level       = rms[1] > 0 ? rms[2] / rms[1] - 1 : 0,
                           .open        = open[2] - open[1],
                           .loud        = PetscMax(rms[1], rms[2]) > VERIFY_SMALL * largest ? PETSC_TRUE : PETSC_FALSE,
                           .level_error = rms[1] > 0 ? hypot(error[0][0], error[1][0]) / rms[1] : 0,
                           .open_error  = hypot(error[0][1], error[1][1])};
  PetscCall(ReducedDestroy(&other));
  PetscFunctionReturn(0);
}

/* Whether the level of the vibration, or the time without contact, is another one */
static PetscBool VerifyIsOff(const ReducedDifference *d)
{
  return (d->loud && PetscAbsReal(d->level) > VERIFY_MOST + 2 * d->level_error) ||
             PetscAbsReal(d->open) > VERIFY_MOST + 2 * d->open_error
           ? PETSC_TRUE
           : PETSC_FALSE;
}

PetscErrorCode ReducedJudgeVerified(ReducedRun r)
{
  static const char *const more[2] = {"take a smaller -ts_dt", "take a higher -dynamics_cutoff"};
  const ReducedDifference *both[2] = {&r->result.finer, &r->result.higher};

  PetscFunctionBeginUser;
  for (int i = 0; i < 2 && r->request.verify && r->result.n_force; i++)
    PetscCheck(!VerifyIsOff(both[i]), r->comm, PETSC_ERR_NOT_CONVERGED,
               "-dynamics_verify: with steps of %.6g s below %.6g Hz the rms of the normal force is another one by "
               "%+.2g %% +- %.2g %%, and the time without contact by %+.2g %% +- %.2g %%, must be %.3g %% at most: %s",
               (double)both[i]->dt, (double)both[i]->cutoff, 100 * (double)both[i]->level,
               100 * (double)both[i]->level_error, 100 * (double)both[i]->open, 100 * (double)both[i]->open_error,
               100 * VERIFY_MOST, more[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedVerify(ReducedRun r)
{
  PetscFunctionBeginUser;
  if (!r->result.n_force) PetscFunctionReturn(0);
  PetscCall(VerifyOne(r, r->request.cutoff, 2, &r->result.finer));
  PetscCall(VerifyOne(r, REDUCED_HIGHER * r->request.cutoff, 1, &r->result.higher));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedVerifyView(ReducedRun r, PetscViewer viewer)
{
  const ReducedDifference *both[2] = {&r->result.finer, &r->result.higher};

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    const ReducedDifference *d = both[i];

    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "once more with steps of %.6g s below %.6g Hz: normal force off by %.2e of its "
                                     "rms, %.2e of its largest value at most; in "
                                     "the last half of the time its rms by %+.2e +- %.1e, the time without contact by "
                                     "%+.2e +- %.1e\n",
                                     (double)d->dt, (double)d->cutoff, (double)d->rms, (double)d->largest,
                                     (double)d->level, (double)d->level_error, (double)d->open, (double)d->open_error));
  }
  PetscFunctionReturn(0);
}
