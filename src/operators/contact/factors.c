/*
   The unsymmetric stiffness of closed pairs as a product of two matrices with a row for each pair,

      sum_t c_t(p) L_t' R_t = L' R,   L = [c_1 L_1; c_2 L_2; ...],   R = [R_1; R_2; ...]

   so that what is symmetric can be factored by itself (solver/factor/lowrank.h). A row of L is the tangential
   displacement of a pair (dimensionless), a row of R minus its normal displacement times the penalty per pair or the
   area; c_t holds k_n mu. Terms one after another with one L, as of friction at several speeds, have its rows once,
   with R = sum_t c_t / c_1 R_t.
*/
#include "base/algebra/matrixadd.h"
#include "operators/pencilimpl.h"

/* Whether a term takes part: unsymmetric stiffness with a coefficient */
static PetscBool TakesPart(const OperatorsTerm *term, const PetscReal p[])
{
  return term->kind == OPERATORS_STIFFNESS && term->frictional && OperatorsTermCoefficient(term, p) != 0 ? PETSC_TRUE
                                                                                                         : PETSC_FALSE;
}

/* Row i of A times c as row `row` of B */
static PetscErrorCode RowCopy(PetscReal c, Mat A, PetscInt i, PetscInt row, Mat B)
{
  const PetscInt    *columns;
  const PetscScalar *values;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(MatGetRow(A, i, &n, &columns, &values));
  for (PetscInt k = 0; k < n; k++) PetscCall(MatSetValue(B, row, columns[k], c * values[k], INSERT_VALUES));
  PetscCall(MatRestoreRow(A, i, &n, &columns, &values));
  PetscFunctionReturn(0);
}

/* Puts the local rows of A times c into B from its row `first` on */
static PetscErrorCode RowsCopy(PetscReal c, Mat A, PetscInt first, Mat B)
{
  PetscInt begin, end;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &begin, &end));
  for (PetscInt i = begin; i < end; i++) PetscCall(RowCopy(c, A, i, first++, B));
  PetscFunctionReturn(0);
}

/* The larger of *longest and the length of the longest local row */
static PetscErrorCode RowsLongest(Mat A, PetscInt *longest)
{
  PetscInt begin, end;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &begin, &end));
  for (PetscInt i = begin; i < end; i++) {
    PetscInt n;

    PetscCall(MatGetRow(A, i, &n, NULL, NULL));
    *longest = PetscMax(*longest, n);
    PetscCall(MatRestoreRow(A, i, &n, NULL, NULL));
  }
  PetscFunctionReturn(0);
}

/* The first term after t that has another left factor, or is no stiffness: damping of friction has factors too */
static PetscInt BlockEnd(const Terms *terms, PetscInt t)
{
  const OperatorsTerm *term = &terms->term[t];
  PetscInt             end  = t + 1;

  while (end < terms->n && term->left && terms->term[end].left == term->left && terms->term[end].kind == term->kind)
    end++;
  return end;
}

/* sum_k c_k / c_t R_k over the terms from t to `end`; the caller destroys it */
static PetscErrorCode RightCreate(const Terms *terms, const PetscReal p[], PetscInt t, PetscInt end, Mat *R)
{
  const PetscReal c = OperatorsTermCoefficient(&terms->term[t], p);

  PetscFunctionBeginUser;
  if (end == t + 1) {
    PetscCall(PetscObjectReference((PetscObject)terms->term[t].right));
    *R = terms->term[t].right;
    PetscFunctionReturn(0);
  }
  PetscCall(MatDuplicate(terms->term[t].right, MAT_COPY_VALUES, R));
  for (PetscInt k = t + 1; k < end; k++)
    PetscCall(
      MatAXPY(*R, OperatorsTermCoefficient(&terms->term[k], p) / c, terms->term[k].right, SAME_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

/* All left factors times their coefficients, or all right factors, below one another: [pairs of this
   rank][unknowns]. Coefficients stand in L alone; rows keep the order of the terms in both. */
static PetscErrorCode FactorsStack(const Terms *terms, const PetscReal p[], PetscBool right, Mat *S)
{
  PetscInt n_rows = 0, n, n_columns = 0, longest = 0, first;
  MPI_Comm comm = MPI_COMM_NULL;

  PetscFunctionBeginUser;
  for (PetscInt t = 0, end; t < terms->n; t = end) {
    const Mat A = right ? terms->term[t].right : terms->term[t].left;

    end = TakesPart(&terms->term[t], p) ? BlockEnd(terms, t) : t + 1;
    if (!TakesPart(&terms->term[t], p)) continue;
    PetscCall(PetscObjectGetComm((PetscObject)A, &comm));
    PetscCall(MatGetLocalSize(A, &n, &n_columns));
    PetscCall(RowsLongest(A, &longest));
    n_rows += n;
  }
  PetscCall(MatCreateAIJ(comm, n_rows, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, longest, NULL, longest, NULL, S));
  PetscCall(MatGetOwnershipRange(*S, &first, NULL));
  for (PetscInt t = 0, end; t < terms->n; t = end) {
    const OperatorsTerm *term = &terms->term[t];
    Mat                  R;

    end = TakesPart(term, p) ? BlockEnd(terms, t) : t + 1;
    if (!TakesPart(term, p)) continue;
    PetscCall(RightCreate(terms, p, t, end, &R));
    PetscCall(RowsCopy(right ? 1 : OperatorsTermCoefficient(term, p), right ? R : term->left, first, *S));
    PetscCall(MatGetLocalSize(term->left, &n, NULL));
    PetscCall(MatDestroy(&R));
    first += n;
  }
  PetscCall(MatAssemblyBegin(*S, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*S, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* NULL, NULL where there is no unsymmetric stiffness, or some of it has no factors: then K is factored as it is. */
PetscErrorCode TermsFormFactors(const Terms *terms, const PetscReal p[], Mat *left, Mat *right)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  *left = *right = NULL;
  for (PetscInt t = 0; t < terms->n; t++) {
    const OperatorsTerm *term = &terms->term[t];

    if (!term->frictional || term->kind == OPERATORS_DAMPING || OperatorsTermCoefficient(term, p) == 0) continue;
    if (!term->left || term->kind != OPERATORS_STIFFNESS) PetscFunctionReturn(0);
    n++;
  }
  if (!n) PetscFunctionReturn(0);
  PetscCall(FactorsStack(terms, p, PETSC_FALSE, left));
  PetscCall(FactorsStack(terms, p, PETSC_TRUE, right));
  PetscFunctionReturn(0);
}

/* Takes away what can be made again from what stays: K_even from K by subtraction of friction, or both from the
   half that is factored and the mass. */
PetscErrorCode PencilReleaseSymmetric(Pencil pencil, Mat half, PetscReal shift)
{
  TermsSum *const even = &pencil->sum[PencilEven(pencil)], *const whole = &pencil->sum[PENCIL_K];
  const PetscBool friction = pencil->has_factors && pencil->factor[0] ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!pencil->released || !(half || (friction && whole->current))) PetscFunctionReturn(0);
  if (half) PetscCall(PetscObjectReference((PetscObject)half));
  PetscCall(MatDestroy(&pencil->half));
  pencil->half       = half;
  pencil->half_shift = shift;
  PetscCall(TermsSumDestroy(even));
  if (half && friction) PetscCall(TermsSumDestroy(whole));
  PetscFunctionReturn(0);
}

/* sum, which is empty, = A + c left' right */
static PetscErrorCode AddFriction(Pencil pencil, PetscReal c, Mat A, TermsSum *sum)
{
  OperatorsTerm both[2] = {{.A = A}, {.A = NULL}};

  PetscFunctionBeginUser;
  PetscCall(MatTransposeMatMult(pencil->factor[0], pencil->factor[1], MAT_INITIAL_MATRIX, PETSC_DEFAULT, &both[1].A));
  PetscCall(TermsSumAdd(&(Terms){2, both}, (PetscReal[]){1, c}, sum));
  PetscCall(PetscFree(sum->has)); /* of other terms than the pencil's */
  PetscCall(MatDestroy(&both[1].A));
  PetscFunctionReturn(0);
}

/* sum = half + shift M; half holds K_even - shift M (upper half) as it was factored, so that it is K_even but for
   rounding of |shift| M. */
static PetscErrorCode AddMass(Pencil pencil, TermsSum *sum)
{
  const Mat M = pencil->sum[pencil->Zr ? PROJECTED_M : SUM_M].A;
  PetscBool added;

  PetscFunctionBeginUser;
  PetscCall(MatConvert(pencil->half, MATSEQAIJ, MAT_INITIAL_MATRIX, &sum->A));
  PetscCall(MatDestroy(&pencil->half));
  PetscCall(MatrixAdd(pencil->half_shift, M, sum->A, &added));
  PetscCheck(added, pencil->comm, PETSC_ERR_PLIB, "the mass is not in the pattern of what was factored");
  PetscFunctionReturn(0);
}

PetscErrorCode PencilRestore(Pencil pencil, PencilSum which)
{
  TermsSum *const even = &pencil->sum[PencilEven(pencil)], *const whole = &pencil->sum[PENCIL_K];

  PetscFunctionBeginUser;
  if (!even->current) {
    if (pencil->half)
      PetscCall(AddMass(pencil, even));
    else
      PetscCall(AddFriction(pencil, -1, whole->A, even));
  }
  even->current = PETSC_TRUE;
  if (which != PENCIL_K) PetscFunctionReturn(0);
  PetscCall(AddFriction(pencil, 1, even->A, whole));
  whole->current = PETSC_TRUE;
  PetscFunctionReturn(0);
}
