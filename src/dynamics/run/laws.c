/*
   Looks at the laws by second paths, see laws.h. A look begins with the forces of a step and ends when the step is
   made, before a checkpoint is written, so that a run that goes on from there needs nothing of it.
*/
#include "dynamics/dynamicsimpl.h"
#include "base/algebra/vec3.h"

/* roundings of each term */
#define LAWS_NOISE 16

/* Which numbers of a state vector count: those of this rank's nodes, or of its copies, too; free or held directions */
typedef struct {
  PetscBool copies, free, held;
} LawsWhich;

/* Adds scale x to the sums; x are forces (N) at the nodes, or with weight (kg) velocities. value: resultant and
   moment about the origin, N and N m; size: the sums of the lengths, beside which their errors are seen. */
static void LawsAdd(Dynamics d, const PetscReal x[], const PetscReal weight[], const LawsWhich *which, PetscReal scale,
                    LawsSum *sum)
{
  const Layout *l = d->layout;

  for (PetscInt i = 0; i < l->n_vertices; i++) {
    const PetscReal *X        = &d->mesh->x[3 * i];
    PetscReal        force[3] = {0, 0, 0}, moment[3], length;

    if (l->at[i] < 0 || !(l->owned[i] || which->copies)) continue;
    for (int j = 0; j < 3; j++) {
      const PetscInt k = l->at[i] + j * l->step[i];

      if (!(l->minv[k] > 0 ? which->free : which->held)) continue;
      for (int c = 0; c < 3; c++) force[c] += l->basis[9 * i + 3 * j + c] * x[k] * (weight ? weight[k] : 1);
    }
    Vec3Cross(X, force, moment);
    length = Vec3Length(force);
    for (int c = 0; c < 3; c++) sum->value[c] += scale * force[c], sum->value[3 + c] += scale * moment[c];
    sum->size[0] += PetscAbsReal(scale) * length;
    sum->size[1] += PetscAbsReal(scale) * length * Vec3Length(X);
  }
}

static const LawsWhich LAWS_ALL    = {.free = PETSC_TRUE, .held = PETSC_TRUE};
static const LawsWhich LAWS_FREE   = {.free = PETSC_TRUE};
static const LawsWhich LAWS_COPIES = {.copies = PETSC_TRUE, .free = PETSC_TRUE, .held = PETSC_TRUE};

/* Whether the step is looked at; the last one is */
static PetscErrorCode LawsAreDue(Dynamics d, const CentralStep *step, PetscBool *due)
{
  PetscReal end;
  PetscInt  n, most;

  PetscFunctionBeginUser;
  PetscCall(TSGetStepNumber(d->ts, &n));
  PetscCall(TSGetMaxSteps(d->ts, &most));
  PetscCall(TSGetMaxTime(d->ts, &end));
  *due = LedgerIsLooked(n, d->laws.interval);
  if (n + 1 >= most || step->time + step->dt >= end) *due = d->laws.interval > 0 && n > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (d->ended) *due = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Internal forces must be those of the ground: f = -K u - C v sums, in all directions, to what springs, dashpots
   and bushings exert, since the forces within bodies balance in pairs */
static PetscErrorCode LawsLookAtBodies(Dynamics d, const PetscReal u[])
{
  Laws      *l      = &d->laws;
  LawsSum    ground = {.size = {0, 0}};
  PetscReal *g;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(d->layout->n, &g));
  PetscCall(BodiesGetGroundForces(d->bodies, u, g));
  LawsAdd(d, g, NULL, &LAWS_COPIES, -1, &ground);
  for (int i = 0; i < 6; i++) l->miss.value[i] += l->internal.value[i] - ground.value[i];
  for (int i = 0; i < 2; i++) l->miss.size[i] += l->internal.size[i] + ground.size[i];
  PetscCall(PetscFree(g));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsLookBegin(Dynamics d, const CentralStep *step, const PetscReal u[], const PetscReal f[])
{
  Laws *l = &d->laws;

  PetscFunctionBeginUser;
  PetscCall(LawsAreDue(d, step, &l->now));
  if (!l->now) PetscFunctionReturn(0);
  l->internal = l->miss = l->before = (LawsSum){.size = {0, 0}};
  l->kick                           = step->kick;
  LawsAdd(d, f, NULL, &LAWS_ALL, 1, &l->internal);
  PetscCall(LawsLookAtBodies(d, u));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsLookAtLoads(Dynamics d, PetscReal time, const PetscReal f[])
{
  Laws       *l   = &d->laws;
  LawsSum     all = {.size = {0, 0}};
  PetscReal   told[3];
  PetscMPIInt rank;
  PetscBool   known;

  PetscFunctionBeginUser;
  if (!l->now) PetscFunctionReturn(0);
  LawsAdd(d, f, NULL, &LAWS_ALL, 1, &all);
  PetscCall(ExternalGetResultant(d->external, time, told, &known));
  PetscCallMPI(MPI_Comm_rank(d->comm, &rank));
  for (int i = 0; i < 3 && known; i++) l->miss.value[i] += all.value[i] - l->internal.value[i] - (rank ? 0 : told[i]);
  if (!rank) l->miss.size[0] += Vec3Length(told);
  PetscFunctionReturn(0);
}

/* K u of the kernels beside that of the elements. What may be rounding: that of K u with the largest stiffness that the
   critical step leaves to a mass, 4 m / dt^2 */
static PetscErrorCode LawsLookAtStiffness(Dynamics d, const PetscReal u[])
{
  const Layout   *l         = d->layout;
  const PetscReal stiffness = 4 / PetscSqr(d->critical.assembled);
  LedgerLaws     *laws      = &d->ledger.total.laws;
  PetscReal      *ku, largest[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->n, &ku));
  PetscCall(BodiesGetElementForces(d->bodies, u, ku));
  for (PetscInt i = 0; i < l->n; i++) {
    largest[0] = PetscMax(largest[0], PetscAbsReal(ku[i] - d->ku[i]));
    largest[1] = PetscMax(largest[1], PetscAbsReal(ku[i]));
    largest[2] = PetscMax(largest[2], stiffness * l->total[i] * PetscAbsReal(u[i]));
  }
  PetscCall(PetscFree(ku));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPIU_REAL, MPI_MAX, d->comm));
  largest[0] -= LAWS_NOISE * PETSC_MACHINE_EPSILON * largest[2];
  if (largest[1] > 0) laws->stiffness = PetscMax(laws->stiffness, largest[0] / largest[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsLookAtForces(Dynamics d, const CentralStep *step, const LawsArrays *a)
{
  Laws *l = &d->laws;

  PetscFunctionBeginUser;
  if (!l->now) PetscFunctionReturn(0);
  LawsAdd(d, a->v, d->layout->total, &LAWS_FREE, 1, &l->before);
  LawsAdd(d, a->f, NULL, &LAWS_FREE, step->kick, &l->before);
  if (a->f_old) LawsAdd(d, a->f_old, NULL, &LAWS_FREE, step->kick_old, &l->before);
  PetscCall(LawsLookAtStiffness(d, a->u));
  PetscFunctionReturn(0);
}

/* Contact forces: none in all, on no arm */
static PetscErrorCode LawsLookAtContact(Dynamics d)
{
  const DynamicsSurface *s    = &d->surface;
  LawsSum               *miss = &d->laws.miss;
  ContactArms            arms;

  PetscFunctionBeginUser;
  PetscCall(ContactProjectorGetArms(d->projector, &arms));
  for (PetscInt k = 0; k < s->n; k++) {
    const PetscInt   i     = s->vertex[k];
    const PetscReal *force = &s->force[3 * k], *u = &s->u[3 * k], length = Vec3Length(force);
    PetscReal        arm[3], moment[3];

    if (!d->layout->owned[i] || length == 0) continue;
    for (int c = 0; c < 3; c++) arm[c] = d->mesh->x[3 * i + c] + (arms == CONTACT_ARMS_PRESENT ? u[c] : 0);
    Vec3Cross(arm, force, moment);
    for (int c = 0; c < 3 && arms != CONTACT_ARMS_UNKNOWN; c++)
      miss->value[c] += force[c], miss->value[3 + c] += moment[c];
    miss->size[0] += length;
    miss->size[1] += length * Vec3Length(arm);
  }
  PetscFunctionReturn(0);
}

/* Friction of the step by the places of the nodes */
static PetscErrorCode LawsLookAtFriction(Dynamics d, const PetscReal u[])
{
  LedgerLaws     *laws  = &d->ledger.total.laws;
  PetscReal       error = 0, noise = d->ledger.part.predicted, miss;
  const PetscInt *active;
  PetscInt        n;
  ContactSlipWork work;

  PetscFunctionBeginUser;
  PetscCall(ContactProjectorGetActive(d->projector, &n, &active));
  for (PetscInt i = 0; i < n; i++) LayoutGet(d->layout, d->surface.vertex[active[i]], u, &d->surface.u[3 * active[i]]);
  PetscCall(ContactProjectorGetSlipWork(d->projector, d->surface.u, &work));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &noise, 1, MPIU_REAL, MPI_SUM, d->comm));
  noise = LAWS_NOISE * PETSC_MACHINE_EPSILON * (d->ledger.total.throughput + noise);
  miss  = PetscMax(work.miss, PetscAbsReal(work.heat - work.dissipated) - work.noise) - noise;
  if (work.size > 0) error = PetscMax(0, miss) / work.size;
  if (work.normal > 0) error = PetscMax(error, work.over / work.normal);
  laws->friction = PetscMax(laws->friction, error);
  PetscFunctionReturn(0);
}

/* Squares of what is rounded: forces of the largest stiffness that the critical step leaves to a mass, 4 m / dt^2, at
   u, and changes of momentum M v / kick; N, N m */
static void LawsAddNoise(Dynamics d, const PetscReal u[], const PetscReal v[], PetscReal sum[2])
{
  const Layout   *l         = d->layout;
  const PetscReal stiffness = 4 / PetscSqr(d->critical.assembled), kick = d->laws.kick;

  for (PetscInt i = 0; i < l->n_vertices; i++) {
    for (int j = 0; j < 3 && l->at[i] >= 0 && l->owned[i]; j++) {
      const PetscInt  k = l->at[i] + j * l->step[i];
      const PetscReal f = l->total[k] * (stiffness * PetscAbsReal(u[k]) + PetscAbsReal(v[k]) / kick);

      sum[0] += f * f;
      sum[1] += f * f * Vec3Dot(&d->mesh->x[3 * i], &d->mesh->x[3 * i]);
    }
  }
}

/* Momentum at the end of the step, and the errors of both momenta beyond rounding: M v_{n+1/2} = M v_{n-1/2} + kick
   f + kick_old f_old in all, over kick (N) */
static PetscErrorCode LawsEndMomentum(Dynamics d, const PetscReal u[], const PetscReal v[])
{
  Laws       *l     = &d->laws;
  LedgerLaws *laws  = &d->ledger.total.laws;
  LawsSum     after = {.size = {0, 0}};
  PetscReal   sum[10], noise;

  PetscFunctionBeginUser;
  LawsAdd(d, v, d->layout->total, &LAWS_FREE, 1, &after);
  for (int i = 0; i < 6; i++) sum[i] = l->miss.value[i] + (after.value[i] - l->before.value[i]) / l->kick;
  for (int i = 0; i < 2; i++) sum[6 + i] = l->miss.size[i];
  LawsAddNoise(d, u, v, &sum[8]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 10, MPIU_REAL, MPI_SUM, d->comm));
  for (int i = 0; i < 2; i++) {
    noise  = LAWS_NOISE * PETSC_MACHINE_EPSILON * PetscSqrtReal(sum[8 + i]);
    sum[i] = sum[6 + i] > 0 ? PetscMax(0, Vec3Length(&sum[3 * i]) - noise) / sum[6 + i] : 0;
  }
  laws->momentum = PetscMax(laws->momentum, sum[0]);
  laws->moment   = PetscMax(laws->moment, sum[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsLookEnd(Dynamics d)
{
  const PetscScalar *u, *v;
  PetscReal          time;
  PetscInt           n;

  PetscFunctionBeginUser;
  if (!d->laws.now) PetscFunctionReturn(0);
  PetscCall(VecGetArrayRead(d->u, &u));
  PetscCall(VecGetArrayRead(d->v, &v));
  if (d->projector) PetscCall(LawsLookAtFriction(d, u));
  if (d->projector) PetscCall(LawsLookAtContact(d));
  PetscCall(LawsEndMomentum(d, u, v));
  PetscCall(VecRestoreArrayRead(d->v, &v));
  PetscCall(VecRestoreArrayRead(d->u, &u));
  d->ledger.total.laws.looks++;
  d->laws.now = PETSC_FALSE;
  PetscCall(TSGetTime(d->ts, &time));
  PetscCall(TSGetStepNumber(d->ts, &n));
  PetscCall(LedgerJudgeLaws(d->comm, &d->ledger.total.laws, n, time));
  PetscFunctionReturn(0);
}
