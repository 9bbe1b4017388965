/* Private to frf/: the space of Galerkin's method and the small matrices of the pencil on it */
#pragma once

#include "frf/frfimpl.h"
#include "solver/block/orthonormal.h"

/* Matrices on the space, column-major, leading dimension size; C NULL without damping */
typedef struct {
  PetscInt   n, size;
  PetscReal *K, *C, *M; /* V' A V */
  PetscReal *E;         /* V' E V of a change of K by as much as it is rounded, N/m */
} FrfSmall;

typedef struct {
  PencilMatrices pencil;
  Mat            E;  /* diagonal, K_ii times machine epsilon with signs at random */
  BV             KV; /* [small.n] K V, where K is unsymmetric */
  BV             V;  /* [small.n] orthonormal columns, unknowns of the pencil */
  FrfSmall       small;
} FrfSpace;

/* Room for `size` vectors */
PETSC_INTERN PetscErrorCode FrfSpaceCreate(const PencilMatrices *pencil, PetscInt size, FrfSpace *space);
/* A block of n columns in the unknowns of the pencil */
PETSC_INTERN PetscErrorCode FrfSpaceCreateBlock(const FrfSpace *space, PetscInt n, BV *block);
/* Takes in what the columns of the block hold beyond the space; the block stays as it is */
PETSC_INTERN PetscErrorCode FrfSpaceAdd(FrfSpace *space, BV block);
/* Coordinates V' B of a block, array [n of the block][size], zero beyond the vectors that there are; the caller frees */
PETSC_INTERN PetscErrorCode FrfSpaceCoordinates(const FrfSpace *space, BV block, PetscReal **coordinates);
/* The block = V coordinates [n][stride], the first small.n of each */
PETSC_INTERN PetscErrorCode FrfSpaceLift(const FrfSpace *space, PetscInt n, PetscInt stride,
                                         const PetscReal coordinates[], BV block);
PETSC_INTERN PetscErrorCode FrfSpaceDestroy(FrfSpace *space);
