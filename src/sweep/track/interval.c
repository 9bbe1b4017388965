/*
   Places between two points where the modes may not do what the points show. The modes i, k of point a are predicted on
   the way to b by their 2 x 2 problem in the pencil of b,

      S(t) = diag(s_i, s_k) + t (S_b - diag(s_i, s_k)),   S_b = (Y^T B_b X)^-1 Y^T A_b X,   0 <= t <= 1,

   likewise those of b on the way to a. With delta(t) = delta_a + t (delta_b - delta_a) the difference of the diagonal
   and c = S_ik S_ki the coupling, the eigenvalues differ by 2 sqrt(d), d = delta^2 / 4 + t^2 c.

   Instability of modes that are stable at both ends. Undamped, d(t) is a parabola, so that an interval of any width
   where d < 0 is found, at its lowest point; damped, the growth is looked at where the frequencies cross and at equal
   steps.
   Veering. Modes that change places in the order of frequency cross when c = 0, else they veer, which vectors from
   before and after do not tell. The step is divided at the crossing if the gap is wider than what halving can resolve.

   What this guarantees: the model is exact for two modes of an affine pencil that do not couple with others, and
   otherwise to second order in the coupling times the step; the sweep is divided at the predicted place and asked
   again, so that the error of the model shrinks with the interval. An instability is missed when neither end of the
   step predicts it: when it is brought about by modes that both are not in the window, by two modes whose coupling
   changes altogether within the step, or, with damping, when it is small and several modes contribute to it. Pairs in
   flutter that veer with other pairs within one step are not looked at.
*/
#include "match.h"

#define NARROW 1e-12 /* |d| relative to kappa^2 below which a coalescence is not distinguished from a crossing */
/* Equal steps at which the growth of a damped pair is looked at; it has no more than few extremes, and each look is
   a quadratic equation. */
#define GROWTH_STEPS 32
#define MIXED        0.1 /* |t^2 c| over |delta / 2|^2 from which vectors of crossing modes mix */

/* S_b of modes i, k [2 * 2], row by row: the inverse of the 2 x 2 part of G = Y^T B X times that of H = Y^T A X.
   False where vectors of a are nearly dependent in B of b, det G < 1e-3 of its diagonal product. */
static PetscBool PairMatrix(const PetscComplex H[], const PetscComplex G[], PetscInt n, PetscInt i, PetscInt k,
                            PetscComplex S[])
{
  const PetscComplex a = G[i * n + i], b = G[k * n + i], c = G[i * n + k], d = G[k * n + k], det = a * d - b * c;
  const PetscComplex e = H[i * n + i], f = H[k * n + i], g = H[i * n + k], h = H[k * n + k];

  if (cabs(det) < 1e-3 * cabs(a * d) || det == 0) return PETSC_FALSE;
  S[0] = (d * e - b * g) / det;
  S[1] = (d * f - b * h) / det;
  S[2] = (a * g - c * e) / det;
  S[3] = (a * h - c * f) / det;
  return PETSC_TRUE;
}

/* Lowest point of d(t) = (delta_a + t slope)^2 / 4 + t^2 c when it is below -least: d'(t) = 0 at t = -delta_a slope
   / (slope^2 + 4 c). Without coupling of opposite sign (c >= 0) d is a sum of squares. At t = 1, the other end,
   which is known to be stable, the middle is asked instead. */
static PetscBool PredictUndamped(PetscReal delta_a, PetscReal delta_b, PetscReal coupling, PetscReal least,
                                 PetscReal *t)
{
  const PetscReal slope = delta_b - delta_a, curvature = slope * slope + 4 * coupling;
  PetscReal       d;

  if (coupling >= 0) return PETSC_FALSE;
  *t = curvature > 0 ? PetscMin(-delta_a * slope / curvature, 1) : 1;
  if (*t <= 0) return PETSC_FALSE;
  d = PetscSqr(delta_a + *t * slope) / 4 + *t * *t * coupling;
  if (*t == 1) *t = 0.5;
  return d < -least ? PETSC_TRUE : PETSC_FALSE;
}

/* Larger growth of the two eigenvalues lambda of diag(s) + t (S - diag(s)) */
static PetscReal PairGrowth(const PetscComplex s[], const PetscComplex S[], PetscReal t)
{
  const PetscComplex p = s[0] + t * (S[0] - s[0]), q = s[1] + t * (S[3] - s[1]);
  const PetscComplex root = csqrt((p - q) * (p - q) / 4 + t * t * S[1] * S[2]);

  return creal((p + q) / 2) + PetscAbsReal(creal(root));
}

/* Where the growth exceeds the limit most, first where the frequencies cross: there the coupling does most. */
static PetscBool PredictDamped(const PetscComplex s[], const PetscComplex S[], PetscReal limit, PetscReal *t)
{
  const PetscReal delta_a = cimag(s[0] - s[1]), delta_b = cimag(S[0] - S[3]);
  PetscReal       largest = limit;

  *t = -1;
  for (PetscInt step = 0; step <= GROWTH_STEPS; step++) {
    const PetscReal at =
      step ? (PetscReal)step / GROWTH_STEPS : (delta_a != delta_b ? delta_a / (delta_a - delta_b) : 0);
    const PetscReal growth = at > 0 && at <= 1 ? PairGrowth(s, S, at) : PETSC_MIN_REAL;

    if (growth > largest) largest = growth, *t = at;
  }
  return *t > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether modes whose frequencies cross at t veer instead: they mix there, |t^2 c| >= MIXED |delta / 2|^2, and the
   gap 2 |sqrt(d)| is wider than the resolution, what is left of the step after all halvings. */
static PetscBool PredictVeering(PetscComplex delta_a, PetscComplex delta_b, PetscComplex coupling, PetscBool damped,
                                PetscReal resolution, PetscReal *t)
{
  const PetscReal from = damped ? cimag(delta_a) : creal(delta_a), to = damped ? cimag(delta_b) : creal(delta_b);
  PetscComplex    half, mixing;

  *t = 0.5;
  if (from * to >= 0) return resolution < 0.5 ? PETSC_TRUE : PETSC_FALSE; /* no crossing: the step is too large */
  *t     = from / (from - to);
  half   = (delta_a + *t * (delta_b - delta_a)) / 2;
  mixing = *t * *t * coupling;
  if (cabs(mixing) < MIXED * cabs(half * half)) return PETSC_FALSE;
  return 2 * cabs(csqrt(half * half + mixing)) > resolution * PetscAbsReal(to - from) ? PETSC_TRUE : PETSC_FALSE;
}

/* From point a towards b */
typedef struct {
  const ModeFrame *a, *b;
  const PetscInt  *other; /* [modes of a] mode of b or -1 */
  PetscReal        resolution;
} IntervalStep;

/* Modes that take part: vibrating, with a partner at the other end, stable and alone in their cluster */
static PetscBool ModeTakesPart(const IntervalStep *step, PetscInt i)
{
  const ModeFrame *a = step->a;

  if (step->other[i] < 0 || a->modes.rigid[i] || cimag(a->modes.lambda[i]) == 0) return PETSC_FALSE;
  return ModeFrameClusterSize(a, i) == 1 && !ModeFrameIsUnstable(a, i) ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether the match exchanges the frequencies of modes i and k */
static PetscBool ModesSwap(const IntervalStep *step, PetscInt i, PetscInt k)
{
  const PetscComplex *p = step->a->modes.lambda, *q = step->b->modes.lambda;
  const PetscInt     *other = step->other;

  return cimag(p[i] - p[k]) * cimag(q[other[i]] - q[other[k]]) < 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* least, in the unit of d: rounding of kappa^2, or (2 L omega)^2, the discriminant at which the growth is the limit
   L; limit, rad/s, is that of a damped pair, no less than its errors. */
static PetscBool PredictPair(const IntervalStep *step, PetscInt i, PetscInt k, const PetscComplex S[], PetscReal *t)
{
  const ModeFrame    *a = step->a, *b = step->b;
  const PetscInt     *other   = step->other;
  const ReducedModes *modes   = &a->modes;
  const PetscComplex  s[2]    = {StandardValue(&a->form, modes->lambda[i]), StandardValue(&a->form, modes->lambda[k])};
  const PetscComplex  delta_a = s[0] - s[1], delta_b = S[0] - S[3], coupling = S[1] * S[2];
  const PetscReal     size = cabs(modes->lambda[i]), growth = ModesLimitGrowth(&a->limit, size);
  const PetscReal     limit = PetscMax(PetscMax(MODES_TINY * size, growth), modes->error[i] + modes->error[k]);
  const PetscReal     least = PetscMax(NARROW * PetscSqr(cabs(s[0])), PetscSqr(2 * growth * size));

  if (!ModeFrameIsUnstable(b, other[i]) && !ModeFrameIsUnstable(b, other[k])) {
    if (a->form.damped && PredictDamped(s, S, limit, t)) return PETSC_TRUE;
    if (!a->form.damped && PredictUndamped(creal(delta_a), creal(delta_b), creal(coupling), least, t))
      return PETSC_TRUE;
  }
  if (!ModesSwap(step, i, k)) return PETSC_FALSE;
  return PredictVeering(delta_a, delta_b, coupling, a->form.damped, step->resolution, t);
}

/* Looks at all pairs */
static PetscErrorCode PredictStep(const IntervalStep *step, PetscReal *t, PetscBool *found)
{
  const PetscInt n = step->a->modes.n;
  PetscComplex  *H, *G, S[4];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &H, n * n, &G));
  PetscCall(StandardProject(&step->b->form, n, step->a->X, step->a->Y, H, G));
  for (PetscInt i = 0; i < n && !*found; i++) {
    for (PetscInt k = i + 1; k < n && !*found && ModeTakesPart(step, i); k++) {
      if (ModeTakesPart(step, k) && PairMatrix(H, G, n, i, k, S)) *found = PredictPair(step, i, k, S, t);
    }
  }
  PetscCall(PetscFree2(H, G));
  PetscFunctionReturn(0);
}

/* From both ends: a pair may be predicted from one alone, as the model is only good to second order. t in [1e-3, 1
   - 1e-3], so that each division makes both parts shorter. */
PetscErrorCode IntervalPredict(const ModeFrame *a, const ModeFrame *b, const Match *match, PetscReal resolution,
                               PetscReal *t, PetscBool *found)
{
  PetscInt *to;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(PetscMalloc1(match->na, &to));
  for (PetscInt i = 0; i < match->na; i++) to[i] = -1;
  for (PetscInt j = 0; j < match->nb; j++)
    if (match->from[j] >= 0) to[match->from[j]] = j;
  PetscCall(PredictStep(&(IntervalStep){a, b, to, resolution}, t, found));
  if (!*found) {
    PetscCall(PredictStep(&(IntervalStep){b, a, match->from, resolution}, t, found));
    *t = 1 - *t;
  }
  PetscCall(PetscFree(to));
  if (*found) *t = PetscMin(PetscMax(*t, 1e-3), 1 - 1e-3);
  PetscFunctionReturn(0);
}
