/*
   Corrections with factors of Q at a complex shift s = i omega, for damping so strong that those of the undamped
   problem do not converge. Of a residual r of an eigenvalue lambda

      z = Q(s)^-1 r,   Q(lambda) z - r = (lambda - s) (C + (lambda + s) M) z,

   which is the residual of the next step, and so on: a Krylov space of each mode, of which Galerkin's method takes the
   best. What damping makes real lies on the negative real axis below -1 / beta, undamped modes beyond the basis lie
   beyond its reach: far from s beside the modes about it. A step leaves |(w - w_s) / (w + conj w_s)| of what belongs to
   the former, w = root(lambda + 1 / beta): a quarter at twice or half of s.
*/
#include "basis/complexshift.h"
#include "basis/residual.h"
#include "projection.h"
#include "solver/block/orthonormal.h"

#define ABOUT_LEVELS 2    /* steps of a residual, before the next dense problem; with 3 a sixth more time */
#define ABOUT_DROP   0.1  /* of what may remain of a residual: directions of corrections that make less are left out */
#define ABOUT_FINER  0.01 /* times that, where all are */
#define ABOUT_RANDOM 4    /* vectors of a search, and its steps */
#define ABOUT_SEARCH 3
#define ABOUT_NEW    1e-6 /* of them: what the basis has not */

/* The length of columns k and k + 1, real and imaginary parts */
static PetscErrorCode PairNorm(BV block, PetscInt k, PetscReal *norm)
{
  PetscReal part[2];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 2; i++) PetscCall(BVNormColumn(block, k + i, NORM_2, &part[i]));
  *norm = hypot(part[0], part[1]);
  PetscFunctionReturn(0);
}

/* Makes each pair of the active columns of Z as long as the residual is in units of what may remain of it */
static PetscErrorCode PairsScale(const PetscReal tolerance[], BV R, BV Z, PetscReal *longest)
{
  PetscInt n, first;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(R, NULL, &n));
  PetscCall(BVGetActiveColumns(Z, &first, NULL));
  for (PetscInt k = 0; k < n; k += 2) {
    PetscReal residual, length;

    PetscCall(PairNorm(R, k, &residual));
    PetscCall(PairNorm(Z, first + k, &length));
    residual /= tolerance[k];
    *longest = PetscMax(*longest, residual);
    for (PetscInt i = 0; i < 2 && length > 0; i++) PetscCall(BVScaleColumn(Z, first + k + i, residual / length));
  }
  PetscFunctionReturn(0);
}

/* Z = Q(s)^-1 R, or Q(s)'^-1 R */
static PetscErrorCode AboutSolve(const Projection *p, PetscBool left, BV R, BV Z)
{
  Mat from, to;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(R, &from));
  PetscCall(BVGetMat(Z, &to));
  PetscCall(ComplexShiftSolve(p->about, left, from, to));
  PetscCall(BVRestoreMat(Z, &to));
  PetscCall(BVRestoreMat(R, &from));
  PetscFunctionReturn(0);
}

/* R = (lambda - s) (C + (lambda + s) M) Z, pair by pair */
static PetscErrorCode AboutRemain(const Projection *p, PetscBool left, const PetscComplex lambda[], BV Z, BV R)
{
  const Mat          A[2] = {ProjectionMatrix(p, SUBSPACE_C, left), ProjectionMatrix(p, SUBSPACE_M, left)};
  const PetscComplex s    = CMPLX(0, p->about->factor.shift);
  const PetscScalar *az;
  PetscScalar       *r;
  PetscInt           n, n_local, lda, ldr;
  BV                 images;
  Mat                from, to;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(Z, NULL, &n));
  PetscCall(BlockCreate(p->space.V, 2 * n, &images));
  PetscCall(BlockMultiplySideBySide(2, A, Z, images));
  PetscCall(BVGetMat(images, &from));
  PetscCall(BVGetMat(R, &to));
  PetscCall(MatGetLocalSize(from, &n_local, NULL));
  PetscCall(MatDenseGetLDA(from, &lda));
  PetscCall(MatDenseGetLDA(to, &ldr));
  PetscCall(MatDenseGetArrayRead(from, &az));
  PetscCall(MatDenseGetArray(to, &r));
  for (PetscInt k = 0; k < n; k += 2) {
    const PetscComplex d = lambda[k / 2] - s, e = lambda[k / 2] + s;

    for (PetscInt i = 0; i < n_local; i++) {
      const PetscComplex c = CMPLX(az[k * lda + i], az[(k + 1) * lda + i]);
      const PetscComplex m = CMPLX(az[(n + k) * lda + i], az[(n + k + 1) * lda + i]);
      const PetscComplex a = d * (c + e * m);

      r[k * ldr + i]       = creal(a);
      r[(k + 1) * ldr + i] = cimag(a);
    }
  }
  PetscCall(MatDenseRestoreArray(to, &r));
  PetscCall(MatDenseRestoreArrayRead(from, &az));
  PetscCall(BVRestoreMat(R, &to));
  PetscCall(BVRestoreMat(images, &from));
  PetscCall(BVDestroy(&images));
  PetscFunctionReturn(0);
}

/* Residuals of one side, with what may remain of their columns, and their eigenvalues */
typedef struct {
  PetscBool           left;
  const PetscReal    *tolerance; /* [columns] */
  const PetscComplex *lambda;    /* [pairs] rad/s */
  BV                  R;         /* overwritten */
} AboutSide;

/* The steps of a side behind the columns that there are, each pair as long as its residual in units of what may remain
   of it */
static PetscErrorCode AboutSteps(const Projection *p, const AboutSide *side, BV all, PetscReal *longest)
{
  PetscInt n, first;
  BV       Z;

  PetscFunctionBeginUser;
  PetscCall(BVGetActiveColumns(side->R, NULL, &n));
  PetscCall(BVGetActiveColumns(all, NULL, &first));
  PetscCall(BlockCreate(p->space.V, n, &Z));
  for (int level = 0; level < ABOUT_LEVELS && n; level++, first += n) {
    PetscCall(AboutSolve(p, side->left, side->R, Z));
    PetscCall(BVSetActiveColumns(all, first, first + n));
    PetscCall(BVCopy(Z, all));
    PetscCall(PairsScale(side->tolerance, side->R, all, longest));
    if (level + 1 < ABOUT_LEVELS) PetscCall(AboutRemain(p, side->left, side->lambda, Z, side->R));
  }
  PetscCall(BVSetActiveColumns(all, 0, first));
  PetscCall(BVDestroy(&Z));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionExtendAbout(Projection *p, BV residuals[2], PetscReal *const tolerance[2],
                                     PetscComplex *const lambda[2], PetscInt *n_solves)
{
  const PetscInt before  = p->space.n;
  PetscInt       n[2]    = {0, 0};
  PetscReal      longest = 0;
  BV             all;

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++)
    if (residuals[i]) PetscCall(BVGetActiveColumns(residuals[i], NULL, &n[i]));
  *n_solves = ABOUT_LEVELS * (n[0] + n[1]) / 2;
  if (!*n_solves) PetscFunctionReturn(0);
  PetscCall(BlockCreate(p->space.V, 2 * *n_solves, &all));
  PetscCall(BVSetActiveColumns(all, 0, 0));
  for (int i = 0; i < 2; i++) {
    const AboutSide side = {i ? PETSC_TRUE : PETSC_FALSE, tolerance[i], lambda[i], residuals[i]};

    if (n[i]) PetscCall(AboutSteps(p, &side, all, &longest));
  }
  PetscCall(SubspaceAdd(&p->space, p->finer * ABOUT_DROP / longest, all, NULL));
  if (p->space.n == before) p->finer *= ABOUT_FINER;
  PetscCall(BVDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionSearchAbout(Projection *p, PetscComplex lambda, unsigned long seed)
{
  PetscComplex at[ABOUT_RANDOM];
  BV           all, R, Z;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(p->space.V, 2 * ABOUT_RANDOM * ABOUT_SEARCH, &all));
  PetscCall(BlockCreate(p->space.V, 2 * ABOUT_RANDOM, &R));
  PetscCall(BlockCreate(p->space.V, 2 * ABOUT_RANDOM, &Z));
  PetscCall(SolverSeed(R, seed));
  for (PetscInt j = 0; j < 2 * ABOUT_RANDOM; j++) PetscCall(BVSetRandomColumn(R, j));
  for (PetscInt j = 0; j < ABOUT_RANDOM; j++) at[j] = lambda;
  for (PetscInt level = 0; level < ABOUT_SEARCH; level++) {
    PetscCall(AboutSolve(p, PETSC_FALSE, R, Z));
    PetscCall(BlockProject(p->space.V, p->space.n, p->space.M, Z));
    for (PetscInt j = 0; j < 2 * ABOUT_RANDOM; j++) {
      PetscReal length;

      PetscCall(BVNormColumn(Z, j, NORM_2, &length));
      if (length > 0) PetscCall(BVScaleColumn(Z, j, 1 / length));
    }
    PetscCall(BVSetActiveColumns(all, 2 * ABOUT_RANDOM * level, 2 * ABOUT_RANDOM * (level + 1)));
    PetscCall(BVCopy(Z, all));
    if (level + 1 < ABOUT_SEARCH) PetscCall(AboutRemain(p, PETSC_FALSE, at, Z, R));
  }
  PetscCall(BVSetActiveColumns(all, 0, 2 * ABOUT_RANDOM * ABOUT_SEARCH));
  PetscCall(SubspaceAdd(&p->space, ABOUT_NEW, all, NULL));
  PetscCall(BVDestroy(&Z));
  PetscCall(BVDestroy(&R));
  PetscCall(BVDestroy(&all));
  PetscFunctionReturn(0);
}
