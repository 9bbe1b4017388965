/* Private to modes/, sweep/: the dense quadratic problem of one point */
#pragma once

#include "dense.h"

/* Q(lambda) = lambda^2 M + lambda C + K, [n * n] each */
typedef struct {
  PetscInt   n;
  PetscBool  damped;    /* C is not zero */
  PetscBool  symmetric; /* all terms, and no damping */
  PetscReal *K, *C, *M;
} DensePencil;

/* Q(lambda) on the unknowns first .. first + n - 1, [n * n] */
void DensePencilEvaluate(const DensePencil *pencil, PetscComplex lambda, PetscInt first, PetscInt n, PetscComplex Q[]);
PetscErrorCode DensePencilDestroy(DensePencil *pencil);

/* follow.c - from a guess lambda, x, y [n] the eigenvalue with vectors of any length that Newton's method finds; found =
   false where it does not settle or Q(lambda) stays singular */
PetscErrorCode DensePencilFollow(const DensePencil *pencil, PetscComplex *lambda, PetscComplex x[], PetscComplex y[],
                                 PetscBool *found);
