/*
   Which displacements follow others, and by which rows of D (dependents.c): a list claims an unknown, then gives its
   row.
*/
#include "dependents.h"

PetscErrorCode DependentsClaim(Dependents *d, PetscInt unknown, PetscInt by)
{
  const PetscInt i = unknown - d->first;

  PetscFunctionBeginUser;
  if (i < 0 || i >= d->n || d->D) PetscFunctionReturn(0);
  if (d->by[i] >= 0) d->conflict = PetscMax(d->conflict, d->by[i] * d->n_lists + by);
  d->by[i] = by;
  PetscFunctionReturn(0);
}

PetscErrorCode DependentsFollow(Dependents *d, PetscInt unknown, PetscInt n, const PetscInt column[],
                                const PetscReal value[])
{
  const PetscInt i = unknown - d->first;

  PetscFunctionBeginUser;
  if (i < 0 || i >= d->n) PetscFunctionReturn(0);
  if (!d->D) d->follows[i] = PETSC_TRUE;
  for (PetscInt k = 0; k < n; k++) {
    if (column[k] < 0 || value[k] == 0) continue;
    if (!d->D)
      d->count[i]++;
    else
      PetscCall(MatSetValue(d->D, unknown, column[k], value[k], ADD_VALUES));
  }
  PetscFunctionReturn(0);
}
