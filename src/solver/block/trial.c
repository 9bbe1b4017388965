/*
   Whether solutions are those of the systems that were given, for all columns of a block at the price of a few dot
   products (R. Freivalds, Probabilistic machines can use less running time, IFIP Congress 1977). For a vector w at
   random

      w'(A x - b) = (A' w)'x - w'b

   is zero for a solution, and for another vector zero by chance alone. A' w, and A w for the transposed problem, are
   made once for a factorisation. What is measured is the difference beside |A' w| |x| + |w| |b|: 1e-16 is usual.
*/
#include "solver/factor/lowrank.h"
#include "solver/factor/shiftinvert.h"
#include <petscblaslapack.h>
#include <math.h>

#define TRIAL_TRUST 1e-8 /* largest difference; another column or another matrix leaves more than 1e-5 */

/* trial = w, A' w and A w, with what the update adds; the entries of w lie in [-1/2, 1/2]. MatMultTranspose() is
   saved where A is symmetric. */
PetscErrorCode ShiftInvertMakeTrial(ShiftInvert *si)
{
  Mat A;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertDestroyTrial(si));
  PetscCall(KSPGetOperators(si->ksp, &A, NULL));
  PetscCall(MatCreateVecs(A, &si->trial[0], NULL));
  for (int i = 1; i < 3; i++) PetscCall(VecDuplicate(si->trial[0], &si->trial[i]));
  PetscCall(VecSetRandom(si->trial[0], NULL));
  PetscCall(VecShift(si->trial[0], -0.5));
  PetscCall(MatMult(A, si->trial[0], si->trial[2]));
  if (si->even)
    PetscCall(VecCopy(si->trial[2], si->trial[1]));
  else
    PetscCall(MatMultTranspose(A, si->trial[0], si->trial[1]));
  for (int i = 1; i < 3 && si->update; i++)
    PetscCall(LowRankMultAdd(si->update, i == 1 ? PETSC_TRUE : PETSC_FALSE, si->trial[0], si->trial[i]));
  for (int i = 0; i < 3; i++) PetscCall(VecNorm(si->trial[i], NORM_2, &si->length[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftInvertDestroyTrial(ShiftInvert *si)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) PetscCall(VecDestroy(&si->trial[i]));
  PetscFunctionReturn(0);
}

/* v'x and x'x of the columns first .. last - 1, local rows */
static PetscErrorCode TrialColumns(Vec v, PetscInt first, PetscInt last, Mat X, PetscScalar sums[][2])
{
  const PetscBLASInt one = 1;
  const PetscScalar *x, *w;
  PetscInt           n, stride;
  PetscBLASInt       rows;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(v, &n));
  PetscCall(PetscBLASIntCast(n, &rows));
  PetscCall(MatDenseGetLDA(X, &stride));
  PetscCall(VecGetArrayRead(v, &w));
  PetscCall(MatDenseGetArrayRead(X, &x));
  for (PetscInt j = first; j < last; j++) {
    sums[j][0] = BLASdot_(&rows, w, &one, &x[j * stride], &one);
    sums[j][1] = BLASdot_(&rows, &x[j * stride], &one, &x[j * stride], &one);
  }
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscCall(VecRestoreArrayRead(v, &w));
  PetscFunctionReturn(0);
}

/* Two dot products a column, one reduction of 2 n numbers for the block. */
PetscErrorCode TrialSums(const ShiftInvert *si, PetscBool solution, PetscInt n_right, Mat X, PetscScalar sums[][2])
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  PetscCall(TrialColumns(si->trial[solution ? 1 : 0], 0, n_right, X, sums));
  PetscCall(TrialColumns(si->trial[solution ? 2 : 0], n_right, n, X, sums));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(2 * n), MPIU_SCALAR, MPIU_SUM, si->comm));
  PetscFunctionReturn(0);
}

/* Dot products are alike on all ranks: all raise the error, or none. NaN fails the comparison. */
PetscErrorCode TrialCheck(const ShiftInvert *si, PetscInt n_right, PetscInt n, PetscScalar b[][2], PetscScalar x[][2])
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal difference = PetscAbsReal(x[j][0] - b[j][0]);
    const PetscReal size =
      si->length[j < n_right ? 1 : 2] * PetscSqrtReal(x[j][1]) + si->length[0] * PetscSqrtReal(b[j][1]);

    PetscCheck(isfinite(size) && difference <= TRIAL_TRUST * size, si->comm, PETSC_ERR_LIB,
               "MUMPS solved %" PetscInt_FMT
               " systems at once with an error of %.2g beside their size, where %.0g is the "
               "most to trust: this PETSc and MUMPS do not do what squeal takes for granted; scripts/test shiftinvert "
               "says more",
               n, (double)(difference / size), TRIAL_TRUST);
  }
  PetscFunctionReturn(0);
}
