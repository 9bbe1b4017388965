/* Private to sweep/: one line of the grid while it is worked on */
#pragma once

#include "sweepimpl.h"

/* The places of a line, their modes and branches */
typedef struct {
  PetscInt      n, first; /* places; index of the first of them in the grid */
  PetscReal    *value;    /* [n] of the first parameter */
  PetscReal    *p;        /* [n][n_parameters] */
  ReducedModes *modes;    /* [n] */
  PetscInt    **branch;   /* [n][modes]; -1 where branches are not followed */
  /* of a sweep in full or on real modes, which has no vectors after its points; else NULL */
  BranchName **name; /* [n][modes] */
} LinePoints;

/* line.c - a line without its modes; names of the branches and the records of the points, numbers from first_new on and
   events from first_event on being of this line */
PETSC_INTERN PetscErrorCode LineCreate(Sweep sweep, PetscInt line, LinePoints *points);
PETSC_INTERN PetscErrorCode LineFinish(Sweep sweep, PetscInt first_new, PetscInt first_event, LinePoints *points);
PETSC_INTERN PetscErrorCode LineDestroy(LinePoints *points);

/* segment.c - follows the branches along the line, from one change of contact status to the next, and across it.
   Not collective. */
PETSC_INTERN PetscErrorCode LineTrackSegments(Sweep sweep, LinePoints *points);
/* Gives branch b >= first_new the number rename[b - first_new] at places before last and in the events from
   first_event on; those for which that is -1 are numbered from first_new on, in their order */
PETSC_INTERN PetscErrorCode LineRename(Sweep sweep, PetscInt first_new, PetscInt rename[], PetscInt last,
                                       PetscInt first_event, LinePoints *points);
