/*
   Complex vectors as pairs of real ones. Q(lambda) = lambda^2 M + lambda C + K + sum_j h_j(lambda) A_j, the sum that of
   laws of materials (pencil.h), and D(lambda) = M + (C + sum_j h_j' A_j) / (2 lambda), so that Q' = 2 lambda D.
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
/* z += sum_j h_j A_j x, d += sum_j h_j' A_j x / (2 lambda); either may be without parts */
PETSC_INTERN PetscErrorCode ComplexVecAddLaws(const PencilMatrices *pencil, PetscComplex lambda, ComplexVec x,
                                              ComplexVec z, ComplexVec d);
/* z = D(lambda) x */
PETSC_INTERN PetscErrorCode ComplexVecApplyD(const PencilMatrices *pencil, PetscComplex lambda, ComplexVec x, Vec work,
                                             ComplexVec z);

/* Each A times the vectors of entries first .. first + n - 1, by columns: the real part, and the imaginary one where
   there is one */
PETSC_INTERN PetscErrorCode SpectrumMultiply(const Spectrum *s, PetscInt first, PetscInt n, PetscInt n_matrices,
                                             const Mat A[], Mat AX[]);

/* defect.c - whether a condition is so large that the pair may be close to defective; h and |x^H Q x| of its vectors
   v = x, y of any length; Qx is Q(lambda) x, and is overwritten, work like it. Collective */
typedef struct {
  PetscBool near;             /* measured */
  PetscReal along, departure; /* (rad/s)^2, once they are divided by |x|_M^2 and |x|_M |y|_M: wrong in the plane; h */
} Defect;

PETSC_INTERN PetscBool      DefectIsNear(PetscReal condition);
PETSC_INTERN PetscErrorCode DefectMeasure(const PencilMatrices *pencil, PetscComplex lambda, const ComplexVec v[2],
                                          ComplexVec Qx, ComplexVec work, Defect *defect);
/* Error of lambda^2 of entry i, (rad/s)^2: that of first order, and where the plane was measured no more than by it
   from what is wrong across the pair, |y^T Q x| and rounding. Not collective */
PETSC_INTERN PetscReal DefectError(const Spectrum *s, PetscInt i, const Defect *defect, PetscReal across,
                                   PetscReal first);
