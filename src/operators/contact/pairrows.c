/*
   Rows of the closed pairs in the unknowns of a pencil, of the factors of K = K_even + left' right: those of all
   unknowns times Zr.
*/
#include "operators/pencilimpl.h"

/* Rows A of all unknowns become A Zr, where there is a Zr */
static PetscErrorCode PencilProjectRows(Pencil pencil, Mat *A)
{
  Mat projected;

  PetscFunctionBeginUser;
  if (!*A || !pencil->Zr) PetscFunctionReturn(0);
  PetscCall(MatMatMult(*A, pencil->Zr, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &projected));
  PetscCall(MatProductClear(projected));
  PetscCall(MatDestroy(A));
  *A = projected;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilFormFactors(Pencil pencil)
{
  PetscFunctionBeginUser;
  if (pencil->has_factors) PetscFunctionReturn(0);
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&pencil->factor[i]));
  PetscCall(TermsFormFactors(&pencil->base, pencil->parameters.p, &pencil->factor[0], &pencil->factor[1]));
  for (int i = 0; i < 2; i++) PetscCall(PencilProjectRows(pencil, &pencil->factor[i]));
  pencil->has_factors = PETSC_TRUE;
  PetscFunctionReturn(0);
}
