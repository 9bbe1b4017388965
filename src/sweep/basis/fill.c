/*
   Bases that need no choice of points: all unit vectors, for a small system, and the basis of today's tools, for
   comparison: the lowest real modes of the frictionless, undamped system at one point. That one knows nothing of
   friction, and no estimate of its error is to be had.
*/
#include "basis.h"

#define WHOLE 200 /* unknowns up to which the basis is the whole space */

/* The model of all that the block holds; frees the block */
static PetscErrorCode BasisTake(Basis *basis, BV *block, PetscInt *n_added)
{
  PetscFunctionBeginUser;
  PetscCall(BasisAdd(basis, *block, 0, n_added));
  PetscCall(BasisPromote(basis));
  PetscCall(BVDestroy(block));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisFillWhole(Basis *basis, PetscBool *whole)
{
  PetscInt n, first, last, n_added;
  BV       block;

  PetscFunctionBeginUser;
  *whole = PETSC_FALSE;
  PetscCall(MatGetSize(basis->M, &n, NULL));
  if (n > WHOLE) PetscFunctionReturn(0);
  PetscCall(BasisCreateBlock(basis, n, &block));
  PetscCall(MatGetOwnershipRange(basis->M, &first, &last));
  for (PetscInt i = 0; i < n; i++) {
    Vec unit;

    PetscCall(BVGetColumn(block, i, &unit));
    PetscCall(VecSet(unit, 0));
    if (i >= first && i < last) PetscCall(VecSetValue(unit, i, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(unit));
    PetscCall(VecAssemblyEnd(unit));
    PetscCall(BVRestoreColumn(block, i, &unit));
  }
  PetscCall(BasisTake(basis, &block, &n_added));
  *whole = n_added == n ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode BasisFillReal(Basis *basis, Modes modes, PetscInt n_modes, PetscReal p[])
{
  const Mode *mode;
  PetscReal   band[2], growth;
  PetscInt    n;
  BV          block;

  PetscFunctionBeginUser;
  PetscCheck(ReducedFrictionless(&basis->reduced, p), basis->comm, PETSC_ERR_USER_INPUT,
             "-sweep_method real: the matrices cannot be made frictionless; use reduced");
  PetscCall(PencilSetParameters(basis->pencil, p));
  PetscCall(ModesGetBand(modes, band, &growth));
  PetscCall(ModesSetNearest(modes, 0, n_modes));
  PetscCall(ModesSolve(modes));
  PetscCall(ModesSetBand(modes, band));
  PetscCall(ModesGet(modes, &n, &mode));
  PetscCall(BasisCreateBlock(basis, n, &block));
  for (PetscInt i = 0; i < n; i++) {
    Vec u, q;

    PetscCall(ModesGetVectors(modes, i, &u, NULL, NULL, NULL));
    PetscCall(BVGetColumn(block, i, &q));
    PetscCall(PencilRestrict(basis->pencil, u, q));
    PetscCall(BVRestoreColumn(block, i, &q));
  }
  PetscCall(BasisTake(basis, &block, NULL));
  PetscFunctionReturn(0);
}
