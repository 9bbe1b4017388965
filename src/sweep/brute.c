/*
   Full solutions: a sweep by brute force, one eigenvalue problem of the mesh per point, and the check of reduced
   results at points that the basis has never seen, half way between those of the sweep.
*/
#include "sweepimpl.h"

/* Modes at point i, about the sliding state there where statics tell it */
static PetscErrorCode PointSolve(Sweep sweep, PetscInt i, const PetscReal p[])
{
  SlidingState state;
  Pencil       pencil;

  PetscFunctionBeginUser;
  if (!sweep->statics) {
    PetscCall(PencilSetParameters(sweep->pencil, p));
    PetscCall(SweepNameParities(sweep, sweep->pencil));
    PetscCall(ModesSolveParities(sweep->modes));
    PetscFunctionReturn(0);
  }
  PetscCall(StaticsSolveSliding(sweep->statics, p, &state));
  PetscCall(StaticsRelease(sweep->statics));
  PetscCall(SweepStatusTake(sweep, &state, &sweep->grid.place[i].status));
  PetscCall(OperatorsLinearise(sweep->operators, &state, &pencil));
  PetscCall(SlidingStateDestroy(&state));
  PetscCall(ModesSetPencil(sweep->modes, pencil));
  PetscCall(SweepNameParities(sweep, pencil));
  PetscCall(ModesSolveParities(sweep->modes));
  PetscCall(ModesSetPencil(sweep->modes, NULL));
  PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepBrute(Sweep sweep)
{
  const PetscInt n_points = GridSize(&sweep->grid);
  PetscReal     *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  for (PetscInt i = 0; i < n_points; i++) {
    SweepPoint *point = &sweep->point[i];
    const Mode *mode;

    GridPoint(&sweep->grid, i, p);
    PetscCall(PointSolve(sweep, i, p));
    PetscCall(ModesGet(sweep->modes, &point->n, &mode));
    PetscCall(PetscCalloc1(point->n, &point->mode));
    for (PetscInt k = 0; k < point->n; k++) {
      SweepMode  *m = &point->mode[k];
      const char *parity;

      PetscCall(ModesGetParity(sweep->modes, k, &parity));
      m->parity    = parity ? SweepFindParity(sweep, parity) : 0;
      m->sigma     = mode[k].sigma;
      m->omega     = mode[k].omega;
      m->error     = mode[k].error;
      m->condition = mode[k].condition;
      m->unstable  = ReducedIsUnstable(CMPLX(m->sigma, m->omega), PetscIsInfOrNanReal(m->error) ? 0 : m->error);
      m->branch    = -1;
      PetscCall(PetscStrncpy(m->label, mode[k].label, sizeof(m->label)));
    }
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Largest distance of a full eigenvalue from the nearest reduced one, relative, and the frequency where it is */
static PetscReal LargestDistance(PetscInt n, const Mode full[], const ReducedModes *reduced, PetscReal *omega)
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda  = CMPLX(full[i].sigma, full[i].omega);
    PetscReal          nearest = PETSC_MAX_REAL;

    if (full[i].rigid) continue;
    for (PetscInt k = 0; k < reduced->n; k++) nearest = PetscMin(nearest, cabs(reduced->lambda[k] - lambda));
    if (nearest <= largest * cabs(lambda)) continue;
    largest = nearest / cabs(lambda);
    *omega  = full[i].omega;
  }
  return largest;
}

/* True errors beside the sum of what the two solutions state */
static void CheckRatios(PetscInt n, const Mode full[], const ReducedModes *reduced, SweepCheck *check)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscComplex lambda  = CMPLX(full[i].sigma, full[i].omega);
    PetscReal          nearest = PETSC_MAX_REAL, stated = 1, ratio;

    if (full[i].rigid || !reduced->n) continue;
    for (PetscInt k = 0; k < reduced->n; k++) {
      const PetscReal distance = cabs(reduced->lambda[k] - lambda);

      if (distance < nearest) nearest = distance, stated = reduced->error[k] + full[i].error;
    }
    ratio = nearest / stated;
    if (!(ratio <= 1)) check->n_beyond++;
    if (!(ratio <= check->ratio)) check->ratio = ratio;
  }
}

/* Compares the two at the point of the check; the reduced window is a little wider, for modes on its edge */
static PetscErrorCode CheckPoint(Sweep sweep, SweepCheck *check)
{
  const ReducedWindow wide = {sweep->window.low * (1 - 1e-3), sweep->window.high * (1 + 1e-3), sweep->window.growth};
  const Mode         *full;
  ReducedModes        reduced;
  PetscReal          *p;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sweep->grid.n_parameters, &p));
  GridFill(&sweep->grid, &check->at, p);
  PetscCall(PointsSolve(&sweep->groups, &sweep->basis.reduced, &wide, 1, p, &reduced));
  PetscCall(PencilSetParameters(sweep->pencil, p));
  PetscCall(PetscFree(p));
  if (sweep->parity < 0)
    PetscCall(ModesSolve(sweep->modes));
  else
    PetscCall(ModesSolveAny(sweep->modes, &check->n_full));
  PetscCall(ModesGet(sweep->modes, &check->n_full, &full));
  for (PetscInt i = 0; i < check->n_full; i++)
    check->n_unstable_full += ReducedIsUnstable(CMPLX(full[i].sigma, full[i].omega), full[i].error);
  for (PetscInt k = 0; k < reduced.n; k++) {
    const PetscReal omega = cimag(reduced.lambda[k]);

    if (omega < sweep->window.low || omega > sweep->window.high) continue;
    check->n_reduced++;
    check->n_unstable_reduced += ReducedIsUnstable(reduced.lambda[k], reduced.error[k]);
  }
  CheckRatios(check->n_full, full, &reduced, check);
  check->error    = LargestDistance(check->n_full, full, &reduced, &check->omega);
  check->estimate = sweep->method == SWEEP_REAL ? NAN : ReducedModesWorst(&reduced, &sweep->window, PETSC_TRUE);
  for (PetscInt i = 0; i < check->n_full; i++)
    if (!full[i].rigid) check->full = PetscMax(check->full, full[i].error / hypot(full[i].sigma, full[i].omega));
  PetscCall(ReducedModesDestroy(&reduced));
  PetscFunctionReturn(0);
}

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
