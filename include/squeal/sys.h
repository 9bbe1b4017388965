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
  SQUEAL_FRF,
  SQUEAL_DYNAMICS,
  SQUEAL_RESULTS,
  SQUEAL_N_STAGES
} SquealStage;

/* Versions of the program and of what it stands on */
typedef struct {
  char squeal[32], petsc[32], slepc[32], mumps[32], blas[64], mpi[MPI_MAX_LIBRARY_VERSION_STRING];
} SquealVersions;

/*@ SquealGetVersions - e.g. "3.18.5"; of OpenBLAS also its kernels, by which results differ in rounding. Not
   collective; MPI must be up. @*/
void SquealGetVersions(SquealVersions *versions);

/*@
   SquealInitialize - starts MPI, PETSc and SLEPc, with one-line error messages, log stages and the citation.
   Collective.

   Input Parameter:
.  help - text of a program of one's own for PETSc's -help; NULL for squeal itself, where -h, --help, -version and
          --version are answered here and end the program with status 0

   Errors: an options file that cannot be read.
@*/
PetscErrorCode SquealInitialize(int *argc, char ***argv, const char help[]);

/*@ SquealViewUsage - prints a few lines for a command line without any options. Collective. @*/
PetscErrorCode SquealViewUsage(MPI_Comm comm);

/*@
   SquealSetFromOptions - what concerns every room. Collective.

   Options are the rows of src/quantity/settings.c.

   Errors: PETSC_ERR_FILE_OPEN for a log that cannot be written, or would replace a file that is no log.
@*/
PetscErrorCode SquealSetFromOptions(MPI_Comm comm);

/*@ SquealStageBegin - enters a stage of the flow; time and memory are kept for SquealViewStages(). Collective. @*/
PetscErrorCode SquealStageBegin(SquealStage stage);

/*@ SquealStageEnd - leaves it. Collective. @*/
PetscErrorCode SquealStageEnd(SquealStage stage);

/* What a stage took: seconds of the slowest rank, memory at its end summed over the ranks */
typedef struct {
  const char *name;
  double      seconds, megabytes;
} SquealStageCost;

/*@ SquealGetStages - cost [SQUEAL_N_STAGES] of the n stages that were entered. Collective. @*/
PetscErrorCode SquealGetStages(MPI_Comm comm, PetscInt *n, SquealStageCost cost[]);

/*@ SquealGetPeak - the most memory that the ranks had at any time of the run, each at its own, MB in all. Collective.
   @*/
PetscErrorCode SquealGetPeak(MPI_Comm comm, double *megabytes);

/*@ SquealViewStages - prints time (s, slowest rank) and memory (MB, sum of ranks) of each stage, and the most that
   there was. Collective. @*/
PetscErrorCode SquealViewStages(MPI_Comm comm, PetscViewer viewer);

/*@ SquealFinalize - ends all ranks; returns the exit status of the program: 0 when error is 0, else 1. Collective; when
    other ranks are not on their way here (an error of one rank) they are aborted. @*/
int SquealFinalize(PetscErrorCode error);
