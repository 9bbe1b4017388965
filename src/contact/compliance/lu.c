/*
   What an iteration spends its time in: products with W, and LU factors of a hundred rows or two, for which BLAS
   and LAPACK are slow. Rows are not exchanged: what small pivots spoil shows in their ratio, which ComplianceLUFactor()
   returns. Columns are eliminated LU_BLOCK at a time, and taken off four others at once.
*/
#include "base/algebra/versions.h"
#include "complianceimpl.h"

/* columns at a time: what is read of the others is used eight times */
#define LU_BLOCK 8
/* others at once: what is read of the block is used four times, and the sums stay in registers */
#define LU_OTHER 4
/* of a matrix of so many rows, which leaves the cache of a core, so many columns are taken off the others before the
   next ones */
#define LU_LARGE 1000
#define LU_PANEL 64

/* `columns` columns P from row k on become their own L and U */
INTO_VERSIONS void LUFactorBlock(PetscInt n, PetscInt k, PetscInt columns, PetscReal P[])
{
  for (PetscInt j = 0; j < columns; j++) {
    PetscReal      *l     = &P[j * n];
    const PetscReal scale = 1 / l[k + j];

    for (PetscInt i = k + j + 1; i < n; i++) l[i] *= scale;
    for (PetscInt q = j + 1; q < columns; q++) {
      PetscReal      *a = &P[q * n];
      const PetscReal u = a[k + j];

      for (PetscInt i = k + j + 1; i < n; i++) a[i] -= u * l[i];
    }
  }
}

/* Takes the block P at row k off `others` columns A after it */
INTO_VERSIONS void LUTakeBlock(PetscInt n, PetscInt k, PetscInt others, const PetscReal *restrict P,
                               PetscReal *restrict A)
{
  PetscReal u[LU_OTHER][LU_BLOCK];

  for (PetscInt q = 0; q < others; q++)
    for (PetscInt j = 0; j < LU_BLOCK; j++) {
      u[q][j] = A[q * n + k + j];
      for (PetscInt m = 0; m < j; m++) u[q][j] -= P[m * n + k + j] * u[q][m];
      A[q * n + k + j] = u[q][j];
    }
  for (PetscInt i = k + LU_BLOCK; i < n; i++) {
    PetscReal a[LU_OTHER];

    for (PetscInt q = 0; q < others; q++) a[q] = A[q * n + i];
    for (PetscInt j = 0; j < LU_BLOCK; j++)
      for (PetscInt q = 0; q < others; q++) a[q] -= P[j * n + i] * u[q][j];
    for (PetscInt q = 0; q < others; q++) A[q * n + i] = a[q];
  }
}

/* Takes the blocks at rows `from` to `to` off `others` columns A, one after the other */
INTO_VERSIONS void LUTakePanel(PetscInt n, PetscInt from, PetscInt to, PetscInt others, const PetscReal LU[],
                               PetscReal A[])
{
  for (PetscInt k = from; k < to; k += LU_BLOCK) LUTakeBlock(n, k, others, &LU[k * n], A);
}

/* Takes the blocks at rows `from` to `to` off the columns from `to` to `end` */
INTO_VERSIONS void LUTakeColumns(PetscInt n, PetscInt from, PetscInt to, PetscInt end, PetscReal A[])
{
  PetscInt q = to;

  for (; q + LU_OTHER <= end; q += LU_OTHER) LUTakePanel(n, from, to, LU_OTHER, A, &A[q * n]);
  for (; q < end; q++) LUTakePanel(n, from, to, 1, A, &A[q * n]);
}

VERSIONS
/* A = L U without exchange, L with 1 on its diagonal, both in the place of A [n][n] by columns; 2 n^3 / 3 operations.
   The sums have a fixed order, so that the bits do not depend on BLAS or its threads. Returns the least |U_ii| over
   the largest, 0 or no number where a pivot is 0. */
PetscReal ComplianceLUFactor(PetscInt n, PetscReal A[])
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

VERSIONS
void ComplianceLUSolve(PetscInt n, const PetscReal *restrict LU, PetscReal *restrict x)
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j + 1; i < n; i++) x[i] -= LU[j * n + i] * x[j];
  for (PetscInt j = n - 1; j >= 0; j--) {
    x[j] /= LU[j * n + j];
    for (PetscInt i = 0; i < j; i++) x[i] -= LU[j * n + i] * x[j];
  }
}

/* Back substitution of the block P at row k in `others` columns A: its rows, and what they take off those before */
INTO_VERSIONS void LUTakeUpper(PetscInt n, PetscInt k, PetscInt others, const PetscReal *restrict P,
                               PetscReal *restrict A)
{
  PetscReal u[LU_OTHER][LU_BLOCK];

  for (PetscInt q = 0; q < others; q++)
    for (PetscInt j = LU_BLOCK - 1; j >= 0; j--) {
      u[q][j] = A[q * n + k + j];
      for (PetscInt m = LU_BLOCK - 1; m > j; m--) u[q][j] -= P[m * n + k + j] * u[q][m];
      A[q * n + k + j] = u[q][j] /= P[j * n + k + j];
    }
  for (PetscInt i = 0; i < k; i++) {
    PetscReal a[LU_OTHER];

    for (PetscInt q = 0; q < others; q++) a[q] = A[q * n + i];
    for (PetscInt j = LU_BLOCK - 1; j >= 0; j--)
      for (PetscInt q = 0; q < others; q++) a[q] -= P[j * n + i] * u[q][j];
    for (PetscInt q = 0; q < others; q++) A[q * n + i] = a[q];
  }
}

/* The same with LU_OTHER columns at once, for which the factors are read once */
INTO_VERSIONS void LUSolveOthers(PetscInt n, PetscInt others, const PetscReal *restrict LU, PetscReal *restrict X)
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

VERSIONS
void ComplianceLUSolveColumns(PetscInt n, const PetscReal LU[], PetscInt columns, PetscReal X[])
{
  PetscInt q = 0;

  for (; q + LU_OTHER <= columns; q += LU_OTHER) LUSolveOthers(n, LU_OTHER, LU, &X[q * n]);
  for (; q < columns; q++) LUSolveOthers(n, 1, LU, &X[q * n]);
}

VERSIONS
/* y += W[:, column] x, eight columns in one pass over y: y is read and written once for eight. Columns beyond n are
   the last one with the factor 0. */
void ComplianceAddColumns(PetscInt N, const PetscReal *restrict W, PetscInt n, const PetscInt column[],
                          const PetscReal x[], PetscReal *restrict y)
{
  for (PetscInt k = 0; k < n; k += LU_BLOCK) {
    const PetscReal *w[LU_BLOCK];
    PetscReal        f[LU_BLOCK];

    for (PetscInt j = 0; j < LU_BLOCK; j++) {
      w[j] = &W[column[PetscMin(k + j, n - 1)] * N];
      f[j] = k + j < n ? x[k + j] : 0;
    }
    for (PetscInt i = 0; i < N; i++)
      y[i] += ((w[0][i] * f[0] + w[1][i] * f[1]) + (w[2][i] * f[2] + w[3][i] * f[3])) +
              ((w[4][i] * f[4] + w[5][i] * f[5]) + (w[6][i] * f[6] + w[7][i] * f[7]));
  }
}

/* Eight numbers in a row, of any alignment */
typedef PetscReal LURow __attribute__((vector_size(64), aligned(8), may_alias));
_Static_assert(sizeof(LURow) == LU_BLOCK * sizeof(PetscReal), "a row of a block");

#define LU_READ(x) (*(const LURow *)(x))

/* Columns k to k + 3 of W below row k + 3, and the same as rows: y of both */
INTO_VERSIONS void SymmetricBelow(PetscInt N, PetscInt k, const PetscReal *restrict W, const PetscReal *restrict x,
                                  PetscReal *restrict y)
{
  const PetscReal *w[LU_OTHER]   = {&W[k * N], &W[(k + 1) * N], &W[(k + 2) * N], &W[(k + 3) * N]};
  LURow            sum[LU_OTHER] = {{0}};
  PetscInt         i             = k + LU_OTHER;

  for (; i + LU_BLOCK <= N; i += LU_BLOCK) {
    const LURow a = LU_READ(&w[0][i]), b = LU_READ(&w[1][i]), c = LU_READ(&w[2][i]), d = LU_READ(&w[3][i]),
                z = LU_READ(&x[i]);

    *(LURow *)&y[i] = LU_READ(&y[i]) + ((a * x[k] + b * x[k + 1]) + (c * x[k + 2] + d * x[k + 3]));
    sum[0] += a * z;
    sum[1] += b * z;
    sum[2] += c * z;
    sum[3] += d * z;
  }
  for (int j = 0; j < LU_OTHER; j++)
    for (int l = 0; l < LU_BLOCK; l++) y[k + j] += sum[j][l];
  for (; i < N; i++)
    for (int j = 0; j < LU_OTHER; j++) {
      y[i] += w[j][i] * x[k + j];
      y[k + j] += w[j][i] * x[i];
    }
}

VERSIONS
/* y += W x of a symmetric W, of which half is read */
void ComplianceAddSymmetric(PetscInt N, const PetscReal *restrict W, const PetscReal *restrict x, PetscReal *restrict y)
{
  const PetscInt whole = N / LU_OTHER * LU_OTHER;

  for (PetscInt k = 0; k < whole; k += LU_OTHER) {
    for (int j = 0; j < LU_OTHER; j++)
      for (int i = 0; i < LU_OTHER; i++) y[k + i] += W[(k + j) * N + k + i] * x[k + j];
    SymmetricBelow(N, k, W, x, y);
  }
  for (PetscInt j = whole; j < N; j++)
    for (PetscInt i = whole; i < N; i++) y[i] += W[j * N + i] * x[j];
}
