/*
   Products of blocks of vectors, dense matrices with their rows spread over the ranks: X'Y, and X += c A H with a small
   H that every rank has. One call of BLAS each.
*/
#include "gram.h"
#include <petscblaslapack.h>

/* H [columns of Y][columns of X] = X'Y, alike on all ranks up to the order of the sum; one reduction. BLAS with an
   inner size of 0 would leave H as it was. */
PetscErrorCode BlockGram(Mat X, Mat Y, PetscReal H[])
{
  const PetscScalar *x, *y, one = 1, zero = 0;
  PetscInt           n, a, b, ldx, ldy;
  PetscBLASInt       rows, columns, inner, lx, ly;
  MPI_Comm           comm;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetComm((PetscObject)X, &comm));
  PetscCall(MatGetLocalSize(X, &n, NULL));
  PetscCall(MatGetSize(X, NULL, &a));
  PetscCall(MatGetSize(Y, NULL, &b));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(PetscBLASIntCast(a, &rows));
  PetscCall(PetscBLASIntCast(b, &columns));
  PetscCall(PetscBLASIntCast(n, &inner));
  PetscCall(PetscBLASIntCast(PetscMax(1, ldx), &lx));
  PetscCall(PetscBLASIntCast(PetscMax(1, ldy), &ly));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArrayRead(Y, &y));
  if (!n) PetscCall(PetscArrayzero(H, a * b));
  if (n && a && b)
    PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &rows, &columns, &inner, &one, x, &lx, y, &ly, &zero, H, &rows));
  PetscCall(MatDenseRestoreArrayRead(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, H, (PetscMPIInt)(a * b), MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockAddProduct(PetscReal scale, Mat A, const PetscReal H[], Mat X)
{
  const PetscScalar *a, one = 1;
  PetscScalar       *x;
  PetscInt           n, m, k, lda, ldx;
  PetscBLASInt       rows, columns, inner, la, lx;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n, NULL));
  PetscCall(MatGetSize(A, NULL, &m));
  PetscCall(MatGetSize(X, NULL, &k));
  PetscCall(MatDenseGetLDA(A, &lda));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(PetscBLASIntCast(n, &rows));
  PetscCall(PetscBLASIntCast(k, &columns));
  PetscCall(PetscBLASIntCast(m, &inner));
  PetscCall(PetscBLASIntCast(PetscMax(1, lda), &la));
  PetscCall(PetscBLASIntCast(PetscMax(1, ldx), &lx));
  PetscCall(MatDenseGetArrayRead(A, &a));
  PetscCall(MatDenseGetArray(X, &x));
  if (n && m && k)
    PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &rows, &columns, &inner, &scale, a, &la, H, &inner, &one, x, &lx));
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscCall(MatDenseRestoreArrayRead(A, &a));
  PetscFunctionReturn(0);
}

PetscErrorCode BlockTakeOut(Mat A, Mat B, Mat X)
{
  PetscInt   m, columns;
  PetscReal *H;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, NULL, &m));
  PetscCall(MatGetSize(X, NULL, &columns));
  PetscCall(PetscMalloc1(m * columns, &H));
  PetscCall(BlockGram(B, X, H));
  PetscCall(BlockAddProduct(-1, A, H, X));
  PetscCall(PetscFree(H));
  PetscFunctionReturn(0);
}
