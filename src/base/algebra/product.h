/* Private: products of sparse matrices with many vectors at once */
#pragma once

#include <slepcbv.h>

/* Columns first, first + 1, ... of a sparse A as the dense X, zeros where A has no more */
PETSC_INTERN PetscErrorCode BlockTakeColumns(Mat A, PetscInt first, Mat X);
/* Y = A X of dense X and Y, which may be X */
PETSC_INTERN PetscErrorCode BlockMultiply(Mat A, Mat X, Mat Y);
/* Y[i] = A[i] X of n matrices, which costs less than one by one */
PETSC_INTERN PetscErrorCode BlockMultiplyEach(PetscInt n, const Mat A[], Mat X, const Mat Y[]);
/* The same of the active columns of X, into as many columns of Y for each matrix, one after the other */
PETSC_INTERN PetscErrorCode BlockMultiplySideBySide(PetscInt n, const Mat A[], BV X, BV Y);
/* Y = A X of the active columns of X and Y */
PETSC_INTERN PetscErrorCode BlockMultiplyVectors(Mat A, BV X, BV Y);
