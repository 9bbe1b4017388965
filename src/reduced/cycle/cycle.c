/* Cycle: options, the flow of a run */
#include "cycleimpl.h"
#include "reduced/refuse.h"

PetscErrorCode CycleCreate(MPI_Comm comm, LimitCycle *cycle)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(cycle));
  (*cycle)->comm = comm;
  PetscCall(QuantitiesInit(&cycle_quantities, *cycle));
  PetscFunctionReturn(0);
}

/* A branch has a parameter and a range, and begins somewhere */
static PetscErrorCode CycleCheckBranch(LimitCycle c)
{
  PetscFunctionBeginUser;
  PetscCheck(c->parameter[0] || !c->from_mode, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_start mode needs -cycle_parameter: cycles begin where a mode becomes unstable over it");
  if (!c->parameter[0]) PetscFunctionReturn(0);
  PetscCheck(c->has_range, c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_parameter %s needs -cycle_range: its least and largest value, e.g. 0.1,0.6", c->parameter);
  PetscCheck(c->range[1] > c->range[0] && PetscAbsReal(c->range[0]) < 1e30 && PetscAbsReal(c->range[1]) < 1e30, c->comm,
             PETSC_ERR_USER_INPUT, "-cycle_range %.6g,%.6g must be two values of %s, the smaller one first",
             (double)c->range[0], (double)c->range[1], c->parameter);
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetFromOptions(LimitCycle c)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(c->comm, &cycle_quantities, c));
  PetscCheck(c->steps == 0 || (c->steps >= 7 && c->steps % 2), c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_steps %" PetscInt_FMT " must be an odd number, 7 or more, or 0 for those of the transient",
             c->steps);
  PetscCall(CycleCheckBranch(c));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFollowsTransient(LimitCycle c, PetscBool *follows)
{
  PetscFunctionBeginUser;
  *follows = c->from_mode ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode CycleVisit(LimitCycle c, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &cycle_quantities, NULL, c, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleSetRooms(LimitCycle c, ReducedRun reduced, Operators operators, const PetscReal p[])
{
  PetscFunctionBeginUser;
  c->reduced   = reduced;
  c->operators = operators;
  PetscCall(PetscFree(c->p));
  PetscCall(OperatorsCreatePoint(operators, p, &c->p));
  PetscFunctionReturn(0);
}

/* The parameter, before anything runs */
static PetscErrorCode CycleFindParameter(LimitCycle c)
{
  ReducedParameter *v = &c->varied;
  Model             model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(c->operators, &model, NULL));
  if (!c->parameter[0] || !model) PetscFunctionReturn(0);
  PetscCall(ReducedParameterFind(c->operators, c->p, "-cycle_parameter", "along which cycles can be followed",
                                 c->parameter, v));
  for (int i = 0; i < 2; i++) PetscCall(ReducedParameterCheck(c->operators, "-cycle_range", v, c->range[i]));
  if (v->kind == REDUCED_BODY) PetscCall(OperatorsCheckMoved(c->operators, "-cycle_parameter", 1, &v->index));
  PetscCheck(c->from_mode || (v->value >= c->range[0] && v->value <= c->range[1]), c->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range %.6g,%.6g must hold -%s %.6g, where the transient finds the first cycle",
             (double)c->range[0], (double)c->range[1], c->parameter, (double)v->value);
  PetscFunctionReturn(0);
}

/* least: the parameter may not reach what its law forbids, and the differences of the shooting stay above it.
   Models over a parameter of the bodies are made here; all others are moved in place. */
PetscErrorCode CycleSetParameter(LimitCycle c)
{
  PetscFunctionBeginUser;
  c->shooting.span = 1;
  if (!c->parameter[0]) PetscFunctionReturn(0);
  c->shooting.span  = c->range[1] - c->range[0];
  c->shooting.least = PETSC_SMALL * c->range[1];
  if (c->varied.kind == REDUCED_FRICTION && !c->varied.open)
    c->shooting.least = PetscMax(c->varied.least, -PETSC_MAX_REAL);
  c->flow.varied = &c->varied;
  c->flow.value  = c->varied.value;
  if (c->varied.kind != REDUCED_BODY) PetscFunctionReturn(0);
  PetscCall(CycleFamilyCreate(c->reduced, &c->varied, c->range, c->p, c->beside, &c->family));
  c->flow.family = c->family;
  c->flow.model  = &c->family->model;
  PetscFunctionReturn(0);
}

/* The number N of steps in a period is odd: what alternates from step to step with mean forces on a massless
   compliance cannot then close in a period. */
PetscErrorCode CycleSetShooting(LimitCycle c, PetscReal period)
{
  PetscFunctionBeginUser;
  c->flow.n_steps    = c->steps ? c->steps : 2 * (PetscInt)PetscFloorReal(0.5 * period / c->reduced->motion.dt) + 1;
  c->shooting.flow   = CycleFlowRun;
  c->shooting.ctx    = &c->flow;
  c->shooting.rtol   = c->rtol;
  c->shooting.max_it = c->max_it;
  PetscFunctionReturn(0);
}

/* A place in front of the cycles that are there, or behind them, so that the table has the order of the branch. */
static PetscErrorCode CycleAddPoint(LimitCycle c, CyclePoint **point)
{
  const PetscInt n = c->n_points++;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(n + 1) * sizeof(*c->point), &c->point));
  for (PetscInt i = n; i > 0 && c->in_front; i--) c->point[i] = c->point[i - 1];
  *point  = &c->point[c->in_front ? 0 : n];
  **point = (CyclePoint){.value_error = -1, .n_steps = c->flow.n_steps, .wants_higher = c->verify_cutoff};
  PetscCall(PetscCalloc3(c->flow.n_looked, &(*point)->probe, c->flow.n_looked, &(*point)->finer_probe, c->flow.n_looked,
                         &(*point)->spread_probe));
  PetscFunctionReturn(0);
}

/* A cycle, or with `along` a fold of which the parameter is known to `error` */
PetscErrorCode CycleTake(LimitCycle c, const ShootingCycle *at, const ShootingTangent *along, PetscReal error)
{
  CyclePoint *point;

  PetscFunctionBeginUser;
  PetscCall(CycleAddPoint(c, &point));
  point->value       = at->value;
  point->value_error = error;
  point->fold        = along ? PETSC_TRUE : PETSC_FALSE;
  point->its         = at->its;
  point->residual    = at->residual;
  PetscCall(CycleListen(c));
  PetscCall(CycleFlowMeasure(&c->flow, at, &point->found, point->probe));
  PetscCall(CycleHear(c, at->period, c->reduced->request.cutoff, &point->sound));
  PetscCall(ShootingGetStability(&c->shooting, at, &point->stability));
  if (c->verify) PetscCall(CycleRefine(c, at, along, point));
  if (c->higher) PetscCall(CycleHigherLook(c->higher, at, along, point));
  if (!point->has_finer || (point->wants_higher && !point->has_higher)) point->value_error = -1; /* a part is unknown */
  PetscCall(CycleWrite(c));
  PetscFunctionReturn(0);
}

/* Raises the error for a guess from which no cycle is found */
static PetscErrorCode CycleCheckFound(LimitCycle c, const ShootingCycle *at)
{
  char miss[160] = "the contact laws have no solution on the way through a period";

  PetscFunctionBeginUser;
  if (at->residual < PETSC_MAX_REAL)
    PetscCall(PetscSNPrintf(miss, sizeof(miss),
                            "a period ends %.1e of the vibration's size from where it began, must be %.0e",
                            (double)at->residual, (double)c->rtol));
  PetscCheck(at->converged, c->comm, PETSC_ERR_NOT_CONVERGED,
             CYCLE_BY
             ": no cycle of %.6g Hz is found: after %" PetscInt_FMT
             " steps of Newton's method %s; a longer -ts_max_time, more -cycle_steps or a larger -cycle_max_it "
             "may help",
             1 / (double)at->period, at->its, miss);
  PetscFunctionReturn(0);
}

/* The cycle at the end of the transient */
static PetscErrorCode CycleFind(LimitCycle c, ShootingCycle *at)
{
  PetscFunctionBeginUser;
  PetscCall(CycleGuess(c, at));
  PetscCall(CycleSetParameter(c));
  at->value = c->varied.value;
  PetscCall(CycleSetShooting(c, at->period));
  PetscCall(ShootingSolve(&c->shooting, at));
  PetscCall(CycleCheckFound(c, at));
  if (c->verify_cutoff) PetscCall(CycleHigherCreate(c, &c->higher));
  PetscCall(CycleTake(c, at, NULL, -1));
  c->rms = c->point[0].found.rms;
  if (c->parameter[0]) PetscCall(CycleFollow(c, at, NULL));
  PetscFunctionReturn(0);
}

/* c->rms is that of amplitude 1, by which steps and the end of the branch are measured. */
static PetscErrorCode CycleFindOnset(LimitCycle c, ShootingCycle *at)
{
  ShootingTangent growing;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->flow.n, &growing.x));
  PetscCall(CycleSetParameter(c));
  PetscCall(CycleBegin(c, at, &growing));
  if (c->verify_cutoff) PetscCall(CycleHigherCreate(c, &c->higher));
  PetscCall(CycleTake(c, at, NULL, -1));
  c->rms = c->point[0].found.rms / c->amplitude;
  PetscCall(CycleFollow(c, at, &growing));
  PetscCall(PetscFree(growing.x));
  PetscFunctionReturn(0);
}

/* Without a transient: the bodies, and a time after all ramps */
static PetscErrorCode CycleReduce(LimitCycle c, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(DynamicsSetEndless(c->reduced->dynamics));
  PetscCall(ReducedPrepare(c->reduced, results));
  PetscCall(ReducedRefuseVarying(c->reduced, "-analysis cycle"));
  PetscCall(ReducedChoose(c->reduced));
  PetscCall(ShiftInvertDestroy(&c->reduced->reduction.inverse));
  c->reduced->motion.state.time = CYCLE_FAR;
  PetscFunctionReturn(0);
}

/* Collective; the cycles themselves are found on every rank alike, without messages, from the same dense matrices. */
PetscErrorCode CycleSolve(LimitCycle c, Results results)
{
  PetscInt      n;
  ShootingCycle at = {.value = 0};
  PetscBool     asked;

  PetscFunctionBeginUser;
  PetscCall(ReducedIsAsked(c->reduced, &asked));
  PetscCheck(asked, c->comm, PETSC_ERR_USER_INPUT, CYCLE_BY " needs -dynamics_model reduced");
  c->results = results;
  PetscCall(CycleFindParameter(c));
  if (c->from_mode)
    PetscCall(CycleReduce(c, results));
  else
    PetscCall(ReducedIntegrate(c->reduced, results));
  PetscCall(CycleFlowCreate(c->reduced, &c->flow));
  n = c->flow.n;
  PetscCall(PetscCalloc2(n, &at.x, n * n, &at.M));
  if (c->from_mode)
    PetscCall(CycleFindOnset(c, &at));
  else
    PetscCall(CycleFind(c, &at));
  PetscCall(PetscFree2(at.x, at.M));
  PetscFunctionReturn(0);
}

static PetscErrorCode CyclePointDestroy(CyclePoint *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(p->probe, p->finer_probe, p->spread_probe));
  PetscCall(PetscFree(p->sound.row));
  PetscCall(PetscFree(p->finer_sound.row));
  PetscCall(PetscFree(p->higher_sound.row));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleDestroy(LimitCycle *cycle)
{
  LimitCycle c = *cycle;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(CycleHigherDestroy(&c->higher));
  PetscCall(CycleFlowDestroy(&c->flow));
  PetscCall(CycleFamilyDestroy(&c->family));
  PetscCall(PetscFree2(c->shooting.size, c->shooting.weight));
  PetscCall(PetscFree(c->shooting.free));
  for (PetscInt i = 0; i < c->n_points; i++) PetscCall(CyclePointDestroy(&c->point[i]));
  PetscCall(PetscFree(c->point));
  PetscCall(PetscFree(c->p));
  PetscCall(PetscFree(*cycle));
  PetscFunctionReturn(0);
}
