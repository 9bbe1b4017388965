/*
   The flow of the reduced model through a period: N steps of length T / N from the state x = (eta, rate, lambda, q), and its
   derivative M, the product of those of the steps (steptangent.c).
*/
#include "cycleimpl.h"

#define FLOW_FAR 1e3 /* s, when ramps are over */

/* Loads and sliding at the end of the run; raises the error where they go on to change */
static PetscErrorCode FlowSetDrive(ReducedRun r, CycleFlow *f)
{
  const PetscReal   now = r->state.time;
  const ModelScene *scene;
  PetscReal        *later, way;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(PetscCalloc1(r->model.n_loads, &later));
  ReducedSetLoads(r, now, f->loads);
  ReducedSetLoads(r, now + FLOW_FAR, later);
  for (PetscInt i = 0; i < r->model.n_loads; i++)
    PetscCheck(f->loads[i] == later[i], r->comm, PETSC_ERR_USER_INPUT,
               "-analysis cycle: load %s still changes when the transient ends at %.6g s: take a longer "
               "-ts_max_time, or a shorter ramp",
               scene->loads[i].name, (double)now);
  PetscCall(PetscFree(later));
  for (PetscInt i = 0; i < r->model.n_pairs; i++) {
    PetscCall(ReducedGetWay(r, i, &f->speed[i]));
    r->state.time = now + FLOW_FAR;
    PetscCall(ReducedGetWay(r, i, &way));
    r->state.time = now;
    PetscCheck(PetscAbsReal(way - f->speed[i]) <= 1e-6 * PetscAbsReal(way), r->comm, PETSC_ERR_USER_INPUT,
               "-analysis cycle: the sliding still changes when the transient ends at %.6g s: take a longer "
               "-ts_max_time, or a shorter ramp",
               (double)now);
    f->speed[i] /= r->dt;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowCreate(ReducedRun r, CycleFlow *f)
{
  PetscFunctionBeginUser;
  *f = (CycleFlow){.model = &r->model, .n = ReducedTangentSize(&r->model), .span = 1};
  PetscCall(PetscCalloc3(r->model.n_loads, &f->loads, r->model.n_pairs, &f->speed, r->model.n_pairs, &f->way));
  PetscCall(ReducedStateCreate(f->model, &f->state));
  PetscCall(ReducedReportCreate(f->model, &f->report));
  PetscCall(FlowSetDrive(r, f));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowSetSteps(CycleFlow *f, PetscInt n_steps)
{
  PetscFunctionBeginUser;
  f->n_steps = n_steps;
  PetscCall(PetscFree(f->force));
  PetscCall(PetscMalloc1(n_steps, &f->force));
  PetscFunctionReturn(0);
}

void CycleFlowPack(const CycleFlow *f, const ReducedState *s, PetscReal x[])
{
  const PetscInt m = f->model->m, n = 3 * f->model->n_pairs;

  for (PetscInt i = 0; i < m; i++) {
    x[i]     = s->eta[i];
    x[m + i] = s->rate[i];
  }
  for (PetscInt i = 0; i < n; i++) {
    x[2 * m + i] = s->p[i];
    if (f->model->Cx) x[2 * m + n + i] = s->q[i];
  }
}

/* The state that x stands for; y follows from it */
static void FlowUnpack(CycleFlow *f, const PetscReal x[])
{
  const ReducedModel *model = f->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs, N = model->n_ports;
  ReducedState       *s = &f->state;

  for (PetscInt i = 0; i < m; i++) {
    s->eta[i]  = x[i];
    s->rate[i] = x[m + i];
  }
  for (PetscInt i = 0; i < n; i++) {
    s->p[i] = x[2 * m + i];
    s->q[i] = model->Cx ? x[2 * m + n + i] : s->p[i];
    s->y[i] = 0;
  }
  for (PetscInt i = 0; i < model->n_loads; i++) s->p[n + i] = f->loads[i];
  for (PetscInt i = 0; i < N; i++) s->last[i] = s->p[i];
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_TRUE, 1, s->eta, s->y);
  ReducedBlockTimes(&(DenseBlock){model->W, n, n, N}, PETSC_FALSE, 1, s->q, s->y);
  ReducedBlockTimes(&(DenseBlock){&model->W[N * n], n, model->n_loads, N}, PETSC_FALSE, 1, f->loads, s->y);
}

static PetscErrorCode FlowForget(CycleFlow *f)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedTangentDestroy(&f->tangent));
  PetscCall(ReducedStepperDestroy(&f->stepper));
  PetscFunctionReturn(0);
}

/* Stepper for the period, its friction for the parameter */
static PetscErrorCode FlowPrepare(CycleFlow *f, PetscReal period, PetscReal value, PetscBool tangent)
{
  const PetscReal dt      = period / (PetscReal)f->n_steps;
  PetscBool       changed = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < f->model->n_pairs && f->varies; i++) {
    if (!f->varies[i] || f->model->mu[i] == value) continue;
    f->model->mu[i] = value;
    changed         = PETSC_TRUE;
  }
  if (f->stepper && f->dt != dt) PetscCall(FlowForget(f));
  if (!f->stepper) {
    PetscCall(ReducedStepperCreate(f->model, dt, REDUCED_RTOL, &f->stepper));
    f->dt = dt;
  } else if (changed && f->stepper->laws) {
    PetscCall(ContactComplianceSetFriction(f->stepper->laws,
                                           &(ComplianceFriction){f->model->mu, f->model->slope, f->model->speed, dt}));
  }
  if (tangent && !f->tangent) PetscCall(ReducedTangentCreate(f->stepper, &f->tangent));
  for (PetscInt i = 0; i < f->model->n_pairs; i++) f->way[i] = f->speed[i] * dt;
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowRun(void *ctx, const PetscReal x[], PetscReal period, PetscReal value, PetscReal y[],
                            PetscReal M[])
{
  CycleFlow         *f     = ctx;
  const ReducedDrive drive = {f->loads, f->way, NULL};

  PetscFunctionBeginUser;
  PetscCall(FlowPrepare(f, period, value, M ? PETSC_TRUE : PETSC_FALSE));
  FlowUnpack(f, x);
  f->n_flows++;
  if (M) PetscCall(PetscArrayzero(M, f->n * f->n));
  for (PetscInt i = 0; i < f->n && M; i++) M[i + f->n * i] = 1;
  for (PetscInt k = 0; k < f->n_steps; k++) {
    PetscCall(ReducedStep(f->stepper, &drive, &f->state, &f->report));
    if (M) PetscCall(ReducedTangentApply(f->tangent, f->n, M));
    f->force[k] = 0;
    for (PetscInt i = 0; i < f->model->n_pairs; i++) f->force[k] += f->state.p[3 * i];
  }
  CycleFlowPack(f, &f->state, y);
  PetscFunctionReturn(0);
}

/* The largest force, by the parabola through three steps; 0 where all is open */
static PetscReal FlowPeak(const CycleFlow *f)
{
  const PetscInt n    = f->n_steps;
  PetscReal      peak = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal before = f->force[(k + n - 1) % n], here = f->force[k], after = f->force[(k + 1) % n];
    const PetscReal bend = before - 2 * here + after;

    if (here < before || here < after) continue;
    peak = PetscMax(peak, here - (bend < 0 ? PetscSqr(after - before) / (8 * bend) : 0));
  }
  return peak;
}

void CycleFlowMeasure(const CycleFlow *f, PetscReal period, CycleMeasure *m)
{
  const PetscReal n = (PetscReal)f->n_steps;

  *m = (CycleMeasure){.freq = 1 / period, .peak = FlowPeak(f), .least = f->force[0]};
  for (PetscInt k = 0; k < f->n_steps; k++) {
    m->mean += f->force[k] / n;
    m->least = PetscMin(m->least, f->force[k]);
    m->open += (f->force[k] <= 0) / n;
  }
  for (PetscInt k = 0; k < f->n_steps; k++) m->rms += PetscSqr(f->force[k] - m->mean) / n;
  m->rms = PetscSqrtReal(m->rms);
}

PetscErrorCode CycleFlowDestroy(CycleFlow *f)
{
  PetscFunctionBeginUser;
  if (!f->model) PetscFunctionReturn(0);
  PetscCall(FlowForget(f));
  PetscCall(ReducedStateDestroy(&f->state));
  PetscCall(ReducedReportDestroy(&f->report));
  PetscCall(PetscFree3(f->loads, f->speed, f->way));
  PetscCall(PetscFree(f->varies));
  PetscCall(PetscFree(f->force));
  PetscFunctionReturn(0);
}
