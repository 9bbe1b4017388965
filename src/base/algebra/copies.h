/* Iterations on copies of one problem, one on each rank, with operators that all ranks apply together */
#pragma once

#include <petscksp.h>

/* The first rank's test of convergence is that of all: none goes on alone, also where processors of two kinds round
   differently. ksp is of one rank; collective on comm in each iteration. */
PETSC_INTERN PetscErrorCode CopiesEndTogether(MPI_Comm comm, KSP ksp);
