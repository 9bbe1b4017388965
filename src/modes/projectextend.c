/*
   Corrections Z = P^-1 B of residuals B = sigma R, P = K - s M, or P^-T of left ones. Residuals of many modes lie near few
   directions: those of their singular value decomposition, each residual divided by what may remain of it, are solved for. With
   K Z = B + s M Z, kappa and R = C - alpha M - beta K as in projectfit.c,

      Q(lambda) Z = (1 + beta lambda) (B + (s - kappa) M Z) + lambda R Z,

   so that M Z and R Z are what Galerkin's method finds next in the residuals; their directions are solved for as well, which
   saves a round.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/orthonormal.h"

#define EXTEND_LATER                                                                                                   \
  10 /* times what may remain: directions of M Z and R Z shorter than this are left to the next round */
#define EXTEND_DROP 0.3 /* of what may remain: directions of corrections that make less are left out */

/* Corrections, block after block, each column as long as it matters */
typedef struct {
  int       n;
  BV        block[4];
  PetscReal longest;
} Corrections;

/* Z = P^-1 B, or P^-T B, for another block of them */
static PetscErrorCode CorrectionsSolve(const Projection *p, PetscBool left, BV B, Corrections *c)
{
  PetscInt n;
  Mat      b, z;
  BV       Z;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(B, NULL, &n));
  PetscCall(BlockCreate(p->V, n, &Z));
  PetscCall(BVGetMat(B, &b));
  PetscCall(BVGetMat(Z, &z));
  PetscCall(ShiftInvertApplyBlock(&p->si, left, b, z));
  PetscCall(BVRestoreMat(Z, &z));
  PetscCall(BVRestoreMat(B, &b));
  c->block[c->n++] = Z;
  PetscFunctionReturn(0);
}

/* Makes the columns of the block as long as sigma says */
static PetscErrorCode CorrectionsScale(BV block, const PetscReal sigma[], PetscReal *longest)
{
  PetscInt  n;
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(BVNormColumn(block, j, NORM_2, &norm));
    if (norm > 0) PetscCall(BVScaleColumn(block, j, sigma[j] / norm));
    *longest = PetscMax(*longest, sigma[j]);
  }
  PetscFunctionReturn(0);
}

/* M Z and (C - (alpha + beta s) M) Z - beta B = R Z side by side in a block of twice as many columns */
static PetscErrorCode RemainFill(const Projection *p, PetscBool left, BV B, BV Z, BV remain)
{
  const Mat C = left ? p->transposed[1] : p->pencil->C, M = left ? p->transposed[2] : p->pencil->M;
  PetscInt  n;
  Mat       b, z, mz, cz;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(B, NULL, &n));
  PetscCall(BVGetMat(Z, &z));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &mz));
  PetscCall(BlockMultiply(M, z, mz));
  PetscCall(BVSetActiveColumns(remain, n, 2 * n));
  PetscCall(BVGetMat(remain, &cz));
  PetscCall(BlockMultiply(C, z, cz));
  PetscCall(MatAXPY(cz, -(p->alpha + p->beta * p->si.shift), mz, SAME_NONZERO_PATTERN));
  PetscCall(BVGetMat(B, &b));
  PetscCall(MatAXPY(cz, -p->beta, b, SAME_NONZERO_PATTERN));
  PetscCall(BVRestoreMat(B, &b));
  PetscCall(BVRestoreMat(remain, &cz));
  PetscCall(BVSetActiveColumns(remain, 0, n));
  PetscCall(BVGetMat(remain, &cz));
  PetscCall(MatCopy(mz, cz, SAME_NONZERO_PATTERN));
  PetscCall(BVRestoreMat(remain, &cz));
  PetscCall(BVSetActiveColumns(remain, 0, 2 * n));
  PetscCall(MatDestroy(&mz));
  PetscCall(BVRestoreMat(Z, &z));
  PetscFunctionReturn(0);
}

/* Residuals sigma B of one side; lengths[2 columns of B] of what their corrections leave */
typedef struct {
  PetscBool  left;
  BV         B;
  PetscReal *sigma, *lengths;
} ResidualsOfSide;

/* What corrections Z leave of residuals, with the largest (s - kappa) and lambda of the window */
static PetscErrorCode RemainMake(const Projection *p, const ResidualsOfSide *side, BV Z, BV *remain)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target), low = p->window->low, s = p->si.shift;
  const PetscReal far = PetscMax(PetscAbsReal(high * high - s), PetscAbsReal(low * low - s));
  PetscReal      *tolerance;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(side->B, NULL, &n));
  PetscCall(BlockCreate(p->V, 2 * n, remain));
  PetscCall(RemainFill(p, side->left, side->B, Z, *remain));
  PetscCall(PetscMalloc1(2 * n, &tolerance));
  for (PetscInt j = 0; j < 2 * n; j++) tolerance[j] = EXTEND_LATER / (side->sigma[j % n] * (j < n ? far : high));
  PetscCall(BlockCompress(tolerance, *remain, side->lengths));
  PetscCall(PetscFree(tolerance));
  PetscFunctionReturn(0);
}

/* Corrections of one side */
static PetscErrorCode SideExtend(const Projection *p, PetscBool left, const PetscReal tolerance[], BV residuals,
                                 Corrections *c)
{
  ResidualsOfSide side = {.left = left, .B = residuals};
  PetscInt        n    = 0, n_later;
  BV              later;

  PetscFunctionBeginUser;
  if (residuals) PetscCall(BVGetActiveColumns(residuals, NULL, &n));
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &side.sigma, 2 * n, &side.lengths));
  PetscCall(BlockCompress(tolerance, residuals, side.sigma));
  PetscCall(CorrectionsSolve(p, left, residuals, c));
  PetscCall(RemainMake(p, &side, c->block[c->n - 1], &later));
  PetscCall(CorrectionsScale(c->block[c->n - 1], side.sigma, &c->longest));
  PetscCall(BVGetActiveColumns(later, NULL, &n_later));
  if (n_later) {
    PetscCall(CorrectionsSolve(p, left, later, c));
    PetscCall(CorrectionsScale(c->block[c->n - 1], side.lengths, &c->longest));
  }
  PetscCall(BVDestroy(&later));
  PetscCall(PetscFree2(side.sigma, side.lengths));
  PetscFunctionReturn(0);
}

/* All of them side by side; those apart are destroyed */
static PetscErrorCode CorrectionsJoin(const Projection *p, Corrections *c, BV *all, PetscInt *n)
{
  PetscInt m[4];

  PetscFunctionBeginUser;
  *n = 0;
  for (int i = 0; i < c->n; i++) {
    PetscCall(BVGetActiveColumns(c->block[i], NULL, &m[i]));
    *n += m[i];
  }
  PetscCall(BlockCreate(p->V, PetscMax(1, *n), all));
  for (PetscInt i = 0, at = 0; i < c->n; at += m[i++]) {
    PetscCall(BVSetActiveColumns(*all, at, at + m[i]));
    PetscCall(BVCopy(c->block[i], *all));
    PetscCall(BVDestroy(&c->block[i]));
  }
  PetscCall(BVSetActiveColumns(*all, 0, *n));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionExtend(Projection *p, BV residuals[2], PetscReal *const tolerance[2], PetscInt *n_columns)
{
  Corrections corrections = {.n = 0};
  PetscInt    n;
  BV          all;

  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++)
    PetscCall(SideExtend(p, side ? PETSC_TRUE : PETSC_FALSE, tolerance[side], residuals[side], &corrections));
  PetscCall(CorrectionsJoin(p, &corrections, &all, &n));
  if (n) PetscCall(ProjectionAdd(p, EXTEND_DROP / corrections.longest, all));
  PetscCall(BVDestroy(&all));
  if (n_columns) *n_columns = n;
  PetscFunctionReturn(0);
}
