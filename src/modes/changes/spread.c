/*
   Changes that are spread over many unknowns, on the space: A of a layer or of a term of the pencil, to which
   Delta(lambda) = K_d + lambda C_d + lambda^2 M_d is the sum with their amounts.

   Projected they are exact, V' A V. The changed system answers to the forces Delta(lambda) x of its modes, and its
   transposed one to Delta(lambda)' y. To first order these are the modes as they were: as many forces as there are
   modes, or few where they move the nodes that change in few ways, and principal components span them. Then what the
   modes of the changed system, found with the answers to these, exert beyond them, and so on.
*/
#include "changes.h"
#include "solver/block/orthonormal.h"
#include <complex.h>

/* Y = Zl' A Zr X of a layer, or Zr' A Zl X */
static PetscErrorCode LayerApply(const ChangeSpace *s, const ChangeTerm *term, PetscBool transposed, BV X, BV Y)
{
  Vec      u[2], x, y;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(term->A, &u[0], &u[1]));
  PetscCall(BVGetActiveColumns(X, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(BVGetColumn(X, j, &x));
    PetscCall(PencilExpand(s->owner, transposed, x, u[0]));
    PetscCall(BVRestoreColumn(X, j, &x));
    PetscCall(MatMult(term->A, u[0], u[1]));
    PetscCall(BVGetColumn(Y, j, &y));
    PetscCall(PencilProjectForce(s->owner, transposed, u[1], y));
    PetscCall(BVRestoreColumn(Y, j, &y));
  }
  for (int i = 0; i < 2; i++) PetscCall(VecDestroy(&u[i]));
  PetscFunctionReturn(0);
}

/* Y = A X, or A' X, of the active columns of X */
static PetscErrorCode SpreadApply(const ChangeSpace *s, const ChangeTerm *term, PetscBool transposed, BV X, BV Y)
{
  Mat A = term->A;

  PetscFunctionBeginUser;
  if (term->layer) {
    PetscCall(LayerApply(s, term, transposed, X, Y));
    PetscFunctionReturn(0);
  }
  if (transposed && !term->symmetric) PetscCall(MatTranspose(term->A, MAT_INITIAL_MATRIX, &A));
  PetscCall(BlockMultiplyVectors(A, X, Y));
  if (A != term->A) PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* V' A V of one term in place of an older one */
static PetscErrorCode SpreadProject(ChangeSpace *s, const ChangeTerm *term, PetscReal **small)
{
  Subspace *space = &s->space.space;
  BV        image;
  Mat       H;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(space->V, 0, space->n));
  PetscCall(BlockCreate(space->V, space->n, &image));
  PetscCall(SpreadApply(s, term, PETSC_FALSE, space->V, image));
  PetscCall(BlockProducts(space->V, NULL, image, &H));
  PetscCall(PetscFree(*small));
  PetscCall(PetscMalloc1(space->n * space->n, small));
  PetscCall(BlockCopy(H, PETSC_FALSE, space->n, *small));
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&image));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceProject(ChangeSpace *s)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < s->n_terms; t++)
    if (s->term[t].A) PetscCall(SpreadProject(s, &s->term[t], &s->side[0][t]));
  PetscFunctionReturn(0);
}

/* Coordinates [2 n][stride] of (k + lambda_j c + lambda_j^2 m) x_j, real and imaginary parts */
static void ScaledVectors(const ChangeVectors *v, const ChangeTerm *term, PetscReal scaled[])
{
  const PetscInt n = v->stride;

  for (PetscInt j = 0; j < v->n; j++) {
    const PetscComplex lambda = v->lambda[j];
    const PetscComplex amount = term->stiffness + lambda * term->viscosity + lambda * lambda * term->mass;

    for (PetscInt i = 0; i < n; i++) {
      const PetscComplex z = amount * CMPLX(v->x[2 * j * n + i], v->x[(2 * j + 1) * n + i]);

      scaled[2 * j * n + i]       = creal(z);
      scaled[(2 * j + 1) * n + i] = cimag(z);
    }
  }
}

/* F += A V scaled, or A' V scaled */
static PetscErrorCode ForcesAdd(const ChangeSpace *s, const ChangeTerm *term, const ChangeVectors *v, BV F)
{
  const PetscInt n = v->stride, m = 2 * v->n;
  BV             V = s->space.space.V, image;
  PetscReal     *scaled;
  Mat            Q;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * n, &scaled));
  ScaledVectors(v, term, scaled);
  PetscCall(BVSetActiveColumns(V, 0, n));
  PetscCall(BlockCreate(V, n, &image));
  PetscCall(SpreadApply(s, term, v->left, V, image));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, m, scaled, &Q));
  PetscCall(BVMult(F, 1, 1, image, Q));
  PetscCall(MatDestroy(&Q));
  PetscCall(BVDestroy(&image));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(0);
}

/* F -= U U' F of known vectors U, which are orthonormal */
static PetscErrorCode ForcesLess(const ChangeForces *known, BV F)
{
  Mat H;
  BV  U;

  PetscFunctionBeginUser;
  if (!known || !known->n) PetscFunctionReturn(0);
  PetscCall(BlockCreate(F, known->n, &U));
  for (PetscInt j = 0; j < known->n; j++) PetscCall(BVInsertVec(U, j, known->force[j]));
  for (int twice = 0; twice < 2; twice++) {
    PetscCall(BlockProducts(U, NULL, F, &H));
    PetscCall(BVMult(F, -1, 1, U, H));
    PetscCall(MatDestroy(&H));
  }
  PetscCall(BVDestroy(&U));
  PetscFunctionReturn(0);
}

/* Principal components of the forces, beyond known ones, but for what is `drop` of the longest */
static PetscErrorCode ForcesCompress(const ChangeForces *known, PetscReal drop, BV F)
{
  PetscReal *tolerance, *sigma, longest = 0, length;
  PetscInt   m;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(F, NULL, &m));
  for (PetscInt j = 0; j < m; j++) {
    PetscCall(BVNormColumn(F, j, NORM_2, &length));
    longest = PetscMax(longest, length);
  }
  if (longest == 0) PetscCall(BVSetActiveColumns(F, 0, 0));
  if (longest == 0) PetscFunctionReturn(0);
  PetscCall(ForcesLess(known, F));
  PetscCall(PetscMalloc2(m, &tolerance, m, &sigma));
  for (PetscInt j = 0; j < m; j++) tolerance[j] = drop * longest;
  PetscCall(BlockCompress(NULL, tolerance, F, sigma));
  PetscCall(PetscFree2(tolerance, sigma));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceForces(const ChangeSpace *s, const ChangeVectors *v, const ChangeForces *known,
                                 PetscReal drop, ChangeForces *forces)
{
  PetscBool spread = PETSC_FALSE;
  BV        F;
  Vec       like;

  PetscFunctionBeginUser;
  *forces = (ChangeForces){0, NULL};
  for (PetscInt t = 0; t < s->n_terms; t++)
    if (s->term[t].A) spread = PETSC_TRUE;
  if (!spread || !v->n || (v->left && s->space.pencil.symmetric)) PetscFunctionReturn(0);
  PetscCall(BlockCreate(s->space.space.V, 2 * v->n, &F));
  PetscCall(BVScale(F, 0));
  for (PetscInt t = 0; t < s->n_terms; t++)
    if (s->term[t].A) PetscCall(ForcesAdd(s, &s->term[t], v, F));
  PetscCall(ForcesCompress(known, drop, F));
  PetscCall(BVGetActiveColumns(F, NULL, &forces->n));
  PetscCall(PetscMalloc1(forces->n, &forces->force));
  PetscCall(MatCreateVecs(s->space.pencil.K, &like, NULL));
  for (PetscInt j = 0; j < forces->n; j++) {
    PetscCall(VecDuplicate(like, &forces->force[j]));
    PetscCall(BVCopyVec(F, j, forces->force[j]));
  }
  PetscCall(VecDestroy(&like));
  PetscCall(BVDestroy(&F));
  PetscFunctionReturn(0);
}
