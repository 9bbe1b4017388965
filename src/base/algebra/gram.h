/* Private: products of blocks of vectors, dense matrices whose rows are spread over the ranks */
#pragma once

#include <petscmat.h>

/* H [columns of Y][columns of X] = X'Y on every rank. Collective */
PETSC_INTERN PetscErrorCode BlockGram(Mat X, Mat Y, PetscReal H[]);
/* X += scale A H, H [columns of X][columns of A]. Not collective */
PETSC_INTERN PetscErrorCode BlockAddProduct(PetscReal scale, Mat A, const PetscReal H[], Mat X);
/* X -= A (B'X), A and B [unknowns][m]: with A = Phi, B = M Phi it takes the modes out of displacements, the other way
   round out of forces. Collective */
PETSC_INTERN PetscErrorCode BlockTakeOut(Mat A, Mat B, Mat X);
