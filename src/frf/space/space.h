/* Private to frf/: the space of Galerkin's method with the pencil on it */
#pragma once

#include "frf/frfimpl.h"
#include "basis/subspace.h"

typedef struct {
  PencilMatrices pencil;
  PetscInt       size;
  Subspace       space; /* orthonormal columns in the unknowns of the pencil, K, C and M on them, and E */
} FrfSpace;

/* a change of K by as much as it is rounded, diagonal: K_ii times machine epsilon with signs at random */
#define FRF_E SUBSPACE_PENCIL

/* Room for `size` vectors */
PETSC_INTERN PetscErrorCode FrfSpaceCreate(const PencilMatrices *pencil, PetscInt size, FrfSpace *space);
/* Takes in what the columns of the block hold beyond the space; the block stays as it is */
PETSC_INTERN PetscErrorCode FrfSpaceAdd(FrfSpace *space, BV block);
/* Coordinates V' B of a block, array [n of the block][size], zero beyond the vectors that there are; the caller
   frees */
PETSC_INTERN PetscErrorCode FrfSpaceCoordinates(const FrfSpace *space, BV block, PetscReal **coordinates);
/* The block = V coordinates [n][stride], as many of each as there are vectors */
PETSC_INTERN PetscErrorCode FrfSpaceLift(const FrfSpace *space, PetscInt n, PetscInt stride,
                                         const PetscReal coordinates[], BV block);
PETSC_INTERN PetscErrorCode FrfSpaceDestroy(FrfSpace *space);
