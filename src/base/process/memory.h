/* Private to base/ and what sets it: memory that may not be had */
#pragma once

#include <petscsys.h>

/* Takes the buffer of BLAS where the address space is bounded. Errors: PETSC_ERR_USER_INPUT where that leaves none. */
PETSC_INTERN PetscErrorCode MemoryPrepare(MPI_Comm comm);

/* Writes what is to be done when an allocation has failed; allocates nothing */
PETSC_INTERN void MemoryExplain(char message[], size_t size);

/* The most bytes that this process had at any time */
PETSC_INTERN double MemoryPeak(void);

/* Gives freed memory back to the system, which the C library keeps otherwise */
PETSC_INTERN void MemoryReturn(void);

/* What factors and models may take on one machine, MB; 0: what is free */
PETSC_INTERN PetscErrorCode MemoryAllow(MPI_Comm comm, PetscReal megabytes);
/* MB that factors or models may take on this machine, all ranks there together: -squeal_memory where given, else what
   is free, infinite where nothing tells */
PETSC_INTERN double MemoryRoom(PetscBool *given);
/* Ranks of the whole run on this machine. Not collective. */
PETSC_INTERN int MemoryRanks(void);
