/*
   The window of the eigenvalues asked for. With a symmetric pencil without damping and friction the number of
   eigenvalues kappa = omega^2 below s follows from the negative pivots of K - s M (solver/factor/inertia.c). It sizes
   the Krylov space, and proves that no real mode is missing.

   Where unknowns are without mass, as multipliers of constraints are, rounding makes large eigenvalues of any sign of
   the infinite ones, by the root of rounding at best: 1e8 times what is near the shift. So what is larger than 10 times
   the band and the growth asked for is no mode then; of modes nearest to a target, what is larger than 100 times the
   unknowns' own frequencies.
*/
#include "modes/modesimpl.h"

#define MODES_EDGE      1e-8 /* relative width of the band's ends, so that an eigenvalue on an end belongs to it */
#define MODES_ROUNDINGS 50   /* of K / M: lower frequencies squared cannot be told from zero */
#define MODES_BELOW     1e-2 /* of these: below it nothing is */
#define MODES_AWAY      1e-7 /* relative move of an end on which MUMPS finds an eigenvalue */
#define MODES_MOST      10   /* of the band and of the growth: with unknowns without mass, what is larger is no mode */
#define MODES_FINITE    1e7  /* of the scale: the same where no band is given */

/* A frequency (rad/s) that is small beside all elastic modes: 1e-5 of the mean of the unknowns' own, w_i^2 = K_ii /
   M_ii, weighted by M_ii, in which a stiff spring weighs no more than the mass at it. Rounding of K makes of a zero
   about eps x'|K| x / x'M x: where x moves all alike, eps times the mean of w_i^2. Below some of these is zero. */
static PetscErrorCode WindowScale(const PencilMatrices *pencil, PetscReal *scale, PetscReal *zero)
{
  PetscReal K, M, w;
  Vec       k, m;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(pencil->K, &k, &m));
  PetscCall(MatGetDiagonal(pencil->K, k));
  PetscCall(MatGetDiagonal(pencil->M, m));
  PetscCall(VecNorm(k, NORM_1, &K));
  PetscCall(VecNorm(m, NORM_1, &M));
  PetscCall(VecPointwiseMult(k, k, m));
  PetscCall(VecSqrtAbs(k));
  PetscCall(VecNorm(k, NORM_1, &w));
  *zero  = PetscSqrtReal(MODES_ROUNDINGS * PETSC_MACHINE_EPSILON * K / M);
  *scale = PetscMax(1e-5 * w / M, *zero);
  PetscCall(VecDestroy(&k));
  PetscCall(VecDestroy(&m));
  PetscFunctionReturn(0);
}

/* Limit of the modes where unknowns are without mass, and the negative pivots of these */
static PetscErrorCode WindowFindMassless(Modes modes, const PencilMatrices *frictionless, Window *window)
{
  PetscReal most;

  PetscFunctionBeginUser;
  window->known.massless = 0;
  window->known.most     = INFINITY;
  PetscCall(MassIsSingular(frictionless, &window->known.singular));
  if (!window->known.singular) PetscFunctionReturn(0);
  window->known.most = modes->has_band ? MODES_MOST * PetscMax(window->high, window->growth)
                                       : PetscMax(MODES_FINITE * window->known.scale, MODES_MOST * window->target);
  if (!frictionless->symmetric) PetscFunctionReturn(0);
  PetscCall(ShiftInvertCountMassless(frictionless, window->known.most, &modes->counter, &window->known.massless));
  if (modes->has_band) PetscFunctionReturn(0);
  most = window->known.most;
  PetscCall(ShiftInvertCountBelow(frictionless, MODES_AWAY, &modes->counter, &most, &window->known.finite));
  window->known.finite -= window->known.massless;
  PetscFunctionReturn(0);
}

/* Frictionless modes with frequency below *omega (rad/s), which is moved up or down where a mode lies there */
static PetscErrorCode WindowCountBelow(Modes modes, const Window *window, PetscReal away, PetscReal *omega, PetscInt *n)
{
  PencilMatrices frictionless;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(modes->pencil, &frictionless));
  PetscCall(ShiftInvertCountBelow(&frictionless, away, &modes->counter, omega, n));
  if (*omega > 0) *n -= window->known.massless;
  PetscFunctionReturn(0);
}

/* Frictionless modes below the band. Where it begins within what rounding makes of zero, rigid modes belong to it,
   unless all that is about zero is found below its end */
static PetscErrorCode WindowCountLow(Modes modes, Window *window)
{
  PetscReal zero  = window->known.zero;
  PetscInt  about = 0;

  PetscFunctionBeginUser;
  window->known.below = 0;
  if (window->low >= MODES_BELOW * zero)
    PetscCall(WindowCountBelow(modes, window, -MODES_AWAY, &window->edge[0], &window->known.below));
  if (window->low >= zero) PetscFunctionReturn(0);
  if (window->known.below) PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &zero, &about));
  if (!about || about != window->known.below) window->known.below = 0, window->edge[0] = 0;
  PetscFunctionReturn(0);
}

/* Frictionless modes below the target, or in the band, whose edges move where a mode lies on them */
static PetscErrorCode WindowCount(Modes modes, Window *window)
{
  PetscInt below_high;

  PetscFunctionBeginUser;
  if (!modes->has_band) {
    PetscReal target = window->target < window->known.scale ? 0 : window->target;

    PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &target, &window->known.below));
    PetscFunctionReturn(0);
  }
  PetscCall(WindowCountLow(modes, window));
  PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &window->edge[1], &below_high));
  window->known.expected = below_high - window->known.below;
  PetscFunctionReturn(0);
}

PetscErrorCode WindowFind(Modes modes, Window *window)
{
  const PetscReal low = 2 * PETSC_PI * modes->band[0], high = 2 * PETSC_PI * modes->band[1];
  PencilMatrices  frictionless;

  PetscFunctionBeginUser;
  *window = (Window){.low    = low,
                     .high   = high,
                     .target = 2 * PETSC_PI * modes->target,
                     .count  = modes->has_band ? 0 : modes->count,
                     .growth = modes->growth > 0 ? modes->growth : 0.1 * high,
                     .edge   = {low * (1 - MODES_EDGE), high * (1 + MODES_EDGE)},
                     .extra  = 6,
                     .known  = {.within = -1, .expected = -1, .finite = -1, .below = -1},
                     .route  = {.beyond = -1}};
  PetscCall(PencilGetFrictionless(modes->pencil, &frictionless));
  PetscCall(WindowScale(&frictionless, &window->known.scale, &window->known.zero));
  PetscCall(WindowFindMassless(modes, &frictionless, window));
  if (frictionless.symmetric) PetscCall(WindowCount(modes, window));
  PetscFunctionReturn(0);
}

PetscReal WindowMiddle(const Window *window)
{
  return 0.5 * (window->low * window->low + window->high * window->high);
}

PetscErrorCode WindowNarrow(Modes modes, const PencilMatrices *pencil, const Window *whole, const PetscReal ends[2],
                            Window *part)
{
  PetscReal middle, radius, edge[2];
  PetscInt  below;

  PetscFunctionBeginUser;
  *part      = *whole;
  part->low  = ends[0];
  part->high = ends[1];
  if (ends[0] > whole->low) part->edge[0] = ends[0] * (1 - MODES_EDGE);
  if (ends[1] < whole->high) part->edge[1] = ends[1] * (1 + MODES_EDGE);
  if (whole->known.expected < 0) PetscFunctionReturn(0);
  if (pencil->symmetric) part->growth = 0;
  middle  = WindowMiddle(part);
  radius  = UndampedRadius(part, middle, NULL);
  edge[0] = pencil->symmetric ? part->edge[0] : PetscSqrtReal(PetscMax(0, middle - radius));
  edge[1] = pencil->symmetric ? part->edge[1] : PetscSqrtReal(middle + radius);
  PetscCall(WindowCountBelow(modes, whole, -MODES_AWAY, &edge[0], &part->known.below));
  PetscCall(WindowCountBelow(modes, whole, MODES_AWAY, &edge[1], &below));
  part->known.expected = below - part->known.below;
  if (pencil->symmetric) part->edge[0] = edge[0], part->edge[1] = edge[1];
  PetscFunctionReturn(0);
}

/* The damped problem converges from zero upwards and must know how far: the frictionless, undamped modes tell */
PetscErrorCode WindowReach(Modes modes, Window *window)
{
  PencilMatrices frictionless;
  ShiftInvert    si;
  Spectrum       nearest;

  PetscFunctionBeginUser;
  PetscCall(PencilGetFrictionless(modes->pencil, &frictionless));
  PetscCall(ShiftInvertCreate(&frictionless, UndampedShift(window), PETSC_FALSE, &modes->progress, &si));
  PetscCall(UndampedSolve(modes, &frictionless, window, &si, PETSC_FALSE, &nearest));
  PetscCall(WindowSelect(window, &nearest));
  for (PetscInt i = 0; i < nearest.n; i++) window->high = PetscMax(window->high, nearest.omega[i]);
  window->high = PetscMax(window->high, window->known.scale);
  if (window->known.singular) window->known.most = MODES_MOST * window->high;
  PetscCall(SpectrumDestroy(&nearest));
  PetscCall(ShiftInvertDestroy(&si));
  PetscFunctionReturn(0);
}

/* C = b K moves a mode omega of the undamped problem to a distance d from the real shift s with
   d^2 = s^2 + (1 + b s) omega^2. Where many are farther than the window's corners, asking for as many eigenvalues as
   the undamped problem has in the window would look for them among the overdamped ones, which hardly differ. */
PetscErrorCode WindowSetDamping(Modes modes, const PencilMatrices *pencil, Window *window)
{
  PetscReal K, C, shift, corner, omega;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(pencil->K, NORM_FROBENIUS, &K));
  PetscCall(MatNorm(pencil->C, NORM_FROBENIUS, &C));
  window->known.damping = K > 0 ? C / K : 0;
  if (window->known.expected < 0) PetscFunctionReturn(0);
  window->known.within = window->known.below + window->known.expected;
  shift                = DampedShift(window);
  corner               = hypot(window->high, shift + window->growth);
  omega                = PetscSqrtReal((corner * corner - shift * shift) / (1 + shift * window->known.damping));
  if (omega < window->high) PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &omega, &window->known.within));
  PetscFunctionReturn(0);
}

/* With damping a rigid mode is a double zero, which rounding splits into two tiny eigenvalues */
PetscErrorCode WindowCountRigid(Modes modes, Window *window, const Spectrum *s)
{
  PetscReal scale = window->known.scale;

  PetscFunctionBeginUser;
  if (!s->n || PetscAbsReal(s->sigma[0]) > window->known.scale || s->omega[0] > window->known.scale ||
      window->known.below < 0)
    PetscFunctionReturn(0);
  PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &scale, &window->known.rigid));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowSelect(const Window *window, Spectrum *s)
{
  PetscInt first = 0, n;

  PetscFunctionBeginUser;
  for (PetscInt i = s->n; i-- > 0;)
    if (hypot(s->sigma[i], s->omega[i]) > window->known.most) PetscCall(SpectrumRemove(s, i));
  n = s->n;
  if (window->count) {
    while (s->n > window->count + window->known.rigid) PetscCall(SpectrumRemove(s, WindowFarthest(window, s)));
    PetscFunctionReturn(0);
  }
  while (n > 0 && s->omega[first] < window->edge[0]) first++, n--;
  while (n > 0 && s->omega[first + n - 1] > window->edge[1]) n--;
  PetscCall(SpectrumKeep(s, first, n));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowProve(Modes modes, Window *window, const Spectrum *s, PetscBool *complete)
{
  PetscInt below_low, below_high;

  PetscFunctionBeginUser;
  if (window->count && s->n) { /* just outside the outermost modes: what lies that close belongs to them */
    PetscReal low  = s->omega[0] < window->known.scale ? 0 : s->omega[0] * (1 - 1e-6);
    PetscReal high = PetscMax(window->known.scale, s->omega[s->n - 1] * (1 + 1e-6));

    PetscCall(WindowCountBelow(modes, window, -MODES_AWAY, &low, &below_low));
    PetscCall(WindowCountBelow(modes, window, MODES_AWAY, &high, &below_high));
    window->known.expected = below_high - below_low;
  }
  *complete =
    s->n == window->known.expected || (window->count && window->known.expected >= s->n && s->n == window->count)
      ? PETSC_TRUE
      : PETSC_FALSE;
  PetscFunctionReturn(0);
}
