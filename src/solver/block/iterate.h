/* Private to the block eigensolver: what its type keeps, and the iteration */
#pragma once

#include "space.h"
#include <slepc/private/epsimpl.h>

typedef struct {
  PetscInt   size;  /* of a block, as given; 0: chosen, */
  PetscInt   least; /* and then not below this */
  PetscInt   block; /* in use */
  PetscReal  reach; /* ends the solution where all out to this distance from the target have converged; 0: none */
  PetscBool  reached;
  BlockSpace space;
  PetscInt   locked, converged; /* eigenvalues: at the last restart, at the last look */
  PetscInt   its;
  PetscInt   look;  /* columns from which the next look is taken */
  PetscInt   seen;  /* columns at the last look */
  PetscReal  worst; /* largest residual of a wanted eigenvalue then, beside the tolerance */
  PetscBool  begun; /* there is a space */
  /* the transposed problem, whose solver is not owned; NULL for none */
  EPS              other;
  PetscBool        paired; /* it is solved along with another one, which may have this one as its other */
  BlockKrylovSolve solve;
  void            *solve_ctx;
} EPS_BlockKrylov;

/* block/iterate.c - ops->solve; frees the space of a solution */
PETSC_INTERN PetscErrorCode BlockKrylovIterate(EPS eps);
PETSC_INTERN PetscErrorCode BlockKrylovEnd(EPS eps);
