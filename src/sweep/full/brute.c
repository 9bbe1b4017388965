/*
   Full solutions: a sweep by brute force, one eigenvalue problem of the mesh per point, and the check of reduced
   results at points that the basis has never seen, half way between those of the sweep.
*/
#include "follow.h"
#include "compare.h"

/* The modes that were found at place i of the line */
static PetscErrorCode PointTake(Sweep sweep, PetscInt i, LinePoints *points)
{
  ReducedModes *found = &points->modes[i];
  const Mode   *mode;
  PetscInt      n;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(sweep->modes, &n, &mode));
  PetscCall(ReducedModesCreate(n, 0, found));
  PetscCall(PetscMalloc1(n, &points->branch[i]));
  PetscCall(PetscCalloc1(n, &points->name[i]));
  for (PetscInt k = 0; k < n; k++) {
    found->lambda[k]     = CMPLX(mode[k].sigma, mode[k].omega);
    found->product[k]    = CMPLX(mode[k].product[0], mode[k].product[1]);
    found->error[k]      = mode[k].error;
    found->rigid[k]      = mode[k].rigid;
    points->branch[i][k] = -1;
    PetscCall(PetscStrncpy(points->name[i][k].text, mode[k].label, sizeof(points->name[i][k].text)));
  }
  PetscFunctionReturn(0);
}

/* Branches need left vectors: without them the modes of each point stand alone, with branch -1. */
static PetscErrorCode PencilSolve(Sweep sweep, Pencil pencil, PetscInt i, LinePoints *points, Follow *follow)
{
  PetscBool nearest, left, terms;

  PetscFunctionBeginUser;
  PetscCall(ModesSetPencil(sweep->modes, pencil));
  PetscCall(ModesPrepareComponents(sweep->modes, &terms));
  PetscCall(ModesSolve(sweep->modes));
  PetscCall(ModesFindComponents(sweep->modes));
  PetscCall(PointTake(sweep, i, points));
  PetscCall(ModesWant(sweep->modes, &nearest, &left));
  if (left) PetscCall(FollowTake(sweep, pencil, i, points, follow));
  PetscFunctionReturn(0);
}

/* The pencil about a sliding state belongs to its point alone, and is freed with it; statics let go of their
   factors before the eigensolver makes its own. */
static PetscErrorCode PointSolve(Sweep sweep, PetscInt i, LinePoints *points, Follow *follow)
{
  const PetscReal *p = &points->p[i * sweep->grid.n_parameters];
  SlidingState     state;
  Pencil           pencil;

  PetscFunctionBeginUser;
  if (!sweep->statics) {
    PetscCall(PencilSetParameters(sweep->pencil, p));
    PetscCall(PencilSolve(sweep, sweep->pencil, i, points, follow));
    PetscFunctionReturn(0);
  }
  PetscCall(StaticsSolveSliding(sweep->statics, p, &state));
  PetscCall(StaticsRelease(sweep->statics));
  PetscCall(SweepStatusTake(sweep, &state, &sweep->grid.place[points->first + i].status));
  PetscCall(OperatorsLinearise(sweep->operators, &state, &pencil));
  PetscCall(SlidingStateDestroy(&state));
  PetscCall(PencilSolve(sweep, pencil, i, points, follow));
  PetscCall(ModesSetPencil(sweep->modes, NULL));
  PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

/* Points in order, each collective; those that an earlier run kept are taken up without a solution. */
PetscErrorCode SweepBrute(Sweep sweep)
{
  LinePoints points;
  Follow     follow = {0};
  PetscBool  taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(sweep->grid.n_places, &sweep->worst));
  PetscCall(SweepResumePlaces(sweep, &follow));
  for (PetscInt line = 0; line < GridLines(&sweep->grid); line++) {
    const PetscInt n_before = sweep->n_branches, first_event = sweep->events.n;

    PetscCall(LineCreate(sweep, line, &points));
    PetscCall(PetscCalloc1(points.n, &points.name));
    for (PetscInt i = 0; i < points.n; i++) {
      PetscCall(SweepTakePlace(sweep, i, &points, &taken));
      if (taken) continue;
      PetscCall(PointSolve(sweep, i, &points, &follow));
      PetscCall(SweepKeepPlace(sweep, i, &points, &follow));
    }
    PetscCall(LineFinish(sweep, n_before, first_event, &points));
    PetscCall(LineDestroy(&points));
  }
  PetscCall(FollowDestroy(&follow));
  if (sweep->onsets && sweep->n_branches) {
    PetscCall(PetscCalloc1(PetscMax(1, sweep->events.n), &sweep->is_confirmed));
    SweepSortOnsets(sweep);
  }
  PetscCall(SweepClassify(sweep));
  PetscFunctionReturn(0);
}

/* Compares the two at the point of the check, by what both must have: growth and decay as asked for, |sigma|; the
   reduced window is a little wider, for modes on its edge */
static PetscErrorCode CheckPoint(Sweep sweep, SweepCheck *check)
{
  const PetscReal     growth = sweep->window.growth;
  const ReducedWindow wide = {sweep->window.low * (1 - 1e-3), sweep->window.high * (1 + 1e-3), growth * (1 + 1e-3), 0};
  const Mode         *full;
  ReducedModes        reduced;
  PetscReal          *p;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridFill(&sweep->grid, &check->at, p);
  if (sweep->method == SWEEP_REAL)
    PetscCall(SweepRealSolve(sweep, p, &wide, &reduced));
  else
    PetscCall(PointsSolve(&sweep->groups, &sweep->basis.reduced, &wide, 1, p, &reduced));
  PetscCall(PencilSetParameters(sweep->pencil, p));
  PetscCall(PetscFree(p));
  PetscCall(ModesSolve(sweep->modes));
  PetscCall(ModesGet(sweep->modes, &n, &full));
  FullCompare(&sweep->window, &sweep->limit, n, full, &reduced, &check->found);
  check->found.estimate = sweep->method == SWEEP_REAL ? NAN : ReducedModesWorst(&reduced, &sweep->window, PETSC_TRUE);
  PetscCall(ReducedModesDestroy(&reduced));
  PetscFunctionReturn(0);
}

/* Check i lies in the middle of gap (2 i + 1) gaps / (2 n_checks) of the first axis, so that checks are spread
   evenly and two of them never share a gap; along a second axis gaps are taken in another order, (7 j + 3) mod
   gaps, off the diagonal of the grid. */
PetscErrorCode SweepCheckPlaces(Sweep sweep)
{
  const SweepGrid *grid = &sweep->grid;

  PetscFunctionBeginUser;
  sweep->n_checks = PetscMin(sweep->n_verify, grid->n[0] - 1); /* no value twice */
  PetscCall(PetscCalloc1(sweep->n_checks, &sweep->check));
  for (PetscInt i = 0; i < sweep->n_checks; i++) {
    SweepPlace *at = &sweep->check[i].at;

    at->point = -1;
    for (PetscInt k = 0; k < grid->n_axes; k++) {
      const PetscReal *value = grid->value[k];
      const PetscInt   gaps = grid->n[k] - 1, step = gaps ? ((2 * i + 1) * gaps) / (2 * sweep->n_checks) : 0;
      const PetscInt   j = k && gaps ? (step * 7 + 3) % gaps : step;

      at->value[k] = gaps ? GridMiddle(grid, k, value[j], value[j + 1]) : value[0];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweepVerify(Sweep sweep)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < sweep->n_checks; i++) PetscCall(CheckPoint(sweep, &sweep->check[i]));
  PetscFunctionReturn(0);
}
