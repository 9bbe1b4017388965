/* Private: an error that some ranks find is raised by all */
#pragma once

#include <petscsys.h>

#define FAULT_TEXT 1024

/* What a rank found wrong; code 0 = nothing */
typedef struct {
  PetscErrorCode code;
  char           text[FAULT_TEXT];
} Fault;

/* FaultNote - keeps the first fault of this rank, printf-like. Not collective. */
PETSC_INTERN PetscErrorCode FaultNote(Fault *fault, PetscErrorCode code, const char format[], ...)
  PETSC_ATTRIBUTE_FORMAT(3, 4);

/* FaultsAgree - gives all ranks the fault of the lowest rank that has one. Collective. */
PETSC_INTERN PetscErrorCode FaultsAgree(MPI_Comm comm, Fault *fault);

/* FaultsRaise - raises that fault on all ranks. Collective. */
PETSC_INTERN PetscErrorCode FaultsRaise(MPI_Comm comm, Fault *fault);
