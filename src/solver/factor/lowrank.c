/*
   Solutions with A + L' R, A symmetric, by factors of A (M. A. Woodbury, Inverting modified matrices, Princeton 1950).
   With Y = A^-1 R' and C = I + R A^-1 L' = I + (L Y)'

      right        (A + L' R)^-1 b = A^-1 (b - L' C^-1 Y' b)
      transposed   (A + R' L)^-1 b = z - Y C'^-1 L z,   z = A^-1 b

   so that one set of p vectors and one solve serve both. Without Y, C^-1 Y' b = C^-1 R z, and Y c = A^-1 R' c: two
   solves. In friction p is the number of closed pairs, L their slip times k_n mu, R their gap.
*/
#include "lowrank.h"
#include "base/algebra/dense.h"
#include "solver/block/panel.h"

#define LOWRANK_BLOCK 32 /* right-hand sides at once, at most and at least */
#define LOWRANK_ROWS  64 /* the same of sparse ones, of which MUMPS alone has copies: a seventh less time than by 32 */
#define LOWRANK_FEW   8
/* Entries of the right-hand sides that are solved at once, 40 MB: MUMPS and PETSc hold eight copies of a block
   meanwhile. */
#define LOWRANK_ROOM 5000000

/* Dense matrix of m columns with as many local rows as A has local columns (or rows) */
static PetscErrorCode DenseLike(Mat A, PetscBool rows, PetscInt m, Mat *D)
{
  PetscInt n_rows, n_columns;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n_rows, &n_columns));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)A), rows ? n_rows : n_columns, PETSC_DECIDE, PETSC_DETERMINE, m,
                           NULL, D));
  PetscFunctionReturn(0);
}

/* All rows of a distributed p x m matrix D on every rank: c[m][p], by a sum of parts that are zero elsewhere. */
static PetscErrorCode PairsGather(Mat D, PetscInt p, PetscInt m, PetscScalar c[])
{
  const PetscScalar *d;
  PetscInt           first, last, stride;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c, p * m));
  PetscCall(MatGetOwnershipRange(D, &first, &last));
  PetscCall(MatDenseGetLDA(D, &stride));
  PetscCall(MatDenseGetArrayRead(D, &d));
  for (PetscInt j = 0; j < m; j++) PetscCall(PetscArraycpy(&c[j * p + first], &d[j * stride], last - first));
  PetscCall(MatDenseRestoreArrayRead(D, &d));
  PetscCallMPI(
    MPI_Allreduce(MPI_IN_PLACE, c, (PetscMPIInt)(p * m), MPIU_SCALAR, MPIU_SUM, PetscObjectComm((PetscObject)D)));
  PetscFunctionReturn(0);
}

/* c[m][p] = S X for S = L or R */
static PetscErrorCode PairsOf(Mat S, Mat X, PetscInt p, PetscInt m, PetscScalar c[])
{
  Mat D;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(S, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &D));
  PetscCall(PairsGather(D, p, m, c));
  PetscCall(MatDestroy(&D));
  PetscFunctionReturn(0);
}

/* The same of a sequential S, whose few entries go where they belong */
static PetscErrorCode RowsSpread(Mat S, PetscReal scale, PetscInt p, PetscInt m, const PetscScalar c[], Mat X)
{
  PetscScalar *x;
  PetscInt     stride;

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetLDA(X, &stride));
  PetscCall(MatDenseGetArray(X, &x));
  for (PetscInt i = 0; i < p; i++) {
    const PetscInt    *column;
    const PetscScalar *s;
    PetscInt           n;

    PetscCall(MatGetRow(S, i, &n, &column, &s));
    for (PetscInt j = 0; j < m; j++)
      for (PetscInt k = 0; k < n; k++) x[j * stride + column[k]] += scale * s[k] * c[j * p + i];
    PetscCall(MatRestoreRow(S, i, &n, &column, &s));
  }
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscFunctionReturn(0);
}

/* X += scale S' c for S = L or R */
static PetscErrorCode PairsSpread(Mat S, PetscReal scale, PetscInt p, PetscInt m, const PetscScalar c[], Mat X)
{
  PetscScalar *d;
  PetscInt     first, last, stride;
  PetscBool    sequential;
  Mat          D, SD;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)S, MATSEQAIJ, &sequential));
  if (sequential) {
    PetscCall(RowsSpread(S, scale, p, m, c, X));
    PetscFunctionReturn(0);
  }
  PetscCall(DenseLike(S, PETSC_TRUE, m, &D));
  PetscCall(MatGetOwnershipRange(D, &first, &last));
  PetscCall(MatDenseGetLDA(D, &stride));
  PetscCall(MatDenseGetArrayWrite(D, &d));
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = first; i < last; i++) d[j * stride + i - first] = scale * c[j * p + i];
  PetscCall(MatDenseRestoreArrayWrite(D, &d));
  PetscCall(MatTransposeMatMult(S, D, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &SD));
  PetscCall(MatAXPY(X, 1, SD, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&SD));
  PetscCall(MatDestroy(&D));
  PetscFunctionReturn(0);
}

/* c[m][p] = Y' B, or with c given B -= Y c: products of the local rows, by the walk of panel.c, which reads Y once. */
static PetscErrorCode StoredProduct(const LowRank *u, PetscBool subtract, PetscInt m, Mat B, PetscScalar c[])
{
  PetscInt n_local, stride_b, stride_y;
  Panel    y, b;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(u->Y, &n_local, NULL));
  PetscCall(MatDenseGetLDA(B, &stride_b));
  PetscCall(MatDenseGetLDA(u->Y, &stride_y));
  y = (Panel){n_local, u->p, stride_y, NULL};
  b = (Panel){n_local, m, stride_b, NULL};
  PetscCall(MatDenseGetArrayRead(u->Y, (const PetscScalar **)&y.a));
  PetscCall(MatDenseGetArray(B, &b.a));
  if (subtract)
    PetscCall(PanelUpdate(&y, c, NULL, &b, NULL, NULL));
  else
    PetscCall(PanelProduct(&y, &b, c));
  PetscCall(MatDenseRestoreArray(B, &b.a));
  PetscCall(MatDenseRestoreArrayRead(u->Y, (const PetscScalar **)&y.a));
  if (!subtract) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c, (PetscMPIInt)(u->p * m), MPIU_SCALAR, MPIU_SUM, u->comm));
  PetscFunctionReturn(0);
}

/* X = A^-1 R' for m rows of R from `first` on, dense right-hand sides */
static PetscErrorCode SolveDense(const LowRank *u, PetscInt first, PetscInt m, Mat X)
{
  PetscScalar *unit;

  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(X));
  PetscCall(PetscCalloc1(u->p * m, &unit));
  for (PetscInt j = 0; j < m; j++) unit[j * u->p + first + j] = 1;
  PetscCall(PairsSpread(u->R, 1, u->p, m, unit, X));
  PetscCall(PetscFree(unit));
  PetscCall((*u->solve)(u->ctx, X));
  PetscFunctionReturn(0);
}

/* The same with sparse right-hand sides, of which a solver knows that most of its forward substitution is zero */
static PetscErrorCode SolveSparse(const LowRank *u, PetscInt first, PetscInt m, Mat X)
{
  IS  rows;
  Mat part;

  PetscFunctionBeginUser;
  PetscCall(ISCreateStride(u->comm, m, first, 1, &rows));
  PetscCall(MatCreateSubMatrix(u->R, rows, NULL, MAT_INITIAL_MATRIX, &part));
  PetscCall((*u->solve_rows)(u->ctx, part, X));
  PetscCall(MatDestroy(&part));
  PetscCall(ISDestroy(&rows));
  PetscFunctionReturn(0);
}

/* Columns first .. first + m - 1 of Y, and rows of C = I + (L Y)' */
static PetscErrorCode LowRankExtend(LowRank *u, PetscInt first, PetscInt m, PetscScalar c[])
{
  const PetscInt p = u->p;
  Mat            X;

  PetscFunctionBeginUser;
  if (u->Y)
    PetscCall(MatDenseGetSubMatrix(u->Y, PETSC_DECIDE, PETSC_DECIDE, first, first + m, &X));
  else
    PetscCall(DenseLike(u->R, PETSC_FALSE, m, &X));
  if (u->solve_rows)
    PetscCall(SolveSparse(u, first, m, X));
  else
    PetscCall(SolveDense(u, first, m, X));
  PetscCall(PairsOf(u->L, X, p, m, c));
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < p; i++) u->C[i * p + first + j] = c[j * p + i] + (i == first + j ? 1 : 0);
  if (u->Y)
    PetscCall(MatDenseRestoreSubMatrix(u->Y, &X));
  else
    PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

/* Y where it is kept, and C, by solves */
static PetscErrorCode LowRankSolveAll(LowRank *u, PetscInt n)
{
  const PetscInt most  = PetscMin(u->solve_rows ? LOWRANK_ROWS : LOWRANK_BLOCK, LOWRANK_ROOM / n);
  const PetscInt block = PetscMin(u->p, PetscMax(LOWRANK_FEW, most));
  PetscScalar   *c;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(u->p * block, &c));
  for (PetscInt first = 0; first < u->p; first += block)
    PetscCall(LowRankExtend(u, first, PetscMin(block, u->p - first), c));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

/* C by entries of the inverse where the vectors are not kept, else by p solves. *singular where A + L' R is: its
   determinant is that of A times that of C. */
PetscErrorCode LowRankSetUp(Mat L, Mat R, PetscBool store, LowRank *u, PetscBool *singular)
{
  PetscInt  n;
  PetscBool made = PETSC_FALSE;

  PetscFunctionBeginUser;
  u->L = L;
  u->R = R;
  PetscCall(PetscObjectGetComm((PetscObject)L, &u->comm));
  PetscCall(PetscObjectReference((PetscObject)L));
  PetscCall(PetscObjectReference((PetscObject)R));
  PetscCall(MatGetSize(L, &u->p, &n));
  if (store) PetscCall(DenseLike(R, PETSC_FALSE, u->p, &u->Y));
  PetscCall(PetscMalloc1(u->p * u->p, &u->C));
  PetscCall(PetscMalloc1(u->p, &u->pivot));
  if (!store) PetscCall(LowRankCapacitance(u, &made));
  if (!made) PetscCall(LowRankSolveAll(u, n));
  PetscCall(DenseFactor(u->p, u->C, u->pivot, singular));
  PetscFunctionReturn(0);
}

/* The columns of X and c of one side, right or left; m may be zero */
typedef struct {
  PetscBool    left;
  PetscInt     first, m;
  PetscScalar *c; /* [m][p] */
} Side;

/* c := C^-1 S X or C^-T S X, S = R or L, or with Y the right ones C^-1 Y' X */
static PetscErrorCode SideReduce(const LowRank *u, const Side *side, Mat X)
{
  Mat x;

  PetscFunctionBeginUser;
  if (!side->m) PetscFunctionReturn(0);
  PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, side->first, side->first + side->m, &x));
  if (u->Y && !side->left)
    PetscCall(StoredProduct(u, PETSC_FALSE, side->m, x, side->c));
  else
    PetscCall(PairsOf(side->left ? u->L : u->R, x, u->p, side->m, side->c));
  PetscCall(MatDenseRestoreSubMatrix(X, &x));
  PetscCall(DenseSolve(u->p, u->C, u->pivot, side->left, side->m, side->c));
  PetscFunctionReturn(0);
}

/* X -= S' c, S = L or R, or with Y the left ones X -= Y c */
static PetscErrorCode SideSubtract(const LowRank *u, const Side *side, Mat X)
{
  Mat x;

  PetscFunctionBeginUser;
  if (!side->m) PetscFunctionReturn(0);
  PetscCall(MatDenseGetSubMatrix(X, PETSC_DECIDE, PETSC_DECIDE, side->first, side->first + side->m, &x));
  if (u->Y && side->left)
    PetscCall(StoredProduct(u, PETSC_TRUE, side->m, x, side->c));
  else
    PetscCall(PairsSpread(side->left ? u->R : u->L, -1, u->p, side->m, side->c, x));
  PetscCall(MatDenseRestoreSubMatrix(X, &x));
  PetscFunctionReturn(0);
}

/* With Y: the right ones are changed before the solve, the left ones after it */
static PetscErrorCode ApplyStored(const LowRank *u, const Side *right, const Side *left, Mat X)
{
  PetscFunctionBeginUser;
  PetscCall(SideReduce(u, right, X));
  PetscCall(SideSubtract(u, right, X));
  PetscCall((*u->solve)(u->ctx, X));
  PetscCall(SideReduce(u, left, X));
  PetscCall(SideSubtract(u, left, X));
  PetscFunctionReturn(0);
}

/* Without Y: two solves of all */
static PetscErrorCode ApplyTwice(const LowRank *u, const Side *right, const Side *left, Mat X)
{
  Mat Z;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(X, MAT_COPY_VALUES, &Z));
  PetscCall((*u->solve)(u->ctx, Z));
  PetscCall(SideReduce(u, right, Z));
  PetscCall(SideReduce(u, left, Z));
  PetscCall(MatDestroy(&Z));
  PetscCall(SideSubtract(u, right, X));
  PetscCall(SideSubtract(u, left, X));
  PetscCall((*u->solve)(u->ctx, X));
  PetscFunctionReturn(0);
}

/* The first n_right columns are solved with A + L' R, the others with its transpose; one solve with the factors of
   A for all with Y, two without. */
PetscErrorCode LowRankApply(const LowRank *u, PetscInt n_right, Mat X)
{
  PetscInt     m;
  PetscScalar *c;
  Side         right, left;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &m));
  PetscCall(PetscMalloc1(u->p * m, &c));
  right = (Side){PETSC_FALSE, 0, n_right, c};
  left  = (Side){PETSC_TRUE, n_right, m - n_right, c + n_right * u->p};
  if (u->Y)
    PetscCall(ApplyStored(u, &right, &left, X));
  else
    PetscCall(ApplyTwice(u, &right, &left, X));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

PetscErrorCode LowRankMultAdd(const LowRank *u, PetscBool transposed, Vec x, Vec r)
{
  Vec pairs;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(u->L, NULL, &pairs));
  PetscCall(MatMult(transposed ? u->L : u->R, x, pairs));
  PetscCall(MatMultTransposeAdd(transposed ? u->R : u->L, pairs, r, r));
  PetscCall(VecDestroy(&pairs));
  PetscFunctionReturn(0);
}

PetscErrorCode LowRankDestroy(LowRank *u)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&u->L));
  PetscCall(MatDestroy(&u->R));
  PetscCall(MatDestroy(&u->Y));
  PetscCall(PetscFree(u->C));
  PetscCall(PetscFree(u->pivot));
  PetscFunctionReturn(0);
}
