/* Private to dynamics/: the record of a run and the files that fill it */
#pragma once

#include <squeal/dynamics.h>
#include <squeal/options.h>
#include <squeal/projector.h>
#include <squeal/quantity.h>
#include "dynamics/external/external.h"
#include "dynamics/history/history.h"
#include "dynamics/central/tscentral.h"
#include "dynamics/run/run.h"

#define FILTERS_MOST 256 /* modes of -dynamics_filters_modes */

typedef enum { START_REST, START_STATIC, N_STARTS } DynamicsStart;

/* The largest stable steps, s */
typedef struct {
  PetscReal assembled; /* by Lanczos iteration on the assembled model */
  PetscReal element;   /* of the stiffest element alone: below the assembled one */
  PetscInt  its;       /* eigenproblems solved */
} CriticalStep;

/* Nodes of the contact surfaces; arrays have n * 3 Cartesian components, filled at the nodes of active pairs only */
typedef struct {
  PetscInt        n;          /* nodes */
  const PetscInt *vertex;     /* [n] local nodes from 0 */
  PetscReal      *u;          /* [n][3] displacements, m */
  PetscReal      *before, *v; /* [n][3] velocities v_{n-1/2}, and v_{n+1/2} as predicted without contact, m/s */
  PetscReal      *force;      /* [n][3] forces on the nodes, N */
} DynamicsSurface;

struct _p_Dynamics {
  MPI_Comm                comm;
  Model                   model;
  Contact                 contact;
  PetscInt                n_interfaces;
  const ContactInterface *interfaces;
  /* set by options */
  PetscReal     fraction, dt_asked; /* of the critical step; -ts_dt, 0 for none */
  PetscBool     dt_given;           /* by -ts_dt, which goes before -ts_time_step */
  PetscBool     step_force, coriolis, centrifugal, view_kkt, restart;
  DynamicsStart start;
  char          shape[PETSC_MAX_PATH_LEN]; /* folder of a run of modes; empty for none */
  PetscInt      shape_mode, checkpoint_interval;
  PetscReal     shape_amplitude, b;
  char          filters_dir[PETSC_MAX_PATH_LEN]; /* folder of a run of modes; empty for none */
  PetscInt      asked[FILTERS_MOST], n_asked;    /* its modes that are named */
  /* children */
  Operators        operators;
  Statics          statics;
  TS               ts;
  Bodies           bodies;
  External         external;
  ContactProjector projector; /* NULL without contacts */
  History          history;
  HistoryFilters   filters;
  Results          results;
  /* state and work */
  const Layout *layout;
  Vec        u, v, minv; /* displacements, m; velocities, m/s; inverse masses, 1/kg; length and order of the layout */
  PetscReal *ku;         /* K u of this rank's cells, N */
  DynamicsSurface surface;
  ContactSums    *sums; /* [interfaces] */
  LedgerAccount   ledger;
  const Mesh     *mesh;
  CriticalStep    critical;
  Checksum        scene; /* for checkpoints; NULL until one is met */
  /* statistics */
  PetscInt       n_elements, n_steps; /* of this call */
  PetscLogDouble seconds;
  PetscBool      stopped; /* by a signal */
  PetscBool      endless; /* no end is asked for: nothing is integrated up to one */
  PetscBool      ended;   /* all steps are done: the last balance is due */
};

/* quantities.c - rows of the options */
extern const QuantityTable dynamics_quantities;

/* run/run.c - when the run ends, s; the step is at most as long, and divides it where the run shall end exactly there.
   Errors: PETSC_ERR_USER_INPUT for an end that is none, and for a -ts_dt beyond it. Collective. */
PETSC_INTERN PetscErrorCode DynamicsFitEnd(Dynamics dynamics, PetscReal *dt, PetscReal *end);

/* forces.c - callbacks of the TS: forces, contact, and what is recorded when they are complete */
PETSC_INTERN PetscErrorCode DynamicsForce(TS ts, const CentralStep *step, void *ctx);
PETSC_INTERN PetscErrorCode DynamicsConstrain(TS ts, const CentralStep *step, void *ctx);

/* criticalstep.c - the critical steps of the bodies */
PETSC_INTERN PetscErrorCode DynamicsFindCriticalStep(Dynamics dynamics);

/* impulses.c - where an impulse acts in this step: counts from now on what it changes at the contacts; at the end, says
   so. Report is collective. */
PETSC_INTERN PetscErrorCode DynamicsMarkImpulse(Dynamics dynamics);
PETSC_INTERN PetscErrorCode DynamicsReportImpulses(Dynamics dynamics);

/* turningframe.c - inertial forces in parts that turn */
PETSC_INTERN PetscErrorCode DynamicsSetFrames(Dynamics dynamics);

/* statevector.c - between vectors of all unknowns and state vectors (held directions 0, or of displacements what
   motions prescribe there) */
PETSC_INTERN PetscErrorCode StateVectorFromVec(Model model, const Layout *layout, Vec x, PetscReal state[]);
PETSC_INTERN PetscErrorCode StateVectorFromDisplacements(Model model, const Layout *layout, Vec u, PetscReal state[]);
PETSC_INTERN PetscErrorCode StateVectorToVec(Model model, const Layout *layout, const PetscReal state[], Vec x);

/* start/state.c - displacements and velocities at the start; raises errors for what a static start has no place for */
PETSC_INTERN PetscErrorCode DynamicsCheckStatic(Dynamics dynamics);
PETSC_INTERN PetscErrorCode DynamicsStartState(Dynamics dynamics);

/* filters.c - modal filters of -dynamics_filters for the history, which solves the sliding state; frees them */
PETSC_INTERN PetscErrorCode DynamicsSetFilters(Dynamics dynamics);
PETSC_INTERN PetscErrorCode DynamicsDestroyFilters(Dynamics dynamics);

/* run/keep.c - checkpoints */
PETSC_INTERN PetscErrorCode DynamicsKeep(Dynamics dynamics);
PETSC_INTERN PetscErrorCode DynamicsGoOn(Dynamics dynamics);

/* raises an error where that would lose the checkpoint of an unfinished run, or a file that is not squeal's.
   Collective. */
PETSC_INTERN PetscErrorCode DynamicsCheckEarlier(Dynamics dynamics);
