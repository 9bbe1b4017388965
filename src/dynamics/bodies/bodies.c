/*
   Bodies: life cycle, masses, and the order of work in a step: what touches shared nodes first, then its exchange
   while the rest is done.
*/
#include "bodiesimpl.h"
#include "base/events.h"
#include <squeal/quantity.h>

/* Lumped masses (kg) of this rank's cells (part), complete ones (total, summed over the ranks that share a node),
   and 1 / total (minv), 0 where a component has a part along a held direction */
static PetscErrorCode BodiesSetMasses(Bodies b)
{
  Layout *l = &b->layout;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(l->n, &l->part, l->n, &l->total, l->n, &l->minv));
  for (PetscInt i = 0; i < b->n_swept; i++) {
    const SweptBody *s = &b->swept[i];

    for (PetscInt row = 0; row < 3 * s->lines->n_lines; row++)
      PetscCall(PetscArraycpy(&l->part[s->begin + row * s->stride], &s->mass[row / 3 * s->stride], s->stride));
  }
  for (PetscInt i = 0; i < 3 * b->general.n; i++) l->part[b->general.begin + i] = b->general.mass[i / 3];
  PetscCall(PetscArraycpy(l->total, l->part, l->n));
  PetscCall(SharedBegin(&b->share, l, l->total));
  PetscCall(SharedEnd(&b->share, l, l->total));
  for (PetscInt v = 0; v < l->n_vertices; v++) {
    if (l->at[v] < 0) continue;
    for (PetscInt j = 0; j < 3; j++) {
      const PetscInt at   = l->at[v] + j * l->step[v];
      PetscBool      held = PETSC_FALSE;

      for (int d = 0; d < 3; d++)
        if (b->mesh->unknown[3 * v + d] < 0 && l->basis[9 * v + 3 * j + d] != 0) held = PETSC_TRUE;
      l->minv[at] = held ? 0 : 1 / l->total[at];
    }
  }
  PetscFunctionReturn(0);
}

/* Whether any rank has damping, and then room for its forces: all ranks need it alike, as sums at shared nodes hold
   those of others. */
static PetscErrorCode BodiesSetUpDamping(Bodies b)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(b->model, &scene));
  for (PetscInt i = 0; i < scene->n_parts; i++)
    if (scene->parts[i].alpha != 0 || scene->parts[i].beta != 0) b->damped = PETSC_TRUE;
  for (PetscInt i = 0; i < b->n_points; i++)
    for (int j = 0; j < 9; j++)
      if (b->point[i].damping[j] != 0) b->damped = PETSC_TRUE;
  for (PetscInt i = 0; i < b->n_joints; i++)
    for (int j = 0; j < 6; j++)
      if (b->joint[i].like->viscosity[j] != 0) b->damped = PETSC_TRUE;
  if (b->super.all.C || b->n_branches) b->damped = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &b->damped, 1, MPIU_BOOL, MPI_LOR, b->comm));
  if (b->damped) PetscCall(PetscCalloc1(b->layout.n, &b->layout.damping));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesCreate(MPI_Comm comm, Bodies *bodies)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(bodies));
  (*bodies)->comm       = comm;
  (*bodies)->share.comm = MPI_COMM_NULL;
  PetscFunctionReturn(0);
}

static const char *const kernels[] = {[PETSC_FALSE] = "auto", [PETSC_TRUE] = "general", NULL};
static const Quantity kernel[] = {{"-dynamics_kernel", "internal forces; general: one matrix of blocks for every body",
                                   NULL, QUANTITY_WORD, QUANTITY_AT(struct _p_Bodies, no_sweep), .words = kernels}};
static const QuantityTable bodies_quantities = {"Bodies in time", "dynamics.h", 1, kernel, .in = RUN_MESH};

PetscErrorCode BodiesSetFromOptions(Bodies b)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(b->comm, &bodies_quantities, b));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesVisit(Bodies b, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &bodies_quantities, NULL, b, NULL));
  PetscFunctionReturn(0);
}

/* Shared nodes are found first, as layout and ranges put them in front; points come after the layout in whose
   places they stand; masses after all cells are known. */
PetscErrorCode BodiesSetUp(Bodies b, Operators operators)
{
  PetscFunctionBeginUser;
  b->operators = operators;
  PetscCall(OperatorsGetModel(operators, &b->model, NULL));
  PetscCheck(b->model, b->comm, PETSC_ERR_ARG_WRONGSTATE, "bodies need a model: loaded matrices have none");
  PetscCall(ModelGetMesh(b->model, &b->mesh));
  b->layout.n_vertices = b->mesh->n_nodes;
  b->layout.owned      = b->mesh->owned;
  PetscCall(ModelGetBodies(b->model, &b->n_bodies, &b->body));
  PetscCall(SharedSetUp(b));
  PetscCall(BodiesFindSwept(b));
  PetscCall(BodiesLayOut(b));
  PetscCall(SuperLayOut(b));
  PetscCall(GeneralSetUp(b));
  PetscCall(BranchesSetUp(b));
  PetscCall(PointsSetUp(b));
  PetscCall(JointsSetUpRows(b));
  PetscCall(BodiesSetMasses(b));
  PetscCall(SuperSetMasses(b));
  PetscCall(BodiesSetUpDamping(b));
  for (int i = 0; i < 2; i++) PetscCall(PetscCalloc1(b->layout.n, &b->work[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesGetLayout(Bodies b, const Layout **layout)
{
  PetscFunctionBeginUser;
  *layout = &b->layout;
  PetscFunctionReturn(0);
}

/* Component j of a node is driven from outside: without inverse mass the integrator leaves its velocity alone. */
PetscErrorCode BodiesHold(Bodies b, PetscInt vertex, PetscInt j)
{
  PetscFunctionBeginUser;
  if (b->layout.at[vertex] >= 0) b->layout.minv[b->layout.at[vertex] + j * b->layout.step[vertex]] = 0;
  PetscFunctionReturn(0);
}

/* The kernels on the nodes that ranks share (early), or on the others. ku and d of a shared node stay the part of
   this rank; f alone is summed over the ranks. */
static PetscErrorCode BodiesAdvanceKernels(Bodies b, PetscBool early, BodiesWork *w)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->n_swept; i++) PetscCall(SweptAdvance(&b->swept[i], early, w));
  PetscCall(GeneralAdvance(&b->general, early, w));
  PointsAdvance(b, early, w);
  PetscCall(JointsAdvance(b, early, w));
  PetscCall(SuperAdvance(b, early, w));
  PetscFunctionReturn(0);
}

/* The sum at shared nodes is under way while the others are advanced; the sums of energies are of this rank */
PetscErrorCode BodiesAdvance(Bodies b, const BodiesStep *step, BodiesSums *sums)
{
  /* v is written to at its padding alone, which is as before in the end */
  BodiesWork w = {
    .dt = step->dt, .u = step->u, .v = (PetscReal *)step->v, .ku = step->ku, .f = step->f, .d = b->layout.damping};

  PetscFunctionBeginUser;
  PetscCall(BodiesAdvanceKernels(b, PETSC_TRUE, &w));
  BranchesAdvance(b, PETSC_TRUE, &w);
  PetscCall(SharedBegin(&b->share, &b->layout, w.f));
  PetscCall(BodiesAdvanceKernels(b, PETSC_FALSE, &w));
  BranchesAdvance(b, PETSC_FALSE, &w);
  PetscCall(EventBegin(EVENT_EXCHANGE));
  PetscCall(SharedEnd(&b->share, &b->layout, w.f));
  PetscCall(EventEnd(EVENT_EXCHANGE));
  *sums = w.sums;
  PetscFunctionReturn(0);
}

/* Zeros in held directions and padding */
static void BodiesClearHeld(Bodies b, PetscReal x[])
{
  for (PetscInt i = 0; i < b->layout.n; i++)
    if (b->layout.minv[i] == 0) x[i] = 0;
}

/* A step of dt = 1 from ku = 0 with v = x leaves K x in ku and C x in d: the kernels serve as operators of their
   own critical step */
PetscErrorCode BodiesApply(Bodies b, const PetscReal x[], PetscReal kx[], PetscReal cx[])
{
  PetscReal *const k = kx ? kx : b->work[0], *const c = cx && b->damped ? cx : NULL;
  BodiesWork w = {.dt = 1, .u = x, .v = (PetscReal *)x, .ku = k, .f = b->work[1], .d = c};

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(k, b->layout.n));
  if (cx) PetscCall(PetscArrayzero(cx, b->layout.n));
  for (int early = 1; early >= 0; early--) PetscCall(BodiesAdvanceKernels(b, (PetscBool)early, &w));
  BranchesAddStiffness(b, x, k);
  for (int i = 0; i < 2; i++) {
    PetscReal *y = i ? cx : kx;

    if (!y) continue;
    PetscCall(SharedBegin(&b->share, &b->layout, y));
    PetscCall(SharedEnd(&b->share, &b->layout, y));
    BodiesClearHeld(b, y);
  }
  PetscFunctionReturn(0);
}

/* K u by another way than the kernels, free of the rounding that u of a body far off has in them */
static PetscErrorCode BodiesGetElementForces(Bodies b, const PetscReal u[], PetscReal ku[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(ku, b->layout.n));
  PetscCall(BodiesCellsAddForces(b, u, ku));
  PointsAddForces(b, u, ku);
  PetscCall(JointsAddForces(b, u, ku));
  PetscCall(SuperAddForces(b, u, ku));
  PetscFunctionReturn(0);
}

/* ku of given displacements by the elements, and damping forces of given velocities by the kernels, dt = 0: a state
   from which steps go on. */
PetscErrorCode BodiesSetState(Bodies b, const PetscReal u[], const PetscReal v[], PetscReal ku[])
{
  BodiesWork w = {.dt = 0, .u = u, .v = (PetscReal *)v, .ku = b->work[0], .f = b->work[1], .d = b->layout.damping};

  PetscFunctionBeginUser;
  if (b->damped) {
    PetscCall(PetscArrayzero(b->work[0], b->layout.n));
    for (int early = 1; early >= 0; early--) PetscCall(BodiesAdvanceKernels(b, (PetscBool)early, &w));
  }
  PetscCall(BodiesGetElementForces(b, u, ku));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesGetMemory(Bodies b, PetscInt *n, PetscReal **forces)
{
  PetscFunctionBeginUser;
  *n      = b->n_branch_forces;
  *forces = b->branch_forces;
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesAddChecksum(Bodies b, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "-dynamics_kernel"));
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){b->no_sweep}));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesDestroy(Bodies *bodies)
{
  Bodies b = *bodies;

  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < b->n_swept; i++) PetscCall(SweptDestroy(&b->swept[i]));
  PetscCall(GeneralDestroy(&b->general));
  PetscCall(SharedDestroy(&b->share));
  PetscCall(PetscFree(b->swept));
  PetscCall(PetscFree(b->point));
  PetscCall(JointsDestroyRows(b));
  PetscCall(TiedDestroy(&b->tied));
  PetscCall(SuperDestroy(b));
  PetscCall(BranchesDestroy(b));
  PetscCall(PetscFree(b->frame));
  PetscCall(PetscFree(b->body));
  PetscCall(PetscFree2(b->layout.at, b->layout.step));
  PetscCall(PetscFree(b->layout.basis));
  PetscCall(PetscFree3(b->layout.part, b->layout.total, b->layout.minv));
  for (int i = 0; i < 2; i++) PetscCall(PetscFree(b->work[i]));
  PetscCall(PetscFree(b->layout.damping));
  PetscCall(PetscFree(*bodies));
  PetscFunctionReturn(0);
}
