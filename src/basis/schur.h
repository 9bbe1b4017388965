/* The quasi-triangular form of a general real matrix: all eigenvalues, vectors of single ones */
#pragma once

#include <petscsys.h>

/* D^-1 A D = Z T Z' */
typedef struct {
  PetscInt     n;
  PetscReal   *T, *Z;   /* [n * n]; A in place of T before DenseSchurForm() */
  PetscReal   *wr, *wi; /* [n] eigenvalues wr + i wi, pairs of conjugates one after the other, wi > 0 first */
  PetscReal   *scale;   /* [n] D as LAPACK's gebal writes it, with ends */
  PetscBLASInt ends[2];
} DenseSchur;

PetscErrorCode DenseSchurCreate(PetscInt n, DenseSchur *schur);
PetscErrorCode DenseSchurForm(DenseSchur *schur);
/* Real and imaginary part [2][n] of a vector to eigenvalue i, or i - 1 where wi[i] < 0, of any length; of a left one
   u^H A = w u^H. The imaginary part is 0 where wi is. */
PetscErrorCode DenseSchurVector(const DenseSchur *schur, PetscInt i, PetscBool left, PetscReal v[]);
PetscErrorCode DenseSchurDestroy(DenseSchur *schur);
