/* For base/ and what is above it: which help is asked for, and options of PETSc and SLEPc */
#pragma once

#include <petscsys.h>

#define HELP_MAX_NAME 128

/* Answers -h, --help, -version and --version on rank 0; whether it did. MPI is up, PETSc need not be */
PETSC_INTERN PetscBool HelpAnswer(int argc, char *const argv[]);
/* Writes -help as -help_list, of which PETSc, which would print its own options, knows nothing */
PETSC_INTERN void HelpRename(int argc, char *argv[]);
/* What asks for the options: -help, -help_all, -help_json */
typedef enum { HELP_NONE, HELP_LIST, HELP_ALL, HELP_JSON } HelpKind;
/* Which of them is given, so that a scene need not be complete */
PETSC_INTERN PetscErrorCode HelpIsAsked(HelpKind *kind);
/* The same; where no scene is given, options of one with a name in each list. With -help_all each name is
   shown once until HelpShowLibraries() is off */
PETSC_INTERN PetscErrorCode HelpBegin(HelpKind *kind, PetscBool *example);
/* Whether objects of PETSc and SLEPc that read their options from now on print them */
PETSC_INTERN PetscErrorCode HelpShowLibraries(PetscBool on);

/* libraries.c - whether options of PETSc or SLEPc begin with the name and an underscore */
PETSC_INTERN PetscBool LibraryHasPrefix(const char name[]);
/* Whether an option is one of their solvers', read when the rooms read theirs */
PETSC_INTERN PetscBool LibraryIsSolvers(const char name[]);
/* Whether they may still read an option */
PETSC_INTERN PetscBool LibraryReadsLater(const char name[]);
/* Options of theirs for the nearest name to one, NULL behind the last */
PETSC_INTERN const char *LibraryName(size_t i);
