/* Private to the solvers in statics/, modes/ and sweep/: one factorisation at a shift, its solves, and its inertia */
#pragma once

#include <squeal/quantity.h>
#include "base/process/progress.h"
#include "base/algebra/synchronize.h"
#include <squeal/pencil.h>
#include <math.h>
#include <slepcds.h>
#include <slepcst.h>

/* Cost of factors by MUMPS' estimate */
typedef struct {
  double entries;      /* of the factors, all ranks */
  double flops;        /* of the factorisation */
  double all;          /* MB of all ranks */
  double needed, disk; /* MB of one machine, the one that has least room for it; the same with factors on disk */
  double room;         /* MB on that machine */
} FactorCost;

struct LowRank; /* lowrank.h */
struct InverseBlock;

/* What need not stay once it is factored (release.c): nothing, where another shift will be asked for; the symmetric
   matrix that MUMPS has a copy of; K and K_even of the pencil too */
typedef enum { RELEASE_NOTHING, RELEASE_MATRIX, RELEASE_PENCIL } ReleaseKind;

/* Factorisation of K - s M (undamped) or K + s C + s^2 M (damped), shared by right and left vectors and by inertia
   counts */
typedef struct ShiftInvert {
  MPI_Comm    comm;
  KSP         ksp;
  PetscReal   shift;           /* kappa (rad/s)^2 when undamped, lambda (rad/s) when damped */
  PetscBool   inertia, counts; /* negative pivots can be counted; they are being, so that null pivots are no error */
  PetscBool   factored;        /* there are factors, not the analysis alone */
  ReleaseKind release;         /* before friction is put on the factors */
  Pencil      owner;           /* of K and K_even, where they may be released */
  PetscBool   released;        /* the matrix is not there any more */
  PetscBool   regain;          /* K and K_even were released: to be got again for another shift */
  /* what makes products with K then, where the half that is factored is left alone; else NULL */
  Mat       product;
  PetscBool even;        /* the matrix that is factored is symmetric: LDL' */
  PetscBool halves;      /* its upper half will do, on one rank */
  PetscBool even_damped; /* LDL' with damping too, where K, C and M are symmetric */
  /* K itself is factored, at shift 0 and without a copy; by MUMPS whatever st_ksp_ and st_pc_ say; with null pivots and
     the sign of the determinant found */
  PetscBool bare;
  double    solves; /* right-hand sides that are expected; 0: not known */
  /* of MUMPS beyond its estimate, percent; 0: its own choice, which is raised where it fails */
  PetscInt         workspace;
  Mat              term[3];               /* K, C, M of it */
  PetscObjectState pattern[3], values[3]; /* of those */
  Vec              trial[3];  /* what solutions are checked by: w at random, A' w and A w, A with its update */
  PetscReal        length[3]; /* of those */
  FactorCost       cost;      /* of its factors */
  const char      *why;       /* LU in place of an update, in words; NULL where there is no choice */
  struct LowRank  *update;    /* friction beside that matrix; NULL for none */
  Progress        *progress;
  /* called after every solve of an eigensolver, alike on all ranks; NULL for nothing. An error ends the solution */
  PetscErrorCode (*after)(void *ctx);
  void *after_ctx;
} ShiftInvert;

/* shiftinvert.c - prefix st_; a singular matrix moves the shift a little, want_inertia lets MUMPS count negative
   pivots */
PETSC_INTERN PetscErrorCode ShiftInvertCreate(const PencilMatrices *pencil, PetscReal shift, PetscBool want_inertia,
                                              Progress *progress, ShiftInvert *si);
/* Another shift, or other values of the pencil, for an si that was created or is all zeros but for its progress: where
   the pattern is the same the analysis serves again */
PETSC_INTERN PetscErrorCode ShiftInvertMove(const PencilMatrices *pencil, PetscReal shift, ShiftInvert *si);
PETSC_INTERN PetscErrorCode ShiftInvertAttach(ShiftInvert *si, PetscBool transposed, ST st);
PETSC_INTERN PetscErrorCode ShiftInvertDestroy(ShiftInvert *si);
/* Whether they are factors of a damped pencil, K + shift C + shift^2 M. Not collective. */
PETSC_INTERN PetscBool      ShiftInvertIsDamped(const ShiftInvert *si);
/* Counts n steps of the eigensolver, and calls what is to be called after them */
PETSC_INTERN PetscErrorCode ShiftInvertStepped(const ShiftInvert *si, PetscInt n);
/* x = A^-1 b, or A^-T b. PETSC_ERR_NOT_CONVERGED where an iterative solver of the user's did not converge */
PETSC_INTERN PetscErrorCode ShiftInvertSolve(const ShiftInvert *si, PetscBool transposed, Vec b, Vec x);
/* analysis.c - symbolic analysis of A, which the factorisation then finds done; with MUMPS only.
   PETSC_ERR_USER_INPUT where the machine has not the memory for the factors by MUMPS' estimate */
PETSC_INTERN PetscErrorCode ShiftInvertAnalyse(const ShiftInvert *si, Mat A, FactorCost *cost);
/* factor.c - the matrix at si->shift with its analysis; and its factors: singular where it has none, with null pivots
   unless they are counted */
PETSC_INTERN PetscErrorCode ShiftInvertPrepare(const PencilMatrices *pencil, ShiftInvert *si);
/* Whether what is to be factored has the pattern of what was, so that the analysis serves again */
PETSC_INTERN PetscErrorCode ShiftInvertKeepsPattern(const ShiftInvert *si, const PencilMatrices *pencil,
                                                    PetscBool *keeps);
/* Whether the factors are those of the symmetric part at this shift already, friction put on them or not */
PETSC_INTERN PetscErrorCode ShiftInvertStands(const PencilMatrices *pencil, PetscReal shift, const ShiftInvert *si,
                                              PetscBool *stands);
PETSC_INTERN PetscErrorCode ShiftInvertFactor(const PencilMatrices *pencil, ShiftInvert *si, PetscBool *singular);
/* factor.c - whether the determinant of the matrix factored is negative, where si->bare */
PETSC_INTERN PetscErrorCode ShiftInvertIsNegative(const ShiftInvert *si, PetscBool *negative);
/* release.c - gives up what si->release says, of the matrices that were factored. The symmetric one is a copy of the
   pattern of K: products with it are made from K, M and the pairs then. Where it is but the upper half it stays, and
   with RELEASE_PENCIL K goes: si->product makes products with it. K_even goes with friction, or with K. */
PETSC_INTERN PetscErrorCode ShiftInvertRelease(const PencilMatrices *pencil, ShiftInvert *si);
/* The pencil with K and K_even of their owner where they were released */
PETSC_INTERN PetscErrorCode ShiftInvertRegain(const PencilMatrices *pencil, const ShiftInvert *si,
                                              PencilMatrices *whole);
/* Whether the estimate is shown on stdout before factorisations, not by default */
PETSC_INTERN void      ShiftInvertShow(PetscBool show);
PETSC_INTERN PetscBool ShiftInvertShows(void);
/* block.c - X = A^-1 B, or A^-T B, for dense B, X of the same size and any leading dimension: many right-hand sides at
   once. PETSC_ERR_LIB where a column does not solve its system: a library behaves otherwise than assumed */
PETSC_INTERN PetscErrorCode ShiftInvertApplyBlock(const ShiftInvert *si, PetscBool transposed, Mat B, Mat X);
/* X = Z A^-1 Z'B of all unknowns u = Z q, where A is a matrix of the q; A^-1 B where Z is NULL */
PETSC_INTERN PetscErrorCode ShiftInvertApplyThrough(const ShiftInvert *si, Mat Z, Mat B, Mat X);
/* X := A^-1 X for the first n_right columns, at least one, and A^-T X for the others, at least one, by one block of
   solves; ctx is a ShiftInvert with an update. As many steps of the eigensolver. */
PETSC_INTERN PetscErrorCode ShiftInvertApplyBoth(void *ctx, PetscInt n_right, Mat X);
/* X := A^-1 X by the factors of the symmetric matrix alone; ctx is the KSP */
PETSC_INTERN PetscErrorCode ShiftInvertApplyFactors(void *ctx, Mat X);
/* The same of sparse rows, A X = rows', whether it can be done: MUMPS takes sparse right-hand sides on one rank (on
   more it wants all of them on the first) */
PETSC_INTERN PetscErrorCode ShiftInvertSolvesRows(KSP ksp, PetscBool *solves);
PETSC_INTERN PetscErrorCode ShiftInvertApplyRows(void *ctx, Mat rows, Mat X);
/* The factors that a solver works with, NULL where it is another solver, and whether they are those of MUMPS */
PETSC_INTERN PetscErrorCode ShiftInvertGetFactors(KSP ksp, Mat *F, PetscBool *is_mumps);
/* inverse.c - entries of A^-1 by the factors of the symmetric matrix, whether they can be had; ctx is the KSP.
   Collective. */
PETSC_INTERN PetscErrorCode ShiftInvertGivesInverse(KSP ksp, PetscBool *gives);
PETSC_INTERN PetscErrorCode ShiftInvertGetInverse(void *ctx, const struct InverseBlock *block);
/* trial.c - makes what the solutions with si are checked by, from its matrix and its update */
PETSC_INTERN PetscErrorCode ShiftInvertMakeTrial(ShiftInvert *si);
PETSC_INTERN PetscErrorCode ShiftInvertDestroyTrial(ShiftInvert *si);
/* Sums by which a block is judged, one [2] a column: with the trial vector v, of the right-hand side w, v'b and b'b; of
   a solution A' w (the first n_right) or A w. Collective. */
PETSC_INTERN PetscErrorCode TrialSums(const ShiftInvert *si, PetscBool solution, PetscInt n_right, Mat X,
                                      PetscScalar sums[][2]);
/* PETSC_ERR_LIB where one of n solutions does not fit its right-hand side */
PETSC_INTERN PetscErrorCode TrialCheck(const ShiftInvert *si, PetscInt n_right, PetscInt n, PetscScalar b[][2],
                                       PetscScalar x[][2]);
/* Raises the error for what no shift makes regular */
PETSC_INTERN PetscErrorCode ShiftInvertRegular(MPI_Comm comm, PetscBool regular, PetscReal shift);
/* inertia.c - negative pivots of K - omega^2 M, 0 where omega is not positive; symmetric undamped pencil. A null pivot
   is an eigenvalue at *omega itself, which has no sign: *omega is then moved by its part `away` (of either sign).
   PETSC_ERR_MAT_LU_ZRPVT where null pivots stay. */
PETSC_INTERN PetscErrorCode ShiftInvertCountBelow(const PencilMatrices *pencil, PetscReal away, ShiftInvert *si,
                                                  PetscReal *omega, PetscInt *n);
/* Where unknowns are without mass: how many of those pivots belong to no mode but to these unknowns, or to a mode that
   grows faster than `most`, 1/s */
PETSC_INTERN PetscErrorCode ShiftInvertCountMassless(const PencilMatrices *pencil, PetscReal most, ShiftInvert *si,
                                                     PetscInt *n);
/* Whether unknowns or directions are without mass: rows of M without an entry that is not zero, or what the pencil
   says. Collective. */
PETSC_INTERN PetscErrorCode MassIsSingular(const PencilMatrices *pencil, PetscBool *singular);

/* readoptions.c - reads the options eps_, pep_ (eigensolvers), st_ (factorisations), and of st_ksp_ those of iterative
   solvers, where some are given and nobody has read them yet, so that what is still unread is unknown */
PETSC_INTERN PetscErrorCode SolverReadEigenOptions(MPI_Comm comm);
PETSC_INTERN PetscErrorCode SolverReadFactorOptions(MPI_Comm comm);
PETSC_INTERN PetscErrorCode SolverReadIterativeOptions(MPI_Comm comm);

/* Shows which runs read options of PETSc and SLEPc. Collective */
extern const QuantityTable  solver_quantities; /* quantities.c - of PETSc and SLEPc, by prefix */
PETSC_INTERN PetscErrorCode SolverVisit(const QuantityVisitor *visitor);
/* Whether an option that begins so, as "pep_", is given */
PETSC_INTERN PetscErrorCode SolverOptionsGiven(const char prefix[], PetscBool *given);
