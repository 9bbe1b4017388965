/* Private to sweep/: the pencil of one point as a linear problem A z = s B z (see standard.c) */
#pragma once

#include "basis/pencil.h"

/* The leading n unknowns of the pencil; damped may be set where the pencil of another point is */
typedef struct {
  const DensePencil *pencil;
  PetscInt           n;
  PetscBool          damped;
  PetscReal          scale; /* rad/s, of the second half of z: about |lambda| */
} StandardForm;

typedef enum { STANDARD_A, STANDARD_B } StandardMatrix;

/* Length of z */
PetscInt StandardSize(const StandardForm *form);
/* Y = op(A) X or op(B) X, [m][StandardSize()] */
PetscErrorCode StandardApply(const StandardForm *form, StandardMatrix matrix, PetscBool transposed, PetscInt m,
                             const PetscComplex X[], PetscComplex Y[]);
/* H = Y^T A X, G = Y^T B X of m vectors X, Y [m][StandardSize()], [m * m] column-major */
PetscErrorCode StandardProject(const StandardForm *form, PetscInt m, const PetscComplex X[], const PetscComplex Y[],
                               PetscComplex H[], PetscComplex G[]);
/* s of lambda, and the lambda with omega >= 0 of s */
PetscComplex StandardValue(const StandardForm *form, PetscComplex lambda);
PetscComplex StandardLambda(const StandardForm *form, PetscComplex s);
/* z of the vector x of an eigenvalue lambda */
void StandardVector(const StandardForm *form, PetscComplex lambda, const PetscComplex x[], PetscComplex z[]);
