/*
   Greedy choice of the full solutions. The first point is solved by the eigensolver (Krylov, right and left), further
   ones by corrections of what the basis gives there: a block solve with the factors of the full pencil, repeated until
   the corrections no longer matter. At each of these points Sylvester's law of inertia counts the frictionless modes;
   when the basis has fewer, the point is solved by the eigensolver too.

   A point's first corrections z_r, z_s tell the error that the basis had there (estimate.c). The next point is the one
   farthest from all looked at, as long as the last one had to be taken in; else the one with the largest estimate. It
   ends when the farthest point needs nothing (two of them while there are no corrections that could tell an error
   elsewhere), and no point does by the estimate with all corrections so far (points.c).

   Corrections of one point tell little of the error at others. Before it ends, the points farthest from all others are
   therefore looked at with the factors of the last one, a block solve each, which estimates the error from then on. Of
   two points alone both are full solutions, which say nothing of what lies between: there the middle is looked at.
   Where few points differ, as those of a load that changes contact statuses, the last full solution itself is looked at
   too: its corrections end at rtol.

   Over a box of many parameters corrections are many and much alike. Of each block of them those directions are kept
   that hold energy, in the norm K + h^2 M (correct.c); what is left out is a part of the stated errors. Pairs that open
   and close are taken in behind the first point (pairs.c). Looks go on until some in a row find no more than was
   stated, and by how much others did widens what is stated.
*/
#include "greedywork.h"

/* Relative width beyond the band of modes that the basis holds: a mode that crosses the edge between two points
   must be in the basis before it is in the band. */
#define GUARD 0.03
/* Vectors shorter than this beside the root of rtol add nothing to the model: the error of an eigenvalue is of
   second order in that of the vectors, |z|^2 <= 1e-6 rtol. */
#define GREEDY_DROP 1e-3
#define LAZY_BATCH  4 /* on any number of ranks */
#define LOOK_SURE   3 /* looks one after the other that find no more than was stated, over a box */

/* Distance of point i from the nearest full solution, in parts of the extent: sqrt(sum_k ((a_k - b_k) /
   scale_k)^2), along a range measured in ratios (scale < 0) with log(a_k / b_k). No unit. */
static PetscReal PointDistance(const GreedyWork *run, PetscInt i)
{
  const PetscInt   n_parameters = run->basis->reduced.n_parameters;
  const PetscReal *a = &run->points[i * n_parameters], *scale = run->scale;
  PetscReal        nearest = PETSC_MAX_REAL;

  for (PetscInt j = run->first; j < run->greedy->n_samples; j++) {
    const PetscReal *b   = run->greedy->sample[j].p;
    PetscReal        sum = 0;

    for (PetscInt k = 0; k < n_parameters; k++) {
      if (scale[k] > 0) sum += PetscSqr((a[k] - b[k]) / scale[k]);
      if (scale[k] < 0) sum += PetscSqr(PetscLogReal(a[k] / b[k]) / scale[k]);
    }
    nearest = PetscMin(nearest, PetscSqrtReal(sum));
  }
  return nearest;
}

/* The point farthest from all full solutions, and how far. Equal distances are those within 1e-12: the first of
   them is taken, on all ranks, whatever rounding says. */
static PetscInt PointFarthest(const GreedyWork *run, PetscReal *farthest)
{
  PetscInt best = 0;

  *farthest = -1;
  for (PetscInt i = 0; i < run->n; i++) {
    const PetscReal nearest = PointDistance(run, i);

    if (nearest <= *farthest + 1e-12) continue;
    *farthest = nearest;
    best      = i;
  }
  return best;
}

/* The point of the largest estimate among those whose own factors were not made twice; -1 for none */
static PetscInt EstimateWorst(const GreedyWork *run)
{
  PetscInt worst = -1;

  for (PetscInt i = 0; i < run->n; i++)
    if (PointTimes(run, &run->points[i * run->basis->reduced.n_parameters], PETSC_TRUE) < 2 &&
        (worst < 0 || run->estimate[i] > run->estimate[worst]))
      worst = i;
  return worst;
}

/* Estimates of all points on the present basis */
static PetscErrorCode EstimatesAll(GreedyWork *run)
{
  const Greedy *g = run->greedy;

  PetscFunctionBeginUser;
  PetscCall(PointsEstimate(g->groups, &run->basis->reduced, &g->window, run->n, run->points, run->estimate));
  for (PetscInt i = 0; i < run->n; i++) run->fresh[i] = run->basis->reduced.n;
  PetscFunctionReturn(0);
}

/* Estimates fall as the basis grows, as a rule: those from a smaller basis serve as bounds. LAZY_BATCH of the largest
   ones are made anew until the largest is from the present basis (M. Minoux, Accelerated greedy algorithms, 1978). At
   the end all are (PointNext()) */
static PetscErrorCode EstimatesLazy(GreedyWork *run)
{
  const PetscInt n_parameters = run->basis->reduced.n_parameters, now = run->basis->reduced.n;
  PetscReal     *points, worst[LAZY_BATCH];
  PetscInt       list[LAZY_BATCH];

  PetscFunctionBeginUser;
  if (!run->fresh[0]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(LAZY_BATCH * n_parameters, &points));
  for (PetscInt i = EstimateWorst(run); i >= 0 && run->fresh[i] != now; i = EstimateWorst(run)) {
    PetscInt n = 0;

    while (n < LAZY_BATCH && i >= 0 && run->fresh[i] != now) {
      PetscCall(PetscArraycpy(&points[n * n_parameters], &run->points[i * n_parameters], n_parameters));
      list[n++]        = i;
      run->fresh[i]    = now;
      run->estimate[i] = 0; /* so that the next one is found */
      i                = EstimateWorst(run);
    }
    PetscCall(PointsEstimate(run->greedy->groups, &run->basis->reduced, &run->greedy->window, n, points, worst));
    for (PetscInt k = 0; k < n; k++) run->estimate[list[k]] = worst[k];
  }
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* The next point to look at, or -1. First by distance, which needs no solution, then by the estimate at all points
   (collective). A point whose own factors were made twice is not chosen again. */
static PetscErrorCode PointNext(GreedyWork *run, PetscInt *next)
{
  Greedy         *g = run->greedy;
  PetscReal       farthest;
  PetscInt        worst  = -1;
  const PetscBool blind  = run->basis->reduced.n == run->basis->reduced.n_used ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  enough = blind ? 2 : 1;

  PetscFunctionBeginUser;
  *next = PointFarthest(run, &farthest);
  if (g->n_passed < enough && (farthest > 0 || g->n_samples == 1)) PetscFunctionReturn(0);
  if (g->reach > g->window.growth) g->window.rtol = g->goal * g->rtol / POINTS_MARGIN; /* as in what comes after */
  if (g->lazy) PetscCall(EstimatesLazy(run));
  worst = EstimateWorst(run);
  if (!g->lazy || worst < 0 || run->estimate[worst] <= g->goal * g->rtol) PetscCall(EstimatesAll(run));
  worst    = EstimateWorst(run);
  g->worst = worst >= 0 ? run->estimate[worst] : 0;
  *next    = g->worst > g->goal * g->rtol ? worst : -1;
  PetscFunctionReturn(0);
}

/* Place between the first two points, in the measure of PointDistance() */
static void PointsMiddle(const GreedyWork *run, PetscReal middle[])
{
  const PetscInt   n = run->basis->reduced.n_parameters;
  const PetscReal *a = run->points, *b = &run->points[n];

  for (PetscInt k = 0; k < n; k++) middle[k] = run->scale[k] < 0 ? PetscSqrtReal(a[k] * b[k]) : 0.5 * (a[k] + b[k]);
}

/* Contact statuses among the points, of groups of pairs that open and close; 0 without groups */
static PetscErrorCode PointsStatuses(const GreedyWork *run, PetscInt *n)
{
  const OperatorsParameter *parameter    = run->basis->reduced.parameter;
  const PetscInt            n_parameters = run->basis->reduced.n_parameters;
  PetscInt                  first        = n_parameters;

  PetscFunctionBeginUser;
  *n = 0;
  while (first > 0 && parameter[first - 1].internal) first--;
  for (PetscInt i = 0; i < run->n && first < n_parameters; i++) {
    PetscBool same = PETSC_FALSE;

    for (PetscInt j = 0; j < i && !same; j++)
      PetscCall(PetscArraycmp(&run->points[i * n_parameters + first], &run->points[j * n_parameters + first],
                              n_parameters - first, &same));
    *n += same ? 0 : 1;
  }
  PetscFunctionReturn(0);
}

/* The point of the largest estimate among those not looked at; -1 for none */
static PetscInt LookWorst(const GreedyWork *run)
{
  PetscInt worst = -1;

  for (PetscInt i = 0; i < run->n; i++)
    if ((worst < 0 || run->estimate[i] > run->estimate[worst]) && PointDistance(run, i) > 0) worst = i;
  return worst;
}

/* Where to look: at the point farthest from all others, over a box every other time at that of the largest estimate; of
   two then at the middle, for right and for left vectors; then at the last full solution itself, whose corrections
   ended at rtol and left short vectors out; NULL for nowhere more */
static const PetscReal *LookNext(const GreedyWork *run, PetscInt look, const PetscReal middle[], PetscBool *own)
{
  PetscReal farthest;
  PetscInt  i = PointFarthest(run, &farthest);

  if (farthest > 0 && run->greedy->most_looks && look % 2 == 0) i = LookWorst(run);
  if (farthest > 0) return &run->points[i * run->basis->reduced.n_parameters];
  if (run->n == 2 && look < 3) return middle;
  if (*own) return NULL;
  *own = PETSC_TRUE;
  return run->greedy->sample[run->first].p;
}

/* Whether there are looks enough: `n` of them, and over a box the last LOOK_SURE ones without an error beyond what was
   stated; or one that tells that the model is not good enough */
static PetscBool LooksEnough(const GreedyWork *run, PetscInt look, PetscInt n, PetscInt n_sure, PetscReal worst)
{
  const Greedy *g = run->greedy;

  if (!g->most_looks) return look >= n ? PETSC_TRUE : PETSC_FALSE;
  if (POINTS_MARGIN * worst > g->goal * g->rtol || look >= LOOK_MOST) return PETSC_TRUE;
  return look >= n && n_sure >= LOOK_SURE ? PETSC_TRUE : PETSC_FALSE;
}

/* Looks at the points farthest from all others with the factors of the last full solution, where pairs open and
   close at every status: what one lacks says little of another. The points looked at stand among the samples for
   the distances only and are taken out in the end; the vectors found stay, as Z of the estimate. */
static PetscErrorCode PointsLook(GreedyWork *run)
{
  Greedy *const        g         = run->greedy;
  const PetscInt       n_samples = g->n_samples, n_parameters = run->basis->reduced.n_parameters;
  const CorrectionDrop drop  = run->drop;
  PetscReal            worst = 0, surprise = 0, beyond = 0, *middle;
  PetscInt             n_added, n_statuses, n_sure     = 0;
  PetscBool            own = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_parameters, &middle));
  PetscCall(PointsStatuses(run, &n_statuses));
  if (run->n == 2) PointsMiddle(run, middle);
  g->looked  = PETSC_TRUE;
  run->first = g->most_looks ? 0 : n_samples - 1; /* over a box those solved in full are known */
  run->drop  = (CorrectionDrop){PetscMin(drop.length, LOOK_DROP), drop.energy};
  if (g->most_looks) n_statuses = PetscMin(n_statuses, g->most_looks);
  if (g->most_looks) run->surprise = &surprise;
  run->basis->reduced.beyond = 0;
  for (int look = 0; !LooksEnough(run, look, PetscMax(GREEDY_LOOKS, n_statuses), n_sure, worst); look++) {
    const PetscReal *p     = LookNext(run, look, middle, &own);
    ReducedModes     modes = {0};

    if (!p) break;
    run->sides = own || n_statuses ? CORRECT_BOTH : look % 2 ? CORRECT_LEFT : CORRECT_RIGHT;
    PetscCall(FactorKeep(run, p));
    PetscCall(StepApply(run, p, &modes, &n_added, &worst));
    PetscCall(ReducedModesDestroy(&modes));
    n_sure = surprise <= 1 ? n_sure + 1 : 0;
    beyond = PetscMax(beyond, surprise);
    PetscCall(SampleAdd(run, p, PETSC_FALSE, 0, worst)); /* for the distances */
  }
  run->basis->reduced.beyond = beyond > 1 ? beyond : 0;
  run->sides                 = CORRECT_BOTH;
  run->surprise              = NULL;
  run->first                 = 0;
  run->drop                  = drop;
  for (PetscInt j = n_samples; j < g->n_samples; j++) PetscCall(PetscFree(g->sample[j].p));
  g->n_samples = n_samples;
  PetscCall(PetscFree(middle));
  PetscFunctionReturn(0);
}

static PetscErrorCode GreedyWorkDestroy(GreedyWork *run)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertDestroy(&run->counter));
  PetscCall(PetscFree3(run->estimate, run->scale, run->fresh));
  PetscFunctionReturn(0);
}

/* The loop ends: each pass adds a sample, of which there are max_samples. Called again with other points it goes on
   with the samples that there are. Collective; distances and estimates are alike on all ranks. */
PetscErrorCode GreedyRun(Greedy *greedy, PetscInt n, const PetscReal points[], Basis *basis)
{
  const PetscReal low = greedy->window.low, high = greedy->window.high;
  GreedyWork      run          = {.greedy     = greedy,
                                  .basis      = basis,
                                  .n          = n,
                                  .points     = points,
                                  .guarded    = greedy->window,
                                  .correction = &greedy->correction};
  PetscInt        n_parameters = basis->reduced.n_parameters, next = 0;

  PetscFunctionBeginUser;
  run.counter.progress = greedy->progress;
  run.drop             = (CorrectionDrop){GREEDY_DROP * PetscSqrtReal(greedy->rtol), greedy->energy};
  run.guarded.low      = low < 0.5 * high ? 0 : low * (1 - GUARD);
  run.guarded.high     = high * (1 + GUARD);
  run.guarded.growth   = PetscMax(greedy->window.growth, greedy->reach);
  run.guarded.rtol     = 0;
  PetscCall(PetscCalloc3(n, &run.estimate, n_parameters, &run.scale, n, &run.fresh));
  PetscCall(PointsScale(basis->pencil, n, points, run.scale));
  if (greedy->n_samples) PetscCall(PointNext(&run, &next));
  for (;;) {
    if (next < 0 && !greedy->looked) {
      PetscCall(PointsLook(&run));
      PetscCall(PointNext(&run, &next));
    }
    if (next < 0 || greedy->n_samples >= greedy->max_samples) break;
    if (greedy->n_samples) {
      PetscCall(SampleCorrect(&run, &points[next * n_parameters], &greedy->last));
    } else {
      PetscCall(SampleKrylov(&run, points, NAN));
      if (greedy->lazy) PetscCall(PairsTake(&run, points));
    }
    greedy->looked        = PETSC_FALSE;
    basis->reduced.beyond = 0; /* of the model before */
    if (greedy->keep) PetscCall(greedy->keep(greedy->keep_ctx));
    PetscCall(PointNext(&run, &next));
  }
  PetscCall(GreedyWorkDestroy(&run));
  PetscCheck(next < 0, basis->comm, PETSC_ERR_NOT_CONVERGED,
             "%s %.6g is not made sure of at all %" PetscInt_FMT " points by %" PetscInt_FMT " full solutions; %s",
             greedy->option, (double)greedy->rtol, n, greedy->n_samples, greedy->advice);
  PetscFunctionReturn(0);
}

PetscErrorCode GreedyDestroy(Greedy *greedy)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < greedy->n_samples; i++) PetscCall(PetscFree(greedy->sample[i].p));
  PetscCall(PetscFree(greedy->sample));
  PetscCall(CorrectionDestroy(&greedy->correction));
  PetscFunctionReturn(0);
}
