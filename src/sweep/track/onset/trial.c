/*
   The modes that take part in an onset: which they are at a trial value, and the function g of onset.c.
*/
#include "trial.h"
#include <petscblaslapack.h>

/* Distance from one of the product of two modes that certainly are the same: two modes share 1, so that no other
   one has more than 0.3 with it. */
#define FOLLOW_SAME 0.3

PetscErrorCode TrialDestroy(Trial *trial)
{
  PetscFunctionBeginUser;
  PetscCall(ModeFrameDestroy(&trial->frame));
  PetscCall(PetscFree(trial->member));
  PetscFunctionReturn(0);
}

/* S = Y' A X [k * k] with real A of the frame; Z [k][size] is work */
static PetscErrorCode PlaneProduct(const Trial *trial, const PetscReal A[], const PetscReal X[], const PetscReal Y[],
                                   PetscReal Z[], PetscReal S[])
{
  const PetscReal one = 1, zero = 0;
  PetscBLASInt    n, k;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(trial->frame->form.n, &n));
  PetscCall(PetscBLASIntCast(trial->k, &k));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &n, &k, &n, &one, A, &n, X, &n, &zero, Z, &n));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &k, &k, &n, &one, Y, &n, Z, &n, &zero, S, &k));
  PetscFunctionReturn(0);
}

/* Square of the growth at which a pair of mean m, lambda^2 = -m +- i e, counts as unstable: with |lambda|^2 = m + 2 L^2
   for L = ratio |lambda| */
static PetscReal PlaneLimit(const ModesLimit *limit, PetscReal m)
{
  const PetscReal square = PetscSqr(limit->ratio);

  return PetscMax(PetscSqr(limit->growth), square < 0.5 ? square * PetscMax(m, 0) / (1 - 2 * square) : PETSC_INFINITY);
}

/* g and m of the plane of the trial's members, S = (Y' M X)^-1 Y' K X [k][k]: m = tr S / k, (rad/s)^2, d = tr (S -
   m I)^2 / k, (rad/s)^4, without eigenvalues of S, which would be of the root of rounding at lock-in. Growth L is
   e^2 = -d = 4 L^2 (m + L^2). */
static PetscErrorCode PlaneDiscriminant(Trial *trial)
{
  const ModeFrame *f = trial->frame;
  const PetscInt   n = f->form.n, k = trial->k;
  PetscBLASInt    *pivot;
  PetscReal       *X, *Y, *Z, *G, *S, d = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(k * n, &X, k * n, &Y, k * n, &Z, k * k, &G, k * k, &S, k, &pivot));
  PetscCall(ModePlaneFollow(f, k, trial->member, X, Y, &trial->settled));
  PetscCall(PlaneProduct(trial, f->pencil.M, X, Y, Z, G));
  PetscCall(PlaneProduct(trial, f->pencil.K, X, Y, Z, S));
  PetscCall(DenseFactor(k, G, pivot, NULL));
  PetscCall(DenseSolve(k, G, pivot, PETSC_FALSE, k, S));
  trial->m = 0;
  for (PetscInt a = 0; a < k; a++) trial->m += S[a * k + a] / k;
  for (PetscInt a = 0; a < k; a++) S[a * k + a] -= trial->m;
  for (PetscInt a = 0; a < k; a++)
    for (PetscInt b = 0; b < k; b++) d += S[a * k + b] * S[b * k + a] / k;
  trial->limit = PlaneLimit(&f->limit, trial->m);
  trial->g     = -d - 4 * trial->limit * (trial->m + trial->limit);
  PetscCall(PetscFree6(X, Y, Z, G, S, pivot));
  PetscFunctionReturn(0);
}

/* -kappa of a single mode, kappa = y^T K x / (y^T M x), which is -lambda^2 without damping and of the sign of -lambda
   near lambda = 0 with it; lambda itself is rounded to zero there */
static PetscErrorCode ModeStiffness(Trial *trial)
{
  const ModeFrame    *f = trial->frame;
  const PetscComplex *x = f->modes.x + trial->member[0] * f->form.n, *y = f->modes.y + trial->member[0] * f->form.n;
  PetscComplex        k = 0, m = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < f->form.n; c++) {
    for (PetscInt r = 0; r < f->form.n; r++) {
      k += y[r] * f->pencil.K[c * f->form.n + r] * x[c];
      m += y[r] * f->pencil.M[c * f->form.n + r] * x[c];
    }
  }
  trial->g = -creal(k / m) - PetscSqr(f->limit.growth);
  PetscFunctionReturn(0);
}

/* g of the members */
PetscErrorCode TrialValue(OnsetKind kind, Trial *trial)
{
  const PetscComplex lambda = trial->frame->modes.lambda[trial->member[0]];

  PetscFunctionBeginUser;
  if (kind == ONSET_PAIR)
    PetscCall(PlaneDiscriminant(trial));
  else if (kind == ONSET_GROWTH)
    trial->g = creal(lambda) - ModesLimitGrowth(&trial->frame->limit, cabs(lambda));
  else
    PetscCall(ModeStiffness(trial));
  PetscFunctionReturn(0);
}

/* The k modes of the trial that have most in common with the plane of the reference */
PetscErrorCode TrialIdentify(const Trial *reference, Trial *trial, PetscBool *found)
{
  const ModeFrame *a = reference->frame, *b = trial->frame;
  const PetscInt   nb = b->modes.n, k = reference->k, *member = reference->member;
  PetscComplex    *sum;
  PetscBool       *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(nb, &sum, nb, &taken));
  PetscCall(PetscMalloc1(k, &trial->member));
  for (PetscInt r = 0; r < k; r++) ModeFrameOverlap(b, a->W + member[r] * a->N, a->X + member[r] * a->N, sum);
  *found = nb >= k ? PETSC_TRUE : PETSC_FALSE;
  for (trial->k = 0; trial->k < k && *found; trial->k++) {
    PetscInt best = -1;

    for (PetscInt j = 0; j < nb; j++)
      if (!taken[j] && (best < 0 || cabs(sum[b->cluster[j]]) > cabs(sum[b->cluster[best]]))) best = j;
    if (cabs(sum[b->cluster[best]]) < 0.2) *found = PETSC_FALSE;
    taken[best]             = PETSC_TRUE;
    trial->member[trial->k] = best;
  }
  PetscCall(PetscFree2(sum, taken));
  PetscFunctionReturn(0);
}

/* Whether a trial of one mode has the same as the reference */
PetscBool TrialIsSame(const Trial *reference, const Trial *trial)
{
  const ModeFrame *a = reference->frame, *b = trial->frame;
  const PetscInt   i   = reference->member[0];
  PetscComplex     sum = 0;

  if (cimag(b->modes.lambda[0]) <= 0) return PETSC_FALSE;
  ModeFrameOverlap(b, a->W + i * a->N, a->X + i * a->N, &sum);
  return cabs(sum - 1) < FOLLOW_SAME ? PETSC_TRUE : PETSC_FALSE;
}

/* k modes of one eigenvalue, sqrt(m) i, in the plane of the reference */
static PetscErrorCode PlaneGuess(const Trial *reference, PetscReal m, ReducedModes *guess)
{
  const ModeFrame *a = reference->frame;

  PetscFunctionBeginUser;
  PetscCall(ReducedModesCreate(reference->k, a->N, guess));
  for (PetscInt r = 0; r < reference->k; r++) {
    guess->lambda[r] = CMPLX(0, PetscSqrtReal(m));
    PetscCall(PetscArraycpy(guess->x + r * a->N, a->X + reference->member[r] * a->N, a->N));
    PetscCall(PetscArraycpy(guess->y + r * a->N, a->Y + reference->member[r] * a->N, a->N));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TrialFollowPlane(ModeSource *source, PetscReal value, PetscReal m, const Trial *reference, Trial *trial,
                                PetscBool *found)
{
  const ModeFrame *a = reference->frame;
  ReducedModes     guess;
  PetscComplex    *sum;
  ModeFrame       *b;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (m <= 0) PetscFunctionReturn(0);
  source->n_followed++;
  PetscCall(PlaneGuess(reference, m, &guess));
  PetscCall(ModeSourceTake(source, value, &guess, &trial->frame));
  PetscCall(ReducedModesDestroy(&guess));
  b        = trial->frame;
  trial->k = reference->k;
  PetscCall(PetscMalloc1(trial->k, &trial->member));
  for (PetscInt r = 0; r < trial->k; r++) trial->member[r] = r;
  PetscCall(PetscArraycpy(b->modes.x, b->X, trial->k * b->N));
  PetscCall(PetscArraycpy(b->modes.y, b->Y, trial->k * b->N));
  PetscCall(PlaneDiscriminant(trial));
  PetscCall(PetscCalloc1(trial->k, &sum));
  for (PetscInt r = 0; r < trial->k; r++)
    ModeFrameOverlap(b, a->W + reference->member[r] * a->N, a->X + reference->member[r] * a->N, sum);
  *found = trial->settled && cabs(sum[0] / trial->k - 1) < FOLLOW_SAME ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree(sum));
  if (!*found) PetscCall(TrialDestroy(trial));
  PetscFunctionReturn(0);
}

/* Makes member 0 of a frame of one mode the trial's, or lets the frame go */
PetscErrorCode TrialTakeSingle(Trial *trial, PetscBool good)
{
  PetscFunctionBeginUser;
  if (!good) {
    PetscCall(TrialDestroy(trial));
    PetscFunctionReturn(0);
  }
  trial->k = 1;
  PetscCall(PetscCalloc1(1, &trial->member));
  PetscFunctionReturn(0);
}
