/*
   LU factors of a dense matrix and solutions with them, in single precision where LU_SINGLE is set; versions.h comes
   before. Rows are not exchanged: what small pivots spoil shows in their ratio, which LUFactor() returns. Columns are
   eliminated LU_BLOCK at a time, and taken off four others at once.
*/
#pragma once

#include <petscsys.h>

#ifdef LU_SINGLE
typedef float LUNumber;
#else
typedef PetscReal LUNumber;
#endif

/* columns at a time: what is read of the others is used eight times */
#define LU_BLOCK 8
/* others at once: what is read of the block is used four times, and the sums stay in registers */
#define LU_OTHER 4
/* of a matrix of so many rows, which leaves the cache of a core, so many columns are taken off the others before the
   next ones */
#define LU_LARGE 1000
#define LU_PANEL 64

/* `columns` columns P from row k on become their own L and U */
INTO_VERSIONS void LUFactorBlock(PetscInt n, PetscInt k, PetscInt columns, LUNumber P[])
{
  for (PetscInt j = 0; j < columns; j++) {
    LUNumber      *l     = &P[j * n];
    const LUNumber scale = 1 / l[k + j];

    for (PetscInt i = k + j + 1; i < n; i++) l[i] *= scale;
    for (PetscInt q = j + 1; q < columns; q++) {
      LUNumber      *a = &P[q * n];
      const LUNumber u = a[k + j];

      for (PetscInt i = k + j + 1; i < n; i++) a[i] -= u * l[i];
    }
  }
}

/* Takes the block P at row k off `others` columns A after it */
INTO_VERSIONS void LUTakeBlock(PetscInt n, PetscInt k, PetscInt others, const LUNumber *restrict P,
                               LUNumber *restrict A)
{
  LUNumber u[LU_OTHER][LU_BLOCK];

  for (PetscInt q = 0; q < others; q++)
    for (PetscInt j = 0; j < LU_BLOCK; j++) {
      u[q][j] = A[q * n + k + j];
      for (PetscInt m = 0; m < j; m++) u[q][j] -= P[m * n + k + j] * u[q][m];
      A[q * n + k + j] = u[q][j];
    }
  for (PetscInt i = k + LU_BLOCK; i < n; i++) {
    LUNumber a[LU_OTHER];

    for (PetscInt q = 0; q < others; q++) a[q] = A[q * n + i];
    for (PetscInt j = 0; j < LU_BLOCK; j++)
      for (PetscInt q = 0; q < others; q++) a[q] -= P[j * n + i] * u[q][j];
    for (PetscInt q = 0; q < others; q++) A[q * n + i] = a[q];
  }
}

/* Takes the blocks at rows `from` to `to` off `others` columns A, one after the other */
INTO_VERSIONS void LUTakePanel(PetscInt n, PetscInt from, PetscInt to, PetscInt others, const LUNumber LU[],
                               LUNumber A[])
{
  for (PetscInt k = from; k < to; k += LU_BLOCK) LUTakeBlock(n, k, others, &LU[k * n], A);
}

/* Takes the blocks at rows `from` to `to` off the columns from `to` to `end` */
INTO_VERSIONS void LUTakeColumns(PetscInt n, PetscInt from, PetscInt to, PetscInt end, LUNumber A[])
{
  PetscInt q = to;

  for (; q + LU_OTHER <= end; q += LU_OTHER) LUTakePanel(n, from, to, LU_OTHER, A, &A[q * n]);
  for (; q < end; q++) LUTakePanel(n, from, to, 1, A, &A[q * n]);
}

/* A = L U without exchange, L with 1 on its diagonal, both in the place of A [n][n] by columns; 2 n^3 / 3 operations.
   The sums have a fixed order, so that the bits do not depend on BLAS or its threads. Returns the least |U_ii| over
   the largest, 0 or no number where a pivot is 0. */
INTO_VERSIONS PetscReal LUFactor(PetscInt n, LUNumber A[])
{
  const PetscInt whole = n / LU_BLOCK * LU_BLOCK, panel = n < LU_LARGE ? LU_BLOCK : LU_PANEL;
  PetscReal      least = n ? PETSC_MAX_REAL : 1, largest = n ? 0 : 1;

  for (PetscInt k = 0, end; k < whole; k = end) {
    end = PetscMin(whole, k + panel);
    for (PetscInt j = k; j < end; j += LU_BLOCK) {
      LUFactorBlock(n, j, LU_BLOCK, &A[j * n]);
      LUTakeColumns(n, j, j + LU_BLOCK, end, A);
    }
    LUTakeColumns(n, k, end, n, A);
  }
  LUFactorBlock(n, whole, n - whole, &A[whole * n]);
  for (PetscInt i = 0; i < n; i++) {
    least   = PetscMin(least, PetscAbsReal(A[i * (n + 1)]));
    largest = PetscMax(largest, PetscAbsReal(A[i * (n + 1)]));
  }
  return least / largest;
}

/* Back substitution of the block P at row k in `others` columns A: its rows, and what they take off those before */
INTO_VERSIONS void LUTakeUpper(PetscInt n, PetscInt k, PetscInt others, const LUNumber *restrict P,
                               LUNumber *restrict A)
{
  LUNumber u[LU_OTHER][LU_BLOCK];

  for (PetscInt q = 0; q < others; q++)
    for (PetscInt j = LU_BLOCK - 1; j >= 0; j--) {
      u[q][j] = A[q * n + k + j];
      for (PetscInt m = LU_BLOCK - 1; m > j; m--) u[q][j] -= P[m * n + k + j] * u[q][m];
      A[q * n + k + j] = u[q][j] /= P[j * n + k + j];
    }
  for (PetscInt i = 0; i < k; i++) {
    LUNumber a[LU_OTHER];

    for (PetscInt q = 0; q < others; q++) a[q] = A[q * n + i];
    for (PetscInt j = LU_BLOCK - 1; j >= 0; j--)
      for (PetscInt q = 0; q < others; q++) a[q] -= P[j * n + i] * u[q][j];
    for (PetscInt q = 0; q < others; q++) A[q * n + i] = a[q];
  }
}

/* A x = b of some columns at once, for which the factors are read once */
INTO_VERSIONS void LUSolveOthers(PetscInt n, PetscInt others, const LUNumber *restrict LU, LUNumber *restrict X)
{
  const PetscInt whole = n / LU_BLOCK * LU_BLOCK;

  LUTakePanel(n, 0, whole, others, LU, X);
  for (PetscInt q = 0; q < others; q++) {
    for (PetscInt j = whole; j < n; j++)
      for (PetscInt i = j + 1; i < n; i++) X[q * n + i] -= LU[j * n + i] * X[q * n + j];
    for (PetscInt j = n - 1; j >= whole; j--) {
      X[q * n + j] /= LU[j * n + j];
      for (PetscInt i = 0; i < j; i++) X[q * n + i] -= LU[j * n + i] * X[q * n + j];
    }
  }
  for (PetscInt k = whole - LU_BLOCK; k >= 0; k -= LU_BLOCK) LUTakeUpper(n, k, others, &LU[k * n], X);
}

INTO_VERSIONS void LUSolveColumns(PetscInt n, const LUNumber LU[], PetscInt columns, LUNumber X[])
{
  PetscInt q = 0;

  for (; q + LU_OTHER <= columns; q += LU_OTHER) LUSolveOthers(n, LU_OTHER, LU, &X[q * n]);
  for (; q < columns; q++) LUSolveOthers(n, 1, LU, &X[q * n]);
}
