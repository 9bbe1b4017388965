/*
   The normal laws of pairs that slide, by complementary pivoting (C. E. Lemke, Management Sci. 11, 1965): finite where
   the active set goes round in circles, and indifferent to rounding where pairs open or close in any order.

   With gaps g = g0 + l / k - w the small system w + (W - V D) l - W w = rhs of forces l (m) becomes

      l = M g + q,   M = B^-1 A,   q = B^-1 (rhs - A g0),   A = I - W,   B = A / k + W - V D,   0 <= l, 0 <= g, l g = 0.

   Pairs of Coulomb's law can be pivoted without friction only: their tangential rows have l = 0, so that B has the
   columns of A there for w, and nothing is complementary to them.

   The tableau l - M g - e z0 = q, e = (1, ..., 1), begins with the largest z0 that makes all forces positive; whenever
   a variable leaves the basis its complement enters, until z0 leaves. Ties are broken lexicographically by the columns
   of l, so that no basis comes twice. A column without positive entry is a ray: no equilibrium is found.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"
#include "base/algebra/dense.h"

#define PIVOT_LEAST 1e-11 /* of the largest entry of a column: a smaller one is rounding */
#define PIVOT_TIES  1e-12 /* of the largest ratio: closer ones are equal */
#define PIVOT_MOST  50    /* pivots per pair */

/* What the law of a row says, all ranks' one after the other */
typedef struct {
  PetscReal flexibility, g0, slide; /* 1 / k, m, part of mu */
  PetscBool tangential;
} PivotLaw;

/* Rows of l, g, z0 and the right-hand side: row i is T[i * width ..] */
typedef struct {
  PetscInt   n, width, *basis; /* variable of each row: 0 .. n - 1 forces, n .. 2 n - 1 gaps, 2 n is z0 */
  PetscReal *T;
} PivotTableau;

/* B, A, and rhs - A g0 (m), by columns, [n][n] and [n]; rhs is overwritten. A and B have no unit: l and g are both in
   m. */
static void PivotSystem(const Compliance *c, PetscInt n, const PivotLaw law[], PetscReal A[], PetscReal B[],
                        PetscReal rhs[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal W = c->W[j * n + i], a = (i == j ? 1 : 0) - W;

      A[j * n + i] = a;
      B[j * n + i] = law[j].tangential ? a : a * law[j].flexibility + W;
      if (c->V) B[j * n + i] -= law[j].slide * c->V[j * n + i];
      rhs[i] -= a * law[j].g0;
    }
}

/* Keeps the normal rows of M (and columns) and q; their number */
static PetscInt PivotKeepNormal(PetscInt n, const PivotLaw law[], PetscReal M[], PetscReal q[])
{
  PetscInt m = 0, at = 0;

  for (PetscInt i = 0; i < n; i++)
    if (!law[i].tangential) q[m++] = q[i];
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n && !law[j].tangential; i++)
      if (!law[i].tangential) M[at++] = M[j * n + i];
  return m;
}

/* The tableau of M and q, given by columns, with the forces as its basis */
static PetscErrorCode PivotTableauCreate(PetscInt n, const PetscReal M[], const PetscReal q[], PivotTableau *t)
{
  PetscFunctionBeginUser;
  t->n     = n;
  t->width = 2 * n + 2;
  PetscCall(PetscCalloc2(n * t->width, &t->T, n, &t->basis));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *row = &t->T[i * t->width];

    row[i] = 1;
    for (PetscInt j = 0; j < n; j++) row[n + j] = -M[j * n + i];
    row[2 * n]     = -1;
    row[2 * n + 1] = q[i];
    t->basis[i]    = i;
  }
  PetscFunctionReturn(0);
}

/* Variable `column` enters in row r */
static void PivotExchange(PivotTableau *t, PetscInt r, PetscInt column)
{
  PetscReal *const row   = &t->T[r * t->width];
  const PetscReal  pivot = 1 / row[column];

  for (PetscInt k = 0; k < t->width; k++) row[k] *= pivot;
  row[column] = 1;
  for (PetscInt i = 0; i < t->n; i++) {
    PetscReal *const other  = &t->T[i * t->width];
    const PetscReal  factor = other[column];

    if (i == r || factor == 0) continue;
    for (PetscInt k = 0; k < t->width; k++) other[k] -= factor * row[k];
    other[column] = 0;
  }
  t->basis[r] = column;
}

/* Whether row a, divided by its entry of the column, comes lexicographically before row b */
static PetscBool PivotIsLess(const PivotTableau *t, PetscInt a, PetscInt b, PetscInt column)
{
  const PetscReal *x = &t->T[a * t->width], *y = &t->T[b * t->width];

  for (PetscInt k = -1; k < t->n; k++) {
    const PetscInt  at = k < 0 ? t->width - 1 : k;
    const PetscReal p = x[at] / x[column], q = y[at] / y[column];

    if (PetscAbsReal(p - q) > PIVOT_TIES * PetscMax(PetscAbsReal(p), PetscAbsReal(q))) return (PetscBool)(p < q);
  }
  return PETSC_FALSE;
}

/* Row whose variable leaves when `column` enters, z0 first among equals; -1 for a ray */
static PetscInt PivotRow(const PivotTableau *t, PetscInt column)
{
  PetscReal largest = 0;
  PetscInt  best    = -1;

  for (PetscInt i = 0; i < t->n; i++) largest = PetscMax(largest, PetscAbsReal(t->T[i * t->width + column]));
  for (PetscInt i = 0; i < t->n; i++) {
    if (t->T[i * t->width + column] <= PIVOT_LEAST * largest) continue;
    if (best < 0 || PivotIsLess(t, i, best, column)) best = i;
  }
  return best;
}

/* Pivots until z0 leaves; false where it does not. z0 enters in the row of the most negative right-hand side, after
   which all are positive. PIVOT_MOST bounds what the lexicographic rule makes finite: Lemke's method may need 2^n
   pivots, in practice a few n. */
static PetscBool PivotComplement(PivotTableau *t)
{
  const PetscInt n = t->n, z0 = 2 * n;
  PetscInt       r = 0, enters = z0;

  for (PetscInt i = 1; i < n; i++)
    if (t->T[i * t->width + z0 + 1] < t->T[r * t->width + z0 + 1]) r = i;
  if (t->T[r * t->width + z0 + 1] >= 0) return PETSC_TRUE; /* all closed */
  for (PetscInt it = 0; it < PIVOT_MOST * n && r >= 0; it++) {
    const PetscInt leaves = t->basis[r];

    PivotExchange(t, r, enters);
    if (leaves == z0) return PETSC_TRUE;
    enters = leaves < n ? leaves + n : leaves - n;
    r      = PivotRow(t, enters);
  }
  return PETSC_FALSE;
}

/* Open pairs are those whose gap is in the basis; law [rows] of all, pairs numbered by their normal rows */
static void PivotStatus(const PivotTableau *t, const PairRows *rows, const PivotLaw law[], ContactStatus status[])
{
  PetscInt begin = 0;

  for (PetscInt i = 0; i < rows->begin; i++) begin += !law[i].tangential;
  for (PetscInt p = 0; p < rows->n_pairs; p++) status[p] = CONTACT_SLIP;
  for (PetscInt i = 0; i < t->n; i++) {
    const PetscInt p = t->basis[i] - t->n - begin;

    if (t->basis[i] >= t->n && p >= 0 && p < rows->n_pairs) status[p] = CONTACT_OPEN;
  }
}

/* Laws of the rows of all ranks */
static PetscErrorCode PivotGather(const PairRows *rows, PetscReal friction, PivotLaw **all)
{
  PivotLaw *law;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, &law));
  for (PetscInt p = 0; p < rows->n_pairs; p++)
    for (PetscInt i = rows->first[p]; i < rows->first[p + 1]; i++) {
      law[i] = (PivotLaw){.tangential = PETSC_TRUE};
      if (i == rows->first[p])
        law[i] = (PivotLaw){1 / rows->law[p].k, CoulombOrigin(&rows->law[p]), friction * rows->slide[p], PETSC_FALSE};
    }
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(PivotLaw), law, NULL, all));
  PetscCall(PetscFree(law));
  PetscFunctionReturn(0);
}

/* Every rank pivots the same tableau, of 2 n^2 numbers, from the same bits, so that all decide alike; each pivot
   costs 4 n^2 operations */
PetscErrorCode PivotSolve(const Compliance *c, PetscReal friction, const PetscReal rhs[], ContactStatus status[],
                          PetscBool *found)
{
  const PairRows *rows = c->rows;
  PivotLaw       *law;
  PivotTableau    tableau;
  const PetscInt  n = c->rows->n_all;
  PetscBLASInt   *pivot;
  PetscBool       singular;
  PetscReal      *A, *B, *q;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(PivotGather(rows, friction, &law));
  PetscCall(GatherRecords(rows->comm, rows->n, sizeof(PetscReal), rhs, NULL, &q));
  PetscCall(PetscMalloc3(n * n, &A, n * n, &B, n, &pivot));
  PivotSystem(c, n, law, A, B, q);
  PetscCall(DenseFactor(n, B, pivot, &singular));
  if (!singular) {
    PetscCall(DenseSolve(n, B, pivot, PETSC_FALSE, n, A));
    PetscCall(DenseSolve(n, B, pivot, PETSC_FALSE, 1, q));
    PetscCall(PivotTableauCreate(PivotKeepNormal(n, law, A, q), A, q, &tableau));
    *found = PivotComplement(&tableau);
    if (*found) PivotStatus(&tableau, rows, law, status);
    PetscCall(PetscFree2(tableau.T, tableau.basis));
  }
  PetscCall(PetscFree3(A, B, pivot));
  PetscCall(PetscFree(law));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
}
