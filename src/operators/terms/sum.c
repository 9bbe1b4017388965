/*
   Sums of terms, sum_t c_t(p) A_t, formed row by row into one matrix. Its pattern is the union of the terms that it was
   first formed from; at other values of the parameters only the values are written again, and nothing at all where the
   coefficients are the same. A term that was left out, its coefficient having been zero, makes a new pattern when it
   comes.
*/
#include "terms.h"
#include "base/algebra/matrixadd.h"

/* Columns of one row from several matrices */
typedef struct {
  PetscInt  size, n;
  PetscInt *column;
} SumRow;

static PetscErrorCode SumRowReserve(SumRow *row, PetscInt size)
{
  PetscFunctionBeginUser;
  if (size <= row->size) PetscFunctionReturn(0);
  row->size = 2 * size;
  PetscCall(PetscRealloc((size_t)row->size * sizeof(*row->column), &row->column));
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

/* Local entries of the terms that the sum has, at least as many as it has itself */
static PetscErrorCode SumBound(const Terms *terms, const PetscBool has[], PetscInt *bound)
{
  PetscFunctionBeginUser;
  *bound = 0;
  for (PetscInt t = 0; t < terms->n; t++) {
    MatInfo info;

    if (!has[t]) continue;
    PetscCall(MatGetInfo(terms->term[t].A, MAT_LOCAL, &info));
    *bound += (PetscInt)info.nz_used;
  }
  PetscFunctionReturn(0);
}

/* Compressed rows [rows + 1], [entries], [entries] */
typedef struct {
  PetscInt    *ia, *ja;
  PetscScalar *a;
} SumArrays;

static PetscErrorCode SumArraysDestroy(void *ctx)
{
  SumArrays *arrays = ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscFree3(arrays->ia, arrays->ja, arrays->a));
  PetscCall(PetscFree(arrays));
  PetscFunctionReturn(0);
}

/* The union of the terms that the sum has in the local rows `first` .. `first` + n - 1, with zeros */
static PetscErrorCode SumArraysCreate(const Terms *terms, const PetscBool has[], PetscInt first, PetscInt n,
                                      SumArrays **arrays)
{
  PetscInt   bound;
  SumRow     row = {0};
  SumArrays *s;

  PetscFunctionBeginUser;
  PetscCall(SumBound(terms, has, &bound));
  PetscCall(PetscNew(&s));
  PetscCall(PetscMalloc3(n + 1, &s->ia, bound, &s->ja, bound, &s->a));
  s->ia[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(SumRowUnite(terms, has, first + i, &row));
    PetscCall(PetscArraycpy(&s->ja[s->ia[i]], row.column, row.n));
    s->ia[i + 1] = s->ia[i] + row.n;
  }
  PetscCall(PetscArrayzero(s->a, s->ia[n])); /* the bound may be far above, and its memory stays untouched */
  PetscCall(PetscFree(row.column));
  *arrays = s;
  PetscFunctionReturn(0);
}

/* The matrix of such arrays: on one rank it works in them and takes them along (MatCreateSeqAIJWithArrays() frees
   nothing, a container does), on several it copies them */
static PetscErrorCode SumCreateMatrix(MPI_Comm comm, PetscInt n_rows, PetscInt n_columns, SumArrays *arrays, Mat *A)
{
  PetscMPIInt    size;
  PetscContainer owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size > 1) {
    PetscCall(MatCreateMPIAIJWithArrays(comm, n_rows, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, arrays->ia,
                                        arrays->ja, arrays->a, A));
    PetscCall(SumArraysDestroy(arrays));
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateSeqAIJWithArrays(comm, n_rows, n_columns, arrays->ia, arrays->ja, arrays->a, A));
  PetscCall(PetscContainerCreate(comm, &owner));
  PetscCall(PetscContainerSetPointer(owner, arrays));
  PetscCall(PetscContainerSetUserDestroy(owner, SumArraysDestroy));
  PetscCall(PetscObjectCompose((PetscObject)*A, "squeal_rows", (PetscObject)owner));
  PetscCall(PetscContainerDestroy(&owner));
  PetscFunctionReturn(0);
}

/* Matrix of zeros in the union of the terms that the sum has */
static PetscErrorCode SumCreateUnion(const Terms *terms, const PetscBool has[], Mat *A)
{
  const Mat  like = terms->term[0].A;
  PetscInt   first, n_rows, n_columns;
  SumArrays *arrays;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(like, &first, NULL));
  PetscCall(MatGetLocalSize(like, &n_rows, &n_columns));
  PetscCall(SumArraysCreate(terms, has, first, n_rows, &arrays));
  PetscCall(SumCreateMatrix(PetscObjectComm((PetscObject)like), n_rows, n_columns, arrays, A));
  PetscFunctionReturn(0);
}

/* Whether a term is in a sum with this coefficient: a law's of C always, as the problem is not linear without loss
   at the reference either */
static PetscBool TermCounts(const OperatorsTerm *term, PetscReal c)
{
  if (c != 0) return PETSC_TRUE;
  return term->law && term->kind == OPERATORS_DAMPING && term->scale != 0 && term->reference > 0 ? PETSC_TRUE
                                                                                                 : PETSC_FALSE;
}

/* Coefficients [terms] of the chosen terms, zero for others; all_zero = whether none remains, constant = the only
   chosen term if it never changes and has the factor 1, else NULL: that is handed out itself, without a copy */
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
    if (TermCounts(term, c[t])) *all_zero = PETSC_FALSE;
  }
  *constant = n_chosen == 1 && !only->n && !only->law && only->scale * kind->scale == 1 ? only->A : NULL;
}

/* Makes the pattern cover all terms that count, those of a kind, NULL for any; A stays when it does already */
static PetscErrorCode SumCoverPattern(const Terms *terms, const TermsSumKind *kind, const PetscReal c[], TermsSum *sum)
{
  PetscBool covered = sum->A ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!sum->has) PetscCall(PetscCalloc1(terms->n, &sum->has));
  for (PetscInt t = 0; t < terms->n; t++) {
    const OperatorsTerm *term   = &terms->term[t];
    const PetscBool      stands = kind && term->kind == kind->kind && TermCounts(term, c[t]) ? PETSC_TRUE : PETSC_FALSE;

    if ((c[t] == 0 && !stands) || sum->has[t]) continue;
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

/* TermsSumAdd() of the terms of a kind, NULL for any */
static PetscErrorCode SumAdd(const Terms *terms, const TermsSumKind *kind, const PetscReal c[], TermsSum *sum)
{
  PetscFunctionBeginUser;
  PetscCall(SumCoverPattern(terms, kind, c, sum));
  for (PetscInt t = 0; t < terms->n; t++) {
    PetscBool added = PETSC_TRUE;

    if (sum->has[t]) PetscCall(MatrixAdd(c[t], terms->term[t].A, sum->A, &added));
    PetscCheck(added, PetscObjectComm((PetscObject)sum->A), PETSC_ERR_PLIB, "a term is not in the pattern of its sum");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TermsSumAdd(const Terms *terms, const PetscReal c[], TermsSum *sum)
{
  PetscFunctionBeginUser;
  PetscCall(SumAdd(terms, NULL, c, sum));
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
    PetscCall(SumAdd(terms, kind, c, sum));
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
