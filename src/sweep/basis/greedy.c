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
   therefore looked at with the factors of the last one, a block solve each, which estimates the error from then on.
*/
#include "greedy.h"

#define GUARD        0.03 /* relative width beyond the band of modes that the basis holds */
#define SAFE         0.01 /* what is asked at a point that corrections come from, beside rtol */
#define SETTLED      1e-3 /* beside rtol: a mode that needs no more corrections at this point */
#define GREEDY_STEPS 8
#define GREEDY_DROP  1e-3 /* vectors shorter than this beside the root of rtol add nothing to the model */
#define LOOK_DROP    3e-2 /* beside that: vectors that tell an error, as the square times a ratio of stiffnesses, 1e4 */

/* What the run knows */
typedef struct {
  Greedy          *greedy;
  Basis           *basis;
  ReducedWindow    guarded; /* a little wider */
  PetscInt         n;
  const PetscReal *points;
  PetscReal       *estimate; /* [n] */
  PetscReal       *scale;    /* [n_parameters] */
  PetscReal        drop;
  CorrectionSides  sides;
  PetscInt         first; /* sample from which on distances are measured */
  Correction       correction;
  ShiftInvert      counter;             /* where the factors of the correction do not serve */
  PetscBool        has_factor, is_near; /* is_near: the factors are those of the point */
} GreedyWork;

/* New entry of the list of full solutions */
static PetscErrorCode SampleAdd(GreedyWork *run, const PetscReal p[], PetscBool krylov, PetscInt n_vectors,
                                PetscReal estimate)
{
  Greedy        *g            = run->greedy;
  const PetscInt n_parameters = run->basis->reduced.n_parameters;
  GreedySample  *sample       = &g->sample[g->n_samples++];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_parameters, &sample->p));
  PetscCall(PetscArraycpy(sample->p, p, n_parameters));
  sample->krylov    = krylov;
  sample->n_vectors = n_vectors;
  sample->estimate  = estimate;
  PetscFunctionReturn(0);
}

/* Solves point p by the eigensolver */
static PetscErrorCode SampleKrylov(GreedyWork *run, const PetscReal p[], PetscReal estimate)
{
  const PetscReal wide[2] = {run->guarded.low / (2 * PETSC_PI), run->guarded.high / (2 * PETSC_PI)};
  const Mode     *mode;
  PetscReal       band[2], growth;
  PetscInt        n, n_vectors;
  BV              block;

  PetscFunctionBeginUser;
  PetscCall(PencilSetParameters(run->basis->pencil, p));
  PetscCall(ModesGetBand(run->greedy->modes, band, &growth));
  PetscCall(ModesSetBand(run->greedy->modes, wide));
  PetscCall(ModesSolve(run->greedy->modes));
  PetscCall(ModesSetBand(run->greedy->modes, band));
  PetscCall(ModesGet(run->greedy->modes, &n, &mode));
  PetscCall(BasisCreateModes(run->basis, run->greedy->modes, n, 4, &block));
  PetscCall(BasisAdd(run->basis, block, run->drop, &n_vectors));
  PetscCall(BVDestroy(&block));
  run->basis->reduced.n_used = run->basis->reduced.n;
  PetscCall(SampleAdd(run, p, PETSC_TRUE, n_vectors, estimate));
  PetscFunctionReturn(0);
}

/* One step of corrections at p of the modes that the step before (modes, empty at first) has not settled; worst = what
   they tell about the model before */
static PetscErrorCode StepApply(GreedyWork *run, const PetscReal p[], ReducedModes *modes, PetscInt *n_added,
                                PetscReal *worst)
{
  ReducedModes before = *modes;

  PetscFunctionBeginUser;
  PetscCall(ReducedSolve(&run->basis->reduced, p, &run->guarded, modes));
  PetscCall(ReducedModesBroadcast(run->basis->comm, 0, modes)); /* control flow must be alike on all ranks */
  PetscCall(CorrectionDropSettled(&before, SETTLED * run->greedy->rtol, modes));
  PetscCall(ReducedModesDestroy(&before));
  PetscCall(CorrectionApplySides(&run->correction, modes, run->sides, run->drop, run->basis, n_added));
  PetscCall(ReducedEstimate(&run->basis->reduced, p, modes));
  PetscCall(ReducedModesBroadcast(run->basis->comm, 0, modes));
  *worst = ReducedModesWorst(modes, &run->greedy->window, PETSC_FALSE);
  PetscFunctionReturn(0);
}

/* Whether the basis has as many frictionless modes at p as the full problem */
static PetscErrorCode SampleCount(GreedyWork *run, const PetscReal p[], PetscBool *complete)
{
  PetscInt full, by_basis;
  /* LDL' factors at the upper end are those of the count there; an LU would have to be made again after it */
  const PetscBool shared =
    run->is_near && run->correction.factor.even && run->greedy->window.low < 0.5 * run->greedy->window.high
      ? PETSC_TRUE
      : PETSC_FALSE;
  ShiftInvert *counter = shared ? &run->correction.factor : &run->counter;

  PetscFunctionBeginUser;
  PetscCall(CorrectionCount(run->basis, p, &run->greedy->window, counter, &full, &by_basis));
  PetscCallMPI(MPI_Bcast(&by_basis, 1, MPIU_INT, 0, run->basis->comm));
  *complete = full == by_basis ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The factors at p in place of those before */
static PetscErrorCode FactorMake(GreedyWork *run, const PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(CorrectionCreate(run->basis->pencil, p, &run->greedy->window, run->greedy->progress, &run->correction));
  run->has_factor = run->is_near = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* The pencil at p with the factors of the last point that has any; a run that goes on makes these anew */
static PetscErrorCode FactorKeep(GreedyWork *run, const PetscReal p[])
{
  PetscInt last = run->greedy->n_samples - 1;

  PetscFunctionBeginUser;
  while (last > 0 && !run->greedy->sample[last].factored) last--;
  if (!run->has_factor) PetscCall(FactorMake(run, run->greedy->sample[last].p));
  PetscCall(CorrectionMove(run->basis->pencil, p, &run->correction));
  run->is_near = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* How often p has been looked at, or, factored, corrected with factors of its own */
static PetscInt PointTimes(const GreedyWork *run, const PetscReal p[], PetscBool factored)
{
  PetscInt times = 0;

  for (PetscInt j = 0; j < run->greedy->n_samples; j++) {
    const GreedySample *sample = &run->greedy->sample[j];
    PetscBool           same   = sample->factored || !factored ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt k = 0; k < run->basis->reduced.n_parameters && same; k++)
      same = sample->p[k] == p[k] ? PETSC_TRUE : PETSC_FALSE;
    times += same ? 1 : 0;
  }
  return times;
}

/* Looks at point p: first = the estimate there before; where it exceeds rtol, the basis takes the point in */
static PetscErrorCode SampleCorrect(GreedyWork *run, const PetscReal p[], PetscReal *first)
{
  const PetscReal drop  = run->drop;
  ReducedModes    modes = {0};
  PetscReal       worst;
  PetscInt        n_added, n_vectors = 0;
  PetscBool       complete = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (PointTimes(run, p, PETSC_TRUE)) run->drop *= LOOK_DROP; /* what was left out is what errs */
  if (run->greedy->n_samples > 1 && !PointTimes(run, p, PETSC_FALSE))
    PetscCall(FactorKeep(run, p));
  else
    PetscCall(FactorMake(run, p));
  PetscCall(StepApply(run, p, &modes, &n_added, first));
  worst = *first;
  if (worst > SAFE * run->greedy->rtol && !run->is_near) PetscCall(FactorMake(run, p));
  for (int step = 1; step < GREEDY_STEPS && worst > SAFE * run->greedy->rtol; step++) {
    n_vectors += n_added;
    run->basis->reduced.n_used = run->basis->reduced.n;
    PetscCall(StepApply(run, p, &modes, &n_added, &worst));
  }
  PetscCall(ReducedModesDestroy(&modes));
  run->drop = drop;
  PetscCall(SampleCount(run, p, &complete));
  run->greedy->n_passed = *first <= SAFE * run->greedy->rtol && complete ? run->greedy->n_passed + 1 : 0;
  PetscCall(SampleAdd(run, p, PETSC_FALSE, n_vectors, *first));
  run->greedy->sample[run->greedy->n_samples - 1].factored = run->is_near;
  if (!complete && run->greedy->n_samples < run->greedy->max_samples) {
    *first = PETSC_MAX_REAL;
    PetscCall(SampleKrylov(run, p, *first));
  }
  PetscFunctionReturn(0);
}

/* Distance of point i from the nearest full solution, in parts of the extent */
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

/* The point farthest from all full solutions, and how far */
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

/* The next point to look at, or -1 */
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
  PetscCall(PointsEstimate(g->groups, &run->basis->reduced, &g->window, run->n, run->points, run->estimate));
  for (PetscInt i = 0; i < run->n; i++)
    if (PointTimes(run, &run->points[i * run->basis->reduced.n_parameters], PETSC_TRUE) < 2 &&
        (worst < 0 || run->estimate[i] > run->estimate[worst]))
      worst = i;
  g->worst = worst >= 0 ? run->estimate[worst] : 0;
  *next    = g->worst > g->rtol ? worst : -1;
  PetscFunctionReturn(0);
}

/* Looks at the points farthest from all others with the factors of the last full solution */
static PetscErrorCode PointsLook(GreedyWork *run)
{
  Greedy *const   g         = run->greedy;
  const PetscInt  n_samples = g->n_samples, n_parameters = run->basis->reduced.n_parameters;
  const PetscReal drop = run->drop;
  PetscReal       farthest, worst;
  PetscInt        n_added;

  PetscFunctionBeginUser;
  g->looked  = PETSC_TRUE;
  run->first = n_samples - 1;
  run->drop *= LOOK_DROP;
  for (int look = 0; look < GREEDY_LOOKS; look++) {
    const PetscReal *p     = &run->points[PointFarthest(run, &farthest) * n_parameters];
    ReducedModes     modes = {0};

    if (farthest <= 0) break;
    run->sides = look % 2 ? CORRECT_LEFT : CORRECT_RIGHT;
    PetscCall(FactorKeep(run, p));
    PetscCall(StepApply(run, p, &modes, &n_added, &worst));
    PetscCall(ReducedModesDestroy(&modes));
    PetscCall(SampleAdd(run, p, PETSC_FALSE, 0, worst)); /* for the distances */
  }
  run->sides = CORRECT_BOTH;
  run->first = 0;
  run->drop  = drop;
  for (PetscInt j = n_samples; j < g->n_samples; j++) PetscCall(PetscFree(g->sample[j].p));
  g->n_samples = n_samples;
  PetscFunctionReturn(0);
}

static PetscErrorCode GreedyWorkDestroy(GreedyWork *run)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertDestroy(&run->correction.factor));
  PetscCall(ShiftInvertDestroy(&run->counter));
  PetscCall(PetscFree2(run->estimate, run->scale));
  PetscFunctionReturn(0);
}

PetscErrorCode GreedyRun(Greedy *greedy, PetscInt n, const PetscReal points[], Basis *basis)
{
  const PetscReal low = greedy->window.low, high = greedy->window.high;
  GreedyWork      run = {.greedy = greedy, .basis = basis, .n = n, .points = points, .guarded = greedy->window};
  PetscInt        n_parameters = basis->reduced.n_parameters, next = 0;

  PetscFunctionBeginUser;
  run.counter.progress = greedy->progress;
  run.drop             = GREEDY_DROP * PetscSqrtReal(greedy->rtol);
  run.guarded.low      = low < 0.5 * high ? 0 : low * (1 - GUARD);
  run.guarded.high     = high * (1 + GUARD);
  PetscCall(PetscMalloc2(n, &run.estimate, n_parameters, &run.scale));
  PetscCall(PointsScale(basis->pencil, n, points, run.scale));
  if (greedy->n_samples) PetscCall(PointNext(&run, &next));
  for (;;) {
    if (next < 0 && !greedy->looked) {
      PetscCall(PointsLook(&run));
      PetscCall(PointNext(&run, &next));
    }
    if (next < 0 || greedy->n_samples >= greedy->max_samples) break;
    if (greedy->n_samples)
      PetscCall(SampleCorrect(&run, &points[next * n_parameters], &greedy->last));
    else
      PetscCall(SampleKrylov(&run, points, NAN));
    greedy->looked = PETSC_FALSE;
    if (greedy->keep) PetscCall(greedy->keep(greedy->keep_ctx));
    PetscCall(PointNext(&run, &next));
  }
  PetscCall(GreedyWorkDestroy(&run));
  PetscCheck(next < 0, basis->comm, PETSC_ERR_NOT_CONVERGED,
             "-sweep_rtol %.6g was not reached with %" PetscInt_FMT
             " full solutions, the estimate at the last one was %.2g; raise -sweep_max_samples or narrow the range",
             (double)greedy->rtol, greedy->n_samples, (double)greedy->last);
  PetscFunctionReturn(0);
}

PetscErrorCode GreedyDestroy(Greedy *greedy)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < greedy->n_samples; i++) PetscCall(PetscFree(greedy->sample[i].p));
  PetscCall(PetscFree(greedy->sample));
  PetscFunctionReturn(0);
}
