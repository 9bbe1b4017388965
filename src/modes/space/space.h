/* Private to modes/, frf/: the space of Galerkin's method with the pencil on it */
#pragma once

#include "basis/subspace.h"

typedef struct {
  PencilMatrices pencil;
  PetscInt       size;
  Subspace       space; /* orthonormal columns in the unknowns of the pencil, K, C and M on them, and E */
} ModesSpace;

/* a change of K by as much as it is rounded, diagonal: K_ii times machine epsilon with signs at random */
#define SPACE_E SUBSPACE_PENCIL

/* Room for `size` vectors */
PETSC_INTERN PetscErrorCode ModesSpaceCreate(const PencilMatrices *pencil, PetscInt size, ModesSpace *space);
/* Takes in what the columns of the block hold beyond the space; the block stays as it is */
PETSC_INTERN PetscErrorCode ModesSpaceAdd(ModesSpace *space, BV block);
/* Coordinates V' B of a block, array [n of the block][size], zero beyond the vectors that there are; the caller
   frees */
PETSC_INTERN PetscErrorCode ModesSpaceCoordinates(const ModesSpace *space, BV block, PetscReal **coordinates);
/* The block = V coordinates [n][stride], as many of each as there are vectors */
PETSC_INTERN PetscErrorCode ModesSpaceLift(const ModesSpace *space, PetscInt n, PetscInt stride,
                                           const PetscReal coordinates[], BV block);
PETSC_INTERN PetscErrorCode ModesSpaceDestroy(ModesSpace *space);
