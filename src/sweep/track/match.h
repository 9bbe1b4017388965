/*
   Private to sweep/: which modes of one point are those of another. Pure functions on small arrays: no MPI, no options.
*/
#pragma once

#include "frame.h"

/* Modes i of a and j of b whose products are not negligible are connected and form components */
typedef struct {
  PetscInt   na, nb, n_components;
  PetscReal *strength;                  /* [na * nb] overlap of the clusters of i and j, 1 = the same or contained */
  PetscInt  *component_a, *component_b; /* [na], [nb] */
  PetscInt  *clusters_a, *clusters_b;   /* [n_components] clusters of a, b in each */
  PetscBool *certain;                   /* [n_components] */
  PetscBool  all_certain;
  /* modes of an uncertain component are assigned when they alone reach this strength; 0: as scores say */
  PetscReal least;
  PetscInt *from; /* [nb] mode of a or -1; MatchAssign() */
} Match;

/* match.c - window (may be NULL): a mode without partner is certain only when it left or entered the window */
PetscErrorCode MatchCreate(const ModeFrame *a, const ModeFrame *b, const ReducedWindow *window, Match *match);
/* Fills from; score [na * nb] (match->strength or better) of i, j of one component; order [na] frequency (rad/s), NULL
   for that of a, by which the modes of a take their places where scores do not decide: in a pair the lower one takes
   the unstable member */
PetscErrorCode MatchAssign(const ModeFrame *a, const ModeFrame *b, const PetscReal score[], const PetscReal order[],
                           Match *match);
PetscErrorCode MatchDestroy(Match *match);

/* interval.c - where to divide the step between two points that match, t in (0, 1) from a to b: where two modes that
   are stable at both ends are predicted to be unstable between, or to veer where the match makes them cross, with a gap
   above resolution times the change of their distance; found = whether there is such a place */
PetscErrorCode IntervalPredict(const ModeFrame *a, const ModeFrame *b, const Match *match, PetscReal resolution,
                               PetscReal *t, PetscBool *found);
