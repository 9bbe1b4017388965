/* Private to the solvers in modes/ and sweep/: residuals of eigenpairs (lambda^2 M + lambda C + K) x = r */
#pragma once

#include <squeal/pencil.h>
#include <complex.h>

/* Complex vectors side by side as real columns: one for a real vector, else its real and imaginary part */
typedef struct {
  PetscInt      m, n_columns;
  PetscInt     *column; /* [m + 1] first column of each vector */
  PetscComplex *lambda; /* [m] their eigenvalues, rad/s; lambda^2 is real where the vector is and there is no damping */
} ComplexColumns;

PETSC_INTERN PetscErrorCode ComplexColumnsCreate(PetscInt capacity, ComplexColumns *columns);
PETSC_INTERN void           ComplexColumnsAdd(ComplexColumns *columns, PetscComplex lambda, PetscBool is_real);
PETSC_INTERN PetscErrorCode ComplexColumnsDestroy(ComplexColumns *columns);

/* R = Q(lambda) X, or Q(lambda)' X, of dense X and R with these columns. Where K is K_even, right' left is put to it, which makes
   K' of it. Collective. */
PETSC_INTERN PetscErrorCode ResidualMake(const PencilMatrices *pencil, PetscBool transposed,
                                         const ComplexColumns *columns, Mat X, Mat R);
