/*
   The state at t = 0: displacements u_0 and velocities v_0.
      rest    u_0 = 0, v_0 the initial velocities of the parts
      static  u_0 of the sliding state under the loads (statics.h) and motions, and its contact forces; v_0 as at
              rest. Then nothing
              moves until something disturbs it: all loads and sliding speeds are in force from the first step.
   On top of either a mode x of an earlier run, lambda = sigma + i omega: u_0 += A Re(x), v_0 += A Re(lambda x), in the
   phase in which the largest component of x is positive, of equally large ones (to 1e-6) the first by place x, y, z,
   then by direction, and with A such that it is the amplitude asked for. m, m/s.
*/
#include "dynamics/dynamicsimpl.h"
#include "shape.h"

/* Raises the error for a time that the sliding state does not know; 0 is none */
static PetscErrorCode StartCheckAbsent(Dynamics d, const char name[], const char what[])
{
  char      option[160];
  PetscReal length = 1;
  PetscBool set;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s%s", name, what));
  PetscCall(PetscOptionsGetReal(NULL, NULL, option, &length, &set));
  PetscCheck(
    !set || length == 0, d->comm, PETSC_ERR_USER_INPUT,
    "%s has no place with -dynamics_start static, the steady state under the whole loads: leave it out, or take "
    "-dynamics_start rest",
    option);
  PetscFunctionReturn(0);
}

/* Raises the error for what is not at the start what the sliding state has; what swings about zero is no part of it */
static PetscErrorCode StartCheckFactor(Dynamics d, const char name[], const char what[], PetscReal factor)
{
  PetscFunctionBeginUser;
  PetscCheck(
    factor == 1, d->comm, PETSC_ERR_USER_INPUT,
    "-%s%s begins with %.6g: with -dynamics_start static, the steady state under the whole loads, it must begin "
    "with 1; or take -dynamics_start rest",
    name, what, (double)factor);
  PetscFunctionReturn(0);
}

static PetscErrorCode StartCheckHistories(Dynamics d)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(d->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++)
    if (!scene->loads[i].swings)
      PetscCall(StartCheckFactor(d, scene->loads[i].name, "_history", RampValue(ExternalGetLoad(d->external, i), 0)));
  for (PetscInt i = 0; i < scene->n_motions; i++)
    if (!scene->motions[i].swings)
      PetscCall(
        StartCheckFactor(d, scene->motions[i].name, "_history", RampValue(ExternalGetMotion(d->external, i), 0)));
  for (PetscInt i = 0; i < d->n_interfaces && d->projector; i++) {
    PetscReal speed, friction;
    PetscBool warms;

    PetscCall(ContactProjectorGetFactors(d->projector, i, 0, &speed, &friction, &warms));
    PetscCall(StartCheckFactor(d, d->interfaces[i].name, "_frequency or _history", speed));
    PetscCall(StartCheckFactor(d, d->interfaces[i].name, warms ? "_mu_temperature" : "_mu_history", friction));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsCheckStatic(Dynamics d)
{
  static const char *const ramps[]    = {"_ramp", "_delay"};
  const ContactInterface  *interfaces = d->interfaces;
  const ModelScene        *scene;
  PetscInt                 n = d->n_interfaces;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(d->model, &scene));
  for (int r = 0; r < 2; r++) {
    for (PetscInt i = 0; i < scene->n_loads; i++)
      if (!scene->loads[i].swings) PetscCall(StartCheckAbsent(d, scene->loads[i].name, ramps[r]));
    for (PetscInt i = 0; i < scene->n_motions; i++)
      if (!scene->motions[i].swings) PetscCall(StartCheckAbsent(d, scene->motions[i].name, ramps[r]));
    for (PetscInt i = 0; i < n; i++) {
      char friction[160];

      PetscCall(PetscSNPrintf(friction, sizeof(friction), "%s_mu", interfaces[i].name));
      PetscCall(StartCheckAbsent(d, interfaces[i].name, ramps[r]));
      PetscCall(StartCheckAbsent(d, friction, ramps[r]));
    }
  }
  PetscCall(StartCheckHistories(d));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsCheckBolts(Dynamics d)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(d->model, &scene));
  for (PetscInt i = 0; i < scene->n_loads; i++)
    PetscCheck(
      !scene->loads[i].has_tension || d->start == START_STATIC, d->comm, PETSC_ERR_USER_INPUT,
      "-%s_tension: how far the bolt is drawn is found with the sliding state: take -dynamics_start static, or "
      "give -%s_shortening (m), which -analysis static prints",
      scene->loads[i].name, scene->loads[i].name);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsCheckExact(Dynamics d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    const ContactInterface *c = &d->interfaces[i];

    PetscCheck(
      c->law == CONTACT_CONSTRAINT, d->comm, PETSC_ERR_USER_INPUT,
      "-%s_law penalty: -dynamics_start static needs -%s_law constraint, the law of the dynamics, or a reduced "
      "model with -dynamics_contact penalty",
      c->name, c->name);
  }
  PetscFunctionReturn(0);
}

#define START_EQUAL 1e-6 /* components that differ by less, relative, are equally large: a symmetric body has several */

/* A component of a shape: its place, m, its direction, and its phase, a unit number */
typedef struct {
  double x[3], direction, phase[2];
} StartComponent;

/* By place, then by direction */
static PetscBool StartIsBefore(const StartComponent *a, const StartComponent *b)
{
  const double at[2][4] = {{a->x[0], a->x[1], a->x[2], a->direction}, {b->x[0], b->x[1], b->x[2], b->direction}};

  for (int d = 0; d < 4; d++)
    if (at[0][d] != at[1][d]) return at[0][d] < at[1][d] ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_FALSE;
}

/* Of the components of all ranks that are as large as the largest the first by place: rounding does not choose */
static PetscErrorCode StartFindLargest(MPI_Comm comm, const Mesh *mesh, const PetscReal re[], const PetscReal im[],
                                       PetscReal *largest, StartComponent *first)
{
  StartComponent *all, mine = {{INFINITY, INFINITY, INFINITY}, 0, {1, 0}};
  PetscMPIInt     n_ranks;

  PetscFunctionBeginUser;
  *largest = 0;
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) *largest = PetscMax(*largest, hypot(re[i], im[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 1, MPIU_REAL, MPI_MAX, comm));
  for (PetscInt i = 0; *largest > 0 && i < 3 * mesh->n_nodes; i++) {
    const PetscReal     *x = &mesh->x[i - i % 3], size = hypot(re[i], im[i]);
    const StartComponent c = {{x[0], x[1], x[2]}, (double)(i % 3), {re[i] / size, im[i] / size}};

    if (size >= (1 - START_EQUAL) * *largest && StartIsBefore(&c, &mine)) mine = c;
  }
  PetscCallMPI(MPI_Comm_size(comm, &n_ranks));
  PetscCall(PetscMalloc1(n_ranks, &all));
  PetscCallMPI(MPI_Allgather(&mine, 6, MPI_DOUBLE, all, 6, MPI_DOUBLE, comm));
  *first = all[0];
  for (PetscMPIInt r = 1; r < n_ranks; r++)
    if (StartIsBefore(&all[r], first)) *first = all[r];
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Turns the phase of x = re + i im, which eigensolvers leave to chance, to that in which its largest component is real
   and positive. Returns that component. */
static PetscErrorCode StartTurn(MPI_Comm comm, const Mesh *mesh, PetscReal re[], PetscReal im[], PetscReal *largest)
{
  StartComponent first;

  PetscFunctionBeginUser;
  PetscCall(StartFindLargest(comm, mesh, re, im, largest, &first));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscReal r = re[i];

    re[i] = first.phase[0] * r + first.phase[1] * im[i];
    im[i] = first.phase[0] * im[i] - first.phase[1] * r;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsGetShape(Dynamics d, PetscReal u[], PetscReal v[])
{
  const Mesh *mesh;
  PetscInt    n;
  PetscReal  *re, *im, lambda[2], largest = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(d->model, &mesh));
  n = 3 * mesh->n_nodes;
  PetscCall(PetscArrayzero(u, n));
  PetscCall(PetscArrayzero(v, n));
  if (!d->shape[0]) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(n, &re, n, &im));
  PetscCall(ShapeRead(d->model,
                      &(ShapeSource){"-dynamics_shape", "-dynamics_shape_mode", "-output_fields", d->shape, "modes.h5",
                                     "", d->shape_mode},
                      re, im, lambda));
  PetscCall(StartTurn(d->comm, mesh, re, im, &largest));
  PetscCheck(largest > 0, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_shape_mode %" PetscInt_FMT " of -dynamics_shape %s does not move", d->shape_mode, d->shape);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal scale = d->shape_amplitude / largest;

    u[i] = scale * re[i];
    v[i] = scale * (lambda[0] * re[i] - lambda[1] * im[i]);
  }
  PetscCall(PetscFree2(re, im));
  PetscFunctionReturn(0);
}

/* u += A re, v += A (sigma re - omega im) */
static PetscErrorCode StartAddShape(Dynamics d, PetscReal u[], PetscReal v[])
{
  const PetscInt n = d->layout->n_vertices;
  PetscReal     *du, *dv;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &du, 3 * n, &dv));
  PetscCall(DynamicsGetShape(d, du, dv));
  for (PetscInt i = 0; i < n; i++) {
    if (d->layout->at[i] < 0) continue;
    LayoutAdd(d->layout, i, &du[3 * i], u);
    LayoutAdd(d->layout, i, &dv[3 * i], v);
  }
  PetscCall(PetscFree2(du, dv));
  PetscFunctionReturn(0);
}

/* 1e-10 of the largest extent about the origin, m: rounding of coordinates is no penetration */
static PetscErrorCode StartFindSlack(Dynamics d, PetscReal *slack)
{
  const Mesh *mesh;
  PetscReal   range[2] = {0, 0}; /* largest and smallest coordinate, as maxima */

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(d->model, &mesh));
  for (PetscInt i = 0; i < 3 * d->layout->n_vertices; i++) {
    range[0] = PetscMax(range[0], mesh->x[i]);
    range[1] = PetscMax(range[1], -mesh->x[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, d->comm));
  *slack = 1e-10 * (range[0] + range[1]);
  PetscFunctionReturn(0);
}

/* Contact surfaces at displacements u: pairs, and forces of the sliding state where it is the start */
static PetscErrorCode StartContact(Dynamics d, const PetscReal u[])
{
  const ContactState *states = NULL;
  PetscReal           slack;

  PetscFunctionBeginUser;
  if (!d->projector) PetscFunctionReturn(0);
  if (d->start == START_STATIC) PetscCall(StaticsGetState(d->statics, &states, NULL));
  for (PetscInt i = 0; i < d->surface.n; i++) LayoutGet(d->layout, d->surface.vertex[i], u, &d->surface.u[3 * i]);
  PetscCall(StartFindSlack(d, &slack));
  if (d->shape[0]) slack += PetscAbsReal(d->shape_amplitude);
  PetscCall(ContactProjectorStart(d->projector, 0, d->surface.u, slack, states));
  PetscFunctionReturn(0);
}

/* Raises the error for gaps of a file, which the mesh does not have as it moves */
static PetscErrorCode StartCheckGaps(Dynamics d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n_interfaces; i++)
    PetscCheck(!d->interfaces[i].n_gaps, d->comm, PETSC_ERR_USER_INPUT,
               "-%s_gap %s: -dynamics_start static on the mesh has no gaps but those of the mesh; leave it out, or "
               "choose -dynamics_model reduced",
               d->interfaces[i].name, d->interfaces[i].gap_file);
  PetscFunctionReturn(0);
}

/* Raises the error for motions that go on: on the mesh the sliding state holds their nodes */
static PetscErrorCode StartCheckMoving(Dynamics d)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(d->model, &scene));
  for (PetscInt i = 0; i < scene->n_motions; i++)
    PetscCheck(!RampVaries(ExternalGetMotion(d->external, i)), d->comm, PETSC_ERR_SUP,
               "-%s_frequency or _history: -dynamics_start static on the mesh has motions that stay; take "
               "-dynamics_start rest, or -dynamics_model reduced",
               scene->motions[i].name);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsStartState(Dynamics d)
{
  PetscScalar *u, *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArray(d->u, &u));
  PetscCall(VecGetArray(d->v, &v));
  PetscCall(ExternalSetVelocity(d->external, v));
  if (d->start == START_STATIC) {
    Vec displacement;

    PetscCall(DynamicsCheckStatic(d));
    PetscCall(DynamicsCheckExact(d));
    PetscCall(StartCheckGaps(d));
    PetscCall(StartCheckMoving(d));
    PetscCall(StaticsCheckLasting(d->statics));
    PetscCall(StaticsSolve(d->statics, NULL));
    PetscCall(StaticsGetState(d->statics, NULL, &displacement));
    PetscCall(ExternalDrawBolts(d->external, d->statics));
    PetscCall(StateVectorFromDisplacements(d->model, d->layout, displacement, u));
  }
  if (d->shape[0]) PetscCall(StartAddShape(d, u, v));
  PetscCall(BodiesMakeRigid(d->bodies, u));
  PetscCall(BodiesMakeRigid(d->bodies, v));
  PetscCall(StartContact(d, u));
  PetscCall(BodiesSetState(d->bodies, u, v, d->ku));
  PetscCall(VecRestoreArray(d->v, &v));
  PetscCall(VecRestoreArray(d->u, &u));
  PetscFunctionReturn(0);
}
