/* The near inverse of the compliance of the pairs (sparse.h): a factorisation of the bodies with springs at the
   directions that are held, and a solution in each product */
#include "sparse.h"
#include "base/algebra/gram.h"

/* stiffness of the springs beside that of the pairs: they leave as much of it, and rounding as many digits */
#define HOLD_STIFF 100
/* least part of the modes' stiffness that is left beside 1 / f: beyond, f is as of a mode that is free */
#define HOLD_LEAST 1e-3

PetscErrorCode SparseHoldCreate(ReducedSparse sparse, SparseHold *h)
{
  const ReducedModel *model = &sparse->run->reduction.model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  h->sparse = sparse;
  PetscCall(PetscCalloc4(m, &h->f, n, &h->tau, n, &h->force, m, &h->coordinates));
  PetscCall(PetscMalloc3(n * m, &h->GY, m * m, &h->E, m, &h->pivot));
  PetscFunctionReturn(0);
}

/* K_h, in place from the second time on: rows that are not held are zeros, so that its pattern stays */
static PetscErrorCode HoldForm(SparseHold *h)
{
  const ReducedSparse s       = h->sparse;
  const MatStructure  pattern = h->K ? SUBSET_NONZERO_PATTERN : DIFFERENT_NONZERO_PATTERN;
  PetscScalar        *value;
  Mat                 held, springs;
  Vec                 tau;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(s->G, MAT_COPY_VALUES, &held));
  PetscCall(MatCreateVecs(held, NULL, &tau));
  PetscCall(VecGetArray(tau, &value));
  for (PetscInt i = 0; i < 3 * s->run->reduction.n_local; i++) value[i] = h->tau[3 * s->run->reduction.begin + i];
  PetscCall(VecRestoreArray(tau, &value));
  PetscCall(MatDiagonalScale(held, tau, NULL));
  PetscCall(MatTransposeMatMult(s->G, held, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &springs));
  if (h->K)
    PetscCall(MatCopy(s->base, h->K, SUBSET_NONZERO_PATTERN));
  else
    PetscCall(MatDuplicate(s->base, MAT_COPY_VALUES, &h->K));
  PetscCall(MatAXPY(h->K, 1, springs, pattern));
  PetscCall(MatSetOption(h->K, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatDestroy(&springs));
  PetscCall(MatDestroy(&held));
  PetscCall(VecDestroy(&tau));
  PetscFunctionReturn(0);
}

/* GY and E */
static PetscErrorCode HoldSetModes(SparseHold *h)
{
  const Reduction *r = &h->sparse->run->reduction;
  const PetscInt   m = r->model.m;
  Mat              Y;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(r->MPhi, MAT_DO_NOT_COPY_VALUES, &Y));
  PetscCall(ShiftInvertApplyThrough(&h->inverse, h->sparse->Z, r->MPhi, Y));
  PetscCall(SparseRows(h->sparse, Y, h->GY));
  PetscCall(BlockGram(r->MPhi, Y, h->E));
  for (PetscInt k = 0; k < m; k++)
    h->E[k * (m + 1)] += h->f[k] / PetscMax(HOLD_LEAST, 1 - h->f[k] * r->model.omega2[k]);
  PetscCall(DenseFactor(m, h->E, h->pivot, NULL));
  PetscCall(MatDestroy(&Y));
  PetscFunctionReturn(0);
}

PetscErrorCode SparseHoldSet(SparseHold *h, const PetscBool held[])
{
  const ReducedSparse s = h->sparse;
  PencilMatrices      pencil;
  PetscBool           singular;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * s->run->reduction.model.n_pairs; i++)
    h->tau[i] = !held || held[i] ? HOLD_STIFF * s->kappa[i / 3] : 0;
  PetscCall(HoldForm(h));
  pencil          = (PencilMatrices){.symmetric = PETSC_TRUE, .K = h->K};
  h->inverse.comm = s->run->comm;
  h->inverse.even = h->inverse.bare = PETSC_TRUE;
  PetscCall(ShiftInvertFactor(&pencil, &h->inverse, &singular));
  PetscCall(ShiftInvertRegular(s->run->comm, (PetscBool)!singular, 0));
  PetscCall(ShiftInvertMakeTrial(&h->inverse));
  PetscCall(HoldSetModes(h));
  PetscFunctionReturn(0);
}

PetscErrorCode SparseHoldMove(SparseHold *h, const PetscReal force[], PetscReal motion[])
{
  const ReducedSparse s = h->sparse;
  const PetscInt      n = 3 * s->run->reduction.model.n_pairs, m = s->run->reduction.model.m;

  PetscFunctionBeginUser;
  PetscCall(SparseForces(s, force, s->B));
  PetscCall(ShiftInvertApplyThrough(&h->inverse, s->Z, s->B, s->X));
  PetscCall(SparseRows(s, s->X, motion));
  PetscCall(PetscArrayzero(h->coordinates, m));
  ReducedBlockTimes(&(DenseBlock){h->GY, n, m, n}, PETSC_TRUE, 1, force, h->coordinates);
  PetscCall(DenseSolve(m, h->E, h->pivot, PETSC_FALSE, 1, h->coordinates));
  ReducedBlockTimes(&(DenseBlock){h->GY, n, m, n}, PETSC_FALSE, -1, h->coordinates, motion);
  PetscFunctionReturn(0);
}

PetscErrorCode SparseHoldPress(SparseHold *h, const PetscReal motion[], PetscReal force[])
{
  const PetscInt n = 3 * h->sparse->run->reduction.model.n_pairs;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) h->force[i] = h->tau[i] * motion[i];
  PetscCall(SparseHoldMove(h, h->force, force));
  for (PetscInt i = 0; i < n; i++) force[i] = h->tau[i] * (motion[i] - force[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode SparseHoldDestroy(SparseHold *h)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(h->f, h->tau, h->force, h->coordinates));
  PetscCall(PetscFree3(h->GY, h->E, h->pivot));
  PetscCall(MatDestroy(&h->K));
  PetscCall(ShiftInvertDestroy(&h->inverse));
  PetscFunctionReturn(0);
}
