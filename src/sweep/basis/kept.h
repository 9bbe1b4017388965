/* Private to the rooms that have a basis of a sweep: the full solutions behind it in files */
#pragma once

#include "greedy.h"
#include "results/journal/journal.h"

/* What is kept, all borrowed, and how much of it is */
typedef struct {
  const Journal *journal;
  Basis         *basis;
  Greedy        *greedy;
  const char    *begin;           /* of the files' names */
  PetscInt       n_files, n_kept; /* files, vectors in them */
} BasisKept;

/* Takes up what an earlier run kept, and makes the greedy choice keep what comes. Collective. */
PETSC_INTERN PetscErrorCode BasisResume(BasisKept *kept);
/* <begin>_restart_<k> */
PETSC_INTERN PetscErrorCode BasisKeptName(const char begin[], PetscInt k, char name[64]);
/* Columns first .. n - 1 of vectors to or from values */
PETSC_INTERN PetscErrorCode BasisVectorsMove(BV vectors, PetscInt first, PetscInt n, PetscBool read,
                                             PetscReal values[]);
