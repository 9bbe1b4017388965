/*
   Solves with many right-hand sides at once. PETSc hands the array of a dense matrix to MUMPS as it is and MUMPS takes
   each column to begin where the one before ends, so columns that lie apart in memory (leading dimension above the
   local rows, as in the matrices of BVGetMat() since SLEPc 3.20) would be answered wrongly without a word. They are
   copied here. What a library does otherwise than assumed shows in the check of trial.c, which every block passes.
*/
#include "base/events.h"
#include "solver/factor/lowrank.h"
#include "solver/factor/shiftinvert.h"

#define BLOCK_MUMPS 32 /* columns that MUMPS takes at once by itself, ICNTL(27) */
/* Columns at once: 48 of them take a fifth less time so than in two passes by 32. */
#define BLOCK_WIDE 64

/* Whether columns lie apart on any rank: SLEPc rounds the leading dimension up, which some local rows need not. All
   ranks must take the same way, as what follows is collective. */
static PetscErrorCode BlockIsApart(Mat A, PetscBool *apart)
{
  PetscInt n_local, lda;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n_local, NULL));
  PetscCall(MatDenseGetLDA(A, &lda));
  *apart = n_local && lda != n_local ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, apart, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)A)));
  PetscFunctionReturn(0);
}

/* A itself, or on all ranks a matrix of its size whose columns follow one another, with A's values where copy asks */
static PetscErrorCode BlockPack(Mat A, PetscBool copy, Mat *packed)
{
  PetscInt  n_local, n, n_columns;
  PetscBool apart;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(A, &n_local, &n));
  PetscCall(MatGetSize(A, NULL, &n_columns));
  PetscCall(BlockIsApart(A, &apart));
  if (!apart) {
    PetscCall(PetscObjectReference((PetscObject)A));
    *packed = A;
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)A), n_local, n, PETSC_DETERMINE, n_columns, NULL, packed));
  if (copy) PetscCall(MatCopy(A, *packed, SAME_NONZERO_PATTERN));
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

/* Whether factors are those of MUMPS */
static PetscErrorCode BlockIsMumps(Mat F, PetscBool *is_mumps)
{
  MatSolverType type;

  PetscFunctionBeginUser;
  *is_mumps = PETSC_FALSE;
  if (!F) PetscFunctionReturn(0);
  PetscCall(MatFactorGetSolverType(F, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, is_mumps));
  PetscFunctionReturn(0);
}

/* Has MUMPS take more columns at once than its own 32 (ICNTL(27) of the MUMPS Users' guide), where there are more
   and nobody says how many. */
static PetscErrorCode BlockWiden(Mat F, Mat B)
{
  PetscInt    n;
  PetscBool   is_mumps, given;
  const char *prefix;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  PetscCall(BlockIsMumps(F, &is_mumps));
  if (n <= BLOCK_MUMPS || !is_mumps) PetscFunctionReturn(0);
  PetscCall(MatGetOptionsPrefix(F, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-mat_mumps_icntl_27", &given));
  if (!given) PetscCall(MatMumpsSetIcntl(F, 27, BLOCK_WIDE));
  PetscFunctionReturn(0);
}

/* All columns at once by the factors */
static PetscErrorCode BlockApplyFactor(Mat F, PetscBool transposed, Mat B, Mat X)
{
  Mat right, answer;

  PetscFunctionBeginUser;
  PetscCall(BlockPack(B, PETSC_TRUE, &right));
  PetscCall(BlockPack(X, PETSC_FALSE, &answer));
  PetscCall(BlockWiden(F, right));
  if (transposed)
    PetscCall(MatMatSolveTranspose(F, right, answer));
  else
    PetscCall(MatMatSolve(F, right, answer));
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

PetscErrorCode ShiftInvertGetFactors(KSP ksp, Mat *F, PetscBool *is_mumps)
{
  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor(ksp, F));
  PetscCall(BlockIsMumps(*F, is_mumps));
  PetscFunctionReturn(0);
}

/* X = A^-1 B by the solver of the matrix that is factored */
static PetscErrorCode BlockSolve(KSP ksp, PetscBool transposed, Mat B, Mat X)
{
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor(ksp, &F));
  if (F)
    PetscCall(BlockApplyFactor(F, transposed, B, X));
  else
    PetscCall(BlockApplyColumns(ksp, transposed, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertSolvesRows(KSP ksp, PetscBool *solves)
{
  PetscMPIInt size;
  Mat         F;

  PetscFunctionBeginUser;
  *solves = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)ksp), &size));
  if (size == 1) PetscCall(ShiftInvertGetFactors(ksp, &F, solves));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyRows(void *ctx, Mat rows, Mat X)
{
  Mat F;

  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor((KSP)ctx, &F));
  PetscCall(BlockWiden(F, X));
  PetscCall(MatMatTransposeSolve(F, rows, X));
  PetscCall(BlockCount(X));
  PetscFunctionReturn(0);
}

/* B = X, or for factors of MUMPS, which copy the right-hand side into the solution first, a matrix on the array of
   X: no second block then. Others read B while they write X. */
static PetscErrorCode BlockRightSide(Mat F, Mat X, Mat *B)
{
  PetscInt     n_local, n_rows, n;
  PetscScalar *x;
  PetscBool    is_mumps, apart;

  PetscFunctionBeginUser;
  PetscCall(BlockIsMumps(F, &is_mumps));
  PetscCall(MatGetLocalSize(X, &n_local, NULL));
  PetscCall(MatGetSize(X, &n_rows, &n));
  PetscCall(BlockIsApart(X, &apart));
  if (!is_mumps || apart) {
    PetscCall(MatDuplicate(X, MAT_COPY_VALUES, B));
    PetscFunctionReturn(0);
  }
  PetscCall(MatDenseGetArray(X, &x));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)X), n_local, PETSC_DECIDE, n_rows, n, x, B));
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertApplyFactors(void *ctx, Mat X)
{
  Mat F, B;

  PetscFunctionBeginUser;
  PetscCall(BlockGetFactor((KSP)ctx, &F));
  PetscCall(BlockRightSide(F, X, &B));
  PetscCall(BlockSolve((KSP)ctx, PETSC_FALSE, B, X));
  PetscCall(MatDestroy(&B));
  PetscFunctionReturn(0);
}

/* With an update all columns are of one side: n_right of them right ones, or none where transposed. The sums of the
   check are taken of B before X is written, which may be the same array. */
PetscErrorCode ShiftInvertApplyBlock(const ShiftInvert *si, PetscBool transposed, Mat B, Mat X)
{
  PetscInt n, n_right;
  PetscScalar(*b)[2], (*x)[2];

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(B, NULL, &n));
  n_right = transposed ? 0 : n;
  PetscCall(PetscMalloc2(n, &b, n, &x));
  PetscCall(EventBegin(EVENT_SOLVE));
  PetscCall(TrialSums(si, PETSC_FALSE, n_right, B, b));
  if (si->update) PetscCall(MatCopy(B, X, SAME_NONZERO_PATTERN));
  if (si->update)
    PetscCall(LowRankApply(si->update, n_right, X));
  else
    PetscCall(BlockSolve(si->ksp, transposed, B, X));
  PetscCall(TrialSums(si, PETSC_TRUE, n_right, X, x));
  PetscCall(TrialCheck(si, n_right, n, b, x));
  PetscCall(EventEnd(EVENT_SOLVE));
  PetscCall(PetscFree2(b, x));
  PetscFunctionReturn(0);
}

/* X = Z (Z'A Z)^-1 Z'B, A being the matrix of the followed unknowns already. */
PetscErrorCode ShiftInvertApplyThrough(const ShiftInvert *si, Mat Z, Mat B, Mat X)
{
  Mat from, to, full;

  PetscFunctionBeginUser;
  if (!Z) {
    PetscCall(ShiftInvertApplyBlock(si, PETSC_FALSE, B, X));
    PetscFunctionReturn(0);
  }
  PetscCall(MatTransposeMatMult(Z, B, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &from));
  PetscCall(MatDuplicate(from, MAT_DO_NOT_COPY_VALUES, &to));
  PetscCall(ShiftInvertApplyBlock(si, PETSC_FALSE, from, to));
  PetscCall(MatMatMult(Z, to, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &full));
  PetscCall(MatCopy(full, X, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&full));
  PetscCall(MatDestroy(&from));
  PetscCall(MatDestroy(&to));
  PetscFunctionReturn(0);
}

/* X in place. One block of right-hand sides for both problems: the factors are read once. */
PetscErrorCode ShiftInvertApplyBoth(void *ctx, PetscInt n_right, Mat X)
{
  const ShiftInvert *si = ctx;
  PetscInt           n;
  PetscScalar(*b)[2], (*x)[2];

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(PetscMalloc2(n, &b, n, &x));
  PetscCall(EventBegin(EVENT_SOLVE));
  PetscCall(TrialSums(si, PETSC_FALSE, n_right, X, b));
  PetscCall(LowRankApply(si->update, n_right, X));
  PetscCall(TrialSums(si, PETSC_TRUE, n_right, X, x));
  PetscCall(TrialCheck(si, n_right, n, b, x));
  PetscCall(EventEnd(EVENT_SOLVE));
  PetscCall(PetscFree2(b, x));
  PetscCall(ShiftInvertStepped(si, n));
  PetscFunctionReturn(0);
}
