/* Shooting with dense matrices: see shooting.h */
#include "shooting.h"
#include "dense.h"

#define SHOOTING_DIFFERENCE 1e-6 /* of period and span */
#define SHOOTING_FALL       0.9  /* of the residual that a shortened step must reach */
#define SHOOTING_LOST       3.0  /* residual beyond which no cycle is near */
#define SHOOTING_PHASE      0.3  /* of 1, where the multiplier of the phase is sought */
#define SHOOTING_STEPS      0.02 /* what steps make of it at least: where two are as near, the vector decides */
#define SHOOTING_SHORTEST   (1. / 8)

/* One problem: the guess, the branch and work */
typedef struct {
  const Shooting        *s;
  PetscReal             *x0, *y, *trial; /* guess, Phi, x of a shortened step */
  PetscReal             *c, *f, *g;      /* phase, dPhi/dT, dPhi/dp */
  PetscReal             *A, *rhs;        /* [n + 2][n + 2], [n + 2] */
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

/* Central difference of the flow in the period or the parameter */
static PetscErrorCode ShotDifference(ShootingWork *w, const ShootingCycle *c, PetscReal dT, PetscReal dp, PetscReal d[])
{
  const Shooting *s = w->s;

  PetscFunctionBeginUser;
  PetscCall(s->flow(s->ctx, c->x, c->period + dT, c->value + dp, d, NULL));
  PetscCall(s->flow(s->ctx, c->x, c->period - dT, PetscMax(s->least, c->value - dp), w->trial, NULL));
  for (PetscInt i = 0; i < s->n; i++) d[i] = (d[i] - w->trial[i]) / (2 * dT + dp + PetscMin(dp, c->value - s->least));
  PetscFunctionReturn(0);
}

/* f, g at the cycle, and the phase at the guess */
static PetscErrorCode ShotDifferentiate(ShootingWork *w, const ShootingCycle *c)
{
  const Shooting *s = w->s;

  PetscFunctionBeginUser;
  if (!s->phase_free) PetscCall(ShotDifference(w, c, SHOOTING_DIFFERENCE * c->period, 0, w->f));
  if (w->tangent) PetscCall(ShotDifference(w, c, 0, SHOOTING_DIFFERENCE * s->span, w->g));
  if (w->has_phase) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->n; i++) w->c[i] = s->phase_free ? 0 : w->f[i] * PetscSqr(s->weight[i]) * w->scale;
  w->has_phase = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* The matrix of Newton's equations: n + 2 rows; where nothing is asked of T or p, its row says that it stays */
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

/* Newton's step; along the branch its plane is met from the first one on, since the guess lies in it */
static PetscErrorCode ShotStep(ShootingWork *w, ShootingCycle *c)
{
  const PetscInt  n = w->s->n;
  const PetscReal T = c->period, p = c->value, before = c->residual;
  PetscBool       singular;

  PetscFunctionBeginUser;
  PetscCall(ShotDifferentiate(w, c));
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

/* Cosine between the motion along the cycle, v, and the right vector of eigenvalue i, in LAPACK's real storage */
static PetscReal StabilityAlong(const Shooting *s, const PetscReal v[], const PetscReal im[], const PetscReal R[],
                                PetscInt i)
{
  const PetscInt   n  = s->n;
  const PetscReal *re = &R[n * (im[i] < 0 ? i - 1 : i)], *ri = im[i] == 0 ? NULL : re + n;
  PetscReal        dot[2] = {0, 0}, length = 0, size = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal w = PetscSqr(s->weight[k]), b = ri ? ri[k] : 0;

    dot[0] += w * v[k] * re[k];
    dot[1] += w * v[k] * b;
    length += w * (PetscSqr(re[k]) + PetscSqr(b));
    size += w * PetscSqr(v[k]);
  }
  return length > 0 && size > 0 ? hypot(dot[0], dot[1]) / PetscSqrtReal(length * size) : 0;
}

/* Which of the eigenvalues near 1 that are left is that of the phase: its vector is the motion along the cycle */
static PetscErrorCode StabilityFindPhase(const Shooting *s, const ShootingCycle *cycle, PetscReal *const eigen[3],
                                         PetscInt *phase)
{
  const PetscReal dT = SHOOTING_DIFFERENCE * cycle->period, *re = eigen[0], *im = eigen[1];
  PetscReal      *v, *before, best                                              = -1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->n, &v, s->n, &before));
  PetscCall(s->flow(s->ctx, cycle->x, cycle->period - dT, cycle->value, before, NULL));
  PetscCall(s->flow(s->ctx, cycle->x, cycle->period + dT, cycle->value, v, NULL));
  for (PetscInt i = 0; i < s->n; i++) v[i] -= before[i];
  *phase = 0;
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal off   = hypot(re[i] - 1, im[i]);
    const PetscReal along = off < SHOOTING_PHASE ? StabilityAlong(s, v, im, eigen[2], i) / (off + SHOOTING_STEPS) : -1;

    if (along > best) *phase = i;
    best = PetscMax(best, along);
  }
  PetscCall(PetscFree2(v, before));
  PetscFunctionReturn(0);
}

PetscErrorCode ShootingGetStability(const Shooting *s, const ShootingCycle *cycle, ShootingStability *stability)
{
  const PetscInt n = s->n;
  PetscInt       at;
  PetscReal     *A, *re, *im, *R;

  PetscFunctionBeginUser;
  *stability = (ShootingStability){
    .phase = {0, 0}
  };
  PetscCall(PetscMalloc4(n * n, &A, n, &re, n, &im, n * n, &R));
  PetscCall(PetscArraycpy(A, cycle->M, n * n));
  PetscCall(DenseEigen(n, A, re, im, NULL, R));
  for (PetscInt k = 0; k < s->n_free;
       k++) { /* shifts along free directions change nothing: exactly 1, and counted out */
    for (PetscInt i = at = 0; i < n; i++)
      if (hypot(re[i] - 1, im[i]) < hypot(re[at] - 1, im[at])) at = i;
    re[at] = im[at] = 0;
  }
  PetscCall(StabilityFindPhase(s, cycle, (PetscReal *const[3]){re, im, R}, &at));
  stability->phase[0] = re[at];
  stability->phase[1] = im[at];
  re[at] = im[at] = 0;
  for (PetscInt i = 0; i < n; i++) {
    if (hypot(re[i], im[i]) <= hypot(stability->largest[0], stability->largest[1])) continue;
    stability->largest[0] = re[i];
    stability->largest[1] = PetscAbsReal(im[i]);
  }
  PetscCall(PetscFree4(A, re, im, R));
  PetscFunctionReturn(0);
}

/* <a, b> in (S x, T / scale, p / span) */
static PetscReal TangentDot(const Shooting *s, PetscReal scale, const ShootingTangent *a, const PetscReal b[])
{
  PetscReal sum = a->period * b[s->n] / PetscSqr(scale) + a->value * b[s->n + 1] / PetscSqr(s->span);

  for (PetscInt i = 0; i < s->n; i++) sum += PetscSqr(s->weight[i]) * a->x[i] * b[i];
  return sum;
}

PetscErrorCode ShootingGetTangent(const Shooting *s, const ShootingCycle *cycle, ShootingTangent *tangent)
{
  const PetscInt  n     = s->n;
  ShootingTangent along = *tangent, none;
  ShootingWork    w;
  PetscBool       singular;
  PetscReal       length;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &none.x));
  none.period = 0;
  none.value  = s->span;
  if (along.period == 0 && along.value == 0) along = none;
  PetscCall(ShotCreate(s, cycle, &along, &w));
  PetscCall(ShotDifferentiate(&w, cycle));
  PetscCall(ShotFactor(&w, cycle, &singular));
  PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             "a branch of cycles has no direction: it splits there");
  PetscCall(PetscArrayzero(w.rhs, n + 2 + s->n_free));
  w.rhs[n + 1] = 1;
  PetscCall(DenseSolve(n + 2 + s->n_free, w.A, w.pivot, PETSC_FALSE, 1, w.rhs));
  PetscCall(PetscArraycpy(tangent->x, w.rhs, n));
  tangent->period = w.rhs[n];
  tangent->value  = w.rhs[n + 1];
  length          = PetscSqrtReal(TangentDot(s, w.scale, tangent, w.rhs));
  for (PetscInt i = 0; i < n; i++) tangent->x[i] /= length;
  tangent->period /= length;
  tangent->value /= length;
  PetscCall(ShotDestroy(&w));
  PetscCall(PetscFree(none.x));
  PetscFunctionReturn(0);
}

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
