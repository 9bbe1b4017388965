/* Private to operators/: the fill-reducing order "metis" */
#pragma once

#include <petscmat.h>

#define ORDERING_METIS "metis"

/* Makes -pc_factor_mat_ordering_type metis known to PETSc: for LU by MUMPS on one rank, without effect elsewhere.
   Call once after PetscInitialize(). Not collective. */
PETSC_INTERN PetscErrorCode OrderingRegister(void);
