/* For the rows of what concerns every room: what base/ is told */
#pragma once

#include <petscsys.h>

/* Shows PETSc's traceback of an error before the line that a user sees */
PETSC_INTERN void SquealTrace(PetscBool trace);
/* Says what gives options to a run that is not on its command line; scene.yaml has them. Collective */
PETSC_INTERN PetscErrorCode SquealSayEnvironment(MPI_Comm comm);
