/*
   Entries of the inverse of the matrix that is factored, a_ij = e_i' A^-1 e_j for some rows i and columns j, by MUMPS
   (ICNTL(30)): of each substitution it goes through the parts of the factors alone that lie between these unknowns and
   the root of the elimination tree (P. Amestoy, I. Duff, J.-Y. L'Excellent, Y. Robert, F.-H. Rouet, B. Ucar, On
   computing inverse entries of a sparse matrix in an out-of-core environment, SIAM J. Sci. Comput. 34, 2012).
*/
#include "lowrank.h"
#include "shiftinvert.h"

#define INVERSE_TOGETHER (-128) /* columns that MUMPS takes at once at most, as it reads negative numbers */

/* The pattern of what is asked for, [n][n], with row j for column j of the inverse, all of it on the first rank */
static PetscErrorCode InversePattern(MPI_Comm comm, PetscInt n, const InverseBlock *b, Mat *T)
{
  PetscMPIInt  rank;
  PetscInt    *n_row;
  PetscScalar *zeros;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatCreate(comm, T));
  PetscCall(MatSetSizes(*T, rank ? 0 : n, rank ? 0 : n, n, n));
  PetscCall(MatSetType(*T, MATAIJ));
  PetscCall(PetscCalloc1(rank ? 0 : n, &n_row));
  for (PetscInt j = 0; j < b->n_columns && !rank; j++) n_row[b->column[j]] = b->n_rows;
  PetscCall(MatSeqAIJSetPreallocation(*T, 0, n_row));
  PetscCall(MatMPIAIJSetPreallocation(*T, 0, n_row, 0, NULL));
  PetscCall(PetscFree(n_row));
  PetscCall(PetscCalloc1(b->n_rows, &zeros));
  for (PetscInt j = 0; j < b->n_columns && !rank; j++)
    PetscCall(MatSetValues(*T, 1, &b->column[j], b->n_rows, b->row, zeros, INSERT_VALUES));
  PetscCall(PetscFree(zeros));
  PetscCall(MatAssemblyBegin(*T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*T, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* MUMPS fills the values of T; what it is told for that, ICNTL(20), (21), (27) and (30), is as before afterwards,
   since later solves read it. */
static PetscErrorCode InverseFill(Mat F, Mat T)
{
  static const PetscInt told[] = {20, 21, 27, 30};
  PetscInt              before[PETSC_STATIC_ARRAY_LENGTH(told)];
  Mat                   S;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(told); i++) PetscCall(MatMumpsGetIcntl(F, told[i], &before[i]));
  PetscCall(MatMumpsSetIcntl(F, 27, INVERSE_TOGETHER));
  PetscCall(MatCreateTranspose(T, &S));
  PetscCall(MatMumpsGetInverse(F, S));
  PetscCall(MatDestroy(&S));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(told); i++) PetscCall(MatMumpsSetIcntl(F, told[i], before[i]));
  PetscFunctionReturn(0);
}

/* Whether entries can be had: MUMPS alone gives them, and not of block low-rank factors, ICNTL(35). */
PetscErrorCode ShiftInvertGivesInverse(KSP ksp, PetscBool *gives)
{
  PetscInt low_rank;
  Mat      F;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertGetFactors(ksp, &F, gives));
  if (!*gives) PetscFunctionReturn(0);
  PetscCall(MatMumpsGetIcntl(F, 35, &low_rank));
  if (low_rank) *gives = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Collective; a [n_columns][n_rows] on the first rank. Row j of T holds column j of the inverse, whose transpose
   MatMumpsGetInverse() asks for. */
PetscErrorCode ShiftInvertGetInverse(void *ctx, const InverseBlock *b)
{
  const KSP          ksp  = ctx;
  const MPI_Comm     comm = PetscObjectComm((PetscObject)ksp);
  const PetscScalar *a;
  PetscMPIInt        rank, size;
  PetscInt           n;
  PetscBool          is_mumps;
  Mat                F, T, local;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(ShiftInvertGetFactors(ksp, &F, &is_mumps));
  PetscCall(MatGetSize(F, &n, NULL));
  PetscCall(InversePattern(comm, n, b, &T));
  PetscCall(InverseFill(F, T));
  local = T;
  if (size > 1) PetscCall(MatMPIAIJGetSeqAIJ(T, &local, NULL, NULL));
  PetscCall(MatSeqAIJGetArrayRead(local, &a)); /* row after row, as they were asked for */
  if (!rank) PetscCall(PetscArraycpy(b->a, a, b->n_rows * b->n_columns));
  PetscCall(MatSeqAIJRestoreArrayRead(local, &a));
  PetscCall(MatDestroy(&T));
  PetscFunctionReturn(0);
}
