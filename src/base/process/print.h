/* Private to base/: what squeal prints also goes to a log file, and never into a progress line */
#pragma once

#include <petscsys.h>

/* Stands between PETSc's printers and the files from now on */
PETSC_INTERN void PrintInstall(void);
/* Copies all that is printed from now on to a file, on the first rank; once; makes its folder. Errors:
   PETSC_ERR_FILE_OPEN, also where a file is there that is no log. Collective */
PETSC_INTERN PetscErrorCode PrintSetLog(MPI_Comm comm, const char file[]);
/* Prints on stderr and into the log, also where PETSC is at its end */
PETSC_INTERN void PrintError(const char message[]);
/* Writes a line on stderr and into the log from within a signal handler */
PETSC_INTERN void PrintAtOnce(const char line[]);
/* Closes the log; false where not all of it came to the disk */
PETSC_INTERN PetscBool PrintEnd(void);
