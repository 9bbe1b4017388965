/* Vectors that BlockKrylovTakeVector() hands over, beside copies by EPSGetEigenpair() */
#pragma once

#include "check.h"
#include "solver/block/krylov.h"

/* As -bv_type vecs: there is no array of all columns, of which one could be taken without a copy */
static inline PetscErrorCode KeepColumnsApart(EPS eps)
{
  BV V;

  PetscFunctionBeginUser;
  PetscCall(EPSGetBV(eps, &V));
  PetscCall(BVSetType(V, BVVECS));
  PetscFunctionReturn(0);
}

/* Breaks when: vectors that are taken are not those of EPSGetEigenpair(), go with their solver, or share memory */
static inline PetscErrorCode CheckTaken(EPS *eps, int *failed)
{
  Vec       copy[4][2], taken[4][2];
  PetscReal worst     = 0, here;
  PetscInt  n_complex = 0;
  BV        V;

  PetscFunctionBeginUser;
  PetscCall(EPSGetBV(*eps, &V));
  for (int i = 0; i < 4; i++) {
    for (int part = 0; part < 2; part++) PetscCall(BVCreateVec(V, &copy[i][part]));
    PetscCall(EPSGetEigenpair(*eps, i, NULL, NULL, copy[i][0], copy[i][1]));
    PetscCall(BlockKrylovTakeVector(*eps, i, PETSC_FALSE, &taken[i][0], &taken[i][1]));
    n_complex += taken[i][1] ? 1 : 0;
  }
  PetscCall(EPSDestroy(eps));
  for (int k = 0; k < 8; k++) {
    Vec *const x = &taken[k / 2][k % 2], *const y = &copy[k / 2][k % 2];

    if (*x) PetscCall(VecAXPY(*y, -1, *x));
    PetscCall(VecNorm(*y, NORM_INFINITY, &here));
    worst = PetscMax(worst, here);
    if (*x) PetscCall(VecSet(*x, 0));
    PetscCall(VecDestroy(x));
    PetscCall(VecDestroy(y));
  }
  *failed +=
    CheckClose("vectors taken from their solver", worst, 0, 0) + CheckTrue("complex ones", n_complex >= 2, n_complex);
  PetscFunctionReturn(0);
}
