/* Shooting with dense matrices: see shooting.h */
#include "shooting.h"
#include "base/algebra/dense.h"

/* Of the residual that a shortened step must reach; the shortest is taken whatever it reaches. */
#define SHOOTING_FALL 0.9
/* Residual, in sizes of the vibration, beyond which no cycle is near. */
#define SHOOTING_LOST     3.0
#define SHOOTING_SHORTEST (1. / 8)
#define SHOOTING_CLOSE    1e-7 /* of the period: cycles before and after, between which hardly any status changes */

/* One problem: the guess, the branch and work */
typedef struct {
  const Shooting        *s;
  PetscReal             *x0, *y, *trial; /* guess, Phi, x of a shortened step */
  PetscReal             *c, *f, *g;      /* phase, dPhi/dT, dPhi/dp */
  PetscReal             *A, *rhs;        /* [N][N], [N], N = n + 2 + n_free */
  PetscBLASInt          *pivot;
  const ShootingTangent *tangent; /* NULL: the parameter is fixed */
  PetscReal              scale;   /* of the period */
  PetscBool              has_phase;
} ShootingWork;

static PetscErrorCode ShotCreate(const Shooting *s, const ShootingCycle *cycle, const ShootingTangent *tangent,
                                 ShootingWork *w)
{
  const PetscInt n = s->n, N = n + 2 + s->n_free;

  PetscFunctionBeginUser;
  *w = (ShootingWork){.s = s, .tangent = tangent, .scale = cycle->period};
  PetscCall(PetscCalloc6(n, &w->x0, n, &w->y, n, &w->trial, n, &w->c, n, &w->f, n, &w->g));
  PetscCall(PetscMalloc3(N * N, &w->A, N, &w->rhs, N, &w->pivot));
  PetscCall(PetscArraycpy(w->x0, cycle->x, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShotDestroy(ShootingWork *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(w->x0, w->y, w->trial, w->c, w->f, w->g));
  PetscCall(PetscFree3(w->A, w->rhs, w->pivot));
  PetscFunctionReturn(0);
}

/* Takes from y = Phi - x what it drifts along free directions */
static void ShootingHold(const Shooting *s, const PetscReal x[], PetscReal y[])
{
  for (PetscInt k = 0; k < s->n_free; k++) {
    const PetscReal *e     = &s->free[k * s->n];
    PetscReal        drift = 0;

    for (PetscInt i = 0; i < s->n; i++) drift += PetscSqr(s->weight[i]) * e[i] * (y[i] - x[i]);
    for (PetscInt i = 0; i < s->n; i++) y[i] -= drift * e[i];
  }
}

/* |(Phi - x) / size|; infinite where it is no number */
static PetscReal ShootingMiss(const Shooting *s, const PetscReal x[], const PetscReal y[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < s->n; i++) sum += PetscSqr((y[i] - x[i]) / s->size[i]);
  return PetscIsInfOrNanReal(sum) ? PETSC_MAX_REAL : PetscSqrtReal(sum);
}

/* Central difference of the flow in the period or the parameter, of which one step is 0; at the least value of the
   parameter it is one-sided, over the way that there is. */
static PetscErrorCode ShotDifference(ShootingWork *w, const ShootingCycle *c, PetscReal dT, PetscReal dp, PetscReal d[])
{
  const Shooting *s = w->s;

  PetscFunctionBeginUser;
  PetscCall(s->flow(s->ctx, c->x, c->period + dT, c->value + dp, d, NULL));
  PetscCall(s->flow(s->ctx, c->x, c->period - dT, PetscMax(s->least, c->value - dp), w->trial, NULL));
  for (PetscInt i = 0; i < s->n; i++) d[i] = (d[i] - w->trial[i]) / (2 * dT + dp + PetscMin(dp, c->value - s->least));
  PetscFunctionReturn(0);
}

/* f, g at the cycle, and the phase at the guess; has is false where the flow fails next to the cycle */
static PetscErrorCode ShotDifferentiate(ShootingWork *w, const ShootingCycle *c, PetscBool *has)
{
  const Shooting *s = w->s;

  PetscFunctionBeginUser;
  *has = PETSC_TRUE;
  if (!s->phase_free) PetscCall(ShotDifference(w, c, SHOOTING_DIFFERENCE * c->period, 0, w->f));
  if (w->tangent) PetscCall(ShotDifference(w, c, 0, SHOOTING_DIFFERENCE * s->span, w->g));
  for (PetscInt i = 0; i < s->n; i++)
    if (PetscIsInfOrNanReal(w->f[i]) || PetscIsInfOrNanReal(w->g[i])) *has = PETSC_FALSE;
  if (!*has || w->has_phase) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n; i++) w->c[i] = s->phase_free ? 0 : w->f[i] * PetscSqr(s->weight[i]) * w->scale;
  w->has_phase = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Newton's matrix of shooting.h [N][N], N = n + 2 + n_free, by columns: n rows of the flow, the phase, the plane,
   the free directions; where nothing is asked of T or p, its row says that it stays. */
static PetscErrorCode ShotFactor(ShootingWork *w, const ShootingCycle *cycle, PetscBool *singular)
{
  const Shooting        *s = w->s;
  const ShootingTangent *t = w->tangent;
  const PetscInt         n = s->n, N = n + 2 + s->n_free;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(w->A, N * N));
  for (PetscInt j = 0; j < n; j++) {
    for (PetscInt i = 0; i < n; i++) w->A[i + N * j] = cycle->M[i + n * j] - (i == j);
    w->A[n + N * j]       = w->c[j];
    w->A[n + 1 + N * j]   = t ? t->x[j] * PetscSqr(s->weight[j]) : 0;
    w->A[j + N * n]       = w->f[j];
    w->A[j + N * (n + 1)] = w->g[j];
  }
  for (PetscInt k = 0; k < s->n_free; k++)
    for (PetscInt i = 0; i < n; i++) {
      w->A[n + 2 + k + N * i]   = s->free[k * n + i] * PetscSqr(s->weight[i]);
      w->A[i + N * (n + 2 + k)] = -s->free[k * n + i];
    }
  if (s->phase_free) w->A[n + N * n] = 1;
  w->A[n + 1 + N * n]       = t ? t->period / PetscSqr(w->scale) : 0;
  w->A[n + 1 + N * (n + 1)] = t ? t->value / PetscSqr(s->span) : 1;
  PetscCall(DenseFactor(N, w->A, w->pivot, singular));
  PetscFunctionReturn(0);
}

/* Phi and M at x, T, p, and the residual */
static PetscErrorCode ShotFlow(ShootingWork *w, ShootingCycle *c)
{
  PetscFunctionBeginUser;
  PetscCall(w->s->flow(w->s->ctx, c->x, c->period, c->value, w->y, c->M));
  ShootingHold(w->s, c->x, w->y);
  c->residual = ShootingMiss(w->s, c->x, w->y);
  PetscFunctionReturn(0);
}

/* Newton's step, halved until the residual falls; along the branch its plane is met from the first one on, since
   the guess lies in it. The period never falls below half of itself. c->its stays where there is no step. */
static PetscErrorCode ShotStep(ShootingWork *w, ShootingCycle *c)
{
  const PetscInt  n = w->s->n;
  const PetscReal T = c->period, p = c->value, before = c->residual;
  PetscBool       has, singular;

  PetscFunctionBeginUser;
  PetscCall(ShotDifferentiate(w, c, &has));
  if (!has) PetscFunctionReturn(0);
  PetscCall(ShotFactor(w, c, &singular));
  if (singular) PetscFunctionReturn(0);
  for (PetscInt i = n; i < n + 2 + w->s->n_free; i++) w->rhs[i] = 0;
  for (PetscInt i = 0; i < n; i++) w->rhs[i] = c->x[i] - w->y[i];
  PetscCall(DenseSolve(n + 2 + w->s->n_free, w->A, w->pivot, PETSC_FALSE, 1, w->rhs));
  PetscCall(PetscArraycpy(w->trial, c->x, n));
  for (PetscReal part = 1; part >= SHOOTING_SHORTEST; part /= 2) {
    for (PetscInt i = 0; i < n; i++) c->x[i] = w->trial[i] + part * w->rhs[i];
    c->period = PetscMax(0.5 * T, T + part * w->rhs[n]);
    c->value  = PetscMax(w->s->least, p + part * w->rhs[n + 1]);
    PetscCall(ShotFlow(w, c));
    if (c->residual <= SHOOTING_FALL * before || c->residual <= w->s->rtol) break;
  }
  c->its++;
  PetscFunctionReturn(0);
}

/* Iterates from the guess; the phase and the plane go through it */
static PetscErrorCode ShootingIterate(const Shooting *s, const ShootingTangent *tangent, ShootingCycle *c)
{
  ShootingWork w;

  PetscFunctionBeginUser;
  c->its = 0;
  PetscCall(ShotCreate(s, c, tangent, &w));
  PetscCall(ShotFlow(&w, c));
  while (c->residual > s->rtol && c->its < s->max_it && c->residual < SHOOTING_LOST) {
    const PetscInt its = c->its;

    PetscCall(ShotStep(&w, c));
    PetscCall(PetscInfo(NULL, "shooting %" PetscInt_FMT ": residual %g period %.12g value %.12g\n", c->its,
                        (double)c->residual, (double)c->period, (double)c->value));
    if (c->its == its) break;
  }
  c->converged = c->residual <= s->rtol ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ShotDestroy(&w));
  PetscFunctionReturn(0);
}

PetscErrorCode ShootingSolve(const Shooting *s, ShootingCycle *cycle)
{
  PetscFunctionBeginUser;
  PetscCall(ShootingIterate(s, NULL, cycle));
  PetscFunctionReturn(0);
}

/* <a, b> in (S x, T / scale, p / span) */
static PetscReal TangentDot(const Shooting *s, PetscReal scale, const ShootingTangent *a, const PetscReal b[])
{
  PetscReal sum = a->period * b[s->n] / PetscSqr(scale) + a->value * b[s->n + 1] / PetscSqr(s->span);

  for (PetscInt i = 0; i < s->n; i++) sum += PetscSqr(s->weight[i]) * a->x[i] * b[i];
  return sum;
}

/* Whether a tangent has no length */
static PetscBool TangentIsNone(const Shooting *s, const ShootingTangent *t)
{
  if (t->period != 0 || t->value != 0) return PETSC_FALSE;
  for (PetscInt i = 0; i < s->n; i++)
    if (s->weight[i] != 0 && t->x[i] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Direction of the branch: Newton's matrix t = e of the last row, scaled to length one; its sign is that of the
   tangent before, on whose side the last row keeps it. */
PetscErrorCode ShootingGetTangent(const Shooting *s, const ShootingCycle *cycle, ShootingTangent *tangent,
                                  ShootingDirection *direction)
{
  const PetscInt n = s->n;
  ShootingWork   w;
  PetscBool      has, singular = PETSC_TRUE;
  PetscReal      length;

  PetscFunctionBeginUser;
  if (TangentIsNone(s, tangent)) tangent->value = s->span;
  PetscCall(ShotCreate(s, cycle, tangent, &w));
  PetscCall(ShotDifferentiate(&w, cycle, &has));
  if (has) PetscCall(ShotFactor(&w, cycle, &singular));
  *direction = has ? SHOOTING_SPLITS : SHOOTING_NO_DERIVATIVE;
  if (!singular) {
    PetscCall(PetscArrayzero(w.rhs, n + 2 + s->n_free));
    w.rhs[n + 1] = 1;
    PetscCall(DenseSolve(n + 2 + s->n_free, w.A, w.pivot, PETSC_FALSE, 1, w.rhs));
    length = PetscSqrtReal(TangentDot(s, w.scale, &(ShootingTangent){w.rhs, w.rhs[n], w.rhs[n + 1]}, w.rhs));
    if (length > 0 && !PetscIsInfOrNanReal(length)) *direction = SHOOTING_ALONG;
  }
  if (*direction == SHOOTING_ALONG) {
    for (PetscInt i = 0; i < n; i++) tangent->x[i] = w.rhs[i] / length;
    tangent->period = w.rhs[n] / length;
    tangent->value  = w.rhs[n + 1] / length;
  }
  PetscCall(ShotDestroy(&w));
  PetscFunctionReturn(0);
}

/* A predicted place, step along the tangent, and Newton's method in the plane normal to it. Where that fails the
   cycle is as it was before. */
PetscErrorCode ShootingAdvance(const Shooting *s, PetscReal step, const ShootingTangent *tangent, ShootingCycle *cycle)
{
  const PetscInt      n      = s->n;
  const ShootingCycle before = *cycle;
  PetscReal          *x, *M;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &x, n * n, &M));
  PetscCall(PetscArraycpy(x, cycle->x, n));
  PetscCall(PetscArraycpy(M, cycle->M, n * n));
  for (PetscInt i = 0; i < n; i++) cycle->x[i] += step * tangent->x[i];
  cycle->period += step * tangent->period;
  cycle->value = PetscMax(s->least, cycle->value + step * tangent->value);
  PetscCall(ShootingIterate(s, tangent, cycle));
  if (!cycle->converged) {
    const PetscInt its = cycle->its;

    *cycle           = before;
    cycle->its       = its;
    cycle->converged = PETSC_FALSE;
    PetscCall(PetscArraycpy(cycle->x, x, n));
    PetscCall(PetscArraycpy(cycle->M, M, n * n));
  }
  PetscCall(PetscFree2(x, M));
  PetscFunctionReturn(0);
}

/* The check of the derivative: central difference of the flow from the cycles a little earlier and later, each with its
   own period */
static PetscErrorCode ShotCheckDerivative(ShootingWork *w, const ShootingCycle *c, ShootingPhase *phase)
{
  const Shooting *s      = w->s;
  PetscReal       length = 0, speed = 0, part = 0, e;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; i++) {
    length += PetscSqr(s->weight[i] * phase->x[i]);
    speed += PetscSqr(s->weight[i] * w->f[i]);
  }
  e = SHOOTING_CLOSE * c->period * PetscSqrtReal(speed / length);
  PetscCall(PetscArrayzero(w->rhs, s->n));
  for (int side = -1; side <= 1; side += 2) {
    for (PetscInt i = 0; i < s->n; i++) w->trial[i] = c->x[i] + side * e * phase->x[i];
    PetscCall(s->flow(s->ctx, w->trial, c->period + side * e * phase->slope, c->value, w->y, NULL));
    ShootingHold(s, w->trial, w->y);
    for (PetscInt i = 0; i < s->n; i++) w->rhs[i] += side * w->y[i] / (2 * e);
  }
  for (PetscInt i = 0; i < s->n; i++) part += PetscSqr(s->weight[i]) * phase->x[i] * w->rhs[i];
  phase->check = part / length;
  phase->known = PetscIsInfOrNanReal(phase->check) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* x' and T' of shooting.h from Newton's matrix with the right-hand side c . f in the row of the phase. */
PetscErrorCode ShootingGetPhase(const Shooting *s, const ShootingCycle *cycle, ShootingPhase *phase)
{
  const PetscInt n = s->n, N = n + 2 + s->n_free;
  ShootingWork   w;
  PetscBool      has, singular = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(ShotCreate(s, cycle, NULL, &w));
  PetscCall(ShotDifferentiate(&w, cycle, &has));
  if (has) PetscCall(ShotFactor(&w, cycle, &singular));
  phase->known = PETSC_FALSE;
  if (!singular) {
    PetscCall(PetscArrayzero(w.rhs, N));
    for (PetscInt i = 0; i < n; i++) w.rhs[n] += w.c[i] * w.f[i];
    PetscCall(DenseSolve(N, w.A, w.pivot, PETSC_FALSE, 1, w.rhs));
    PetscCall(PetscArraycpy(phase->x, w.rhs, n));
    phase->slope = w.rhs[n];
    PetscCall(ShotCheckDerivative(&w, cycle, phase));
  }
  PetscCall(ShotDestroy(&w));
  PetscFunctionReturn(0);
}

PetscErrorCode ShootingCopy(PetscInt n, const ShootingCycle *from, ShootingCycle *to)
{
  PetscReal *x = to->x, *M = to->M;

  PetscFunctionBeginUser;
  *to   = *from;
  to->x = x;
  to->M = M;
  PetscCall(PetscArraycpy(x, from->x, n));
  PetscCall(PetscArraycpy(M, from->M, n * n));
  PetscFunctionReturn(0);
}
