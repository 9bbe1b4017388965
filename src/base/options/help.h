/* For base/ and results/: what squeal says of itself and of its options */
#pragma once

#include <petscsys.h>

#define HELP_MAX_NAME 128

/* An option as -help shows it */
typedef struct {
  char      name[HELP_MAX_NAME]; /* without the dash */
  char      group[96];           /* title under which its owner reads it */
  char      value[128], initial[128], text[512];
  PetscBool own; /* of squeal, not of PETSc or SLEPc */
} HelpOption;

typedef struct {
  int         n, max;
  HelpOption *option;
} HelpList;

/* Answers -h, --help, -version and --version on rank 0; whether it did. MPI is up, PETSc need not be */
PETSC_INTERN PetscBool HelpAnswer(int argc, char *const argv[]);
/* Keeps PETSc from printing what it knows of -help at its start, which HelpPrint() does */
PETSC_INTERN void HelpHush(int argc, char *const argv[]);
/* What asks for the options: -help, -help_all, -help_json */
typedef enum { HELP_NONE, HELP_LIST, HELP_ALL, HELP_JSON } HelpKind;
/* Which of them is given, so that a scene need not be complete */
PETSC_INTERN PetscErrorCode HelpIsAsked(HelpKind *kind);
/* All options that read_again() reads, with values; n = 0 before, free list->option with free() */
PETSC_INTERN PetscErrorCode HelpCollect(MPI_Comm comm, PetscErrorCode (*read_again)(MPI_Comm, void *), void *ctx,
                                        HelpList *list);
/* unknown.c - whether options of PETSc or SLEPc begin with the name and an underscore */
PETSC_INTERN PetscBool UnknownIsLibrarysPrefix(const char name[]);
