/* Private to sweep/: the dense eigenvalue problem of one point */
#pragma once

#include "reduced.h"
#include "standard.h"

/* reduced.c - the matrices of the model at p on the leading n vectors; symmetric is left to the caller */
PetscErrorCode ReducedPencil(const Reduced *reduced, const PetscReal p[], PetscInt n, DensePencil *pencil);
/* The same with K = 0, of many terms as a rule: products of modes with each other need C and M alone */
PetscErrorCode ReducedPencilLoose(const Reduced *reduced, const PetscReal p[], PetscInt n, DensePencil *pencil);
/* eigen.c - eigenvalues in the window with omega >= 0 and vectors of any length, rigid modes
   first and once each, the others in any order; E [n * n] of RoundingEnergy(), or NULL: which ones are rigid by
   rounding on the mesh is then not told */
PetscErrorCode DensePencilEigen(const DensePencil *pencil, const PetscReal E[], const ReducedWindow *window,
                                ReducedModes *modes);
/* condense.c - the same by way of the core; `found` is false where that is not good enough for some mode, or the other
   vectors may have modes of their own in the window */
PetscErrorCode CondensedEigen(const DensePencil *pencil, const PetscReal E[], const ReducedCore *core,
                              const ReducedWindow *window, ReducedModes *modes, PetscBool *found);
/* What rounding in the leading n x n block of K does to kappa = -lambda^2 times y^T M x: eps sqrt(sum_i |K_ii| |x_i|^2
   sum_i |K_ii| |y_i|^2) */
PetscReal DensePencilNoise(const DensePencil *pencil, PetscInt n, const PetscComplex x[], const PetscComplex y[]);
