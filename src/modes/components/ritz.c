/*
   Free modes of the bodies by the Rayleigh-Ritz method: of vectors V, those of body b alone, V_b,

      (V_b' K V_b) z = kappa (V_b' M V_b) z,   phi = V_b z,   phi' M phi = 1.

   Kappa is never below the exact one of its number. The dense problem is that of reduce.c.
*/
#include "components.h"
#include "solver/block/orthonormal.h"
#include <petscblaslapack.h>

#define RITZ_COLUMNS 32    /* multiplied at once */
#define RITZ_ROWS    512   /* of a body, side by side in the cache */
#define RITZ_STILL   1e-14 /* square of a length beside that of all bodies: the body does not move in this vector */

/* The unknowns of each body */
static PetscErrorCode RowsFind(Pencil bodies, const FreeBodies *of, Vec like, FreeBasis *basis)
{
  const PetscScalar *at;
  PetscScalar       *body;
  PetscInt           n;
  Operators          operators;
  Vec                all, own;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(bodies, &operators));
  PetscCall(OperatorsCreateVec(operators, &all));
  PetscCall(VecGetLocalSize(all, &n));
  PetscCall(VecGetArrayWrite(all, &body));
  for (PetscInt i = 0; i < n; i++) body[i] = of->of[i];
  PetscCall(VecRestoreArrayWrite(all, &body));
  PetscCall(VecDuplicate(like, &own));
  PetscCall(PencilRestrict(bodies, all, own));
  PetscCall(VecGetLocalSize(own, &n));
  PetscCall(PetscCalloc2(of->n, &basis->row, of->n, &basis->n_rows));
  PetscCall(VecGetArrayRead(own, &at));
  for (PetscInt b = 0; b < of->n; b++) {
    PetscCall(PetscMalloc1(n, &basis->row[b]));
    for (PetscInt i = 0; i < n; i++)
      if (PetscAbsReal(at[i] - b) < 0.5) basis->row[b][basis->n_rows[b]++] = i;
  }
  PetscCall(VecRestoreArrayRead(own, &at));
  PetscCall(VecDestroy(&own));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisCreate(Pencil bodies, const FreeBodies *of, PetscInt n, FreeBasis *basis)
{
  PencilMatrices pencil;
  PetscInt       n_own;
  Vec            like;

  PetscFunctionBeginUser;
  *basis = (FreeBasis){.n = n, .n_bodies = of->n};
  PetscCall(PencilGetMatrices(bodies, &pencil));
  PetscCall(MatCreateVecs(pencil.K, &like, NULL));
  PetscCall(VecGetLocalSize(like, &n_own));
  PetscCall(
    MatCreateDense(PetscObjectComm((PetscObject)pencil.K), n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &basis->V));
  PetscCall(RowsFind(bodies, of, like, basis));
  PetscCall(VecDestroy(&like));
  PetscCall(PetscCalloc4(of->n * n * n, &basis->mass, of->n * n * n, &basis->stiffness, of->n * n, &basis->kappa,
                         of->n * n * n, &basis->Z));
  PetscCall(PetscCalloc2(of->n, &basis->n_modes, of->n, &basis->n_rigid));
  PetscFunctionReturn(0);
}

/* Columns of a dense matrix on this rank */
typedef struct {
  PetscInt           n, stride;
  const PetscScalar *at;
} Columns;

/* n rows of some columns side by side, stride ld: where they are neighbours they stay in place */
static const PetscScalar *RowsPack(PetscInt n, const PetscInt row[], const Columns *from, PetscScalar room[],
                                   PetscBLASInt *ld)
{
  *ld = (PetscBLASInt)from->stride;
  if (row[n - 1] - row[0] == n - 1) return &from->at[row[0]];
  for (PetscInt j = 0; j < from->n; j++)
    for (PetscInt i = 0; i < n; i++) room[j * n + i] = from->at[(size_t)j * from->stride + row[i]];
  *ld = (PetscBLASInt)n;
  return room;
}

/* G[k][:, 0 .. m) += V_b' Y[k], two Y of m columns; G has n rows */
static PetscErrorCode BodyProducts(const FreeBasis *basis, PetscInt b, const Columns *V, const Columns Y[2],
                                   PetscReal *const G[2])
{
  const PetscScalar one = 1;
  PetscScalar      *room[2];
  PetscBLASInt      columns, products, stride;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(V->n, &columns));
  PetscCall(PetscBLASIntCast(Y->n, &products));
  PetscCall(PetscBLASIntCast(basis->n, &stride));
  PetscCall(PetscMalloc2(RITZ_ROWS * V->n, &room[0], RITZ_ROWS * Y->n, &room[1]));
  for (PetscInt first = 0; first < basis->n_rows[b]; first += RITZ_ROWS) {
    const PetscInt    *row  = &basis->row[b][first];
    const PetscBLASInt rows = (PetscBLASInt)PetscMin(RITZ_ROWS, basis->n_rows[b] - first);
    PetscBLASInt       ldv, ldy;
    const PetscScalar *v = RowsPack(rows, row, V, room[0], &ldv);

    for (int k = 0; k < 2; k++) {
      const PetscScalar *y = RowsPack(rows, row, &Y[k], room[1], &ldy);

      PetscCallBLAS("BLASgemm",
                    BLASgemm_("T", "N", &columns, &products, &rows, &one, v, &ldv, y, &ldy, &one, G[k], &stride));
    }
  }
  PetscCall(PetscFree2(room[0], room[1]));
  PetscFunctionReturn(0);
}

/* Columns first .. last of V' M V and V' K V of all bodies, down to the diagonal */
static PetscErrorCode ColumnsMeasure(const PencilMatrices *bodies, PetscInt first, PetscInt last, FreeBasis *basis)
{
  const Mat A[2] = {bodies->M, bodies->K};
  Columns   V    = {.n = last}, Y[2];
  Mat       X, AX[2];

  PetscFunctionBeginUser;
  PetscCall(MatDenseGetSubMatrix(basis->V, PETSC_DECIDE, PETSC_DECIDE, first, last, &X));
  for (int k = 0; k < 2; k++) PetscCall(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, &AX[k]));
  PetscCall(BlockMultiplyEach(2, A, X, AX));
  PetscCall(MatDenseRestoreSubMatrix(basis->V, &X));
  PetscCall(MatDenseGetLDA(basis->V, &V.stride));
  PetscCall(MatDenseGetArrayRead(basis->V, &V.at));
  for (int k = 0; k < 2; k++) {
    Y[k].n = last - first;
    PetscCall(MatDenseGetLDA(AX[k], &Y[k].stride));
    PetscCall(MatDenseGetArrayRead(AX[k], &Y[k].at));
  }
  for (PetscInt b = 0; b < basis->n_bodies; b++) {
    const PetscInt at = (b * basis->n + first) * basis->n;

    PetscCall(BodyProducts(basis, b, &V, Y, (PetscReal *[2]){&basis->mass[at], &basis->stiffness[at]}));
  }
  for (int k = 0; k < 2; k++) {
    PetscCall(MatDenseRestoreArrayRead(AX[k], &Y[k].at));
    PetscCall(MatDestroy(&AX[k]));
  }
  PetscCall(MatDenseRestoreArrayRead(basis->V, &V.at));
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

PetscErrorCode FreeBasisSolve(const PencilMatrices *bodies, FreeBasis *basis)
{
  const PetscInt    n    = basis->n;
  const PetscMPIInt size = (PetscMPIInt)(basis->n_bodies * n * n);
  MPI_Comm          comm = PetscObjectComm((PetscObject)basis->V);
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < n; first += RITZ_COLUMNS)
    PetscCall(ColumnsMeasure(bodies, first, PetscMin(n, first + RITZ_COLUMNS), basis));
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

PetscErrorCode FreeBasisLift(const FreeBasis *basis, PetscInt b, PetscInt n, PetscInt first, Mat F)
{
  const PetscScalar one = 1, zero = 0;
  Columns           V = {.n = basis->n};
  PetscScalar      *f, *v, *phi;
  const PetscInt   *row = basis->row[b];
  PetscInt          ldf;
  PetscBLASInt      columns, inner;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCall(PetscBLASIntCast(basis->n, &inner));
  PetscCall(MatDenseGetLDA(basis->V, &V.stride));
  PetscCall(MatDenseGetLDA(F, &ldf));
  PetscCall(MatDenseGetArrayRead(basis->V, &V.at));
  PetscCall(MatDenseGetArray(F, &f));
  PetscCall(PetscMalloc2(RITZ_ROWS * basis->n, &v, RITZ_ROWS * n, &phi));
  for (PetscInt start = 0; start < basis->n_rows[b] && n; start += RITZ_ROWS) {
    const PetscBLASInt rows = (PetscBLASInt)PetscMin(RITZ_ROWS, basis->n_rows[b] - start);
    PetscBLASInt       ld;
    const PetscScalar *packed = RowsPack(rows, &row[start], &V, v, &ld);

    PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &rows, &columns, &inner, &one, packed, &ld,
                                        &basis->Z[b * basis->n * basis->n], &inner, &zero, phi, &rows));
    for (PetscInt k = 0; k < n; k++)
      for (PetscInt i = 0; i < rows; i++) f[(size_t)(first + k) * ldf + row[start + i]] = phi[k * rows + i];
  }
  PetscCall(PetscFree2(v, phi));
  PetscCall(MatDenseRestoreArray(F, &f));
  PetscCall(MatDenseRestoreArrayRead(basis->V, &V.at));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisDestroy(FreeBasis *basis)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&basis->V));
  for (PetscInt b = 0; b < basis->n_bodies; b++) PetscCall(PetscFree(basis->row[b]));
  PetscCall(PetscFree2(basis->row, basis->n_rows));
  PetscCall(PetscFree4(basis->mass, basis->stiffness, basis->kappa, basis->Z));
  PetscCall(PetscFree2(basis->n_modes, basis->n_rigid));
  PetscFunctionReturn(0);
}
