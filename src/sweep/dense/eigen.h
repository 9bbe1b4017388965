/* Private to sweep/: the dense eigenvalue problem of one point */
#pragma once

#include "reduced.h"
#include "standard.h"

/* reduced.c - the matrices of the model at p on the leading n vectors; symmetric is left to the caller */
PetscErrorCode ReducedPencil(const Reduced *reduced, const PetscReal p[], PetscInt n, DensePencil *pencil);
/* eigen.c - eigenvalues in the window with omega >= 0 and vectors of any length, rigid modes
   first and once each, the others in any order; E [n * n] of RoundingEnergy(), or NULL: which ones are rigid by
   rounding on the mesh is then not told */
PetscErrorCode DensePencilEigen(const DensePencil *pencil, const PetscReal E[], const ReducedWindow *window,
                                ReducedModes *modes);
/* What rounding in the leading n x n block of K does to kappa = -lambda^2 times y^T M x: eps sqrt(sum_i |K_ii| |x_i|^2
   sum_i |K_ii| |y_i|^2) */
PetscReal DensePencilNoise(const DensePencil *pencil, PetscInt n, const PetscComplex x[], const PetscComplex y[]);
