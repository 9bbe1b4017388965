/*
   Complex vectors as pairs of real ones. Q(lambda) = lambda^2 M + lambda C + K, and D(lambda) = M + C / (2 lambda),
   so that Q' = 2 lambda D.
*/
#pragma once

#include "modesimpl.h"
#include <complex.h>

typedef struct {
  Vec r, i; /* i may be NULL: zero */
} ComplexVec;

/* lambda of entry i */
static inline PetscComplex SpectrumLambda(const Spectrum *s, PetscInt i)
{
  return CMPLX(s->sigma[i], s->omega[i]);
}

/* x^T z without conjugation */
PETSC_INTERN PetscErrorCode ComplexVecDot(ComplexVec x, ComplexVec z, PetscComplex *dot);
/* z += a x, z = A x; z.i must be there */
PETSC_INTERN PetscErrorCode ComplexVecAXPY(PetscComplex a, ComplexVec x, ComplexVec z);
PETSC_INTERN PetscErrorCode ComplexVecMult(Mat A, ComplexVec x, ComplexVec z);
/* z = D(lambda) x */
PETSC_INTERN PetscErrorCode ComplexVecApplyD(const PencilMatrices *pencil, PetscComplex lambda, ComplexVec x, Vec work,
                                             ComplexVec z);
