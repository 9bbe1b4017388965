/* What happens at ^C and SIGTERM */
#pragma once

#include <petscsys.h>

/* Ends the program with one line from now on, where these signals are not ignored. Collective */
PETSC_INTERN PetscErrorCode InterruptInstall(MPI_Comm comm);

/* Gives the signals their default action back, before an error is printed */
PETSC_INTERN void InterruptRemove(void);

/* What the line says from now on of what is left, e.g. "4 points are kept"; printf-like. Not collective */
PETSC_INTERN void InterruptSays(const char format[], ...) PETSC_ATTRIBUTE_FORMAT(1, 2);

/* A file that goes where a signal ends the run; empty for none */
PETSC_INTERN void InterruptRemoves(const char path[]);
