/*
   Products of a sparse matrix with many vectors at once, Y = A X. PETSc's MatMatMult() takes the vectors column by
   column, four at a time, and fetches an entry of each from another place in memory; here BLOCK_WIDTH of them lie side by
   side, so that one entry of A meets as many neighbours. The sums of a row are in the order of MatMult().
*/
#include "base/versions.h"
#include "orthonormal.h"

#define BLOCK_WIDTH 16

/* Columns first .. first + m - 1 of x side by side, [n][BLOCK_WIDTH], zeros where there are fewer */
static void ColumnsPack(PetscInt n, PetscInt m, PetscInt stride, const PetscScalar x[], PetscScalar packed[])
{
  for (PetscInt j = 0; j < BLOCK_WIDTH; j++)
    for (PetscInt i = 0; i < n; i++) packed[i * BLOCK_WIDTH + j] = j < m ? x[j * stride + i] : 0;
}

/* Compressed rows */
typedef struct {
  PetscInt           n;
  const PetscInt    *ia, *ja;
  const PetscScalar *a;
} Rows;

/* Rows times packed columns; y [m] columns, stride apart */
static VERSIONS void RowsMultiply(const Rows *rows, const PetscScalar packed[], PetscInt m, PetscInt stride,
                                  PetscScalar y[])
{
  for (PetscInt i = 0; i < rows->n; i++) {
    PetscScalar sum[BLOCK_WIDTH] = {0};

    for (PetscInt k = rows->ia[i]; k < rows->ia[i + 1]; k++) {
      const PetscScalar *x = &packed[rows->ja[k] * BLOCK_WIDTH], value = rows->a[k];

      for (PetscInt j = 0; j < BLOCK_WIDTH; j++) sum[j] += value * x[j];
    }
    for (PetscInt j = 0; j < m; j++) y[j * stride + i] = sum[j];
  }
}

/* On one rank */
static PetscErrorCode ApplySequential(Mat A, Mat X, Mat Y)
{
  PetscInt           n_rows, n_columns, ldx, ldy;
  const PetscScalar *x;
  Rows               rows;
  PetscScalar       *y, *packed;
  PetscBool          done;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, &n_rows, &n_columns));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows.n, &rows.ia, &rows.ja, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no rows of a sequential sparse matrix");
  PetscCall(MatSeqAIJGetArrayRead(A, &rows.a));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArray(Y, &y));
  PetscCall(PetscMalloc1(n_rows * BLOCK_WIDTH, &packed));
  for (PetscInt first = 0; first < n_columns; first += BLOCK_WIDTH) {
    const PetscInt m = PetscMin(BLOCK_WIDTH, n_columns - first);

    ColumnsPack(n_rows, m, ldx, &x[first * ldx], packed);
    RowsMultiply(&rows, packed, m, ldy, &y[first * ldy]);
  }
  PetscCall(PetscFree(packed));
  PetscCall(PetscLogFlops(2. * rows.ia[rows.n] * n_columns));
  PetscCall(MatDenseRestoreArray(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCall(MatSeqAIJRestoreArrayRead(A, &rows.a));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows.n, &rows.ia, &rows.ja, &done));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockTakeColumns(Mat A, PetscInt first, Mat X)
{
  PetscInt     begin, end, stride, n;
  PetscScalar *x;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(MatGetOwnershipRange(A, &begin, &end));
  PetscCall(MatZeroEntries(X));
  PetscCall(MatDenseGetLDA(X, &stride));
  PetscCall(MatDenseGetArray(X, &x));
  for (PetscInt i = begin; i < end; i++) {
    const PetscInt    *column;
    const PetscScalar *v;
    PetscInt           n_row;

    PetscCall(MatGetRow(A, i, &n_row, &column, &v));
    for (PetscInt k = 0; k < n_row; k++)
      if (column[k] >= first && column[k] < first + n) x[(column[k] - first) * stride + i - begin] = v[k];
    PetscCall(MatRestoreRow(A, i, &n_row, &column, &v));
  }
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockMultiply(Mat A, Mat X, Mat Y)
{
  PetscBool sequential, dense;
  Mat       AX;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSEQAIJ, &sequential));
  PetscCall(PetscObjectTypeCompare((PetscObject)X, MATSEQDENSE, &dense));
  if (sequential && dense) {
    PetscCall(ApplySequential(A, X, Y));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
  PetscCall(MatCopy(AX, Y, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&AX));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockMultiplyVectors(Mat A, BV X, BV Y)
{
  PetscBool sequential;
  Mat       x, y;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATSEQAIJ, &sequential));
  if (!sequential) {
    PetscCall(BVMatMult(X, A, Y));
    PetscFunctionReturn(0);
  }
  PetscCall(BVGetMat(X, &x));
  PetscCall(BVGetMat(Y, &y));
  PetscCall(BlockMultiply(A, x, y));
  PetscCall(BVRestoreMat(Y, &y));
  PetscCall(BVRestoreMat(X, &x));
  PetscFunctionReturn(0);
}
