/*
   Private to sweep/: branches over the points of a line, i.e. over the values of one parameter, and the events on them.
   Pure functions on the reduced model: no MPI, no options.
*/
#pragma once

#include "modes/growth/mechanism.h"
#include "sweep/dense/reduced.h"

typedef enum { EVENT_LOCK_IN, EVENT_LOCK_OUT, EVENT_DIVERGENCE, EVENT_RESTABILISATION, EVENT_JUMP } BranchEventKind;

/* Between lower and upper (lower < upper) the modes of one or two branches change stability. Lock-in: a pair becomes
   unstable as the parameter grows, lock-out: it becomes stable again; divergence: a mode of frequency zero becomes
   unstable, restabilisation: it becomes stable again. Jump: pairs open or close between lower and upper, and a mode is
   unstable on one side only */
typedef struct {
  BranchEventKind kind;
  PetscReal       lower, upper; /* values of the parameter with the stability of before and after */
  PetscComplex    lambda;       /* the unstable eigenvalue where it is unstable, at lower or upper, rad/s */
  PetscInt        branch[2];    /* the branch that is unstable and its partner, -1 for none */
  PetscReal       critical;     /* value where sigma = 0; set by OnsetFind() */
  PetscReal       omega;        /* rad/s at the critical value */
  PetscReal       error;        /* estimated error of the critical value, in its unit */
  PetscBool       found;
  /* modes change places in the bracket: critical is its middle, error half of it, omega of lambda */
  PetscBool jumps;
  Mechanism mechanism;            /* of the growth on the unstable side */
  PetscBool above;                /* of a jump: unstable at upper */
  PetscInt  place;                /* of the grid, whose other parameters hold; set by the caller */
  PetscInt  n_solved, n_followed; /* reduced eigenproblems, and single modes followed, so far */
  PetscInt  n_corrected;          /* corrections on the full problem, counted by the caller */
} BranchEvent;

typedef struct {
  PetscInt     n;
  BranchEvent *event;
} BranchEvents;

/* The line: the parameters that take its value, values [n] ascending or descending, all other parameters from
   base[n_parameters]; modes in the window are followed */
typedef struct {
  PetscInt             n_moved, n;
  const PetscInt      *parameter; /* [n_moved] indices */
  const PetscReal     *value;
  const PetscReal     *base;
  const ReducedWindow *window;
} BranchLine;

/* A point of a line with its modes and their branches */
typedef struct {
  PetscReal           value; /* of the line's parameter */
  const ReducedModes *modes;
  PetscInt           *branch; /* [modes->n] */
} BranchPoint;

/* source.c - gives the parameters of the line this value in p[n_parameters] */
void BranchLineSet(const BranchLine *line, PetscReal value, PetscReal p[]);
/* track.c - branch[point][mode] for the modes already solved at the points, numbered from *n_branches on; *n_branches
   grows. Where the match of two neighbouring points is ambiguous the interval is halved by further ReducedSolve(). */
PetscErrorCode TrackLine(const Reduced *reduced, const BranchLine *line, const ReducedModes modes[], PetscInt *branch[],
                         PetscInt *n_branches, BranchEvents *events);
/* step.c - match of the modes of two points a, b that may differ in any parameter: from[i of b] = mode of a or -1;
   certain = whether no match is ambiguous */
PetscErrorCode TrackMatch(const Reduced *reduced, const PetscReal p[], const ReducedModes *a, const ReducedModes *b,
                          PetscInt from[], PetscBool *certain);
/* The same with all parameters p of both points, and none for a mode that is no other one's for certain */
PetscErrorCode TrackSure(const Reduced *reduced, const PetscReal *const p[2], const ReducedModes *a,
                         const ReducedModes *b, PetscInt from[]);
/* Modes of two points a, b on the two sides of a change of contact status: branches of b that are certainly
   modes of a become those of a, the others keep theirs; appends a jump for every mode that is unstable on one side
   only. p = all parameters at b */
PetscErrorCode TrackJump(const Reduced *reduced, const PetscReal p[], const BranchPoint *a, BranchPoint *b,
                         BranchEvents *events);
/* Vectors of branches whose modes cannot be told from others at a point, from before they joined them; made with room
   for all modes and n = 0 */
typedef struct {
  ReducedModes modes;
  PetscInt    *branch;
} BranchMemory;

/* Along a line, across a change of contact status, from one line to the next */
typedef enum { STEP_SMOOTH, STEP_JUMP, STEP_LINK } StepKind;

typedef struct {
  StepKind             kind;
  const ReducedWindow *window;
  const PetscReal     *p[2]; /* all parameters at a and at b */
  BranchPoint          a, b;
  const BranchMemory  *before; /* of a */
  BranchMemory        *after;  /* of b is appended */
  PetscInt             n_branches;
  PetscInt             n_broken; /* branches that end at a since the step is too large to tell where they go on */
} PointStep;

/* Branches of b from those of a, new ones from n_branches on, and events of the kind, where nothing is solved between
   the points. The place of an onset is interpolated; its error reaches both points. What is uncertain ends. */
PetscErrorCode TrackStep(const Reduced *reduced, PointStep *step, BranchEvents *events);
/* change.c */
PetscErrorCode BranchEventsDestroy(BranchEvents *events);

/* onset.c - the critical value of an event on the reduced model, to rounding, and its estimated error; modes (may be
   NULL) = the modes that take part, there; empty if not found */
PetscErrorCode OnsetFind(const Reduced *reduced, const BranchLine *line, BranchEvent *event, ReducedModes *modes);
