/*
   The branch of cycles through the one that was found, both ways by pseudo-arclength (solver/shooting/shooting.h),
   through folds, until the parameter leaves its range, the vibration vanishes or no further cycle is found. Distances
   are those of (eta, rate) over their rms in a vibration that is told before, of T over itself and of the parameter
   over its range. Where dp/ds changes its sign between two cycles the fold is looked for.
*/
#include "cycleimpl.h"

#define BRANCH_STEP 0.1 /* the first */
/* Of the vibration's rms: longer steps may land on another branch. */
#define BRANCH_LONGEST 0.25
#define BRANCH_SHRINKS 0.7 /* times the rms over that of the vibration, at most: it is not passed by zero */
/* Halved ten times from the first: shorter ones would come no further. */
#define BRANCH_SHORTEST 1e-4
#define BRANCH_EASY     3 /* steps of Newton's method after which the next step is longer */
#define BRANCH_MAX_IT   8
/* Rms of the force over that of the vibration, below which the branch has come to an onset. */
#define BRANCH_VANISHED 0.05
#define BRANCH_UPRIGHT                                                                                                 \
  1e-5 /* slope over the span below which a branch has no fold: linear vibrations of any amplitude at an onset */
#define BRANCH_BEYOND 0.01 /* of the span, and twice that of an end: how far a step may go beyond it */

/* One way along the branch */
typedef struct {
  ShootingPlace     here, next, fold;
  PetscReal         step;
  PetscInt          most;      /* points after which it ends */
  ShootingDirection direction; /* of the branch at the next place */
  const char       *end;
} BranchWay;

/* A step that goes beyond the range by a little at most, where there are no models: dp = t_p ds, t_p the slope of
   the tangent. */
static PetscReal BranchLimit(const LimitCycle c, const BranchWay *w)
{
  const PetscReal slope = w->here.tangent.value, end = c->range[slope > 0];
  const PetscReal least = PetscMin(BRANCH_BEYOND * (c->range[1] - c->range[0]), 2 * BRANCH_BEYOND * PetscAbsReal(end));
  const PetscReal far   = PetscAbsReal(end - w->here.cycle.value) + PetscMax(least, PETSC_SMALL);

  return slope != 0 ? PetscMin(w->step, far / PetscAbsReal(slope)) : w->step;
}

/* The next cycle, that at the end of the range from one beyond it; taken is false where there is none */
static PetscErrorCode BranchStep(LimitCycle c, PetscReal step, BranchWay *w, PetscBool *taken)
{
  ShootingCycle *at = &w->next.cycle;
  PetscReal      inside;

  PetscFunctionBeginUser;
  PetscCall(ShootingCopy(c->flow.n, &w->here.cycle, at));
  PetscCall(ShootingAdvance(&c->shooting, step, &w->here.tangent, at));
  *taken = at->converged;
  inside = PetscMin(c->range[1], PetscMax(c->range[0], at->value));
  if (!*taken || inside == at->value) PetscFunctionReturn(0);
  at->value = inside;
  PetscCall(ShootingSolve(&c->shooting, at));
  *taken = at->converged;
  w->end = *taken ? "end of -cycle_range" : "none is found at the end of -cycle_range";
  PetscFunctionReturn(0);
}

/* Why the branch ends at a place without direction; NULL where there is one */
static const char *BranchNoWay(ShootingDirection direction)
{
  if (direction == SHOOTING_NO_DERIVATIVE) return "the motion has no derivative there";
  return direction == SHOOTING_SPLITS ? "the branch splits, and has no direction" : NULL;
}

/* Direction at the next place, by the one before so that it does not turn back; and the fold where the parameter
   has turned back, dp/ds of both signs, unless both are nearly 0. */
static PetscErrorCode BranchTurn(LimitCycle c, PetscReal step, BranchWay *w)
{
  ShootingTangent *t = &w->next.tangent;
  PetscReal        error;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(t->x, w->here.tangent.x, c->flow.n));
  t->period = w->here.tangent.period;
  t->value  = w->here.tangent.value;
  PetscCall(ShootingGetTangent(&c->shooting, &w->next.cycle, t, &w->direction));
  if (w->direction != SHOOTING_ALONG || (t->value > 0) == (w->here.tangent.value > 0)) PetscFunctionReturn(0);
  if (PetscMax(PetscAbsReal(t->value), PetscAbsReal(w->here.tangent.value)) < BRANCH_UPRIGHT * c->shooting.span)
    PetscFunctionReturn(0);
  PetscCall(ShootingFindFold(&c->shooting, &w->here, step, t->value, &w->fold, &error));
  if (error >= 0) PetscCall(CycleTake(c, &w->fold.cycle, &w->fold.tangent, error));
  PetscFunctionReturn(0);
}

/* How far the next step goes, and why there is none */
static void BranchGoOn(const LimitCycle c, PetscBool taken, BranchWay *w)
{
  const CyclePoint *last = &c->point[c->in_front ? 0 : c->n_points - 1];

  if (w->end) return;
  if (!taken) {
    w->step /= 2;
    if (w->step < BRANCH_SHORTEST) w->end = "no further cycle is found";
    return;
  }
  if (w->next.cycle.its <= BRANCH_EASY) w->step = PetscMin(1.5 * w->step, BRANCH_LONGEST);
  w->step = PetscMin(w->step, BRANCH_SHRINKS * last->found.rms / c->rms);
  w->end  = BranchNoWay(w->direction);
  if (w->end) return;
  if (last->found.rms < BRANCH_VANISHED * c->rms)
    w->end = "the vibration vanishes";
  else if (c->n_points >= w->most)
    w->end = "-cycle_points";
}

/* Direction, first step, and whether there is any */
static PetscErrorCode BranchLeave(LimitCycle c, BranchWay *w)
{
  const PetscReal value = w->here.cycle.value;

  PetscFunctionBeginUser;
  w->step = BRANCH_STEP;
  PetscCall(ShootingGetTangent(&c->shooting, &w->here.cycle, &w->here.tangent, &w->direction));
  w->end = BranchNoWay(w->direction);
  if (w->here.tangent.value > 0 ? value >= c->range[1] : value <= c->range[0]) w->end = "end of -cycle_range";
  if (c->n_points >= w->most) w->end = "-cycle_points";
  PetscFunctionReturn(0);
}

/* One way along the branch, from a place on */
static PetscErrorCode BranchWalk(LimitCycle c, BranchWay *w)
{
  PetscFunctionBeginUser;
  PetscCall(BranchLeave(c, w));
  while (!w->end) {
    const PetscReal     step = BranchLimit(c, w);
    const ShootingPlace here = w->here;
    PetscBool           taken;

    w->step = step;
    PetscCall(BranchStep(c, step, w, &taken));
    if (taken && !w->end) PetscCall(BranchTurn(c, step, w));
    if (taken && c->n_points < w->most) PetscCall(CycleTake(c, &w->next.cycle, NULL, -1));
    BranchGoOn(c, taken, w);
    if (!taken) continue;
    w->here = w->next;
    w->next = here;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceCreate(PetscInt n, ShootingPlace *place)
{
  PetscFunctionBeginUser;
  *place = (ShootingPlace){.cycle.period = 0};
  PetscCall(PetscCalloc3(n, &place->cycle.x, n * n, &place->cycle.M, n, &place->tangent.x));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceDestroy(ShootingPlace *place)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(place->cycle.x, place->cycle.M, place->tangent.x));
  PetscFunctionReturn(0);
}

/* The start, and the way from it: of the parameter, or along `growing` */
static PetscErrorCode BranchBegin(LimitCycle c, const ShootingCycle *start, const ShootingTangent *growing,
                                  PetscReal sign, BranchWay *w)
{
  ShootingTangent *t = &w->here.tangent;

  PetscFunctionBeginUser;
  PetscCall(ShootingCopy(c->flow.n, start, &w->here.cycle));
  for (PetscInt i = 0; i < c->flow.n; i++) t->x[i] = growing ? sign * growing->x[i] : 0;
  t->period = growing ? sign * growing->period : 0;
  t->value  = growing ? sign * growing->value : sign * c->shooting.span;
  PetscFunctionReturn(0);
}

/* One way first, into rows in front of the start, then the other, so that the table is in the order of the branch;
   the first may take half of the points. Newton's method gets fewer steps than at the start: a shorter step along
   the branch costs less. */
PetscErrorCode CycleFollow(LimitCycle c, const ShootingCycle *start, const ShootingTangent *growing)
{
  const PetscInt n = c->flow.n, max_it = c->shooting.max_it;
  BranchWay      w = {.end = NULL};

  PetscFunctionBeginUser;
  c->shooting.max_it = BRANCH_MAX_IT;
  PetscCall(PlaceCreate(n, &w.here));
  PetscCall(PlaceCreate(n, &w.next));
  PetscCall(PlaceCreate(n, &w.fold));
  for (int way = 0; way < 2; way++) {
    PetscCall(BranchBegin(c, start, growing, way ? 1 : -1, &w));
    c->in_front = way ? PETSC_FALSE : PETSC_TRUE;
    w.most      = way ? c->max_points : PetscMax(2, (c->max_points + 1) / 2);
    PetscCall(BranchWalk(c, &w));
    c->end[way] = w.end;
  }
  c->shooting.max_it = max_it;
  PetscCall(PlaceDestroy(&w.here));
  PetscCall(PlaceDestroy(&w.next));
  PetscCall(PlaceDestroy(&w.fold));
  PetscFunctionReturn(0);
}
