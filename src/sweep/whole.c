/*
   A small system needs no reduction: its basis is the whole space.
*/
#include "sweepimpl.h"

#define WHOLE 200 /* unknowns up to which it is */

PetscErrorCode SweepWholeBasis(Sweep sweep, PetscBool *whole)
{
  PetscInt n, first, last, n_added;
  BV       block;

  PetscFunctionBeginUser;
  *whole = PETSC_FALSE;
  PetscCall(MatGetSize(sweep->basis.M, &n, NULL));
  if (n > WHOLE) PetscFunctionReturn(0);
  PetscCall(BasisCreateBlock(&sweep->basis, n, &block));
  for (PetscInt i = 0; i < n; i++) {
    Vec unit;

    PetscCall(BVGetColumn(block, i, &unit));
    PetscCall(VecSet(unit, 0));
    PetscCall(VecGetOwnershipRange(unit, &first, &last));
    if (i >= first && i < last) PetscCall(VecSetValue(unit, i, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(unit));
    PetscCall(VecAssemblyEnd(unit));
    PetscCall(BVRestoreColumn(block, i, &unit));
  }
  PetscCall(BasisAdd(&sweep->basis, block, 0, &n_added));
  PetscCall(BVDestroy(&block));
  PetscCall(BasisPromote(&sweep->basis));
  *whole = n_added == n ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}
