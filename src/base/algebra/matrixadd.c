/*
   A += c X of two sparse matrices row by row, see matrixadd.h. Columns of a row are in order in both, so that one walk
   along the row of A meets those of X. PETSc's MatSetValues() and MatAXPY() with SUBSET_NONZERO_PATTERN search each
   entry for itself.
*/
#include "matrixadd.h"
#include <petsc/private/petscimpl.h> /* PetscObjectStateIncrease() */

/* Rows of a sequential matrix, whole or from their diagonal on; column j stands for number[j] where numbers are given,
   which grow with j */
typedef struct {
  Mat             A;
  PetscBool       upper;
  PetscInt        n;
  const PetscInt *ia, *ja, *number;
} AddRows;

static PetscErrorCode AddRowsGet(Mat A, const PetscInt number[], AddRows *rows)
{
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSEQSBAIJ, &rows->upper));
  rows->A      = A;
  rows->number = number;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->ia, &rows->ja, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no rows of a sequential sparse matrix");
  PetscFunctionReturn(0);
}

static PetscErrorCode AddRowsRestore(AddRows *rows)
{
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(MatRestoreRowIJ(rows->A, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->ia, &rows->ja, &done));
  PetscFunctionReturn(0);
}

/* Whether row i has the same columns in both, as most rows of the stiffness of a part have in a sum */
static PetscBool RowsAreAlike(PetscInt i, const AddRows *X, const AddRows *A)
{
  const PetscInt n = X->ia[i + 1] - X->ia[i];

  if (X->number || A->number || A->ia[i + 1] - A->ia[i] != n) return PETSC_FALSE;
  if (!n) return PETSC_TRUE; /* a matrix without entries has no array of columns */
  return memcmp(&X->ja[X->ia[i]], &A->ja[A->ia[i]], (size_t)n * sizeof(*X->ja)) ? PETSC_FALSE : PETSC_TRUE;
}

/* a += c x of row i; with a NULL nothing is summed. Whether all entries of x have their place. */
static PetscBool RowAdd(PetscInt i, PetscReal c, const AddRows *X, const PetscScalar x[], const AddRows *A,
                        PetscScalar a[])
{
  PetscInt k = A->ia[i], j = X->ia[i];

  if (RowsAreAlike(i, X, A)) {
    for (PetscInt h = 0; a && h < X->ia[i + 1] - j; h++) a[k + h] += c * x[j + h];
    return PETSC_TRUE;
  }

  while (A->upper && j < X->ia[i + 1] && X->ja[j] < i) j++;
  for (; j < X->ia[i + 1]; j++, k++) {
    const PetscInt column = X->number ? X->number[X->ja[j]] : X->ja[j];

    while (k < A->ia[i + 1] && (A->number ? A->number[A->ja[k]] : A->ja[k]) < column) k++;
    if (k == A->ia[i + 1] || (A->number ? A->number[A->ja[k]] : A->ja[k]) != column) return PETSC_FALSE;
    if (a) a[k] += c * x[j];
  }
  return PETSC_TRUE;
}

/* A += c X of sequential matrices whose entries have their place, or with add false whether they have */
static PetscErrorCode SequentialAdd(PetscBool add, PetscReal c, AddRows *X, AddRows *A, PetscBool *fits)
{
  const PetscScalar *x = NULL;
  PetscScalar       *a = NULL;

  PetscFunctionBeginUser;
  if (add) PetscCall(MatSeqAIJGetArrayRead(X->A, &x));
  if (add) {
    if (A->upper)
      PetscCall(MatSeqSBAIJGetArray(A->A, &a));
    else
      PetscCall(MatSeqAIJGetArray(A->A, &a));
  }
  for (PetscInt i = 0; i < A->n && *fits; i++) *fits = RowAdd(i, c, X, x, A, a);
  if (add) {
    if (A->upper)
      PetscCall(MatSeqSBAIJRestoreArray(A->A, &a));
    else
      PetscCall(MatSeqAIJRestoreArray(A->A, &a));
  }
  if (add) PetscCall(MatSeqAIJRestoreArrayRead(X->A, &x));
  PetscFunctionReturn(0);
}

/* The sequential parts of a matrix: itself, or the columns of this rank and the others. n is 0 for another type. */
static PetscErrorCode AddPartsGet(Mat A, PetscInt *n, AddRows part[2])
{
  const PetscInt *number;
  PetscInt        block;
  PetscBool       sequential, parallel;
  Mat             inside, outside;

  PetscFunctionBeginUser;
  PetscCall(MatGetBlockSize(A, &block));
  PetscCall(
    PetscObjectTypeCompareAny((PetscObject)A, &sequential, MATSEQAIJ, block == 1 ? MATSEQSBAIJ : MATSEQAIJ, ""));
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATMPIAIJ, &parallel));
  *n = sequential ? 1 : parallel ? 2 : 0;
  if (sequential) PetscCall(AddRowsGet(A, NULL, &part[0]));
  if (!parallel) PetscFunctionReturn(0);
  PetscCall(MatMPIAIJGetSeqAIJ(A, &inside, &outside, &number));
  PetscCall(AddRowsGet(inside, NULL, &part[0]));
  PetscCall(AddRowsGet(outside, number, &part[1]));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixAdd(PetscReal c, Mat X, Mat A, PetscBool *added)
{
  PetscInt  n, m;
  AddRows   x[2], a[2];
  PetscBool fits;

  PetscFunctionBeginUser;
  PetscCall(AddPartsGet(X, &n, x));
  PetscCall(AddPartsGet(A, &m, a));
  fits = n && n == m && !x[0].upper ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < n && fits; i++) PetscCall(SequentialAdd(PETSC_FALSE, c, &x[i], &a[i], &fits));
  PetscCallMPI(MPI_Allreduce(&fits, added, 1, MPIU_BOOL, MPI_LAND, PetscObjectComm((PetscObject)A)));
  for (PetscInt i = 0; i < n && *added; i++) PetscCall(SequentialAdd(PETSC_TRUE, c, &x[i], &a[i], &fits));
  if (*added) PetscCall(PetscObjectStateIncrease((PetscObject)A));
  for (PetscInt i = 0; i < n; i++) PetscCall(AddRowsRestore(&x[i]));
  for (PetscInt i = 0; i < m; i++) PetscCall(AddRowsRestore(&a[i]));
  PetscFunctionReturn(0);
}
