/*
   How a change couples the modes, modes_couplings.csv: with lambda_j, x_j, y_j of the system as it was, and
   Delta(lambda) what the change adds to Q(lambda),

      S_ij = -y_i' Delta(lambda_j) x_j / (y_i' Q'(lambda_i) x_i)     1/s.

   S_ii is the shift of lambda_i to first order. The eigenvalues of diag(lambda_i) + S are right to second order in what
   the modes of the band have a share in, and pairs that merge or part are in them: this is Q(s)^-1 as a sum over the
   modes, but for those beyond the band and their conjugates. Several changes add up, and so do multiples of masses,
   springs and dashpots. No equation is solved for it.
*/
#include "changes.h"
#include <complex.h>

/* What a term adds to Q(lambda) per unit of its a a' or A; of a mass that hangs what it exerts at a */
static PetscComplex TermAmount(const ChangeTerm *term, PetscComplex lambda)
{
  const PetscComplex spring = term->stiffness + lambda * term->viscosity, mass = lambda * lambda * term->mass;

  return term->hung ? spring * mass / (spring + mass) : spring + mass;
}

/* z = A x_j by the columns of the modes, of one term */
static void TermTimes(const ChangeSpace *s, PetscInt t, PetscInt j, PetscComplex z[])
{
  const PetscInt   n = s->n_modes;
  const PetscReal *x = &s->before[2 * j * n], *l = s->side[0][t], *r = s->side[1][t];
  PetscComplex     sum = 0;

  for (PetscInt i = 0; i < n; i++) z[i] = 0;
  if (s->term[t].force) {
    for (PetscInt k = 0; k < n; k++) sum += r[k] * CMPLX(x[k], x[n + k]);
    for (PetscInt i = 0; i < n; i++) z[i] = l[i] * sum;
    return;
  }
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < n; i++) z[i] += l[k * n + i] * CMPLX(x[k], x[n + k]);
}

/* Column j of S, [n_before] */
static PetscErrorCode CouplingColumn(Modes modes, const ChangeSpace *s, PetscInt j, PetscComplex column[])
{
  const PetscInt n = s->n_modes;
  PetscComplex  *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &z));
  for (PetscInt i = 0; i < s->n_before; i++) column[i] = 0;
  for (PetscInt t = 0; t < s->n_terms; t++) {
    const PetscComplex amount = TermAmount(&s->term[t], s->lambda[j]);

    TermTimes(s, t, j, z);
    for (PetscInt i = 0; i < s->n_before; i++) {
      const PetscReal   *y     = &s->after[2 * i * n];
      const PetscComplex slope = 2 * s->lambda[i] * CMPLX(modes->mode[i].product[0], modes->mode[i].product[1]);
      PetscComplex       yz    = 0;

      for (PetscInt k = 0; k < n; k++) yz += CMPLX(y[k], y[n + k]) * z[k];
      column[i] -= amount * yz / slope;
    }
  }
  PetscCall(PetscFree(z));
  PetscFunctionReturn(0);
}

/* Rows of one change; rigid modes are left out */
static PetscErrorCode CouplingsWriteOne(Modes modes, const ChangeSpace *s, PetscInt change, ResultsTable table)
{
  PetscComplex *column;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_before, &column));
  for (PetscInt j = 0; j < s->n_before; j++) {
    if (modes->mode[j].rigid) continue;
    PetscCall(CouplingColumn(modes, s, j, column));
    for (PetscInt i = 0; i < s->n_before; i++)
      if (!modes->mode[i].rigid && column[i] != 0)
        PetscCall(ResultsTableRow(table, "%s,%d,%d,%.9g,%.9g", modes->change[change].name, (int)i + 1, (int)j + 1,
                                  (double)creal(column[i]), (double)cimag(column[i])));
  }
  PetscCall(PetscFree(column));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangesWriteCouplings(Modes modes, const ChangeRange *range, Results results)
{
  ChangeSpace  space;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ChangeSpaceCreate(modes, range, &space));
  PetscCall(ResultsTableOpen(results, "modes_couplings", "change,mode,of,real_rad_s,imaginary_rad_s", &table));
  for (PetscInt i = 0; i < modes->n_changes; i++) {
    PetscInt    n;
    ChangeTerm *terms;

    PetscCall(ChangeCreateTerms(modes, i, &n, &terms));
    PetscCall(ChangeSpaceTake(&space, n, terms));
    PetscCall(CouplingsWriteOne(modes, &space, i, table));
    PetscCall(ChangeDestroyTerms(n, &terms));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(ChangeSpaceDestroy(&space));
  PetscFunctionReturn(0);
}
