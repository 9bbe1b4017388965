/* Private to sweep/: what a branch remembers while its mode cannot be told from others */
#pragma once

#include "match.h"

/* The last vectors of each branch from before its mode joined others in one cluster (lock-in, modes that meet) */
typedef struct {
  PetscComplex *x, *w; /* [N] */
  PetscReal     omega; /* rad/s */
  PetscBool     joined;
} Branch;

/* Branches first, first + 1, ... */
typedef struct {
  PetscInt first, n;
  Branch  *branch;
} BranchList;

/* branch.c - the branches of b from those of a, and new ones for modes without a partner */
PetscErrorCode BranchListBegin(BranchList *list, ModeFrame *frame);
PetscErrorCode BranchListContinue(BranchList *list, const ModeFrame *a, ModeFrame *b, Match *match);
PetscErrorCode BranchListDestroy(BranchList *list);
