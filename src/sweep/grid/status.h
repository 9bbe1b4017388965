/* Private to sweep/: the different contact statuses of a sweep, and the groups of pairs with a history in common */
#pragma once

#include <petscsys.h>

/* Statuses that differ in at least one pair */
typedef struct {
  MPI_Comm   comm;
  PetscInt   n_local, n_pairs; /* pairs of this rank, and of all */
  PetscInt   n;
  PetscBool *closed;   /* [n][n_local] */
  PetscInt  *n_closed; /* [n] pairs over all ranks */
} StatusList;

PetscErrorCode StatusListCreate(MPI_Comm comm, PetscInt n_local, StatusList *list);
/* Index of the status in which the local pairs are closed or not; a new one is appended. Collective. */
PetscErrorCode StatusListAdd(StatusList *list, const PetscBool closed[], PetscInt *index);
/* The one of the first n statuses that differs from this in the fewest pairs of all ranks, and in how many.
   Collective. */
PetscErrorCode StatusListNearest(const StatusList *list, PetscInt n, const PetscBool closed[], PetscInt *index,
                                 PetscInt *apart);
/* Groups of pairs that are open and closed together: group [n_local] 0 for those always closed, -1 for those never,
   1 .. n_groups for the others, numbered alike on all ranks; value [n][n_groups] = 1 where a group is closed, 0 where
   it is open, to be freed by the caller. Collective. */
PetscErrorCode StatusListGroup(const StatusList *list, PetscInt group[], PetscInt *n_groups, PetscReal **value);
PetscErrorCode StatusListDestroy(StatusList *list);
