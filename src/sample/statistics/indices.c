/*
   Indices of Sobol of y = f(x), the variables independent, V = Var(y):

      first order   S_k = Var(E(y | x_k)) / V,    sum_r f(B)(f(AB_k) - f(A)) / (n V)       A. Saltelli et al. 2010
      total         T_k = E(Var(y | x_~k)) / V,   sum_r (f(A) - f(AB_k))^2 / (2 n V)       M. J. W. Jansen 1999

   (both in Computer Physics Communications, 181 and 117), f less its mean, AB_k being A with variable k of B. Their
   standard errors are those of a ratio of means of independent rows r, g_r over v_r with v_r = (f(A)^2 + f(B)^2) / 2,
   to first order:

      s^2 = sum_r (g_r - S v_r)^2 / (n^2 V^2)

   Rows of a sequence that fills the box evenly err less.

   The regression is y = c + sum_k b_k (x_k - mean) by least squares; standardised, b_k s(x_k) / s(y), it ranks the
   variables as far as y is straight, which R^2 tells. Its standard error is that of independent residuals of one
   variance.
*/
#include "indices.h"
#include "base/algebra/dense.h"

/* mean of g over mean of v, and its standard error */
static void RatioFind(PetscInt n, const PetscReal g[], const PetscReal v[], PetscReal *ratio, PetscReal *error)
{
  PetscReal sum_g = 0, sum_v = 0, square = 0;

  for (PetscInt r = 0; r < n; r++) sum_g += g[r], sum_v += v[r];
  *ratio = n > 1 && sum_v > 0 ? sum_g / sum_v : NAN;
  for (PetscInt r = 0; r < n; r++) square += PetscSqr(g[r] - *ratio * v[r]);
  *error = PetscSqrtReal(square) / sum_v;
}

/* The rows that have all values: list [n], and how many */
static PetscInt DesignRows(const SobolDesign *design, PetscInt list[])
{
  PetscInt n_rows = 0;

  for (PetscInt r = 0; r < design->n; r++) {
    PetscReal sum = design->a[r] + design->b[r];

    for (PetscInt k = 0; k < design->n_variables; k++) sum += design->mixed[k * design->n + r];
    if (!PetscIsNanReal(sum)) list[n_rows++] = r;
  }
  return n_rows;
}

PetscErrorCode IndicesOfSobol(const SobolDesign *design, VariableIndex index[], PetscInt *n_rows)
{
  const PetscInt   n = design->n;
  const PetscReal *a = design->a, *b = design->b;
  PetscInt        *row, m;
  PetscReal       *first, *total, *v, mean = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &row, n, &first, n, &total, n, &v));
  *n_rows = m = DesignRows(design, row);
  for (PetscInt i = 0; i < m; i++) mean += 0.5 * (a[row[i]] + b[row[i]]) / (PetscReal)m;
  for (PetscInt i = 0; i < m; i++) v[i] = 0.5 * (PetscSqr(a[row[i]] - mean) + PetscSqr(b[row[i]] - mean));
  for (PetscInt k = 0; k < design->n_variables; k++) {
    for (PetscInt i = 0; i < m; i++) {
      const PetscReal fa = a[row[i]], fb = b[row[i]], fk = design->mixed[k * n + row[i]];

      first[i] = (fb - mean) * (fk - fa);
      total[i] = 0.5 * PetscSqr(fa - fk);
    }
    RatioFind(m, first, v, &index[k].first, &index[k].first_error);
    RatioFind(m, total, v, &index[k].total, &index[k].total_error);
  }
  PetscCall(PetscFree4(row, first, total, v));
  PetscFunctionReturn(0);
}

/* Mean and sum of squares about it of the numbers at every stride-th place, of those points that have y */
static void SpreadFind(const Regression *g, const PetscReal x[], PetscInt stride, PetscReal *mean, PetscReal *square)
{
  PetscInt m = 0;

  *mean = *square = 0;
  for (PetscInt i = 0; i < g->n; i++)
    if (!PetscIsNanReal(g->y[i])) *mean += x[i * stride], m++;
  *mean /= (PetscReal)PetscMax(1, m);
  for (PetscInt i = 0; i < g->n; i++)
    if (!PetscIsNanReal(g->y[i])) *square += PetscSqr(x[i * stride] - *mean);
}

/* The normal equations of standardised numbers, G b = c with G, c correlations: G [d][d], c [d]. Few variables, each
   varied by itself, make them well conditioned */
static void NormalEquations(const Regression *g, const PetscReal mean[], const PetscReal root[], PetscReal G[],
                            PetscReal c[])
{
  const PetscInt d = g->n_variables;

  for (PetscInt i = 0; i < g->n; i++) {
    const PetscReal *x = &g->x[i * d], y = (g->y[i] - mean[d]) / root[d];

    if (PetscIsNanReal(y)) continue;
    for (PetscInt k = 0; k < d; k++) {
      const PetscReal z = (x[k] - mean[k]) / root[k];

      c[k] += z * y;
      for (PetscInt j = 0; j < d; j++) G[j * d + k] += z * (x[j] - mean[j]) / root[j];
    }
  }
}

/* b = G^-1 c, R^2 = c' b, errors (1 - R^2) / (m - d - 1) times the diagonal of G^-1 */
PetscErrorCode RegressionSlopes(const Regression *g, VariableIndex index[], PetscReal *r_squared)
{
  const PetscInt d = g->n_variables;
  PetscReal     *mean, *root, *G, *c;
  PetscInt       m = 0;
  PetscBool      singular, flat = PETSC_FALSE;

  PetscFunctionBeginUser;
  *r_squared = NAN;
  PetscCall(PetscCalloc4(d + 1, &mean, d + 1, &root, d * d, &G, d * (d + 1), &c));
  for (PetscInt k = 0; k <= d; k++) {
    SpreadFind(g, k < d ? g->x + k : g->y, k < d ? d : 1, &mean[k], &root[k]);
    root[k] = PetscSqrtReal(root[k]);
    if (!(root[k] > 0)) flat = PETSC_TRUE;
    if (k < d) index[k].slope = index[k].slope_error = NAN;
  }
  for (PetscInt i = 0; i < g->n; i++) m += PetscIsNanReal(g->y[i]) ? 0 : 1;
  if (flat || m < d + 2) goto done;
  NormalEquations(g, mean, root, G, c);
  for (PetscInt k = 0; k < d; k++) c[d * (k + 1) + k] = 1; /* then the columns of G^-1 */
  for (PetscInt k = 0; k < d; k++) index[k].slope_error = c[k];
  PetscCall(DenseSolveWith(d, G, d + 1, c, &singular));
  *r_squared = 0;
  for (PetscInt k = 0; k < d; k++) *r_squared += index[k].slope_error * c[k];
  for (PetscInt k = 0; k < d; k++) {
    index[k].slope       = singular ? NAN : c[k];
    index[k].slope_error = PetscSqrtReal(PetscMax(0, 1 - *r_squared) * c[d * (k + 1) + k] / (PetscReal)(m - d - 1));
  }
done:
  PetscCall(PetscFree4(mean, root, G, c));
  PetscFunctionReturn(0);
}
