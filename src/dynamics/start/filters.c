/*
   Modal filters of a run of modes about the sliding state (modes/output/filter.c), laid on the state vectors of this
   run: the amplitude of mode k is c_k = a_k^T (u - u_0) + b_k^T v, m, with u_0 the displacements of the sliding state
   under the whole loads. They are those of this run only where the matrices of both are the same: lumped mass, exact
   contact, the status of the sliding state.
*/
#include "dynamics/dynamicsimpl.h"
#include "shape.h"

/* Lays a weight on a state vector, every unknown on one rank, begin <= row < end: copies would count twice in a'u */
static PetscErrorCode FilterLay(Dynamics d, const PetscInt range[2], PetscReal weight[], PetscReal state[])
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(d->model, &mesh));
  PetscCall(PetscArrayzero(state, d->layout->n));
  for (PetscInt i = 0; i < d->layout->n_vertices; i++) {
    if (d->layout->at[i] < 0) continue;
    for (int c = 0; c < 3; c++) {
      const PetscInt row = mesh->unknown[3 * i + c];

      if (row < range[0] || row >= range[1]) weight[3 * i + c] = 0;
    }
    LayoutSet(d->layout, i, &weight[3 * i], state);
  }
  PetscFunctionReturn(0);
}

/* Weights of one mode, of displacements (kind _u) or velocities (_v): state [2][layout n], real and imaginary part */
static PetscErrorCode FilterRead(Dynamics d, PetscInt mode, const char kind[], const PetscInt range[2],
                                 PetscReal state[])
{
  const ShapeSource source = {
    "-dynamics_filters", "-dynamics_filters_modes", "-modes_filters", d->filters_dir, "filters.h5", kind, mode};
  PetscReal *re, *im, lambda[2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(3 * d->layout->n_vertices, &re, 3 * d->layout->n_vertices, &im));
  PetscCall(ShapeRead(d->model, &source, re, im, lambda));
  PetscCall(FilterLay(d, range, re, state));
  PetscCall(FilterLay(d, range, im, state + d->layout->n));
  PetscCall(PetscFree2(re, im));
  PetscFunctionReturn(0);
}

/* What the filters give of the sliding state: rest [n][2], m */
static PetscErrorCode FiltersAtRest(Dynamics d, Vec displacement)
{
  const PetscInt  n    = d->layout->n;
  HistoryFilters *f    = &d->filters;
  PetscReal      *rest = f->rest, *u;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &u));
  PetscCall(StateVectorFromDisplacements(d->model, d->layout, displacement, u));
  for (PetscInt i = 0; i < 2 * f->n; i++) {
    rest[i] = 0;
    for (PetscInt k = 0; k < n; k++) rest[i] += f->u[i * n + k] * u[k];
  }
  PetscCall(PetscFree(u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rest, (PetscMPIInt)(2 * f->n), MPIU_REAL, MPI_SUM, d->comm));
  PetscFunctionReturn(0);
}

/* A part that turns is described in a frame of its own, the modes are not */
static PetscErrorCode FiltersCheckFrames(Dynamics d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    PetscReal rotation[3];
    PetscBool turns;

    PetscCall(ContactProjectorGetTurning(d->projector, i, &turns, rotation));
    PetscCheck(!turns, d->comm, PETSC_ERR_USER_INPUT,
               "-dynamics_filters: -%s_kinematics turning describes a part in a frame that turns, and the modes are "
               "those of a fixed one; leave out one of the two",
               d->interfaces[i].name);
  }
  PetscFunctionReturn(0);
}

/* The modes that are asked for: numbers given, or all unstable ones */
static PetscErrorCode FiltersListModes(Dynamics d)
{
  HistoryFilters *f = &d->filters;

  PetscFunctionBeginUser;
  if (!f->n)
    PetscCall(ShapeListUnstable(d->comm, &(ShapeSource){.option = "-dynamics_filters", .dir = d->filters_dir}, &f->n,
                                &f->mode));
  PetscCheck(f->n, d->comm, PETSC_ERR_USER_INPUT,
             "%s/modes.csv of -dynamics_filters has no unstable mode; say which with -dynamics_filters_modes",
             d->filters_dir);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetFilters(Dynamics d)
{
  const PetscInt  n = d->layout->n;
  HistoryFilters *f = &d->filters;
  PetscInt        range[2];
  Vec             displacement;

  PetscFunctionBeginUser;
  if (!d->filters_dir[0]) PetscFunctionReturn(0);
  PetscCall(FiltersCheckFrames(d));
  PetscCall(FiltersListModes(d));
  PetscCall(StaticsCheckLasting(d->statics));
  PetscCall(StaticsSolve(d->statics, NULL));
  PetscCall(StaticsGetState(d->statics, NULL, &displacement));
  PetscCall(VecGetOwnershipRange(displacement, &range[0], &range[1]));
  PetscCall(PetscMalloc3(2 * f->n * n, &f->u, 2 * f->n * n, &f->v, 2 * f->n, &f->rest));
  for (PetscInt i = 0; i < f->n; i++) {
    PetscCall(FilterRead(d, f->mode[i], "_u", range, &f->u[2 * i * n]));
    PetscCall(FilterRead(d, f->mode[i], "_v", range, &f->v[2 * i * n]));
  }
  PetscCall(FiltersAtRest(d, displacement));
  PetscCall(HistorySetFilters(d->history, f));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsDestroyFilters(Dynamics d)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(d->filters.mode));
  PetscCall(PetscFree3(d->filters.u, d->filters.v, d->filters.rest));
  PetscFunctionReturn(0);
}
