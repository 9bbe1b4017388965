/*
   Many points on the reduced model. Each point is a dense problem of its own, so ranks share the points, not a point;
   the results are then sent to all ranks, bit by bit the same.
*/
#include "points.h"
#include "base/process/progress.h"

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
