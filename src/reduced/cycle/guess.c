/*
   The guess of a cycle: the motion goes on from the end of the transient; the first time at which it comes back to
   where it began, as near as ever in the window, is the period. Distances are those of (eta, rate), each over its rms
   about the mean.
*/
#include "cycleimpl.h"

/* Of the window: 3000 states of 2 m numbers are kept. */
#define GUESS_STEPS 3000
#define GUESS_BEGIN 6 /* steps in a period, at least */
/* Distances below it, and below GUESS_TIMES the nearest, are returns; a motion with noise comes no nearer. */
#define GUESS_NEAR  0.12
#define GUESS_TIMES 2
/* The motion must have been away so far before it returns: 1 is its rms. */
#define GUESS_AWAY    1.0
#define GUESS_NONE    0.5   /* no return */
#define GUESS_RIGID   1e-12 /* of the largest: squares of frequencies, and of gaps that a motion changes */
#define GUESS_AT_REST 1e-7  /* rms of the force over its mean */

/* States in the window */
typedef struct {
  PetscInt   n, m;
  PetscReal *z, *force; /* [n][2 m], [n] */
  PetscReal  size[3];   /* rms about the mean of eta, rate, lambda */
  PetscReal  rest;      /* rms of the normal force about its mean, over that */
} GuessWindow;

/* The motion from the end of the run on; x [flow n] is where it begins, `lambda` collects rms of the pairs' forces */
static PetscErrorCode WindowRun(LimitCycle c, PetscReal x[], GuessWindow *w)
{
  ReducedRun     r = c->reduced;
  const PetscInt m = r->reduction.model.m, n = 3 * r->reduction.model.n_pairs;
  PetscReal     *sum, *square;
  ReducedDrive   drive;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &sum, n, &square));
  PetscCall(CycleFlowPack(&c->flow, &r->motion.state, x));
  for (PetscInt k = 0; k < w->n; k++) {
    w->force[k] = 0;
    for (PetscInt i = 0; i < m; i++) {
      w->z[2 * m * k + i]     = r->motion.state.eta[i];
      w->z[2 * m * k + m + i] = r->motion.state.rate[i];
    }
    for (PetscInt i = 0; i < n; i++) {
      if (i % 3 == 0) w->force[k] += r->motion.state.p[i];
      sum[i] += r->motion.state.p[i] / (PetscReal)w->n;
      square[i] += PetscSqr(r->motion.state.p[i]) / (PetscReal)w->n;
    }
    PetscCall(ReducedDriveSet(r, &drive));
    PetscCall(ReducedStep(r->motion.stepper, &drive, &r->motion.state, &r->motion.report));
  }
  for (PetscInt i = 0; i < n; i++) w->size[2] += PetscMax(0, square[i] - PetscSqr(sum[i]));
  w->size[2] = PetscSqrtReal(w->size[2]);
  PetscCall(PetscFree2(sum, square));
  PetscFunctionReturn(0);
}

/* Rms about the mean of eta, rate and the force */
static PetscErrorCode WindowMeasure(GuessWindow *w)
{
  const PetscInt m     = w->m;
  PetscReal      force = 0, square = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 2 * m; i++) {
    PetscReal mean = 0;

    for (PetscInt k = 0; k < w->n; k++) mean += w->z[2 * m * k + i] / (PetscReal)w->n;
    for (PetscInt k = 0; k < w->n; k++) w->size[i / m] += PetscSqr(w->z[2 * m * k + i] - mean) / (PetscReal)w->n;
  }
  w->size[0] = PetscSqrtReal(w->size[0]);
  w->size[1] = PetscSqrtReal(w->size[1]);
  for (PetscInt k = 0; k < w->n; k++) force += w->force[k] / (PetscReal)w->n;
  for (PetscInt k = 0; k < w->n; k++) square += PetscSqr(w->force[k] - force) / (PetscReal)w->n;
  w->rest = force > 0 ? PetscSqrtReal(square) / force : 0;
  PetscFunctionReturn(0);
}

/* Distance of the first state from the way between k and k + 1, over the size of the motion, and where on that way,
   0 to 1: the point of the straight line nearest to it. Steps need not meet the first state. */
static PetscReal GuessDistance(const GuessWindow *w, PetscInt k, PetscReal *part)
{
  const PetscInt   m = w->m;
  const PetscReal *a = &w->z[2 * m * k], *b = a + 2 * m, *o = w->z;
  PetscReal        ab = 0, bb = 0, sum = 0;

  for (PetscInt i = 0; i < 2 * m; i++) {
    const PetscReal s = 1 / PetscSqr(w->size[i / m]);

    ab += s * (o[i] - a[i]) * (b[i] - a[i]);
    bb += s * PetscSqr(b[i] - a[i]);
  }
  *part = bb > 0 ? PetscMin(1, PetscMax(0, ab / bb)) : 0;
  for (PetscInt i = 0; i < 2 * m; i++) sum += PetscSqr((o[i] - a[i] - *part * (b[i] - a[i])) / w->size[i / m]);
  return PetscSqrtReal(0.5 * sum);
}

/* The first return, in steps; nearest = the least distance of all. Of neighbouring steps that are near, the nearest
   counts. */
static PetscReal WindowReturn(const GuessWindow *w, PetscReal *nearest)
{
  PetscReal part, away = 0, best = PETSC_MAX_REAL, found = 0;

  *nearest = PETSC_MAX_REAL;
  for (PetscInt k = 1; k + 1 < w->n; k++) {
    const PetscReal d = GuessDistance(w, k, &part);

    away = PetscMax(away, d);
    if (away >= GUESS_AWAY && k >= GUESS_BEGIN) *nearest = PetscMin(*nearest, d);
  }
  away = 0;
  for (PetscInt k = 1; k + 1 < w->n; k++) {
    const PetscReal d = GuessDistance(w, k, &part);

    away = PetscMax(away, d);
    if (away < GUESS_AWAY || k < GUESS_BEGIN) continue;
    if (d > PetscMax(GUESS_NEAR, GUESS_TIMES * *nearest)) {
      if (found > 0) return found;
      continue;
    }
    if (d < best) found = (PetscReal)k + part;
    best = PetscMin(best, d);
  }
  return found;
}

/* Free directions: rigid motions of the bodies that change no gap, nothing but slip being felt of them; unit length
   in S x. They are the null space of the sum over the pairs of P_n P_n' on the rigid modes. */
static PetscErrorCode GuessSetFree(LimitCycle c)
{
  const ReducedModel *model = &c->reduced->reduction.model;
  const PetscInt      m     = model->m;
  PetscInt            n     = 0;
  PetscReal          *A, *w;

  PetscFunctionBeginUser;
  while (n < m && model->omega2[n] <= GUESS_RIGID * model->omega2[m - 1]) n++;
  PetscCall(PetscCalloc2(n * n, &A, n, &w));
  for (PetscInt p = 0; p < model->n_pairs; p++)
    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < n; i++) A[i + n * j] += model->P[i + m * 3 * p] * model->P[j + m * 3 * p];
  if (n) PetscCall(DenseSymmetricEigen(n, A, NULL, w, NULL));
  PetscCall(PetscCalloc1(n * c->flow.n, &c->shooting.free));
  for (PetscInt k = 0; k < n && w[k] <= GUESS_RIGID * w[n - 1]; k++, c->shooting.n_free++)
    for (PetscInt i = 0; i < n; i++) c->shooting.free[k * c->flow.n + i] = A[i + n * k] * c->shooting.size[i];
  PetscCall(PetscFree2(A, w));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetSizes(LimitCycle c, const PetscReal size[3])
{
  const PetscInt m = c->reduced->reduction.model.m;

  PetscFunctionBeginUser;
  c->shooting.n = c->flow.n;
  PetscCall(PetscMalloc2(c->flow.n, &c->shooting.size, c->flow.n, &c->shooting.weight));
  for (PetscInt i = 0; i < c->flow.n; i++) {
    c->shooting.size[i]   = size[PetscMin(2, i / m)];
    c->shooting.weight[i] = i < 2 * m ? 1 / c->shooting.size[i] : 0;
  }
  PetscCall(GuessSetFree(c));
  PetscFunctionReturn(0);
}

/* guess->x is the state at the end of the transient, guess->period the time of the first return, s. The state of
   the run moves on by the window. */
PetscErrorCode CycleGuess(LimitCycle c, ShootingCycle *guess)
{
  const PetscInt m = c->reduced->reduction.model.m;
  GuessWindow    w = {.n = GUESS_STEPS, .m = m};
  PetscReal      steps;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * m * w.n, &w.z, w.n, &w.force));
  PetscCall(WindowRun(c, guess->x, &w));
  PetscCall(WindowMeasure(&w));
  PetscCheck(w.rest > GUESS_AT_REST && w.size[0] > 0 && w.size[1] > 0 && w.size[2] > 0, c->comm, PETSC_ERR_USER_INPUT,
             CYCLE_BY ": the transient ends at rest (normal force constant to %.1e), where there is no cycle: "
                      "start it with more, or take a parameter at which the sliding state is unstable",
             (double)w.rest);
  steps = WindowReturn(&w, &c->closure);
  PetscCheck(steps > 0 && c->closure <= GUESS_NONE, c->comm, PETSC_ERR_USER_INPUT,
             CYCLE_BY ": the motion at the end of the transient does not return to itself (%.2g of its size at "
                      "the nearest within %" PetscInt_FMT " steps): it is no cycle, or has not settled: take a longer "
                      "-ts_max_time",
             (double)c->closure, w.n);
  guess->period = steps * c->reduced->motion.dt;
  PetscCall(CycleSetSizes(c, w.size));
  PetscCall(PetscFree2(w.z, w.force));
  PetscFunctionReturn(0);
}
