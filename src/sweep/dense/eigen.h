/* Private to sweep/: the dense eigenvalue problem of one point */
#pragma once

#include "reduced.h"

/* Q(lambda) = lambda^2 M + lambda C + K, [n * n] each; C is NULL without damping */
typedef struct {
  PetscInt   n;
  PetscReal *K, *C, *M;
  PetscBool  symmetric; /* all terms, and no damping */
} DensePencil;

/* eigen.c - eigenvalues in the window with omega >= 0 and vectors of any length, rigid modes
   first and once each, the others in any order */
PetscErrorCode PencilEigen(const DensePencil *pencil, const ReducedWindow *window, ReducedModes *modes);
/* What rounding in K does to kappa = -lambda^2 times y^T M x: eps sqrt(sum_i |K_ii| |x_i|^2 sum_i |K_ii| |y_i|^2) */
PetscReal PencilNoise(const DensePencil *pencil, const PetscComplex x[], const PetscComplex y[]);
