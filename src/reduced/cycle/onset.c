/*
   Where the branch begins: at the value of the parameter at which a mode v, sigma + i omega, of the sliding state x_0
   becomes unstable (Hopf bifurcation). The growth of the fastest mode is looked at over the range and its zero next to
   the value of the scene bracketed. Cycles of small amplitude a near it are

      x = x_0 + a Re(v exp(i omega t)),    T = 2 pi / omega,

   with the phase of v at which the normal forces of the pairs are largest, the root of the sum of their squares, at t =
   0, and its sign by that of the pair of the largest, later pairs counting up to twice as much: the phase of an
   eigensolver depends on the signs of the bodies' modes, hence on ranks, and tells where the steps lie. From there
   Newton's method goes on at that amplitude: the plane of pseudo-arclength is normal to v, and the parameter is left
   free. While all pairs stay closed and slide the motion is linear, and the parameter that of the onset whatever a; it
   moves when pairs begin to open. Amplitude 1 is that at which normal forces of the pairs change by as much as they are
   at rest, in the root of the sum of their squares.
*/
#include "cycleimpl.h"

/* Values over the range: an unstable interval narrower than a 32nd of it may be missed. */
#define ONSET_LOOKS 33
#define ONSET_RTOL  1e-12 /* of the range */

/* The sliding state at a value, and its fastest mode */
typedef struct {
  PetscReal    value, eigenvalue[2]; /* rad/s */
  ReducedState rest, mode[2];
} OnsetLook;

static PetscErrorCode LookCreate(const ReducedModel *model, OnsetLook *look)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateCreate(model, &look->rest));
  for (int i = 0; i < 2; i++) PetscCall(ReducedStateCreate(model, &look->mode[i]));
  PetscFunctionReturn(0);
}

static PetscErrorCode LookDestroy(OnsetLook *look)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedStateDestroy(&look->rest));
  for (int i = 0; i < 2; i++) PetscCall(ReducedStateDestroy(&look->mode[i]));
  PetscFunctionReturn(0);
}

/* Growth at a value, 1/s; not a number where there is no sliding state */
static PetscErrorCode OnsetGrowth(LimitCycle c, PetscReal value, OnsetLook *look, PetscReal *growth)
{
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(CycleFlowSetValue(&c->flow, value));
  look->value = value;
  *growth     = NAN;
  PetscCall(ReducedEquilibrium(c->flow.model, c->flow.loads, &look->rest, &found));
  if (!found) PetscFunctionReturn(0);
  PetscCall(ReducedFastestMode(c->flow.model, &look->rest, look->eigenvalue, look->mode));
  *growth = look->eigenvalue[0];
  PetscFunctionReturn(0);
}

/* Two values next to that of the scene between which growth (1/s) changes its sign; a value without a sliding
   state, NaN, begins anew. */
static PetscErrorCode HopfBracket(LimitCycle c, OnsetLook *look, PetscReal at[2], PetscReal growth[2],
                                  PetscInt *n_found, PetscReal span[2])
{
  PetscReal before = NAN, last = 0, nearest = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  *n_found = 0;
  span[0]  = PETSC_MAX_REAL;
  span[1]  = -PETSC_MAX_REAL;
  for (int k = 0; k < ONSET_LOOKS; k++) {
    const PetscReal value = c->range[0] + (c->range[1] - c->range[0]) * k / (ONSET_LOOKS - 1);
    PetscReal       now, far;

    PetscCall(OnsetGrowth(c, value, look, &now));
    if (!PetscIsNanReal(now)) (*n_found)++;
    if (now > -PETSC_INFINITY) span[0] = PetscMin(span[0], now);
    if (now > -PETSC_INFINITY) span[1] = PetscMax(span[1], now);
    far = PetscAbsReal(0.5 * (last + value) - c->varied.value);
    if ((before > 0 && now <= 0) || (before <= 0 && now > 0)) {
      if (far < nearest) {
        at[0]     = last;
        at[1]     = value;
        growth[0] = before;
        growth[1] = now;
      }
      nearest = PetscMin(nearest, far);
    }
    before = now;
    last   = value;
  }
  if (nearest == PETSC_MAX_REAL) at[0] = at[1] = NAN;
  PetscFunctionReturn(0);
}

/* Growth at a value where there must be a sliding state, since there is one on both sides of it */
static PetscErrorCode HopfGrowth(LimitCycle c, PetscReal value, OnsetLook *look, PetscReal *growth)
{
  PetscFunctionBeginUser;
  PetscCall(OnsetGrowth(c, value, look, growth));
  PetscCheck(!PetscIsNanReal(*growth), c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_start mode: no sliding state is found at %s %.6g, next to where a mode becomes unstable: take "
             "another -cycle_range, or -cycle_start transient",
             c->varied.name, (double)value);
  PetscFunctionReturn(0);
}

/* The onset by bisection, which jumps of the closed pairs do not disturb: 35 halvings to 1e-12 of the range.
   c->onset = value, growth there (1/s), frequency (Hz). */
static PetscErrorCode HopfFind(LimitCycle c, OnsetLook *look)
{
  PetscReal at[2], growth[2], span[2];
  PetscInt  n_found;

  PetscFunctionBeginUser;
  PetscCall(HopfBracket(c, look, at, growth, &n_found, span));
  PetscCheck(n_found > 0, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_start mode: no sliding state is found for %s between %.6g and %.6g: do -loads press the contacts?",
             c->varied.name, (double)c->range[0], (double)c->range[1]);
  PetscCheck(
    span[0] <= span[1], c->comm, PETSC_ERR_USER_INPUT,
    "-cycle_start mode: no mode of the sliding state oscillates for %s between %.6g and %.6g: take less damping, or a "
    "higher -dynamics_cutoff",
    c->varied.name, (double)c->range[0], (double)c->range[1]);
  PetscCheck(
    !PetscIsNanReal(at[0]), c->comm, PETSC_ERR_USER_INPUT,
    "-cycle_start mode: no mode becomes unstable for %s between %.6g and %.6g, the fastest grows by %.3g to %.3g "
    "1/s: take another -cycle_range, or -cycle_start transient",
    c->varied.name, (double)c->range[0], (double)c->range[1], (double)span[0], (double)span[1]);
  while (PetscAbsReal(at[1] - at[0]) > ONSET_RTOL * (c->range[1] - c->range[0])) {
    const PetscReal middle = 0.5 * (at[0] + at[1]);
    PetscReal       now;

    if (middle == at[0] || middle == at[1]) break;
    PetscCall(HopfGrowth(c, middle, look, &now));
    at[(now > 0) == (growth[1] > 0)] = middle;
  }
  PetscCall(HopfGrowth(c, at[1], look, &growth[1]));
  c->onset[0] = at[1];
  c->onset[1] = look->eigenvalue[0];
  c->onset[2] = look->eigenvalue[1] / (2 * PETSC_PI);
  PetscFunctionReturn(0);
}

/* Normal forces of pairs, the root of the sum of their squares */
static PetscReal OnsetForce(const ReducedModel *model, const ReducedState *a, const ReducedState *b)
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < model->n_pairs; i++) sum += PetscSqr(a->p[3 * i]) + (b ? PetscSqr(b->p[3 * i]) : 0);
  return PetscSqrtReal(sum);
}

/* Rms of eta, rates and forces of the mode's motion, `scale` times its vector */
static void OnsetSizes(const ReducedModel *model, const OnsetLook *look, PetscReal scale, PetscReal size[3])
{
  PetscReal square[3] = {0, 0, 0};

  for (int part = 0; part < 2; part++) {
    const ReducedState *v = &look->mode[part];

    for (PetscInt k = 0; k < model->m; k++) {
      square[0] += PetscSqr(v->eta[k]);
      square[1] += PetscSqr(v->rate[k]);
    }
    for (PetscInt i = 0; i < 3 * model->n_pairs; i++) square[2] += PetscSqr(v->p[i]);
  }
  for (int i = 0; i < 3; i++) size[i] = scale * PetscSqrtReal(0.5 * square[i]);
}

/* Cosine and sine of the phase phi at which the normal forces p of the mode are largest: sum Re(p e^(i phi))^2 =
   sum |p|^2 / 2 + Re(e^(2 i phi) sum p^2) / 2 is, at 2 phi = -arg sum p^2. The sign is that of the largest force;
   weights rise from 1 to 2 along the pairs, so that of equal forces of opposite sign (a symmetric body) rounding
   does not choose. */
static void OnsetPhase(const OnsetLook *look, PetscInt n_pairs, PetscReal turn[2])
{
  PetscReal square[2] = {0, 0}, largest = 0, phase, sign = 1;

  for (PetscInt i = 0; i < n_pairs; i++) {
    const PetscReal p[2] = {look->mode[0].p[3 * i], look->mode[1].p[3 * i]};

    square[0] += p[0] * p[0] - p[1] * p[1];
    square[1] += 2 * p[0] * p[1];
  }
  phase = -0.5 * atan2(square[1], square[0]);
  for (PetscInt i = 0; i < n_pairs; i++) {
    const PetscReal p     = look->mode[0].p[3 * i] * cos(phase) - look->mode[1].p[3 * i] * sin(phase);
    const PetscReal weigh = PetscAbsReal(p) * (PetscReal)(n_pairs + i);

    if (weigh <= largest) continue;
    largest = weigh;
    sign    = p < 0 ? -1 : 1;
  }
  turn[0] = sign * cos(phase);
  turn[1] = sign * sin(phase);
}

/* x = Re(v exp(i phase)) as the shooting sees it; work [as long as x] */
static PetscErrorCode OnsetPackMode(const CycleFlow *flow, const OnsetLook *look, PetscReal work[], PetscReal x[])
{
  PetscReal turn[2];

  PetscFunctionBeginUser;
  OnsetPhase(look, flow->model->n_pairs, turn);
  PetscCall(CycleFlowPack(flow, &look->mode[0], x));
  PetscCall(CycleFlowPack(flow, &look->mode[1], work));
  for (PetscInt i = 0; i < flow->n; i++) x[i] = turn[0] * x[i] - turn[1] * work[i];
  PetscFunctionReturn(0);
}

/* All pairs slide: the states whose modes are looked at are those of sliding */
static PetscErrorCode OnsetCheckSliding(LimitCycle c)
{
  const ContactInterface *list;
  PetscInt                n;
  Model                   model;
  Contact                 contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(c->operators, &model, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &list));
  for (PetscInt i = 0; i < c->flow.model->n_pairs; i++) {
    const char *name = list[c->flow.interface[i]].name;

    PetscCheck(c->flow.stated[i].speed != 0, c->comm, PETSC_ERR_USER_INPUT,
               "contact %s: -cycle_start mode is about sliding, and its speed is 0; say it by -%s_slip and -%s_speed",
               name, name, name);
  }
  PetscFunctionReturn(0);
}

/* The cycle near the mode's motion `length` away from rest, which must lie in the range */
static PetscErrorCode OnsetAdvance(LimitCycle c, PetscReal length, const ShootingTangent *growing, ShootingCycle *at)
{
  PetscFunctionBeginUser;
  PetscCall(ShootingAdvance(&c->shooting, length, growing, at));
  PetscCheck(
    at->converged, c->comm, PETSC_ERR_NOT_CONVERGED,
    "-cycle_start mode: at %s %.6g, where a mode of %.6g Hz becomes unstable, Newton's method finds no cycle of "
    "-cycle_amplitude %.3g in %" PetscInt_FMT " steps: take another amplitude, more -cycle_steps, or "
    "-cycle_start transient",
    c->varied.name, (double)c->onset[0], (double)c->onset[2], (double)c->amplitude, at->its);
  PetscCheck(at->value >= c->range[0] && at->value <= c->range[1], c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range %.6g,%.6g must hold %s %.6g, where the first cycle, of -cycle_amplitude %.3g, is: take a "
             "wider range, or another amplitude",
             (double)c->range[0], (double)c->range[1], c->varied.name, (double)at->value, (double)c->amplitude);
  PetscFunctionReturn(0);
}

/* Sizes, lengths and the tangent `growing` are those of the mode scaled to amplitude 1; growing has unit length in
   S x, and neither period nor parameter has a part in it. */
PetscErrorCode CycleBegin(LimitCycle c, ShootingCycle *at, ShootingTangent *growing)
{
  const ReducedModel *model = c->flow.model;
  PetscReal           scale, size[3], length = 0, *work;
  OnsetLook           look;

  PetscFunctionBeginUser;
  PetscCall(OnsetCheckSliding(c));
  PetscCall(LookCreate(model, &look));
  PetscCall(HopfFind(c, &look));
  scale = OnsetForce(model, &look.rest, NULL) / OnsetForce(model, &look.mode[0], &look.mode[1]);
  OnsetSizes(model, &look, scale, size);
  PetscCall(CycleSetSizes(c, size));
  at->value  = look.value;
  at->period = 2 * PETSC_PI / look.eigenvalue[1];
  PetscCall(CycleFlowPack(&c->flow, &look.rest, at->x));
  PetscCall(PetscMalloc1(c->flow.n, &work));
  PetscCall(OnsetPackMode(&c->flow, &look, work, growing->x));
  PetscCall(PetscFree(work));
  for (PetscInt i = 0; i < c->flow.n; i++) length += PetscSqr(c->shooting.weight[i] * growing->x[i]);
  length          = PetscSqrtReal(length);
  growing->period = growing->value = 0;
  for (PetscInt i = 0; i < c->flow.n; i++) growing->x[i] /= length;
  PetscCall(CycleSetShooting(c, at->period));
  PetscCall(OnsetAdvance(c, c->amplitude * scale * length, growing, at));
  PetscCall(LookDestroy(&look));
  PetscFunctionReturn(0);
}
