/* Private to modes/ and sweep/: the progress line */
#pragma once

#include <petscsys.h>

/* Progress line on stderr: what is done, of how much, and the time left */
typedef struct {
  PetscBool      on, shown;
  const char    *what;
  PetscInt       done, expected;
  PetscLogDouble begun;
} Progress;

PETSC_INTERN PetscErrorCode ProgressSetFromOptions(MPI_Comm comm, Progress *progress);
PETSC_INTERN PetscErrorCode ProgressBegin(Progress *progress, const char what[], PetscInt expected);
PETSC_INTERN PetscErrorCode ProgressStep(Progress *progress);
PETSC_INTERN PetscErrorCode ProgressEnd(Progress *progress);
