/*
   Private to sweep/: the modes of one point with dual bases of their invariant planes, from which points are compared.
   Pure functions on small arrays: no MPI, no options.
*/
#pragma once

#include "track.h"
#include "sweep/dense/eigen.h"

#define FRAME_PARALLEL 1e-12 /* least independent part of a vector of a plane, beside the longest */

/* Modes of one point in the standard form A z = s B z (dense/standard.c). A cluster is a set of modes whose vectors
   mean nothing one by one, only the plane that they span does */
typedef struct {
  PetscReal      value;   /* of the parameter of the line */
  ModesLimit     limit;   /* of the reduced model */
  const Reduced *reduced; /* borrowed, with its parameters p [n_parameters] */
  PetscReal     *p;
  PetscBool      refine; /* whether planes may be refined: the modes are those of the pencil */
  DensePencil    pencil;
  StandardForm   form;
  PetscInt       N;         /* length of z */
  ReducedModes   modes;     /* a copy */
  PetscInt      *cluster;   /* [modes.n] first mode of its cluster */
  PetscInt      *branch;    /* [modes.n] -1 for none */
  PetscComplex  *X, *Y, *W; /* [modes.n][N] bases of the clusters, W = B' Y, W_i^T X_j = 1 if i = j, 0 elsewhere */
} ModeFrame;

/* Solves at values of the line */
typedef struct {
  const Reduced    *reduced;
  const BranchLine *line;
  PetscReal        *p; /* [n_parameters] of the last solution; freed by the caller */
  StandardForm      form;
  PetscBool         estimate;             /* whether errors of the eigenvalues are estimated */
  PetscInt          n_solved, n_followed; /* eigenproblems, and single modes followed */
} ModeSource;

/* source.c - the parameters and the solution at a value of the line */
PetscErrorCode ModeSourceCreate(const Reduced *reduced, const BranchLine *line, ModeSource *source);
PetscErrorCode ModeSourceSolve(ModeSource *source, PetscReal value, ModeFrame **frame);
/* The same of a single mode, from a guess and the first mode of from (NULL: none); found = whether that ends */
PetscErrorCode ModeSourceFollow(ModeSource *source, PetscReal value, PetscComplex lambda, const ReducedModes *from,
                                ModeFrame **frame, PetscBool *found);
/* The same from modes that are known already */
PetscErrorCode ModeSourceTake(ModeSource *source, PetscReal value, const ReducedModes *modes, ModeFrame **frame);

/* Products of modes alone, for which K is not summed; all of the pencil; and planes that may be refined in it */
typedef enum { FRAME_PRODUCTS, FRAME_PENCIL, FRAME_REFINED } FrameUse;

/* frame.c - p [n_parameters]; damped and scale of the form are taken; the frame's value is left to the caller */
PetscErrorCode ModeFrameCreate(const Reduced *reduced, const PetscReal p[], const StandardForm *form, FrameUse use,
                               const ReducedModes *modes, ModeFrame **frame);
PetscErrorCode ModeFrameDestroy(ModeFrame **frame);
/* The other member of the pair lambda, -conj(lambda) of an undamped system in flutter, else -1 */
PetscInt ModeFramePartner(const ModeFrame *frame, PetscInt i);
/* Whether mode i is unstable: beyond its error and the limit */
PetscBool ModeFrameIsUnstable(const ModeFrame *frame, PetscInt i);
/* why.c - by which mechanism mode i grows */
Mechanism ModeFrameMechanism(const ModeFrame *frame, PetscInt i);
/* Number of modes of the cluster of mode i */
PetscInt ModeFrameClusterSize(const ModeFrame *frame, PetscInt i);
/* What x with its dual w has in common with each cluster Q: adds sum_{j in Q} (w^T x_j) (w_j^T x) to sum [modes.n] at
   the first mode of Q. The factors are the coefficients of mode j in x and of x in mode j. */
void ModeFrameOverlap(const ModeFrame *frame, const PetscComplex w[], const PetscComplex x[], PetscComplex sum[]);
/* plane.c - undamped: the plane of the modes member[k] as real bases X, Y [k][size], refined by inverse iteration if
   frame->refine */
PetscErrorCode ModePlaneRefine(const ModeFrame *frame, PetscInt k, const PetscInt member[], PetscReal X[],
                               PetscReal Y[]);
/* The same of modes that are guessed; settled = whether the iteration ended at a plane */
PetscErrorCode ModePlaneFollow(const ModeFrame *frame, PetscInt k, const PetscInt member[], PetscReal X[],
                               PetscReal Y[], PetscBool *settled);
