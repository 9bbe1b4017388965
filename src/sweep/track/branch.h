/* Private to sweep/: what a branch remembers while its mode cannot be told from others */
#pragma once

#include "match.h"

/* The last vectors of each branch from before its mode joined others in one cluster (lock-in, modes that meet) */
typedef struct {
  PetscComplex *x, *y, *w; /* [N], w = B' y; NULL for a branch that has ended */
  PetscComplex  lambda;    /* rad/s */
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
/* The same where nothing but the point a and a memory is there; those below n_branches that are not at a have ended.
   The memory of b is appended to one with room for it. */
PetscErrorCode BranchListResume(BranchList *list, PetscInt n_branches, const ModeFrame *a, const BranchMemory *memory);
PetscErrorCode BranchListSave(const BranchList *list, const ModeFrame *b, BranchMemory *memory);
PetscErrorCode BranchListDestroy(BranchList *list);
