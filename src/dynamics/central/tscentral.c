/*
   TS of type "central", see tscentral.h. The type knows no physics: forces and constraint are callbacks. It is
   Newmark's family with beta = 0 and gamma = b (N. M. Newmark, J. Eng. Mech. Div. ASCE 85, 1959), written with the
   velocities of the half steps.
*/
#include "base/algebra/versions.h"
#include "tscentral.h"
#include "base/events.h"
#include <squeal/quantity.h>
#include <petsc/private/tsimpl.h>

typedef struct {
  PetscReal    b;          /* 1/2 to 1 */
  CentralForce force;      /* fills the forces */
  CentralForce constraint; /* adds those of the constraint, or NULL */
  void        *ctx;        /* of both */
  PetscReal    dt_old;     /* of the last step, 0 before the first */
  Vec          minv;       /* inverse masses */
  Vec          f, f_old;   /* forces of this step and the last; f_old NULL for b = 1/2 */
} TS_Central;

/* kick and kick_old (s) of the step. Where the length of steps changes, velocities of half steps are `mean` =
   (dt_old + dt) / 2 apart. The first step goes half the way, dt / 2, from v_0 to v_{1/2}; it has no f before. */
static PetscErrorCode CentralDescribe(TS ts, CentralStep *step)
{
  const TS_Central *c     = (TS_Central *)ts->data;
  const PetscBool   first = c->dt_old == 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal   mean  = 0.5 * (c->dt_old + ts->time_step); /* between the middles of the two steps */

  PetscFunctionBegin;
  step->u        = ts->vec_sol;
  step->v        = ts->vec_dot;
  step->time     = ts->ptime;
  step->dt       = ts->time_step;
  step->dt_old   = c->dt_old;
  step->kick     = first ? 0.5 * step->dt : (0.5 + c->b) * mean;
  step->kick_old = first ? 0 : (0.5 - c->b) * mean;
  PetscFunctionReturn(0);
}

/* f_n with the forces of the constraint; f_{n-1} is kept where the scheme needs it, by exchange of the two vectors.
   When force() is called f still holds what was f_{n-2}, which completes the work of the integrator (forces.c). */
static PetscErrorCode CentralComputeForces(TS ts, CentralStep *step)
{
  TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  if (c->f_old && c->dt_old > 0) {
    Vec last = c->f;

    c->f     = c->f_old;
    c->f_old = last;
  }
  step->f     = c->f;
  step->f_old = c->f_old;
  PetscCall((*c->force)(ts, step, c->ctx));
  if (c->constraint) PetscCall((*c->constraint)(ts, step, c->ctx));
  PetscFunctionReturn(0);
}

/* Numbers of a step; f_old NULL for b = 1/2 */
typedef struct {
  PetscInt           n;
  const PetscScalar *minv, *f, *f_old;
  PetscScalar       *v, *u;
} CentralArrays;

/* v += kick minv f, u += dt v: one pass over memory, three vectors read and two written. Held directions have minv
   = 0 and the velocity that force() gives them. */
static VERSIONS void KickAndDrift(PetscInt n, const CentralStep *step, const PetscScalar *restrict minv,
                                  const PetscScalar *restrict f, PetscScalar *restrict v, PetscScalar *restrict u)
{
  const PetscReal kick = step->kick, dt = step->dt;

  for (PetscInt i = 0; i < n; i++) {
    v[i] += kick * minv[i] * f[i];
    u[i] += dt * v[i];
  }
}

/* v += minv (kick f + kick_old f_old), u += dt v, for b > 1/2 */
static VERSIONS void KickAndDriftTwo(const CentralStep *step, const CentralArrays *a)
{
  const PetscReal kick = step->kick, kick_old = step->kick_old, dt = step->dt;
  const PetscScalar *restrict minv = a->minv, *restrict f = a->f, *restrict f_old = a->f_old;
  PetscScalar *restrict v = a->v, *restrict u = a->u;

  for (PetscInt i = 0; i < a->n; i++) {
    v[i] += minv[i] * (kick * f[i] + kick_old * f_old[i]);
    u[i] += dt * v[i];
  }
}

static PetscErrorCode CentralMove(TS ts, const CentralStep *step)
{
  TS_Central   *c = (TS_Central *)ts->data;
  CentralArrays a = {.f_old = NULL};

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(step->u, &a.n));
  PetscCall(VecGetArrayRead(c->minv, &a.minv));
  PetscCall(VecGetArrayRead(step->f, &a.f));
  if (step->f_old) PetscCall(VecGetArrayRead(step->f_old, &a.f_old));
  PetscCall(VecGetArray(step->v, &a.v));
  PetscCall(VecGetArray(step->u, &a.u));
  if (a.f_old)
    KickAndDriftTwo(step, &a);
  else
    KickAndDrift(a.n, step, a.minv, a.f, a.v, a.u);
  PetscCall(PetscLogFlops((a.f_old ? 7.0 : 5.0) * (PetscLogDouble)a.n));
  PetscCall(VecRestoreArray(step->u, &a.u));
  PetscCall(VecRestoreArray(step->v, &a.v));
  if (step->f_old) PetscCall(VecRestoreArrayRead(step->f_old, &a.f_old));
  PetscCall(VecRestoreArrayRead(step->f, &a.f));
  PetscCall(VecRestoreArrayRead(c->minv, &a.minv));
  PetscFunctionReturn(0);
}

/* One step from t_n to t_{n+1}: forces at t_n, then velocities to t_{n+1/2}, then displacements. The adaptor of TS
   never rejects a step; it is asked for what the end of the run makes of the next one. */
static PetscErrorCode TSStep_Central(TS ts)
{
  TS_Central *c    = (TS_Central *)ts->data;
  PetscReal   next = ts->time_step;
  PetscBool   accept;
  CentralStep step;

  PetscFunctionBegin;
  PetscCall(CentralDescribe(ts, &step));
  PetscCall(CentralComputeForces(ts, &step));
  PetscCall(EventBegin(EVENT_MOVE));
  PetscCall(CentralMove(ts, &step));
  PetscCall(EventEnd(EVENT_MOVE));
  PetscCall(
    TSAdaptChoose(ts->adapt, ts, ts->time_step, NULL, &next, &accept)); /* the last step may have to be shorter */
  c->dt_old = step.dt;
  ts->ptime += step.dt;
  ts->time_step = next;
  PetscFunctionReturn(0);
}

/* f_old is there for b > 1/2 alone: a vector less to hold and to read otherwise. It begins at zero, with kick_old =
   0 in the first step. */
static PetscErrorCode TSSetUp_Central(TS ts)
{
  TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  PetscCheck(ts->vec_sol && ts->vec_dot, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONGSTATE,
             "TS of type " TSCENTRAL " needs displacements and velocities: call TS2SetSolution()");
  PetscCheck(c->force, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_WRONGSTATE,
             "TS of type " TSCENTRAL " needs forces: call TSCentralSetForces()");
  if (!c->f) PetscCall(VecDuplicate(ts->vec_sol, &c->f));
  if (!c->f_old && c->b != 0.5) PetscCall(VecDuplicate(ts->vec_sol, &c->f_old));
  if (c->f_old) PetscCall(VecSet(c->f_old, 0));
  PetscCall(TSGetAdapt(ts, &ts->adapt));
  PetscCall(TSAdaptCandidatesClear(ts->adapt));
  PetscFunctionReturn(0);
}

static PetscErrorCode TSReset_Central(TS ts)
{
  TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  PetscCall(VecDestroy(&c->minv));
  PetscCall(VecDestroy(&c->f));
  PetscCall(VecDestroy(&c->f_old));
  c->dt_old = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode TSDestroy_Central(TS ts)
{
  PetscFunctionBegin;
  PetscCall(TSReset_Central(ts));
  PetscCall(PetscFree(ts->data));
  PetscFunctionReturn(0);
}

static const Quantity rows[] = {
  {"-ts_central_b", "1/2: central differences; up to 1: dissipative", NULL, QUANTITY_REAL, QUANTITY_AT(TS_Central, b),
   .initial = 0.5, QUANTITY_WITHIN(0.5, 1), .why = "0.5 are central differences"},
};
static const QuantityTable central_quantities = {"Central differences", "dynamics.h", 1, rows, .in = RUN_MESH};

PetscErrorCode TSCentralVisit(TS ts, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &central_quantities, NULL, ts->data, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode TSSetFromOptions_Central(TS ts, OptionsItems PetscOptionsObject)
{
  TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  (void)PetscOptionsObject;
  PetscCall(QuantitiesRead(PetscObjectComm((PetscObject)ts), &central_quantities, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode TSView_Central(TS ts, PetscViewer viewer)
{
  const TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  b=%.6g%s\n", (double)c->b, c->b == 0.5 ? " (central differences)" : ""));
  PetscFunctionReturn(0);
}

/* Between the last two displacements, from the velocity that led from one to the other */
static PetscErrorCode TSInterpolate_Central(TS ts, PetscReal t, Vec u)
{
  PetscFunctionBegin;
  PetscCall(VecWAXPY(u, t - ts->ptime, ts->vec_dot, ts->vec_sol));
  PetscFunctionReturn(0);
}

PetscErrorCode TSCentralSetForces(TS ts, Vec minv, CentralForce force, CentralForce constraint, void *ctx)
{
  TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  PetscCall(PetscObjectReference((PetscObject)minv));
  PetscCall(VecDestroy(&c->minv));
  c->minv       = minv;
  c->force      = force;
  c->constraint = constraint;
  c->ctx        = ctx;
  PetscFunctionReturn(0);
}

PetscErrorCode TSCentralGetB(TS ts, PetscReal *b)
{
  PetscFunctionBegin;
  *b = ((TS_Central *)ts->data)->b;
  PetscFunctionReturn(0);
}

PetscErrorCode TSCentralGetForces(TS ts, Vec *f, Vec *f_old)
{
  const TS_Central *c = (TS_Central *)ts->data;

  PetscFunctionBegin;
  *f     = c->f;
  *f_old = c->f_old;
  PetscFunctionReturn(0);
}

/* 0 before the first step. A restart sets it, since it tells a first step from others and is half of `mean`. */
PetscErrorCode TSCentralGetLastStep(TS ts, PetscReal *dt_old)
{
  PetscFunctionBegin;
  *dt_old = ((TS_Central *)ts->data)->dt_old;
  PetscFunctionReturn(0);
}

PetscErrorCode TSCentralSetLastStep(TS ts, PetscReal dt_old)
{
  PetscFunctionBegin;
  ((TS_Central *)ts->data)->dt_old = dt_old;
  PetscFunctionReturn(0);
}

/* Forces at the present time without a step: for the row of the end of a run. */
PetscErrorCode TSCentralEvaluate(TS ts)
{
  CentralStep step;

  PetscFunctionBegin;
  PetscCall(CentralDescribe(ts, &step));
  PetscCall(CentralComputeForces(ts, &step));
  PetscFunctionReturn(0);
}

static PetscErrorCode TSCreate_Central(TS ts)
{
  TS_Central *c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  PetscCall(QuantitiesInit(&central_quantities, c));
  ts->data                = c;
  ts->ops->setup          = TSSetUp_Central;
  ts->ops->step           = TSStep_Central;
  ts->ops->reset          = TSReset_Central;
  ts->ops->destroy        = TSDestroy_Central;
  ts->ops->setfromoptions = TSSetFromOptions_Central;
  ts->ops->view           = TSView_Central;
  ts->ops->interpolate    = TSInterpolate_Central;
  ts->usessnes            = PETSC_FALSE;
  ts->default_adapt_type  = TSADAPTNONE;
  PetscFunctionReturn(0);
}

PetscErrorCode TSCentralRegister(void)
{
  PetscFunctionBegin;
  PetscCall(TSRegister(TSCENTRAL, TSCreate_Central));
  PetscFunctionReturn(0);
}
