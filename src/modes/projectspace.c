/*
   The basis of a projection and its dense model; see project.c.
*/
#include "projection.h"
#include "solver/orthonormal.h"

#define SPACE_SYMMETRIC 1e-13 /* of |A x| |y|: less is rounding */

/* Whether A is symmetric, by y'A x = x'A y of two random vectors */
static PetscErrorCode LooksSymmetric(Mat A, PetscBool *symmetric)
{
  PetscReal   yAx, xAy, Ax, y;
  PetscRandom random;
  Vec         v[3];

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &v[0], NULL));
  for (int i = 1; i < 3; i++) PetscCall(VecDuplicate(v[0], &v[i]));
  PetscCall(PetscRandomCreate(PetscObjectComm((PetscObject)A), &random));
  for (int i = 0; i < 2; i++) PetscCall(VecSetRandom(v[i], random));
  PetscCall(PetscRandomDestroy(&random));
  PetscCall(MatMult(A, v[0], v[2]));
  PetscCall(VecDot(v[2], v[1], &yAx));
  PetscCall(VecNorm(v[2], NORM_2, &Ax));
  PetscCall(VecNorm(v[1], NORM_2, &y));
  PetscCall(MatMult(A, v[1], v[2]));
  PetscCall(VecDot(v[2], v[0], &xAy));
  *symmetric = PetscAbsReal(yAx - xAy) <= SPACE_SYMMETRIC * Ax * y ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 3; i++) PetscCall(VecDestroy(&v[i]));
  PetscFunctionReturn(0);
}

/* A', or A itself where it is symmetric */
static PetscErrorCode TransposeCreate(Mat A, PetscBool symmetric, Mat *At)
{
  PetscFunctionBeginUser;
  if (!symmetric) PetscCall(LooksSymmetric(A, &symmetric));
  if (symmetric)
    PetscCall(PetscObjectReference((PetscObject)A));
  else
    PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, At));
  if (symmetric) *At = A;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCreate(Modes modes, const PencilMatrices *pencil, const Window *window, Projection *p)
{
  const Mat matrix[3] = {pencil->K, pencil->C, pencil->M};
  Vec       u;

  PetscFunctionBeginUser;
  *p = (Projection){.modes = modes, .pencil = pencil, .window = window};
  for (int i = 0; i < 3; i++) {
    PetscCall(TransposeCreate(matrix[i], pencil->symmetric, &p->transposed[i]));
    PetscCall(MatNorm(matrix[i], NORM_FROBENIUS, &p->norms[i]));
  }
  PetscCall(MatCreateVecs(pencil->M, &u, NULL));
  PetscCall(BVCreate(modes->comm, &p->V));
  PetscCall(BVSetType(p->V, BVMAT));
  PetscCall(BVSetSizesFromVec(p->V, u, 1));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCreateBlock(const Projection *p, PetscInt n, BV *block)
{
  PetscFunctionBeginUser;
  PetscCall(BVDuplicateResize(p->V, n, block));
  PetscCall(BVSetActiveColumns(*block, 0, n));
  PetscFunctionReturn(0);
}

/* V' A V of a matrix with its transpose, extended by the block */
static PetscErrorCode ModelExtend(const Projection *p, Mat A, Mat At, BV block, PetscInt first, PetscReal **model)
{
  Mat H;

  PetscFunctionBeginUser;
  PetscCall(BlockExtend(p->V, A, PETSC_TRUE, block, first, model));
  if (A == At) PetscFunctionReturn(0);
  PetscCall(BlockProducts(p->V, At, block, &H));
  PetscCall(BlockCopy(H, PETSC_TRUE, p->k, *model + first));
  PetscCall(MatDestroy(&H));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionAdd(Projection *p, PetscReal drop, BV block, PetscInt *n_added)
{
  const PetscInt first = p->k;
  PetscInt       n;

  PetscFunctionBeginUser;
  PetscCall(BlockOrthonormalise(p->V, first, p->pencil->M, drop, block));
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  if (n_added) *n_added = n;
  if (!n) PetscFunctionReturn(0);
  p->k = first + n;
  PetscCall(BVResize(p->V, p->k, PETSC_TRUE));
  PetscCall(BVSetActiveColumns(p->V, first, p->k));
  PetscCall(BVCopy(block, p->V));
  PetscCall(BVSetActiveColumns(p->V, 0, p->k));
  PetscCall(ModelExtend(p, p->pencil->K, p->transposed[0], block, first, &p->K));
  PetscCall(ModelExtend(p, p->pencil->C, p->transposed[1], block, first, &p->C));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionAddSpectrum(Projection *p, const Spectrum *s)
{
  PetscInt n = 0;
  BV       block;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++) n += s->xi[i] ? 2 : 1;
  if (!n) PetscFunctionReturn(0);
  PetscCall(ProjectionCreateBlock(p, n, &block));
  n = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    PetscCall(BVInsertVec(block, n++, s->xr[i]));
    if (s->xi[i]) PetscCall(BVInsertVec(block, n++, s->xi[i]));
  }
  PetscCall(ProjectionAdd(p, 0, block, NULL));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionDestroy(Projection *p)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 3; i++) PetscCall(MatDestroy(&p->transposed[i]));
  PetscCall(BVDestroy(&p->V));
  PetscCall(PetscFree(p->K));
  PetscCall(PetscFree(p->C));
  PetscCall(ShiftInvertDestroy(&p->si));
  PetscFunctionReturn(0);
}
