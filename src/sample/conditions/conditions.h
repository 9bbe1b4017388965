/* Private to sample/: conditions of a test, each a row of a file */
#pragma once

#include <petscsys.h>

#define CONDITIONS_MAX_BANDS 64

/* The file. Columns are numbers in units that their heads name ("pressure [bar]"), but for the name of the condition
   and the direction of the disc */
typedef struct {
  PetscInt     n, n_columns;
  char       **column;    /* [n_columns] names without their units */
  char       **head;      /* [n_columns] as they stand in the file */
  PetscReal   *unit;      /* [n_columns] of one unit in those of SI */
  const char **si;        /* [n_columns] that unit of SI, NULL without */
  PetscReal   *value;     /* [n][n_columns] as they stand in the file */
  PetscReal   *direction; /* [n] 1 forward, -1 reverse */
  PetscBool    reverses;  /* there is a column direction */
  char       **name;      /* [n] of the condition */
} ConditionTable;

/* A frequency band and what the conditions do in it */
typedef struct {
  PetscReal low, high;            /* Hz */
  PetscInt  n_conditions, n_open; /* in which some mode is unstable; in which the error leaves it open */
  PetscInt  n_modes, worst;       /* unstable modes; the condition of the fastest growth of them, -1 for none */
  PetscReal growth, frequency;    /* of that, 1/s and Hz */
} ConditionBand;

/* table.c - reads the file, alike on all ranks. Collective. Errors: PETSC_ERR_USER_INPUT with the file, its line and
   what is wrong */
PETSC_INTERN PetscErrorCode ConditionTableRead(MPI_Comm comm, const char file[], ConditionTable *table);
PETSC_INTERN PetscErrorCode ConditionTableDestroy(ConditionTable *table);
