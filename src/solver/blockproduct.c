/*
   Products of a sparse matrix with many vectors at once, Y = A X. PETSc's MatMatMult() takes the vectors column by
   column, four at a time, and fetches an entry of each from another place in memory; here BLOCK_WIDTH of them, or
   BLOCK_NARROW where there are no more, lie side by side, so that one entry of A meets as many neighbours, and the three
   rows of a node go together. The sums of a row are in the order of MatMult().
*/
#include "base/versions.h"
#include "orthonormal.h"

#define BLOCK_WIDTH  16
#define BLOCK_NARROW 8
#define PACK_ROWS    64
#define LANES        8

#define ROWS_TOGETHER 3 /* of a node, so that no sum waits for the one before */

typedef PetscScalar BlockLanes __attribute__((vector_size(64), aligned(8), may_alias));

/* Columns 0 .. m - 1 of x side by side, [n][width], zeros where there are fewer; a few rows at a time, whose packed
   columns stay in the cache */
static void ColumnsPack(PetscInt n, PetscInt m, PetscInt width, PetscInt stride, const PetscScalar x[],
                        PetscScalar packed[])
{
  for (PetscInt first = 0; first < n; first += PACK_ROWS) {
    const PetscInt last = PetscMin(n, first + PACK_ROWS);

    for (PetscInt j = 0; j < width; j++)
      for (PetscInt i = first; i < last; i++) packed[i * width + j] = j < m ? x[j * stride + i] : 0;
  }
}

/* Compressed rows */
typedef struct {
  PetscInt           n;
  const PetscInt    *ia, *ja;
  const PetscScalar *a;
} Rows;

/* Columns side by side, and the m of them, stride apart, that the products of rows are put into */
typedef struct {
  const PetscScalar *packed;
  PetscInt           m, stride;
  PetscScalar       *y;
} PackedColumns;

/* Rows i .. i + count - 1, which are as long and, where alike, have the same columns, times `width` columns */
INTO_VERSIONS void RowsTimes(const Rows *rows, PetscInt i, PetscInt count, PetscBool alike, PetscInt width,
                             const PackedColumns *columns)
{
  const PetscInt     n = rows->ia[i + 1] - rows->ia[i], *ja = &rows->ja[rows->ia[i]], parts = width / LANES;
  const PetscScalar *a = &rows->a[rows->ia[i]];
  BlockLanes         sum[ROWS_TOGETHER][BLOCK_WIDTH / LANES];

  for (PetscInt c = 0; c < count; c++)
    for (PetscInt h = 0; h < parts; h++) sum[c][h] = (BlockLanes){0};
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt c = 0; c < count; c++) {
      const BlockLanes *x = (const BlockLanes *)&columns->packed[ja[(alike ? 0 : c * n) + k] * width];

      for (PetscInt h = 0; h < parts; h++) sum[c][h] += a[c * n + k] * x[h];
    }
  for (PetscInt c = 0; c < count; c++)
    for (PetscInt j = 0; j < columns->m; j++) columns->y[j * columns->stride + i + c] = sum[c][j / LANES][j % LANES];
}

/* Whether rows i .. i + ROWS_TOGETHER - 1 are as long as one another; alike: they have the same columns, as those of a node
   have in a stiffness */
INTO_VERSIONS PetscBool RowsMatch(const Rows *rows, PetscInt i, PetscBool *alike)
{
  const PetscInt *ia = rows->ia, *ja = rows->ja;

  *alike = PETSC_FALSE;
  if (i + ROWS_TOGETHER > rows->n) return PETSC_FALSE;
  for (PetscInt c = 1; c < ROWS_TOGETHER; c++)
    if (ia[i + c + 1] - ia[i + c] != ia[i + 1] - ia[i]) return PETSC_FALSE;
  *alike = PETSC_TRUE;
  for (PetscInt c = 1; c < ROWS_TOGETHER; c++)
    if (memcmp(&ja[ia[i]], &ja[ia[i + c]], (size_t)(ia[i + 1] - ia[i]) * sizeof(*ja))) *alike = PETSC_FALSE;
  return PETSC_TRUE;
}

/* All rows */
INTO_VERSIONS void RowsPass(const Rows *rows, PetscInt width, const PackedColumns *columns)
{
  for (PetscInt i = 0, count; i < rows->n; i += count) {
    PetscBool       alike;
    const PetscBool together = RowsMatch(rows, i, &alike);

    count = together ? ROWS_TOGETHER : 1;
    if (!together)
      RowsTimes(rows, i, 1, PETSC_TRUE, width, columns);
    else if (alike)
      RowsTimes(rows, i, ROWS_TOGETHER, PETSC_TRUE, width, columns);
    else
      RowsTimes(rows, i, ROWS_TOGETHER, PETSC_FALSE, width, columns);
  }
}

static VERSIONS void RowsMultiply(const Rows *rows, PetscInt width, const PackedColumns *columns)
{
  if (width == BLOCK_NARROW)
    RowsPass(rows, BLOCK_NARROW, columns);
  else
    RowsPass(rows, BLOCK_WIDTH, columns);
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
    const PetscInt m     = PetscMin(BLOCK_WIDTH, n_columns - first);
    const PetscInt width = m <= BLOCK_NARROW ? BLOCK_NARROW : BLOCK_WIDTH;

    ColumnsPack(n_rows, m, width, ldx, &x[first * ldx], packed);
    RowsMultiply(&rows, width, &(PackedColumns){packed, m, ldy, &y[first * ldy]});
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
