/* Private to solver/ and modes/: an eigensolver of SLEPc's that applies its operator to blocks of vectors */
#pragma once

#include <squeal/quantity.h>
#include <slepceps.h>

#define EPSBLOCKKRYLOVSCHUR "blockkrylovschur"
#define BLOCKKRYLOV_SIZE    "-eps_blockkrylovschur_size"

/* Makes -eps_type blockkrylovschur known to SLEPc. Call once after SlepcInitialize(). Not collective.

   Block Krylov-Schur with thick restart and locking for the problem types HEP, GHEP, NHEP and GNHEP in real arithmetic:
   eigenpairs as those of krylovschur, residuals measured in the same way, at a cost that is matrix-matrix products and
   solves with many right-hand sides. An iteration fills the space once. It ends with EPS_DIVERGED_BREAKDOWN where there
   are no more finite eigenvalues.

   BlockKrylovSetReach() ends a solution as soon as all out to a distance from the target have converged, though these
   be less than were asked for. BlockKrylovSetOther() solves K x = kappa M x and K' y = kappa M' y at once: two spaces
   that have nothing in common but the calls in which their systems are solved, with twice as many right-hand sides.

   Options: -eps_blockkrylovschur_size b: vectors in a block, at most the unknowns (0: 8, or 4 of each of two problems
   at once, less in a smaller space or problem); all of EPS but balancing, regions, two-sided, true residuals, and
   orders other than by magnitude. */
PETSC_INTERN PetscErrorCode BlockKrylovRegister(void);

/* Reads and checks its options, also where the run has another type. Collective. */
PETSC_INTERN PetscErrorCode BlockKrylovReadOptions(MPI_Comm comm);
/* Shows its rows; `why` the run has another type, or NULL. Collective. */
PETSC_INTERN PetscErrorCode BlockKrylovVisit(const QuantityVisitor *visitor, const char why[]);

/* Vectors in a block of a solver that is set up, 1 for another type */
PETSC_INTERN PetscErrorCode BlockKrylovGetBlock(EPS eps, PetscInt *block);

/* At least so many vectors in a block, where none are asked for by option: as many equal eigenvalues as a block has
   vectors are found for certain, more of them by rounding alone. Not collective. */
PETSC_INTERN PetscErrorCode BlockKrylovSetLeast(EPS eps, PetscInt least);

/* The solution ends where all that lies within the distance from the target has converged: the next Ritz value is known
   well enough to lie beyond it. Not collective. Another type has no reach. */
PETSC_INTERN PetscErrorCode BlockKrylovSetReach(EPS eps, PetscReal reach);
/* Whether it ended so */
PETSC_INTERN PetscErrorCode BlockKrylovReached(EPS eps, PetscBool *reached);

/* Vector of eigenpair i of a solution, complex where *xi is not NULL, for the caller to destroy: copies, or of
   this type the columns of its basis themselves, which they keep: no more memory as long as the solver is there, more
   afterwards. Then call once for each i. Collective. */
PETSC_INTERN PetscErrorCode BlockKrylovTakeVector(EPS eps, PetscInt i, PetscBool copy, Vec *xr, Vec *xi);

/* X := A^-1 X for the first n_right columns and A^-T X for the others */
typedef PetscErrorCode (*BlockKrylovSolve)(void *ctx, PetscInt n_right, Mat X);

/* EPSSolve(right) lets the space of `left`, of the transposed problem, grow along with its own: `left` is as far then
   as its own EPSSolve() finds it, which must follow. Both are of this type, generalised problems of the same target by
   shift-and-invert; nothing is done else, paired says so. Collective. */
PETSC_INTERN PetscErrorCode BlockKrylovSetOther(EPS right, EPS left, BlockKrylovSolve solve, void *ctx,
                                                PetscBool *paired);
