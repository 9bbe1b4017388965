/*
   Many points on the reduced model. Each point is a dense problem of its own, so ranks share the points, not a point;
   the results are then sent to all ranks, bit by bit the same.

   Errors are handed on POINTS_MARGIN times those of estimate.c, which see what the added vectors tell and no more: over
   5,657 eigenvalues of scripts/study/errors the true error is at most 0.91 of what is handed on. While the model is the
   same, only vectors that tell its error being added, solutions serve again.
*/
#include "points.h"
#include "base/process/progress.h"

/* Points: at 200 vectors and 60 modes each takes some 0.4 MB. More than the greedy choice looks at. */
#define STORE_MOST 128

/* Forgets all solutions where they are not those of this model and window. Vectors in use change the model, n_used
   with them; vectors that are only added do not. */
static PetscErrorCode PointStoreReset(PointStore *store, const Reduced *reduced, const ReducedWindow *window)
{
  const PetscInt n_used = reduced->n_used;
  PetscBool      same;

  PetscFunctionBeginUser;
  PetscCall(PetscMemcmp(&store->window, window, sizeof(*window), &same));
  if (same && store->n_used == n_used) PetscFunctionReturn(0);
  PetscCall(PointStoreDestroy(store));
  store->n_used = n_used;
  store->window = *window;
  PetscCall(PetscCalloc4(STORE_MOST * reduced->n_parameters, &store->p, STORE_MOST, &store->all, STORE_MOST,
                         &store->modes, STORE_MOST, &store->estimated));
  PetscFunctionReturn(0);
}

PetscErrorCode PointStoreDestroy(PointStore *store)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < store->n; i++) {
    PetscCall(ReducedModesDestroy(&store->all[i]));
    PetscCall(ReducedModesDestroy(&store->modes[i]));
  }
  PetscCall(PetscFree4(store->p, store->all, store->modes, store->estimated));
  store->n = store->n_used = 0;
  PetscFunctionReturn(0);
}

/* The point with these values, or -1 */
static PetscErrorCode PointStoreFind(const PointStore *store, PetscInt n_parameters, const PetscReal p[], PetscInt *at)
{
  PetscBool same = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*at = 0; *at < store->n; ++*at) {
    PetscCall(PetscMemcmp(&store->p[*at * n_parameters], p, (size_t)n_parameters * sizeof(*p), &same));
    if (same) PetscFunctionReturn(0);
  }
  *at = -1;
  PetscFunctionReturn(0);
}

/* error = margin (error - noise) + noise, rad/s: the margin, larger where looks at points found more than was stated,
   is on what Z tells. What was left out of the basis is added to both: it comes back however many are taken in */
PetscErrorCode PointEstimate(const Reduced *reduced, const PetscReal p[], ReducedModes *modes)
{
  const PetscReal margin = POINTS_MARGIN * PetscMax(1, reduced->beyond);

  PetscFunctionBeginUser;
  PetscCall(ReducedEstimate(reduced, p, modes));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal left_out = ReducedLeftOut(reduced, modes, i);

    modes->error[i] = margin * (modes->error[i] - modes->noise[i]) + modes->noise[i] + left_out;
    modes->noise[i] += left_out;
  }
  PetscFunctionReturn(0);
}

/* Errors of a stored point, and which of its modes beyond the growth they let pass, on the basis that there is now */
static PetscErrorCode StoredEstimate(PointStore *store, const Reduced *reduced, PetscInt at)
{
  const PetscReal *p = &store->p[at * reduced->n_parameters];

  PetscFunctionBeginUser;
  if (store->estimated[at] == reduced->n) PetscFunctionReturn(0);
  PetscCall(ReducedModesDestroy(&store->modes[at]));
  PetscCall(ReducedModesSelect(&store->all[at], store->all[at].n, NULL, &store->modes[at]));
  PetscCall(ReducedDropInexact(reduced, p, &store->window, &store->modes[at]));
  PetscCall(PointEstimate(reduced, p, &store->modes[at]));
  store->estimated[at] = reduced->n;
  PetscFunctionReturn(0);
}

/* Not collective. The eigenvalues are kept with the model, the errors with the size of the whole basis: after
   vectors were added the errors alone are computed again. The caller gets a copy. */
PetscErrorCode PointStoreSolve(PointStore *store, const Reduced *reduced, const ReducedWindow *window,
                               const PetscReal p[], ReducedModes *modes)
{
  PetscInt at;

  PetscFunctionBeginUser;
  if (store) {
    PetscCall(PointStoreReset(store, reduced, window));
    PetscCall(PointStoreFind(store, reduced->n_parameters, p, &at));
  }
  if (!store || (at < 0 && store->n == STORE_MOST)) {
    PetscCall(ReducedSolve(reduced, p, window, modes));
    PetscCall(PointEstimate(reduced, p, modes));
    PetscFunctionReturn(0);
  }
  if (at < 0) {
    at = store->n;
    PetscCall(PetscArraycpy(&store->p[at * reduced->n_parameters], p, reduced->n_parameters));
    PetscCall(ReducedSolveAll(reduced, p, window, &store->all[at]));
    store->n++;
  }
  PetscCall(StoredEstimate(store, reduced, at));
  PetscCall(ReducedModesSelect(&store->modes[at], store->modes[at].n, NULL, modes));
  PetscFunctionReturn(0);
}

/* Groups in turn, each on its first rank, spread evenly over the ranks. */
PetscMPIInt PointGroupsOwner(const PointGroups *groups, PetscInt i)
{
  PetscMPIInt size;

  MPI_Comm_size(groups->comm, &size);
  return (PetscMPIInt)((i % groups->n_groups) * size / groups->n_groups);
}

/* max (error - noise) / |lambda| of the modes in the window; with rounding, error / |lambda|. Rounding is left out
   where more vectors are to be decided on: no basis lowers it. */
PetscReal ReducedModesWorst(const ReducedModes *modes, const ReducedWindow *window, PetscBool rounding)
{
  PetscReal worst = 0;

  for (PetscInt i = 0; i < modes->n; i++)
    if (!modes->rigid[i] && cimag(modes->lambda[i]) >= window->low && cimag(modes->lambda[i]) <= window->high)
      worst = PetscMax(worst, (modes->error[i] - (rounding ? 0 : modes->noise[i])) / cabs(modes->lambda[i]));
  return worst;
}

/* Lengths first, then the arrays as numbers of twice the length where complex. On other ranks what they held is
   replaced. `sharp` is not sent: it serves inside the estimate alone. */
PetscErrorCode ReducedModesBroadcast(MPI_Comm comm, PetscMPIInt owner, ReducedModes *modes)
{
  PetscInt    length[2] = {modes->n, modes->size};
  PetscMPIInt rank, n, n_vector;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(length, 2, MPIU_INT, owner, comm));
  if (rank != owner) {
    PetscCall(ReducedModesDestroy(modes));
    PetscCall(ReducedModesCreate(length[0], length[1], modes));
  }
  PetscCall(PetscMPIIntCast(2 * length[0], &n));
  PetscCall(PetscMPIIntCast(2 * length[0] * length[1], &n_vector));
  PetscCallMPI(MPI_Bcast(modes->lambda, n, MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->product, n, MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->x, n_vector, MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->y, n_vector, MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->error, (PetscMPIInt)length[0], MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->noise, (PetscMPIInt)length[0], MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Bcast(modes->rigid, (PetscMPIInt)length[0], MPIU_BOOL, owner, comm));
  PetscFunctionReturn(0);
}

/* Each rank solves its own points without the others; the results are sent afterwards, in order, so that no rank
   waits inside the loop. */
PetscErrorCode PointsSolve(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window, PetscInt n,
                           const PetscReal points[], ReducedModes modes[])
{
  PetscMPIInt rank;
  Progress    progress;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(groups->comm, &rank));
  PetscCall(PetscMemzero(modes, (size_t)n * sizeof(*modes)));
  PetscCall(ProgressBegin(&progress, "points", n));
  for (PetscInt i = 0; i < n; i++) {
    if (PointGroupsOwner(groups, i) == rank)
      PetscCall(PointStoreSolve(groups->store, reduced, window, &points[i * reduced->n_parameters], &modes[i]));
    PetscCall(ProgressStep(&progress));
  }
  PetscCall(ProgressEnd(&progress));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(ReducedModesBroadcast(groups->comm, PointGroupsOwner(groups, i), &modes[i]));
  PetscFunctionReturn(0);
}

/* The same with nothing but the largest error of each point sent: one reduction of n numbers in place of all
   vectors. */
PetscErrorCode PointsEstimate(const PointGroups *groups, const Reduced *reduced, const ReducedWindow *window,
                              PetscInt n, const PetscReal points[], PetscReal worst[])
{
  PetscMPIInt rank, count;
  Progress    progress;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(groups->comm, &rank));
  PetscCall(ProgressBegin(&progress, "points of the basis", n));
  for (PetscInt i = 0; i < n; i++) {
    ReducedModes modes;

    worst[i] = 0;
    PetscCall(ProgressStep(&progress));
    if (PointGroupsOwner(groups, i) != rank) continue;
    PetscCall(PointStoreSolve(groups->store, reduced, window, &points[i * reduced->n_parameters], &modes));
    worst[i] = ReducedModesWorst(&modes, window, PETSC_FALSE);
    PetscCall(ReducedModesDestroy(&modes));
  }
  PetscCall(ProgressEnd(&progress));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, worst, count, MPIU_REAL, MPI_MAX, groups->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsScale(Pencil pencil, PetscInt n_points, const PetscReal points[], PetscReal scale[])
{
  const OperatorsParameter *parameters;
  PetscInt                  n, n_groups = 0;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParameters(pencil, &n, &parameters, NULL));
  for (PetscInt k = 0; k < n; k++) n_groups += parameters[k].internal ? 1 : 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscReal low = points[k], high = points[k];

    for (PetscInt i = 0; i < n_points; i++) {
      low  = PetscMin(low, points[i * n + k]);
      high = PetscMax(high, points[i * n + k]);
    }
    scale[k] = low > 0 && high > RATIO_FROM * low ? -PetscLogReal(high / low) : high - low;
    if (parameters[k].state) scale[k] = 0; /* no matrix depends on it */
    if (parameters[k].internal) scale[k] *= PetscSqrtReal((PetscReal)n_groups);
  }
  PetscFunctionReturn(0);
}
