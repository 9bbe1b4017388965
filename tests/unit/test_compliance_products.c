/*
   Dense products and factors of contact/compliance/lu.c at sizes on both sides of a cache, beside sums written out:

      y = W x of a symmetric W, of which half is read; L U x = A x; columns solved together, bitwise as one by one
*/
#include "contact/compliance/complianceimpl.h"

#include "check.h"
#include "petscmain.h"

/* In [-1, 1), numbers of no period that a block could hide */
static PetscReal Number(PetscInt i)
{
  return PetscSinReal(1.7 * (PetscReal)i + 1e-3 * (PetscReal)i * (PetscReal)i);
}

/* Symmetric, dominated by its diagonal */
static void MatrixFill(PetscInt n, PetscReal A[])
{
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i <= j; i++) A[j * n + i] = A[i * n + j] = Number(i * n + j) + (i == j ? (PetscReal)n : 0);
}

/* Largest of |A x - y| over the largest of |y| */
static PetscReal MatrixMiss(PetscInt n, const PetscReal A[], const PetscReal x[], const PetscReal y[])
{
  PetscReal miss = 0, size = 0;

  for (PetscInt i = 0; i < n; i++) {
    PetscReal sum = 0;

    for (PetscInt j = 0; j < n; j++) sum += A[j * n + i] * x[j];
    miss = PetscMax(miss, PetscAbsReal(sum - y[i]));
    size = PetscMax(size, PetscAbsReal(y[i]));
  }
  return miss / size;
}

static PetscErrorCode TestSize(PetscInt n, int *failed)
{
  const PetscInt columns = 7;
  PetscReal     *A, *LU, *x, *y, *X;
  PetscBool      same = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n * n, &A, n * n, &LU, n, &x, n, &y, columns * n, &X));
  MatrixFill(n, A);
  for (PetscInt i = 0; i < n; i++) x[i] = Number(7 * i + 1);
  PetscCall(PetscArrayzero(y, n));
  ComplianceAddSymmetric(n, A, x, y);
  *failed += CheckClose("symmetric product", MatrixMiss(n, A, x, y), 0, 1e-14 * (double)n);
  for (PetscInt j = 1; j < n; j++) A[j * n] *= 3; /* no longer symmetric */
  PetscCall(PetscArraycpy(LU, A, n * n));
  *failed += CheckTrue("pivots", ComplianceLUFactor(n, LU) > 0.1, (double)n);
  for (PetscInt i = 0; i < columns * n; i++) X[i] = Number(3 * i);
  ComplianceLUSolveColumns(n, LU, columns, X);
  for (PetscInt k = 0; k < columns; k++) {
    PetscBool equal;

    for (PetscInt i = 0; i < n; i++) x[i] = Number(3 * (k * n + i));
    PetscCall(PetscArraycpy(y, x, n));
    ComplianceLUSolve(n, LU, x);
    PetscCall(PetscArraycmp(x, &X[k * n], n, &equal));
    same = equal && same ? PETSC_TRUE : PETSC_FALSE;
  }
  *failed += CheckTrue("columns together, bitwise", same, (double)n);
  *failed += CheckClose("a solution", MatrixMiss(n, A, x, y), 0, 1e-14 * (double)n);
  PetscCall(PetscFree5(A, LU, x, y, X));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  const PetscInt n[] = {1, 5, 61, 363, 999, 1003, 1100};

  PetscFunctionBeginUser;
  (void)size;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(n); i++) PetscCall(TestSize(n[i], failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
