/*
   The space of Galerkin's method: vectors of length one, whatever they are, count alike, so that it is orthonormal
   without M, V'V = I. K, C, M and E = diag(e_i K_ii) are known on it, |e_i| <= 3 eps: K + E is what K could be as
   well.
*/
#include "space.h"
#include "solver/block/orthonormal.h"

#define ROUNDINGS_OF_K 3    /* times machine epsilon */
#define DEPENDENT      1e-9 /* a vector of length one that is nearer than this to the space belongs to it */

/* E, a change of the diagonal of K by rounding; the numbers of PETSc's generator are the same in every run on as
   many ranks. */
static PetscErrorCode NoiseCreate(Mat K, Mat *E)
{
  PetscInt    m, n;
  PetscRandom random;
  Vec         d, sign;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(K, &d, NULL));
  PetscCall(VecDuplicate(d, &sign));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)K), &random));
  PetscCall(
    PetscRandomSetInterval(random, -ROUNDINGS_OF_K * PETSC_MACHINE_EPSILON, ROUNDINGS_OF_K * PETSC_MACHINE_EPSILON));
  PetscCall(VecSetRandom(sign, random));
  PetscCall(MatGetDiagonal(K, d));
  PetscCall(VecPointwiseMult(d, d, sign));
  PetscCall(MatGetLocalSize(K, &m, &n));
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)K), m, n, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL, E));
  PetscCall(MatDiagonalSet(*E, d, INSERT_VALUES));
  PetscCall(MatSetOption(*E, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(VecDestroy(&sign));
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSpaceCreate(const PencilMatrices *pencil, ModesSpace *space)
{
  Mat E;

  PetscFunctionBeginUser;
  space->pencil = *pencil;
  PetscCall(SubspaceCreate(pencil->K, NULL, 0, &space->space));
  PetscCall(SubspaceAddPencil(&space->space, pencil));
  PetscCall(NoiseCreate(pencil->K, &E));
  PetscCall(SubspaceAddTerm(&space->space, E, PETSC_TRUE, PETSC_FALSE));
  PetscCall(MatDestroy(&E));
  PetscFunctionReturn(0);
}

/* Scales the columns to length one; one that is zero stays */
static PetscErrorCode BlockNormalise(BV block)
{
  PetscReal norm;
  PetscInt  n;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(BVNormColumn(block, j, NORM_2, &norm));
    if (norm > 0) PetscCall(BVScaleColumn(block, j, 1 / norm));
  }
  PetscFunctionReturn(0);
}

/* Columns are scaled first: Krylov vectors and modes differ in length by many powers of ten, and DEPENDENT is a
   length. */
PetscErrorCode ModesSpaceAdd(ModesSpace *space, BV block)
{
  PetscInt n;
  BV       fresh;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVDuplicateResize(block, n, &fresh));
  PetscCall(BVCopy(block, fresh));
  PetscCall(BlockNormalise(fresh));
  PetscCall(SubspaceAdd(&space->space, DEPENDENT, fresh, NULL));
  PetscCall(BVDestroy(&fresh));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSpaceProducts(const ModesSpace *space, PetscInt n, const Vec a[], PetscReal **products)
{
  const Subspace *s = &space->space;
  BV              block;
  Mat             H;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * s->n, products));
  if (!n) PetscFunctionReturn(0);
  PetscCall(BlockCreate(s->V, n, &block));
  for (PetscInt j = 0; j < n; j++) PetscCall(BVInsertVec(block, j, a[j]));
  PetscCall(BVSetActiveColumns(s->V, 0, s->n));
  PetscCall(BlockProducts(s->V, NULL, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, s->n, *products));
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSpaceDestroy(ModesSpace *space)
{
  PetscFunctionBeginUser;
  PetscCall(SubspaceDestroy(&space->space));
  PetscFunctionReturn(0);
}
