/*
   Dynamics: life cycle, options, and the run: bodies -> critical step -> state at the start -> TS -> history.
*/
#include "dynamicsimpl.h"
#include "dynamics/run/stop.h"

PetscErrorCode DynamicsCreate(MPI_Comm comm, Dynamics *dynamics)
{
  PetscFunctionBeginUser;
  PetscCall(TSCentralRegister());
  PetscCall(PetscCalloc1(1, dynamics));
  (*dynamics)->comm = comm;
  PetscCall(QuantitiesInit(&dynamics_quantities, *dynamics));
  PetscCall(TSCreate(comm, &(*dynamics)->ts));
  PetscCall(TSSetType((*dynamics)->ts, TSCENTRAL));
  PetscCall(TSSetExactFinalTime((*dynamics)->ts, TS_EXACTFINALTIME_STEPOVER));
  PetscCall(HistoryCreate(comm, &(*dynamics)->history));
  PetscCall(BodiesCreate(comm, &(*dynamics)->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetModel(Dynamics d, Model model, Contact contact)
{
  PetscFunctionBeginUser;
  d->model   = model;
  d->contact = contact;
  PetscCall(ExternalCreate(d->comm, model, &d->external));
  PetscCall(ContactGetInterfaces(contact, &d->n_interfaces, &d->interfaces));
  PetscCall(PetscCalloc1(d->n_interfaces, &d->sums));
  if (d->n_interfaces) PetscCall(ContactProjectorCreate(contact, &d->projector));
  PetscFunctionReturn(0);
}

/* Pairs of the operators are needed where a static state or modal filters are; steps find their own contacts. */
PetscErrorCode DynamicsNeedsPairs(Dynamics d, PetscBool *needs)
{
  PetscFunctionBeginUser;
  *needs = d->start == START_STATIC || d->filters_dir[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetOperators(Dynamics d, Operators operators, Statics statics)
{
  PetscFunctionBeginUser;
  d->operators = operators;
  d->statics   = statics;
  PetscFunctionReturn(0);
}

/* Nodes of the contact surfaces, their work arrays and masses. 1/m in Cartesian directions c is sum_j q_jc^2 / m_j
   of the node's own components j (1/kg): exact where all m_j of a node are one, or held directions are axes. */
static PetscErrorCode DynamicsSetUpSurface(Dynamics d)
{
  DynamicsSurface *s = &d->surface;
  PetscReal       *inverse;

  PetscFunctionBeginUser;
  PetscCall(ContactProjectorSetUp(d->projector));
  PetscCall(ContactProjectorGetNodes(d->projector, &s->n, &s->vertex));
  PetscCall(PetscCalloc4(3 * s->n, &s->u, 3 * s->n, &s->before, 3 * s->n, &s->v, 3 * s->n, &s->force));
  PetscCall(PetscCalloc1(3 * s->n, &inverse));
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscInt   vertex = s->vertex[i];
    const PetscReal *q      = &d->layout->basis[9 * vertex];

    for (int j = 0; j < 3; j++)
      for (int c = 0; c < 3; c++)
        inverse[3 * i + c] +=
          PetscSqr(q[3 * j + c]) * d->layout->minv[d->layout->at[vertex] + j * d->layout->step[vertex]];
  }
  PetscCall(ContactProjectorSetMass(d->projector, inverse));
  PetscCall(PetscFree(inverse));
  PetscFunctionReturn(0);
}

/* u and v [layout n], with copies of shared nodes on each rank; ku = K u, N, is a sum over the steps and never
   formed anew. */
static PetscErrorCode DynamicsCreateState(Dynamics d)
{
  const PetscInt n = d->layout->n;

  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(d->comm, n, PETSC_DETERMINE, &d->u));
  PetscCall(VecDuplicate(d->u, &d->v));
  PetscCall(VecSet(d->u, 0));
  PetscCall(VecSet(d->v, 0));
  PetscCall(PetscCalloc1(n, &d->ku));
  PetscCall(VecCreateMPIWithArray(d->comm, 1, n, PETSC_DETERMINE, d->layout->minv, &d->minv));
  PetscCall(TS2SetSolution(d->ts, d->u, d->v));
  PetscCall(TSCentralSetForces(d->ts, d->minv, DynamicsForce, DynamicsConstrain, d));
  PetscFunctionReturn(0);
}

/* The largest number of six digits up to x: without the digits of an iteration, in which ranks and processors differ */
static PetscReal SixDigits(PetscReal x)
{
  const PetscReal digit = PetscPowReal(10, PetscFloorReal(PetscLog10Real(x)) - 5);

  return PetscFloorReal(x / digit) * digit;
}

/* The step asked for, or the stated fraction of the critical one, in six digits; a larger one is refused */
static PetscErrorCode DynamicsChooseStep(Dynamics d, PetscReal *step, PetscReal *end)
{
  const PetscReal critical = d->critical.assembled;
  PetscReal       dt       = d->dt_asked > 0 ? d->dt_asked : SixDigits(d->fraction * critical);

  PetscFunctionBeginUser;
  PetscCheck(
    dt <= critical || d->step_force, d->comm, PETSC_ERR_USER_INPUT,
    "-ts_dt %.6g is above the critical step %.6g s: the fastest oscillations would grow; take at most %.6g, or "
    "-dynamics_step_force",
    (double)dt, (double)critical, (double)(d->fraction * critical));
  PetscCall(DynamicsFitEnd(d, &dt, end));
  PetscCall(TSSetTimeStep(d->ts, dt));
  *step = dt;
  PetscFunctionReturn(0);
}

/* Masses of points; the ledger's work of the integrator for b > 1/2 knows of none */
static PetscErrorCode DynamicsSetUpPoints(Dynamics d)
{
  const ModelScene *scene;
  const ContactTie *tie;
  PetscInt          n_ties;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(d->model, &scene));
  PetscCall(ContactGetTies(d->contact, &n_ties, &tie));
  PetscCheck(!scene->equations[0], d->comm, PETSC_ERR_SUP,
             "-model_equations is not supported in time on the mesh: take -dynamics_model reduced");
  PetscCheck(!n_ties || d->b == 0.5, d->comm, PETSC_ERR_SUP,
             "-ts_central_b %.6g is not supported with tie %s: take 0.5", (double)d->b, n_ties ? tie[0].name : "");
  for (PetscInt i = 0; i < scene->n_points && d->b != 0.5; i++)
    for (int j = -1; j < 6; j++)
      PetscCheck((j < 0 ? scene->points[i].mass : scene->points[i].inertia[j]) == 0 && !scene->points[i].rigid, d->comm,
                 PETSC_ERR_SUP, "-ts_central_b %.6g is not supported with the mass or rigid set of point %s: take 0.5",
                 (double)d->b, scene->points[i].name);
  PetscCall(BodiesSetPoints(d->bodies, d->surface.n, d->surface.vertex));
  PetscFunctionReturn(0);
}

/* What has no place for the unknowns of superelements that no node has */
static PetscErrorCode DynamicsCheckSuperelements(Dynamics d)
{
  const char *what = d->b != 0.5 ? "-ts_central_b other than 0.5" : d->filters_dir[0] ? "-dynamics_filters" : NULL;

  PetscFunctionBeginUser;
  if (!OperatorsCountSuperelements(d->operators)) PetscFunctionReturn(0);
  if (d->shape[0]) what = "-dynamics_shape";
  if (ModelHasGravity(d->model)) what = "-model_gravity";
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    PetscReal rotation[3];
    PetscBool turns;

    PetscCall(ContactProjectorGetTurning(d->projector, i, &turns, rotation));
    if (turns) what = "-..._kinematics turning";
  }
  PetscCheck(
    !what, d->comm, PETSC_ERR_SUP,
    "%s is not supported with -superelements in time on the mesh: leave it out, or take -dynamics_model reduced", what);
  PetscFunctionReturn(0);
}

/* The order matters: the bodies before all that stands in their layout, supports and motions (minv = 0) before the
   critical step, the step before the history, which fits its intervals to it, and a restart before the times are
   checked. */
static PetscErrorCode DynamicsSetUp(Dynamics d, Results results)
{
  PetscReal end, dt;

  PetscFunctionBeginUser;
  PetscCheck(d->model, d->comm, PETSC_ERR_USER_INPUT,
             "-analysis transient needs a mesh: loaded matrices have no contact surfaces");
  PetscCall(DynamicsCheckSuperelements(d));
  PetscCall(DynamicsCheckBolts(d));
  d->results = results;
  if (!d->restart) PetscCall(DynamicsCheckEarlier(d));
  PetscCall(ModelGetMesh(d->model, &d->mesh));
  d->n_elements = d->mesh->n_cells;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &d->n_elements, 1, MPIU_INT, MPI_SUM, d->comm));
  PetscCall(BodiesSetUp(d->bodies, d->operators));
  PetscCall(BodiesGetLayout(d->bodies, &d->layout));
  PetscCall(ExternalSetUp(d->external, d->operators, d->bodies));
  if (d->projector) PetscCall(DynamicsSetUpSurface(d));
  PetscCall(DynamicsSetUpPoints(d));
  PetscCall(DynamicsSetFrames(d));
  PetscCall(DynamicsCreateState(d));
  PetscCall(DynamicsFindCriticalStep(d));
  PetscCall(DynamicsChooseStep(d, &dt, &end));
  PetscCall(HistorySetUp(
    d->history, &(HistorySource){d->model, d->layout, d->projector, d->n_interfaces, d->interfaces, results}, end, dt));
  PetscCall(TSSetUp(d->ts));
  PetscCall(DynamicsSetFilters(d));
  if (d->restart) PetscCall(DynamicsGoOn(d));
  PetscCall(DynamicsCheckTimes(d, end, dt));
  if (!d->restart) PetscCall(DynamicsStartState(d));
  if (!d->restart) PetscCall(DynamicsForget(d));
  if (d->restart) PetscCall(ResultsKeep(results, CHECKPOINT_FILE));
  if (d->shape[0]) PetscCall(ResultsKeepFolder(results, d->shape));
  if (d->filters_dir[0]) PetscCall(ResultsKeepFolder(results, d->filters_dir));
  PetscFunctionReturn(0);
}

/* After every step: checkpoints where they are due, and the end where a signal asks for it, never without one. A
   signal may reach one rank alone: all agree every STOP_INTERVAL steps, since a message in each would cost more
   than it is worth. */
static PetscErrorCode DynamicsAfterStep(TS ts)
{
  Dynamics  d;
  PetscInt  n;
  PetscBool due, stop = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(TSGetApplicationContext(ts, &d));
  PetscCall(TSGetStepNumber(ts, &n));
  d->n_steps++;
  if (n % STOP_INTERVAL == 0) {
    stop = StopRequested();
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPIU_BOOL, MPI_LOR, d->comm));
  }
  due = d->checkpoint_interval > 0 && n % d->checkpoint_interval == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (stop || due) PetscCall(DynamicsKeep(d));
  if (stop) PetscCall(TSSetConvergedReason(ts, TS_CONVERGED_USER));
  d->stopped = stop;
  PetscFunctionReturn(0);
}

/* Raises the error of a run that a signal ended */
static PetscErrorCode DynamicsComplainStopped(Dynamics d)
{
  PetscReal time;
  PetscInt  n;

  PetscFunctionBeginUser;
  PetscCall(TSGetTime(d->ts, &time));
  PetscCall(TSGetStepNumber(d->ts, &n));
  SETERRQ(d->comm, PETSC_ERR_USER, "stopped by a signal after step %" PetscInt_FMT ", %.6g s; %s", n, (double)time,
          d->checkpoint_interval > 0 ? STOP_GOES_ON : STOP_ROWS STOP_GOES_ON);
}

/* The row of the last time needs forces there, which no step computes any more (TSCentralEvaluate()). */
PetscErrorCode DynamicsSolve(Dynamics d, Results results)
{
  PetscLogDouble begin, end;

  PetscFunctionBeginUser;
  PetscCall(DynamicsSetUp(d, results));
  PetscCall(TSSetApplicationContext(d->ts, d));
  PetscCall(TSSetPostStep(d->ts, DynamicsAfterStep));
  PetscCall(StopInstall());
  PetscCall(PetscTime(&begin));
  PetscCall(TSSolve(d->ts, NULL));
  PetscCall(PetscTime(&end));
  PetscCall(StopRemove());
  d->seconds = end - begin;
  if (d->stopped && d->checkpoint_interval > 0) PetscCall(DynamicsComplainStopped(d));
  d->ended = PETSC_TRUE;
  PetscCall(TSCentralEvaluate(d->ts)); /* the forces of the last time, for its row */
  PetscCall(HistoryClose(d->history));
  PetscCall(DynamicsReportImpulses(d));
  if (d->stopped) PetscCall(DynamicsComplainStopped(d));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetSound(Dynamics d, Sound sound)
{
  PetscFunctionBeginUser;
  PetscCall(HistorySetSound(d->history, sound));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsDestroy(Dynamics *dynamics)
{
  Dynamics d = *dynamics;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  PetscCall(HistoryDestroy(&d->history));
  PetscCall(DynamicsDestroyFilters(d));
  PetscCall(ContactProjectorDestroy(&d->projector));
  PetscCall(PetscFree4(d->surface.u, d->surface.before, d->surface.v, d->surface.force));
  PetscCall(TSDestroy(&d->ts));
  PetscCall(VecDestroy(&d->minv));
  PetscCall(VecDestroy(&d->u));
  PetscCall(VecDestroy(&d->v));
  PetscCall(PetscFree(d->ku));
  PetscCall(PetscFree(d->sums));
  PetscCall(ExternalDestroy(&d->external));
  PetscCall(BodiesDestroy(&d->bodies));
  PetscCall(ChecksumDestroy(&d->scene));
  PetscCall(PetscFree(*dynamics));
  PetscFunctionReturn(0);
}
