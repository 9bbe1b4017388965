/* Progress on stderr, for all rooms */
#pragma once

#include <petscsys.h>

/* A loop: what is done, of how much, and since when; what = NULL shows nothing */
typedef struct {
  const char    *what;
  PetscInt       done, expected;
  PetscLogDouble begun;
} Progress;

/* Whether and how progress shows in this run: as told, else where stderr is a terminal */
PETSC_INTERN PetscErrorCode ProgressShow(MPI_Comm comm, PetscBool given, PetscBool show);
/* Tells which stage of the flow begins */
PETSC_INTERN PetscErrorCode ProgressStage(const char name[]);
PETSC_INTERN PetscErrorCode ProgressBegin(Progress *progress, const char what[], PetscInt expected);
PETSC_INTERN PetscErrorCode ProgressStep(Progress *progress);
PETSC_INTERN PetscErrorCode ProgressEnd(Progress *progress);
