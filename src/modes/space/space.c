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

PetscErrorCode ModesSpaceCreate(const PencilMatrices *pencil, PetscInt size, ModesSpace *space)
{
  PetscInt n;
  Mat      E;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  space->size   = PetscMin(size, n);
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

PetscErrorCode ModesSpaceCoordinates(const ModesSpace *space, BV block, PetscReal **coordinates)
{
  PetscInt n;
  Mat      H;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(PetscCalloc1(n * space->size, coordinates));
  PetscCall(BVSetActiveColumns(space->space.V, 0, space->space.n));
  PetscCall(BlockProducts(space->space.V, NULL, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, space->size, *coordinates));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSpaceLift(const ModesSpace *space, PetscInt n, PetscInt stride, const PetscReal coordinates[],
                              BV block)
{
  const PetscInt size = space->space.n;
  PetscReal     *packed;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * size, &packed));
  for (PetscInt j = 0; j < n; j++) PetscCall(PetscArraycpy(&packed[j * size], &coordinates[j * stride], size));
  PetscCall(BlockLift(space->space.V, size, n, packed, block));
  PetscCall(PetscFree(packed));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSpaceDestroy(ModesSpace *space)
{
  PetscFunctionBeginUser;
  PetscCall(SubspaceDestroy(&space->space));
  PetscFunctionReturn(0);
}
