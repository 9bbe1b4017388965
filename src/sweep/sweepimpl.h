/* Private to sweep/: the record of a sweep */
#pragma once

#include <squeal/quantity.h>
#include <squeal/sweep.h>
#include "results/journal/journal.h"
#include "sweep/basis/kept.h"
#include "sweep/grid/status.h"
#include "sweep/track/track.h"
#include "sweep/grid/grid.h"
#include "sweep/full/compare.h"

#define SWEEP_MAX_TEXT 65536 /* length of a list of values */

typedef enum { SWEEP_REDUCED, SWEEP_FULL, SWEEP_REAL } SweepMethod;
typedef enum { SWEEP_SYMMETRISED, SWEEP_FRICTIONLESS } SweepStiffness; /* of which real modes are taken */

/* One eigenvalue at one point */
typedef struct {
  PetscReal sigma, omega; /* rad/s */
  PetscReal error;        /* estimated error of lambda, rad/s; NaN where there is no estimate */
  PetscReal noise;        /* the part of it that is rounding */
  PetscReal condition;
  PetscInt  branch; /* from 0 on; -1 where branches are not followed */
  ModeState state;
  PetscBool numerical; /* stable, but its error covers growth */
  char      label[32];
} SweepMode;

/* All eigenvalues of a point */
typedef struct {
  PetscInt   n;
  SweepMode *mode;
} SweepPoint;

/* Name of a branch, and its growth or decay where it was looked at, 1/s */
typedef struct {
  char      text[32];
  PetscReal growth;
} BranchName;

/* True errors at a point that the basis has never seen */
typedef struct {
  SweepPlace at;
  FullCheck  found;
} SweepCheck;

struct _p_Sweep {
  MPI_Comm  comm;
  Operators operators;
  Modes     modes;
  Statics   statics; /* whose closed pairs are taken, or NULL: all are */
  Pencil    pencil;  /* of all points; NULL where each has its own sliding state */
  Progress  progress;
  /* set by options */
  char           parameter[256], link[1024], values[GRID_MAX_AXES][SWEEP_MAX_TEXT];
  SweepMethod    method;
  PetscReal      rtol;
  PetscInt       max_samples, n_real, n_verify, n_groups;
  SweepStiffness real_stiffness;
  PetscBool      linked, onsets, sensitivities, restart;            /* linked: -sweep_link is given */
  PetscBool      method_given, rtol_given, max_given, onsets_given; /* the option is */
  /* results */
  SweepGrid     grid;
  PointGroups   groups;
  PointStore    store;
  ReducedWindow window;
  ModesLimit    limit; /* what counts as unstable */
  Basis         basis;
  Greedy        greedy;
  StatusList    statuses; /* empty without statics; n_pairs -1 without contact */
  PetscInt      n_static; /* static solutions */
  SweepPoint   *point;    /* [places] */
  PetscReal    *worst;    /* [places] largest estimated relative error, but for rounding */
  PetscInt      n_branches;
  PetscInt      n_broken; /* in full: branches of which it is not known where they go on */
  PetscBool     whole;    /* the basis is the whole space */
  BranchName   *label;    /* [n_branches] */
  BranchEvents  events;
  PetscBool    *is_confirmed; /* [onsets] on the full problem */
  SweepCheck   *check;        /* [n_checks] */
  PetscInt      n_checks;
  const char   *folder;
  Results       results;
  Journal       journal; /* what a killed sweep goes on from */
  /* of a sweep without basis: those solved, being taken up while it is not to be written */
  JournalPack    places;
  PetscInt       n_kept;     /* places in them */
  BasisKept      kept;       /* of a reduced sweep */
  PetscLogDouble seconds[5]; /* basis, points, onsets, verification, contact statuses */
};

/* quantities.c - rows of the options */
extern const QuantityTable sweep_quantities;

/* confirm.c - by line, then by critical value */
PETSC_INTERN void SweepSortOnsets(Sweep sweep);

/* line.c - solves the points of the grid line by line, follows the branches, names them */
PETSC_INTERN PetscErrorCode SweepLines(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepLinesForget(Sweep sweep);
/* Gives all ranks the number of branches and the events of rank 0, from event n_before on */
PETSC_INTERN PetscErrorCode SweepShareEvents(Sweep sweep, PetscInt n_before);
/* Largest estimated relative error of all places, but for rounding */
PETSC_INTERN PetscReal SweepWorst(Sweep sweep);
/* Which eigenvalues are unstable or neutral, beyond the estimated error, or `numerical`: the error bar covers zero, or
   is not finite */
PETSC_INTERN PetscErrorCode SweepClassify(Sweep sweep);
/* axes.c - parameters, links and values of the axes, and the places of the grid */
PETSC_INTERN PetscErrorCode SweepAxes(Sweep sweep);
/* sliding.c - statuses of all places and checks from the sliding state, changes of status bracketed, groups of pairs as
   further parameters of the pencil; the status at a place, and that of a sliding state; pairs closed at a point (-1
   without contact), and whether the point before it has another status; fewest and most pairs closed at all places, and
   whether their statuses differ */
PETSC_INTERN PetscErrorCode SweepStatuses(Sweep sweep);
/* grid/sliding.c - full solutions where no basis can follow the sliding state and nobody asks for one */
PETSC_INTERN PetscErrorCode SweepChooseMethod(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepStatusSolve(Sweep sweep, const SweepPlace *place, PetscInt *status);
PETSC_INTERN PetscErrorCode SweepStatusTake(Sweep sweep, const SlidingState *state, PetscInt *status);
PETSC_INTERN PetscInt       SweepClosedAt(Sweep sweep, PetscInt point, PetscBool *jump);
PETSC_INTERN PetscBool      SweepClosedRange(Sweep sweep, PetscInt *least, PetscInt *most);
/* confirm.c - onsets on the reduced model, then on the full problem */
PETSC_INTERN PetscErrorCode SweepOnsets(Sweep sweep);
/* Index of an event along the second axis */
PETSC_INTERN PetscInt SweepEventLine(Sweep sweep, PetscInt e);
/* onsetview.c - onsets, and the answer in one line; what they cost */
PETSC_INTERN PetscErrorCode SweepViewOnsets(Sweep sweep, const OperatorsParameter *parameter, PetscViewer viewer);
PETSC_INTERN PetscErrorCode SweepViewOnsetCost(Sweep sweep, PetscViewer viewer);
/* brute.c - every point in full, without reduced model; the places of full solutions that check the reduced ones, and
   these */
PETSC_INTERN PetscErrorCode SweepBrute(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepCheckPlaces(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepVerify(Sweep sweep);
/* realmodes.c - every point on real modes of its own; one point */
PETSC_INTERN PetscErrorCode SweepReal(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepRealSolve(Sweep sweep, const PetscReal p[], const ReducedWindow *window,
                                           ReducedModes *modes);
/* restart.c - the journal; takes up the full solutions that an earlier run kept, and keeps those that come; deletes all
   that is kept in the folder, also by longer sweeps */
PETSC_INTERN PetscErrorCode SweepJournalOpen(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepResume(Sweep sweep);
PETSC_INTERN PetscErrorCode SweepForget(Sweep sweep);
