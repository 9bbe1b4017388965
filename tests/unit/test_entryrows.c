/*
   Unit test of basis/entryrows: X' A Y over the rows in which A has entries, on one and on several ranks, against
   the products of SLEPc's BV with the whole matrix.
*/
#include "basis/entryrows.h"
#include "check.h"

#define N_ROWS  120
#define N_LEFT  7
#define N_RIGHT 5

/* Entries in the rows first .. first + n - 1, an explicit zero in the row behind them */
static PetscErrorCode MatrixMake(PetscInt first, PetscInt n, Mat *A)
{
  PetscInt low, high;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, N_ROWS, N_ROWS, 4, NULL, 4, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &low, &high));
  for (PetscInt i = PetscMax(low, first); i < PetscMin(high, first + n); i++)
    for (PetscInt k = 0; k < 3; k++)
      PetscCall(MatSetValue(*A, i, (i + 31 * k) % N_ROWS, 1 + sin((PetscReal)(3 * i + k)), INSERT_VALUES));
  if (first + n >= low && first + n < high) PetscCall(MatSetValue(*A, first + n, 0, 0, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

static PetscErrorCode VectorsMake(Mat A, PetscInt n, PetscReal phase, BV *X)
{
  Vec u;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &u, NULL));
  PetscCall(BVCreate(PETSC_COMM_WORLD, X));
  PetscCall(BVSetType(*X, BVMAT));
  PetscCall(BVSetSizesFromVec(*X, u, n + 1)); /* one more than is active */
  PetscCall(VecDestroy(&u));
  for (PetscInt j = 0; j <= n; j++) {
    PetscInt low, high;

    PetscCall(BVGetColumn(*X, j, &u));
    PetscCall(VecGetOwnershipRange(u, &low, &high));
    for (PetscInt i = low; i < high; i++)
      PetscCall(VecSetValue(u, i, cos(phase + (PetscReal)((j + 2) * i)), INSERT_VALUES));
    PetscCall(VecAssemblyBegin(u));
    PetscCall(VecAssemblyEnd(u));
    PetscCall(BVRestoreColumn(*X, j, &u));
  }
  PetscCall(BVSetActiveColumns(*X, 0, n));
  PetscFunctionReturn(0);
}

/* |H - X' Y|, entry by entry */
static PetscErrorCode Difference(Mat H, BV X, BV Y, PetscReal *worst)
{
  Mat G;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, N_LEFT, N_RIGHT, NULL, &G));
  PetscCall(BVDot(Y, X, G));
  PetscCall(MatAXPY(G, -1, H, SAME_NONZERO_PATTERN));
  PetscCall(MatNorm(G, NORM_FROBENIUS, worst));
  PetscCall(MatDestroy(&G));
  PetscFunctionReturn(0);
}

/* D Y */
static PetscErrorCode VectorsScale(Vec diagonal, BV Y)
{
  Mat columns;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(Y, &columns));
  PetscCall(MatDiagonalScale(columns, diagonal, NULL));
  PetscCall(BVRestoreMat(Y, &columns));
  PetscFunctionReturn(0);
}

/* Breaks when: a row with entries is left out, one without is taken for one of few, or a rank without any stops the others.
   Reference: the whole products */
static PetscErrorCode TestRows(PetscInt first, PetscInt n, PetscBool few, int *failed)
{
  EntryRows rows = {0};
  PetscInt  found;
  PetscReal worst;
  BV        X, Y, AY;
  Vec       diagonal;
  Mat       A, H;

  PetscFunctionBeginUser;
  printf("     rows %d to %d\n", (int)first, (int)(first + n - 1));
  PetscCall(MatrixMake(first, n, &A));
  PetscCall(EntryRowsCreate(A, &rows));
  PetscCallMPI(MPI_Allreduce(&rows.n, &found, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  *failed += CheckTrue("few rows", rows.few == few, rows.few);
  *failed += CheckTrue("rows that are taken", found >= n && (!few || found <= N_ROWS / 2), (double)found);
  PetscCall(VectorsMake(A, N_LEFT, 0.3, &X));
  PetscCall(VectorsMake(A, N_RIGHT, 1.1, &Y));
  PetscCall(VectorsMake(A, N_RIGHT, 0, &AY));
  PetscCall(BVMatMult(Y, A, AY));
  PetscCall(EntryRowsProducts(&rows, X, NULL, AY, &H));
  PetscCall(Difference(H, X, AY, &worst));
  PetscCall(MatDestroy(&H));
  *failed += CheckClose("X' A Y", worst, 0, 1e-12);
  PetscCall(MatCreateVecs(A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(A, diagonal));
  PetscCall(EntryRowsProducts(&rows, X, diagonal, Y, &H));
  PetscCall(VectorsScale(diagonal, Y));
  PetscCall(Difference(H, X, Y, &worst));
  *failed += CheckClose("X' diag(A) Y", worst, 0, 1e-12);
  PetscCall(MatDestroy(&H));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(BVDestroy(&X));
  PetscCall(BVDestroy(&Y));
  PetscCall(BVDestroy(&AY));
  PetscCall(EntryRowsDestroy(&rows));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestRows(3, 11, PETSC_TRUE, &failed)); /* all on the first rank */
  PetscCall(TestRows(55, 20, PETSC_TRUE, &failed));
  PetscCall(TestRows(0, 100, PETSC_FALSE, &failed));
  PetscCall(TestRows(0, 119, PETSC_FALSE, &failed));
  PetscCall(SlepcFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
