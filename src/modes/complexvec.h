/*
   Complex vectors as pairs of real ones, and Q(lambda) = lambda^2 M + lambda C + K and D(lambda) = M + C / (2 lambda), so that
   Q' = 2 lambda D, applied to them.
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
/* z = D(lambda) x, z = Q(lambda) x; z.i must be there */
PETSC_INTERN PetscErrorCode PencilApplyD(const OperatorsPencil *pencil, PetscComplex lambda, ComplexVec x, Vec work, ComplexVec z);
PETSC_INTERN PetscErrorCode PencilApplyQ(const OperatorsPencil *pencil, PetscComplex lambda, ComplexVec x, Vec work, ComplexVec z);
