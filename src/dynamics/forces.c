/*
   What the integrator asks for in every step from t_n, in this order:
      ku += dt K v, f = -ku - C v              internal forces (bodies.h)
      f += F(t_n), prescribed velocities       external.h
      v* = v + minv (kick f + kick_old f_old)  at the nodes of the contact surfaces
      f += G'lambda                            contact (projector.h)
   With f complete, t_n is recorded where a row is due. Forces in N, velocities in m/s.
*/
#include "dynamicsimpl.h"
#include "base/events.h"

#define CHECK_INTERVAL 200 /* steps between two looks at the ledger where no row is due */

/* The first vertex whose velocity is no number: this rank alone knows of it */
static PetscErrorCode DynamicsComplainNaN(Dynamics d, const CentralStep *step, const PetscReal v[])
{
  const PetscReal *x;
  PetscInt         n_step;

  PetscFunctionBeginUser;
  PetscCall(ModelGetCoordinates(d->model, &x));
  PetscCall(TSGetStepNumber(d->ts, &n_step));
  for (PetscInt i = 0; i < d->layout->n_vertices; i++) {
    PetscReal here[3];

    if (d->layout->at[i] < 0) continue;
    LayoutGet(d->layout, i, v, here);
    PetscCheck(!PetscIsInfOrNanReal(here[0] + here[1] + here[2]), PETSC_COMM_SELF, PETSC_ERR_FP,
               "velocity is no number at the node at %.6g, %.6g, %.6g m after step %" PetscInt_FMT ", %.6g s",
               (double)x[3 * i], (double)x[3 * i + 1], (double)x[3 * i + 2], n_step, (double)step->time);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FP, "energy is no number after step %" PetscInt_FMT ", %.6g s", n_step,
          (double)step->time);
}

/* Sum of v'(f - f_old) over this rank, shared vertices counted once; held directions have no acceleration */
static PetscReal DynamicsIntegratorPower(const Layout *l, const PetscReal minv[], const PetscReal v[],
                                         const PetscReal f[], const PetscReal f_old[])
{
  PetscReal power = 0;

  for (PetscInt i = 0; i < l->n_vertices; i++) {
    for (int j = 0; j < 3 && l->owned[i] && l->at[i] >= 0; j++) {
      const PetscInt k = l->at[i] + j * l->step[i];

      if (minv[k] > 0) power += v[k] * (f[k] - f_old[k]);
    }
  }
  return power;
}

/* Completes the integrator's work of the step before, whose forces the arrays still hold at the beginning of this one
 */
static PetscErrorCode DynamicsCompleteIntegrator(Dynamics d, const CentralStep *step, const PetscReal v[], Vec f,
                                                 Vec f_old)
{
  const PetscScalar *older, *last;
  const PetscReal   *minv;

  PetscFunctionBeginUser;
  PetscCall(BodiesGetMass(d->bodies, NULL, NULL, &minv));
  if (!f_old || step->dt_old == 0) PetscFunctionReturn(0);
  PetscCall(VecGetArrayRead(f, &older)); /* f is about to be overwritten: it holds the forces before f_old */
  PetscCall(VecGetArrayRead(f_old, &last));
  LedgerAddIntegrator(&d->part, d->b, DynamicsIntegratorPower(d->layout, minv, v, last, older), PETSC_TRUE,
                      step->dt_old);
  PetscCall(VecRestoreArrayRead(f_old, &last));
  PetscCall(VecRestoreArrayRead(f, &older));
  PetscFunctionReturn(0);
}

/* Cartesian values of a state vector at the active nodes */
static void SurfaceGet(const DynamicsSurface *s, const Layout *l, PetscInt n, const PetscInt active[],
                       const PetscReal x[], PetscReal cartesian[])
{
  for (PetscInt i = 0; i < n; i++) LayoutGet(l, s->vertex[active[i]], x, &cartesian[3 * active[i]]);
}

PetscErrorCode DynamicsForce(TS ts, const CentralStep *step, Vec u, Vec v, Vec f_old, Vec f, void *ctx)
{
  const Dynamics     d = ctx;
  const PetscScalar *displacement;
  const PetscInt    *active;
  PetscScalar       *velocity, *force;
  PetscInt           n_active;
  BodiesSums         sums;
  ExternalPower      power;

  PetscFunctionBeginUser;
  (void)ts;
  PetscCall(VecGetArrayRead(u, &displacement));
  PetscCall(VecGetArray(v, &velocity));
  PetscCall(DynamicsCompleteIntegrator(d, step, velocity, f, f_old));
  PetscCall(VecGetArray(f, &force));
  PetscCall(EventBegin(EVENT_BODIES_ADVANCE));
  PetscCall(BodiesAdvance(d->bodies, step->dt_old, displacement, velocity, d->ku, force, &sums));
  PetscCall(EventEnd(EVENT_BODIES_ADVANCE));
  if (PetscIsInfOrNanReal(sums.kinetic)) PetscCall(DynamicsComplainNaN(d, step, velocity));
  LedgerAddBodies(&d->part, &sums, step->dt_old);
  if (d->projector) {
    PetscCall(ContactProjectorGetActive(d->projector, &n_active, &active));
    SurfaceGet(&d->surface, d->layout, n_active, active, velocity, d->surface.before);
  }
  PetscCall(EventBegin(EVENT_EXTERNAL));
  PetscCall(ExternalAdvance(d->external, step->time, step->dt, displacement, velocity, force, &power));
  PetscCall(EventEnd(EVENT_EXTERNAL));
  LedgerAddExternal(&d->part, &power, step->dt_old);
  PetscCall(VecRestoreArray(f, &force));
  PetscCall(VecRestoreArray(v, &velocity));
  PetscCall(VecRestoreArrayRead(u, &displacement));
  PetscFunctionReturn(0);
}

/* Predicted velocities of the active nodes, Cartesian */
static void SurfacePredict(const DynamicsSurface *s, const Layout *l, const CentralStep *step, PetscInt n,
                           const PetscInt active[], const PetscReal minv[], const PetscReal f[],
                           const PetscReal f_old[], const PetscReal v[])
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt   vertex = s->vertex[active[i]], at = l->at[vertex], stride = l->step[vertex];
    const PetscReal *q    = &l->basis[9 * vertex];
    PetscReal       *here = &s->v[3 * active[i]];

    for (int c = 0; c < 3; c++) here[c] = 0;
    for (int j = 0; j < 3; j++) {
      const PetscInt  k = at + j * stride;
      const PetscReal w = v[k] + minv[k] * (step->kick * f[k] + (f_old ? step->kick_old * f_old[k] : 0));

      for (int c = 0; c < 3; c++) here[c] += q[3 * j + c] * w;
    }
  }
}

/* Kinetic energy of the predicted velocities, of this rank's vertices, J */
static PetscReal SurfaceEnergy(const DynamicsSurface *s, const Layout *l, PetscInt n, const PetscInt active[],
                               const PetscReal minv[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscInt   vertex = s->vertex[active[i]];
    const PetscReal *v = &s->v[3 * active[i]], m = l->owned[vertex] ? minv[l->at[vertex]] : 0;

    if (m > 0) sum += 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / m;
  }
  return sum;
}

/* Contact forces of the step on all copies of the active nodes; balanced: the ledger is looked at in this step */
static PetscErrorCode DynamicsAddContact(Dynamics d, const CentralStep *step, PetscBool balanced, const PetscReal u[],
                                         const PetscReal v[], const PetscReal f_old[], PetscReal f[])
{
  const ContactStep      contact = {.time = step->time, .dt = step->dt, .kick = step->kick};
  const DynamicsSurface *s       = &d->surface;
  const PetscInt        *active;
  const PetscReal       *minv;
  PetscInt               n;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_PROJECT));
  PetscCall(BodiesGetMass(d->bodies, NULL, NULL, &minv));
  PetscCall(ContactProjectorGetActive(d->projector, &n, &active));
  SurfaceGet(s, d->layout, n, active, u, s->u);
  SurfacePredict(s, d->layout, step, n, active, minv, f, f_old, v);
  if (balanced) d->part.predicted = PetscMax(d->part.predicted, SurfaceEnergy(s, d->layout, n, active, minv));
  PetscCall(ContactProject(d->projector, &contact, s->u, s->before, s->v, s->force));
  for (PetscInt i = 0; i < n; i++) LayoutAdd(d->layout, s->vertex[active[i]], &s->force[3 * active[i]], f);
  PetscCall(EventEnd(EVENT_PROJECT));
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsGetSums(Dynamics d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n_interfaces; i++) PetscCall(ContactProjectorGetSums(d->projector, i, &d->sums[i]));
  PetscFunctionReturn(0);
}

/* The ledger up to the half step before t_n; the contact forces of the step from t_n must not be known yet */
static PetscErrorCode DynamicsBalance(Dynamics d, const CentralStep *step, PetscInt n)
{
  const PetscReal fraction = step->dt / d->critical.assembled;

  PetscFunctionBeginUser;
  PetscCall(DynamicsGetSums(d));
  PetscCall(LedgerClose(d->comm, &d->part, d->n_interfaces, d->sums, n <= 1 ? PETSC_TRUE : PETSC_FALSE, &d->origin,
                        &d->ledger));
  PetscCall(LedgerJudge(d->comm, &d->ledger, fraction, n, step->time));
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsRecord(Dynamics d, const CentralStep *step, PetscInt n, const PetscReal u[],
                                     const PetscReal before[], const PetscReal f_old[], const PetscReal f[])
{
  HistoryState state = {.step         = n,
                        .time         = step->time,
                        .dt           = step->dt,
                        .b            = step->dt_old > 0 ? d->b : 0,
                        .u            = u,
                        .before       = before,
                        .f            = f,
                        .f_old        = step->dt_old > 0 ? f_old : NULL,
                        .ledger       = &d->ledger,
                        .n_interfaces = d->n_interfaces,
                        .sums         = d->sums};

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_RECORD));
  PetscCall(DynamicsGetSums(d));
  PetscCall(BodiesGetMass(d->bodies, NULL, NULL, &state.minv));
  PetscCall(HistoryRecord(d->history, &state));
  PetscCall(EventEnd(EVENT_RECORD));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsConstrain(TS ts, const CentralStep *step, Vec u, Vec v, Vec f_old, Vec f, void *ctx)
{
  const Dynamics     d = ctx;
  const PetscScalar *displacement, *velocity, *last = NULL;
  const PetscReal   *minv;
  PetscScalar       *force;
  PetscBool          due, balanced;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(TSGetStepNumber(ts, &n));
  due      = HistoryIsDue(d->history, step->time, step->dt);
  balanced = due || d->ended || n <= 1 || n % CHECK_INTERVAL == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (balanced) PetscCall(DynamicsBalance(d, step, n));
  PetscCall(VecGetArrayRead(u, &displacement));
  PetscCall(VecGetArrayRead(v, &velocity));
  if (f_old) PetscCall(VecGetArrayRead(f_old, &last));
  PetscCall(VecGetArray(f, &force));
  if (d->projector) PetscCall(DynamicsAddContact(d, step, balanced, displacement, velocity, last, force));
  PetscCall(ExternalFinish(d->external, step->dt, force));
  PetscCall(BodiesGetMass(d->bodies, NULL, NULL, &minv));
  if (last)
    LedgerAddIntegrator(&d->part, d->b, DynamicsIntegratorPower(d->layout, minv, velocity, force, last), PETSC_FALSE,
                        0);
  if (due) PetscCall(DynamicsRecord(d, step, n, displacement, velocity, last, force));
  PetscCall(VecRestoreArray(f, &force));
  if (f_old) PetscCall(VecRestoreArrayRead(f_old, &last));
  PetscCall(VecRestoreArrayRead(v, &velocity));
  PetscCall(VecRestoreArrayRead(u, &displacement));
  PetscFunctionReturn(0);
}
