/*
   What a room that integrates the same scenes by other means takes from the options of a transient.
*/
#include "dynamics/dynamicsimpl.h"
#include <squeal/options.h>

/* Options of the explicit integrator that change the answer */
static PetscErrorCode RunRefuse(Dynamics d, const char by[])
{
  PetscFunctionBeginUser;
  PetscCheck(!d->coriolis && !d->centrifugal, d->comm, PETSC_ERR_SUP,
             "%s knows no inertial forces of parts that turn: leave out -dynamics_coriolis and -dynamics_centrifugal",
             by);
  PetscCheck(!d->filters_dir[0], d->comm, PETSC_ERR_SUP,
             "%s: -dynamics_filters works on state vectors of the mesh; leave it out", by);
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetEndless(Dynamics d)
{
  PetscFunctionBeginUser;
  d->endless = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsCheckTimes(Dynamics d, PetscReal end, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(ExternalCheckLate(d->external, end, dt, LATE_ALL));
  PetscCall(ExternalCheckSteps(d->external, dt));
  if (d->n_interfaces) PetscCall(ContactProjectorCheckSteps(d->projector, dt));
  for (PetscInt i = 0; i < d->n_interfaces; i++) {
    const ContactInterface *c = &d->interfaces[i];
    PetscReal               delay;

    PetscCall(ContactProjectorGetDelay(d->projector, i, &delay));
    PetscCall(ExternalCheckDelay(d->external, c->name, delay, end, LATE_ALL));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsGetStep(Dynamics d, PetscReal dt, DynamicsRun *run)
{
  PetscFunctionBeginUser;
  run->dt  = d->dt_asked > 0 ? d->dt_asked : dt;
  run->end = 0;
  if (d->endless) PetscFunctionReturn(0);
  PetscCall(DynamicsFitEnd(d, &run->dt, &run->end));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsGetRun(Dynamics d, Results results, const char by[], PetscReal dt, DynamicsRun *run)
{
  PetscFunctionBeginUser;
  PetscCheck(d->model, d->comm, PETSC_ERR_USER_INPUT,
             "-analysis transient needs a mesh: loaded matrices have no contact surfaces");
  PetscCall(RunRefuse(d, by));
  d->results = results;
  if (!d->restart) PetscCall(DynamicsCheckEarlier(d));
  PetscCall(DynamicsCheckBolts(d));
  if (d->start == START_STATIC) PetscCall(DynamicsCheckStatic(d));
  *run = (DynamicsRun){.model               = d->model,
                       .contact             = d->contact,
                       .n_interfaces        = d->n_interfaces,
                       .interfaces          = d->interfaces,
                       .operators           = d->operators,
                       .statics             = d->statics,
                       .external            = d->external,
                       .projector           = d->projector,
                       .history             = d->history,
                       .checkpoint_interval = d->checkpoint_interval,
                       .from_static         = d->start == START_STATIC ? PETSC_TRUE : PETSC_FALSE,
                       .restart             = d->restart,
                       .view_kkt            = d->view_kkt};
  PetscCall(DynamicsGetStep(d, dt, run));
  PetscCall(TSGetMaxSteps(d->ts, &run->n_steps));
  if (d->restart) PetscCall(ResultsKeep(results, CHECKPOINT_FILE));
  if (d->shape[0]) PetscCall(ResultsKeepFolder(results, d->shape));
  PetscFunctionReturn(0);
}

/* dt at most the run; with matchstep the longest dt up to it of which the run is a whole number */
PetscErrorCode DynamicsFitEnd(Dynamics d, PetscReal *dt, PetscReal *end)
{
  TSExactFinalTimeOption match;
  PetscReal              begin, time;
  PetscInt               most;

  PetscFunctionBeginUser;
  PetscCall(TSGetExactFinalTime(d->ts, &match));
  PetscCheck(match != TS_EXACTFINALTIME_INTERPOLATE, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_exact_final_time interpolate is not offered: stepover or matchstep");
  PetscCall(TSGetTime(d->ts, &begin));
  PetscCall(TSGetMaxTime(d->ts, &time));
  PetscCall(TSGetMaxSteps(d->ts, &most));
  PetscCheck(begin == 0, d->comm, PETSC_ERR_USER_INPUT, "-ts_init_time %.6g must be 0: ramps and motions begin there",
             (double)begin);
  PetscCheck(time < PETSC_MAX_REAL || most < PETSC_MAX_INT, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_max_time must be given: how long to integrate (s); or -ts_max_steps");
  PetscCheck(time > 0, d->comm, PETSC_ERR_USER_INPUT, "-ts_max_time %.6g must be a positive time (s)", (double)time);
  PetscCheck(most > 0, d->comm, PETSC_ERR_USER_INPUT, "-ts_max_steps %" PetscInt_FMT " must be positive", most);
  PetscCheck(d->dt_asked <= time, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_dt %.6g s is longer than the run: take at most -ts_max_time %.6g", (double)d->dt_asked, (double)time);
  *dt = PetscMin(*dt, time);
  if (match == TS_EXACTFINALTIME_MATCHSTEP && time < PETSC_MAX_REAL)
    *dt = time / PetscCeilReal(time / *dt * (1 - 1e-12));
  *end = most < PETSC_MAX_INT ? PetscMin(time, *dt * (PetscReal)most) : time;
  PetscFunctionReturn(0);
}
