/*
   Whether steps of a run see a history (ramp.h): a swing has two steps a cycle at least, or it would show as a slower
   one, and ten for its curve; between two steps a table is not far from the straight line of its values at both.
*/
#include "ramp.h"

static const PetscReal fewest = 2, few = 10; /* steps a cycle: refused, warned of below */
static const PetscReal unseen = 1e-2;        /* of the largest factor, by which a row may be off that line */

static PetscErrorCode SwingCheck(MPI_Comm comm, const char name[], const Ramp *ramp, PetscReal dt)
{
  const PetscReal steps = 1 / (ramp->frequency * dt);

  PetscFunctionBeginUser;
  PetscCheck(
    steps >= fewest * (1 - PETSC_SQRT_MACHINE_EPSILON), comm, PETSC_ERR_USER_INPUT,
    "-%s_frequency %.6g Hz: steps of %.6g s are %.3g a cycle, which would show it as a slower swing: give at most "
    "%.6g Hz, or a smaller -ts_dt",
    name, ramp->frequency, (double)dt, (double)steps, (double)(1 / (fewest * dt)));
  if (steps < few)
    PetscCall(
      PetscFPrintf(comm, stderr,
                   "squeal: warning: -%s_frequency %.6g Hz: steps of %.6g s are %.3g a cycle, ten show its curve: "
                   "take a smaller -ts_dt\n",
                   name, ramp->frequency, (double)dt, (double)steps));
  PetscFunctionReturn(0);
}

/* What the steps make of the time of row i */
static PetscReal BetweenSteps(const Ramp *ramp, PetscReal time, PetscReal dt)
{
  const PetscReal begin = dt * PetscFloorReal(time / dt), part = (time - begin) / dt;

  return (1 - part) * RampValue(ramp, begin) + part * RampValue(ramp, begin + dt);
}

static PetscErrorCode RowsCheck(MPI_Comm comm, const char name[], const Ramp *ramp, PetscReal dt)
{
  PetscReal largest = 0, worst = 0;
  PetscInt  at = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < ramp->n; i++) largest = PetscMax(largest, PetscAbsReal(ramp->factor[i]));
  for (PetscInt i = 1; i < ramp->n; i++) {
    const PetscReal off = PetscAbsReal(ramp->factor[i] - BetweenSteps(ramp, ramp->delay + ramp->time[i], dt));

    if (off > worst) at = i;
    worst = PetscMax(worst, off);
  }
  if (worst > unseen * largest)
    PetscCall(PetscFPrintf(
      comm, stderr,
      "squeal: warning: %s-%s_history %s has the factor %.6g at %.6g s, between two steps of %.6g s, which "
      "make %.6g of it: take a smaller -ts_dt, or a table that they can follow\n",
      ramp->warms ? "friction by " : "", name, ramp->file, (double)ramp->factor[at], (double)ramp->time[at], (double)dt,
      (double)BetweenSteps(ramp, ramp->delay + ramp->time[at], dt)));
  PetscFunctionReturn(0);
}

PetscErrorCode RampCheckSteps(MPI_Comm comm, const char name[], const Ramp *ramp, PetscReal dt)
{
  PetscFunctionBeginUser;
  if (ramp->frequency > 0) PetscCall(SwingCheck(comm, name, ramp, dt));
  if (ramp->n) PetscCall(RowsCheck(comm, name, ramp, dt));
  PetscFunctionReturn(0);
}
