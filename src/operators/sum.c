/*
   Sums of terms, sum_t c_t(p) A_t, formed row by row into one matrix. Its pattern is the union of the terms that it was
   first formed from; at other values of the parameters only the values are written again, and nothing at all where the
   coefficients are the same. A term that was left out, its coefficient having been zero, makes a new pattern when it
   comes.
*/
#include "terms.h"

/* Columns of one row from several matrices, and room for scaled values */
typedef struct {
  PetscInt     size, n;
  PetscInt    *column;
  PetscScalar *value;
} SumRow;

static PetscErrorCode SumRowReserve(SumRow *row, PetscInt size)
{
  PetscFunctionBeginUser;
  if (size <= row->size) PetscFunctionReturn(0);
  row->size = 2 * size;
  PetscCall(PetscRealloc((size_t)row->size * sizeof(*row->column), &row->column));
  PetscCall(PetscRealloc((size_t)row->size * sizeof(*row->value), &row->value));
  PetscFunctionReturn(0);
}

static PetscErrorCode SumRowDestroy(SumRow *row)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(row->column));
  PetscCall(PetscFree(row->value));
  PetscFunctionReturn(0);
}

/* Distinct columns of row i of all terms that the sum has */
static PetscErrorCode SumRowUnite(const Terms *terms, const PetscBool has[], PetscInt i, SumRow *row)
{
  PetscInt n_terms = 0;

  PetscFunctionBeginUser;
  row->n = 0;
  for (PetscInt t = 0; t < terms->n; t++) {
    const PetscInt *columns;
    PetscInt        n;

    if (!has[t]) continue;
    PetscCall(MatGetRow(terms->term[t].A, i, &n, &columns, NULL));
    PetscCall(SumRowReserve(row, row->n + n));
    PetscCall(PetscArraycpy(&row->column[row->n], columns, n));
    row->n += n;
    n_terms += n > 0;
    PetscCall(MatRestoreRow(terms->term[t].A, i, &n, &columns, NULL));
  }
  if (n_terms > 1) PetscCall(PetscSortRemoveDupsInt(&row->n, row->column));
  PetscFunctionReturn(0);
}

/* Empty matrix, preallocated exactly for the union of the terms that the sum has */
static PetscErrorCode SumCreateUnion(const Terms *terms, const PetscBool has[], Mat *A)
{
  const Mat like = terms->term[0].A;
  PetscInt  first, last, left, right, *inside, *outside;
  SumRow    row = {0};

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(like, &first, &last));
  PetscCall(MatGetOwnershipRangeColumn(like, &left, &right));
  PetscCall(PetscCalloc2(last - first, &inside, last - first, &outside));
  for (PetscInt i = 0; i < last - first; i++) {
    PetscCall(SumRowUnite(terms, has, first + i, &row));
    for (PetscInt k = 0; k < row.n; k++) inside[i] += row.column[k] >= left && row.column[k] < right;
    outside[i] = row.n - inside[i];
  }
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)like), last - first, right - left, PETSC_DETERMINE,
                         PETSC_DETERMINE, 0, inside, 0, outside, A));
  PetscCall(MatSetOption(*A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(PetscFree2(inside, outside));
  PetscCall(SumRowDestroy(&row));
  PetscFunctionReturn(0);
}

/* A += scale X */
static PetscErrorCode SumAddRows(PetscReal scale, Mat X, Mat A)
{
  PetscInt first, last;
  SumRow   row = {0};

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(X, &first, &last));
  for (PetscInt i = first; i < last; i++) {
    const PetscInt    *columns;
    const PetscScalar *values;
    PetscInt           n;

    PetscCall(MatGetRow(X, i, &n, &columns, &values));
    PetscCall(SumRowReserve(&row, n));
    for (PetscInt k = 0; k < n; k++) row.value[k] = scale * values[k];
    if (n) PetscCall(MatSetValues(A, 1, &i, n, columns, row.value, ADD_VALUES));
    PetscCall(MatRestoreRow(X, i, &n, &columns, &values));
  }
  PetscCall(SumRowDestroy(&row));
  PetscFunctionReturn(0);
}

/* Coefficients [terms] of the chosen terms, zero for others; all_zero = whether none remains, constant = the only
   chosen term if it never changes, else NULL */
static void SumCoefficients(const Terms *terms, const TermsSumKind *kind, const PetscReal p[], PetscReal c[],
                            PetscBool *all_zero, Mat *constant)
{
  const OperatorsTerm *only     = NULL;
  PetscInt             n_chosen = 0;

  *all_zero = PETSC_TRUE;
  for (PetscInt t = 0; t < terms->n; t++) {
    const OperatorsTerm *term = &terms->term[t];

    c[t] = 0;
    if (term->kind != kind->kind) continue;
    if (kind->choice != TERMS_ALL && term->frictional == (kind->choice == TERMS_SYMMETRIC)) continue;
    only = term;
    n_chosen++;
    c[t] = kind->scale * OperatorsTermCoefficient(term, p);
    if (c[t] != 0) *all_zero = PETSC_FALSE;
  }
  *constant = n_chosen == 1 && !only->n && only->scale * kind->scale == 1 ? only->A : NULL;
}

/* Makes the pattern cover all terms that are not zero; A stays when it does already */
static PetscErrorCode SumCoverPattern(const Terms *terms, const PetscReal c[], TermsSum *sum)
{
  PetscBool covered = sum->A ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!sum->has) PetscCall(PetscCalloc1(terms->n, &sum->has));
  for (PetscInt t = 0; t < terms->n; t++) {
    if (c[t] == 0 || sum->has[t]) continue;
    sum->has[t] = PETSC_TRUE;
    covered     = PETSC_FALSE;
  }
  if (covered) {
    PetscCall(MatZeroEntries(sum->A));
    PetscFunctionReturn(0);
  }
  PetscCall(MatDestroy(&sum->A));
  PetscCall(SumCreateUnion(terms, sum->has, &sum->A));
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSumForm(const Terms *terms, const TermsSumKind *kind, const PetscReal p[], TermsSum *sum)
{
  PetscReal *c;
  PetscBool  all_zero, same = PETSC_FALSE;
  Mat        constant;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(terms->n, &c));
  SumCoefficients(terms, kind, p, c, &all_zero, &constant);
  if (sum->A && sum->c) PetscCall(PetscArraycmp(c, sum->c, terms->n, &same));
  if (same) {
    PetscCall(PetscFree(c));
    sum->current = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  if (constant) {
    PetscCall(PetscObjectReference((PetscObject)constant));
    PetscCall(MatDestroy(&sum->A));
    sum->A = constant;
  } else if (all_zero) {
    PetscCall(TermsSumDestroy(sum));
  } else {
    PetscCall(SumCoverPattern(terms, c, sum));
    for (PetscInt t = 0; t < terms->n; t++)
      if (sum->has[t]) PetscCall(SumAddRows(c[t], terms->term[t].A, sum->A));
    PetscCall(MatAssemblyBegin(sum->A, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(sum->A, MAT_FINAL_ASSEMBLY));
  }
  sum->current = PETSC_TRUE;
  PetscCall(PetscFree(sum->c));
  sum->c = c;
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSumDestroy(TermsSum *sum)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&sum->A));
  PetscCall(PetscFree(sum->has));
  PetscCall(PetscFree(sum->c));
  sum->current = PETSC_FALSE;
  PetscFunctionReturn(0);
}
