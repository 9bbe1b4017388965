/*
   The flow of the reduced model through a period: N steps of length T / N from the state x = (eta, rate, lambda,
   q), in m sqrt(kg), m sqrt(kg)/s, N and N, 2 m + 3 n_pairs (+ 3 n_pairs with damping) numbers, and its derivative
   M, the product of those of the steps (step/tangent.c). With a family eta and rate of x are those of the scene's
   modes. A step whose contact laws have no solution ends the period: Phi is then infinite, which no cycle comes
   from: INFINITY, not the large number PETSC_INFINITY, two of which have no difference.
*/
#include "cycleimpl.h"

#define FLOW_ROUNDING 1e-6 /* of friction */

/* Raises the error for friction that goes on to change; the model has that of the last step */
static PetscErrorCode FlowCheckFriction(ReducedRun r, const char when[], const char what[])
{
  const PetscReal now = r->motion.state.time;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->run.n_interfaces; i++) {
    PetscReal factor[2];
    PetscBool varies;

    PetscCall(ContactProjectorGetFriction(r->run.projector, i, now, &factor[0], &varies));
    PetscCall(ContactProjectorGetFriction(r->run.projector, i, now + CYCLE_FAR, &factor[1], &varies));
    PetscCheck(factor[0] == factor[1], r->comm, PETSC_ERR_USER_INPUT,
               CYCLE_BY ": the friction of %s still changes %s %.6g s: %s", r->run.interfaces[i].name, when,
               (double)now, what);
  }
  PetscFunctionReturn(0);
}

/* Loads and sliding from the time of the run on; raises the error where they go on to change: the flow must be
   autonomous. share = way of the run in a step over speed times dt, so that the way follows the speed and the step. */
static PetscErrorCode FlowSetDrive(ReducedRun r, CycleFlow *f)
{
  const PetscReal   now = r->motion.state.time;
  const ModelScene *scene;
  PetscReal        *later, way[2];
  const char *const when = now < CYCLE_FAR ? "when the transient ends at" : "after all ramps, at";
  const char *const what = now < CYCLE_FAR ? "take a longer -ts_max_time, or a shorter ramp" : "take what is constant";

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(r->run.model, &scene));
  PetscCall(PetscCalloc1(r->reduction.model.n_loads, &later));
  ReducedSetLoads(r, now, f->loads);
  ReducedSetLoads(r, now + CYCLE_FAR, later);
  for (PetscInt i = 0; i < r->reduction.model.n_loads; i++)
    PetscCheck(f->loads[i] == later[i], r->comm, PETSC_ERR_USER_INPUT, CYCLE_BY ": load %s still changes %s %.6g s: %s",
               scene->loads[i].name, when, (double)now, what);
  PetscCall(PetscFree(later));
  PetscCall(FlowCheckFriction(r, when, what));
  for (PetscInt i = 0; i < r->reduction.model.n_pairs; i++) {
    PetscCall(ReducedGetWay(r, i, &way[0]));
    r->motion.state.time = now + CYCLE_FAR;
    PetscCall(ReducedGetWay(r, i, &way[1]));
    r->motion.state.time = now;
    PetscCheck(PetscAbsReal(way[1] - way[0]) <= 1e-6 * PetscAbsReal(way[1]), r->comm, PETSC_ERR_USER_INPUT,
               CYCLE_BY ": the sliding still changes %s %.6g s: %s", when, (double)now, what);
    f->share[i] = f->stated[i].speed != 0 ? way[0] / (f->stated[i].speed * r->motion.dt) : 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowCreate(ReducedRun r, CycleFlow *f)
{
  const PetscInt n = r->reduction.model.n_pairs;

  PetscFunctionBeginUser;
  *f          = (CycleFlow){.model = &r->reduction.model, .n = ReducedTangentSize(&r->reduction.model)};
  f->first    = 3 * n + r->reduction.model.n_loads;
  f->n_looked = r->reduction.model.n_ports - f->first;
  PetscCall(
    PetscCalloc5(r->reduction.model.n_loads, &f->loads, n, &f->share, n, &f->way, n, &f->stated, n, &f->interface));
  PetscCall(PetscArraycpy(f->stated, r->reduction.model.friction, n));
  for (PetscInt i = 0; i < n; i++) f->interface[i] = r->reduction.pair[i].interface;
  PetscCall(ReducedStateCreate(f->model, &f->state));
  PetscCall(ReducedReportCreate(f->model, &f->report));
  f->report.works = PETSC_FALSE;
  PetscCall(FlowSetDrive(r, f));
  PetscFunctionReturn(0);
}

/* x of a state, eta and rate in the coordinates of the scene's modes where a family has others; y and last are not
   in x. */
PetscErrorCode CycleFlowPack(const CycleFlow *f, const ReducedState *s, PetscReal x[])
{
  const PetscInt m = f->model->m, n = 3 * f->model->n_pairs;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m; i++) {
    x[i]     = s->eta[i];
    x[m + i] = s->rate[i];
  }
  for (PetscInt i = 0; i < n; i++) {
    x[2 * m + i] = s->begin[i];
    if (f->model->Cx) x[2 * m + n + i] = s->q[i];
  }
  if (f->family) PetscCall(CycleFamilyTurn(f->family, PETSC_TRUE, 2, m, x));
  PetscFunctionReturn(0);
}

/* Whether a pair of forces p rests: within the cone of mu(0), and not with the friction of its slip speed s, m/s.
   One that slides has |p_T| = mu(s_m) p_n with s_m the mean of its step, near s; one that sticks has s = 0 but for what
   the residual, which has no rates, lets it creep. So the limit between them is mu(2 s), less rounding where mu is
   level there. Slip is along -p_T. */
static PetscBool PairRests(const FrictionLaw *law, const PetscReal p[3], const PetscReal v[2])
{
  const PetscReal   size = hypot(p[1], p[2]), s = size > 0 ? -(p[1] * v[0] + p[2] * v[1]) / size : 0;
  const FrictionLaw here = FrictionPressed(law, p[0]);

  if (!(p[0] > 0) || size > FrictionMu(&here, 0) * p[0]) return PETSC_FALSE;
  return size < (1 - FLOW_ROUNDING) * FrictionMu(&here, 2 * PetscMax(0, s)) * p[0] ? PETSC_TRUE : PETSC_FALSE;
}

/* Statuses of the pairs by x alone. Those of the period before, of another x, would make Phi no function of x where
   friction varies: pairs that stick go on resting (compliance/step.c). Call after FlowPrepare(). */
static void FlowSetStatuses(CycleFlow *f)
{
  const ReducedModel *model = f->model;
  const PetscInt      m     = model->m;
  ReducedState       *s     = &f->state;

  for (PetscInt i = 0; i < model->n_pairs; i++) {
    PetscReal v[2] = {f->way[i] / f->dt, 0};

    ReducedBlockTimes(&(DenseBlock){&model->P[m * (3 * i + 1)], m, 2, m}, PETSC_TRUE, 1, s->rate, v);
    s->status[i] = PairRests(&model->friction[i], &s->p[3 * i], v) ? CONTACT_STICK : CONTACT_SLIP;
    if (!(s->p[3 * i] > 0)) s->status[i] = CONTACT_OPEN;
  }
}

/* The state that x stands for; y = P eta + W q + W loads follows from it, and p = last = begin, and the statuses: x has
   all that a step knows of the past. */
static PetscErrorCode FlowUnpack(CycleFlow *f, const PetscReal x[])
{
  const ReducedModel *model = f->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs, N = model->n_ports;
  ReducedState       *s = &f->state;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->eta, x, m));
  PetscCall(PetscArraycpy(s->rate, &x[m], m));
  if (f->family) PetscCall(CycleFamilyTurn(f->family, PETSC_FALSE, 1, m, s->eta));
  if (f->family) PetscCall(CycleFamilyTurn(f->family, PETSC_FALSE, 1, m, s->rate));
  for (PetscInt i = 0; i < n; i++) {
    s->p[i] = s->begin[i] = x[2 * m + i];
    s->q[i]               = model->Cx ? x[2 * m + n + i] : s->p[i];
    s->y[i]               = 0;
  }
  for (PetscInt i = 0; i < model->n_loads; i++) s->p[n + i] = f->loads[i];
  for (PetscInt i = 0; i < N; i++) s->last[i] = s->p[i];
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_TRUE, 1, s->eta, s->y);
  ReducedBlockTimes(&(DenseBlock){model->W, n, n, N}, PETSC_FALSE, 1, s->q, s->y);
  ReducedBlockTimes(&(DenseBlock){&model->W[N * n], n, model->n_loads, N}, PETSC_FALSE, 1, f->loads, s->y);
  FlowSetStatuses(f);
  PetscFunctionReturn(0);
}

static PetscErrorCode FlowForget(CycleFlow *f)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedTangentDestroy(&f->tangent));
  PetscCall(ReducedStepperDestroy(&f->stepper));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowSetValue(CycleFlow *f, PetscReal value)
{
  const ReducedMoved moved = {f->model, f->interface, f->stated, f->loads};

  PetscFunctionBeginUser;
  if (!f->varied || f->value == value) PetscFunctionReturn(0);
  f->value = value;
  if (f->family) PetscCall(FlowForget(f));
  if (f->family) PetscCall(CycleFamilySet(f->family, value));
  ReducedParameterMove(f->varied, value, &moved);
  if (f->stepper && f->stepper->laws)
    PetscCall(ContactComplianceSetFriction(f->stepper->laws, f->model->friction, f->dt));
  PetscFunctionReturn(0);
}

/* Stepper for the period and the parameter; it is made again only where the step, T / N, or the bodies change. */
static PetscErrorCode FlowPrepare(CycleFlow *f, PetscReal period, PetscReal value, PetscBool tangent)
{
  const PetscReal dt = period / (PetscReal)f->n_steps;

  PetscFunctionBeginUser;
  PetscCall(CycleFlowSetValue(f, value));
  if (f->stepper && f->dt != dt) PetscCall(FlowForget(f));
  if (!f->stepper) PetscCall(ReducedStepperCreate(f->model, dt, REDUCED_RTOL, &f->stepper));
  f->dt = dt;
  if (tangent && !f->tangent) PetscCall(ReducedTangentCreate(f->stepper, &f->tangent));
  for (PetscInt i = 0; i < f->model->n_pairs; i++) f->way[i] = f->share[i] * f->model->friction[i].speed * dt;
  PetscFunctionReturn(0);
}

/* Rates after step k, in the scene's modes */
static void FlowKeepRates(CycleFlow *f, PetscInt k)
{
  const PetscInt m    = f->model->m;
  PetscReal     *rate = &f->rates[m * k];

  for (PetscInt j = 0; j < m; j++) rate[j] = f->state.rate[j];
  if (f->family) (void)CycleFamilyTurn(f->family, PETSC_TRUE, 1, m, rate);
}

/* The normal force after step k, and what probes show: displacement, of it that of the residual, and velocity of the
   modes */
static void FlowLook(CycleFlow *f, PetscInt k)
{
  const ReducedModel *model = f->model;
  const PetscInt      m = model->m, n = f->n_looked, pairs = 3 * model->n_pairs, N = model->n_ports;
  PetscReal          *u = &f->shown[3 * n * k], *residual = u + n, *v = residual + n;
  const DenseBlock    P = {&model->P[m * f->first], m, n, m};

  f->force[k] = 0;
  for (PetscInt i = 0; i < model->n_pairs; i++) f->force[k] += f->state.p[3 * i];
  if (f->rates) FlowKeepRates(f, k);
  for (PetscInt i = 0; i < 3 * n; i++) u[i] = 0;
  if (!n) return;
  ReducedBlockTimes(&(DenseBlock){&model->W[N * f->first], pairs, n, N}, PETSC_TRUE, 1, f->state.q, residual);
  ReducedBlockTimes(&(DenseBlock){&model->W[N * f->first + pairs], model->n_loads, n, N}, PETSC_TRUE, 1, f->loads,
                    residual);
  ReducedBlockTimes(&P, PETSC_TRUE, 1, f->state.eta, u);
  ReducedBlockTimes(&P, PETSC_TRUE, 1, f->state.rate, v);
  for (PetscInt i = 0; i < n; i++) u[i] += residual[i];
}

/* All steps of the period from the state on */
static PetscErrorCode FlowSteps(CycleFlow *f, PetscReal M[])
{
  const ReducedDrive drive = {f->loads, f->way, NULL};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < f->n_steps; k++) {
    PetscCall(ReducedStep(f->stepper, &drive, &f->state, &f->report));
    if (M) PetscCall(ReducedTangentApply(f->tangent, f->n, M));
    if (f->force) FlowLook(f, k);
    if (f->force) ReducedGetContactWork(f->model, &f->report, &f->contact, &f->friction);
  }
  PetscFunctionReturn(0);
}

/* Columns of M, changes of eta and rate, to the coordinates of the model or back */
static PetscErrorCode FlowTurn(CycleFlow *f, PetscBool to_scene, PetscReal M[])
{
  PetscFunctionBeginUser;
  if (!M || !f->family) PetscFunctionReturn(0);
  for (PetscInt part = 0; part < 2; part++)
    PetscCall(CycleFamilyTurn(f->family, to_scene, f->n, f->n, &M[part * f->model->m]));
  PetscFunctionReturn(0);
}

/* Errors of the contact laws and of the factors are caught here, since Newton's method may try states that have no
   solution; others are raised. */
PetscErrorCode CycleFlowRun(void *ctx, const PetscReal x[], PetscReal period, PetscReal value, PetscReal y[],
                            PetscReal M[])
{
  CycleFlow     *f = ctx;
  PetscErrorCode error;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < f->n; i++) y[i] = INFINITY;
  if (f->family && !CycleFamilyHolds(f->family, value)) PetscFunctionReturn(0);
  PetscCall(FlowPrepare(f, period, value, M ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(FlowUnpack(f, x));
  f->n_flows++;
  if (M) PetscCall(PetscArrayzero(M, f->n * f->n));
  for (PetscInt i = 0; i < f->n && M; i++) M[i + f->n * i] = 1;
  PetscCall(FlowTurn(f, PETSC_FALSE, M));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = FlowSteps(f, M);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!error || error == PETSC_ERR_NOT_CONVERGED || error == PETSC_ERR_FP || error == PETSC_ERR_MAT_LU_ZRPVT,
             PETSC_COMM_SELF, error, "a period of a cycle ended by PETSc's error %d", (int)error);
  PetscCall(FlowTurn(f, PETSC_TRUE, M));
  if (!error) PetscCall(CycleFlowPack(f, &f->state, y));
  if (error) PetscCall(FlowForget(f)); /* factors of what went wrong */
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFlowDestroy(CycleFlow *f)
{
  PetscFunctionBeginUser;
  if (!f->model) PetscFunctionReturn(0);
  PetscCall(FlowForget(f));
  PetscCall(ReducedStateDestroy(&f->state));
  PetscCall(ReducedReportDestroy(&f->report));
  PetscCall(PetscFree5(f->loads, f->share, f->way, f->stated, f->interface));
  PetscFunctionReturn(0);
}
