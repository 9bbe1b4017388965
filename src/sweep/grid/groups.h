/* Private to sweep/: groups of pairs that open and close together, as parameters of a pencil */
#pragma once

#include "status.h"
#include <squeal/pencil.h>

/* A pencil that holds at all statuses of a list: n_groups parameters closed_g stand behind those of the operators */
typedef struct {
  Pencil     pencil;
  PetscInt   n_groups, n_parameters;
  PetscReal *closed; /* [statuses][n_groups] 1 closed, 0 open */
} StatusPencil;

/* Makes it; not where `exact` is returned as true: pairs of a group obey the exact constraint, which is no affine term.
   Collective. The pencil and `closed` are the caller's. */
PetscErrorCode StatusPencilCreate(const StatusList *list, Operators operators, PetscBool *exact, StatusPencil *made);
/* Forms the matrices at p [n_parameters] (closed_g are overwritten) with all groups closed, with and without friction,
   so that their pattern holds every term, whichever point comes first: no later sum then meets an entry without a
   place. Collective. */
PetscErrorCode StatusPencilFormPattern(const StatusPencil *made, PetscReal p[]);
