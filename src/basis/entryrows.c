/*
   Products of many vectors over the rows in which a matrix has entries. A brake has a disc with nearly all unknowns,
   and a pad, springs, and pairs with a hundredth of them: V' A W of those costs a hundredth of the disc's.

      H = X' D Y = sum_k x_k' d_k y_k over these rows k, D a diagonal or the identity
*/
#include "entryrows.h"
#include <petscblaslapack.h>

#define ROWS_FEW  0.25 /* of all rows, up to which they are few */
#define ROWS_MOST 0.5  /* of the local rows: from here on nothing is gained by leaving others out */

/* Whether a row has an entry that is not zero */
static PetscErrorCode RowIsThere(Mat A, PetscInt row, PetscBool *there)
{
  const PetscScalar *value;
  PetscInt           n;

  PetscFunctionBeginUser;
  *there = PETSC_FALSE;
  PetscCall(MatGetRow(A, row, &n, NULL, &value));
  for (PetscInt k = 0; k < n && !*there; k++) *there = value[k] != 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(MatRestoreRow(A, row, &n, NULL, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode EntryRowsCreate(Mat A, EntryRows *rows)
{
  PetscInt first, last, n_all, n_rows;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  PetscCall(MatGetSize(A, &n_rows, NULL));
  PetscCall(PetscMalloc1(last - first, &rows->row));
  rows->n = 0;
  for (PetscInt i = first; i < last; i++) {
    PetscBool there;

    PetscCall(RowIsThere(A, i, &there));
    if (there) rows->row[rows->n++] = i - first;
  }
  PetscCallMPI(MPI_Allreduce(&rows->n, &n_all, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)A)));
  rows->all = (PetscReal)rows->n > ROWS_MOST * (PetscReal)(last - first) ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < last - first && rows->all; i++) rows->row[i] = i;
  if (rows->all) rows->n = last - first;
  rows->few = (PetscReal)n_all <= ROWS_FEW * (PetscReal)n_rows ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode EntryRowsDestroy(EntryRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(rows->row));
  rows->n = 0;
  PetscFunctionReturn(0);
}

/* Rows of the columns of a matrix, their own or a copy of some */
typedef struct {
  Mat                columns;
  const PetscScalar *all, *a; /* [n_columns][stride] */
  PetscScalar       *copy;
  PetscInt           n_columns;
  PetscBLASInt       stride;
} RowsView;

/* The rows of the active columns of X, times weights w [local rows] unless that is NULL */
static PetscErrorCode RowsViewCreate(const EntryRows *rows, BV X, const PetscScalar w[], RowsView *v)
{
  const PetscInt n = rows->n;
  PetscInt       stride;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(X, &v->columns));
  PetscCall(MatGetSize(v->columns, NULL, &v->n_columns));
  PetscCall(MatDenseGetLDA(v->columns, &stride));
  PetscCall(MatDenseGetArrayRead(v->columns, &v->all));
  v->copy = NULL;
  v->a    = v->all;
  PetscCall(PetscBLASIntCast(PetscMax(1, rows->all && !w ? stride : n), &v->stride));
  if (rows->all && !w) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * v->n_columns, &v->copy));
  v->a = v->copy;
  for (PetscInt j = 0; j < v->n_columns; j++)
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt i = rows->row[k];

      v->copy[j * n + k] = w ? w[i] * v->all[j * stride + i] : v->all[j * stride + i];
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode RowsViewDestroy(BV X, RowsView *v)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(v->copy));
  PetscCall(MatDenseRestoreArrayRead(v->columns, &v->all));
  PetscCall(BVRestoreMat(X, &v->columns));
  PetscFunctionReturn(0);
}

/* H [columns of X][columns of Y] of all ranks, by one dgemm of each rank's rows: 2 n mx my flops */
PetscErrorCode EntryRowsProducts(const EntryRows *rows, BV X, Vec diagonal, BV Y, Mat *H)
{
  const PetscScalar  one = 1, zero = 0;
  const PetscScalar *w = NULL;
  PetscScalar       *h;
  PetscBLASInt       n, mx, my;
  PetscMPIInt        count;
  RowsView           x, y;

  PetscFunctionBeginUser;
  if (diagonal) PetscCall(VecGetArrayRead(diagonal, &w));
  PetscCall(RowsViewCreate(rows, X, NULL, &x));
  PetscCall(RowsViewCreate(rows, Y, w, &y));
  if (diagonal) PetscCall(VecRestoreArrayRead(diagonal, &w));
  PetscCall(PetscBLASIntCast(rows->n, &n));
  PetscCall(PetscBLASIntCast(x.n_columns, &mx));
  PetscCall(PetscBLASIntCast(y.n_columns, &my));
  PetscCall(PetscMPIIntCast(x.n_columns * y.n_columns, &count));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, mx, my, NULL, H));
  PetscCall(MatDenseGetArray(*H, &h));
  if (count)
    PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &mx, &my, &n, &one, x.a, &x.stride, y.a, &y.stride, &zero, h, &mx));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, h, count, MPIU_SCALAR, MPIU_SUM, PetscObjectComm((PetscObject)X)));
  PetscCall(MatDenseRestoreArray(*H, &h));
  PetscCall(PetscLogFlops(2. * n * count));
  PetscCall(RowsViewDestroy(Y, &y));
  PetscCall(RowsViewDestroy(X, &x));
  PetscFunctionReturn(0);
}
