/*
   Bases that need no choice of points: all unit vectors, for a small system, and, for comparison, the
   lowest real modes of the frictionless, undamped system at one point, as brake models usually are projected. They know
   nothing of friction, and no estimate of their error is to be had.
*/
#include "basis.h"

#define WHOLE 200 /* unknowns up to which the basis is the whole space */

PetscErrorCode BasisCreateModes(const Basis *basis, Modes modes, PetscInt n, PetscInt n_parts, BV *block)
{
  Vec      part[4], q;
  PetscInt m = 0;

  PetscFunctionBeginUser;
  PetscCall(BasisCreateBlock(basis, n_parts * n, block));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(ModesGetVectors(modes, i, &part[0], &part[1], &part[2], &part[3]));
    for (int k = 0; k < n_parts; k++) {
      if (!part[k]) continue;
      PetscCall(BVGetColumn(*block, m, &q));
      PetscCall(PencilRestrict(basis->pencil, part[k], q));
      PetscCall(BVRestoreColumn(*block, m++, &q));
    }
  }
  PetscCall(BVSetActiveColumns(*block, 0, m));
  PetscFunctionReturn(0);
}

/* The model of all that the block holds; frees the block */
static PetscErrorCode BasisTake(Basis *basis, BV *block, PetscInt *n_added)
{
  PetscFunctionBeginUser;
  PetscCall(BasisAdd(basis, *block, 0, n_added));
  PetscCall(BasisUse(basis, basis->reduced.n));
  PetscCall(BVDestroy(block));
  PetscFunctionReturn(0);
}

PetscErrorCode BasisFillWhole(Basis *basis, PetscBool *whole)
{
  PetscInt n, first, last, n_added;
  Mat      unit;
  BV       block;

  PetscFunctionBeginUser;
  *whole = PETSC_FALSE;
  PetscCall(MatGetSize(basis->M, &n, NULL));
  if (n > WHOLE) PetscFunctionReturn(0);
  PetscCall(BasisCreateBlock(basis, n, &block));
  PetscCall(MatGetOwnershipRange(basis->M, &first, &last));
  PetscCall(BVGetMat(block, &unit));
  PetscCall(MatZeroEntries(unit));
  for (PetscInt i = first; i < last; i++) PetscCall(MatSetValue(unit, i, i, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(unit, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(unit, MAT_FINAL_ASSEMBLY));
  PetscCall(BVRestoreMat(block, &unit));
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
             "-sweep_method real: the matrices cannot be made symmetric without friction and spin; use reduced");
  PetscCall(PencilSetParameters(basis->pencil, p));
  PetscCall(ModesGetBand(modes, band, &growth));
  PetscCall(ModesSetNearest(modes, 0, n_modes));
  PetscCall(ModesSolve(modes));
  PetscCall(ModesSetBand(modes, band));
  PetscCall(ModesGet(modes, &n, &mode));
  PetscCall(BasisCreateModes(basis, modes, n, 1, &block));
  PetscCall(BasisTake(basis, &block, NULL));
  PetscFunctionReturn(0);
}
