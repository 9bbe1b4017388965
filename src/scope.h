/* Private to the chain: what a run does, and what of the solvers of PETSc and of the scene it does not use */
#pragma once

#include <squeal/quantity.h>
#include <squeal/squeal.h>

/* A run; model and contact are NULL for matrices without a mesh */
typedef struct {
  Analysis   analysis;
  unsigned   does; /* RunBit of the analysis */
  Model      model;
  Contact    contact;
  Operators  operators;
  Modes      linear;
  Sweep      varied;
  Dynamics   dynamics;
  ReducedRun reduced;
  LimitCycle cycle;
  PetscBool  damps; /* a sweep varies what makes damping */
} Scope;

/* All that the run does. Collective. */
PETSC_INTERN PetscErrorCode ScopeGetRun(MPI_Comm comm, const Scope *scope, QuantityRun *run);

/* Raises an error for options of the command line of a solver that the run has no need of. Collective. */
PETSC_INTERN PetscErrorCode ScopeCheck(const Scope *scope, const QuantityRun *run);

/* Says which things of the model the run does not use. Collective. */
PETSC_INTERN PetscErrorCode ScopeView(const Scope *scope, PetscViewer viewer);
