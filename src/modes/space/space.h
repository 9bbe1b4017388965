/* Private to modes/, frf/: the space of Galerkin's method with the pencil on it */
#pragma once

#include "basis/subspace.h"

typedef struct {
  PencilMatrices pencil;
  Subspace       space; /* orthonormal columns in the unknowns of the pencil, K, C and M on them, and E */
} ModesSpace;

/* The last term, E: a change of K by as much as it is rounded, diagonal: K_ii times machine epsilon with signs at
   random */
#define SPACE_E(space) ((space)->space.n_terms - 1)

PETSC_INTERN PetscErrorCode ModesSpaceCreate(const PencilMatrices *pencil, ModesSpace *space);
/* Takes in what the columns of the block hold beyond the space; the block stays as it is */
PETSC_INTERN PetscErrorCode ModesSpaceAdd(ModesSpace *space, BV block);
/* V' a of n vectors, array [n][vectors that there are]; the caller frees */
PETSC_INTERN PetscErrorCode ModesSpaceProducts(const ModesSpace *space, PetscInt n, const Vec a[],
                                               PetscReal **products);
PETSC_INTERN PetscErrorCode ModesSpaceDestroy(ModesSpace *space);
