/* A cycle in numbers, from a period that the flow integrates once more: its normal force, and what probes do */
#include "cycleimpl.h"

/* The largest of n values, `stride` apart, of a period: sign (f - mean), by the parabola through three steps, whose
   top lies (after - before)^2 / (-8 bend) above the middle one. */
static PetscReal PeriodLargest(PetscInt n, PetscInt stride, const PetscReal f[], PetscReal sign, PetscReal mean)
{
  PetscReal largest = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal before = sign * (f[stride * ((k + n - 1) % n)] - mean), here = sign * (f[stride * k] - mean);
    const PetscReal after = sign * (f[stride * ((k + 1) % n)] - mean), bend = before - 2 * here + after;

    if (here < before || here < after) continue;
    largest = PetscMax(largest, here - (bend < 0 ? PetscSqr(after - before) / (8 * bend) : 0));
  }
  return largest;
}

/* Mean, and rms about it */
static PetscReal PeriodRms(PetscInt n, PetscInt stride, const PetscReal f[], PetscReal *mean)
{
  PetscReal square = 0;

  *mean = 0;
  for (PetscInt k = 0; k < n; k++) *mean += f[stride * k] / (PetscReal)n;
  for (PetscInt k = 0; k < n; k++) square += PetscSqr(f[stride * k] - *mean) / (PetscReal)n;
  return PetscSqrtReal(square);
}

static void PeriodMeasure(const CycleFlow *f, PetscReal period, CycleMeasure *m)
{
  *m      = (CycleMeasure){.freq = 1 / period, .least = f->force[0]};
  m->rms  = PeriodRms(f->n_steps, 1, f->force, &m->mean);
  m->peak = PeriodLargest(f->n_steps, 1, f->force, 1, 0);
  m->made = ReducedContactFeeds(f->contact, PetscAbsReal(f->friction));
  for (PetscInt k = 0; k < f->n_steps; k++) {
    m->least = PetscMin(m->least, f->force[k]);
    m->open += (f->force[k] <= 0) / (PetscReal)f->n_steps;
  }
}

/* Adds the rate of the residual to the velocities, a central difference over the period, and takes a drift along a
   free direction (mean velocity times time) out of the displacements u, at the port whose values begin there. */
static void PortComplete(const CycleFlow *f, PetscReal u[])
{
  const PetscInt n = f->n_steps, stride = 3 * f->n_looked;
  PetscReal     *residual = u + f->n_looked, *v = residual + f->n_looked, drift = 0;

  for (PetscInt k = 0; k < n; k++)
    v[stride * k] += (residual[stride * ((k + 1) % n)] - residual[stride * ((k + n - 1) % n)]) / (2 * f->dt);
  for (PetscInt k = 0; k < n; k++) drift += v[stride * k] / (PetscReal)n;
  for (PetscInt k = 0; k < n; k++) u[stride * k] -= drift * f->dt * (PetscReal)k;
}

static void PortMeasure(const CycleFlow *f, PetscReal u[], CycleProbe *probe)
{
  const PetscInt   n = f->n_steps, stride = 3 * f->n_looked;
  const PetscReal *v = u + 2 * f->n_looked;
  PetscReal        mean;

  PortComplete(f, u);
  probe->displacement_rms  = PeriodRms(n, stride, u, &mean);
  probe->displacement_peak = PetscMax(PeriodLargest(n, stride, u, 1, mean), PeriodLargest(n, stride, u, -1, mean));
  probe->velocity_rms      = PeriodRms(n, stride, v, &mean);
  probe->velocity_peak     = PetscMax(PeriodLargest(n, stride, v, 1, mean), PeriodLargest(n, stride, v, -1, mean));
}

/* Displacements of probes are P eta + W q + W loads (m), velocities P rate, completed by PortComplete(); force
   [steps] is kept for this one period. */
PetscErrorCode CycleFlowMeasure(CycleFlow *f, const ShootingCycle *cycle, CycleMeasure *measure, CycleProbe probe[])
{
  const size_t steps = (size_t)f->n_steps;
  PetscReal   *y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->n, &y));
  PetscCall(PetscMalloc2(steps, &f->force, steps * 3 * (size_t)f->n_looked, &f->shown));
  f->contact = f->friction = 0;
  PetscCall(CycleFlowRun(f, cycle->x, cycle->period, cycle->value, y, NULL));
  PetscCheck(!PetscIsInfOrNanReal(y[0]), PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             CYCLE_BY ": a cycle of %.6g Hz was found, but the contact laws have no solution when it is run once more: "
                      "take more -cycle_steps",
             1 / (double)cycle->period);
  PeriodMeasure(f, cycle->period, measure);
  for (PetscInt i = 0; i < f->n_looked && probe; i++) PortMeasure(f, &f->shown[i], &probe[i]);
  PetscCall(PetscFree2(f->force, f->shown));
  PetscCall(PetscFree(y));
  PetscFunctionReturn(0);
}
