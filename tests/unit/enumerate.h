/*
   Contact problems of a few pairs by brute force, in long double: every choice of open and closed pairs is solved and
   checked. Nothing of it is shared with statics/.

   Gaps are q + W l with forces l along N' - mu T'; closed: gap + l / k = 0 and l >= 0, open: l = 0 and gap >= 0: the
   linear complementarity problem of W + I / k and q. It has exactly one solution for every q when all principal minors
   of the matrix are positive (R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, 1992, 3.3.7).
*/
#pragma once

#include <petscmat.h>
#include <stdlib.h>
#include <string.h>

#define ENUMERATE_MAX 12 /* pairs */

typedef struct {
  int       n;                       /* solutions */
  PetscBool unique;                  /* all principal minors are positive, hence n is 1 for any load */
  PetscBool sharp;                   /* nothing was decided by less than 1e-9 */
  PetscReal force[8][ENUMERATE_MAX]; /* lambda_n of the first of them, N */
} Solutions;

typedef struct {
  int          n;                                       /* pairs */
  long double *K, *N, *T, *f;                           /* [unknowns][unknowns], [pairs][unknowns], [unknowns] */
  long double  g0[ENUMERATE_MAX], slack[ENUMERATE_MAX]; /* 1 / k_n */
  int          n_unknowns;
} DenseContact;

/* B <- A^-1 B for B [n][m], by rows, partial pivoting; the determinant's sign, 0 where a pivot is below 1e-15 of the
   largest entry of its column */
static inline int LongSolve(int n, long double A[], int m, long double B[])
{
  int sign = 1;

  for (int j = 0; j < n; j++) {
    long double largest = 0;
    int         best    = j;

    for (int i = 0; i < n; i++) largest = fmaxl(largest, fabsl(A[i * n + j]));
    for (int i = j; i < n; i++)
      if (fabsl(A[i * n + j]) > fabsl(A[best * n + j])) best = i;
    if (!(fabsl(A[best * n + j]) > 1e-15L * largest)) return 0;
    for (int k = 0; k < n && best != j; k++) {
      const long double a = A[j * n + k];

      A[j * n + k]    = A[best * n + k];
      A[best * n + k] = a;
    }
    for (int k = 0; k < m && best != j; k++) {
      const long double b = B[j * m + k];

      B[j * m + k]    = B[best * m + k];
      B[best * m + k] = b;
    }
    if ((A[j * n + j] < 0) != (best != j)) sign = -sign;
    for (int i = 0; i < n; i++) {
      const long double factor = i == j ? 0 : A[i * n + j] / A[j * n + j];

      if (factor == 0) continue;
      for (int k = j; k < n; k++) A[i * n + k] -= factor * A[j * n + k];
      for (int k = 0; k < m; k++) B[i * m + k] -= factor * B[j * m + k];
    }
  }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) B[i * m + k] /= A[i * n + i];
  return sign;
}

/* W + I / k, [n][n], and q, for regular K; false where K is singular */
static inline PetscBool Condense(const DenseContact *c, PetscReal mu, long double W[], long double q[])
{
  const int    n = c->n_unknowns, m = c->n + 1;
  long double *A = malloc(sizeof(*A) * (size_t)(n * n)), *B = malloc(sizeof(*B) * (size_t)(n * m));
  PetscBool    good;

  memcpy(A, c->K, sizeof(*A) * (size_t)(n * n));
  for (int i = 0; i < n; i++) {
    for (int p = 0; p < c->n; p++) B[i * m + p] = c->N[p * n + i] - mu * c->T[p * n + i];
    B[i * m + c->n] = c->f[i];
  }
  good = LongSolve(n, A, m, B) > 0 ? PETSC_TRUE : PETSC_FALSE;
  for (int p = 0; p < c->n; p++)
    for (int k = 0; k < m; k++) {
      long double sum = 0;

      for (int i = 0; i < n; i++) sum += c->N[p * n + i] * B[i * m + k];
      if (k < c->n)
        W[p * c->n + k] = sum + (p == k ? c->slack[p] : 0);
      else
        q[p] = c->g0[p] - sum;
    }
  free(A);
  free(B);
  return good;
}

/* One choice of closed pairs, the bits of `closed` */
static inline void Try(int n, const long double W[], const long double q[], unsigned closed, Solutions *s)
{
  long double A[ENUMERATE_MAX * ENUMERATE_MAX], l[ENUMERATE_MAX], all[ENUMERATE_MAX] = {0}, force = 0, length = 0;
  int         at[ENUMERATE_MAX], m = 0, sign, good = 1;

  for (int p = 0; p < n; p++)
    if (closed >> p & 1) at[m++] = p;
  for (int i = 0; i < m; i++) {
    for (int j = 0; j < m; j++) A[i * m + j] = W[at[i] * n + at[j]] / W[at[i] * n + at[i]];
    l[i] = -q[at[i]] / W[at[i] * n + at[i]];
  }
  sign = LongSolve(m, A, 1, l);
  if (sign <= 0) s->unique = PETSC_FALSE;
  if (!sign) return;
  for (int i = 0; i < m; i++) all[at[i]] = l[i];
  for (int p = 0; p < n; p++) {
    force  = fmaxl(force, fabsl(all[p]));
    length = fmaxl(length, fabsl(q[p]));
  }
  for (int p = 0; p < n; p++) {
    long double gap = q[p], measure;

    for (int k = 0; k < n; k++) gap += W[p * n + k] * all[k];
    measure = closed >> p & 1 ? all[p] / force : gap / length;
    if (fabsl(measure) < 1e-9L) s->sharp = PETSC_FALSE;
    if (measure < 0) good = 0;
  }
  for (int p = 0; p < n && good && s->n < 8; p++) s->force[s->n][p] = (PetscReal)all[p];
  s->n += good;
}

/* All solutions; false where K is singular */
static inline PetscBool Enumerate(const DenseContact *c, PetscReal mu, Solutions *s)
{
  long double W[ENUMERATE_MAX * ENUMERATE_MAX], q[ENUMERATE_MAX];

  *s = (Solutions){.unique = PETSC_TRUE, .sharp = PETSC_TRUE};
  if (!Condense(c, mu, W, q)) return PETSC_FALSE;
  for (unsigned closed = 0; closed < 1u << c->n; closed++) Try(c->n, W, q, closed, s);
  return PETSC_TRUE;
}

/* A as long doubles, by rows */
static inline PetscErrorCode LongMatrix(Mat A, long double **values)
{
  PetscInt n, m;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &n, &m));
  *values = calloc((size_t)(n * m), sizeof(**values));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt    *column;
    const PetscScalar *v;
    PetscInt           k;

    PetscCall(MatGetRow(A, i, &k, &column, &v));
    for (PetscInt j = 0; j < k; j++) (*values)[i * m + column[j]] = v[j];
    PetscCall(MatRestoreRow(A, i, &k, &column, &v));
  }
  PetscFunctionReturn(0);
}
