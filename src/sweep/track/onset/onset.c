/*
   The value of the parameter p at which an event happens, as the zero of a smooth function g(p) that is positive where
   the mode is unstable.

   Lock-in, undamped: two real kappa = -lambda^2 meet and become a complex pair. Each of them behaves like a square root
   there, and rounding moves them by the root of the machine precision, but their discriminant is smooth: on orthonormal
   real bases X, Y of the plane of the pair (plane.c)

      S = (Y^T M X)^-1 Y^T K X,   m = tr S / k,   g = -d,   d = tr (S - m I)^2 / k

   is ((kappa_1 - kappa_2) / 2)^2 for k = 2, and the same for two such pairs at once (a doublet that locks in with a
   doublet, k = 4). At lock-in omega = sqrt(m). Damped: g = sigma of the mode, which is simple. Divergence: g = -kappa
   = -y^T K x / (y^T M x). With a limit L(|lambda|) of what counts as unstable the onset is where sigma = L: g = -d -
   4 L^2 (m + L^2), sigma - L, -kappa - L^2; with damping a real eigenvalue is simple there, and g = sigma - L too.

   The zero is bracketed by the points of the event and found by Brent's method (R. P. Brent, Algorithms for
   Minimization without Derivatives, Prentice-Hall 1973, chapter 4). At each trial value the mode, or the plane, is the
   one with the largest product with those of the nearer end of the bracket. The mode of a damped system is followed by
   Newton's method (basis/follow.c), the plane by inverse iteration; all modes are solved for only where what that finds
   is not the same one for certain.

   Where two modes change places between neighbouring values, g jumps from one to the other, and the bracket shrinks to
   the jump: a change of sign and no zero. Then the onset is only known to lie in the bracket that it began with, and
   its frequency is that of the unstable end.

   Error of the critical value: |delta g| / |g'|, where sigma carries three times the estimated error of the eigenvalue
   and what rounding does to it, kappa that times 2 |lambda| + error, with damping times kappa / lambda at the unstable
   end, and d the square of 2 omega times the error, the splitting that the error makes of a double eigenvalue; and
   rounding.
*/
#include "trial.h"

#define FOLLOW_AT 1e-6 /* relative distance of the unstable mode from what it was in the sweep */
/* Relative width of a bracket that has shrunk to a place: some thousand units of rounding of the value. */
#define JUMP_WIDTH 1e-12
#define JUMP_TIMES 100 /* g at both its ends, over the error of g */

typedef struct {
  ModeSource source;
  OnsetKind  kind;
  Trial      end[2]; /* unstable, stable */
  PetscReal  change; /* of g with |lambda| at the unstable end */
  PetscReal  unit;   /* of g: machine epsilon times it is rounding */
} Onset;

/* Guess of the simple mode at a value: on the line through both ends of the bracket, or that of the reference */
static PetscComplex OnsetGuess(const Onset *onset, const Trial *reference, PetscReal value)
{
  const ModeFrame *a = onset->end[0].frame, *b = onset->end[1].frame;
  PetscComplex     end[2];

  if (!b || a->value == b->value) return reference->frame->modes.lambda[reference->member[0]];
  end[0] = a->modes.lambda[onset->end[0].member[0]];
  end[1] = b->modes.lambda[onset->end[1].member[0]];
  return end[0] + (value - a->value) / (b->value - a->value) * (end[1] - end[0]);
}

/* Follows a simple mode from the reference to a value; found = whether what is there certainly is the same mode */
static PetscErrorCode OnsetFollow(Onset *onset, PetscReal value, const Trial *reference, Trial *trial, PetscBool *found)
{
  ReducedModes from;

  PetscFunctionBeginUser;
  *found = onset->kind == ONSET_GROWTH && ModeFrameClusterSize(reference->frame, reference->member[0]) == 1
             ? PETSC_TRUE
             : PETSC_FALSE;
  if (!*found) PetscFunctionReturn(0);
  PetscCall(ReducedModesSelect(&reference->frame->modes, 1, reference->member, &from));
  PetscCall(ModeSourceFollow(&onset->source, value, OnsetGuess(onset, reference, value), &from, &trial->frame, found));
  if (*found) *found = TrialIsSame(reference, trial);
  PetscCall(TrialTakeSingle(trial, *found));
  PetscCall(ReducedModesDestroy(&from));
  PetscFunctionReturn(0);
}

/* Follows the plane of a pair between both ends of the bracket */
static PetscErrorCode OnsetFollowPair(Onset *onset, PetscReal value, const Trial *reference, Trial *trial,
                                      PetscBool *found)
{
  const Trial    *a = &onset->end[0], *b = &onset->end[1];
  const PetscBool between = b->frame && a->frame->value != b->frame->value ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       m;

  PetscFunctionBeginUser;
  if (onset->kind != ONSET_PAIR || !between || onset->source.estimate) PetscFunctionReturn(0);
  m = a->m + (value - a->frame->value) / (b->frame->value - a->frame->value) * (b->m - a->m);
  PetscCall(TrialFollowPlane(&onset->source, value, m, reference, trial, found));
  PetscFunctionReturn(0);
}

/* The trial at a value, by the nearer end of the bracket: the mode followed, else the plane followed, else all
   modes solved for, from cheap to certain. */
static PetscErrorCode OnsetTry(Onset *onset, PetscReal value, Trial *trial, PetscBool *found)
{
  const PetscReal to_0      = PetscAbsReal(value - onset->end[0].frame->value);
  const PetscReal to_1      = onset->end[1].frame ? PetscAbsReal(value - onset->end[1].frame->value) : PETSC_MAX_REAL;
  const Trial    *reference = &onset->end[to_1 < to_0 ? 1 : 0];

  PetscFunctionBeginUser;
  PetscCall(OnsetFollow(onset, value, reference, trial, found));
  if (!*found) PetscCall(OnsetFollowPair(onset, value, reference, trial, found));
  if (!*found) {
    PetscCall(ModeSourceSolve(&onset->source, value, &trial->frame));
    PetscCall(TrialIdentify(reference, trial, found));
  }
  if (*found) PetscCall(TrialValue(onset->kind, trial));
  PetscFunctionReturn(0);
}

/* The unstable end of a simple mode, of which the sweep knows the eigenvalue */
static PetscErrorCode OnsetBeginSimple(Onset *onset, PetscReal value, PetscComplex lambda, PetscBool *found)
{
  Trial *trial = &onset->end[0];

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (onset->kind != ONSET_GROWTH) PetscFunctionReturn(0);
  PetscCall(ModeSourceFollow(&onset->source, value, lambda, NULL, &trial->frame, found));
  if (*found && cabs(trial->frame->modes.lambda[0] - lambda) > FOLLOW_AT * cabs(lambda)) *found = PETSC_FALSE;
  PetscCall(TrialTakeSingle(trial, *found));
  if (*found) PetscCall(TrialValue(onset->kind, trial));
  PetscFunctionReturn(0);
}

/* The unstable end: the mode of eigenvalue lambda, with the others of its cluster for a pair */
static PetscErrorCode OnsetBegin(Onset *onset, PetscReal value, PetscComplex lambda, PetscBool *found)
{
  Trial     *trial = &onset->end[0];
  ModeFrame *f;
  PetscInt   mode = -1;

  PetscFunctionBeginUser;
  PetscCall(OnsetBeginSimple(onset, value, lambda, found));
  if (*found) PetscFunctionReturn(0);
  PetscCall(ModeSourceSolve(&onset->source, value, &trial->frame));
  f = trial->frame;
  PetscCall(PetscMalloc1(f->modes.n, &trial->member));
  for (PetscInt i = 0; i < f->modes.n; i++)
    if (mode < 0 || cabs(f->modes.lambda[i] - lambda) < cabs(f->modes.lambda[mode] - lambda)) mode = i;
  *found = mode >= 0 && cabs(f->modes.lambda[mode] - lambda) <= 1e-5 * cabs(lambda) ? PETSC_TRUE : PETSC_FALSE;
  if (!*found) PetscFunctionReturn(0);
  trial->member[trial->k++] = mode;
  for (PetscInt i = 0; i < f->modes.n; i++)
    if (onset->kind == ONSET_PAIR && i != mode && f->cluster[i] == f->cluster[mode]) trial->member[trial->k++] = i;
  *found = onset->kind != ONSET_PAIR || trial->k > 1 ? PETSC_TRUE : PETSC_FALSE;
  if (*found) PetscCall(TrialValue(onset->kind, trial));
  onset->change = PetscAbsReal(trial->g) / cabs(lambda);
  PetscFunctionReturn(0);
}

/* Replaces the end of the bracket on whose side the trial is */
static PetscErrorCode OnsetShrink(Onset *onset, Trial *trial)
{
  const int side = trial->g > 0 ? 0 : 1;

  PetscFunctionBeginUser;
  PetscCall(TrialDestroy(&onset->end[side]));
  onset->end[side] = *trial;
  PetscFunctionReturn(0);
}

/* The size of what g is a difference of, in the unit of g: |lambda| for a growth, kappa^2 for a discriminant, kappa
   for a divergence (change = |g| / |lambda| there). */
static PetscReal OnsetUnit(const Onset *onset, const BranchEvent *event)
{
  const PetscReal size = PetscMax(cabs(event->lambda), event->omega);

  return onset->kind == ONSET_GROWTH ? size : onset->kind == ONSET_PAIR ? PetscSqr(size * size) : size * onset->change;
}

/* Brent's method for the zero of g between the ends, until g is rounding, eps unit, or the bracket is 2 eps wide.
   Names as in Brent: b the best value, a the one before, c the other side of the zero, d the step, e the one
   before. u / v is the step of the secant, or of inverse quadratic interpolation where a, b, c differ. 100 steps
   are more than bisection needs to reach rounding. */
static PetscErrorCode OnsetIterate(Onset *onset, PetscReal *critical, PetscBool *found)
{
  PetscReal a = onset->end[0].frame->value, b = onset->end[1].frame->value, c = a, d = b - a, e = d;
  PetscReal ga = onset->end[0].g, gb = onset->end[1].g, gc = ga;

  PetscFunctionBeginUser;
  for (int iteration = 0; iteration < 100 && *found; iteration++) {
    Trial     trial = {0};
    PetscReal tolerance, half;

    if (PetscAbsReal(gc) < PetscAbsReal(gb)) a = b, b = c, c = a, ga = gb, gb = gc, gc = ga;
    tolerance = 2 * PETSC_MACHINE_EPSILON * PetscAbsReal(b);
    half      = 0.5 * (c - b);
    *critical = b;
    if (PetscAbsReal(half) <= tolerance || PetscAbsReal(gb) <= PETSC_MACHINE_EPSILON * onset->unit) break;
    if (PetscAbsReal(e) >= tolerance && PetscAbsReal(ga) > PetscAbsReal(gb)) {
      const PetscReal s = gb / ga, q = ga / gc, r = gb / gc;
      PetscReal       u = a == c ? 2 * half * s : s * (2 * half * q * (q - r) - (b - a) * (r - 1));
      PetscReal       v = a == c ? 1 - s : (q - 1) * (r - 1) * (s - 1);

      if (u > 0) v = -v;
      u = PetscAbsReal(u);
      if (2 * u < PetscMin(3 * half * v - PetscAbsReal(tolerance * v), PetscAbsReal(e * v)))
        e = d, d = u / v;
      else
        d = half, e = half;
    } else {
      d = half, e = half;
    }
    a = b, ga = gb;
    b += PetscAbsReal(d) > tolerance ? d : PetscSign(half) * tolerance;
    PetscCall(OnsetTry(onset, b, &trial, found));
    gb = trial.g;
    if (*found)
      PetscCall(OnsetShrink(onset, &trial));
    else
      PetscCall(TrialDestroy(&trial));
    if ((gb > 0) == (gc > 0)) c = a, gc = ga, d = b - a, e = d;
  }
  PetscFunctionReturn(0);
}

/* |g'| at the trial, in the unit of g over that of the parameter, from a difference of 1e-3 of the step towards its
   farther end: short beside what g bends on, long beside its rounding. 0 where the mode is lost there. */
static PetscErrorCode OnsetSlope(Onset *onset, const Trial *trial, const BranchEvent *event, PetscReal *slope)
{
  const PetscReal p = trial->frame->value, up = event->upper - p, down = p - event->lower;
  const PetscReal h    = up > down ? 1e-3 * up : -1e-3 * down;
  Trial           next = {0};
  PetscBool       found;

  PetscFunctionBeginUser;
  PetscCall(OnsetTry(onset, p + h, &next, &found));
  *slope = found ? PetscAbsReal((next.g - trial->g) / h) : 0;
  PetscCall(TrialDestroy(&next));
  PetscFunctionReturn(0);
}

/* Error of g at the critical trial, from those of the eigenvalues and rounding */
static PetscReal OnsetUncertainty(const Onset *onset, const Trial *trial, const BranchEvent *event)
{
  const PetscReal lambda = cabs(trial->frame->modes.lambda[trial->member[0]]);
  PetscReal       error = 0, noise = 0, delta;

  for (PetscInt r = 0; r < trial->k; r++) {
    const ReducedModes *modes = &trial->frame->modes;
    const PetscInt      i     = trial->member[r];

    error = PetscMax(error, modes->error[i] - modes->noise[i]); /* rounding of the critical value is added apart */
    noise = PetscMax(noise, modes->noise[i]);
  }
  delta = onset->kind == ONSET_PAIR ? PetscSqr(2 * event->omega * error) : 3 * error;
  if (onset->kind == ONSET_GROWTH) delta += noise;
  if (onset->kind == ONSET_STIFFNESS) delta *= onset->source.form.damped ? onset->change : 2 * lambda + error;
  return delta + 10 * PETSC_MACHINE_EPSILON * onset->unit;
}

/* Whether g jumps at the critical value; delta = error of g */
static PetscBool OnsetJumps(const Onset *onset, PetscReal delta)
{
  const Trial    *a = &onset->end[0], *b = &onset->end[1];
  const PetscReal width = PetscAbsReal(a->frame->value - b->frame->value);

  return width <= JUMP_WIDTH * PetscAbsReal(a->frame->value) &&
             PetscMin(PetscAbsReal(a->g), PetscAbsReal(b->g)) > JUMP_TIMES * delta
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Frequency, error and modes at the critical value, where errors are estimated once. omega^2 = m + L^2 of a pair at
   its limit. Without a slope the error is the width of the step. */
static PetscErrorCode OnsetFinish(Onset *onset, BranchEvent *event, ReducedModes *modes)
{
  const PetscReal width = event->upper - event->lower;
  Trial           trial = {0};
  PetscReal       slope, delta;

  PetscFunctionBeginUser;
  onset->source.estimate = PETSC_TRUE;
  PetscCall(OnsetTry(onset, event->critical, &trial, &event->found));
  onset->source.estimate = PETSC_FALSE;
  if (event->found) {
    if (onset->kind == ONSET_PAIR)
      event->omega = PetscSqrtReal(PetscMax(trial.m + trial.limit, 0));
    else if (onset->kind == ONSET_GROWTH)
      event->omega = cimag(trial.frame->modes.lambda[trial.member[0]]);
    else
      event->omega = 0;
    PetscCall(OnsetSlope(onset, &trial, event, &slope));
    delta        = OnsetUncertainty(onset, &trial, event);
    event->error = delta < slope * width ? delta / slope : width;
    event->error += 4 * PETSC_MACHINE_EPSILON * PetscAbsReal(event->critical);
    event->jumps = OnsetJumps(onset, delta);
    if (modes) PetscCall(ReducedModesSelect(&trial.frame->modes, trial.k, trial.member, modes));
  }
  if (event->found && event->jumps) {
    event->critical = 0.5 * (event->lower + event->upper);
    event->error    = 0.5 * width;
    event->omega    = cimag(event->lambda);
  }
  PetscCall(TrialDestroy(&trial));
  PetscFunctionReturn(0);
}

/* The unstable and the stable end; an end on which the other sign is due to rounding, 1e-6 of the other, is the
   critical value itself. */
static PetscErrorCode OnsetBracket(Onset *onset, const BranchEvent *event, PetscReal *critical, PetscBool *found)
{
  const PetscBool unstable_above =
    event->kind == EVENT_LOCK_IN || event->kind == EVENT_DIVERGENCE ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal unstable = unstable_above ? event->upper : event->lower;
  const PetscReal stable   = unstable_above ? event->lower : event->upper;
  PetscReal       g0, g1;

  PetscFunctionBeginUser;
  PetscCall(OnsetBegin(onset, unstable, event->lambda, found));
  onset->unit = OnsetUnit(onset, event);
  if (*found) PetscCall(OnsetTry(onset, stable, &onset->end[1], found));
  if (!*found) PetscFunctionReturn(0);
  g0 = onset->end[0].g, g1 = onset->end[1].g;
  if (g0 > 0 && g1 < 0) {
    PetscCall(OnsetIterate(onset, critical, found));
  } else {
    *critical = PetscAbsReal(g0) < PetscAbsReal(g1) ? unstable : stable;
    *found    = PetscMin(PetscAbsReal(g0), PetscAbsReal(g1)) <= 1e-6 * PetscMax(PetscAbsReal(g0), PetscAbsReal(g1))
                  ? PETSC_TRUE
                  : PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OnsetFind(const Reduced *reduced, const BranchLine *line, BranchEvent *event, ReducedModes *modes)
{
  Onset     onset = {0};
  PetscReal critical;
  PetscBool divergence = event->kind == EVENT_DIVERGENCE || event->kind == EVENT_RESTABILISATION;

  PetscFunctionBeginUser;
  if (modes) PetscCall(PetscMemzero(modes, sizeof(*modes)));
  PetscCall(ModeSourceCreate(reduced, line, &onset.source));
  onset.kind = divergence ? ONSET_STIFFNESS : (onset.source.form.damped ? ONSET_GROWTH : ONSET_PAIR);
  if (divergence && onset.source.form.damped && reduced->limit.growth > 0) onset.kind = ONSET_GROWTH;
  PetscCall(OnsetBracket(&onset, event, &critical, &event->found));
  if (event->found) {
    event->critical = critical;
    PetscCall(OnsetFinish(&onset, event, modes));
  }
  event->n_solved += onset.source.n_solved;
  event->n_followed += onset.source.n_followed;
  PetscCall(TrialDestroy(&onset.end[0]));
  PetscCall(TrialDestroy(&onset.end[1]));
  PetscCall(PetscFree(onset.source.p));
  PetscFunctionReturn(0);
}
