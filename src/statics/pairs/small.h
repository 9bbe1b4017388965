/* Private to statics/: the small problem of the pairs, dense or by GMRES, and the bodies factored with the pairs at a
   status */
#pragma once

#include "statics/staticsimpl.h"

/* What the laws of the pairs ask of the small system: row i has l_i = sum_k P[k] z_(first + k) + p0, w_i alike */
typedef struct {
  PetscInt  first, d; /* rows of the pair, counted over all ranks */
  PetscReal P[3], Q[3], p0, q0, slide;
} LawRow;

/* w + (W - V D) l - W w = G K_a^-1 f with the laws; with e: of w = G u + e, that is with w + e in the place of w */
typedef struct {
  const Compliance *compliance;
  PetscReal         friction;   /* factor of all friction coefficients */
  const LawRow     *law;        /* [rows] */
  Vec               f;          /* N */
  PetscBool         added;      /* f and e are what is left of a solution */
  const PetscReal  *e, *free;   /* [rows] m: e where added; G K_a^-1 f, where not and there is W */
  PetscReal         rtol;       /* of GMRES, where the system is not dense */
  PetscInt         *n_factored; /* counts factorisations */
  PetscBool        *far;        /* K_a alone takes more solves than a factorisation costs */
} SmallSystem;

/* l = P z, w = Q z; with p0, q0 when they are wanted */
static inline void SmallApplyLaws(const PairRows *rows, const LawRow law[], PetscBool constants, const PetscReal z[],
                                  PetscReal l[], PetscReal w[])
{
  for (PetscInt i = 0; i < rows->n; i++) {
    const LawRow *a = &law[i];

    l[i] = constants ? a->p0 : 0;
    w[i] = constants ? a->q0 : 0;
    for (PetscInt k = 0; k < a->d; k++) {
      l[i] += a->P[k] * z[a->first - rows->begin + k];
      w[i] += a->Q[k] * z[a->first - rows->begin + k];
    }
  }
}

/* small.c - z [rows], from a guess that GMRES begins with, l and w of the small system; reversed = whether the
   determinant is negative, dense ones only */
PETSC_INTERN PetscErrorCode SmallSolve(const SmallSystem *system, PetscReal z[], PetscReal l[], PetscReal w[],
                                       SmallOutcome *outcome, PetscBool *reversed);
/* gmres.c - z [rows] of this rank from a guess of it, where W is NULL */
PETSC_INTERN PetscErrorCode SmallSolveSparse(const SmallSystem *system, PetscReal z[], SmallOutcome *outcome);
/* refactor.c - room for factors of the bodies with the pairs at a status; factors at the laws of a system, with the
   whole of friction or without, in the place of those of K_a where W is NULL, or a singular matrix; how far its laws
   are from those that were factored; u = K_s^-1 b, or K_a^-1 b. Not collective: whether they stand for K_a; Xw = X w
   and their slide (NULL for none), z = Q_e^-1 r; where they do not, X = Q_e = 1. */
typedef struct {
  PetscBool stands;  /* there are factors */
  PetscBool same;    /* and they are of these laws, */
  PetscBool whole;   /* of their friction too */
  PetscInt  n_other; /* rows of pairs with another law, over all ranks */
} FactorDistance;
PETSC_INTERN PetscErrorCode   StatusFactorCreate(Compliance *c, StatusFactor *factor);
PETSC_INTERN PetscErrorCode   StatusFactorSet(StatusFactor factor, const SmallSystem *system, PetscBool whole,
                                              PetscBool *singular);
PETSC_INTERN PetscErrorCode   StatusFactorCompare(StatusFactor factor, const SmallSystem *system, FactorDistance *d);
PETSC_INTERN PetscBool        StatusFactorServes(StatusFactor factor);
PETSC_INTERN void             StatusFactorHold(StatusFactor factor, const PetscReal w[], PetscReal Xw[]);
PETSC_INTERN const PetscReal *StatusFactorSlide(StatusFactor factor);
PETSC_INTERN void             StatusFactorScale(StatusFactor factor, const PetscReal r[], PetscReal z[]);
PETSC_INTERN PetscErrorCode   StatusFactorSolve(StatusFactor factor, Vec b, Vec u);
/* refactor.c - reversed of any small system: the sign of its determinant by such factors */
PETSC_INTERN PetscErrorCode SmallIsReversed(const SmallSystem *system, PetscBool *reversed);
PETSC_INTERN PetscErrorCode StatusFactorDestroy(StatusFactor *factor);
