/*
   Corrections Z = P^-1 B of residuals B = sigma R, P = K - s M, or P^-T of left ones. Residuals of many modes lie near few
   directions: those of their singular value decomposition, each residual divided by what may remain of it, are solved for. With
   K Z = B + s M Z, kappa and R = C - alpha M - beta K as in projection/fit.c,

      Q(lambda) Z = (1 + beta lambda) (B + (s - kappa) M Z) + lambda R Z,

   so that M Z and R Z are what Galerkin's method finds next in the residuals; their directions are solved for as well, which
   saves a round.
*/
#include "projection.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"

#define EXTEND_LATER                                                                                                   \
  10 /* times what may remain: directions of M Z and R Z shorter than this are left to the next round */
#define EXTEND_DROP   0.1 /* of what may remain: directions of corrections that make less are left out */
#define EXTEND_FINER  0.01 /* times that, where all are */
#define EXTEND_LEVELS 2   /* of corrections: of the residuals, and of what these leave */

/* Residuals sigma B of one side */
typedef struct {
  PetscBool  left;
  PetscInt   n;     /* columns of B, zero where there is none */
  BV         B, Z;  /* Z = P^-1 B, or P^-T B */
  PetscReal *sigma; /* [n] */
} SideOfExtension;

/* Corrections, block after block, each column as long as it matters */
typedef struct {
  int       n;
  BV        block[2 * EXTEND_LEVELS];
  PetscReal longest;
} Corrections;

/* Copies the active columns of a block to those of a dense matrix from `first` on, or back */
static PetscErrorCode ColumnsCopy(BV block, PetscInt first, PetscBool back, Mat all)
{
  PetscInt n;
  Mat      b, part;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(block, NULL, &n));
  PetscCall(BVGetMat(block, &b));
  PetscCall(MatDenseGetSubMatrix(all, PETSC_DECIDE, PETSC_DECIDE, first, first + n, &part));
  PetscCall(back ? MatCopy(part, b, SAME_NONZERO_PATTERN) : MatCopy(b, part, SAME_NONZERO_PATTERN));
  PetscCall(MatDenseRestoreSubMatrix(all, &part));
  PetscCall(BVRestoreMat(block, &b));
  PetscFunctionReturn(0);
}

/* Z = P^-1 B of one side, P^-T B of a left one */
static PetscErrorCode SideSolve(const Projection *p, SideOfExtension *side)
{
  Mat b, z;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(side->B, &b));
  PetscCall(BVGetMat(side->Z, &z));
  PetscCall(ShiftInvertApplyBlock(&p->si, side->left, b, z));
  PetscCall(BVRestoreMat(side->Z, &z));
  PetscCall(BVRestoreMat(side->B, &b));
  PetscFunctionReturn(0);
}

/* The same of both in one block, which costs less where the factors are LDL' with an update */
static PetscErrorCode SidesSolveBoth(Projection *p, SideOfExtension side[2])
{
  const PetscInt n[2] = {side[0].n, side[1].n};
  PetscInt       n_local;
  Mat            X;

  PetscFunctionBeginUser;
  PetscCall(BVGetSizes(p->space.V, &n_local, NULL, NULL));
  PetscCall(MatCreateDense(p->modes->comm, n_local, PETSC_DECIDE, PETSC_DETERMINE, n[0] + n[1], NULL, &X));
  for (int i = 0; i < 2; i++) PetscCall(ColumnsCopy(side[i].B, i ? n[0] : 0, PETSC_FALSE, X));
  PetscCall(ShiftInvertApplyBoth(&p->si, n[0], X));
  for (int i = 0; i < 2; i++) PetscCall(ColumnsCopy(side[i].Z, i ? n[0] : 0, PETSC_TRUE, X));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

/* Z of the sides that have residuals */
static PetscErrorCode SidesSolve(Projection *p, SideOfExtension side[2])
{
  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++)
    if (side[i].n) PetscCall(BlockCreate(p->space.V, side[i].n, &side[i].Z));
  if (side[0].n && side[1].n && p->si.update) {
    PetscCall(SidesSolveBoth(p, side));
    PetscFunctionReturn(0);
  }
  for (int i = 0; i < 2; i++)
    if (side[i].n) PetscCall(SideSolve(p, &side[i]));
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
static PetscErrorCode SideRemain(const Projection *p, const SideOfExtension *side, SideOfExtension *next)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target), low = p->window->low, s = p->si.shift;
  const PetscReal far = PetscMax(PetscAbsReal(high * high - s), PetscAbsReal(low * low - s));
  const PetscInt  n   = side->n;
  PetscReal      *tolerance;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(p->space.V, 2 * n, &next->B));
  PetscCall(RemainFill(p, side->left, side->B, side->Z, next->B));
  PetscCall(PetscMalloc1(2 * n, &tolerance));
  PetscCall(PetscMalloc1(2 * n, &next->sigma));
  for (PetscInt j = 0; j < 2 * n; j++) tolerance[j] = EXTEND_LATER / (side->sigma[j % n] * (j < n ? far : high));
  PetscCall(BlockCompress(tolerance, next->B, next->sigma));
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

/* Moves Z to the corrections; what they leave takes the place of the residuals, but after the last level */
static PetscErrorCode SideTake(const Projection *p, PetscBool last, SideOfExtension *side, Corrections *c)
{
  SideOfExtension next = {.left = side->left};

  PetscFunctionBeginUser;
  if (!last) PetscCall(SideRemain(p, side, &next));
  PetscCall(CorrectionsScale(side->Z, side->sigma, &c->longest));
  c->block[c->n++] = side->Z;
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
  PetscCall(BlockCompress(tolerance, residuals, side->sigma));
  PetscCall(BVGetActiveColumns(residuals, NULL, &side->n));
  side->B = residuals;
  PetscCall(PetscObjectReference((PetscObject)residuals));
  PetscFunctionReturn(0);
}

/* All of them side by side; those apart are destroyed */
static PetscErrorCode CorrectionsJoin(const Projection *p, Corrections *c, BV *all, PetscInt *n)
{
  PetscInt m[2 * EXTEND_LEVELS];

  PetscFunctionBeginUser;
  *n = 0;
  for (int i = 0; i < c->n; i++) {
    PetscCall(BVGetActiveColumns(c->block[i], NULL, &m[i]));
    *n += m[i];
  }
  PetscCall(BlockCreate(p->space.V, PetscMax(1, *n), all));
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
  Corrections     corrections = {.n = 0};
  SideOfExtension side[2]     = {{.left = PETSC_FALSE}, {.left = PETSC_TRUE}};
  const PetscInt  before      = p->space.n;
  PetscInt        n;
  BV              all;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) PetscCall(SideBegin(residuals[i], tolerance[i], &side[i]));
  for (int level = 0; level < EXTEND_LEVELS; level++) {
    PetscCall(SidesSolve(p, side));
    for (int i = 0; i < 2; i++)
      if (side[i].n)
        PetscCall(SideTake(p, level + 1 == EXTEND_LEVELS ? PETSC_TRUE : PETSC_FALSE, &side[i], &corrections));
  }
  for (int i = 0; i < 2; i++) PetscCall(SideDestroy(&side[i]));
  PetscCall(CorrectionsJoin(p, &corrections, &all, &n));
  if (n) PetscCall(SubspaceAdd(&p->space, p->finer * EXTEND_DROP / corrections.longest, all, NULL));
  if (n && p->space.n == before) p->finer *= EXTEND_FINER;
  PetscCall(BVDestroy(&all));
  if (n_columns) *n_columns = n;
  PetscFunctionReturn(0);
}
