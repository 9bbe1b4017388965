/*
   Errors of free modes by the Ritz method.

   The residual r = (K - kappa M) phi is a force where the tails are, and kappa is too large by what it deforms,

      r' (K - kappa M)^-1 r,  about FOUND_SOFT r' D^-1 r,  D = diag K.

   Without the factor that is 0.05 to 0.7 of it, on massi2005.yaml and brake.yaml at all free modes. Two free modes are
   mixed by as much over the distance of their kappa.
*/
#include "components.h"

#define FOUND_SOFT 30 /* what a force deforms beyond its own unknown */

/* The diagonal of K of the bodies */
static PetscErrorCode DiagonalTake(const FreeMatrices *bodies, Vec *d)
{
  Vec less;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(bodies->K, NULL, d));
  PetscCall(MatGetDiagonal(bodies->K, *d));
  if (!bodies->less) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(*d, &less));
  PetscCall(MatGetDiagonal(bodies->less, less));
  PetscCall(VecAXPY(*d, 1, less));
  PetscCall(VecDestroy(&less));
  PetscFunctionReturn(0);
}

/* d = about the diagonal of K where nothing follows, Z NULL, or of Z'K Z: sum_k K_kk Z_ki^2 */
static PetscErrorCode DiagonalFind(const FreeMatrices *bodies, Mat Z, Vec *d)
{
  const PetscScalar *k, *z;
  const PetscInt    *column;
  PetscInt           first, last, n;
  Vec                all;

  PetscFunctionBeginUser;
  PetscCall(DiagonalTake(bodies, &all));
  *d = all;
  if (!Z) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(Z, d, NULL));
  PetscCall(VecSet(*d, 0));
  PetscCall(MatGetOwnershipRange(Z, &first, &last));
  PetscCall(VecGetArrayRead(all, &k));
  for (PetscInt i = first; i < last; i++) {
    PetscCall(MatGetRow(Z, i, &n, &column, &z));
    for (PetscInt j = 0; j < n; j++) PetscCall(VecSetValue(*d, column[j], k[i - first] * z[j] * z[j], ADD_VALUES));
    PetscCall(MatRestoreRow(Z, i, &n, &column, &z));
  }
  PetscCall(VecRestoreArrayRead(all, &k));
  PetscCall(VecAssemblyBegin(*d));
  PetscCall(VecAssemblyEnd(*d));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

/* r' D^-1 r of r = K phi - kappa M phi, which takes the place of K phi, where followers hand their forces on, Z' r */
static PetscErrorCode ResidualWeigh(Vec K_phi, Vec M_phi, PetscReal kappa, Mat Z, Vec d, PetscReal *sum)
{
  const PetscScalar *r, *weight;
  PetscInt           n;
  Vec                q = K_phi;

  PetscFunctionBeginUser;
  PetscCall(VecAXPY(K_phi, -kappa, M_phi));
  if (Z) PetscCall(VecDuplicate(d, &q));
  if (Z) PetscCall(MatMultTranspose(Z, K_phi, q));
  PetscCall(VecGetLocalSize(q, &n));
  PetscCall(VecGetArrayRead(q, &r));
  PetscCall(VecGetArrayRead(d, &weight));
  for (PetscInt i = 0; i < n; i++)
    if (weight[i] > 0) *sum += r[i] * r[i] / weight[i];
  PetscCall(VecRestoreArrayRead(d, &weight));
  PetscCall(VecRestoreArrayRead(q, &r));
  if (Z) PetscCall(VecDestroy(&q));
  PetscFunctionReturn(0);
}

PetscErrorCode FoundJudge(const FreeMatrices *bodies, Mat Z, Mat F, PetscInt n, FoundMode found[])
{
  PetscReal *sums; /* [n] r' D^-1 r */
  PetscInt   columns;
  Mat        AF[2];
  Vec        d;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(F, NULL, &columns));
  if (!columns) PetscFunctionReturn(0);
  for (int k = 0; k < 2; k++) PetscCall(MatDuplicate(F, MAT_DO_NOT_COPY_VALUES, &AF[k]));
  PetscCall(FreeMatricesMultiply(bodies, F, AF));
  PetscCall(DiagonalFind(bodies, Z, &d));
  PetscCall(PetscCalloc1(n, &sums));
  for (PetscInt j = 0; j < n; j++) {
    Vec       phi, K_phi, M_phi;
    PetscReal kappa = found[j].kappa;
    PetscInt  k     = found[j].column;

    if (found[j].rigid) continue;
    PetscCall(MatDenseGetColumnVecRead(F, k, &phi));
    PetscCall(MatDenseGetColumnVec(AF[1], k, &K_phi));
    PetscCall(MatDenseGetColumnVecRead(AF[0], k, &M_phi));
    PetscCall(VecDot(phi, K_phi, &found[j].kappa));
    found[j].error = PetscAbsReal(found[j].kappa - kappa);
    PetscCall(ResidualWeigh(K_phi, M_phi, kappa, Z, d, &sums[j]));
    PetscCall(MatDenseRestoreColumnVecRead(AF[0], k, &M_phi));
    PetscCall(MatDenseRestoreColumnVec(AF[1], k, &K_phi));
    PetscCall(MatDenseRestoreColumnVecRead(F, k, &phi));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)F)));
  for (PetscInt j = 0; j < n; j++) found[j].error += FOUND_SOFT * sums[j];
  PetscCall(PetscFree(sums));
  PetscCall(VecDestroy(&d));
  for (int k = 0; k < 2; k++) PetscCall(MatDestroy(&AF[k]));
  PetscFunctionReturn(0);
}
