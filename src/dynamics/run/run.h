/*
   Run (private to dynamics/ and to rooms that integrate the same scenes by other means) - what the options of a
   transient ask for, and the histories that record it.
*/
#pragma once

#include <squeal/dynamics.h>
#include "dynamics/external/external.h"
#include "dynamics/history/history.h"
#include "results/journal/journal.h"

#define CHECKPOINT_FILE "checkpoint.bin"
/* The checkpoints of a Dynamics or of a ReducedRun, once the checksum of their scene is made */
#define CHECKPOINTS(r) ((Journal){(r)->comm, (r)->results, (r)->scene, "-dynamics_restart", NULL})

/* All borrowed */
typedef struct {
  Model                   model;
  Contact                 contact;
  PetscInt                n_interfaces;
  const ContactInterface *interfaces;
  Operators               operators;
  Statics                 statics;
  External                external;  /* not set up: ramps, impulses, velocities at the start */
  ContactProjector        projector; /* not set up: the ramps of sliding; NULL without contacts */
  History                 history;
  PetscReal               dt, end; /* s */
  PetscInt                n_steps; /* at most */
  PetscInt                checkpoint_interval;
  PetscBool               from_static, restart, view_kkt;
} DynamicsRun;

/* DynamicsGetRun - begins a run of the same scene that the caller integrates: step `dt` where -ts_dt does not say one,
   DynamicsCheckEarlier() done. Collective. Errors: PETSC_ERR_USER_INPUT as of DynamicsSolve(), and for options that
   belong to the explicit integrator alone, which `by` names as the option that leaves them without effect. */
PETSC_INTERN PetscErrorCode DynamicsGetRun(Dynamics dynamics, Results results, const char by[], PetscReal dt,
                                           DynamicsRun *run);

/* DynamicsCheckBolts - raises the error for bolts under a tension where no sliding state tells their shortening. */
PETSC_INTERN PetscErrorCode DynamicsCheckBolts(Dynamics dynamics);

/* DynamicsCheckExact - raises the error for contacts with a penalty law, which a start in the sliding state has and
   exact contact has not. Collective. */
PETSC_INTERN PetscErrorCode DynamicsCheckExact(Dynamics dynamics);

/* DynamicsSetEndless - the caller takes the scene and the step, and integrates nothing from a beginning to an end: none
   is asked for, and the run's is 0. Not collective. */
PETSC_INTERN PetscErrorCode DynamicsSetEndless(Dynamics dynamics);

/* DynamicsCheckTimes - what steps dt, s, do not see of histories (ExternalCheckSteps()); what comes after the end of
   the run: ExternalCheckLate(), sliding that begins there, and an interval of checkpoints that is longer than the run,
   an error of the command line. Collective. */
PETSC_INTERN PetscErrorCode DynamicsCheckTimes(Dynamics dynamics, PetscReal end, PetscReal dt);

/* DynamicsGetStep - step and end of a run whose caller takes another `dt` where -ts_dt does not say one. Collective. */
PETSC_INTERN PetscErrorCode DynamicsGetStep(Dynamics dynamics, PetscReal dt, DynamicsRun *run);

/* DynamicsGetShape - what -dynamics_shape adds to the start at the local nodes: displacements and velocities,
   [nodes][3], m and m/s; zeros without. Collective. */
PETSC_INTERN PetscErrorCode DynamicsGetShape(Dynamics dynamics, PetscReal u[], PetscReal v[]);

/* DynamicsWriteImpulses - impulses.csv of a run that is over, and in words whether the response is linear: sums over
   the interfaces, and when each impulse acted, s, negative where it did not. Collective. */
PETSC_INTERN PetscErrorCode DynamicsWriteImpulses(Dynamics dynamics, const ContactSums sums[], const PetscReal time[]);

/* DynamicsAddRunChecksum - what a run must share with the one that it goes on with, but for what concerns the
   integrator. Collective. */
PETSC_INTERN PetscErrorCode DynamicsAddRunChecksum(Dynamics dynamics, Checksum checksum);

/* DynamicsForget - takes away the checkpoint of an earlier run, whose tables a run that starts anew replaces: nothing
   must go on from it with these. Collective. */
PETSC_INTERN PetscErrorCode DynamicsForget(Dynamics dynamics);

/* LedgerView - the balance in words, J */
PETSC_INTERN PetscErrorCode LedgerView(const Ledger *ledger, PetscViewer viewer);
