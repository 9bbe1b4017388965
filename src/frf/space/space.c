/*
   The space of Galerkin's method: one orthonormal basis V for right and left vectors, and V' K V, V' C V, V' M V, which
   grow with it by the rows and columns of the new vectors.
*/
#include "space.h"

#define ROUNDINGS_OF_K 3    /* times machine epsilon */
#define DEPENDENT      1e-9 /* a vector of length one that is nearer than this to the space belongs to it */

/* E, a change of the diagonal of K by rounding */
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

PetscErrorCode FrfSpaceCreate(const PencilMatrices *pencil, PetscInt size, FrfSpace *space)
{
  PetscInt n;
  Vec      u;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  size          = PetscMin(size, n);
  space->pencil = *pencil;
  space->small  = (FrfSmall){.size = size};
  space->KV     = NULL;
  PetscCall(PetscCalloc1(size * size, &space->small.K));
  PetscCall(PetscCalloc1(size * size, &space->small.M));
  PetscCall(PetscCalloc1(size * size, &space->small.E));
  PetscCall(NoiseCreate(pencil->K, &space->E));
  if (pencil->C) PetscCall(PetscCalloc1(size * size, &space->small.C));
  PetscCall(MatCreateVecs(pencil->K, &u, NULL));
  PetscCall(BVCreate(PetscObjectComm((PetscObject)pencil->K), &space->V));
  PetscCall(BVSetType(space->V, BVMAT));
  PetscCall(BVSetSizesFromVec(space->V, u, 1)); /* grows with what is put in */
  if (!pencil->symmetric) PetscCall(BVDuplicate(space->V, &space->KV));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSpaceCreateBlock(const FrfSpace *space, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BlockCreate(space->V, n, block));
  PetscFunctionReturn(0);
}

/* V' A V, extended by the columns `first` and on, which are those of the block */
static PetscErrorCode SmallExtend(const FrfSpace *space, Mat A, BV block, PetscInt first, PetscReal small[])
{
  const PetscInt size = space->small.size;
  PetscBool      known, symmetric;
  Mat            H, At;

  PetscFunctionBeginUser;
  PetscCall(MatIsSymmetricKnown(A, &known, &symmetric));
  PetscCall(BlockProducts(space->V, A, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, size, &small[first * size]));
  if (!known || !symmetric) {
    PetscCall(MatDestroy(&H));
    PetscCall(MatCreateTranspose(A, &At));
    PetscCall(BlockProducts(space->V, At, block, &H));
    PetscCall(MatDestroy(&At));
  }
  PetscCall(BlockCopy(H, PETSC_TRUE, size, &small[first]));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

/* V' K V of an unsymmetric K, extended likewise, and K V */
static PetscErrorCode StiffnessExtend(FrfSpace *space, BV block, PetscInt first, PetscReal small[])
{
  const PetscInt size = space->small.size;
  PetscInt       n;
  Mat            H;
  BV             product;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVDuplicateResize(block, n, &product));
  PetscCall(BVMatMult(block, space->pencil.K, product));
  PetscCall(BlockProducts(space->V, NULL, product, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, size, &small[first * size]));
  PetscCall(MatDestroy(&H));
  if (first) {
    PetscCall(BVSetActiveColumns(space->KV, 0, first));
    PetscCall(BlockProducts(block, NULL, space->KV, &H));
    PetscCall(BlockCopy(H, PETSC_FALSE, size, &small[first]));
    PetscCall(MatDestroy(&H));
  }
  PetscCall(BVResize(space->KV, first + n, PETSC_TRUE));
  PetscCall(BVSetActiveColumns(space->KV, first, first + n));
  PetscCall(BVCopy(product, space->KV));
  PetscCall(BVDestroy(&product));
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

PetscErrorCode FrfSpaceAdd(FrfSpace *space, BV block)
{
  FrfSmall      *small = &space->small;
  const PetscInt first = small->n;
  PetscInt       n;
  BV             fresh;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVDuplicateResize(block, n, &fresh));
  PetscCall(BVCopy(block, fresh));
  PetscCall(BlockNormalise(fresh));
  PetscCall(BlockOrthonormalise(space->V, first, NULL, DEPENDENT, fresh));
  PetscCall(BVGetActiveColumns(fresh, NULL, &n));
  n = PetscMin(n, small->size - first);
  if (n) {
    PetscCall(BVSetActiveColumns(fresh, 0, n));
    PetscCall(BVSetActiveColumns(space->V, 0, first));
    PetscCall(BVResize(space->V, first + n, PETSC_TRUE));
    PetscCall(BVSetActiveColumns(space->V, first, first + n));
    PetscCall(BVCopy(fresh, space->V));
    PetscCall(BVSetActiveColumns(space->V, 0, first + n));
    PetscCall(space->KV ? StiffnessExtend(space, fresh, first, small->K)
                        : SmallExtend(space, space->pencil.K, fresh, first, small->K));
    PetscCall(SmallExtend(space, space->pencil.M, fresh, first, small->M));
    PetscCall(SmallExtend(space, space->E, fresh, first, small->E));
    if (small->C) PetscCall(SmallExtend(space, space->pencil.C, fresh, first, small->C));
    small->n = first + n;
  }
  PetscCall(BVDestroy(&fresh));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSpaceCoordinates(const FrfSpace *space, BV block, PetscReal **coordinates)
{
  PetscInt n;
  Mat      H;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(PetscCalloc1(n * space->small.size, coordinates));
  PetscCall(BVSetActiveColumns(space->V, 0, space->small.n));
  PetscCall(BlockProducts(space->V, NULL, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, space->small.size, *coordinates));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSpaceLift(const FrfSpace *space, PetscInt n, PetscInt stride, const PetscReal coordinates[], BV block)
{
  PetscScalar *c;
  Mat          C;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, space->small.n, n, NULL, &C));
  PetscCall(MatDenseGetArray(C, &c));
  for (PetscInt j = 0; j < n; j++)
    PetscCall(PetscArraycpy(&c[j * space->small.n], &coordinates[j * stride], space->small.n));
  PetscCall(MatDenseRestoreArray(C, &c));
  PetscCall(BVSetActiveColumns(space->V, 0, space->small.n));
  PetscCall(BVSetActiveColumns(block, 0, n));
  PetscCall(BVMult(block, 1, 0, space->V, C));
  PetscCall(MatDestroy(&C));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfSpaceDestroy(FrfSpace *space)
{
  PetscFunctionBeginUser;
  PetscCall(BVDestroy(&space->V));
  PetscCall(BVDestroy(&space->KV));
  PetscCall(MatDestroy(&space->E));
  PetscCall(PetscFree(space->small.E));
  PetscCall(PetscFree(space->small.K));
  PetscCall(PetscFree(space->small.C));
  PetscCall(PetscFree(space->small.M));
  PetscFunctionReturn(0);
}
