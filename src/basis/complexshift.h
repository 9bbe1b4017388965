/* Private to modes/: factors of Q(i omega) = K + i omega C - omega^2 M, in real arithmetic */
#pragma once

#include "solver/factor/shiftinvert.h"

typedef struct ComplexShift {
  PencilMatrices matrices; /* of the unknowns [v; w], each rank's v before its w */
  ShiftInvert    factor;   /* about omega, rad/s */
} ComplexShift;

/* Of a pencil with damping, without laws; no factors as yet */
PETSC_INTERN PetscErrorCode ComplexShiftCreate(const PencilMatrices *pencil, Progress *progress, ComplexShift *c);
/* Factors at another omega; the analysis serves again */
PETSC_INTERN PetscErrorCode ComplexShiftMove(ComplexShift *c, PetscReal omega);
/* Z = Q^-1 B, or Q'^-1 B, of dense B and Z whose columns are real and imaginary parts in turn */
PETSC_INTERN PetscErrorCode ComplexShiftSolve(const ComplexShift *c, PetscBool transposed, Mat B, Mat Z);
PETSC_INTERN PetscErrorCode ComplexShiftDestroy(ComplexShift *c);
