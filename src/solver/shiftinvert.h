/* Private to the solvers in statics/, modes/ and sweep/: one factorisation at a shift, its solves, and its inertia */
#pragma once

#include "base/progress.h"
#include <squeal/pencil.h>
#include <slepcst.h>

/* Factorisation of K - s M (undamped) or K + s C + s^2 M (damped), shared by right and left vectors and by inertia
   counts */
typedef struct {
  MPI_Comm  comm;
  KSP       ksp;
  PetscReal shift; /* kappa (rad/s)^2 when undamped, lambda (rad/s) when damped */
  PetscReal size;  /* |A|_F of the matrix */
  Progress *progress;
  /* called after every solve of an eigensolver, alike on all ranks; NULL for nothing. An error ends the solution */
  PetscErrorCode (*after)(void *ctx);
  void *after_ctx;
} ShiftInvert;

/* shiftinvert.c - prefix st_; a singular matrix moves the shift a little, want_inertia lets MUMPS count negative
   pivots */
PETSC_INTERN PetscErrorCode ShiftInvertCreate(const PencilMatrices *pencil, PetscReal shift, PetscBool want_inertia,
                                              Progress *progress, ShiftInvert *si);
PETSC_INTERN PetscErrorCode ShiftInvertAttach(ShiftInvert *si, PetscBool transposed, ST st);
PETSC_INTERN PetscErrorCode ShiftInvertDestroy(ShiftInvert *si);
/* x = A^-1 b, or A^-T b. PETSC_ERR_NOT_CONVERGED where an iterative solver of the user's did not converge */
PETSC_INTERN PetscErrorCode ShiftInvertSolve(const ShiftInvert *si, PetscBool transposed, Vec b, Vec x);
/* analysis.c - symbolic analysis of A, which the factorisation then finds done; with MUMPS only.
   PETSC_ERR_USER_INPUT where the machine has not the memory for the factors by MUMPS' estimate */
PETSC_INTERN PetscErrorCode ShiftInvertAnalyse(const ShiftInvert *si, Mat A);
/* Whether the estimate is shown on stdout before factorisations, not by default */
PETSC_INTERN void      ShiftInvertShow(PetscBool show);
PETSC_INTERN PetscBool ShiftInvertShows(void);
/* block.c - X = A^-1 B, or A^-T B, for dense B, X of the same size and any leading dimension: many right-hand sides at
   once. PETSC_ERR_LIB where the last column does not solve its system: a library behaves otherwise than assumed */
PETSC_INTERN PetscErrorCode ShiftInvertApplyBlock(const ShiftInvert *si, PetscBool transposed, Mat B, Mat X);
/* Frictionless modes with frequency below *omega (rad/s) by Sylvester's law of inertia; symmetric undamped pencil. A null
   pivot is an eigenvalue at *omega itself, which has no sign: *omega is then moved by its part `away` (of either sign).
   PETSC_ERR_MAT_LU_ZRPVT where null pivots stay. */
PETSC_INTERN PetscErrorCode ShiftInvertCountBelow(const PencilMatrices *pencil, PetscReal away, Progress *progress,
                                                  PetscReal *omega, PetscInt *n);

/* readoptions.c - reads the options eps_, pep_ (eigensolvers), st_ (factorisations), and of st_ksp_ those of iterative
   solvers, where some are given and nobody has read them yet, so that what is still unread is unknown */
PETSC_INTERN PetscErrorCode SolverReadEigenOptions(MPI_Comm comm);
PETSC_INTERN PetscErrorCode SolverReadFactorOptions(MPI_Comm comm);
PETSC_INTERN PetscErrorCode SolverReadIterativeOptions(MPI_Comm comm);
