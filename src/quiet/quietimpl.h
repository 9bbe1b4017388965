/* Private to quiet/: its record */
#pragma once

#include <squeal/quiet.h>
#include "quiet/cell/frame.h"
#include "sweep/box/box.h"
#include "sweep/full/compare.h"

/* What is looked for: the largest box about the scene's own values, or all quiet parts of the one that is given */
typedef enum { QUIET_BOX, QUIET_PARTS } QuietGoal;

typedef enum { CELL_OPEN, CELL_QUIET, CELL_DANGEROUS } CellState;

/* A part of the box, and what is known of it */
typedef struct {
  PetscReal low[CUBE_MAX_VARIABLES], high[CUBE_MAX_VARIABLES]; /* in t */
  CellState state;
  PetscBool split;    /* it is replaced by its halves */
  PetscInt  axis;     /* where to cut it */
  PetscReal near;     /* CubeNear() */
  PetscReal margin;   /* rad/s, where it is quiet */
  PetscReal error;    /* estimated, relative, in its middle */
  PetscReal growth;   /* of the fastest growing mode of the band in its middle, 1/s; NaN for none */
  PetscBool unstable; /* in its middle */
} QuietCell;

/* A point with a mode that grows */
typedef struct {
  PetscReal t[CUBE_MAX_VARIABLES], distance;
  PetscReal sigma, omega, error; /* rad/s, of the reduced model */
  PetscBool found, confirmed, other; /* other: its full solution has another contact status */
  PetscReal full_sigma, full_omega, full_error; /* of the full solution there; NaN: no mode of it grows */
  char      label[32];
} DangerPoint;

/* Random points within what is said to be quiet */
typedef struct {
  PetscInt  n, n_unstable, n_full, n_full_unstable, n_beyond;
  PetscInt  n_full_other; /* of n_full, with another contact status, which errors and n_beyond leave out */
  PetscReal growth, full_growth; /* largest, 1/s */
  PetscReal error, true_error;   /* largest relative: estimated, and beside full solutions */
} QuietChecks;

struct _p_Quiet {
  MPI_Comm  comm;
  Operators operators;
  Box       box;
  /* set by options */
  CubeOptions options;
  QuietGoal   goal;
  PetscInt    max_cells, n_random, n_verify, seed;
  PetscReal   tolerance;
  char        varied[CUBE_MAX_TEXT];
  /* results */
  Cube           cube;
  PetscBool      exact; /* coefficients have bounds */
  PetscInt       n_cells, n_room, n_tested;
  QuietCell     *cell;
  PetscReal      size;     /* of the largest box that is shown to be quiet, beside the one given */
  PetscReal      margin;   /* least of its cells, rad/s */
  PetscReal      error;    /* largest of all middles */
  PetscReal      share[3]; /* of the volume, by CellState */
  DangerPoint    danger;   /* the nearest */
  PetscInt       n_status, n_other, apart; /* points of the box whose status was looked at, those with another one than
                                              the scene's own values, most pairs of such a one */
  PetscReal      other_distance;           /* of the nearest of these, as CubeDistance() */
  QuietChecks    checks;
  PetscLogDouble seconds[4]; /* basis, cells, danger, checks */
};

extern const QuantityTable quiet_quantities;

/* search.c - cells, and what they show */
PETSC_INTERN PetscErrorCode QuietSearch(Quiet quiet);
/* danger.c - the model's modes at t: the one of the band that exceeds the limit most, and the largest estimated error.
   Not collective */
PETSC_INTERN PetscErrorCode QuietLook(Quiet quiet, const PetscReal t[], DangerPoint *point, PetscReal *worst,
                                      PetscBool *unstable);
/* Makes of an unstable point one on the way to the scene's own values, if there is one. Not collective */
PETSC_INTERN PetscErrorCode QuietNearer(Quiet quiet, DangerPoint *point);
/* The nearest of the points of all ranks becomes that of all, where it is nearer than what is known. Collective */
PETSC_INTERN PetscErrorCode QuietShareNearest(Quiet quiet, const DangerPoint *point, PetscBool *nearer);
/* Looks at scattered points; then, from the nearest that is known, along the surface. Collective */
PETSC_INTERN PetscErrorCode QuietProbe(Quiet quiet);
PETSC_INTERN PetscErrorCode QuietRefine(Quiet quiet);
/* The full solution there. Collective */
PETSC_INTERN PetscErrorCode QuietConfirm(Quiet quiet);
/* check.c - random points */
PETSC_INTERN PetscErrorCode QuietCheck(Quiet quiet);
