/*
   Products of dense blocks by BLAS, columns of a block stride apart.
*/
#include "reduced/reducedimpl.h"
#include <petscblaslapack.h>

/* Y = op(A) X, [columns][rows] without gaps. BLAS with an inner size of 0 would leave Y as it was. */
static void Multiply(const DenseBlock *A, PetscBool transposed, const DenseBlock *X, PetscReal Y[])
{
  const PetscBLASInt rows = (PetscBLASInt)(transposed ? A->columns : A->rows), columns = (PetscBLASInt)X->columns;
  const PetscBLASInt inner = (PetscBLASInt)X->rows, lda = (PetscBLASInt)A->stride, ldx = (PetscBLASInt)X->stride;
  const PetscReal    one = 1, zero = 0;

  if (rows && columns && !inner)
    for (PetscInt i = 0; i < rows * columns; i++) Y[i] = 0;
  if (rows && columns && inner)
    BLASgemm_(transposed ? "T" : "N", "N", &rows, &columns, &inner, &one, A->A, &lda, X->A, &ldx, &zero, Y, &rows);
}

void ReducedTimes(const DenseBlock *A, const DenseBlock *X, PetscReal Y[])
{
  Multiply(A, PETSC_FALSE, X, Y);
}

void ReducedTimesTransposed(const DenseBlock *A, const DenseBlock *X, PetscReal Y[])
{
  Multiply(A, PETSC_TRUE, X, Y);
}

/* H [b][a] = X'Y of blocks of unknowns, alike on all ranks up to the order of the sum; one reduction of a b
   numbers. */
PetscErrorCode ReducedGram(Mat X, Mat Y, PetscReal H[])
{
  const PetscScalar *x, *y;
  PetscInt           n, a, b, ldx, ldy;
  MPI_Comm           comm;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectGetComm((PetscObject)X, &comm));
  PetscCall(MatGetLocalSize(X, &n, NULL));
  PetscCall(MatGetSize(X, NULL, &a));
  PetscCall(MatGetSize(Y, NULL, &b));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArrayRead(Y, &y));
  ReducedTimesTransposed(&(DenseBlock){x, n, a, ldx}, &(DenseBlock){y, n, b, ldy}, H);
  PetscCall(MatDenseRestoreArrayRead(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, H, (PetscMPIInt)(a * b), MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedAddCombination(Mat X, const PetscReal coefficients[], Vec y)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt k = 0; k < n; k++) {
    Vec column;

    PetscCall(MatDenseGetColumnVecRead(X, k, &column));
    PetscCall(VecAXPY(y, coefficients[k], column));
    PetscCall(MatDenseRestoreColumnVecRead(X, k, &column));
  }
  PetscFunctionReturn(0);
}
