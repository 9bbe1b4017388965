/* Private to the solvers: solutions with a mass matrix */
#pragma once

#include <petscmat.h>

/* M x = b by conjugate gradients and the diagonal of M, symmetric and positive definite, to 1e-13 of |b|. Collective.
   Errors: PETSC_ERR_NOT_CONVERGED, naming `what` is sought. */
PETSC_INTERN PetscErrorCode MassSolve(Mat M, Vec b, Vec x, const char what[]);
