/* Private to the solvers in modes/, sweep/ and frf/: spaces of many vectors, block by block */
#pragma once

#include "base/algebra/product.h"

/* H = X' A Y (A the identity where NULL) for the active columns of X and Y; on every rank, the caller destroys it */
PETSC_INTERN PetscErrorCode BlockProducts(BV X, Mat A, BV Y, Mat *H);
/* Eigenvalues w, ascending, and vectors of the symmetric n x n matrix G, which they overwrite; those of rank 0 on
   all */
PETSC_INTERN PetscErrorCode GramEigen(MPI_Comm comm, PetscInt size, PetscScalar G[], PetscReal w[]);
/* Copies such an H, or its transpose, to A and on, the leading dimension of A being n. Not collective. */
PETSC_INTERN PetscErrorCode BlockCopy(Mat H, PetscBool transposed, PetscInt n, PetscReal A[]);
/* What the active columns of W hold beyond the first n columns of V, which are orthonormal in M (the identity where
   NULL), made orthonormal: directions shorter than drop, or that rounding leaves, are left out, and the active columns
   of W become those that are there. Collective; alike on all ranks. */
PETSC_INTERN PetscErrorCode BlockOrthonormalise(BV V, PetscInt n, Mat M, PetscReal drop, BV W);
/* Room for an n x n matrix with the old one, first x first, in its corner. Not collective. */
PETSC_INTERN PetscErrorCode BlockGrow(PetscInt first, PetscInt n, PetscReal **A);
/* A block of n active columns like those of another. Collective. */
PETSC_INTERN PetscErrorCode BlockCreate(BV like, PetscInt n, BV *block);
/* W -= V V' M W for the active columns of W and the first n columns of V, orthonormal in M (the identity where NULL) */
PETSC_INTERN PetscErrorCode BlockProject(BV V, PetscInt n, Mat M, BV W);
/* Replaces the active columns of B by fewer ones of length one in A (the identity where NULL) that span column j within
   tolerance[j] in that length: left singular vectors of B diag(1 / tolerance), whose singular values, ascending, are in
   sigma[columns of B]; those below one are left out. Collective; alike on all ranks. */
PETSC_INTERN PetscErrorCode BlockCompress(Mat A, const PetscReal tolerance[], BV B, PetscReal sigma[]);
/* block = V coordinates, coordinates [m][size] of the first columns of V, which become its active ones */
PETSC_INTERN PetscErrorCode BlockLift(BV V, PetscInt size, PetscInt m, const PetscReal coordinates[], BV block);

/* block/orthogonalise.c - the factors of a block: what its columns were in terms of a basis and of the new block */
typedef struct {
  PetscInt     ld, most; /* leading dimension of H; columns that the new block may have at most */
  PetscScalar *H;        /* [columns][ld] C in rows 0 .. n - 1, R in as many rows below as there are columns now */
  PetscReal    drop;     /* directions shorter than this beside the longest column are left out */
  PetscReal    loose;    /* how far, about, [V Q]'M[V Q] may be from the identity; zero: as far as rounding leaves it */
  PetscReal  enough; /* the same as it is measured where there is no M: a block that is so far from it stays as it is */
  PetscReal *gram;   /* [n * n] V'MV where V is loose, else NULL */
} BlockFactors;

/* W = V C + Q R for the active columns of W and the first n columns of V, which are orthonormal in M (the identity
   where NULL) or loosely so. Q, orthonormal in itself and to V, takes the place of W, and its active columns become
   those that there are. Unlike BlockOrthonormalise() it resolves directions of any length. Collective; alike on all
   ranks. */
PETSC_INTERN PetscErrorCode BlockFactorise(BV V, PetscInt n, Mat M, BV W, BlockFactors *factors);
