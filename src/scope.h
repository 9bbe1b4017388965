/* Private to the chain: what a run does, and what of the scene it does not use */
#pragma once

#include <squeal/quantity.h>
#include <squeal/squeal.h>

/* What of the scene a run uses, as bits */
typedef enum {
  USES_LOADS    = 1,  /* and gravity, whether it finds an equilibrium or not */
  USES_PLACES   = 2,  /* probes and circles */
  USES_DAMPING  = 4,  /* dashpots, and that of the parts */
  USES_SPIN     = 8,  /* of the parts */
  USES_LAWS     = 16, /* of parts whose stiffness depends on the frequency; in statics their static one */
  USES_BRANCHES = 32, /* Maxwell branches of parts alone */
  USES_ALL      = 63,
} SceneUse;

/* A run; model and contact are NULL for matrices without a mesh */
typedef struct {
  Analysis   analysis;
  unsigned   does; /* RunBits of the analysis */
  unsigned   uses; /* its SceneUses */
  Model      model;
  Contact    contact;
  Operators  operators;
  Modes      linear;
  Statics    statics;
  Dynamics   dynamics;
  ReducedRun reduced;
  Results    results;
} Scope;

/* Raises an error for a material whose stiffness depends on the frequency, where the analysis would leave that out.
   Collective. */
PETSC_INTERN PetscErrorCode ScopeCheckLaws(MPI_Comm comm, const Scope *scope);
/* All that the run does. Collective. */
PETSC_INTERN PetscErrorCode ScopeGetRun(MPI_Comm comm, const Scope *scope, QuantityRun *run);

/* Whether friction of any contact asks for the areas of pairs, in time too. Not collective. */
PETSC_INTERN PetscErrorCode ScopeNeedsAreas(Contact contact, PetscBool *areas);

/* Says which things of the model the run does not use. Collective. */
PETSC_INTERN PetscErrorCode ScopeView(const Scope *scope, PetscViewer viewer);
