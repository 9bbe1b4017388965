/* Private to solver/: factors of A + L' R from those of the symmetric A, L and R with a row for each of p pairs */
#pragma once

#include <petscmat.h>

/* One system with many right-hand sides, X := A^-1 X, X dense */
typedef PetscErrorCode (*LowRankSolve)(void *ctx, Mat X);
/* X = A^-1 B with B' sparse */
typedef PetscErrorCode (*LowRankSolveRows)(void *ctx, Mat rows, Mat X);

/* Entries of A^-1 of some rows and columns, both ascending and the same on every rank: a [n_columns][n_rows], filled on
   the first rank */
typedef struct InverseBlock {
  PetscInt        n_rows, n_columns;
  const PetscInt *row, *column;
  PetscScalar    *a;
} InverseBlock;
typedef PetscErrorCode (*LowRankInverse)(void *ctx, const InverseBlock *block);

typedef struct LowRank {
  MPI_Comm         comm;
  Mat              L, R;  /* p x n, sparse */
  Mat              Y;     /* A^-1 R', n x p dense; NULL: every solution takes two solves with A instead of one */
  PetscInt         p;     /* pairs */
  PetscScalar     *C;     /* [p][p] LU of I + R A^-1 L', by columns, on every rank */
  PetscBLASInt    *pivot; /* [p] */
  LowRankSolve     solve;
  LowRankSolveRows solve_rows; /* NULL: not offered */
  LowRankInverse   inverse;    /* NULL: not offered */
  void            *ctx;        /* of all three */
} LowRank;

/* Makes the update u, whose solve, solve_rows, inverse and ctx are set, from p solves, or from entries of A^-1. With
   `store` Y is kept. singular: A + L' R is (A is not). Collective. */
PETSC_INTERN PetscErrorCode LowRankSetUp(Mat L, Mat R, PetscBool store, LowRank *u, PetscBool *singular);
/* X := (A + L' R)^-1 X for the first n_right columns, and with its transpose for the others. Collective. */
PETSC_INTERN PetscErrorCode LowRankApply(const LowRank *u, PetscInt n_right, Mat X);
/* r += L' R x, or R' L x. Collective. */
PETSC_INTERN PetscErrorCode LowRankMultAdd(const LowRank *u, PetscBool transposed, Vec x, Vec r);
PETSC_INTERN PetscErrorCode LowRankDestroy(LowRank *u);
/* capacitance.c - u->C from u->inverse; made = whether that is worth it. Collective. */
PETSC_INTERN PetscErrorCode LowRankCapacitance(LowRank *u, PetscBool *made);
