/*
   What the integrator asks for in every step from t_n, in this order:
      ku += dt K v, f = -ku - C v              internal forces (bodies.h)
      f += F(t_n), prescribed velocities       external.h
      f += inertial forces of points           bodies.h
      v* = v + minv (kick f + kick_old f_old)  at the nodes of the contact surfaces
      f += G'lambda                            contact (projector.h)
   With f complete, t_n is recorded where a row is due. Forces in N, velocities in m/s.
*/
#include "dynamicsimpl.h"
#include "base/events.h"

/* steps between two looks at the ledger where no row is due: a reduction over the ranks is then no part of the cost */
#define CHECK_INTERVAL 200

/* A step with its arrays, [layout n] */
typedef struct {
  const CentralStep *step;
  const PetscScalar *u, *f_old; /* f_old NULL for b = 1/2 */
  PetscScalar       *v, *f;
  const PetscReal   *minv;
} ForceArrays;

static PetscErrorCode ForceArraysGet(Dynamics d, const CentralStep *step, ForceArrays *a)
{
  PetscFunctionBeginUser;
  *a = (ForceArrays){.step = step, .minv = d->layout->minv};
  PetscCall(VecGetArrayRead(step->u, &a->u));
  PetscCall(VecGetArray(step->v, &a->v));
  if (step->f_old) PetscCall(VecGetArrayRead(step->f_old, &a->f_old));
  PetscCall(VecGetArray(step->f, &a->f));
  PetscFunctionReturn(0);
}

static PetscErrorCode ForceArraysRestore(ForceArrays *a)
{
  PetscFunctionBeginUser;
  PetscCall(VecRestoreArray(a->step->f, &a->f));
  if (a->f_old) PetscCall(VecRestoreArrayRead(a->step->f_old, &a->f_old));
  PetscCall(VecRestoreArray(a->step->v, &a->v));
  PetscCall(VecRestoreArrayRead(a->step->u, &a->u));
  PetscFunctionReturn(0);
}

/* The first node whose velocity is no number: this rank alone knows of it */
static PetscErrorCode DynamicsComplainNaN(Dynamics d, const ForceArrays *a)
{
  const double time = (double)a->step->time;
  const Mesh  *mesh;
  PetscInt     n_step;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(d->model, &mesh));
  PetscCall(TSGetStepNumber(d->ts, &n_step));
  for (PetscInt i = 0; i < d->layout->n_vertices; i++) {
    PetscReal here[3];

    if (d->layout->at[i] < 0) continue;
    LayoutGet(d->layout, i, a->v, here);
    PetscCheck(!PetscIsInfOrNanReal(here[0] + here[1] + here[2]), PETSC_COMM_SELF, PETSC_ERR_FP,
               "velocity is no number at the node at %.6g, %.6g, %.6g m after step %" PetscInt_FMT ", %.6g s",
               (double)mesh->x[3 * i], (double)mesh->x[3 * i + 1], (double)mesh->x[3 * i + 2], n_step, time);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FP, "energy is no number after step %" PetscInt_FMT ", %.6g s", n_step, time);
}

/* Sum of v'(f - f_old) over this rank, W, shared nodes counted once; held directions have no acceleration */
static PetscReal DynamicsIntegratorPower(const Layout *l, const ForceArrays *a)
{
  PetscReal power = 0;

  for (PetscInt i = 0; i < l->n_vertices; i++) {
    for (int j = 0; j < 3 && l->owned[i] && l->at[i] >= 0; j++) {
      const PetscInt k = l->at[i] + j * l->step[i];

      if (a->minv[k] > 0) power += a->v[k] * (a->f[k] - a->f_old[k]);
    }
  }
  return power;
}

/* Cartesian values of a state vector at the active nodes */
static void SurfaceGet(const DynamicsSurface *s, const Layout *l, PetscInt n, const PetscInt active[],
                       const PetscReal x[], PetscReal cartesian[])
{
  for (PetscInt i = 0; i < n; i++) LayoutGet(l, s->vertex[active[i]], x, &cartesian[3 * active[i]]);
}

/* f_n of all but the contact; v is v_{n-1/2}, which prescribed velocities change. Velocities before that are kept
   at the active nodes (surface.before), with which the works of the contact forces of the step before end. */
PetscErrorCode DynamicsForce(TS ts, const CentralStep *step, void *ctx)
{
  const Dynamics  d = ctx;
  const PetscInt *active;
  PetscInt        n_active;
  BodiesSums      sums;
  ExternalPower   power;
  ForceArrays     a;

  PetscFunctionBeginUser;
  (void)ts;
  PetscCall(ForceArraysGet(d, step, &a));
  if (a.f_old && step->dt_old > 0) /* completes the work of the step before: f still holds the forces before f_old */
    LedgerAddIntegrator(&d->ledger.part, d->b, -DynamicsIntegratorPower(d->layout, &a), PETSC_TRUE, step->dt_old);
  PetscCall(EventBegin(EVENT_BODIES_ADVANCE));
  PetscCall(BodiesAdvance(d->bodies, &(BodiesStep){step->dt_old, a.u, a.v, d->ku, a.f}, &sums));
  PetscCall(EventEnd(EVENT_BODIES_ADVANCE));
  if (PetscIsInfOrNanReal(sums.kinetic)) PetscCall(DynamicsComplainNaN(d, &a));
  LedgerAddBodies(&d->ledger.part, &sums, step->dt_old);
  if (d->projector) {
    PetscCall(ContactProjectorGetActive(d->projector, &n_active, &active));
    SurfaceGet(&d->surface, d->layout, n_active, active, a.v, d->surface.before);
  }
  PetscCall(EventBegin(EVENT_EXTERNAL));
  PetscCall(ExternalAdvance(d->external, &(ExternalStep){step->time, step->dt, a.u, a.v, a.f}, &power));
  PetscCall(EventEnd(EVENT_EXTERNAL));
  LedgerAddExternal(&d->ledger.part, &power, step->dt_old);
  PetscCall(BodiesAddInertia(d->bodies, a.f));
  PetscCall(DynamicsMarkImpulse(d));
  PetscCall(ForceArraysRestore(&a));
  PetscFunctionReturn(0);
}

/* Predicted velocities of the active nodes, v* = v + M^-1 (kick f + kick_old f_old), m/s, from the components of
   each node (rows q_j of its basis) to Cartesian ones */
static void SurfacePredict(const DynamicsSurface *s, const Layout *l, const ForceArrays *a, PetscInt n,
                           const PetscInt active[])
{
  const CentralStep *step = a->step;

  for (PetscInt i = 0; i < n; i++) {
    const PetscInt   vertex = s->vertex[active[i]], at = l->at[vertex], stride = l->step[vertex];
    const PetscReal *q    = &l->basis[9 * vertex];
    PetscReal       *here = &s->v[3 * active[i]];

    for (int c = 0; c < 3; c++) here[c] = 0;
    for (int j = 0; j < 3; j++) {
      const PetscInt  k = at + j * stride;
      const PetscReal f = step->kick * a->f[k] + (a->f_old ? step->kick_old * a->f_old[k] : 0);
      const PetscReal w = a->v[k] + a->minv[k] * f;

      for (int c = 0; c < 3; c++) here[c] += q[3 * j + c] * w;
    }
  }
}

/* Kinetic energy of the predicted velocities, of this rank's nodes, J */
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
static PetscErrorCode DynamicsAddContact(Dynamics d, const ForceArrays *a, PetscBool balanced)
{
  const CentralStep     *step      = a->step;
  const ContactStep      contact   = {.time = step->time, .dt = step->dt, .kick = step->kick};
  const DynamicsSurface *s         = &d->surface;
  PetscReal             *predicted = &d->ledger.part.predicted;
  const PetscInt        *active;
  PetscInt               n;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_PROJECT));
  PetscCall(ContactProjectorGetActive(d->projector, &n, &active));
  SurfaceGet(s, d->layout, n, active, a->u, s->u);
  SurfacePredict(s, d->layout, a, n, active);
  if (balanced) *predicted = PetscMax(*predicted, SurfaceEnergy(s, d->layout, n, active, a->minv));
  PetscCall(ContactProject(d->projector, &contact, s->u, s->before, s->v, s->force));
  for (PetscInt i = 0; i < n; i++) LayoutAdd(d->layout, s->vertex[active[i]], &s->force[3 * active[i]], a->f);
  PetscCall(EventEnd(EVENT_PROJECT));
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsGetSums(Dynamics d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n_interfaces; i++) PetscCall(ContactProjectorGetSums(d->projector, i, &d->sums[i]));
  PetscFunctionReturn(0);
}

/* The ledger up to the half step before t_n; the contact forces of the step from t_n must not be known yet, since
   the sums of the projector would have their works, which end at t_{n+1/2} */
static PetscErrorCode DynamicsBalance(Dynamics d, const CentralStep *step, PetscInt n)
{
  const PetscReal fraction = step->dt / d->critical.assembled;

  PetscFunctionBeginUser;
  PetscCall(DynamicsGetSums(d));
  PetscCall(LedgerClose(d->comm, &d->ledger, d->n_interfaces, d->sums, n <= 1 ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(LedgerJudge(d->comm, &d->ledger.total, fraction, n, step->time));
  PetscFunctionReturn(0);
}

/* .b = 0 in a row without a step before it, where v is v_0 itself and no part of the kick is to be added. */
static PetscErrorCode DynamicsRecord(Dynamics d, const ForceArrays *a, PetscInt n)
{
  const CentralStep *step  = a->step;
  HistoryState       state = {.step         = n,
                              .time         = step->time,
                              .dt           = step->dt,
                              .b            = step->dt_old > 0 ? d->b : 0,
                              .u            = a->u,
                              .before       = a->v,
                              .f            = a->f,
                              .f_old        = step->dt_old > 0 ? a->f_old : NULL,
                              .minv         = a->minv,
                              .ledger       = &d->ledger.total,
                              .n_interfaces = d->n_interfaces,
                              .sums         = d->sums};

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_RECORD));
  PetscCall(DynamicsGetSums(d));
  PetscCall(HistoryRecord(d->history, &state));
  PetscCall(EventEnd(EVENT_RECORD));
  PetscFunctionReturn(0);
}

/* The contact of the step, and what is looked at with f_n complete. Whether the ledger is closed, a reduction,
   depends on numbers that all ranks share. */
PetscErrorCode DynamicsConstrain(TS ts, const CentralStep *step, void *ctx)
{
  const Dynamics d = ctx;
  PetscBool      due, balanced;
  PetscInt       n;
  ForceArrays    a;

  PetscFunctionBeginUser;
  PetscCall(TSGetStepNumber(ts, &n));
  due      = HistoryIsDue(d->history, step->time, step->dt);
  balanced = due || d->ended || n <= 1 || n % CHECK_INTERVAL == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (balanced) PetscCall(DynamicsBalance(d, step, n));
  PetscCall(ForceArraysGet(d, step, &a));
  if (d->projector) PetscCall(DynamicsAddContact(d, &a, balanced));
  PetscCall(ExternalFinish(d->external, step->dt, a.f));
  if (a.f_old) LedgerAddIntegrator(&d->ledger.part, d->b, DynamicsIntegratorPower(d->layout, &a), PETSC_FALSE, 0);
  if (due) PetscCall(DynamicsRecord(d, &a, n));
  PetscCall(ForceArraysRestore(&a));
  PetscFunctionReturn(0);
}
