/*
   One step of the reduced model (reduced.h) and its account of energy: first with lambda_{n+1} = 0, which gives the
   free displacements of the pairs, then lambda_{n+1} from the laws, then with it.
*/
#include "reduced/sparse/sparse.h"
#include <petscblaslapack.h>

/* Impulses act at the beginning: rate += Phi'J; the work that they do, J, is J times the mean of the velocities
   before and after. x = (eta, rate) of the beginning. */
static PetscReal StepperKick(ReducedStepper s, const PetscReal kick[], const ReducedState *state)
{
  const PetscInt m    = s->model->m;
  PetscReal      work = 0;

  for (PetscInt k = 0; k < m; k++) {
    s->x[k]     = state->eta[k];
    s->x[m + k] = state->rate[k] + (kick ? kick[k] : 0);
    if (kick) work += kick[k] * 0.5 * (state->rate[k] + s->x[m + k]);
  }
  return work;
}

/* next = E z + F g with g = P' mean less those of branches, the forces on the modes (m sqrt(kg)/s^2), constant in the
   step. */
static void StepperRespond(ReducedStepper s)
{
  const ReducedModel *model = s->model;
  const PetscInt      m     = model->m;

  for (PetscInt k = 0; k < m; k++) s->x[2 * m + k] = 0;
  ReducedBlockTimes(&(DenseBlock){model->P, m, model->n_ports, m}, PETSC_FALSE, 1, s->mean, &s->x[2 * m]);
  for (PetscInt k = 0; k < m && s->known; k++) s->x[2 * m + k] -= s->known[k];
  ReducedStepperMove(s, s->x, s->next);
}

/* Adds -Cm dq / dt to g, and what it changes to next */
static void StepperDrag(ReducedStepper s)
{
  const PetscInt m = s->model->m;

  for (PetscInt k = 0; k < m; k++) s->product[k] = 0;
  ReducedStepperDrag(s, -1 / s->dt, s->dq, s->product);
  ReducedStepperPush(s, s->product, s->next);
  for (PetscInt k = 0; k < m; k++) s->x[2 * m + k] += s->product[k];
}

/* q_{n+1} and dq = q_{n+1} - q_n with lambda_{n+1} in the mean forces: W mean(q) + Cx dq / dt + Cm'(eta_{n+1} - eta_n)
   / dt = W mean(lambda). `next` holds the answer without dq, then with it */
static PetscErrorCode StepperSolveResidual(ReducedStepper s, const ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) s->dq[i] = 0;
  ReducedStepperKnowBranches(s, state);
  StepperRespond(s);
  for (PetscInt i = 0; i < n; i++) {
    s->q[i] = model->Cm ? state->q[i] : state->p[i];
    s->r[i] = s->mean[i] - state->q[i]; /* work */
  }
  if (!model->Cm) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m; k++) s->product[k] = s->next[k] - s->x[k];
  if (s->sparse) {
    for (PetscInt k = 0; k < m; k++) s->product[k] /= -s->dt;
    PetscCall(SparseLawsFree(s->sparse, s->r, s->product, s->dq));
  } else {
    ReducedBlockTimes(&(DenseBlock){s->HW, n, n, n}, PETSC_FALSE, 1, s->r, s->dq);
    ReducedStepperDelay(s, s->product, s->dq);
  }
  PetscCall(ReducedStepperDragBranches(s));
  for (PetscInt i = 0; i < n; i++) s->q[i] += s->dq[i];
  StepperDrag(s);
  PetscFunctionReturn(0);
}

/* Mean forces of the step, with lambda_{n+1} or without */
static void StepperSetMean(ReducedStepper s, const ReducedState *state, PetscBool without)
{
  const PetscInt n = 3 * s->model->n_pairs;

  for (PetscInt i = 0; i < s->model->n_ports; i++)
    s->mean[i] = 0.5 * (state->last[i] + (i < n && without ? 0 : state->p[i]));
}

/* lambda_{n+1} joins what the step has without it: g = P'lambda / 2, a half since the mean force of the step counts,
   makes q_{n+1} change by dq = H W lambda / 2 - H Cm'(F g) / dt, which drags, g -= Cm dq / dt; z(dt) += F g. */
static PetscErrorCode StepperAddForces(ReducedStepper s, const ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  PetscReal          *g = &s->product[2 * m], *z = s->product;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 3 * m; k++) s->product[k] = 0;
  for (PetscInt i = 0; i < n; i++) s->r[i] = model->Cm ? 0 : state->p[i];
  ReducedAddCarrying(model, m, model->P, state->p, g);
  for (PetscInt k = 0; k < m; k++) g[k] *= 0.5;
  if (s->HW) {
    ReducedAddCarrying(model, n, s->HW, state->p, s->r);
    for (PetscInt i = 0; i < n; i++) s->r[i] *= 0.5;
    ReducedStepperPush(s, g, z);
    ReducedStepperDelay(s, z, s->r);
    ReducedStepperDrag(s, -1 / s->dt, s->r, g);
  }
  ReducedStepperPush(s, g, s->next);
  if (s->sparse && model->Cm) {
    PetscCall(SparseLawsDrag(s->sparse, state->p, s->r, s->next));
    ReducedStepperDrag(s, -1 / s->dt, s->r, g);
  }
  for (PetscInt k = 0; k < m; k++) s->x[2 * m + k] += g[k];
  for (PetscInt i = 0; i < n; i++) {
    s->q[i] += s->r[i];
    s->dq[i] += model->Cm ? s->r[i] : 0;
  }
  PetscFunctionReturn(0);
}

/* The linear part of a step alone, for its derivative: next = z(dt), q_{n+1} and the displacements y of the pairs,
   of a state without loads, sliding or impulses, with state->p as lambda_{n+1}. */
PetscErrorCode ReducedStepRespond(ReducedStepper s, const ReducedState *state, PetscReal next[], PetscReal q[],
                                  PetscReal y[])
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;

  PetscFunctionBeginUser;
  (void)StepperKick(s, NULL, state);
  StepperSetMean(s, state, PETSC_FALSE);
  PetscCall(StepperSolveResidual(s, state));
  if (s->HW) ReducedStepperSettle(s, state->p);
  for (PetscInt i = 0; i < 2 * m; i++) next[i] = s->next[i];
  for (PetscInt i = 0; i < n; i++) {
    q[i] = s->q[i];
    y[i] = 0;
  }
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_TRUE, 1, next, y);
  ReducedBlockTimes(&(DenseBlock){model->W, n, n, model->n_ports}, PETSC_FALSE, 1, q, y);
  PetscFunctionReturn(0);
}

/* Free displacements P eta + W q + W loads of the pairs at t_{n+1} without lambda_{n+1}, m, gaps g0 included along
   n; and what slip counts from: y_n less the prescribed sliding. */
static PetscErrorCode StepperSetFree(ReducedStepper s, const ReducedDrive *drive, const ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs, N = model->n_ports;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) s->free[i] = i % 3 ? 0 : model->gap[i / 3];
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_TRUE, 1, s->next, s->free);
  if (s->sparse && model->Cm) {
    PetscCall(SparseTimes(model->sparse, s->q, s->r, NULL));
    for (PetscInt i = 0; i < n; i++) s->free[i] += s->r[i];
  }
  if (!s->sparse && model->Cm) ReducedBlockTimes(&(DenseBlock){model->W, n, n, N}, PETSC_FALSE, 1, s->q, s->free);
  ReducedBlockTimes(&(DenseBlock){ReducedColumn(model, n), n, model->n_loads, N}, PETSC_FALSE, 1, &state->p[n],
                    s->free);
  for (PetscInt i = 0; i < n && model->n_motions; i++) s->free[i] += ReducedMotionWay(model, &state->p[n], i);
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    s->slip0[2 * i]     = state->y[3 * i + 1] - drive->sliding[i];
    s->slip0[2 * i + 1] = state->y[3 * i + 2];
  }
  PetscFunctionReturn(0);
}

/* Raises the error for a closed pair beyond the table of its friction */
static PetscErrorCode StepperCheckTables(ReducedStepper s, const ReducedState *state)
{
  const PetscReal *slip;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceGetSlip(s->laws, &slip));
  for (PetscInt i = 0; i < s->model->n_pairs; i++) {
    const PetscReal   speed = hypot(slip[3 * i + 1], slip[3 * i + 2]) / s->dt;
    const FrictionLaw law   = FrictionPressed(&s->model->friction[i], state->p[3 * i]);

    if (law.pressure > 0 && !FrictionCovers(&law, speed))
      PetscCall(FrictionComplain(PETSC_COMM_SELF, NULL, &law, state->time + s->dt, speed, law.pressure));
  }
  PetscFunctionReturn(0);
}

/* Forces and statuses of the pairs at t_{n+1}, with the guess in state->p. Raised on each rank alone: all have the
   same numbers. */
static PetscErrorCode StepperSolveLaws(ReducedStepper s, ReducedState *state, ReducedReport *report)
{
  const PetscInt       n = s->model->n_pairs;
  const ContactStatus *status;
  const PetscReal     *slip;
  ComplianceReport     solved;

  PetscFunctionBeginUser;
  report->residual = 0;
  report->its      = 0;
  if (!n) PetscFunctionReturn(0);
  PetscCall(ContactComplianceSetResting(s->laws, state->status));
  PetscCall(ContactComplianceSolve(s->laws, s->free, s->slip0, state->p, NULL, &solved));
  PetscCheck(solved.converged, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
             "contact forces do not converge at %.6g s: residual %.2e of pair %" PetscInt_FMT
             ", must be %.0e; friction of mu %.3g may have no solution on these bodies: take "
             "-dynamics_model full",
             (double)(state->time + s->dt), (double)solved.residual, solved.worst + 1, (double)s->rtol,
             (double)FrictionSteady(&s->model->friction[PetscMax(0, solved.worst)]));
  PetscCall(ContactComplianceGetStatus(s->laws, &status));
  PetscCall(PetscArraycpy(state->status, status, n));
  PetscCall(StepperCheckTables(s, state));
  PetscCall(ContactComplianceGetSlip(s->laws, &slip));
  PetscCall(PetscArraycpy(s->slip, slip, 3 * n));
  report->residual = solved.residual;
  report->its      = solved.iterations;
  PetscFunctionReturn(0);
}

/* Heat of a pair's friction in a step, J: its slip s (m) along -p, p the friction at t_{n+1}, for which Coulomb's law
   holds together with s, so that p . s <= 0; times the mean of |p| and of |last| at t_n (N), second order in the step.
   None of a pair that is open at t_{n+1}, nor of one that sticks beyond the rounding of s */
static PetscReal FrictionHeat(const PetscReal p[2], const PetscReal last[2], const PetscReal s[2])
{
  const PetscReal size = hypot(p[0], p[1]);

  return size > 0 ? -0.5 * (1 + hypot(last[0], last[1]) / size) * (p[0] * s[0] + p[1] * s[1]) : 0;
}

/* What the law in series with a pair has taken up in a step, J: contact gives the bodies what is not from there */
static PetscReal StepperStored(const ReducedModel *model, PetscInt i, const ReducedState *state)
{
  const PairSpring *spring = model->spring;

  return spring ? SpringEnergy(&spring[i], state->p[3 * i]) - SpringEnergy(&spring[i], state->last[3 * i]) : 0;
}

/* Works of the pairs with the mean forces, J, and their slip; y becomes that at t_{n+1} */
static void StepperAccount(ReducedStepper s, ReducedState *state, ReducedReport *report)
{
  for (PetscInt i = 0; i < s->model->n_pairs; i++) {
    const PetscReal *mean = &s->mean[3 * i], *slip = &s->slip[3 * i + 1];
    PetscReal        dy[3];

    for (int d = 0; d < 3; d++) {
      const PetscReal y = s->slip[3 * i + d] + (d ? s->slip0[2 * i + d - 1] : -s->model->gap[i]);

      dy[d]               = y - state->y[3 * i + d];
      state->y[3 * i + d] = y;
    }
    for (int d = 0; d < 2; d++) report->slip[2 * i + d] = slip[d];
    report->contact[i]  = mean[0] * dy[0] + StepperStored(s->model, i, state);
    report->friction[i] = mean[1] * dy[1] + mean[2] * dy[2];
    if (!report->works) continue;
    report->heat[i] = FrictionHeat(&state->p[3 * i + 1], &state->last[3 * i + 1], slip);
  }
}

/* What the drives of motions do beside their loads, J: what the springs at the nodes that they move take up, less what
   contact does on these nodes */
static PetscReal StepperMotionWork(ReducedStepper s, const ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      n     = 3 * model->n_pairs;
  PetscReal           work  = 0;

  if (!model->n_motions) return 0;
  work =
    ReducedMotionEnergy(model, s->next, s->q, state->p) - ReducedMotionEnergy(model, state->eta, state->q, state->last);
  for (PetscInt i = 0; i < n; i++)
    work -= s->mean[i] * (ReducedMotionWay(model, &state->p[n], i) - ReducedMotionWay(model, &state->last[n], i));
  return work;
}

/* Work of the loads, J: mean . (change of their displacements), less what only lambda - q makes of a load that
   changes */
static PetscReal StepperLoadWork(ReducedStepper s, const ReducedState *state)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, N = model->n_ports, n = 3 * model->n_pairs;
  PetscReal           work = 0;

  for (PetscInt i = 0; i < N; i++) s->port[i] = i < n ? s->q[i] - state->q[i] : state->p[i] - state->last[i];
  for (PetscInt j = n; j < n + model->n_loads; j++) {
    const PetscReal *w  = ReducedColumn(model, j);
    PetscReal        dy = 0, lag = 0;

    for (PetscInt k = 0; k < m; k++) dy += model->P[k + m * j] * (s->next[k] - s->x[k]);
    for (PetscInt i = 0; i < N; i++) dy += w[i] * s->port[i];
    for (PetscInt i = 0; i < n; i++) lag += w[i] * (s->mean[i] - 0.5 * (s->q[i] + state->q[i]));
    work += s->mean[j] * dy - lag * s->port[j];
  }
  return work + StepperMotionWork(s, state);
}

/* Work that damping takes, J: x'Q x of the modes, x = (z at the beginning, g), and that of the residual, 2 d eta .
   Cm dq / dt + dq'Cx dq / dt. */
static PetscErrorCode StepperDamping(ReducedStepper s, PetscReal *taken)
{
  const PetscInt m = s->model->m, n = 3 * s->model->n_pairs;
  PetscReal      work;

  PetscFunctionBeginUser;
  *taken = 0;
  if (!s->coupled.Q) PetscFunctionReturn(0);
  work   = ReducedStepperDampingForm(s, s->x);
  *taken = work;
  if (!s->model->Cm) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m; k++) s->product[k] = 0;
  ReducedStepperDrag(s, 2, s->dq, s->product);
  for (PetscInt k = 0; k < m; k++) work += (s->next[k] - s->x[k]) * s->product[k] / s->dt;
  if (s->sparse) {
    PetscCall(SparseTimes(s->model->sparse, s->dq, NULL, s->r));
    for (PetscInt i = 0; i < n; i++) work += s->dq[i] * s->r[i] / s->dt;
  } else
    work += ReducedForm(n, n, s->model->Cx, s->dq) / s->dt;
  *taken = work;
  PetscFunctionReturn(0);
}

/* What damping takes between free and moved nodes, J: the drives do it */
static void StepperShareDrag(ReducedStepper s, const ReducedState *state, ReducedReport *report)
{
  PetscReal work;

  if (!s->model->dragged) return;
  for (PetscInt k = 0; k < s->model->m; k++) s->product[k] = s->next[k] - state->eta[k];
  ReducedMotionDrag(s->model, s->product, s->mean, s->dt, &work);
  report->external += work;
  report->damping -= work;
}

/* The forces of the pairs go on as they did, the guess of the laws; those with which the step begins are kept */
static void StepperGuess(PetscInt n, PetscInt n_ports, ReducedState *state)
{
  for (PetscInt i = 0; i < n_ports; i++) {
    const PetscReal p = i < n ? state->begin[i] : state->p[i];

    if (i < n) state->p[i] = 2 * p - state->last[i];
    state->last[i] = p;
  }
}

/* The laws see a linear map dy = compliance dlambda; all else of the step is linear and known. So the step has no
   iteration but that of the laws, and its cost is that of products with E, F, P and W. */
PetscErrorCode ReducedStep(ReducedStepper s, const ReducedDrive *drive, ReducedState *state, ReducedReport *report)
{
  const ReducedModel *model = s->model;
  const PetscInt      m = model->m, n = 3 * model->n_pairs;
  PetscReal           taken;

  PetscFunctionBeginUser;
  report->external = StepperKick(s, drive->kick, state);
  StepperGuess(n, model->n_ports, state);
  for (PetscInt i = 0; i < model->n_loads; i++) state->p[n + i] = drive->loads[i];
  StepperSetMean(s, state, PETSC_TRUE);
  PetscCall(StepperSolveResidual(s, state));
  if (!model->Cm) PetscCall(PetscArrayzero(s->q, n));
  PetscCall(StepperSetFree(s, drive, state));
  PetscCall(StepperSolveLaws(s, state, report));
  StepperSetMean(s, state, PETSC_FALSE);
  PetscCall(StepperAddForces(s, state));
  if (s->HW) ReducedStepperSettle(s, state->p);
  StepperAccount(s, state, report);
  if (report->works) report->external += StepperLoadWork(s, state);
  if (report->works) PetscCall(ReducedStepperSetDamping(s));
  if (report->works) {
    PetscCall(StepperDamping(s, &report->damping));
    report->damping = -report->damping;
    StepperShareDrag(s, state, report);
  }
  taken = ReducedStepperAdvanceBranches(s, state);
  if (report->works) report->damping -= taken;
  PetscCall(ReducedStepperRelax(s, state));
  PetscCall(PetscArraycpy(state->q, s->q, n));
  PetscCall(PetscArraycpy(state->eta, s->next, m));
  PetscCall(PetscArraycpy(state->rate, &s->next[m], m));
  state->time += s->dt;
  PetscFunctionReturn(0);
}

void ReducedGetContactWork(const ReducedModel *model, const ReducedReport *report, PetscReal *contact,
                           PetscReal *friction)
{
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    *contact += report->contact[i];
    *friction += report->friction[i];
  }
}

PetscBool ReducedContactFeeds(PetscReal contact, PetscReal others)
{
  return LedgerContactFeeds(contact, others);
}
