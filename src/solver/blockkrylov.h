/* Private to modes/: an eigensolver of SLEPc's that applies its operator to blocks of vectors */
#pragma once

#include <slepceps.h>

#define EPSBLOCKKRYLOVSCHUR "blockkrylovschur"
#define BLOCKKRYLOV_SIZE    "-eps_blockkrylovschur_size"

/* Makes -eps_type blockkrylovschur known to SLEPc. Call once after SlepcInitialize(). Not collective.

   Block Krylov-Schur with thick restart and locking for the problem types HEP, GHEP, NHEP and GNHEP in real arithmetic:
   eigenpairs as those of krylovschur, residuals measured in the same way, at a cost that is matrix-matrix products and
   solves with many right-hand sides. An iteration fills the space once. It ends with EPS_DIVERGED_BREAKDOWN where there
   are no more finite eigenvalues.

   Options: -eps_blockkrylovschur_size b: vectors in a block, at most the unknowns (0: 8, less in a smaller space or
   problem); all of EPS but balancing, regions, two-sided, true residuals, and orders other than by magnitude. */
PETSC_INTERN PetscErrorCode BlockKrylovRegister(void);

/* Vectors in a block of a solver that is set up, 1 for another type */
PETSC_INTERN PetscErrorCode BlockKrylovGetBlock(EPS eps, PetscInt *block);
