/*
   Solves with many right-hand sides at once. PETSc hands the array of a dense matrix to MUMPS as it is and MUMPS takes
   each column to begin where the one before ends, so columns that lie apart in memory (leading dimension above the local
   rows, as in the matrices of BVGetMat() since SLEPc 3.20) would be answered wrongly without a word. They are copied
   here. What a library does otherwise than assumed shows in the last column (of a right and a left block that are solved
   together in the last one of either in turn), whose backward error

      |A x - b| / (|A|_F |x| + |b|)

   is measured in every block; 1e-16 is usual.
*/
#include "base/events.h"
#include "lowrank.h"
#include "shiftinvert.h"

#define BLOCK_TRUST 1e-8 /* largest backward error; another column or another matrix leaves more than 1e-5 */

/* A itself, or on all ranks a matrix of its size whose columns follow one another, with A's values where copy asks */
static PetscErrorCode BlockPack(Mat A, PetscBool copy, Mat *packed)
{
  PetscInt  n_local, n, n_columns, lda;
  PetscBool apart;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n_local, &n));
  PetscCall(MatGetSize(A, NULL, &n_columns));
  PetscCall(MatDenseGetLDA(A, &lda));
  apart = n_local && lda != n_local ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &apart, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)A)));
  if (!apart) {
    PetscCall(PetscObjectReference((PetscObject)A));
    *packed = A;
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)A), n_local, n, PETSC_DETERMINE, n_columns, NULL, packed));
  if (copy) PetscCall(MatCopy(A, *packed, SAME_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

/* Raises an error where column k of X does not solve the system */
static PetscErrorCode BlockCheck(const ShiftInvert *si, PetscBool transposed, PetscInt k, Mat B, Mat X)
{
  PetscReal residual, size_x, size_b, backward;
  PetscInt  n;
  Mat       A;
  Vec       b, x, r;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(si->ksp, &A, NULL));
  PetscCall(MatGetSize(B, NULL, &n));
  PetscCall(MatDenseGetColumnVecRead(B, k, &b));
  PetscCall(MatDenseGetColumnVecRead(X, k, &x));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(transposed && !si->even ? MatMultTranspose(A, x, r) : MatMult(A, x, r));
  if (si->update) PetscCall(LowRankMultAdd(si->update, transposed, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &residual));
  PetscCall(VecNorm(x, NORM_2, &size_x));
  PetscCall(VecNorm(b, NORM_2, &size_b));
  PetscCall(VecDestroy(&r));
  PetscCall(MatDenseRestoreColumnVecRead(X, k, &x));
  PetscCall(MatDenseRestoreColumnVecRead(B, k, &b));
  backward = residual > 0 ? residual / (si->size * size_x + size_b) : residual;
  PetscCheck(backward <= BLOCK_TRUST, si->comm, PETSC_ERR_LIB,
             "MUMPS solved %" PetscInt_FMT " systems at once with a backward error of %.2g, where %.0g is the most to "
             "trust: this PETSc and MUMPS do not do what squeal takes for granted; scripts/test shiftinvert says more",
             n, (double)backward, BLOCK_TRUST);
  PetscFunctionReturn(0);
}

/* Column by column, for solvers other than a factorisation */
static PetscErrorCode BlockApplyColumns(KSP ksp, PetscBool transposed, Mat B, Mat X)
{
  const ShiftInvert si = {.comm = PetscObjectComm((PetscObject)ksp), .ksp = ksp};
  PetscInt          n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    Vec b, x;

    PetscCall(MatDenseGetColumnVecRead(B, j, &b));
    PetscCall(MatDenseGetColumnVecWrite(X, j, &x));
    PetscCall(ShiftInvertSolve(&si, transposed, b, x));
    PetscCall(MatDenseRestoreColumnVecWrite(X, j, &x));
    PetscCall(MatDenseRestoreColumnVecRead(B, j, &b));
  }
  PetscFunctionReturn(0);
}

/* Counts the columns of a block one by one, since -log_view knows a block as one event */
static PetscErrorCode BlockCount(Mat B)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(EventBegin(EVENT_COLUMN));
    PetscCall(EventEnd(EVENT_COLUMN));
  }
  PetscFunctionReturn(0);
}

/* All columns at once by the factors */
static PetscErrorCode BlockApplyFactor(Mat F, PetscBool transposed, Mat B, Mat X)
{
  Mat right, answer;

  PetscFunctionBeginUser;
  PetscCall(BlockPack(B, PETSC_TRUE, &right));
  PetscCall(BlockPack(X, PETSC_FALSE, &answer));
  PetscCall(transposed ? MatMatSolveTranspose(F, right, answer) : MatMatSolve(F, right, answer));
  PetscCall(BlockCount(right));
  if (answer != X) PetscCall(MatCopy(answer, X, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&right));
  PetscCall(MatDestroy(&answer));
  PetscFunctionReturn(0);
}

/* The factors that a solver works with, NULL where it is another solver */
static PetscErrorCode BlockGetFactor(KSP ksp, Mat *F)
{
  PetscBool direct, factored;
  PC        pc;

  PetscFunctionBeginUser;
  *F = NULL;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &direct));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &factored, PCLU, PCCHOLESKY, ""));
  if (direct && factored) PetscCall(PCFactorGetMatrix(pc, F));
  PetscFunctionReturn(0);
}

/* X = A^-1 B by the solver of the matrix that is factored */
static PetscErrorCode BlockSolve(KSP ksp, PetscBool transposed, Mat B, Mat X)
{
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor(ksp, &F));
  PetscCall(F ? BlockApplyFactor(F, transposed, B, X) : BlockApplyColumns(ksp, transposed, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertSolvesRows(KSP ksp, PetscBool *solves)
{
  PetscMPIInt   size;
  MatSolverType type;
  Mat           F;

  PetscFunctionBeginUser;
  *solves = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)ksp), &size));
  PetscCall(BlockGetFactor(ksp, &F));
  if (size > 1 || !F) PetscFunctionReturn(0);
  PetscCall(MatFactorGetSolverType(F, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, solves));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyRows(void *ctx, Mat rows, Mat X)
{
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor((KSP)ctx, &F));
  PetscCall(MatMatTransposeSolve(F, rows, X));
  PetscCall(BlockCount(X));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyFactors(void *ctx, Mat B, Mat X)
{
  PetscFunctionBeginUser;
  PetscCall(BlockSolve((KSP)ctx, PETSC_FALSE, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyBlock(const ShiftInvert *si, PetscBool transposed, Mat B, Mat X)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  PetscCall(EventBegin(EVENT_SOLVE));
  PetscCall(si->update ? LowRankApply(si->update, transposed ? 0 : n, B, X) : BlockSolve(si->ksp, transposed, B, X));
  PetscCall(BlockCheck(si, transposed, n - 1, B, X));
  PetscCall(EventEnd(EVENT_SOLVE));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyBoth(void *ctx, PetscInt n_right, Mat B, Mat X)
{
  ShiftInvert *si = ctx;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  PetscCall(EventBegin(EVENT_SOLVE));
  PetscCall(LowRankApply(si->update, n_right, B, X));
  PetscCall(BlockCheck(si, si->turn, si->turn ? n - 1 : n_right - 1, B, X));
  si->turn = !si->turn;
  PetscCall(EventEnd(EVENT_SOLVE));
  PetscCall(ShiftInvertStepped(si, n));
  PetscFunctionReturn(0);
}
