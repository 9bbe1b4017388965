/*
   Unit test of solver/block/block.c: solves in blocks with dense matrices whose columns lie apart in memory (leading dimension
   above the local rows), as newer SLEPc hands them out, and the products with such matrices that the sweep relies on.

   Then solver/factor/lowrank.c: friction as an update of the factors of the symmetric part, with its vectors kept (2 pairs) and
   not (40 pairs), at two shifts with one analysis.

   Reference: X is chosen at random, B = A X made column by column with MatMult() or MatMultTranspose().
*/
#include "check.h"
#include "solver/factor/lowrank.h"
#include "solver/factor/ordering.h"
#include "solver/factor/shiftinvert.h"

#define N       200
#define COLUMNS 7

/* A band of half width 3 with a strong diagonal at random; K unsymmetric or symmetric, M the identity */
static PetscErrorCode MakePencil(PetscBool symmetric, PencilMatrices *pencil)
{
  PetscInt    first, last;
  PetscRandom random;

  PetscFunctionBeginUser;
  *pencil = (PencilMatrices){.symmetric = symmetric};
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, N, N, 7, NULL, 6, NULL, &pencil->K));
  PetscCall(MatGetOwnershipRange(pencil->K, &first, &last));
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (PetscInt i = 0; i < N; i++)
    for (PetscInt j = i; j < PetscMin(N, i + 4); j++) {
      PetscReal value[2];

      PetscCall(PetscRandomGetValueReal(random, &value[0]));
      PetscCall(PetscRandomGetValueReal(random, &value[1]));
      if (i >= first && i < last) PetscCall(MatSetValue(pencil->K, i, j, value[0] + (i == j ? 4 : 0), INSERT_VALUES));
      if (j != i && j >= first && j < last)
        PetscCall(MatSetValue(pencil->K, j, i, value[symmetric ? 0 : 1], INSERT_VALUES));
    }
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatAssemblyBegin(pencil->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(pencil->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatDuplicate(pencil->K, MAT_DO_NOT_COPY_VALUES, &pencil->M));
  PetscCall(MatZeroEntries(pencil->M));
  PetscCall(MatShift(pencil->M, 1));
  PetscFunctionReturn(0);
}

/* A dense matrix whose columns are `apart` entries apart beyond their length, filled with 7, gaps too */
static PetscErrorCode MakeDense(Mat A, PetscInt apart, PetscScalar **memory, Mat *D)
{
  PetscInt n, lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n, NULL));
  lda = n + apart;
  PetscCall(PetscMalloc1(lda * COLUMNS, memory));
  for (PetscInt i = 0; i < lda * COLUMNS; i++) (*memory)[i] = 7;
  PetscCall(MatCreate(PETSC_COMM_WORLD, D));
  PetscCall(MatSetSizes(*D, n, PETSC_DECIDE, N, COLUMNS));
  PetscCall(MatSetType(*D, MATDENSE));
  PetscCall(MatDenseSetLDA(*D, lda));
  PetscCall(MatSeqDenseSetPreallocation(*D, *memory));
  PetscCall(MatMPIDenseSetPreallocation(*D, *memory));
  PetscCall(MatAssemblyBegin(*D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*D, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* B = A X or A' X, column by column */
static PetscErrorCode Multiply(Mat A, PetscBool transposed, Mat X, Mat B)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < COLUMNS; j++) {
    Vec x, b;

    PetscCall(MatDenseGetColumnVecRead(X, j, &x));
    PetscCall(MatDenseGetColumnVecWrite(B, j, &b));
    PetscCall(transposed ? MatMultTranspose(A, x, b) : MatMult(A, x, b));
    PetscCall(MatDenseRestoreColumnVecWrite(B, j, &b));
    PetscCall(MatDenseRestoreColumnVecRead(X, j, &x));
  }
  PetscFunctionReturn(0);
}

/* Largest difference of two dense matrices, column by column */
static PetscErrorCode Difference(Mat X, Mat Y, PetscReal *largest)
{
  PetscFunctionBeginUser;
  *largest = 0;
  for (PetscInt j = 0; j < COLUMNS; j++) {
    PetscReal here;
    Vec       x, y, d;

    PetscCall(MatDenseGetColumnVecRead(X, j, &x));
    PetscCall(MatDenseGetColumnVecRead(Y, j, &y));
    PetscCall(VecDuplicate(x, &d));
    PetscCall(VecWAXPY(d, -1, x, y));
    PetscCall(VecNorm(d, NORM_INFINITY, &here));
    *largest = PetscMax(*largest, here);
    PetscCall(VecDestroy(&d));
    PetscCall(MatDenseRestoreColumnVecRead(Y, j, &y));
    PetscCall(MatDenseRestoreColumnVecRead(X, j, &x));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: MUMPS is handed columns that lie apart, which it takes for columns that follow one another; the right
   side is overwritten; factors for which MUMPS estimates too little workspace, here by -workspace percent, are an error
   instead of made with more */
static PetscErrorCode TestSolve(PetscBool symmetric, PetscBool transposed, PetscInt workspace, const PetscInt apart[2],
                                int *failed)
{
  PencilMatrices pencil;
  PetscScalar   *memory[4];
  PetscReal      worst[2];
  Progress       progress = {0};
  ShiftInvert    si       = {.progress = &progress, .workspace = workspace};
  Mat            B, Copy, X, Y;

  PetscFunctionBeginUser;
  PetscCall(MakePencil(symmetric, &pencil));
  PetscCall(ShiftInvertMove(&pencil, 0, &si));
  PetscCall(MakeDense(pencil.K, 2, &memory[0], &X));
  PetscCall(MakeDense(pencil.K, apart[0], &memory[1], &B));
  PetscCall(MakeDense(pencil.K, apart[1], &memory[2], &Y));
  PetscCall(MakeDense(pencil.K, 0, &memory[3], &Copy));
  PetscCall(MatSetRandom(X, NULL));
  PetscCall(Multiply(pencil.K, transposed, X, B));
  PetscCall(Multiply(pencil.K, transposed, X, Copy));
  PetscCall(ShiftInvertApplyBlock(&si, transposed, B, Y));
  PetscCall(Difference(X, Y, &worst[0]));
  PetscCall(Difference(B, Copy, &worst[1]));
  printf("     %s%s, columns %d and %d apart\n", symmetric ? "symmetric" : "unsymmetric",
         transposed ? ", transposed" : "", (int)apart[0], (int)apart[1]);
  *failed += CheckClose("largest error of X", worst[0], 0, 1e-12) + CheckClose("change of B", worst[1], 0, 0) +
             CheckTrue("workspace is raised where it fails", (si.workspace > workspace) == (workspace < 0), si.workspace);
  PetscCall(ShiftInvertDestroy(&si));
  for (int i = 0; i < 4; i++) PetscCall(MatDestroy((Mat *[]){&X, &B, &Y, &Copy}[i]));
  for (int i = 0; i < 4; i++) PetscCall(PetscFree(memory[i]));
  PetscCall(MatDestroy(&pencil.K));
  PetscCall(MatDestroy(&pencil.M));
  PetscFunctionReturn(0);
}

/* Breaks when: a library solves another system than it was given and nobody looks. Here the factors stay those of K while
   the matrix is changed in one entry of the last row. The same with
   right sides so large that the sums that tell overflow. */
static PetscErrorCode TestTrust(PetscReal size, int *failed)
{
  PencilMatrices pencil;
  PetscErrorCode error;
  PetscScalar   *memory[2];
  ShiftInvert    si;
  Progress       progress = {0};
  Mat            A, B, X;

  PetscFunctionBeginUser;
  PetscCall(MakePencil(PETSC_FALSE, &pencil));
  PetscCall(ShiftInvertCreate(&pencil, 0, PETSC_FALSE, &progress, &si));
  PetscCall(MakeDense(pencil.K, 0, &memory[0], &B));
  PetscCall(MakeDense(pencil.K, 0, &memory[1], &X));
  PetscCall(MatSetRandom(B, NULL));
  PetscCall(ShiftInvertApplyBlock(&si, PETSC_FALSE, B, X));
  PetscCall(MatScale(B, size));
  PetscCall(KSPGetOperators(si.ksp, &A, NULL));
  PetscCall(MatShift(A, 1e-3));
  PetscCall(ShiftInvertMakeTrial(&si));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = ShiftInvertApplyBlock(&si, PETSC_FALSE, B, X);
  PetscCall(PetscPopErrorHandler());
  *failed += CheckTrue("factors of another matrix are an error", error == PETSC_ERR_LIB, error);
  PetscCall(ShiftInvertDestroy(&si));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  for (int i = 0; i < 2; i++) PetscCall(PetscFree(memory[i]));
  PetscCall(MatDestroy(&pencil.K));
  PetscCall(MatDestroy(&pencil.M));
  PetscFunctionReturn(0);
}

/* Breaks when: PETSc's products with a sparse matrix, or a scaling of rows, trust that columns follow one another */
static PetscErrorCode TestProducts(int *failed)
{
  PencilMatrices pencil;
  PetscScalar   *memory[2];
  PetscReal      worst;
  Vec            d;
  Mat            X, B, AX;

  PetscFunctionBeginUser;
  PetscCall(MakePencil(PETSC_FALSE, &pencil));
  PetscCall(MakeDense(pencil.K, 5, &memory[0], &X));
  PetscCall(MakeDense(pencil.K, 3, &memory[1], &B));
  PetscCall(MatSetRandom(X, NULL));
  for (int transposed = 0; transposed < 2; transposed++) {
    PetscCall(Multiply(pencil.K, (PetscBool)transposed, X, B));
    PetscCall(transposed ? MatTransposeMatMult(pencil.K, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX)
                         : MatMatMult(pencil.K, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AX));
    PetscCall(Difference(B, AX, &worst));
    PetscCall(MatDestroy(&AX));
    *failed += CheckClose(transposed ? "A' X" : "A X", worst, 0, 1e-13);
  }
  PetscCall(MatCreateVecs(pencil.K, &d, NULL));
  PetscCall(VecSet(d, 3));
  PetscCall(MatCopy(X, B, SAME_NONZERO_PATTERN));
  PetscCall(MatDiagonalScale(B, d, NULL));
  PetscCall(MatScale(X, 3));
  PetscCall(Difference(B, X, &worst));
  *failed += CheckClose("rows scaled by a diagonal", worst, 0, 1e-15);
  PetscCall(VecDestroy(&d));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&B));
  for (int i = 0; i < 2; i++) PetscCall(PetscFree(memory[i]));
  PetscCall(MatDestroy(&pencil.K));
  PetscCall(MatDestroy(&pencil.M));
  PetscFunctionReturn(0);
}

/* p pairs: K = K_even + left' right, entries at random in rows that are spread over all unknowns */
static PetscErrorCode AddPairs(PetscInt p, PencilMatrices *pencil)
{
  Mat         LR;
  PetscRandom random;

  PetscFunctionBeginUser;
  pencil->K_even    = pencil->K;
  pencil->symmetric = PETSC_FALSE;
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (int side = 0; side < 2; side++) {
    Mat     *S = side ? &pencil->right : &pencil->left;
    PetscInt first, last, columns;

    PetscCall(MatGetLocalSize(pencil->K, NULL, &columns));
    PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, columns, p, N, 3, NULL, 3, NULL, S));
    PetscCall(MatGetOwnershipRange(*S, &first, &last));
    for (PetscInt i = 0; i < p; i++)
      for (PetscInt k = 0; k < 3; k++) {
        PetscReal value;

        PetscCall(PetscRandomGetValueReal(random, &value));
        if (i >= first && i < last)
          PetscCall(MatSetValue(*S, i, (37 * i + 61 * k + 7 * side) % N, value, INSERT_VALUES));
      }
    PetscCall(MatAssemblyBegin(*S, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(*S, MAT_FINAL_ASSEMBLY));
  }
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatTransposeMatMult(pencil->left, pencil->right, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &LR));
  PetscCall(MatDuplicate(pencil->K_even, MAT_COPY_VALUES, &pencil->K));
  PetscCall(MatAXPY(pencil->K, 1, LR, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&LR));
  PetscFunctionReturn(0);
}

/* Largest error of a solution in a block, and of its first column by itself, with K - shift M. The solution's columns lie
   apart, on several ranks on all but the first: ranks that do not agree about that wait for ever. */
static PetscErrorCode CheckUpdate(const PencilMatrices *pencil, const ShiftInvert *si, PetscReal shift, int *failed)
{
  PetscMPIInt  rank, size;
  PetscScalar *memory[3];
  PetscReal    worst;
  Mat          A, B, X, Y;
  Vec          b, x, y;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(pencil->K, MAT_COPY_VALUES, &A));
  PetscCall(MatAXPY(A, -shift, pencil->M, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MakeDense(A, 2, &memory[0], &X));
  PetscCall(MakeDense(A, 3, &memory[1], &B));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(MakeDense(A, size > 1 && rank == 0 ? 0 : 5, &memory[2], &Y));
  PetscCall(MatSetRandom(X, NULL));
  for (int transposed = 0; transposed < 2; transposed++) {
    PetscCall(Multiply(A, (PetscBool)transposed, X, B));
    PetscCall(ShiftInvertApplyBlock(si, (PetscBool)transposed, B, Y));
    PetscCall(Difference(X, Y, &worst));
    *failed += CheckClose(transposed ? "transposed, block" : "block", worst, 0, 1e-12);
    PetscCall(MatDenseGetColumnVecRead(B, 0, &b));
    PetscCall(MatDenseGetColumnVecRead(X, 0, &x));
    PetscCall(VecDuplicate(b, &y));
    PetscCall(ShiftInvertSolve(si, (PetscBool)transposed, b, y));
    PetscCall(VecAXPY(y, -1, x));
    PetscCall(VecNorm(y, NORM_INFINITY, &worst));
    *failed += CheckClose(transposed ? "transposed, alone" : "alone", worst, 0, 1e-12);
    PetscCall(VecDestroy(&y));
    PetscCall(MatDenseRestoreColumnVecRead(X, 0, &x));
    PetscCall(MatDenseRestoreColumnVecRead(B, 0, &b));
  }
  for (int i = 0; i < 4; i++) PetscCall(MatDestroy((Mat *[]){&A, &B, &X, &Y}[i]));
  for (int i = 0; i < 3; i++) PetscCall(PetscFree(memory[i]));
  PetscFunctionReturn(0);
}

/* Breaks when: the update is that of another shift or of other pairs; the transposed solution takes the wrong factor */
static PetscErrorCode TestUpdate(PetscInt p, PetscBool kept, int *failed)
{
  PencilMatrices pencil;
  ShiftInvert    si;
  Progress       progress = {0};

  PetscFunctionBeginUser;
  printf("     update for %d pairs\n", (int)p);
  PetscCall(MakePencil(PETSC_TRUE, &pencil));
  PetscCall(AddPairs(p, &pencil));
  pencil.prefers_even = PETSC_TRUE;
  PetscCall(ShiftInvertCreate(&pencil, 0, PETSC_FALSE, &progress, &si));
  *failed += CheckTrue("its vectors are kept", si.update && (si.update->Y != NULL) == kept, kept);
  PetscCall(CheckUpdate(&pencil, &si, 0, failed));
  PetscCall(ShiftInvertMove(&pencil, 0.7, &si));
  PetscCall(CheckUpdate(&pencil, &si, 0.7, failed));
  PetscCall(ShiftInvertDestroy(&si));
  for (int i = 0; i < 5; i++)
    PetscCall(MatDestroy((Mat *[]){&pencil.K, &pencil.K_even, &pencil.M, &pencil.left, &pencil.right}[i]));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  static const PetscInt apart[4][2] = {
    {0, 0},
    {5, 0},
    {0, 5},
    {5, 3}
  };
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(OrderingRegister());
  for (int i = 0; i < 4; i++) {
    PetscCall(TestSolve(PETSC_TRUE, PETSC_FALSE, 0, apart[i], &failed));
    PetscCall(TestSolve(PETSC_FALSE, PETSC_FALSE, 0, apart[i], &failed));
    PetscCall(TestSolve(PETSC_FALSE, PETSC_TRUE, 0, apart[i], &failed));
  }
  PetscCall(TestSolve(PETSC_FALSE, PETSC_FALSE, -90, apart[0], &failed));
  PetscCall(TestUpdate(2, PETSC_TRUE, &failed));
  PetscCall(TestUpdate(40, PETSC_FALSE, &failed));
  PetscCall(TestTrust(1, &failed));
  PetscCall(TestTrust(1e160, &failed));
  PetscCall(TestProducts(&failed));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
