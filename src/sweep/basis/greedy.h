/* Private to sweep/: which points are solved in full, and when the basis is good enough */
#pragma once

#include "correct.h"
#include "points.h"
#include <squeal/modes.h>

#define GREEDY_LOOKS 4         /* points looked at with the factors of another, beside those of a full solution */
#define LOOK_MOST    24        /* over a box, whatever they find */
#define GREEDY_SAFE  (1. / 30) /* of rtol at corrected points: a tenth of what POINTS_MARGIN leaves of it at others */

/* A full solution */
typedef struct {
  PetscReal *p;         /* [n_parameters] */
  PetscBool  krylov;    /* by the eigensolver from nothing; else by corrections from the basis */
  PetscInt   n_vectors; /* gained */
  PetscBool  factored;  /* by corrections with the factors of this point; else those of one before sufficed */
  PetscReal  estimate;  /* largest relative error before this solution as its corrections told; NaN for the first */
} GreedySample;

typedef struct {
  Modes              modes;  /* the eigensolver */
  ReducedWindow      window; /* of the eigenvalues asked for */
  const PointGroups *groups;
  PetscReal          rtol;
  PetscReal          safe, goal;      /* what is asked where corrections are made, and of all estimates, beside rtol */
  const char        *option, *advice; /* that rtol is of, and what to do where it is not reached */
  PetscInt           max_samples;
  PetscInt           n_samples;
  GreedySample      *sample; /* [max_samples] */
  PetscReal          worst;  /* largest estimated relative error at all points when it ended */
  PetscReal          last;   /* estimate at the last point before it was taken in */
  PetscReal          fall;   /* slowest fall of an estimate by a step of corrections so far; 0: none was seen */
  /* largest |sigma| that corrections follow, 1/s, where a full solution has more than asked for; else 0 */
  PetscReal reach;
  PetscInt  n_passed; /* points in a row that needed nothing */
  PetscBool looked;   /* at other points since the last full solution */
  /* of scattered points of a box, each with a status of its own: looks at this many of them at most, and estimates that
     are not from the present basis serve as bounds; 0 and false for the places of a sweep */
  PetscInt   most_looks;
  PetscBool  lazy;
  PetscReal  energy; /* of CorrectionDrop: few directions of each block of corrections; 0: all that are long enough */
  Correction correction; /* the last factors, kept for what comes after */
  Progress  *progress;
  PetscErrorCode (*keep)(void *ctx); /* called after every full solution; may be NULL */
  void *keep_ctx;
} Greedy;

/* Goes on with the samples there are, or begins. Enlarges the basis until every eigenvalue in the window at all points
 * [n][n_parameters] is estimated below rtol */
PetscErrorCode GreedyRun(Greedy *greedy, PetscInt n, const PetscReal points[], Basis *basis);
PetscErrorCode GreedyDestroy(Greedy *greedy);
