/* Private to operators/ and solver/: sums of sparse matrices in place */
#pragma once

#include <petscmat.h>

/* A += c X where every entry of X has its place in A, on all ranks; else, and for matrices that are not of type AIJ, A
   stays as it is and added is false. Entries are summed as MatSetValues() would, without its search. Collective. */
PETSC_INTERN PetscErrorCode MatrixAdd(PetscReal c, Mat X, Mat A, PetscBool *added);
