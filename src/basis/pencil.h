/* Private to modes/, sweep/, frf/: the dense quadratic problem of one point */
#pragma once

#include "base/algebra/dense.h"
#include "schur.h"
#include <squeal/pencil.h>

/* h(lambda) A, A [n * n] */
typedef struct {
  const PencilLaw *law;
  PetscReal       *A;
} DenseLaw;

/* T(lambda) = lambda^2 M + lambda C + K + sum_j h_j(lambda) A_j, [n * n] each; DenseShiftedSolve() leaves out h,
   DenseFrozenSolve() has what it is at the reference */
typedef struct {
  PetscInt        n;
  PetscBool       damped;    /* C is not zero */
  PetscBool       symmetric; /* all terms, and no damping */
  PetscReal      *K, *C, *M; /* C is not read without damping */
  PetscInt        n_laws;
  const DenseLaw *law; /* borrowed */
} DensePencil;

/* T(lambda) on the unknowns first .. first + n - 1, [n * n] */
void DensePencilEvaluate(const DensePencil *pencil, PetscComplex lambda, PetscInt first, PetscInt n, PetscComplex Q[]);
PetscErrorCode DensePencilDestroy(DensePencil *pencil);

/* companion.c - P = K + linear C + square M, [n * n] */
void DensePencilAt(const DensePencil *pencil, PetscReal linear, PetscReal square, PetscReal P[]);
/* The factors of P = K + s[0] C + s[1] M in [n * n], and the matrix of theta in B: P^-1 M [n * n], or with damping
   [0 I; -P^-1 s[1] M, -P^-1 (2 s[1] M + s[0] C)], [2 n * 2 n]; singular (may be NULL: then an error) = P is */
PetscErrorCode DenseCompanion(const DensePencil *pencil, const PetscReal s[2], PetscReal P[], PetscBLASInt pivot[],
                              PetscReal B[], PetscBool *singular);

/* All eigenvalues of a dense problem, by shift and invert about a real shift, rad/s */
typedef struct {
  const DensePencil *pencil;
  PetscInt           n, N; /* sizes of Q and of the standard problem, N = 2 n with damping */
  PetscReal          shift;
  PetscReal         *P;     /* [n * n] factors of Q(shift) */
  DenseSchur         schur; /* of theta */
  PetscBLASInt      *pivot;
} DenseShifted;

/* Solves about the shift, moved away from eigenvalues (unstable real ones) where necessary; the caller destroys w */
PetscErrorCode DenseShiftedSolve(const DensePencil *pencil, PetscReal shift, DenseShifted *w);
/* lambda of entry i of N, omega >= 0; false for what is not listed: infinite ones, the one of a conjugate pair */
PetscBool DenseShiftedLambda(const DenseShifted *w, PetscInt i, PetscComplex *lambda);
/* Its vectors [n], of any length; left ones of a pencil that is not symmetric */
PetscErrorCode DenseShiftedRight(const DenseShifted *w, PetscInt i, PetscComplex x[]);
PetscErrorCode DenseShiftedLeft(const DenseShifted *w, PetscInt i, PetscComplex y[]);
PetscErrorCode DenseShiftedDestroy(DenseShifted *w);

/* All eigenvalues of a dense problem whose laws are held at their reference, theta about a real shift, with
   vectors [N][N] or without */
typedef struct {
  PetscInt      n, N;   /* N = 2 n where C_0 is not zero */
  PetscBool     damped; /* it is not */
  PetscReal     shift;
  PetscComplex *P; /* [n * n] factors at the shift */
  PetscBLASInt *pivot;
  PetscComplex *theta, *left, *right;
} DenseFrozen;

/* Collective: whether C_0 is zero within rounding, hence N, is what rank 0 finds */
PetscErrorCode DenseFrozenSolve(MPI_Comm comm, const DensePencil *pencil, PetscReal shift, PetscBool vectors,
                                DenseFrozen *frozen);
/* lambda of entry i of N, without C_0 that of +- lambda with Im lambda >= 0; false for infinite ones */
PetscBool DenseFrozenLambda(const DenseFrozen *frozen, PetscInt i, PetscComplex *lambda);
/* Its vectors [n], of any length */
void           DenseFrozenRight(const DenseFrozen *frozen, PetscInt i, PetscComplex x[]);
PetscErrorCode DenseFrozenLeft(const DenseFrozen *frozen, PetscInt i, PetscComplex y[]);
PetscErrorCode DenseFrozenDestroy(DenseFrozen *frozen);

/* follow.c - from a guess lambda, x, y [n] the eigenvalue with vectors of any length that Newton's method finds; found
   = false where it does not settle or Q(lambda) stays singular */
PetscErrorCode DensePencilFollow(const DensePencil *pencil, PetscComplex *lambda, PetscComplex x[], PetscComplex y[],
                                 PetscBool *found);
