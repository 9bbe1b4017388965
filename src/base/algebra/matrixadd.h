/* Private to operators/ and solver/: sums of sparse matrices in place */
#pragma once

#include <petscmat.h>

/* A += c X where every entry of X has its place in A, on all ranks; else, and for matrices that are not of type AIJ, A
   stays as it is and added is false. A may be the upper half of a symmetric matrix (MATSEQSBAIJ, blocks of one), and
   takes that of X. Entries are summed as MatSetValues() would, without its search. Collective. */
PETSC_INTERN PetscErrorCode MatrixAdd(PetscReal c, Mat X, Mat A, PetscBool *added);
