/*
   Corrections Z = P^-1 B of residuals B = sigma R, P = K - s M, or P^-T of left ones. Residuals of many modes lie near
   few directions: those of their singular value decomposition, each residual divided by what may remain of it, are
   solved for. With K Z = B + s M Z, kappa and R = C - alpha M - beta K as in projection/fit.c,

      Q(lambda) Z = (1 + beta lambda) (B + (s - kappa) M Z) + lambda R Z,

   so that M Z and R Z are what Galerkin's method finds next in the residuals; their directions are solved for as well,
   which saves a round.
*/
#include "projection.h"
#include "basis/residual.h"
#include "solver/block/orthonormal.h"

#define EXTEND_LATER                                                                                                   \
  10 /* times what may remain: directions of M Z and R Z shorter than this are left to the next round */
#define EXTEND_DROP   0.1  /* of what may remain: directions of corrections that make less are left out */
#define EXTEND_FINER  0.01 /* times that, where all are */
#define EXTEND_LEVELS 2    /* of corrections: of the residuals, and of what these leave */

/* Residuals sigma B of one side */
typedef struct {
  PetscBool  left;
  PetscInt   n; /* columns of B, zero where there is none */
  BV         B;
  PetscReal *sigma; /* [n] */
} SideOfExtension;

/* Makes the active columns of the block as long as sigma says */
static PetscErrorCode CorrectionsScale(BV block, const PetscReal sigma[], PetscReal *longest)
{
  PetscInt  first, end;
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, &first, &end));
  for (PetscInt j = first; j < end; j++) {
    PetscCall(BVNormColumn(block, j, NORM_2, &norm));
    if (norm > 0) PetscCall(BVScaleColumn(block, j, sigma[j - first] / norm));
    *longest = PetscMax(*longest, sigma[j - first]);
  }
  PetscFunctionReturn(0);
}

/* M Z and (C - (alpha + beta s) M) Z - beta B = R Z side by side in a block of twice as many columns */
static PetscErrorCode RemainFill(const Projection *p, PetscBool left, BV B, BV Z, BV remain)
{
  const Mat       A[2]  = {ProjectionMatrix(p, SUBSPACE_M, left), ProjectionMatrix(p, SUBSPACE_C, left)};
  const PetscReal drift = p->alpha + p->beta * p->si.shift;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(B, NULL, &n));
  PetscCall(BlockMultiplySideBySide(2, A, Z, remain));
  for (PetscInt j = 0; j < n; j++) {
    Vec b, mz, cz;

    PetscCall(BVGetColumn(B, j, &b));
    PetscCall(BVGetColumn(remain, j, &mz));
    PetscCall(BVGetColumn(remain, n + j, &cz));
    PetscCall(VecAXPBYPCZ(cz, -drift, -p->beta, 1, mz, b));
    PetscCall(BVRestoreColumn(remain, n + j, &cz));
    PetscCall(BVRestoreColumn(remain, j, &mz));
    PetscCall(BVRestoreColumn(B, j, &b));
  }
  PetscFunctionReturn(0);
}

/* What corrections Z leave of residuals, with the largest (s - kappa) and lambda of the window */
static PetscErrorCode SideRemain(const Projection *p, const SideOfExtension *side, BV Z, SideOfExtension *next)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target), low = p->window->low, s = p->si.shift;
  const PetscReal far = PetscMax(PetscAbsReal(high * high - s), PetscAbsReal(low * low - s));
  const PetscInt  n   = side->n;
  PetscReal      *tolerance;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(p->space.V, 2 * n, &next->B));
  PetscCall(RemainFill(p, side->left, side->B, Z, next->B));
  PetscCall(PetscMalloc1(2 * n, &tolerance));
  PetscCall(PetscMalloc1(2 * n, &next->sigma));
  for (PetscInt j = 0; j < 2 * n; j++) tolerance[j] = EXTEND_LATER / (side->sigma[j % n] * (j < n ? far : high));
  PetscCall(BlockCompress(NULL, tolerance, next->B, next->sigma));
  PetscCall(BVGetActiveColumns(next->B, NULL, &next->n));
  PetscCall(PetscFree(tolerance));
  PetscFunctionReturn(0);
}

static PetscErrorCode SideDestroy(SideOfExtension *side)
{
  PetscFunctionBeginUser;
  PetscCall(BVDestroy(&side->B));
  PetscCall(PetscFree(side->sigma));
  PetscFunctionReturn(0);
}

/* What the corrections in the active columns of Z leave takes the place of the residuals, but after the last level */
static PetscErrorCode SideTake(const Projection *p, PetscBool last, BV Z, SideOfExtension *side, PetscReal *longest)
{
  SideOfExtension next = {.left = side->left};

  PetscFunctionBeginUser;
  if (!last) PetscCall(SideRemain(p, side, Z, &next));
  PetscCall(CorrectionsScale(Z, side->sigma, longest));
  PetscCall(SideDestroy(side));
  *side = next;
  PetscFunctionReturn(0);
}

/* The residuals of a side, few of them */
static PetscErrorCode SideBegin(BV residuals, const PetscReal tolerance[], SideOfExtension *side)
{
  PetscFunctionBeginUser;
  if (residuals) PetscCall(BVGetActiveColumns(residuals, NULL, &side->n));
  if (!side->n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(side->n, &side->sigma));
  PetscCall(BlockCompress(NULL, tolerance, residuals, side->sigma));
  PetscCall(BVGetActiveColumns(residuals, NULL, &side->n));
  side->B = residuals;
  PetscCall(PetscObjectReference((PetscObject)residuals));
  PetscFunctionReturn(0);
}

/* The corrections of both sides, each column as long as it matters, and their residuals, behind those that there are */
static PetscErrorCode LevelTake(const Projection *p, PetscBool last, SideOfExtension side[2], BV *all,
                                PetscReal *longest)
{
  const PetscInt n[2] = {side[0].n, side[1].n}, m = n[0] + n[1];
  PetscInt       before = 0;
  BV             Z;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockCreate(p->space.V, m, &Z));
  PetscCall(ResidualsSolve(&p->si, (BV[2]){side[0].B, side[1].B}, Z));
  for (int i = 0; i < 2; i++) {
    if (!n[i]) continue;
    PetscCall(BVSetActiveColumns(Z, i ? n[0] : 0, i ? m : n[0]));
    PetscCall(SideTake(p, last, Z, &side[i], longest));
  }
  PetscCall(BVSetActiveColumns(Z, 0, m));
  if (*all) {
    PetscCall(BVGetActiveColumns(*all, NULL, &before));
    PetscCall(SubspaceAppend(before, before + m, Z, *all));
    PetscCall(BVDestroy(&Z));
  } else {
    *all = Z;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionExtend(Projection *p, BV residuals[2], PetscReal *const tolerance[2], PetscInt *n_columns)
{
  SideOfExtension side[2] = {{.left = PETSC_FALSE}, {.left = PETSC_TRUE}};
  const PetscInt  before  = p->space.n;
  PetscReal       longest = 0;
  PetscInt        n       = 0;
  BV              all     = NULL;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) PetscCall(SideBegin(residuals[i], tolerance[i], &side[i]));
  for (int level = 0; level < EXTEND_LEVELS; level++)
    PetscCall(LevelTake(p, level + 1 == EXTEND_LEVELS ? PETSC_TRUE : PETSC_FALSE, side, &all, &longest));
  for (int i = 0; i < 2; i++) PetscCall(SideDestroy(&side[i]));
  if (all) {
    PetscCall(BVGetActiveColumns(all, NULL, &n));
    PetscCall(SubspaceAdd(&p->space, p->finer * EXTEND_DROP / longest, all, NULL));
    if (p->space.n == before) p->finer *= EXTEND_FINER;
    PetscCall(BVDestroy(&all));
  }
  if (n_columns) *n_columns = n;
  PetscFunctionReturn(0);
}
