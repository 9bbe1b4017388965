/*
   The left null vectors Y of K, Y'K = 0, by which decays of rigid motions are corrected (rigid/decays.c), from the
   basis and the factors of P = K - s M that a projection has: factors far below all elastic modes, which NullFactor()
   makes, take a tenth of a damped run. With Y = V Z,

      Z' V'K V = 0   by inverse iteration,   V := [V, P^-T K'Y]   until |K'Y| / (|K| |Y|) falls no more:

   V has the left modes of the window, so that what is wrong in Y lies beyond it, where P^-T makes it smaller.
*/
#include "projection.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"

#define NULL_STEPS    8
#define NULL_ROUNDS   4
#define NULL_NEW      1e-6  /* of a correction: what the basis has not */
#define NULL_FALLS    0.5   /* of the error before: another round */
#define NULL_SUFFICES 1e-14 /* error from which on the vectors will do, as those of NullIterate() */
#define NULL_BEST     1e-16 /* error that is rounding of the products with K */

/* Makes the vectors Z [n][k] orthonormal in V'M V */
static void SmallOrthonormalise(PetscInt k, PetscInt n, const PetscReal M[], PetscReal Z[], PetscReal MZ[])
{
  for (PetscInt j = 0; j < n; j++)
    for (int pass = 0; pass < 3; pass++) {
      PetscReal *z = &Z[j * k], *Mz = &MZ[j * k], square = 0;

      for (PetscInt r = 0; r < k; r++) Mz[r] = 0;
      for (PetscInt c = 0; c < k; c++)
        for (PetscInt r = 0; r < k; r++) Mz[r] += M[c * k + r] * z[c];
      for (PetscInt i = 0; i < j && pass < 2; i++) {
        PetscReal dot = 0;

        for (PetscInt r = 0; r < k; r++) dot += Mz[r] * Z[i * k + r];
        for (PetscInt r = 0; r < k; r++) z[r] -= dot * Z[i * k + r];
      }
      if (pass < 2) continue;
      for (PetscInt r = 0; r < k; r++) square += z[r] * Mz[r];
      for (PetscInt r = 0; r < k; r++) z[r] /= PetscSqrtReal(square), Mz[r] /= PetscSqrtReal(square);
    }
}

/* Z [n][k] by inverse iteration about -(10 scale)^2, those of rank 0 on all; singular = that is an eigenvalue */
static PetscErrorCode SmallNull(const Projection *p, PetscInt n, PetscReal Z[], PetscBool *singular)
{
  const PetscInt   k = p->space.n;
  const PetscReal *K = p->space.term[SUBSPACE_K].small, *M = p->space.term[SUBSPACE_M].small;
  PetscReal       *S, *MZ;
  PetscBLASInt    *pivot;
  PetscMPIInt      count;
  PetscRandom      random;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(k * k, &S, n * k, &MZ, k, &pivot));
  for (PetscInt i = 0; i < k * k; i++) S[i] = K[i] + PetscSqr(10 * p->window->known.scale) * M[i];
  PetscCall(DenseFactor(k, S, pivot, singular));
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (PetscInt i = 0; i < n * k; i++) PetscCall(PetscRandomGetValue(random, &Z[i]));
  PetscCall(PetscRandomDestroy(&random));
  SmallOrthonormalise(k, n, M, Z, MZ);
  for (int step = 0; step < NULL_STEPS && !*singular; step++) {
    PetscCall(PetscArraycpy(Z, MZ, n * k));
    PetscCall(DenseSolve(k, S, pivot, PETSC_TRUE, n, Z));
    SmallOrthonormalise(k, n, M, Z, MZ);
  }
  PetscCall(PetscFree3(S, MZ, pivot));
  PetscCall(PetscMPIIntCast(n * k, &count));
  PetscCallMPI(MPI_Bcast(Z, count, MPIU_REAL, 0, p->modes->comm));
  PetscCallMPI(MPI_Bcast(singular, 1, MPIU_BOOL, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* R = K'Y; *worst = the largest |K'y| / (|K| |y|) */
static PetscErrorCode NullResiduals(const Projection *p, PetscInt n, BV Y, BV R, PetscReal *worst)
{
  PetscFunctionBeginUser;
  *worst = 0;
  for (PetscInt j = 0; j < n; j++) {
    PetscReal length, residual;
    Vec       y, r;

    PetscCall(BVGetColumn(Y, j, &y));
    PetscCall(BVGetColumn(R, j, &r));
    PetscCall(MatMultTranspose(p->pencil->K, y, r));
    PetscCall(VecNorm(y, NORM_2, &length));
    PetscCall(VecNorm(r, NORM_2, &residual));
    PetscCall(BVRestoreColumn(R, j, &r));
    PetscCall(BVRestoreColumn(Y, j, &y));
    *worst = PetscMax(*worst, residual / (p->norms[0] * length));
  }
  PetscFunctionReturn(0);
}

/* Adds P^-T R to the basis */
static PetscErrorCode NullExtend(Projection *p, PetscInt n, BV R)
{
  Mat from, to;
  BV  Z;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(p->space.V, n, &Z));
  PetscCall(BVGetMat(R, &from));
  PetscCall(BVGetMat(Z, &to));
  PetscCall(ShiftInvertApplyBlock(&p->si, PETSC_TRUE, from, to));
  PetscCall(BVRestoreMat(Z, &to));
  PetscCall(BVRestoreMat(R, &from));
  PetscCall(SubspaceAdd(&p->space, NULL_NEW, Z, NULL));
  PetscCall(BVDestroy(&Z));
  PetscFunctionReturn(0);
}

/* Y of the present basis, R = K'Y and its size, infinite where there is no Y */
static PetscErrorCode NullTake(const Projection *p, PetscInt n, BV Y, BV R, PetscReal *error)
{
  PetscReal *Z;
  PetscBool  singular;

  PetscFunctionBeginUser;
  *error = PETSC_MAX_REAL;
  PetscCall(PetscMalloc1(n * p->space.n, &Z));
  PetscCall(SmallNull(p, n, Z, &singular));
  if (!singular) PetscCall(BlockLift(p->space.V, p->space.n, n, Z, Y));
  if (!singular) PetscCall(NullResiduals(p, n, Y, R, error));
  PetscCall(PetscFree(Z));
  PetscFunctionReturn(0);
}

/* The vectors in place of those that factors would give */
static PetscErrorCode NullKeep(Modes modes, PetscInt n, BV Y)
{
  Vec like;

  PetscFunctionBeginUser;
  PetscCall(BVGetColumn(Y, 0, &like));
  PetscCall(VecDuplicateVecs(like, n, &modes->null_left));
  PetscCall(BVRestoreColumn(Y, 0, &like));
  for (PetscInt j = 0; j < n; j++) PetscCall(BVCopyVec(Y, j, modes->null_left[j]));
  modes->n_null_left = n;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionFindNull(Projection *p)
{
  const PetscInt n      = p->window->known.rigid;
  PetscReal      before = PETSC_MAX_REAL, error;
  BV             Y, R;

  PetscFunctionBeginUser;
  if (!n || n > p->space.n) PetscFunctionReturn(0);
  PetscCall(BlockCreate(p->space.V, n, &Y));
  PetscCall(BlockCreate(p->space.V, n, &R));
  PetscCall(NullTake(p, n, Y, R, &error));
  for (int round = 0; round < NULL_ROUNDS && error < NULL_FALLS * before && error > NULL_BEST; round++) {
    PetscCall(NullExtend(p, n, R));
    before = error;
    PetscCall(NullTake(p, n, Y, R, &error));
    PetscCall(PetscInfo(Y, "left null vectors: %.1e, %.1e before\n", (double)error, (double)before));
  }
  if (error <= NULL_SUFFICES) PetscCall(NullKeep(p->modes, n, Y));
  PetscCall(BVDestroy(&Y));
  PetscCall(BVDestroy(&R));
  PetscFunctionReturn(0);
}
