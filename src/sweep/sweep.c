/*
   Sweep: life cycle, options, and the flow: contact statuses -> basis -> points and branches -> checks -> onsets ->
   classes.
*/
#include "sweepimpl.h"
#include <petsctime.h>
#include <string.h>

/* Points that the greedy choice looks at: each of its estimates solves the dense problem of every one of them. */
#define MAX_TRAIN 100
/* Passes over all places. Each but the first begins by enlarging the basis where the one before found errors above
   rtol. */
#define MAX_ROUNDS 4

PetscErrorCode SweepCreate(MPI_Comm comm, Sweep *sweep)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, sweep));
  (*sweep)->comm = comm;
  PetscCall(QuantitiesInit(&sweep_quantities, *sweep));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepSetModes(Sweep sweep, Modes modes)
{
  PetscFunctionBeginUser;
  sweep->modes = modes;
  PetscFunctionReturn(0);
}

PetscErrorCode SweepSetOperators(Sweep sweep, Operators operators, const PetscReal p[])
{
  const OperatorsParameter *parameters;
  SweepGrid                *grid = &sweep->grid;

  PetscFunctionBeginUser;
  sweep->operators = operators;
  PetscCall(OperatorsGetParameters(operators, &grid->n_parameters, &parameters));
  PetscCall(PetscFree(grid->base));
  PetscCall(OperatorsCreatePoint(operators, p, &grid->base));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepSetStatics(Sweep sweep, Statics statics)
{
  PetscFunctionBeginUser;
  sweep->statics = statics;
  PetscFunctionReturn(0);
}

/* What does not go together */
static PetscErrorCode SweepCheckMethod(Sweep sweep)
{
  PetscFunctionBeginUser;
  PetscCheck(sweep->method != SWEEP_REAL || !sweep->onsets, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_onsets true: -sweep_method real follows no branches, and finds no onsets");
  PetscCheck(sweep->method == SWEEP_REDUCED || !sweep->sensitivities, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_sensitivities needs -sweep_method reduced");
  PetscCheck(sweep->method != SWEEP_FULL || !sweep->n_verify, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_verify compares with full solutions; -sweep_method full has nothing else");
  PetscFunctionReturn(0);
}

/* One group for each rank where none are asked for. Methods and options that exclude each other are refused here,
   before anything costs time. */
PetscErrorCode SweepSetFromOptions(Sweep sweep)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(sweep->comm, &sweep_quantities, sweep));
  if (!sweep->onsets_given) sweep->onsets = sweep->method != SWEEP_REAL ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SweepCheckMethod(sweep));
  PetscCallMPI(MPI_Comm_size(sweep->comm, &size));
  PetscCheck(sweep->n_groups <= size, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_groups %" PetscInt_FMT " must lie between 0 and the number of ranks, %d", sweep->n_groups,
             (int)size);
  sweep->groups.comm     = sweep->comm;
  sweep->groups.n_groups = sweep->n_groups ? sweep->n_groups : size;
  sweep->groups.store    = &sweep->store;
  PetscFunctionReturn(0);
}

PetscErrorCode SweepVisit(Sweep sweep, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &sweep_quantities, NULL, sweep, NULL));
  PetscFunctionReturn(0);
}

/* Whether the sweep varies damping is read from the names of its parameters: those of the operators contain one of
   these. */
PetscErrorCode SweepGetAsked(Sweep sweep, const char **parameter, PetscBool *real)
{
  PetscFunctionBeginUser;
  *real      = sweep->method == SWEEP_REAL ? PETSC_TRUE : PETSC_FALSE;
  *parameter = sweep->parameter;
  PetscFunctionReturn(0);
}

/* Enlarges the basis for some of the places: every k-th of a long sweep, or those whose error exceeds rtol */
static PetscErrorCode BasisMake(Sweep sweep, PetscBool exceeding)
{
  const SweepGrid *grid  = &sweep->grid;
  const PetscInt   n_all = grid->n_places, n_parameters = grid->n_parameters;
  const PetscInt   step = exceeding ? 1 : PetscMax(1, (n_all + MAX_TRAIN - 3) / (MAX_TRAIN - 1)); /* rounded up */
  PetscInt         n    = 0;
  PetscReal       *points;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((MAX_TRAIN + 2) * n_parameters, &points));
  for (PetscInt i = 0; i < n_all && n <= MAX_TRAIN; i += step)
    if (!exceeding || sweep->worst[i] > sweep->rtol) GridFill(grid, &grid->place[i], &points[n++ * n_parameters]);
  if (!exceeding && (n_all - 1) % step) GridFill(grid, &grid->place[n_all - 1], &points[n++ * n_parameters]);
  PetscCall(GreedyRun(&sweep->greedy, n, points, &sweep->basis));
  PetscCall(PetscFree(points));
  PetscFunctionReturn(0);
}

/* The reduced model: the basis is orthonormal in M of the first point; a small system takes all unit vectors, a
   larger one greedy samples. Room for samples is that of the sweep, max_samples, and of the points that are only
   looked at. With contact statuses max_samples is no less than the places, as in the worst case each has a status of
   its own. Where modes beyond the growth that was asked for were found (greedy.reach), window.rtol admits those whose
   estimated error, POINTS_MARGIN included, is below rtol. */
static PetscErrorCode ModelMake(Sweep sweep)
{
  PetscReal *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridPoint(&sweep->grid, 0, p);
  PetscCall(PencilSetParameters(sweep->pencil, p));
  PetscCall(BasisCreate(sweep->comm, sweep->pencil, &sweep->basis));
  sweep->basis.reduced.limit = sweep->limit;
  sweep->greedy.modes        = sweep->modes;
  sweep->greedy.window       = sweep->window;
  sweep->greedy.groups       = &sweep->groups;
  sweep->greedy.rtol         = sweep->rtol;
  sweep->greedy.safe         = GREEDY_SAFE;
  sweep->greedy.goal         = 1;
  sweep->greedy.option       = "-sweep_rtol";
  sweep->greedy.advice       = "raise -sweep_max_samples, narrow the range, or give -sweep_method full";
  if (!sweep->max_given && sweep->grid.n_groups)
    sweep->max_samples = PetscMax(sweep->max_samples, sweep->grid.n_places);
  sweep->greedy.max_samples = sweep->max_samples;
  sweep->greedy.progress    = &sweep->progress;
  PetscCall(PetscCalloc1(sweep->max_samples + 2 + PetscMax(GREEDY_LOOKS, sweep->grid.n_places), &sweep->greedy.sample));
  sweep->greedy.last = PETSC_MAX_REAL;
  PetscCall(BasisFillWhole(&sweep->basis, &sweep->whole));
  if (!sweep->whole && sweep->restart) PetscCall(SweepResume(sweep)); /* kept in the output folder as it grows */
  if (!sweep->whole) PetscCall(BasisMake(sweep, PETSC_FALSE));
  if (sweep->greedy.reach > sweep->window.growth) sweep->window.rtol = sweep->rtol / POINTS_MARGIN;
  if (sweep->whole) sweep->window.rtol = PETSC_MAX_REAL;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* All points; the basis grows again where one of them exceeds rtol, which only some were asked for. The largest
   error is alike on all ranks (PointsSolve()), so that all decide alike. */
static PetscErrorCode LinesSolve(Sweep sweep)
{
  PetscFunctionBeginUser;
  PetscCall(SweepLines(sweep));
  for (int round = 1; round < MAX_ROUNDS && !sweep->whole; round++) {
    if (SweepWorst(sweep) <= sweep->rtol) break;
    PetscCall(BasisMake(sweep, PETSC_TRUE));
    PetscCall(SweepLinesForget(sweep));
    PetscCall(SweepLines(sweep));
  }
  PetscCall(PointStoreDestroy(&sweep->store));
  sweep->groups.store = NULL;
  sweep->greedy.keep  = NULL;
  sweep->greedy.worst = SweepWorst(sweep);
  PetscCheck(sweep->whole || sweep->greedy.worst <= sweep->rtol, sweep->comm, PETSC_ERR_NOT_CONVERGED,
             "-sweep_rtol %.6g was not reached, the estimate is %.2g; raise -sweep_rtol", (double)sweep->rtol,
             (double)sweep->greedy.worst);
  PetscFunctionReturn(0);
}

/* Adds the time since *since to a phase */
static PetscErrorCode Clock(Sweep sweep, int phase, PetscLogDouble *since)
{
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  sweep->seconds[phase] += now - *since;
  *since = now;
  PetscFunctionReturn(0);
}

/* Basis, points and what is asked of them */
static PetscErrorCode ReducedSweep(Sweep sweep, PetscLogDouble *since)
{
  PetscFunctionBeginUser;
  if (sweep->method == SWEEP_REAL) {
    PetscCall(SweepReal(sweep));
  } else {
    PetscCall(ModelMake(sweep));
    PetscCall(Clock(sweep, 0, since));
    PetscCall(LinesSolve(sweep));
  }
  PetscCall(Clock(sweep, 1, since));
  PetscCall(SweepVerify(sweep));
  PetscCall(Clock(sweep, 3, since));
  if (sweep->onsets) PetscCall(SweepOnsets(sweep));
  PetscCall(Clock(sweep, 2, since));
  PetscCall(SweepClassify(sweep));
  PetscFunctionReturn(0);
}

/* The order matters: the axes before the statuses, which need the places; the statuses before the pencil, whose
   terms they divide; the pencil before the basis. Frequencies are Hz in the options and rad/s from here on. */
PetscErrorCode SweepSolve(Sweep sweep, Results results)
{
  PetscReal      band[2];
  PetscLogDouble since;

  PetscFunctionBeginUser;
  sweep->results = results;
  PetscCall(SweepChooseMethod(sweep));
  PetscCheck(sweep->method == SWEEP_FULL || !OperatorsHaveLaws(sweep->operators), sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_method %s: the stiffness of a part depends on the frequency, which only full solutions know; give "
             "-sweep_method full",
             sweep->method == SWEEP_REAL ? "real" : "reduced");
  PetscCall(ResultsGetDirectory(results, &sweep->folder));
  PetscCall(ModesGetBand(sweep->modes, band, &sweep->window.growth));
  PetscCall(ModesGetLimit(sweep->modes, &sweep->limit));
  sweep->window.low  = 2 * PETSC_PI * band[0];
  sweep->window.high = 2 * PETSC_PI * band[1];
  PetscCall(SweepAxes(sweep));
  PetscCall(SweepCheckPlaces(sweep));
  PetscCall(PetscCalloc1(GridSize(&sweep->grid), &sweep->point));
  PetscCall(PetscTime(&since));
  PetscCall(SweepStatuses(sweep));
  PetscCall(Clock(sweep, 4, &since));
  PetscCall(ModesSetPencil(sweep->modes, sweep->pencil));
  if (sweep->method == SWEEP_FULL) {
    PetscCall(SweepBrute(sweep));
    PetscCall(Clock(sweep, 1, &since));
    PetscFunctionReturn(0);
  }
  PetscCall(ReducedSweep(sweep, &since)); /* each point has its own status among the parameters */
  PetscFunctionReturn(0);
}

PetscErrorCode SweepDestroy(Sweep *sweep)
{
  Sweep s = *sweep;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt i = 0; s->point && i < GridSize(&s->grid); i++) PetscCall(PetscFree(s->point[i].mode));
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->check));
  PetscCall(PetscFree(s->label));
  PetscCall(PetscFree(s->worst));
  PetscCall(PetscFree(s->is_confirmed));
  PetscCall(ChecksumDestroy(&s->journal.scene));
  PetscCall(JournalPackDestroy(&s->places));
  PetscCall(BranchEventsDestroy(&s->events));
  PetscCall(PointStoreDestroy(&s->store));
  PetscCall(GreedyDestroy(&s->greedy));
  PetscCall(BasisDestroy(&s->basis));
  PetscCall(PencilDestroy(&s->pencil));
  PetscCall(GridDestroy(&s->grid));
  PetscCall(StatusListDestroy(&s->statuses));
  PetscCall(PetscFree(*sweep));
  PetscFunctionReturn(0);
}
