/* Cycle: options, the flow of a run, the table */
#include "cycleimpl.h"
#include <squeal/options.h>

#define CYCLE_BY "-analysis cycle"

PetscErrorCode CycleCreate(MPI_Comm comm, LimitCycle *cycle)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(cycle));
  (*cycle)->comm   = comm;
  (*cycle)->rtol   = 1e-9;
  (*cycle)->max_it = 30;
  (*cycle)->verify = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetFromOptions(LimitCycle c)
{
  PetscFunctionBeginUser;
  PetscOptionsBegin(c->comm, NULL, "Limit cycles", "Cycle");
  PetscCall(PetscOptionsInt("-cycle_steps", "steps in a period; 0: as long as those of the transient", "cycle.h",
                            c->steps, &c->steps, NULL));
  PetscCall(PetscOptionsReal("-cycle_rtol", "how far a period may end from where it began, over the vibration's size",
                             "cycle.h", c->rtol, &c->rtol, NULL));
  PetscCall(PetscOptionsInt("-cycle_max_it", "iterations of Newton's method", "cycle.h", c->max_it, &c->max_it, NULL));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-cycle_verify", "errors, by the cycle of twice the steps", &c->verify));
  PetscOptionsEnd();
  PetscCheck(c->steps == 0 || c->steps >= 6, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_steps %" PetscInt_FMT " must be 6 at least, or 0 for those of the transient", c->steps);
  PetscCheck(c->rtol > 0 && c->rtol < 1, c->comm, PETSC_ERR_USER_INPUT, "-cycle_rtol %.6g must be between 0 and 1",
             (double)c->rtol);
  PetscCheck(c->max_it > 0, c->comm, PETSC_ERR_USER_INPUT, "-cycle_max_it %" PetscInt_FMT " must be positive",
             c->max_it);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetReduced(LimitCycle c, ReducedRun reduced)
{
  PetscFunctionBeginUser;
  c->reduced = reduced;
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
  PetscCall(CycleFlowSetSteps(&c->flow, 2 * steps));
  PetscCall(ShootingSolve(&c->shooting, &finer));
  point->has_finer = finer.converged;
  if (finer.converged) CycleFlowMeasure(&c->flow, finer.period, &point->finer);
  PetscCall(CycleFlowSetSteps(&c->flow, steps));
  PetscCall(PetscFree2(finer.x, finer.M));
  PetscFunctionReturn(0);
}

/* The cycle in numbers, with its stability and error */
static PetscErrorCode CycleTake(LimitCycle c, const ShootingCycle *at)
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

/* Rows of cycle.csv; errors are empty where there is no finer cycle */
static PetscErrorCode CycleWrite(LimitCycle c, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(
    results, "cycle",
    "point,value,freq_hz,freq_error_hz,force_mean_n,force_rms_n,force_rms_error_n,force_peak_n,force_peak_error_n,"
    "open_share,multiplier_abs,multiplier_re,multiplier_im,phase_multiplier_re,phase_multiplier_im,unstable,steps,"
    "residual,iterations",
    &table));
  for (PetscInt i = 0; i < c->n_points; i++) {
    const CyclePoint   *p = &c->point[i];
    const CycleMeasure *a = &p->found, *b = &p->finer;
    const PetscReal    *large = p->stability.largest, *phase = p->stability.phase, size = hypot(large[0], large[1]);
    const PetscReal     none = NAN;

    PetscCall(ResultsTableNumbers(
      table, 19,
      (PetscReal[]){(PetscReal)i + 1, p->value, a->freq, p->has_finer ? PetscAbsReal(a->freq - b->freq) : none, a->mean,
                    a->rms, p->has_finer ? PetscAbsReal(a->rms - b->rms) : none, a->peak,
                    p->has_finer ? PetscAbsReal(a->peak - b->peak) : none, a->open, size, large[0], large[1], phase[0],
                    phase[1], size > 1, (PetscReal)p->n_steps, p->residual, (PetscReal)p->its}));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The cycle at the end of the transient */
static PetscErrorCode CycleFind(LimitCycle c, ShootingCycle *at)
{
  PetscInt steps;

  PetscFunctionBeginUser;
  PetscCall(CycleGuess(c, at));
  steps              = c->steps ? c->steps : (PetscInt)PetscFloorReal(at->period / c->reduced->dt + 0.5);
  c->shooting.flow   = CycleFlowRun;
  c->shooting.ctx    = &c->flow;
  c->shooting.span   = c->flow.span;
  c->shooting.rtol   = c->rtol;
  c->shooting.max_it = c->max_it;
  PetscCall(CycleFlowSetSteps(&c->flow, steps));
  PetscCall(ShootingSolve(&c->shooting, at));
  PetscCheck(at->converged, c->comm, PETSC_ERR_NOT_CONVERGED,
             CYCLE_BY ": no cycle of %.6g Hz is found: after %" PetscInt_FMT " steps of Newton's method a period ends "
                      "%.1e of the vibration's size from where it began, must be %.0e; a longer -ts_max_time or more "
                      "-cycle_steps may help",
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
  PetscCall(ReducedIntegrate(c->reduced, results));
  PetscCall(CycleFlowCreate(c->reduced, &c->flow));
  n = c->flow.n;
  PetscCall(PetscMalloc2(n, &at.x, n * n, &at.M));
  PetscCall(CycleFind(c, &at));
  PetscCall(CycleTake(c, &at));
  PetscCall(PetscFree2(at.x, at.M));
  PetscCall(CycleWrite(c, results));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleView(LimitCycle c, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedView(c->reduced, viewer));
  for (PetscInt i = 0; i < c->n_points; i++) {
    const CyclePoint   *p = &c->point[i];
    const CycleMeasure *a = &p->found, *b = &p->finer;
    const PetscReal    *large = p->stability.largest, *phase = p->stability.phase;

    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "cycle of %.9g Hz (+- %.1e) in %" PetscInt_FMT " steps: normal force %.6g N, rms %.6g N (+- %.1e), %.6g to %.6g "
      "N, open %.4g of the time\n  %s: largest multiplier %.6g%+.6gi (%.6g), that of the phase 1%+.1e%+.1ei; residual "
      "%.1e after %" PetscInt_FMT " steps of Newton's method\n",
      (double)a->freq, p->has_finer ? (double)PetscAbsReal(a->freq - b->freq) : NAN, p->n_steps, (double)a->mean,
      (double)a->rms, p->has_finer ? (double)PetscAbsReal(a->rms - b->rms) : NAN, (double)a->least, (double)a->peak,
      (double)a->open, hypot(large[0], large[1]) > 1 ? "unstable" : "stable", (double)large[0], (double)large[1],
      hypot(large[0], large[1]), (double)(phase[0] - 1), (double)phase[1], (double)p->residual, p->its));
  }
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
