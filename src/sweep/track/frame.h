/*
   Private to sweep/: the modes of one point with dual bases of their invariant planes, from which points are compared.
   Pure functions on small arrays: no MPI, no options.
*/
#pragma once

#include "track.h"

/* Modes of one point in the standard form A z = s B z (see frame.c). A cluster is a set of modes whose vectors mean
   nothing one by one, only the plane that they span does */
typedef struct {
  PetscReal     value; /* of the parameter of the line */
  PetscReal     scale; /* rad/s, of the second half of z */
  PetscBool     refine;
  PetscBool     damped;    /* s = lambda, z = [x; lambda x / scale], else s = kappa = -lambda^2, z = x */
  PetscInt      size, N;   /* lengths of x and z */
  PetscReal    *K, *C, *M; /* [size * size] */
  ReducedModes  modes;     /* a copy */
  PetscInt     *cluster;   /* [modes.n] first mode of its cluster */
  PetscInt     *branch;    /* [modes.n] -1 for none */
  PetscComplex *X, *Y, *W; /* [modes.n][N] bases of the clusters, W = B' Y, W_i^T X_j = 1 if i = j, 0 elsewhere */
} ModeFrame;

/* Solves at values of the line */
typedef struct {
  const Reduced       *reduced;
  const ReducedWindow *window;
  const Line          *line;
  PetscReal           *p; /* [n_parameters] of the last solution */
  PetscReal            scale;
  PetscBool            damped, estimate; /* whether errors of the eigenvalues are estimated */
} ModeSource;

/* source.c - the parameters and the solution at a value of the line */
PetscErrorCode ModeSourceCreate(const Reduced *reduced, const ReducedWindow *window, const Line *line,
                                ModeSource *source);
PetscErrorCode ModeSourceSolve(ModeSource *source, PetscReal value, ModeFrame **frame);
/* The same from modes that are known already */
PetscErrorCode ModeSourceTake(ModeSource *source, PetscReal value, const ReducedModes *modes, ModeFrame **frame);
PetscErrorCode ModeSourceDestroy(ModeSource *source);

typedef enum { FRAME_A, FRAME_B } ModeFrameMatrix;

/* frame.c - p [n_parameters]; value = that of the line's parameter; refine = whether the modes are those of the pencil
   at p, so that planes may be refined */
PetscErrorCode ModeFrameCreate(const Reduced *reduced, const PetscReal p[], PetscReal value, PetscBool damped,
                               PetscReal scale, PetscBool refine, const ReducedModes *modes, ModeFrame **frame);
PetscErrorCode ModeFrameApply(const ModeFrame *frame, ModeFrameMatrix matrix, PetscBool transposed,
                              const PetscComplex x[], PetscComplex y[]);
PetscErrorCode ModeFrameDestroy(ModeFrame **frame);
/* The other member of the pair lambda, -conj(lambda) of an undamped system in flutter, else -1 */
PetscInt ModeFramePartner(const ModeFrame *frame, PetscInt i);
/* a^T b without conjugation */
PetscComplex FrameDot(PetscInt n, const PetscComplex a[], const PetscComplex b[]);
/* C_ij = W_i(a)^T X_j(b), [a->modes.n * b->modes.n], b fastest: coefficients of the modes of b in those of a */
PetscErrorCode ModeFrameProject(const ModeFrame *a, const ModeFrame *b, PetscComplex C[]);
/* S = (Y_i^T B(b) X_j)^-1 (Y_i^T A(b) X_j) on modes i, j of a: the pencil of another point b on the vectors of a; H =
   Y^T A X, G = Y^T B X, [a->modes.n^2], second index fastest */
PetscErrorCode ModeFramePencil(const ModeFrame *a, const ModeFrame *b, PetscComplex H[], PetscComplex G[]);
/* s of the frame's standard form to lambda with omega >= 0, and back */
PetscComplex ModeFrameLambda(const ModeFrame *frame, PetscComplex s);
PetscComplex ModeFrameEigenvalue(const ModeFrame *frame, PetscComplex lambda);

/* plane.c - orthonormal basis of the k columns of X [k][N], pivoted; columns that depend on the others within
   1e-12 become zero */
PetscErrorCode ModePlaneOrthonormalise(PetscInt N, PetscInt k, PetscComplex X[]);
/* Undamped: real orthonormal bases of the right and left invariant planes of K x = kappa M x about the shift, from
   starting bases X, Y [k][size], by inverse iteration of the plane, which a defective pair does not disturb */
PetscErrorCode ModePlaneIterate(const ModeFrame *frame, PetscReal shift, PetscInt k, PetscReal X[], PetscReal Y[]);
/* Undamped: the plane of the modes member[k] as real bases X, Y [k][size], refined by ModePlaneIterate() if
   frame->refine */
PetscErrorCode ModePlaneRefine(const ModeFrame *frame, PetscInt k, const PetscInt member[], PetscReal X[],
                               PetscReal Y[]);
