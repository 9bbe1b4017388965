/*
   Private to sweep/: a value of the line at which an onset may be, with the modes that take part. Pure functions on
   small arrays: no MPI, no options.
*/
#pragma once

#include "sweep/track/frame.h"

typedef enum { ONSET_PAIR, ONSET_GROWTH, ONSET_STIFFNESS } OnsetKind;

/* A trial value with the modes that take part */
typedef struct {
  ModeFrame *frame;
  PetscInt   k, *member; /* [k] */
  PetscReal  g, m;
  PetscReal  limit;   /* of a pair: L^2, the square of growth that counts as unstable */
  PetscBool  settled; /* the plane of a pair is known to be an invariant one */
} Trial;

/* g of the members (see onset.c), m of a pair */
PetscErrorCode TrialValue(OnsetKind kind, Trial *trial);
/* The k modes of the trial that have most in common with the plane of the reference */
PetscErrorCode TrialIdentify(const Trial *reference, Trial *trial, PetscBool *found);
/* Whether a trial of one mode certainly has the same as the reference */
PetscBool TrialIsSame(const Trial *reference, const Trial *trial);
/* The plane of the reference, followed to a value of the line; m = guess of its mean; found = whether what is there
   certainly is the same plane */
PetscErrorCode TrialFollowPlane(ModeSource *source, PetscReal value, PetscReal m, const Trial *reference, Trial *trial,
                                PetscBool *found);
/* Makes member 0 of a frame of one mode the trial's, or lets the frame go */
PetscErrorCode TrialTakeSingle(Trial *trial, PetscBool good);
PetscErrorCode TrialDestroy(Trial *trial);
