/* Floquet multipliers of a cycle (shooting.h): that of the phase, told by its vector, and the largest of the others */
#include "shooting.h"
#include "base/algebra/dense.h"
#include <math.h>

#define SHOOTING_FAR  0.5 /* from 1: no steps of a cycle move the multiplier of the phase so far */
#define SHOOTING_MUCH 0.5 /* of the largest part of the motion: parts beside which that one is not told */

/* From -1: rounding of an eigenvalue that is -1 exactly. */
#define SHOOTING_ALTERNATES 1e-9

/* Eigenvalues and vectors of M, in LAPACK's real storage */
typedef struct {
  PetscReal *A, *re, *im, *left, *right; /* [n][n], [n], [n], [n][n], [n][n] */
} Multipliers;

/* z = l^H v of the vector of eigenvalue i that begins at `l`, v complex, its imaginary part NULL for none */
static PetscComplex StabilityDot(PetscInt n, const PetscReal l[], PetscReal im, const PetscReal v[],
                                 const PetscReal vi[])
{
  PetscReal re = 0, i = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal li = im == 0 ? 0 : l[n + k], w = vi ? vi[k] : 0;

    re += l[k] * v[k] + li * w;
    i += l[k] * w - li * v[k];
  }
  return PetscCMPLX(re, i);
}

/* The part that vector r_i has in the motion v = sum_i r_i (l_i^H v) / (l_i^H r_i), over the length of v, both in S x:
   1 for the phase and 0 for all others without errors, however alike the vectors are. i is the first of a conjugate
   pair */
static PetscReal StabilityPart(const Shooting *s, const Multipliers *m, PetscInt i, const PetscReal v[])
{
  const PetscInt   n = s->n;
  const PetscReal *l = &m->left[n * i], *r = &m->right[n * i], im = m->im[i];
  const PetscReal  self   = PetscAbsComplex(StabilityDot(n, l, im, r, im == 0 ? NULL : r + n));
  PetscReal        length = 0, size = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal w = PetscSqr(s->weight[k]);

    length += w * (PetscSqr(r[k]) + (im == 0 ? 0 : PetscSqr(r[n + k])));
    size += w * PetscSqr(v[k]);
  }
  if (self == 0 || size == 0) return 0;
  return PetscAbsComplex(StabilityDot(n, l, im, v, NULL)) / self * PetscSqrtReal(length / size);
}

/* Which of the eigenvalues is that of the phase, -1 for none: its vector makes most of the motion v along the cycle.
   Where others have about as much part in it (at a fold two vectors become one) the nearest to 1 is taken; how many
   there are */
static PetscErrorCode StabilityFindPhase(const Shooting *s, const PetscReal v[], const Multipliers *m, PetscInt *phase,
                                         PetscInt *n_candidates)
{
  PetscReal *part, best = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n, &part));
  for (PetscInt i = 0; i < s->n; i++) {
    part[i] = 0;
    if (hypot(m->re[i] - 1, m->im[i]) < SHOOTING_FAR) part[i] = m->im[i] < 0 ? part[i - 1] : StabilityPart(s, m, i, v);
    best = PetscMax(best, part[i]);
  }
  *phase        = -1;
  *n_candidates = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    if (part[i] <= 0 || part[i] < SHOOTING_MUCH * best) continue;
    (*n_candidates)++;
    if (*phase < 0 || hypot(m->re[i] - 1, m->im[i]) < hypot(m->re[*phase] - 1, m->im[*phase])) *phase = i;
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* Takes out the n_free eigenvalues nearest to 1, as shifts along free directions change nothing, and those that are -1,
   where forces alternate from step to step for ever, as nothing moves by them */
static void StabilityDrop(const Shooting *s, Multipliers *m)
{
  for (PetscInt k = 0; k < s->n_free; k++) {
    PetscInt at = 0;

    for (PetscInt i = 0; i < s->n; i++)
      if (hypot(m->re[i] - 1, m->im[i]) < hypot(m->re[at] - 1, m->im[at])) at = i;
    m->re[at] = m->im[at] = 0;
  }
  for (PetscInt i = 0; i < s->n; i++)
    if (hypot(m->re[i] + 1, m->im[i]) < SHOOTING_ALTERNATES) m->re[i] = m->im[i] = 0;
}

/* worst = the largest modulus of all multipliers where it is open which one is that of the phase, else of the
   others, as `largest` is. */
PetscErrorCode ShootingGetStability(const Shooting *s, const ShootingCycle *cycle, ShootingStability *stability)
{
  const PetscInt n     = s->n;
  PetscInt       found = -1, n_candidates = 0;
  ShootingPhase  phase;
  Multipliers    m;

  PetscFunctionBeginUser;
  *stability = (ShootingStability){.phase = {NAN, NAN}, .slope = NAN, .check = NAN};
  PetscCall(PetscMalloc6(n * n, &m.A, n, &m.re, n, &m.im, n * n, &m.left, n * n, &m.right, n, &phase.x));
  PetscCall(PetscArraycpy(m.A, cycle->M, n * n));
  PetscCall(DenseEigen(n, m.A, m.re, m.im, m.left, m.right));
  StabilityDrop(s, &m);
  PetscCall(ShootingGetPhase(s, cycle, &phase));
  if (phase.known) {
    stability->slope = phase.slope;
    stability->check = phase.check;
    PetscCall(StabilityFindPhase(s, phase.x, &m, &found, &n_candidates));
  }
  for (PetscInt i = 0; i < n; i++) stability->worst = PetscMax(stability->worst, hypot(m.re[i], m.im[i]));
  if (found >= 0) {
    stability->phase[0] = m.re[found];
    stability->phase[1] = m.im[found];
    m.re[found] = m.im[found] = 0;
  }
  for (PetscInt i = 0; i < n; i++) {
    if (hypot(m.re[i], m.im[i]) <= hypot(stability->largest[0], stability->largest[1])) continue;
    stability->largest[0] = m.re[i];
    stability->largest[1] = PetscAbsReal(m.im[i]);
  }
  if (n_candidates == 1) stability->worst = hypot(stability->largest[0], stability->largest[1]);
  PetscCall(PetscFree6(m.A, m.re, m.im, m.left, m.right, phase.x));
  PetscFunctionReturn(0);
}
