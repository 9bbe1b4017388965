/* Private to the solvers in modes/, sweep/ and frf/: spaces of many vectors, block by block */
#pragma once

#include <slepcbv.h>

/* H = X' A Y (A the identity where NULL) for the active columns of X and Y; on every rank, the caller destroys it */
PETSC_INTERN PetscErrorCode BlockProducts(BV X, Mat A, BV Y, Mat *H);
/* Copies such an H, or its transpose, to A and on, the leading dimension of A being n. Not collective. */
PETSC_INTERN PetscErrorCode BlockCopy(Mat H, PetscBool transposed, PetscInt n, PetscReal A[]);
/* What the active columns of W hold beyond the first n columns of V, which are orthonormal in M (the identity where
   NULL), made orthonormal: directions shorter than drop, or that rounding leaves, are left out, and the active columns of
   W become those that are there. Collective; alike on all ranks. */
PETSC_INTERN PetscErrorCode BlockOrthonormalise(BV V, PetscInt n, Mat M, PetscReal drop, BV W);
