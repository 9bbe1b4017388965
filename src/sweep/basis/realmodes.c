/*
   The basis of today's tools, for comparison: the lowest real modes of the frictionless, undamped system in the middle
   of the sweep. It knows nothing of friction, and no estimate of its error is to be had.
*/
#include "sweep/sweepimpl.h"

PetscErrorCode SweepRealBasis(Sweep sweep)
{
  const Mode *mode;
  PetscReal  *p, band[2], growth;
  PetscInt    n;
  BV          block;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridPoint(&sweep->grid, GridSize(&sweep->grid) / 2, p);
  PetscCheck(ReducedFrictionless(&sweep->basis.reduced, p), sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_method real: the matrices cannot be made frictionless; use reduced");
  PetscCall(OperatorsSetParameters(sweep->operators, p));
  PetscCall(ModesGetBand(sweep->modes, band, &growth));
  PetscCall(ModesSetNearest(sweep->modes, 0, sweep->n_real));
  PetscCall(ModesSolve(sweep->modes));
  PetscCall(ModesSetBand(sweep->modes, band));
  PetscCall(ModesGet(sweep->modes, &n, &mode));
  PetscCall(BasisCreateBlock(&sweep->basis, n, &block));
  for (PetscInt i = 0; i < n; i++) {
    Vec u, q;

    PetscCall(ModesGetVectors(sweep->modes, i, &u, NULL, NULL, NULL));
    PetscCall(BVGetColumn(block, i, &q));
    PetscCall(OperatorsRestrict(sweep->operators, u, q));
    PetscCall(BVRestoreColumn(block, i, &q));
  }
  PetscCall(BasisAdd(&sweep->basis, block, 0, NULL));
  PetscCall(BasisPromote(&sweep->basis));
  PetscCall(BVDestroy(&block));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}
