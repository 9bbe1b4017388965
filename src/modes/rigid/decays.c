/*
   Decays of rigid motions, real eigenvalues next to zero: a mass on a dashpot, lambda = -alpha. Rounding of K, which is
   as large as its largest entries, moves them by machine epsilon x'|K| x / |y'C x|, per cents where damping is weak.
   The left null vectors Y, Y'K = 0, know nothing of K: of every eigenvector with lambda != 0

      lambda Y'M x + Y'C x = 0,   lambda = - a.b / a.a,   a = Y'M x,  b = Y'C x,   Y'M Y = 1.

   So lambda is corrected by it where a holds most of x. Rounding x'K x = kappa makes of 0 and -alpha the roots of
   lambda^2 + alpha lambda + kappa = 0: a root that comes of -alpha is nearer to it than to 0.
*/
#include "modes/modesimpl.h"

#define DECAY_RIGID 0.5 /* of |x| in M: a rigid motion */
#define DECAY_MOST  0.9 /* of lambda: a larger correction is that of a zero */
/* |b - alpha a| / |b|: both parts of x are of one decay, which rounding has made a pair of conjugates */
#define DECAY_ONE  1e-4
#define DECAY_NULL 100 /* roundings of sum_i |K_ii| y_i^2, the most that y'K y of a null vector is */

/* What the left null vectors y [n] see of a pencil; work [2] */
typedef struct {
  const PencilMatrices *pencil;
  PetscInt              n;
  Vec                  *y, work[2];
} Decays;

/* Whether entry i decays next to zero */
static PetscBool DecayIs(const Spectrum *s, PetscInt i, PetscReal scale)
{
  return s->sigma[i] != 0 && hypot(s->sigma[i], s->omega[i]) <= scale ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool NullHasDecays(const Modes modes, const Window *window)
{
  const Spectrum *s   = &modes->right;
  PetscBool       has = PETSC_FALSE;

  for (PetscInt i = 0; i < s->n && !has; i++) has = DecayIs(s, i, window->known.scale);
  return has;
}

/* Whether K does no more than rounding to y; work [2] */
static PetscErrorCode DecayIsNull(Mat K, Vec y, Vec work[], PetscBool *null)
{
  PetscReal energy, size;

  PetscFunctionBeginUser;
  PetscCall(MatMult(K, y, work[0]));
  PetscCall(VecDot(work[0], y, &energy));
  PetscCall(MatGetDiagonal(K, work[0]));
  PetscCall(VecAbs(work[0]));
  PetscCall(VecPointwiseMult(work[1], y, y));
  PetscCall(VecDot(work[0], work[1], &size));
  *null = PetscAbsReal(energy) <= DECAY_NULL * PETSC_MACHINE_EPSILON * size ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The left null vectors */
static PetscErrorCode DecaysFindNull(Modes modes, const PencilMatrices *pencil, const Window *window, Decays *d)
{
  PetscReal *error;
  PetscBool  null;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(window->known.rigid, &error));
  if (modes->n_null_left == window->known.rigid) {
    for (PetscInt j = 0; j < modes->n_null_left; j++) PetscCall(VecCopy(modes->null_left[j], d->y[j]));
  } else {
    const PetscBool transposed = pencil->symmetric ? PETSC_FALSE : PETSC_TRUE;

    PetscCall(NullFactor(modes, pencil, window));
    PetscCall(NullIterate(modes, pencil, transposed, window->known.rigid, d->y, error));
  }
  for (PetscInt j = 0; j < window->known.rigid; j++) {
    PetscCall(DecayIsNull(pencil->K, d->y[j], d->work, &null));
    if (null) PetscCall(VecSwap(d->y[j], d->y[d->n++]));
  }
  PetscCall(PetscFree(error));
  PetscFunctionReturn(0);
}

/* The decay of x; found where x is a rigid motion, and alone where nothing else is in x */
static PetscErrorCode DecayOf(const Decays *d, Vec x, PetscReal *lambda, PetscBool *found, PetscBool *alone)
{
  PetscScalar *a, *b;
  PetscReal    square, aa = 0, ab = 0, bb = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(d->n, &a, d->n, &b));
  PetscCall(MatMult(d->pencil->M, x, d->work[0]));
  PetscCall(MatMult(d->pencil->C, x, d->work[1]));
  PetscCall(VecDot(d->work[0], x, &square));
  PetscCall(VecMDot(d->work[0], d->n, d->y, a));
  PetscCall(VecMDot(d->work[1], d->n, d->y, b));
  for (PetscInt j = 0; j < d->n; j++) aa += a[j] * a[j], ab += a[j] * b[j], bb += b[j] * b[j];
  *found  = aa > DECAY_RIGID * DECAY_RIGID * square ? PETSC_TRUE : PETSC_FALSE;
  *lambda = *found ? -ab / aa : 0;
  *alone  = *found && bb - ab * ab / aa <= PetscSqr(DECAY_ONE) * bb ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscFree2(a, b));
  PetscFunctionReturn(0);
}

/* Makes two entries of the pair i of conjugates, of its real and its imaginary part */
static PetscErrorCode SpectrumSplit(Spectrum *s, PetscInt i)
{
  PetscInt *from;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n + 1, &from));
  for (PetscInt k = 0; k <= s->n; k++) from[k] = k > i ? k - 1 : k;
  PetscCall(SpectrumTakeFrom(s, s->n + 1, from));
  PetscCall(PetscFree(from));
  s->omega[i] = s->omega[i + 1] = 0;
  PetscCall(VecDestroy(&s->xi[i]));
  PetscCall(VecDestroy(&s->xr[i + 1]));
  s->xr[i + 1] = s->xi[i + 1];
  s->xi[i + 1] = NULL;
  PetscFunctionReturn(0);
}

/* Splits entry i where it is one decay of two rigid motions, lambda and mu, which ask for no more than rounding */
static PetscErrorCode DecaySplit(Modes modes, const Decays *d, PetscInt i)
{
  Spectrum *s = &modes->right, *left = &modes->left_spectrum;
  PetscReal lambda, mu;
  PetscBool found[2], alone[2];

  PetscFunctionBeginUser;
  if (!s->xi[i] || s->omega[i] == 0 || (left->n && !left->xi[i])) PetscFunctionReturn(0);
  PetscCall(DecayOf(d, s->xr[i], &lambda, &found[0], &alone[0]));
  PetscCall(DecayOf(d, s->xi[i], &mu, &found[1], &alone[1]));
  if (!alone[0] || !alone[1] || PetscAbsReal(lambda - mu) > DECAY_ONE * PetscAbsReal(lambda)) PetscFunctionReturn(0);
  PetscCall(SpectrumSplit(s, i));
  if (left->n) PetscCall(SpectrumSplit(left, i));
  PetscFunctionReturn(0);
}

/* Corrects entry i */
static PetscErrorCode DecayCorrect(Modes modes, const Decays *d, PetscInt i)
{
  PetscReal *sigma, lambda;
  PetscBool  found, alone;

  PetscFunctionBeginUser;
  PetscCall(DecaySplit(modes, d, i));
  sigma = &modes->right.sigma[i];
  if (modes->right.omega[i] != 0) PetscFunctionReturn(0);
  PetscCall(DecayOf(d, modes->right.xr[i], &lambda, &found, &alone));
  if (found && PetscAbsReal(lambda - *sigma) <= DECAY_MOST * PetscAbsReal(*sigma)) *sigma = lambda;
  PetscFunctionReturn(0);
}

/* The corrected eigenvalues in their order */
static PetscErrorCode DecaysSort(Modes modes)
{
  PetscInt *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(modes->right.n, &order));
  PetscCall(SpectrumOrder(&modes->right, order));
  PetscCall(SpectrumPermute(&modes->right, order));
  if (modes->left_spectrum.n) PetscCall(SpectrumPermute(&modes->left_spectrum, order));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}

PetscErrorCode NullDecaysCorrect(Modes modes, const PencilMatrices *damped, const Window *window)
{
  const PencilMatrices undamped = {.K = damped->K, .M = damped->M, .symmetric = damped->symmetric};
  Spectrum            *s        = &modes->right;
  Decays               d        = {.pencil = damped};

  PetscFunctionBeginUser;
  if (!NullHasDecays(modes, window) || !damped->C || !window->known.rigid || window->route.mapped)
    PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(damped->K, &d.work[0], &d.work[1]));
  PetscCall(VecDuplicateVecs(d.work[0], window->known.rigid, &d.y));
  PetscCall(DecaysFindNull(modes, &undamped, window, &d));
  for (PetscInt i = 0; i < s->n && d.n; i++)
    if (DecayIs(s, i, window->known.scale)) PetscCall(DecayCorrect(modes, &d, i));
  PetscCall(DecaysSort(modes));
  PetscCall(VecDestroyVecs(window->known.rigid, &d.y));
  PetscCall(VecDestroy(&d.work[0]));
  PetscCall(VecDestroy(&d.work[1]));
  PetscFunctionReturn(0);
}
