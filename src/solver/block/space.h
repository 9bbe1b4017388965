/* Private to the block eigensolver: a block Krylov decomposition

      Op V_m = V_(m+p) G,   G (m + p) x m,

   in the first m + p columns of V, orthonormal in M; the last p are the block that Op has not been applied to yet
   (G. W. Stewart, SIAM J. Matrix Anal. Appl. 23, 2001; Y. Zhou, Y. Saad, Numer. Algorithms 47, 2008) */
#pragma once

#include "krylov.h"

typedef struct {
  ST           st;
  BV           V, W; /* basis, capacity ncv + block; work, block columns */
  Mat          M;    /* inner product, NULL for x' y */
  PetscInt     n;    /* unknowns */
  PetscInt     ncv, block;
  PetscInt     m, p;
  PetscInt     applied; /* columns that Op was applied to, in all restarts */
  PetscScalar *G;       /* [ncv][ncv + block] */
  PetscScalar *scratch; /* [block][ncv + block] */
} BlockSpace;

PETSC_INTERN PetscErrorCode BlockSpaceCreate(ST st, BV V, Mat M, PetscInt ncv, PetscInt block, BlockSpace *space);
/* Begins the space, or goes on with the first m columns alone, which Op must leave among themselves, with a random
   block in the range of Op. p is less than the block where there are not so many directions more, at last 0. */
PETSC_INTERN PetscErrorCode BlockSpaceStart(BlockSpace *space);
/* Applies Op to the last block: m grows by p. Directions that ended are replaced by random ones. */
PETSC_INTERN PetscErrorCode BlockSpaceExtend(BlockSpace *space);
/* The same of the spaces of K x = kappa M x and of K' y = kappa M' y by shift-and-invert, with one call of solve */
PETSC_INTERN PetscErrorCode BlockSpaceExtendBoth(BlockSpace *right, BlockSpace *left, BlockKrylovSolve solve,
                                                 void *ctx);
/* V := V_m Q and T = Q' G Q of `converged` + `kept` columns, of which the first `locked` are as they were and the
   converged are not coupled to the last block any more */
PETSC_INTERN PetscErrorCode BlockSpaceRestart(BlockSpace *space, PetscInt locked, PetscInt converged, PetscInt kept,
                                              Mat Q, Mat T);
/* |B x|, B the last p rows of G: the residual of x, |x| = 1, of length m, in the basis */
PETSC_INTERN PetscReal BlockSpaceResidual(const BlockSpace *space, const PetscScalar x[]);
/* V := Op V for its first n columns, block by block, each of norm 1 in M then */
PETSC_INTERN PetscErrorCode BlockSpacePurify(ST st, BV V, Mat M, PetscInt n, PetscInt block);
PETSC_INTERN PetscErrorCode BlockSpaceDestroy(BlockSpace *space);
