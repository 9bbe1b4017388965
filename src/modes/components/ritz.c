/*
   Free modes of the bodies by the Rayleigh-Ritz method: of vectors V, those of body b alone, V_b,

      (V_b' K V_b) z = kappa (V_b' M V_b) z,   phi = V_b z,   phi' M phi = 1.

   Kappa is never below the exact one of its number. The dense problem is that of reduce.c.
*/
#include "components.h"
#include "solver/block/orthonormal.h"
#include <petscblaslapack.h>
#include <string.h>

#define RITZ_COLUMNS 32    /* multiplied at once */
#define RITZ_ROWS    512   /* of a body, side by side in the cache */
#define RITZ_STILL   1e-14 /* square of a length beside that of all bodies: the body does not move in this vector */

/* The unknowns of each body */
static PetscErrorCode RowsFind(const FreeBodies *of, PetscInt n, FreeBasis *basis)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(of->n, &basis->row, of->n, &basis->n_rows));
  for (PetscInt i = 0; i < n; i++) basis->n_rows[of->of[i]]++;
  for (PetscInt b = 0; b < of->n; b++) PetscCall(PetscMalloc1(basis->n_rows[b], &basis->row[b]));
  PetscCall(PetscArrayzero(basis->n_rows, of->n));
  for (PetscInt i = 0; i < n; i++) basis->row[of->of[i]][basis->n_rows[of->of[i]]++] = i;
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisCreate(const FreeBodies *of, Mat M, PetscInt n, FreeBasis *basis)
{
  PetscInt n_own;

  PetscFunctionBeginUser;
  *basis = (FreeBasis){.n = n, .n_bodies = of->n};
  PetscCall(MatGetLocalSize(M, &n_own, NULL));
  PetscCall(RowsFind(of, n_own, basis));
  PetscCall(PetscCalloc1(n, &basis->v));
  for (PetscInt k = n - FREE_MOTIONS; k < n; k++) PetscCall(MatCreateVecs(M, NULL, &basis->v[k]));
  PetscCall(PetscCalloc4(of->n * n * n, &basis->mass, of->n * n * n, &basis->stiffness, of->n * n, &basis->kappa,
                         of->n * n * n, &basis->Z));
  PetscCall(PetscCalloc2(of->n, &basis->n_modes, of->n, &basis->n_rigid));
  PetscFunctionReturn(0);
}

/* The first n vectors of the basis on this rank, or as many columns of a dense matrix, whose array is kept for long */
typedef struct {
  PetscInt            n;
  const PetscScalar **at; /* [n] */
} Columns;

static PetscErrorCode VectorsOpen(const FreeBasis *basis, PetscInt n, Columns *v)
{
  PetscFunctionBeginUser;
  v->n = n;
  PetscCall(PetscMalloc1(n, &v->at));
  for (PetscInt j = 0; j < n; j++) PetscCall(VecGetArrayRead(basis->v[j], &v->at[j]));
  PetscFunctionReturn(0);
}

static PetscErrorCode VectorsClose(const FreeBasis *basis, Columns *v)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < v->n; j++) PetscCall(VecRestoreArrayRead(basis->v[j], &v->at[j]));
  PetscCall(PetscFree(v->at));
  PetscFunctionReturn(0);
}

static PetscErrorCode BlockOpen(Mat Y, Columns *y)
{
  PetscInt           stride;
  const PetscScalar *array;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(Y, NULL, &y->n));
  PetscCall(MatDenseGetLDA(Y, &stride));
  PetscCall(MatDenseGetArrayRead(Y, &array));
  PetscCall(PetscMalloc1(y->n, &y->at));
  for (PetscInt j = 0; j < y->n; j++) y->at[j] = &array[(size_t)j * stride];
  PetscFunctionReturn(0);
}

static PetscErrorCode BlockClose(Mat Y, Columns *y)
{
  const PetscScalar *array = y->at[0];

  PetscFunctionBeginUser;
  PetscCall(MatDenseRestoreArrayRead(Y, &array));
  PetscCall(PetscFree(y->at));
  PetscFunctionReturn(0);
}

/* n rows of some columns side by side: neighbours, as most are, at the speed of the memory */
static void RowsPack(PetscInt n, const PetscInt row[], const Columns *from, PetscScalar packed[])
{
  const PetscBool neighbours = row[n - 1] - row[0] == n - 1 ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt j = 0; j < from->n; j++) {
    if (neighbours) memcpy(&packed[j * n], &from->at[j][row[0]], (size_t)n * sizeof(*packed));
    for (PetscInt i = 0; i < n && !neighbours; i++) packed[j * n + i] = from->at[j][row[i]];
  }
}

/* G[k][:, 0 .. m) += V_b' Y[k], two Y of m columns; G has n rows */
static PetscErrorCode BodyProducts(const FreeBasis *basis, PetscInt b, const Columns *V, const Columns Y[2],
                                   PetscReal *const G[2])
{
  const PetscScalar one = 1;
  PetscScalar      *v, *y;
  PetscBLASInt      columns, products, stride;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(V->n, &columns));
  PetscCall(PetscBLASIntCast(Y->n, &products));
  PetscCall(PetscBLASIntCast(basis->n, &stride));
  PetscCall(PetscMalloc2(RITZ_ROWS * V->n, &v, RITZ_ROWS * Y->n, &y));
  for (PetscInt first = 0; first < basis->n_rows[b]; first += RITZ_ROWS) {
    const PetscInt    *row  = &basis->row[b][first];
    const PetscBLASInt rows = (PetscBLASInt)PetscMin(RITZ_ROWS, basis->n_rows[b] - first);

    RowsPack(rows, row, V, v);
    for (int k = 0; k < 2; k++) {
      RowsPack(rows, row, &Y[k], y);
      PetscCallBLAS("BLASgemm",
                    BLASgemm_("T", "N", &columns, &products, &rows, &one, v, &rows, y, &rows, &one, G[k], &stride));
    }
  }
  PetscCall(PetscFree2(v, y));
  PetscFunctionReturn(0);
}

/* Vectors first, first + 1, ... as many as X has columns */
static PetscErrorCode BlockFill(const FreeBasis *basis, PetscInt first, Mat X)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    Vec column;

    PetscCall(MatDenseGetColumnVecWrite(X, j, &column));
    PetscCall(VecCopy(basis->v[first + j], column));
    PetscCall(MatDenseRestoreColumnVecWrite(X, j, &column));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FreeMatricesMultiply(const FreeMatrices *bodies, Mat X, const Mat AX[2])
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(BlockMultiplyEach(2, (const Mat[2]){bodies->M, bodies->K}, X, AX));
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt j = 0; j < n && bodies->less; j++) {
    Vec x, Kx;

    PetscCall(MatDenseGetColumnVecRead(X, j, &x));
    PetscCall(MatDenseGetColumnVec(AX[1], j, &Kx));
    PetscCall(MatMultAdd(bodies->less, x, Kx, Kx));
    PetscCall(MatDenseRestoreColumnVec(AX[1], j, &Kx));
    PetscCall(MatDenseRestoreColumnVecRead(X, j, &x));
  }
  PetscFunctionReturn(0);
}

/* Columns first .. last of V' M V and V' K V of all bodies, down to the diagonal; work: X, M X, K X with columns for
   as many */
static PetscErrorCode ColumnsMeasure(const FreeMatrices *bodies, PetscInt first, const Mat work[3], FreeBasis *basis)
{
  PetscInt m;
  Columns  V, Y[2];

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(work[0], NULL, &m));
  PetscCall(BlockFill(basis, first, work[0]));
  PetscCall(FreeMatricesMultiply(bodies, work[0], &work[1]));
  PetscCall(VectorsOpen(basis, first + m, &V));
  for (int k = 0; k < 2; k++) PetscCall(BlockOpen(work[1 + k], &Y[k]));
  for (PetscInt b = 0; b < basis->n_bodies; b++) {
    const PetscInt at = (b * basis->n + first) * basis->n;

    PetscCall(BodyProducts(basis, b, &V, Y, (PetscReal *[2]){&basis->mass[at], &basis->stiffness[at]}));
  }
  for (int k = 0; k < 2; k++) PetscCall(BlockClose(work[1 + k], &Y[k]));
  PetscCall(VectorsClose(basis, &V));
  PetscFunctionReturn(0);
}

/* All columns, RITZ_COLUMNS at a time */
static PetscErrorCode BasisMeasure(const FreeMatrices *bodies, FreeBasis *basis)
{
  PetscInt n_own, columns = 0;
  Mat      work[3] = {NULL, NULL, NULL};

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(bodies->M, &n_own, NULL));
  for (PetscInt first = 0; first < basis->n; first += columns) {
    const PetscInt m = PetscMin(RITZ_COLUMNS, basis->n - first);

    for (int k = 0; k < 3 && m != columns; k++) {
      PetscCall(MatDestroy(&work[k]));
      PetscCall(MatCreateDense(PetscObjectComm((PetscObject)bodies->M), n_own, PETSC_DECIDE, PETSC_DETERMINE, m, NULL,
                               &work[k]));
    }
    columns = m;
    PetscCall(ColumnsMeasure(bodies, first, work, basis));
  }
  for (int k = 0; k < 3; k++) PetscCall(MatDestroy(&work[k]));
  PetscFunctionReturn(0);
}

/* The lower half as the upper one */
static void SymmetricFill(PetscInt n, PetscReal A[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = j + 1; i < n; i++) A[j * n + i] = A[i * n + j];
}

/* The modes of body b among its vectors */
static PetscErrorCode BodySolve(FreeBasis *basis, PetscInt b)
{
  const PetscInt n = basis->n;
  PetscReal     *length, *G, *H, *Z = &basis->Z[b * n * n];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &length, n * n, &G, n * n, &H));
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal own = basis->mass[(b * n + j) * n + j];
    PetscReal       all = 0;

    for (PetscInt c = 0; c < basis->n_bodies; c++) all += basis->mass[(c * n + j) * n + j];
    length[j] = own > RITZ_STILL * all ? 1 / PetscSqrtReal(own) : 0;
  }
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      G[j * n + i] = length[i] * length[j] * basis->mass[(b * n + j) * n + i];
      H[j * n + i] = length[i] * length[j] * basis->stiffness[(b * n + j) * n + i];
    }
  PetscCall(FreeBodySolve(n, G, H, &(FreeBodyModes){Z, &basis->kappa[b * n], &basis->n_rigid[b], &basis->n_modes[b]}));
  for (PetscInt k = 0; k < basis->n_modes[b]; k++)
    for (PetscInt i = 0; i < n; i++) Z[k * n + i] *= length[i];
  PetscCall(PetscFree3(length, G, H));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisSolve(const FreeMatrices *bodies, FreeBasis *basis)
{
  const PetscInt    n    = basis->n;
  const PetscMPIInt size = (PetscMPIInt)(basis->n_bodies * n * n);
  MPI_Comm          comm = PetscObjectComm((PetscObject)bodies->M);
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCall(BasisMeasure(bodies, basis));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, basis->mass, size, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, basis->stiffness, size, MPIU_REAL, MPI_SUM, comm));
  for (PetscInt b = 0; b < basis->n_bodies; b++) {
    SymmetricFill(n, &basis->mass[b * n * n]);
    SymmetricFill(n, &basis->stiffness[b * n * n]);
  }
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (PetscInt b = 0; b < basis->n_bodies && !rank; b++) PetscCall(BodySolve(basis, b)); /* processors may differ */
  PetscCallMPI(MPI_Bcast(basis->n_rigid, (PetscMPIInt)basis->n_bodies, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(basis->n_modes, (PetscMPIInt)basis->n_bodies, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(basis->kappa, (PetscMPIInt)(basis->n_bodies * n), MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(basis->Z, size, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisLift(const FreeBasis *basis, PetscInt b, const LiftRange *range, Mat F)
{
  const PetscScalar one = 1, zero = 0;
  const PetscInt    n = range->end - range->begin;
  Columns           V;
  PetscScalar      *f, *v, *phi;
  const PetscInt   *row = basis->row[b];
  PetscInt          ldf;
  PetscBLASInt      columns, inner;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCall(PetscBLASIntCast(basis->n, &inner));
  PetscCall(VectorsOpen(basis, basis->n, &V));
  PetscCall(MatDenseGetLDA(F, &ldf));
  PetscCall(MatDenseGetArray(F, &f));
  PetscCall(PetscMalloc2(RITZ_ROWS * basis->n, &v, RITZ_ROWS * n, &phi));
  for (PetscInt start = 0; start < basis->n_rows[b]; start += RITZ_ROWS) {
    const PetscBLASInt rows = (PetscBLASInt)PetscMin(RITZ_ROWS, basis->n_rows[b] - start);

    RowsPack(rows, &row[start], &V, v);
    PetscCallBLAS("BLASgemm",
                  BLASgemm_("N", "N", &rows, &columns, &inner, &one, v, &rows,
                            &basis->Z[(b * basis->n + range->begin) * basis->n], &inner, &zero, phi, &rows));
    for (PetscInt k = 0; k < n; k++)
      for (PetscInt i = 0; i < rows; i++) f[(size_t)(range->first + k) * ldf + row[start + i]] = phi[k * rows + i];
  }
  PetscCall(PetscFree2(v, phi));
  PetscCall(MatDenseRestoreArray(F, &f));
  PetscCall(VectorsClose(basis, &V));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisDestroy(FreeBasis *basis)
{
  PetscFunctionBeginUser;
  for (PetscInt k = basis->n - FREE_MOTIONS; k < basis->n; k++) PetscCall(VecDestroy(&basis->v[k]));
  PetscCall(PetscFree(basis->v));
  for (PetscInt b = 0; b < basis->n_bodies; b++) PetscCall(PetscFree(basis->row[b]));
  PetscCall(PetscFree2(basis->row, basis->n_rows));
  PetscCall(PetscFree4(basis->mass, basis->stiffness, basis->kappa, basis->Z));
  PetscCall(PetscFree2(basis->n_modes, basis->n_rigid));
  PetscFunctionReturn(0);
}
