/* Cycle: options, the flow of a run, the table */
#include "cycleimpl.h"
#include <squeal/options.h>

#define CYCLE_BY     "-analysis cycle"
#define CYCLE_STABLE (1 + 1e-9) /* modulus of a multiplier, with rounding */

PetscErrorCode CycleCreate(MPI_Comm comm, LimitCycle *cycle)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(cycle));
  (*cycle)->comm       = comm;
  (*cycle)->rtol       = 1e-9;
  (*cycle)->max_it     = 30;
  (*cycle)->verify     = PETSC_TRUE;
  (*cycle)->max_points = 60;
  PetscFunctionReturn(0);
}

/* A branch has a parameter and a range */
static PetscErrorCode CycleCheckBranch(LimitCycle c, PetscBool has_range)
{
  PetscFunctionBeginUser;
  if (!c->parameter[0]) PetscFunctionReturn(0);
  PetscCheck(has_range, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_parameter %s needs -cycle_range: its least and largest value, e.g. 0.1,0.6", c->parameter);
  PetscCheck(c->range[0] >= 0 && c->range[1] > c->range[0] && c->range[1] < 1e30, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range %.6g,%.6g must be two values of a friction coefficient, the smaller one first",
             (double)c->range[0], (double)c->range[1]);
  PetscCheck(c->max_points >= 2, c->comm, PETSC_ERR_USER_INPUT, "-cycle_points %" PetscInt_FMT " must be 2 at least",
             c->max_points);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetFromOptions(LimitCycle c)
{
  PetscBool has_range;

  PetscFunctionBeginUser;
  PetscOptionsBegin(c->comm, NULL, "Limit cycles", "Cycle");
  PetscCall(PetscOptionsInt("-cycle_steps", "steps in a period, odd; 0: as long as those of the transient", "cycle.h",
                            c->steps, &c->steps, NULL));
  PetscCall(PetscOptionsReal("-cycle_rtol", "how far a period may end from where it began, over the vibration's size",
                             "cycle.h", c->rtol, &c->rtol, NULL));
  PetscCall(PetscOptionsInt("-cycle_max_it", "iterations of Newton's method", "cycle.h", c->max_it, &c->max_it, NULL));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-cycle_verify", "errors, by the cycle of twice the steps", &c->verify));
  PetscCall(PetscOptionsString("-cycle_parameter",
                               "friction coefficient over which cycles are followed, e.g. contact_mu", "cycle.h",
                               c->parameter, c->parameter, sizeof(c->parameter), NULL));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-cycle_range", "where it ends, least and largest value", 2, c->range,
                            &has_range));
  PetscCall(PetscOptionsInt("-cycle_points", "cycles on the branch, at most; half of them each way", "cycle.h",
                            c->max_points, &c->max_points, NULL));
  PetscOptionsEnd();
  PetscCheck(c->steps == 0 || (c->steps >= 7 && c->steps % 2), c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_steps %" PetscInt_FMT " must be an odd number, 7 at least, or 0 for those of the transient",
             c->steps);
  PetscCheck(c->rtol >= 1e-13 && c->rtol <= 1e-3, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_rtol %.6g must lie between 1e-13, which rounding allows, and 1e-3", (double)c->rtol);
  PetscCheck(c->max_it > 0, c->comm, PETSC_ERR_USER_INPUT, "-cycle_max_it %" PetscInt_FMT " must be positive",
             c->max_it);
  if (!c->parameter[0]) PetscCall(OptionsRefuse(c->comm, "-cycle_range", "not used without -cycle_parameter"));
  if (!c->parameter[0]) PetscCall(OptionsRefuse(c->comm, "-cycle_points", "not used without -cycle_parameter"));
  PetscCall(CycleCheckBranch(c, has_range));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetRooms(LimitCycle c, ReducedRun reduced, Contact contact)
{
  PetscFunctionBeginUser;
  c->reduced = reduced;
  c->contact = contact;
  PetscFunctionReturn(0);
}

/* The same cycle with twice the steps */
static PetscErrorCode CycleRefine(LimitCycle c, const ShootingCycle *at, CyclePoint *point)
{
  const PetscInt n = c->flow.n, steps = c->flow.n_steps;
  ShootingCycle  finer = *at;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &finer.x, n * n, &finer.M));
  PetscCall(PetscArraycpy(finer.x, at->x, n));
  PetscCall(CycleFlowSetSteps(&c->flow, 2 * steps + 1));
  PetscCall(ShootingSolve(&c->shooting, &finer));
  point->has_finer = finer.converged;
  if (finer.converged) CycleFlowMeasure(&c->flow, finer.period, &point->finer);
  if (finer.converged) PetscCall(ShootingGetStability(&c->shooting, &finer, &point->finer_stability));
  PetscCall(CycleFlowSetSteps(&c->flow, steps));
  PetscCall(PetscFree2(finer.x, finer.M));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleTake(LimitCycle c, const ShootingCycle *at)
{
  CyclePoint *point;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(c->n_points + 1) * sizeof(*c->point), &c->point));
  point  = &c->point[c->n_points++];
  *point = (CyclePoint){.value = at->value, .n_steps = c->flow.n_steps, .its = at->its, .residual = at->residual};
  CycleFlowMeasure(&c->flow, at->period, &point->found);
  PetscCall(ShootingGetStability(&c->shooting, at, &point->stability));
  if (c->verify) PetscCall(CycleRefine(c, at, point));
  PetscFunctionReturn(0);
}

/* A number and how far that of twice the steps is from it; nothing where there is none */
static PetscErrorCode CyclePrintError(const CyclePoint *p, PetscReal found, PetscReal finer, size_t size, char text[])
{
  PetscFunctionBeginUser;
  text[0] = 0;
  if (p->has_finer) PetscCall(PetscSNPrintf(text, size, "%.15g", (double)PetscAbsReal(found - finer)));
  PetscFunctionReturn(0);
}

/* Magnitude of the largest multiplier */
static PetscReal CycleMultiplier(const ShootingStability *stability)
{
  return hypot(stability->largest[0], stability->largest[1]);
}

static PetscErrorCode CycleWriteRow(LimitCycle c, PetscInt i, ResultsTable table)
{
  const CyclePoint   *p = &c->point[i];
  const CycleMeasure *a = &p->found, *b = &p->finer;
  const PetscReal    *large = p->stability.largest, *phase = p->stability.phase, size = CycleMultiplier(&p->stability);
  char                error[4][32], value[32] = "";

  PetscFunctionBeginUser;
  PetscCall(CyclePrintError(p, a->freq, b->freq, sizeof(error[0]), error[0]));
  PetscCall(CyclePrintError(p, a->rms, b->rms, sizeof(error[1]), error[1]));
  PetscCall(CyclePrintError(p, a->peak, b->peak, sizeof(error[2]), error[2]));
  PetscCall(CyclePrintError(p, size, CycleMultiplier(&p->finer_stability), sizeof(error[3]), error[3]));
  if (c->parameter[0]) PetscCall(PetscSNPrintf(value, sizeof(value), "%.15g", (double)p->value));
  PetscCall(ResultsTableRow(table,
                            "%" PetscInt_FMT ",%s,%s,%.15g,%s,%.15g,%.15g,%s,%.15g,%s,%.15g,%.15g,%s,%.15g,%.15g,%.15g,"
                            "%.15g,%d,%" PetscInt_FMT ",%.15g,%" PetscInt_FMT,
                            i + 1, c->parameter, value, (double)a->freq, error[0], (double)a->mean, (double)a->rms,
                            error[1], (double)a->peak, error[2], (double)a->open, (double)size, error[3],
                            (double)large[0], (double)large[1], (double)phase[0], (double)phase[1], size > CYCLE_STABLE,
                            p->n_steps, (double)p->residual, p->its));
  PetscFunctionReturn(0);
}

/* cycle.csv */
static PetscErrorCode CycleWrite(LimitCycle c, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(
    results, "cycle",
    "point,parameter,value,freq_hz,freq_error_hz,force_mean_n,force_rms_n,force_rms_error_n,force_peak_n,"
    "force_peak_error_n,open_share,multiplier_abs,multiplier_error,multiplier_re,multiplier_im,phase_multiplier_re,"
    "phase_multiplier_im,"
    "unstable,steps,residual,iterations",
    &table));
  for (PetscInt i = 0; i < c->n_points; i++) PetscCall(CycleWriteRow(c, i, table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The cycle at the end of the transient */
static PetscErrorCode CycleFind(LimitCycle c, ShootingCycle *at)
{
  PetscInt steps;

  PetscFunctionBeginUser;
  PetscCall(CycleGuess(c, at));
  steps              = c->steps ? c->steps : 2 * (PetscInt)PetscFloorReal(0.5 * at->period / c->reduced->dt) + 1;
  c->shooting.flow   = CycleFlowRun;
  c->shooting.ctx    = &c->flow;
  c->shooting.span   = c->flow.span;
  c->shooting.rtol   = c->rtol;
  c->shooting.max_it = c->max_it;
  PetscCall(CycleFlowSetSteps(&c->flow, steps));
  PetscCall(ShootingSolve(&c->shooting, at));
  PetscCheck(at->converged, c->comm, PETSC_ERR_NOT_CONVERGED,
             CYCLE_BY ": no cycle of %.6g Hz is found: after %" PetscInt_FMT " steps of Newton's method a period ends "
                      "%.1e of the vibration's size from where it began, must be %.0e; a longer -ts_max_time, more "
                      "-cycle_steps or a larger -cycle_max_it may help",
             1 / (double)at->period, at->its, (double)at->residual, (double)c->rtol);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSolve(LimitCycle c, Results results)
{
  PetscInt      n;
  ShootingCycle at = {.value = 0};
  PetscBool     asked;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(c->reduced, &asked));
  PetscCheck(asked, c->comm, PETSC_ERR_USER_INPUT, CYCLE_BY " needs -dynamics_model reduced");
  if (c->contact) PetscCall(CycleFindParameter(c));
  PetscCall(ReducedIntegrate(c->reduced, results));
  PetscCall(CycleFlowCreate(c->reduced, &c->flow));
  n = c->flow.n;
  PetscCall(PetscMalloc2(n, &at.x, n * n, &at.M));
  PetscCall(CycleSetParameter(c));
  at.value = c->value;
  PetscCall(CycleFind(c, &at));
  PetscCall(CycleTake(c, &at));
  if (c->parameter[0]) PetscCall(CycleFollow(c, &at));
  PetscCall(PetscFree2(at.x, at.M));
  PetscCall(CycleWrite(c, results));
  PetscFunctionReturn(0);
}

/* One cycle in words */
static PetscErrorCode CycleViewPoint(LimitCycle c, const CyclePoint *p, PetscViewer viewer)
{
  const CycleMeasure *a = &p->found, *b = &p->finer;
  const PetscReal    *large = p->stability.largest, *phase = p->stability.phase;
  const double        size = CycleMultiplier(&p->stability);

  PetscFunctionBeginUser;
  if (c->parameter[0]) PetscCall(PetscViewerASCIIPrintf(viewer, "%s %.6g: ", c->parameter, (double)p->value));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "cycle of %.9g Hz in %" PetscInt_FMT
                                   " steps: normal force %.6g N, rms %.6g N, %.6g to %.6g N, open %.4g of the time\n",
                                   (double)a->freq, p->n_steps, (double)a->mean, (double)a->rms, (double)a->least,
                                   (double)a->peak, (double)a->open));
  if (p->has_finer)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  with twice the steps: frequency off by %+.1e Hz, rms by %+.1e N, largest force by %+.1e N, multiplier by "
      "%+.1e\n",
      (double)(b->freq - a->freq), (double)(b->rms - a->rms), (double)(b->peak - a->peak),
      CycleMultiplier(&p->finer_stability) - size));
  else if (c->verify)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  none is found with twice the steps: its error is unknown\n"));
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "  %s: largest multiplier %.6g%+.6gi (%.6g), that of the phase 1%+.1e%+.1ei; residual %.1e after %" PetscInt_FMT
    " steps of Newton's method\n",
    size > CYCLE_STABLE ? "unstable" : "stable", (double)large[0], (double)large[1], size, (double)(phase[0] - 1),
    (double)phase[1], (double)p->residual, p->its));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleView(LimitCycle c, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedView(c->reduced, viewer));
  if (c->parameter[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " cycles over %s; the first: %s; the last: %s\n",
                                     c->n_points, c->parameter, c->end[0], c->end[1]));
  for (PetscInt i = 0; i < c->n_points; i++) PetscCall(CycleViewPoint(c, &c->point[i], viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleDestroy(LimitCycle *cycle)
{
  LimitCycle c = *cycle;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(CycleFlowDestroy(&c->flow));
  PetscCall(PetscFree2(c->shooting.size, c->shooting.weight));
  PetscCall(PetscFree(c->shooting.free));
  PetscCall(PetscFree(c->point));
  PetscCall(PetscFree(*cycle));
  PetscFunctionReturn(0);
}
