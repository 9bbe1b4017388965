/*
   sys - the life cycle of the program and its log stages (-log_view reports time and memory of each).
*/
#pragma once

#include <petscsys.h>

/* Stages of the flow, registered by SquealInitialize() */
typedef enum {
  SQUEAL_MODEL,
  SQUEAL_CONTACT,
  SQUEAL_OPERATORS,
  SQUEAL_STATICS,
  SQUEAL_MODES,
  SQUEAL_SWEEP,
  SQUEAL_DYNAMICS,
  SQUEAL_RESULTS,
  SQUEAL_N_STAGES
} SquealStage;

/*@
   SquealInitialize - starts MPI, PETSc and SLEPc, with one-line error messages, log stages and the citation.
   Collective.

   Errors: an options file that cannot be read.
@*/
PetscErrorCode SquealInitialize(int *argc, char ***argv, const char help[]);

/*@
   SquealSetFromOptions - what concerns every room. Collective.

   Options Database Key:
.  -squeal_traceback - shows PETSc's traceback of an error, on each rank that meets it, before the line that a user sees
@*/
PetscErrorCode SquealSetFromOptions(MPI_Comm comm);

/*@ SquealStageBegin - enters a stage of the flow; time and memory are kept for SquealViewStages(). Collective. @*/
PetscErrorCode SquealStageBegin(SquealStage stage);

/*@ SquealStageEnd - leaves it. Collective. @*/
PetscErrorCode SquealStageEnd(SquealStage stage);

/*@ SquealViewStages - prints time (s, slowest rank) and memory (MB, sum of ranks) of each stage. Collective. @*/
PetscErrorCode SquealViewStages(MPI_Comm comm, PetscViewer viewer);

/*@ SquealFinalize - ends all ranks; returns the exit status of the program: 0 when error is 0, else 1. Collective; when
    other ranks are not on their way here (an error of one rank) they are aborted. @*/
int SquealFinalize(PetscErrorCode error);
