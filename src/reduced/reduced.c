/*
   Reduced: life cycle and the flow of a run: modes of the bodies -> ports -> residual -> comparison with the
   mesh, which may choose cut-off and step -> state at the start -> steps -> histories.
*/
#include "reducedimpl.h"
#include "refuse.h"
#include "dynamics/run/stop.h"
#include <squeal/options.h>

#define BY "-dynamics_model reduced"

PetscErrorCode ReducedSetFromOptions(ReducedRun r)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(r->comm, &reduced_quantities, r));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedVisit(ReducedRun r, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &reduced_quantities, NULL, r, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedIsAsked(ReducedRun r, PetscBool *asked)
{
  PetscFunctionBeginUser;
  *asked = r->request.asked;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedHasSprings(ReducedRun r, PetscBool *springs)
{
  PetscFunctionBeginUser;
  *springs = r->request.asked && r->request.springs ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedIsCompared(ReducedRun r, PetscBool *compared)
{
  PetscFunctionBeginUser;
  *compared = r->request.asked && r->request.compare ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedSetRooms(ReducedRun r, Dynamics dynamics, Modes modes)
{
  PetscFunctionBeginUser;
  r->dynamics   = dynamics;
  r->mesh_modes = modes;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedPrepare(ReducedRun r, Results results)
{
  PetscFunctionBeginUser;
  r->results = results;
  PetscCall(ReducedChooseCutoff(r));
  PetscCall(DynamicsGetRun(r->dynamics, results, BY, 1 / (2 * PETSC_PI * r->request.cutoff), &r->run));
  if (r->run.from_static && !r->request.springs) PetscCall(DynamicsCheckExact(r->dynamics));
  PetscCall(ReducedRefuse(r));
  PetscCall(ExternalCountHits(r->run.external, &r->reduction.n_hits));
  PetscCall(ReducedSetStep(r, r->run.dt));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedWeigh(ReducedRun r, PetscBool weighs)
{
  PetscFunctionBeginUser;
  r->request.weighs = weighs;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetModel(ReducedRun r, ReducedModel **model)
{
  PetscFunctionBeginUser;
  *model = &r->reduction.model;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetRun(ReducedRun r, PetscReal *cutoff, PetscReal *dt, PetscReal *end)
{
  PetscFunctionBeginUser;
  if (cutoff) *cutoff = r->request.cutoff;
  if (dt) *dt = r->motion.dt;
  if (end) *end = r->run.end;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetHits(ReducedRun r, PetscInt *n, const PetscReal **hits, const PetscReal **due)
{
  PetscFunctionBeginUser;
  *n = r->reduction.n_hits;
  if (hits) *hits = r->reduction.hits;
  if (due) *due = r->reduction.hit_due;
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGetInterface(ReducedRun r, PetscInt pair, PetscInt *interface)
{
  PetscFunctionBeginUser;
  *interface = r->reduction.pair[pair].interface;
  PetscFunctionReturn(0);
}

/* The order matters: the cut-off, which may be raised, before histories and start; the factors of the residual are
   freed where no field asks for a lift to the mesh. */
static PetscErrorCode ReducedSetUp(ReducedRun r, Results results)
{
  PetscBool fields;

  PetscFunctionBeginUser;
  PetscCall(ReducedPrepare(r, results));
  if (!r->run.restart) PetscCall(ExternalCheckLate(r->run.external, r->run.end, r->motion.dt, LATE_COMMAND));
  PetscCheck(!r->request.verify || !r->run.restart, r->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_verify compares whole runs: leave it out of -dynamics_restart, or start anew");
  PetscCall(ReducedWeigh(r, r->request.compare));
  PetscCall(ReducedChoose(r));
  PetscCall(ReducedWarnGrowth(r));
  PetscCall(ReducedWeigh(r, PETSC_FALSE));
  PetscCall(HistorySetUp(
    r->run.history,
    &(HistorySource){r->run.model, NULL, r->run.projector, r->run.n_interfaces, r->run.interfaces, results}, r->run.end,
    r->motion.dt));
  PetscCall(HistoryHasFields(r->run.history, &fields));
  if (!fields && !r->reduction.model.sparse) PetscCall(ShiftInvertDestroy(&r->reduction.inverse));
  if (r->run.restart) PetscCall(ReducedGoOn(r));
  PetscCall(DynamicsCheckTimes(r->dynamics, r->run.end, r->motion.dt));
  if (!r->run.restart) {
    PetscCall(ReducedStart(r));
    PetscCall(ReducedStepperCreate(&r->reduction.model, r->motion.dt, REDUCED_RTOL, &r->motion.stepper));
    PetscCall(DynamicsForget(r->dynamics));
  }
  ReducedSetShown(r, PETSC_TRUE);
  PetscCall(ReducedTakePairs(r, PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* One step and its account. Each rank takes the whole step with the same numbers; nothing is sent. */
static PetscErrorCode ReducedAdvance(ReducedRun r)
{
  ReducedDrive drive;

  PetscFunctionBeginUser;
  PetscCall(ReducedDriveSet(r, &drive));
  for (PetscInt i = 0; i < r->run.n_interfaces && drive.kick; i++) ContactSumsMark(&r->motion.sums[i]);
  PetscCall(ReducedStep(r->motion.stepper, &drive, &r->motion.state, &r->motion.report));
  ReducedSetShown(r, PETSC_FALSE);
  r->motion.step++;
  r->result.n_steps++;
  r->result.n_its += (PetscReal)r->motion.report.its;
  r->motion.ledger.part.external += r->motion.report.external;
  r->motion.ledger.part.damping += r->motion.report.damping;
  PetscCall(ReducedTakePairs(r, PETSC_TRUE));
  if (r->request.verify) PetscCall(ReducedKeepForce(r));
  PetscFunctionReturn(0);
}

/* Checkpoints where they are due, and whether a signal asks for the end, which is not without one */
static PetscErrorCode ReducedAfterStep(ReducedRun r, PetscBool *stop)
{
  const PetscInt interval = r->run.checkpoint_interval;
  const PetscInt look     = r->reduction.model.sparse ? 1 : STOP_INTERVAL; /* steps of solutions are long */

  PetscFunctionBeginUser;
  *stop = PETSC_FALSE;
  if (r->motion.step % look == 0) {
    *stop = StopRequested();
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stop, 1, MPIU_BOOL, MPI_LOR, r->comm));
  }
  if (*stop || (interval > 0 && r->motion.step % interval == 0)) PetscCall(ReducedKeep(r));
  PetscFunctionReturn(0);
}

/* Steps until the end, less 1e-9 of a step for sums of dt; rows on the way, among them the first and the last. */
static PetscErrorCode ReducedMarch(ReducedRun r, PetscBool *stop)
{
  const PetscReal end = r->run.end - 1e-9 * r->motion.dt;

  PetscFunctionBeginUser;
  *stop = PETSC_FALSE;
  for (PetscBool first = PETSC_TRUE; !*stop; first = PETSC_FALSE) {
    const PetscBool done = r->motion.state.time >= end || r->motion.step >= r->run.n_steps ? PETSC_TRUE : PETSC_FALSE;

    if (done || HistoryIsDue(r->run.history, r->motion.state.time, r->motion.dt) || r->motion.step == 0)
      PetscCall(ReducedRecord(r, first && r->motion.step == 0 ? PETSC_TRUE : PETSC_FALSE));
    if (done) break;
    PetscCall(ReducedAdvance(r));
    PetscCall(ReducedAfterStep(r, stop));
  }
  PetscFunctionReturn(0);
}

/* Tables stay open for a run that goes on from a checkpoint, and are closed where none can. */
PetscErrorCode ReducedIntegrate(ReducedRun r, Results results)
{
  PetscLogDouble begin, ready, end;
  PetscBool      stop;

  PetscFunctionBeginUser;
  r->request.steps = PETSC_TRUE;
  PetscCall(PetscTime(&begin));
  PetscCall(ReducedSetUp(r, results));
  PetscCall(PetscTime(&ready));
  PetscCall(StopInstall());
  PetscCall(ReducedMarch(r, &stop));
  PetscCall(StopRemove());
  PetscCall(PetscTime(&end));
  r->result.setup_seconds = ready - begin;
  r->result.seconds       = end - ready;
  if (!stop || r->run.checkpoint_interval == 0) {
    PetscCall(HistoryClose(r->run.history));
    PetscCall(ReducedReportHits(r));
  }
  if (!stop && r->request.verify) PetscCall(ReducedVerify(r));
  PetscCheck(!stop, r->comm, PETSC_ERR_USER, "stopped by a signal after step %" PetscInt_FMT ", %.6g s; %s",
             r->motion.step, (double)r->motion.state.time,
             r->run.checkpoint_interval > 0 ? STOP_GOES_ON : STOP_ROWS STOP_GOES_ON);
  PetscFunctionReturn(0);
}
