/*
   Private to sweep/: the dense model on a basis V of size n, Vhat' Q(lambda; p) V, and what is computed from it at one
   point p of the parameters. Pure functions on small arrays: no MPI, no options. All matrices are column-major.
*/
#pragma once

#include <squeal/modes.h>
#include <complex.h>

/* A_t = left' right, of few rows, on a basis */
typedef struct {
  PetscInt   rank;         /* rows, 0: it is no such product */
  PetscReal *left, *right; /* [n][rank] */
} ReducedFactors;

/* Leading vectors that eigenvalues are sought on first (condense.c), m = 0 for none: what the others add to one of them
   is to be less than rtol */
typedef struct {
  PetscInt  m;
  PetscReal rtol;
} ReducedCore;

/* V' A_t V of every term of the pencil. The leading n_used vectors make the model; the remaining ones, Z, only serve to
   estimate its error. */
typedef struct {
  PetscInt                  n, n_used;
  PetscInt                  n_terms, n_parameters;
  const OperatorsTerm      *term;      /* coefficients (borrowed) */
  const OperatorsParameter *parameter; /* [n_parameters] names (borrowed), or NULL */
  PetscReal               **A;         /* [n_terms][n * n] */
  ReducedFactors           *factors;   /* [n_terms] of those that are products of few rows, or NULL */
  PetscReal               **D;         /* [n_terms][n_used * n_used] V' |diag A_t| V of the stiffness terms, for what
                                          rounding in A_t does, with those of the same RoundingTerm(); NULL, or NULL
                                          entries, where that is no more than rounding in the dense matrices */
  ReducedCore               core;
  PetscReal                 beyond;   /* how far errors that were looked for exceeded what was stated; 0 for not */
  PetscReal                 left_out; /* of |kappa|, what directions may be worth that neither V nor Z was given */
  ModesLimit                limit;    /* what counts as unstable; no limit without */
} Reduced;

/* Eigenvalues to look for: omega in [low, high], |sigma| <= growth, rad/s; and with rtol > 0 those of larger |sigma|
   that the basis happens to have: whose estimated error is at most rtol |lambda| */
typedef struct {
  PetscReal low, high, growth, rtol;
} ReducedWindow;

/* Eigenvalues of one point, omega >= 0, by frequency (members of a pair of equal frequency by growth, the stable one
   first), with vectors in coordinates of the leading n_used vectors of the basis */
typedef struct {
  PetscInt      n, size;
  PetscComplex *lambda;  /* [n] sigma + i omega, rad/s; exactly 0 for a rigid mode */
  PetscComplex *x, *y;   /* [n][size] right and left vectors, x^H M x = y^H M y = 1 with the symmetric part of M;
                            y^T Q(lambda) = 0, without conjugation */
  PetscComplex *product; /* [n] y^T D(lambda) x, D = M + C / (2 lambda), rigid modes: M; 1 / |product| is the condition,
                            0 if defective */
  PetscReal    *error;   /* [n] estimated error of lambda, rad/s; 0 until ReducedEstimate() */
  PetscReal    *sharp;   /* [n] the same to first order: error is more where right and left residuals cancel in it */
  PetscReal    *noise;   /* [n] the part of the error that no better basis lowers: rounding, compression */
  PetscBool    *rigid;   /* [n] zero within rounding */
} ReducedModes;

/* reduced.c - sums the terms at p; eigenvalues and vectors in the window, by dense shift-and-invert about a real shift
   (eigen.c), damped ones in companion form. In clusters of equal eigenvalues the left vectors are biorthogonal to the
   right ones. Undamped, a negative kappa is listed as lambda = +sqrt(-kappa) only; damped, all real eigenvalues are. */
PetscErrorCode ReducedSolve(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                            ReducedModes *modes);
/* The same with all modes beyond the growth of a window with rtol > 0, before ReducedDropInexact() */
PetscErrorCode ReducedSolveAll(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                               ReducedModes *modes);
/* A single simple eigenvalue from a guess: lambda with the vectors of the first mode of from, or with none (NULL) when
   lambda is known to many digits. modes->n = 1, or 0 where the iteration does not end */
PetscErrorCode ReducedFollow(const Reduced *reduced, const PetscReal p[], PetscComplex lambda, const ReducedModes *from,
                             ReducedModes *modes);
PetscErrorCode ReducedModesCreate(PetscInt n, PetscInt size, ReducedModes *modes);
/* A copy of some of the modes, list [n], or of the first n where list is NULL */
PetscErrorCode ReducedModesSelect(const ReducedModes *from, PetscInt n, const PetscInt list[], ReducedModes *to);
PetscErrorCode ReducedModesDestroy(ReducedModes *modes);

/* Rows of a term that goes by its factors on n vectors, where these are few beside n; else 0 */
PetscInt ReducedFactorsRank(const Reduced *reduced, PetscInt t, PetscInt n);

/* values.c - raises an error where Ms [n_used * n_used], the symmetric part of V' M V at p, is not positive definite;
   no mass that depends on parameters: nothing to do */
PetscErrorCode ReducedCheckMass(const Reduced *reduced, const PetscReal p[], const PetscReal Ms[]);

/* Whether a damping term has a coefficient that is not zero */
PetscBool ReducedIsDamped(const Reduced *reduced, const PetscReal p[]);

/* Labels cluster [n] = first member: puts j and all of its cluster into the cluster of i */
void ReducedClusterJoin(PetscInt n, PetscInt i, PetscInt j, PetscInt cluster[]);

/* rounding.c - E [n_used * n_used] of the mesh's rounding; its effects on kappa, times |y^T D x|, of m modes with
   vectors X, Y [m][n]; marks the modes that are zero within it */
#define ROUNDING_SMALL 1e-3 /* beside the window: frequencies that may be zeros */
#define ROUNDING_RIGID 100  /* kappa below this many times its rounding is zero */
PetscErrorCode RoundingEnergy(const Reduced *reduced, const PetscReal p[], PetscReal E[]);
/* The first term whose D has that of term t, all with the same coefficient where pairs are closed */
PetscInt       RoundingTerm(const Reduced *reduced, PetscInt t);
PetscErrorCode RoundingProducts(PetscInt n, const PetscReal E[], PetscInt m, const PetscComplex X[],
                                const PetscComplex Y[], PetscReal product[]);
PetscErrorCode RoundingMarkRigid(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                 ReducedModes *modes);

/* values.c - sets to zero in p[] what friction and damping are proportional to; false where some of either remains */
PetscBool ReducedFrictionless(const Reduced *reduced, PetscReal p[]);

/* estimate.c - errors of all modes from the part Z of the basis that the model does not use, close ones together (see
   the file), and a floor for rounding, which alone remains without Z */
PetscErrorCode ReducedEstimate(const Reduced *reduced, const PetscReal p[], ReducedModes *modes);
/* What left_out is to mode i, rad/s */
PetscReal ReducedLeftOut(const Reduced *reduced, const ReducedModes *modes, PetscInt i);
/* Takes out what has a larger |sigma| than the window and is not known to its rtol */
PetscErrorCode ReducedDropInexact(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                  ReducedModes *modes);

/* sensitivity.c - d lambda / d p_j = -y^T (dQ/dp_j) x / (y^T Q' x) of mode i for every parameter j, [n_parameters];
   zero for a rigid mode, not finite at a defective pair */
PetscErrorCode ReducedSensitivity(const Reduced *reduced, const PetscReal p[], const ReducedModes *modes, PetscInt i,
                                  PetscComplex derivative[]);
