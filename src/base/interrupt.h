/* What happens at ^C and SIGTERM */
#pragma once

#include <petscsys.h>

/* Ends the program with one line from now on, where these signals are not ignored. Collective */
PETSC_INTERN PetscErrorCode InterruptInstall(MPI_Comm comm);

/* Gives the signals their default action back, before an error is printed */
PETSC_INTERN void InterruptRemove(void);

/* A file that goes where a signal ends the run; empty for none */
PETSC_INTERN void InterruptRemoves(const char path[]);
