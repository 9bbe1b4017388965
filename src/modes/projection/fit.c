/*
   How strong damping is. What of C is alpha M + beta K moves the undamped modes but leaves their vectors:

      lambda^2 + (alpha + beta kappa) lambda + kappa = 0,   kappa = omega^2.

   The rest R = C - alpha M - beta K couples them, also with those beyond the basis. At lambda

      Q(lambda) = (1 + beta lambda) (K - kappa M) + lambda R,   kappa(lambda) = -(lambda^2 + alpha lambda) / (1 + beta
      lambda),

   and beyond the basis K - kappa M is regular. With G = (K - s M)^-1 lambda R / (1 + beta lambda) there and K - kappa M
   about K - s M, I + t G stays regular for t in [0, 1] where the spectral radius of G is below one: as R grows from
   nothing no eigenvalue comes into the window from beyond. With laws of materials alpha = beta = 0 in this measure, and
   G_j(lambda) A_j counts by its size beyond Re G_j at the reference, A_j being semidefinite.
*/
#include "projection.h"
#include "base/algebra/dense.h"
#include "solver/block/orthonormal.h"

#define BEYOND_BLOCK  8
#define BEYOND_STEPS  3
#define BEYOND_POINTS 8 /* of the window, where laws of materials are looked at */
#define BEYOND_CLEAR                                                                                                   \
  0.1 /* an estimate below this, of two steps or more, is far enough from one: a third adds 2 % to 0.01 */
#define FIT_DISTINCT 1e-6 /* variance of kappa beside its mean square: below it beta cannot be told from alpha */

/* y'Cx / y'Mx of column j; NAN where that says nothing */
static PetscErrorCode ModeDamping(const ModalBlock modal[2], PetscInt j, PetscReal *damping)
{
  const PetscBool paired = modal[1].n == modal[0].n ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       product[2];
  Vec             y, Ax;

  PetscFunctionBeginUser;
  PetscCall(BVGetColumn(modal[paired].x, j, &y));
  for (int i = 0; i < 2; i++) {
    const BV images = i ? modal[0].Mx : modal[0].Cx;

    PetscCall(BVGetColumn(images, j, &Ax));
    PetscCall(VecDot(Ax, y, &product[i]));
    PetscCall(BVRestoreColumn(images, j, &Ax));
  }
  PetscCall(BVRestoreColumn(modal[paired].x, j, &y));
  *damping = product[1] != 0 ? product[0] / product[1] : NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionFit(Projection *p, const Spectrum *right, const ModalBlock modal[2])
{
  PetscReal sum[5] = {0, 0, 0, 0, 0}; /* 1, kappa, kappa^2, c, c kappa, with kappa relative to the window's */
  PetscReal unit   = PetscSqr(PetscMax(p->window->high, p->window->target)), det;

  PetscFunctionBeginUser;
  p->alpha = p->beta = 0;
  unit               = PetscMax(unit, PetscSqr(p->window->known.scale));
  for (PetscInt j = 0; j < modal[0].n; j++) {
    const PetscInt  i     = modal[0].mode[j];
    const PetscReal kappa = right->omega[i] * right->omega[i] / unit;
    PetscReal       c;

    if (right->xi[i] || right->sigma[i] != 0) continue;
    PetscCall(ModeDamping(modal, j, &c));
    if (!isfinite(c)) continue;
    sum[0] += 1, sum[1] += kappa, sum[2] += kappa * kappa, sum[3] += c, sum[4] += c * kappa;
  }
  det = sum[0] * sum[2] - sum[1] * sum[1];
  if (det > FIT_DISTINCT * sum[0] * sum[2]) p->beta = PetscMax(0, (sum[0] * sum[4] - sum[1] * sum[3]) / det);
  if (sum[0] > 0) p->alpha = PetscMax(0, (sum[3] - p->beta * sum[1]) / sum[0]);
  if (p->beta < FIT_DISTINCT * FIT_DISTINCT * p->alpha) p->beta = 0;
  if (p->alpha < FIT_DISTINCT * FIT_DISTINCT * p->beta) p->alpha = 0;
  p->beta /= unit;
  PetscFunctionReturn(0);
}

/* b += sum_j (a_j - c_j) A_j w, c_j what the pencil's C has of a law, a_j the largest |h_j(i omega) + i omega c_j| of
   the window beside its upper end */
static PetscErrorCode BeyondAddLaws(const Projection *p, Mat w, Mat b)
{
  const PetscReal high = PetscMax(p->window->high, p->window->target), low = p->window->low;
  Mat             Aw;

  PetscFunctionBeginUser;
  if (!p->pencil->n_laws) PetscFunctionReturn(0);
  PetscCall(MatDuplicate(b, MAT_DO_NOT_COPY_VALUES, &Aw));
  for (PetscInt l = 0; l < p->pencil->n_laws; l++) {
    const PencilLaw *law = &p->pencil->law[l];
    const PetscReal  c   = law->scale * cimag(law->at) / law->reference;
    PetscReal        a   = 0;

    for (int i = 0; i <= BEYOND_POINTS; i++) {
      const PetscReal omega = low + (high - low) * (i + 0.5) / (BEYOND_POINTS + 1);

      a = PetscMax(a, cabs(PencilLawAt(law, CMPLX(0, omega), NULL) + I * omega * c));
    }
    PetscCall(BlockMultiplyEach(1, &law->A, w, &Aw));
    PetscCall(MatAXPY(b, a / high - c, Aw, SAME_NONZERO_PATTERN));
  }
  PetscCall(MatDestroy(&Aw));
  PetscFunctionReturn(0);
}

/* Z = P^-1 R W for the active columns of W and Z */
static PetscErrorCode BeyondApply(const Projection *p, BV W, BV Z)
{
  Mat w, z, Mw, Kw, b;

  PetscFunctionBeginUser;
  PetscCall(BVGetMat(W, &w));
  PetscCall(BVGetMat(Z, &z));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &b));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &Mw));
  PetscCall(MatDuplicate(z, MAT_DO_NOT_COPY_VALUES, &Kw));
  PetscCall(BlockMultiplyEach(3, (Mat[]){p->pencil->C, p->pencil->M, p->pencil->K}, w, (Mat[]){b, Mw, Kw}));
  if (!p->pencil->n_laws) {
    PetscCall(MatAXPY(b, -p->alpha, Mw, SAME_NONZERO_PATTERN));
    PetscCall(MatAXPY(b, -p->beta, Kw, SAME_NONZERO_PATTERN));
  }
  PetscCall(BeyondAddLaws(p, w, b));
  PetscCall(ShiftInvertApplyBlock(&p->si, PETSC_FALSE, b, z));
  PetscCall(MatDestroy(&Kw));
  PetscCall(MatDestroy(&Mw));
  PetscCall(MatDestroy(&b));
  PetscCall(BVRestoreMat(Z, &z));
  PetscCall(BVRestoreMat(W, &w));
  PetscFunctionReturn(0);
}

/* Largest |eigenvalue| of H, which is overwritten, [n * n] */
static PetscErrorCode SpectralRadius(PetscInt n, PetscReal H[], PetscReal *radius)
{
  PetscReal *w, *vectors;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * n, &w, 2 * n * n, &vectors));
  PetscCall(DenseEigen(n, H, w, w + n, vectors, vectors + n * n));
  *radius = 0;
  for (PetscInt i = 0; i < n; i++) *radius = PetscMax(*radius, hypot(w[i], w[n + i]));
  PetscCall(PetscFree2(w, vectors));
  PetscFunctionReturn(0);
}

/* A block Krylov space on the complement of V, whose columns stand behind those of V meanwhile */
typedef struct {
  PetscInt n;
  BV       U, images, block; /* U, orthonormal, n columns; P^-1 R U; what the next step takes in */
} BeyondSpace;

/* The empty space, with a random block */
static PetscErrorCode BeyondCreate(const Projection *p, BeyondSpace *s)
{
  PetscInt has;

  PetscFunctionBeginUser;
  *s = (BeyondSpace){.n = 0};
  PetscCall(BlockCreate(p->space.V, BEYOND_BLOCK * BEYOND_STEPS, &s->U));
  PetscCall(BlockCreate(p->space.V, BEYOND_BLOCK * BEYOND_STEPS, &s->images));
  PetscCall(BVGetSizes(p->space.V, NULL, NULL, &has));
  if (has < p->space.n + BEYOND_BLOCK * BEYOND_STEPS)
    PetscCall(BVResize(p->space.V, p->space.n + BEYOND_BLOCK * BEYOND_STEPS, PETSC_TRUE));
  PetscCall(BlockCreate(p->space.V, BEYOND_BLOCK, &s->block));
  PetscCall(SolverSeed(s->block, 1984));
  for (PetscInt j = 0; j < BEYOND_BLOCK; j++) PetscCall(BVSetRandomColumn(s->block, j));
  PetscFunctionReturn(0);
}

static PetscErrorCode BeyondDestroy(const Projection *p, BeyondSpace *s)
{
  BV *const all[] = {&s->U, &s->images, &s->block};

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(p->space.V, 0, p->space.n));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(all); i++) PetscCall(BVDestroy(all[i]));
  PetscFunctionReturn(0);
}

/* Takes in a block; grows = there was something in it */
static PetscErrorCode BeyondStep(const Projection *p, BeyondSpace *s, PetscBool *grows)
{
  PetscInt m;
  BV       image;

  PetscFunctionBeginUser;
  PetscCall(BlockOrthonormalise(p->space.V, p->space.n + s->n, p->pencil->M, 0, s->block));
  PetscCall(BVGetActiveColumns(s->block, NULL, &m));
  *grows = m ? PETSC_TRUE : PETSC_FALSE;
  if (!m) PetscFunctionReturn(0);
  PetscCall(BlockCreate(p->space.V, m, &image));
  PetscCall(BeyondApply(p, s->block, image));
  PetscCall(BVSetActiveColumns(p->space.V, p->space.n + s->n, p->space.n + s->n + m));
  PetscCall(BVCopy(s->block, p->space.V));
  PetscCall(BVSetActiveColumns(s->U, s->n, s->n + m));
  PetscCall(BVCopy(s->block, s->U));
  PetscCall(BVSetActiveColumns(s->images, s->n, s->n + m));
  PetscCall(BVCopy(image, s->images));
  PetscCall(BVDestroy(&s->block));
  s->block = image;
  s->n += m;
  PetscFunctionReturn(0);
}

/* The spectral radius of P^-1 R on the space */
static PetscErrorCode BeyondRadius(const Projection *p, const BeyondSpace *s, PetscReal *radius)
{
  PetscReal *H;
  Mat        product;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(s->U, 0, s->n));
  PetscCall(BVSetActiveColumns(s->images, 0, s->n));
  PetscCall(BlockProducts(s->U, p->pencil->M, s->images, &product));
  PetscCall(PetscMalloc1(s->n * s->n, &H));
  PetscCall(BlockCopy(product, PETSC_FALSE, s->n, H));
  PetscCall(SpectralRadius(s->n, H, radius));
  PetscCall(PetscFree(H));
  PetscCall(MatDestroy(&product));
  PetscCallMPI(MPI_Bcast(radius, 1, MPIU_REAL, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionMeasureBeyond(const Projection *p, PetscReal *rho)
{
  const Window      *w      = p->window;
  const PetscComplex lambda = CMPLX(0, PetscMax(w->high, w->target));
  const PetscReal    factor = cabs(lambda / (1 + (p->pencil->n_laws ? 0 : p->beta) * lambda));
  PetscBool          grows  = PETSC_TRUE;
  BeyondSpace        space;

  PetscFunctionBeginUser;
  *rho = 0;
  PetscCall(BeyondCreate(p, &space));
  for (int step = 1; step <= BEYOND_STEPS && grows; step++) {
    PetscCall(BeyondStep(p, &space, &grows));
    if (!space.n || (step == 1 && grows)) continue;
    PetscCall(BeyondRadius(p, &space, rho));
    *rho *= factor;
    if (*rho < BEYOND_CLEAR) break;
  }
  PetscCall(BeyondDestroy(p, &space));
  PetscFunctionReturn(0);
}
