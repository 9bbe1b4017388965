/* Private to sweep/ and the rooms above it: modes of the reduced model beside those of a full solution */
#pragma once

#include "sweep/dense/reduced.h"

/* True errors at a point that the basis has never seen */
typedef struct {
  PetscInt  n_full, n_reduced, n_unstable_full, n_unstable_reduced;
  PetscReal error, estimate; /* largest relative ones: distance, estimate of the reduced model */
  PetscReal full;            /* largest relative error that the full solution itself states */
  PetscInt  n_beyond;        /* modes whose true error exceeds what both solutions state */
  PetscReal ratio;           /* largest true error beside what both state */
  PetscReal omega;           /* rad/s, where the true error is largest */
} FullCheck;

/* Adds to a check that begins as zeros; reduced may hold modes a little beyond the window, for those on its edges */
void FullCompare(const ReducedWindow *window, const ModesLimit *limit, PetscInt n, const Mode full[],
                 const ReducedModes *reduced, FullCheck *check);
