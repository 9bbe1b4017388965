/*
   Contact statuses. Pairs are grouped by refinement: one group of all pairs is divided status by status into those that
   are closed there and those that are open. What is left together has been open and closed together everywhere, and the
   stiffness of the group is one term of the pencil with the coefficient 0 or 1.
*/
#include "status.h"

PetscErrorCode StatusListCreate(MPI_Comm comm, PetscInt n_local, StatusList *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(list, sizeof(*list)));
  list->comm    = comm;
  list->n_local = n_local;
  PetscCallMPI(MPI_Allreduce(&n_local, &list->n_pairs, 1, MPIU_INT, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* The status of the list that equals this one on all ranks, or -1. One reduction for all statuses of the list. */
static PetscErrorCode StatusFind(const StatusList *list, const PetscBool closed[], PetscInt *index)
{
  PetscMPIInt n;
  PetscBool  *same;

  PetscFunctionBeginUser;
  *index = -1;
  PetscCall(PetscMPIIntCast(list->n, &n));
  PetscCall(PetscMalloc1(list->n, &same));
  for (PetscInt s = 0; s < list->n; s++)
    PetscCall(PetscArraycmp(closed, list->closed + s * list->n_local, list->n_local, &same[s]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, same, n, MPIU_BOOL, MPI_LAND, list->comm));
  for (PetscInt s = 0; s < list->n && *index < 0; s++)
    if (same[s]) *index = s;
  PetscCall(PetscFree(same));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusListAdd(StatusList *list, const PetscBool closed[], PetscInt *index)
{
  PetscInt n_closed = 0;

  PetscFunctionBeginUser;
  PetscCall(StatusFind(list, closed, index));
  if (*index >= 0) PetscFunctionReturn(0);
  *index = list->n++;
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)list->n, &list->n_closed));
  PetscCall(PetscRealloc(sizeof(PetscBool) * (size_t)(list->n * list->n_local + 1), &list->closed));
  PetscCall(PetscArraycpy(list->closed + *index * list->n_local, closed, list->n_local));
  for (PetscInt p = 0; p < list->n_local; p++) n_closed += closed[p] ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(&n_closed, &list->n_closed[*index], 1, MPIU_INT, MPI_SUM, list->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusListNearest(const StatusList *list, PetscInt n, const PetscBool closed[], PetscInt *index,
                                 PetscInt *apart)
{
  PetscMPIInt length;
  PetscInt   *differ;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n, &length));
  PetscCall(PetscCalloc1(n, &differ));
  for (PetscInt s = 0; s < n; s++)
    for (PetscInt p = 0; p < list->n_local; p++) differ[s] += closed[p] != list->closed[s * list->n_local + p] ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, differ, length, MPIU_INT, MPI_SUM, list->comm));
  *index = 0;
  for (PetscInt s = 1; s < n; s++)
    if (differ[s] < differ[*index]) *index = s;
  *apart = differ[*index];
  PetscCall(PetscFree(differ));
  PetscFunctionReturn(0);
}

/* Divides the n groups of pairs by status s: group g gives 2 g (open there) and 2 g + 1 (closed), of which those
   that some rank has pairs of are numbered anew, in this order on all ranks. n never exceeds the number of pairs. */
static PetscErrorCode GroupsDivide(const StatusList *list, PetscInt s, PetscInt *n, PetscInt group[])
{
  const PetscBool *closed = list->closed + s * list->n_local;
  PetscInt        *number, n_new = 0;
  PetscMPIInt      length;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(2 * *n, &length));
  PetscCall(PetscCalloc1(2 * *n, &number));
  for (PetscInt p = 0; p < list->n_local; p++) number[2 * group[p] + (closed[p] ? 1 : 0)] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, number, length, MPIU_INT, MPI_MAX, list->comm));
  for (PetscInt k = 0; k < 2 * *n; k++)
    if (number[k]) number[k] = n_new++;
  for (PetscInt p = 0; p < list->n_local; p++) group[p] = number[2 * group[p] + (closed[p] ? 1 : 0)];
  *n = PetscMax(1, n_new);
  PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}

/* history [n][statuses] = 1 where the group is closed. All pairs of a group agree; ranks without pairs of it have
   zeros, hence the maximum. */
static PetscErrorCode GroupsHistory(const StatusList *list, PetscInt n, const PetscInt group[], PetscInt history[])
{
  PetscMPIInt length;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(n * list->n, &length));
  PetscCall(PetscArrayzero(history, n * list->n));
  for (PetscInt s = 0; s < list->n; s++)
    for (PetscInt p = 0; p < list->n_local; p++)
      if (list->closed[s * list->n_local + p]) history[group[p] * list->n + s] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, history, length, MPIU_INT, MPI_MAX, list->comm));
  PetscFunctionReturn(0);
}

/* group [pairs]: -1 open everywhere, 0 closed everywhere, else 1, 2, ... of n_groups; value [statuses][n_groups] =
   closed_g. */
PetscErrorCode StatusListGroup(const StatusList *list, PetscInt group[], PetscInt *n_groups, PetscReal **value)
{
  PetscInt *history, *number, n = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(group, list->n_local));
  for (PetscInt s = 0; s < list->n; s++) PetscCall(GroupsDivide(list, s, &n, group));
  PetscCall(PetscMalloc2(n * list->n, &history, n, &number));
  PetscCall(GroupsHistory(list, n, group, history));
  *n_groups = 0;
  for (PetscInt g = 0; g < n; g++) {
    PetscInt sum = 0;

    for (PetscInt s = 0; s < list->n; s++) sum += history[g * list->n + s];
    number[g] = sum == 0 ? -1 : sum == list->n ? 0 : ++*n_groups;
  }
  PetscCall(PetscMalloc1(list->n * *n_groups, value));
  for (PetscInt g = 0; g < n; g++)
    for (PetscInt s = 0; s < list->n && number[g] > 0; s++)
      (*value)[s * *n_groups + number[g] - 1] = (PetscReal)history[g * list->n + s];
  for (PetscInt p = 0; p < list->n_local; p++) group[p] = number[group[p]];
  PetscCall(PetscFree2(history, number));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusListDestroy(StatusList *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(list->closed));
  PetscCall(PetscFree(list->n_closed));
  list->n = 0;
  PetscFunctionReturn(0);
}
