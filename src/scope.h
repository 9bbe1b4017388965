/* Private to the chain: what an analysis has a use for, and who reads the options of the rest */
#pragma once

#include <squeal/options.h>
#include <squeal/squeal.h>

/* Who reads options */
typedef enum {
  READER_ANY,
  READER_STATICS,
  READER_MODES,
  READER_FACTOR,
  READER_ITERATIVE,
  READER_SWEEP,
  READER_FRF,
  READER_DYNAMICS,
  READER_MAP,
  READER_CYCLE,
  N_READERS
} Reader;

/* A run; model and contact are NULL for matrices without a mesh */
typedef struct {
  const char *analysis;
  PetscBool   modes, sweep, frf, transient /* and what is made of such runs */, map, cycle;
  Model       model;
  Contact     contact;
  Operators   operators;
  Modes       linear;
  Sweep       varied;
  Dynamics    dynamics;
  ReducedRun  reduced;
} Scope;

/* Raises an error for an option of the command line that a reader claimed of whom the run has no need. Collective. */
PETSC_INTERN PetscErrorCode ScopeCheck(MPI_Comm comm, const Scope *scope, OptionsClaims claims);

/* Says which things of the model the run does not use. Collective. */
PETSC_INTERN PetscErrorCode ScopeView(const Scope *scope, PetscViewer viewer);
