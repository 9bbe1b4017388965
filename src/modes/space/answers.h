/* Private to modes/, frf/: vectors by which the space of Galerkin's method answers to forces, beyond those of the
   modes */
#pragma once

#include "space.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/modes.h>

/* Q(lambda)^-1 b of the right side, Q(lambda)^-T b of the left one. The factors are those that found the modes, of
   K - shift M or, where a damped solution made them, of Q(shift). */
typedef struct {
  ModesSpace *space;
  ShiftInvert factor;  /* borrowed */
  PetscReal   edge[2]; /* frequencies of the answers, rad/s */
  PetscInt    n[2];    /* forces of the right side and of the left one, which may have none */
  const Vec  *b[2];    /* [n] in the unknowns of the pencil */
  PetscReal   keep;    /* of what an answer leaves: smaller directions are left to the next step */
  PetscBool   begun;
  PetscInt   *n_solves; /* counts right-hand sides */
} ModesAnswers;

/* Puts the right or left vectors of all modes into the space */
PETSC_INTERN PetscErrorCode ModesSpaceAddModes(ModesSpace *space, Modes modes, Pencil pencil, PetscBool left);
/* Adds to the space P^-1 b of all forces, or in later steps P^-1 r of what its answers leave of them. Collective. */
PETSC_INTERN PetscErrorCode ModesAnswersStep(ModesAnswers *answers);
