/* Private to base/: memory that may not be had */
#pragma once

#include <petscsys.h>

/* Takes the buffer of BLAS where the address space is bounded. Errors: PETSC_ERR_USER_INPUT where that leaves none. */
PETSC_INTERN PetscErrorCode MemoryPrepare(MPI_Comm comm);

/* Writes what is to be done when an allocation has failed; allocates nothing */
PETSC_INTERN void MemoryExplain(char message[], size_t size);
