/* Private to modes/, sweep/, frf/: residuals of eigenpairs (lambda^2 M + lambda C + K) x = r, and corrections of
   them */
#pragma once

#include "solver/factor/shiftinvert.h"
#include <slepcbv.h>
#include <complex.h>

/* Complex vectors in coordinates of a basis side by side as real columns: one for a real vector, else its real and
   imaginary part */
typedef struct {
  PetscInt      m, n_columns, size;
  PetscInt     *column; /* [m + 1] first column of each vector */
  PetscComplex *lambda; /* [m] their eigenvalues, rad/s; lambda^2 is real where the vector is and there is no damping */
  PetscReal    *coordinates; /* [n_columns][size] */
} ComplexColumns;

PETSC_INTERN PetscErrorCode ComplexColumnsCreate(PetscInt capacity, PetscInt size, ComplexColumns *columns);
/* Takes in a vector x [size] */
PETSC_INTERN PetscErrorCode ComplexColumnsAdd(ComplexColumns *columns, PetscComplex lambda, PetscBool is_real,
                                              const PetscComplex x[]);
PETSC_INTERN PetscErrorCode ComplexColumnsDestroy(ComplexColumns *columns);

/* X = V c of the columns c, made here, and R = Q(lambda) X, or Q(lambda)' X, in as many active columns. Where K is
   K_even, right' left is put to it, which makes K' of it. Collective. */
PETSC_INTERN PetscErrorCode ResidualMake(const PencilMatrices *pencil, PetscBool transposed,
                                         const ComplexColumns *columns, BV V, BV *X, BV R);
/* Z = [P^-1 R[0], P^-T R[1]] of the active columns of both, either of which may be NULL, P being what is factored: in
   one block of solves where friction is put on the factors, which costs less. Collective. */
PETSC_INTERN PetscErrorCode ResidualsSolve(const ShiftInvert *factor, const BV R[2], BV Z);
