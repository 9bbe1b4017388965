/*
   One full solution of the greedy choice (greedy.c): by the eigensolver, or by corrections, with factors and counts.
*/
#include "greedywork.h"

#define SETTLED 0.3 /* beside what is asked where corrections are made: a mode that needs no more at this point */
/* Corrections of one point at most. */
#define GREEDY_STEPS 8
#define SAMPLE_REACH 0.1 /* how much farther than the modes found lies the growth that corrections follow */

PetscErrorCode SampleAdd(GreedyWork *run, const PetscReal p[], PetscBool krylov, PetscInt n_vectors, PetscReal estimate)
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

/* The modes at the present point in a band, Hz, which is then again the one before */
static PetscErrorCode SampleModes(GreedyWork *run, const PetscReal wide[2])
{
  const Modes modes = run->greedy->modes;
  PetscReal   band[2], growth;

  PetscFunctionBeginUser;
  PetscCall(ModesGetBand(modes, band, &growth));
  PetscCall(ModesSetBand(modes, wide));
  PetscCall(ModesSolve(modes));
  PetscCall(ModesSetBand(modes, band));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleKrylov(GreedyWork *run, const PetscReal p[], PetscReal estimate)
{
  const PetscReal wide[2] = {run->guarded.low / (2 * PETSC_PI), run->guarded.high / (2 * PETSC_PI)};
  const Mode     *mode;
  PetscInt        n, n_vectors;
  BV              block;

  PetscFunctionBeginUser;
  PetscCall(PencilSetParameters(run->basis->pencil, p));
  PetscCall(SampleModes(run, wide));
  PetscCall(ModesGet(run->greedy->modes, &n, &mode));
  /* what lies beyond the growth asked for is followed by corrections like the others */
  for (PetscInt i = 0; i < n; i++)
    if (PetscAbsReal(mode[i].sigma) > run->greedy->window.growth)
      run->greedy->reach = PetscMax(run->greedy->reach, (1 + SAMPLE_REACH) * PetscAbsReal(mode[i].sigma));
  run->guarded.growth = PetscMax(run->guarded.growth, run->greedy->reach);
  PetscCall(BasisCreateModes(run->basis, run->greedy->modes, n, 4, &block));
  PetscCall(BasisAdd(run->basis, block, run->drop.length, &n_vectors));
  PetscCall(BVDestroy(&block));
  PetscCall(BasisUse(run->basis, run->basis->reduced.n));
  PetscCall(SampleAdd(run, p, PETSC_TRUE, n_vectors, estimate));
  PetscFunctionReturn(0);
}

/* The largest error of a mode in the window beside what was stated before; that of rank 0 on all */
static PetscErrorCode SurpriseTake(const GreedyWork *run, const ReducedModes *stated, const ReducedModes *modes,
                                   PetscReal *surprise)
{
  const ReducedWindow *w = &run->greedy->window;

  PetscFunctionBeginUser;
  *surprise = 0;
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal omega = cimag(modes->lambda[i]), least = PETSC_SMALL * cabs(modes->lambda[i]);

    if (!modes->rigid[i] && omega >= w->low && omega <= w->high)
      *surprise = PetscMax(*surprise, modes->error[i] / PetscMax(stated->error[i], least));
  }
  PetscCallMPI(MPI_Bcast(surprise, 1, MPIU_REAL, 0, run->basis->comm));
  PetscFunctionReturn(0);
}

/* One correction of what the basis gives at p: solve, drop what is settled, residuals, block solve, more vectors,
   estimate. worst = largest relative error before the new vectors are part of the model, which they tell: n_used
   does not change here. */
PetscErrorCode StepApply(GreedyWork *run, const PetscReal p[], ReducedModes *modes, PetscInt *n_added, PetscReal *worst)
{
  ReducedModes    before = *modes, stated = {0};
  CorrectionBlock block = {0};

  PetscFunctionBeginUser;
  PetscCall(ReducedSolve(&run->basis->reduced, p, &run->guarded, modes));
  PetscCall(ReducedModesBroadcast(run->basis->comm, 0, modes)); /* control flow must be alike on all ranks */
  PetscCall(CorrectionDropSettled(&before, SETTLED * run->greedy->safe * run->greedy->rtol, modes));
  PetscCall(ReducedModesDestroy(&before));
  if (run->surprise) {
    PetscCall(ReducedModesSelect(modes, modes->n, NULL, &stated));
    PetscCall(PointEstimate(&run->basis->reduced, p, &stated));
  }
  PetscCall(CorrectionCollect(run->correction, modes, run->sides, run->basis, &block));
  PetscCall(CorrectionApply(run->correction, run->drop, run->basis, &block, n_added));
  PetscCall(ReducedEstimate(&run->basis->reduced, p, modes));
  PetscCall(ReducedModesBroadcast(run->basis->comm, 0, modes));
  *worst = ReducedModesWorst(modes, &run->greedy->window, PETSC_FALSE);
  if (run->surprise) PetscCall(SurpriseTake(run, &stated, modes, run->surprise));
  PetscCall(ReducedModesDestroy(&stated));
  PetscFunctionReturn(0);
}

/* Whether the basis has as many frictionless modes at p as the full problem; both -1, and so equal, where that cannot
   be counted. The dense count is taken from rank 0, as an eigenvalue on the edge may fall either way by rounding. */
static PetscErrorCode SampleCount(GreedyWork *run, const PetscReal p[], PetscBool *complete)
{
  PetscInt full, by_basis;
  /* LDL' factors at the upper end are those of the count there; an LU would have to be made again after it */
  const PetscBool shared =
    run->is_near && run->correction->factor.even && run->greedy->window.low < 0.5 * run->greedy->window.high
      ? PETSC_TRUE
      : PETSC_FALSE;
  ShiftInvert *counter = shared ? &run->correction->factor : &run->counter;

  PetscFunctionBeginUser;
  PetscCall(CorrectionCount(run->basis, p, &run->greedy->window, counter, &full, &by_basis));
  PetscCallMPI(MPI_Bcast(&by_basis, 1, MPIU_INT, 0, run->basis->comm));
  *complete = full == by_basis ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode FactorMake(GreedyWork *run, const PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(CorrectionFactor(run->basis->pencil, p, &run->greedy->window, run->greedy->progress, run->correction));
  run->is_near = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* How many samples have exactly the values p: of those with factors made there, or of all. Values are copies of one
   another, so that equality is meant bit by bit. */
PetscInt PointTimes(const GreedyWork *run, const PetscReal p[], PetscBool factored)
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

/* Makes the factors of the last point that has any where there are none, as in a run that goes on */
static PetscErrorCode FactorRenew(GreedyWork *run)
{
  PetscInt last = run->greedy->n_samples - 1;

  PetscFunctionBeginUser;
  if (run->correction->has_factor) PetscFunctionReturn(0);
  while (last > 0 && !run->greedy->sample[last].factored) last--;
  PetscCall(FactorMake(run, run->greedy->sample[last].p));
  PetscFunctionReturn(0);
}

PetscErrorCode FactorKeep(GreedyWork *run, const PetscReal p[])
{
  PetscFunctionBeginUser;
  PetscCall(FactorRenew(run));
  PetscCall(CorrectionMove(run->basis->pencil, p, run->correction));
  run->is_near = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Factors for the first look at point p. LDL' factors of its own serve the count too; LU factors do not, and those of
   the point before may do */
static PetscErrorCode FactorFirst(GreedyWork *run, const PetscReal p[])
{
  PetscFunctionBeginUser;
  if (run->greedy->n_samples > 1) PetscCall(FactorRenew(run));
  if (run->greedy->n_samples > 1 && !run->correction->factor.even && !PointTimes(run, p, PETSC_FALSE))
    PetscCall(FactorKeep(run, p));
  else
    PetscCall(FactorMake(run, p));
  PetscFunctionReturn(0);
}

/* A full solution by corrections at p; first = the largest relative error that the basis had there before. A step
   is saved where the fall of earlier ones, fall = the largest error_after / error_before so far, already promises
   less than safe rtol. n_passed counts points in a row that needed nothing and had all modes; a missing mode calls
   the eigensolver and begins the count anew. */
PetscErrorCode SampleCorrect(GreedyWork *run, const PetscReal p[], PetscReal *first)
{
  const CorrectionDrop drop  = run->drop;
  const PetscReal      asked = run->greedy->safe * run->greedy->rtol;
  ReducedModes         modes = {0};
  PetscReal            worst;
  PetscInt             n_added, n_vectors = 0;
  PetscBool            complete = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (PointTimes(run, p, PETSC_TRUE)) /* what was left out is what errs */
    run->drop = (CorrectionDrop){PetscMin(drop.length, LOOK_DROP), LOOK_ENERGY * drop.energy};
  PetscCall(FactorFirst(run, p));
  PetscCall(StepApply(run, p, &modes, &n_added, first));
  worst = *first;
  if (worst > asked && !run->is_near) PetscCall(FactorMake(run, p));
  for (int step = 1; step < GREEDY_STEPS && worst > asked; step++) {
    const PetscReal before = worst, fall = run->greedy->fall;

    n_vectors += n_added;
    PetscCall(BasisUse(run->basis, run->basis->reduced.n));
    if (fall > 0 && fall * worst <= asked && run->greedy->reach <= run->greedy->window.growth)
      break; /* the vectors just taken in are enough, where no others are needed to tell what lies beyond the growth */
    PetscCall(StepApply(run, p, &modes, &n_added, &worst));
    run->greedy->fall = PetscMax(fall, worst / before);
  }
  PetscCall(ReducedModesDestroy(&modes));
  run->drop = drop;
  PetscCall(SampleCount(run, p, &complete));
  run->greedy->n_passed = *first <= asked && complete ? run->greedy->n_passed + 1 : 0;
  PetscCall(SampleAdd(run, p, PETSC_FALSE, n_vectors, *first));
  run->greedy->sample[run->greedy->n_samples - 1].factored = run->is_near;
  if (!complete && run->greedy->n_samples < run->greedy->max_samples) {
    *first = PETSC_MAX_REAL;
    PetscCall(SampleKrylov(run, p, *first));
  }
  PetscFunctionReturn(0);
}
