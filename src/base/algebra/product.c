/*
   Products of sparse matrices with many vectors at once, Y = A X. PETSc's MatMatMult() takes the vectors column by
   column, four at a time, and fetches an entry of each from another place in memory; here up to BLOCK_WIDTH of them lie
   side by side, so that one entry of A meets as many neighbours. The three rows of a node go together, STRIP columns at
   a time: their entries are still in the first cache when the next STRIP columns follow. The sums of a row are in the
   order of MatMult().
*/
#include "base/algebra/versions.h"
#include "product.h"

#define BLOCK_WIDTH 32 /* columns side by side; or STRIP or LANES, where there are no more */
#define STRIP       16
#define LANES       8
#define FEW_ENTRIES 1  /* a column of A has on average: fewer are multiplied as they stand */
#define PACK_ROWS   48 /* rows whose products are unpacked together */
#define PACK_STEP   8

#define ROWS_TOGETHER 3 /* of a node, so that no sum waits for the one before */

typedef PetscScalar BlockLanes __attribute__((vector_size(64), aligned(8), may_alias));

/* Columns 0 .. m - 1 of x side by side, [n][width], zeros where there are fewer; of PACK_STEP rows, which are a line of
   the cache in each column, one row after the other */
INTO_VERSIONS void ColumnsPackWidth(PetscInt n, PetscInt m, PetscInt width, PetscInt stride, const PetscScalar x[],
                                    PetscScalar packed[])
{
  for (PetscInt first = 0; first < n; first += PACK_STEP) {
    const PetscInt last = PetscMin(n, first + PACK_STEP);

    for (PetscInt i = first; i < last; i++) {
      for (PetscInt j = 0; j < m; j++) packed[i * width + j] = x[(size_t)j * stride + i];
      for (PetscInt j = m; j < width; j++) packed[i * width + j] = 0;
    }
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

/* Some rows that are as long as one another and, where alike, have the same columns */
typedef struct {
  PetscInt  first, n;
  PetscBool alike;
} RowGroup;

/* Products of a group with `strip` of `width` columns side by side: products [group.n][width]. All sums of a group,
   3 rows x 2 x 8 numbers, stay in registers. */
INTO_VERSIONS void StripTimes(const Rows *rows, RowGroup group, PetscInt width, PetscInt strip,
                              const PetscScalar packed[], PetscScalar products[])
{
  const PetscInt     begin = rows->ia[group.first], n = rows->ia[group.first + 1] - begin, parts = strip / LANES;
  const PetscInt    *ja = &rows->ja[begin];
  const PetscScalar *a  = &rows->a[begin];
  BlockLanes         sum[ROWS_TOGETHER][STRIP / LANES];

  for (PetscInt c = 0; c < group.n; c++)
    for (PetscInt h = 0; h < parts; h++) sum[c][h] = (BlockLanes){0};
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt c = 0; c < group.n; c++) {
      const BlockLanes *x = (const BlockLanes *)&packed[(size_t)ja[(group.alike ? 0 : c * n) + k] * width];

      for (PetscInt h = 0; h < parts; h++) sum[c][h] += a[c * n + k] * x[h];
    }
  for (PetscInt c = 0; c < group.n; c++)
    for (PetscInt h = 0; h < parts; h++) ((BlockLanes *)&products[c * width])[h] = sum[c][h];
}

/* The same of all columns */
INTO_VERSIONS void GroupTimes(const Rows *rows, RowGroup group, PetscInt width, const PetscScalar packed[],
                              PetscScalar products[])
{
  const PetscInt strip = width < STRIP ? width : STRIP;

  for (PetscInt first = 0; first < width; first += strip)
    StripTimes(rows, group, width, strip, &packed[first], &products[first]);
}

/* Whether rows i .. i + ROWS_TOGETHER - 1 are as long as one another; alike: they have the same columns, as those of a
   node have in a stiffness */
INTO_VERSIONS PetscBool RowsMatch(const Rows *rows, PetscInt i, PetscBool *alike)
{
  const PetscInt *ia = rows->ia, *ja = rows->ja;

  *alike = PETSC_FALSE;
  if (i + ROWS_TOGETHER > rows->n || !ja) return PETSC_FALSE;
  for (PetscInt c = 1; c < ROWS_TOGETHER; c++)
    if (ia[i + c + 1] - ia[i + c] != ia[i + 1] - ia[i]) return PETSC_FALSE;
  *alike = PETSC_TRUE;
  for (PetscInt c = 1; c < ROWS_TOGETHER; c++)
    if (memcmp(&ja[ia[i]], &ja[ia[i + c]], (size_t)(ia[i + 1] - ia[i]) * sizeof(*ja))) *alike = PETSC_FALSE;
  return PETSC_TRUE;
}

/* Rows first, first + 1, ... to last - 1 or a few more, how many of them: products [][width]. The three calls are
   alike but for constants, which the compiler makes three loops of. */
INTO_VERSIONS PetscInt RowsSome(const Rows *rows, PetscInt first, PetscInt last, PetscInt width,
                                const PetscScalar packed[], PetscScalar products[])
{
  PetscInt i = first;

  for (PetscInt count; i < last; i += count) {
    PetscScalar *const at = &products[(i - first) * width];
    PetscBool          alike;
    const PetscBool    together = RowsMatch(rows, i, &alike);

    count = together ? ROWS_TOGETHER : 1;
    if (!together)
      GroupTimes(rows, (RowGroup){i, 1, PETSC_TRUE}, width, packed, at);
    else if (alike)
      GroupTimes(rows, (RowGroup){i, ROWS_TOGETHER, PETSC_TRUE}, width, packed, at);
    else
      GroupTimes(rows, (RowGroup){i, ROWS_TOGETHER, PETSC_FALSE}, width, packed, at);
  }
  return i - first;
}

/* All rows */
INTO_VERSIONS void RowsPass(const Rows *rows, PetscInt width, const PackedColumns *columns)
{
  PetscScalar products[(PACK_ROWS + ROWS_TOGETHER) * BLOCK_WIDTH];

  for (PetscInt first = 0, n; first < rows->n; first += n) {
    n = RowsSome(rows, first, PetscMin(first + PACK_ROWS, rows->n), width, columns->packed, products);
    for (PetscInt j = 0; j < columns->m; j++)
      for (PetscInt i = 0; i < n; i++) columns->y[(size_t)j * columns->stride + first + i] = products[i * width + j];
  }
}

static VERSIONS void RowsMultiply(const Rows *rows, PetscInt width, const PackedColumns *columns)
{
  if (width == LANES)
    RowsPass(rows, LANES, columns);
  else if (width == STRIP)
    RowsPass(rows, STRIP, columns);
  else
    RowsPass(rows, BLOCK_WIDTH, columns);
}

/* The packed columns of any width */
static VERSIONS void ColumnsPack(PetscInt n, PetscInt m, PetscInt width, PetscInt stride, const PetscScalar x[],
                                 PetscScalar packed[])
{
  if (width == LANES)
    ColumnsPackWidth(n, m, LANES, stride, x, packed);
  else if (width == STRIP)
    ColumnsPackWidth(n, m, STRIP, stride, x, packed);
  else
    ColumnsPackWidth(n, m, BLOCK_WIDTH, stride, x, packed);
}

/* Columns first .. first + m - 1 of Y = A X, which are packed */
static PetscErrorCode ApplyRows(Mat A, PetscInt first, PetscInt m, PetscInt width, const PetscScalar packed[], Mat Y)
{
  PetscInt     ldy;
  Rows         rows;
  PetscScalar *y;
  PetscBool    done;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows.n, &rows.ia, &rows.ja, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no rows of a sequential sparse matrix");
  PetscCall(MatSeqAIJGetArrayRead(A, &rows.a));
  PetscCall(MatDenseGetArray(Y, &y));
  RowsMultiply(&rows, width, &(PackedColumns){packed, m, ldy, &y[(size_t)first * ldy]});
  PetscCall(PetscLogFlops(2. * rows.ia[rows.n] * m));
  PetscCall(MatDenseRestoreArray(Y, &y));
  PetscCall(MatSeqAIJRestoreArrayRead(A, &rows.a));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows.n, &rows.ia, &rows.ja, &done));
  PetscFunctionReturn(0);
}

/* A with few entries: packing the columns would cost more than the products. Y [m][ldy] */
static PetscErrorCode ApplyFew(Mat A, PetscInt m, PetscInt ldx, const PetscScalar x[], Mat Y)
{
  PetscInt           ldy, n;
  const PetscInt    *ia, *ja;
  const PetscScalar *a;
  PetscScalar       *y;
  PetscBool          done;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &ia, &ja, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no rows of a sequential sparse matrix");
  PetscCall(MatSeqAIJGetArrayRead(A, &a));
  PetscCall(MatDenseGetArray(Y, &y));
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < n; i++) {
      PetscScalar sum = 0;

      for (PetscInt k = ia[i]; k < ia[i + 1]; k++) sum += a[k] * x[(size_t)j * ldx + ja[k]];
      y[(size_t)j * ldy + i] = sum;
    }
  PetscCall(PetscLogFlops(2. * ia[n] * m));
  PetscCall(MatDenseRestoreArray(Y, &y));
  PetscCall(MatSeqAIJRestoreArrayRead(A, &a));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &ia, &ja, &done));
  PetscFunctionReturn(0);
}

/* Whether it has */
static PetscErrorCode EntriesAreFew(Mat A, PetscBool *few)
{
  PetscInt n_columns;
  MatInfo  info;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, NULL, &n_columns));
  PetscCall(MatGetInfo(A, MAT_LOCAL, &info));
  *few = info.nz_used < FEW_ENTRIES * (PetscReal)n_columns ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* On one rank: columns are packed once for all n matrices. */
static PetscErrorCode ApplySequential(PetscInt n, const Mat A[], Mat X, const Mat Y[])
{
  PetscInt           n_rows, n_columns, ldx;
  const PetscScalar *x;
  PetscScalar       *packed;
  PetscBool          few = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, &n_rows, &n_columns));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetArrayRead(X, &x));
  if (n == 1) PetscCall(EntriesAreFew(A[0], &few));
  if (few) PetscCall(ApplyFew(A[0], n_columns, ldx, x, Y[0]));
  PetscCall(PetscMalloc1(few ? 0 : (size_t)n_rows * BLOCK_WIDTH, &packed));
  for (PetscInt first = 0; first < n_columns && !few; first += BLOCK_WIDTH) {
    const PetscInt m     = PetscMin(BLOCK_WIDTH, n_columns - first);
    const PetscInt width = m <= LANES ? LANES : m <= STRIP ? STRIP : BLOCK_WIDTH;

    ColumnsPack(n_rows, m, width, ldx, &x[(size_t)first * ldx], packed);
    for (PetscInt i = 0; i < n; i++) PetscCall(ApplyRows(A[i], first, m, width, packed, Y[i]));
  }
  PetscCall(PetscFree(packed));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscFunctionReturn(0);
}

/* Columns of a sparse A as a dense X, by walking through all rows of this rank: transposed storage would be needed
   to find a column. */
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

/* Y[i] = A[i] X. On several ranks by MatMatMult(), which brings the rows of X that others own. */
PetscErrorCode BlockMultiplyEach(PetscInt n, const Mat A[], Mat X, const Mat Y[])
{
  PetscBool sequential = PETSC_TRUE, dense;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)X, MATSEQDENSE, &dense));
  for (PetscInt i = 0; i < n && sequential; i++)
    PetscCall(PetscObjectTypeCompare((PetscObject)A[i], MATSEQAIJ, &sequential));
  if (sequential && dense) {
    PetscCall(ApplySequential(n, A, X, Y));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < n; i++) {
    Mat AX;

    PetscCall(MatMatMult(A[i], X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
    PetscCall(MatCopy(AX, Y[i], SAME_NONZERO_PATTERN));
    PetscCall(MatDestroy(&AX));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BlockMultiply(Mat A, Mat X, Mat Y)
{
  PetscFunctionBeginUser;
  PetscCall(BlockMultiplyEach(1, &A, X, &Y));
  PetscFunctionReturn(0);
}

/* A dense matrix on columns first .. first + n - 1 of Y, whose array is y */
static PetscErrorCode ColumnsView(Mat Y, PetscScalar y[], PetscInt first, PetscInt n, Mat *view)
{
  PetscInt n_local, n_rows, stride;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(Y, &n_local, NULL));
  PetscCall(MatGetSize(Y, &n_rows, NULL));
  PetscCall(MatDenseGetLDA(Y, &stride));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)Y), n_local, PETSC_DECIDE, n_rows, n,
                           y + (size_t)first * stride, view));
  PetscCall(MatDenseSetLDA(*view, stride));
  PetscFunctionReturn(0);
}

/* Y = [A_1 X, A_2 X, ...] in one block, whose columns are as many as n times those of X; views write into its
   array. */
PetscErrorCode BlockMultiplySideBySide(PetscInt n, const Mat A[], BV X, BV Y)
{
  PetscInt     m;
  PetscScalar *array;
  Mat          x, y, *view;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(X, &x));
  PetscCall(BVGetMat(Y, &y));
  PetscCall(MatGetSize(x, NULL, &m));
  PetscCall(MatDenseGetArray(y, &array));
  PetscCall(PetscMalloc1(n, &view));
  for (PetscInt i = 0; i < n; i++) PetscCall(ColumnsView(y, array, i * m, m, &view[i]));
  PetscCall(BlockMultiplyEach(n, A, x, view));
  for (PetscInt i = 0; i < n; i++) PetscCall(MatDestroy(&view[i]));
  PetscCall(PetscFree(view));
  PetscCall(MatDenseRestoreArray(y, &array));
  PetscCall(BVRestoreMat(Y, &y));
  PetscCall(BVRestoreMat(X, &x));
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
