/*
   What an iteration spends its time in: products with W, and LU factors of a hundred rows or two, for which BLAS
   and LAPACK are slow (lufactors.h).
*/
#include "base/algebra/versions.h"
#include "complianceimpl.h"
#include "lufactors.h"

VERSIONS
PetscReal ComplianceLUFactor(PetscInt n, PetscReal A[])
{
  return LUFactor(n, A);
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

VERSIONS
void ComplianceLUSolveColumns(PetscInt n, const PetscReal LU[], PetscInt columns, PetscReal X[])
{
  LUSolveColumns(n, LU, columns, X);
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
