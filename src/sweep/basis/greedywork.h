/* Private to sweep/: a run of the greedy choice, shared by greedy.c and sample.c */
#pragma once

#include "greedy.h"

#define LOOK_DROP   2e-9 /* vectors shorter than this tell no error: its square times a ratio of stiffnesses, 1e8 */
#define LOOK_ENERGY 0.01 /* beside Greedy.energy, where what was left out is what errs */

/* What the run knows */
typedef struct {
  Greedy          *greedy;
  Basis           *basis;
  ReducedWindow    guarded; /* a little wider */
  PetscInt         n;
  const PetscReal *points;
  PetscReal       *estimate; /* [n] */
  PetscInt        *fresh;    /* [n] vectors of the basis that it is from, 0 for none */
  PetscReal       *scale;    /* [n_parameters] */
  CorrectionDrop   drop;
  CorrectionSides  sides;
  PetscReal       *surprise;   /* how far a step finds errors beyond what was stated; NULL: not asked for */
  PetscInt         first;      /* sample from which on distances are measured */
  Correction      *correction; /* the greedy's */
  ShiftInvert      counter;    /* where the factors of the correction do not serve */
  PetscBool        is_near;    /* the factors are those of the point */
} GreedyWork;

/* sample.c - appends to the list of full solutions */
PetscErrorCode SampleAdd(GreedyWork *run, const PetscReal p[], PetscBool krylov, PetscInt n_vectors,
                         PetscReal estimate);
/* Solves point p by the eigensolver */
PetscErrorCode SampleKrylov(GreedyWork *run, const PetscReal p[], PetscReal estimate);
/* Looks at point p: first = the estimate there before; where it exceeds rtol, the basis takes the point in */
PetscErrorCode SampleCorrect(GreedyWork *run, const PetscReal p[], PetscReal *first);
/* One step of corrections at p of the modes that the step before (modes, empty at first) has not settled; worst = what
   they tell about the model before */
PetscErrorCode StepApply(GreedyWork *run, const PetscReal p[], ReducedModes *modes, PetscInt *n_added,
                         PetscReal *worst);
/* The factors at p in place of those before */
PetscErrorCode FactorMake(GreedyWork *run, const PetscReal p[]);
/* pairs.c - takes what a change of contact status does at p into the model */
PetscErrorCode PairsTake(GreedyWork *run, const PetscReal p[]);
/* The pencil at p with the factors of the last point that has any */
PetscErrorCode FactorKeep(GreedyWork *run, const PetscReal p[]);
/* How often p has been looked at, or, factored, corrected with factors of its own */
PetscInt PointTimes(const GreedyWork *run, const PetscReal p[], PetscBool factored);
