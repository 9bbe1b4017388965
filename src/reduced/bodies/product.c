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

void ReducedBlockTimes(const DenseBlock *A, PetscBool transposed, PetscReal scale, const PetscReal x[], PetscReal y[])
{
  const PetscReal    one  = 1;
  const PetscBLASInt rows = (PetscBLASInt)A->rows, columns = (PetscBLASInt)A->columns, stride = (PetscBLASInt)A->stride;
  const PetscBLASInt unit = 1;

  if (rows && columns)
    BLASgemv_(transposed ? "T" : "N", &rows, &columns, &scale, A->A, &stride, x, &unit, &one, y, &unit);
}

static inline PetscBool Carries(const PetscReal l[3])
{
  return l[0] != 0 || l[1] != 0 || l[2] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Runs of pairs that carry at once, since most pairs of a rattling contact are open and have no forces. */
void ReducedAddCarrying(const ReducedModel *model, PetscInt rows, const PetscReal A[], const PetscReal lambda[],
                        PetscReal y[])
{
  for (PetscInt i = 0, end; i < model->n_pairs; i = end + 1) {
    while (i < model->n_pairs && !Carries(&lambda[3 * i])) i++;
    for (end = i; end < model->n_pairs && Carries(&lambda[3 * end]);) end++;
    ReducedBlockTimes(&(DenseBlock){&A[3 * i * rows], rows, 3 * (end - i), rows}, PETSC_FALSE, 1, &lambda[3 * i], y);
  }
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

/* The mean of both: the contact laws and energies take W as symmetric. */
void ReducedSymmetrise(PetscInt N, PetscReal A[])
{
  for (PetscInt j = 0; j < N; j++)
    for (PetscInt i = 0; i < j; i++) A[i + N * j] = A[j + N * i] = 0.5 * (A[i + N * j] + A[j + N * i]);
}
