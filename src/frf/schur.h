/* Private to frf/: the response on a small space, at many frequencies */
#pragma once

#include "space.h"

/* S of chain.h on the first n vectors of the space, as Z T Z' with T quasi-triangular, and the force and outputs there */
typedef struct {
  PetscInt   n, length, n_outputs;
  PetscBool  damped, rounded;
  PetscReal  shift;
  PetscReal *T; /* [length][length] column-major */
  PetscReal *b; /* [length] Z' [Q0^-1 b; 0] */
  PetscReal *l; /* [n_outputs][length] Z' [l; 0] */
  PetscReal *x; /* [2][length] work */
} FrfSchur;

/* The force and outputs in coordinates of the space: b[size], l[n_outputs][size] */
typedef struct {
  PetscInt   n_outputs;
  PetscReal *b, *l;
} FrfEnds;

/* Of the first n vectors; rounded: with K + E in place of K */
PETSC_INTERN PetscErrorCode FrfSchurCreate(const FrfSmall *small, PetscInt n, PetscBool rounded, PetscReal shift,
                                           const FrfEnds *ends, FrfSchur *schur);
/* H at omega (rad/s): re[n_outputs], im[n_outputs]; PETSC_TRUE in *singular where it is a pole to rounding */
PETSC_INTERN PetscErrorCode FrfSchurRespond(const FrfSchur *schur, PetscReal omega, PetscReal re[], PetscReal im[],
                                            PetscBool *singular);
PETSC_INTERN PetscErrorCode FrfSchurDestroy(FrfSchur *schur);
