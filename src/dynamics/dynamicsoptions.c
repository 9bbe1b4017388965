/*
   Dynamics: what the options ask for. Times in s, lengths in m.
*/
#include "dynamicsimpl.h"
#include <squeal/options.h>

#define FILTERS_MOST 256 /* modes of -dynamics_filters_modes */

static PetscErrorCode DynamicsStepFromOptions(Dynamics d, OptionsItems PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(OptionsGetReal(PetscOptionsObject, "-dynamics_step_fraction",
                           "step, where -ts_dt is not given, of the critical one (-); it has six digits",
                           d->fraction, &d->fraction, NULL));
  PetscCheck(d->fraction > 0 && d->fraction <= 1, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_step_fraction %.6g must be in (0, 1]", (double)d->fraction);
  PetscCall(OptionsGetBool(PetscOptionsObject, "-dynamics_step_force",
                           "integrate with a -ts_dt above the critical step", &d->step_force));
  PetscCall(
    OptionsGetReal(PetscOptionsObject, "-ts_time_step", "the same as -ts_dt, s", d->dt_asked, &d->dt_asked, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsStartFromOptions(Dynamics d, OptionsItems PetscOptionsObject)
{
  static const char *const starts[N_STARTS] = {[START_REST] = "rest", [START_STATIC] = "static"};
  PetscInt                 start            = d->start;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsEList("-dynamics_start", "at rest, or the sliding state under the loads", "dynamics.h", starts,
                              N_STARTS, starts[start], &start, NULL));
  PetscCall(OptionsGetPath(PetscOptionsObject, "-dynamics_shape",
                           "folder of a run of modes: one of them is added to the start", d->shape, NULL));
  PetscCall(OptionsGetInt(PetscOptionsObject, "-dynamics_shape_mode", "its number in modes.csv", d->shape_mode,
                          &d->shape_mode, NULL));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-dynamics_shape_amplitude", "its largest displacement, m",
                           d->shape_amplitude, &d->shape_amplitude, NULL));
  if (!d->shape[0])
    PetscCall(
      OptionsRefuse(d->comm, "-dynamics_shape_mode -dynamics_shape_amplitude", "not used without -dynamics_shape"));
  d->start = (DynamicsStart)start;
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsFiltersFromOptions(Dynamics d, OptionsItems PetscOptionsObject)
{
  PetscInt  modes[FILTERS_MOST] = {0}, n = FILTERS_MOST;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(OptionsGetPath(PetscOptionsObject, "-dynamics_filters",
                           "folder of a run of modes with -modes_filters: their amplitudes in amplitudes.csv",
                           d->filters_dir, NULL));
  PetscCall(OptionsCheckWords(PetscOptionsObject, "-dynamics_filters_modes", PETSC_TRUE));
  PetscCall(PetscOptionsIntArray("-dynamics_filters_modes", "their numbers in modes.csv, 0 for all unstable ones",
                                 "dynamics.h", modes, &n, &given));
  if (!d->filters_dir[0])
    PetscCall(OptionsRefuse(d->comm, "-dynamics_filters_modes", "not used without -dynamics_filters"));
  if (!given || (n == 1 && modes[0] == 0)) PetscFunctionReturn(0);
  d->filters.n = n;
  PetscCall(PetscMalloc1(n, &d->filters.mode));
  PetscCall(PetscArraycpy(d->filters.mode, modes, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode DynamicsRunFromOptions(Dynamics d, OptionsItems PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(
    OptionsGetBool(PetscOptionsObject, "-dynamics_coriolis", "Coriolis forces in parts that turn", &d->coriolis));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-dynamics_centrifugal", "centrifugal forces in parts that turn",
                           &d->centrifugal));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-contact_view_kkt",
                           "print the residuals of the contact laws at the end", &d->view_kkt));
  PetscCall(OptionsGetInt(PetscOptionsObject, "-dynamics_checkpoint_interval", "steps between checkpoints, 0 for none",
                          d->checkpoint_interval, &d->checkpoint_interval, NULL));
  PetscCall(OptionsGetInt(PetscOptionsObject, "-dynamics_check_interval",
                          "steps between looks at the laws by second paths, 0 for none", d->laws.interval,
                          &d->laws.interval, NULL));
  PetscCheck(d->laws.interval >= 0, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_check_interval %" PetscInt_FMT " must be a number of steps, 0 for none", d->laws.interval);
  PetscCheck(d->checkpoint_interval >= 0, d->comm, PETSC_ERR_USER_INPUT,
             "-dynamics_checkpoint_interval %" PetscInt_FMT " must be a number of steps, 0 for none",
             d->checkpoint_interval);
  PetscCall(OptionsGetBool(PetscOptionsObject, "-dynamics_restart", "go on from the checkpoint in the output folder",
                           &d->restart));
  PetscFunctionReturn(0);
}

PetscErrorCode DynamicsSetFromOptions(Dynamics d)
{
  PetscReal dt;
  PetscBool set, central;

  PetscFunctionBeginUser;
  PetscOptionsBegin(d->comm, NULL, "Dynamics", NULL);
  PetscCall(DynamicsStepFromOptions(d, PetscOptionsObject));
  PetscCall(DynamicsStartFromOptions(d, PetscOptionsObject));
  PetscCall(DynamicsFiltersFromOptions(d, PetscOptionsObject));
  PetscCall(DynamicsRunFromOptions(d, PetscOptionsObject));
  PetscOptionsEnd();
  PetscCall(TSSetFromOptions(d->ts));
  PetscCall(PetscObjectTypeCompare((PetscObject)d->ts, TSCENTRAL, &central));
  PetscCheck(central, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_type does not suit exact contact: leave it out, it is " TSCENTRAL);
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-ts_dt", &dt, &set));
  if (set) d->dt_asked = dt;
  if (set) PetscCall(OptionsRefuse(d->comm, "-ts_time_step", "the same as -ts_dt, which is given too; give one"));
  if (d->dt_asked > 0)
    PetscCall(OptionsRefuse(d->comm, "-dynamics_step_fraction",
                            set ? "not used beside -ts_dt" : "not used beside -ts_time_step"));
  if (d->dt_asked == 0) PetscCall(OptionsRefuse(d->comm, "-dynamics_step_force", "not used without a -ts_dt"));
  PetscCheck(!PetscIsInfOrNanReal(d->dt_asked) && d->dt_asked >= 0, d->comm, PETSC_ERR_USER_INPUT,
             "-ts_dt %.6g must be a positive time (s)", (double)d->dt_asked);
  PetscCall(TSCentralGetB(d->ts, &d->b));
  PetscCall(HistorySetFromOptions(d->history));
  if (d->external) PetscCall(ExternalSetFromOptions(d->external));
  if (d->projector) PetscCall(ContactProjectorSetFromOptions(d->projector));
  PetscCall(BodiesSetFromOptions(d->bodies));
  PetscFunctionReturn(0);
}
