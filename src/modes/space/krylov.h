/* Private to modes/, frf/: Krylov vectors of the pencil at the shift, beyond those of the modes */
#pragma once

#include "space.h"
#include "solver/factor/shiftinvert.h"
#include <squeal/modes.h>

/* With Q0 = K - shift M undamped, the states p are vectors and S p = Q0^-1 M p; with damping Q0 = Q(shift), they are
   pairs p, q and S [p; q] = [-Q0^-1 (g Q'(shift) p + g^2 M q); p], g = shift, so that

      (Q0 - d M)^-1 b = (1 - d S)^-1 Q0^-1 b,   Q(shift + g d)^-1 b = first part of (1 - d S)^-1 [Q0^-1 b; 0].

   States are kept as coordinates in the space, orthonormal: first those of the modes, which S maps on themselves, then
   those of the chain. Left chains are those of the transposed pencil. */
typedef struct {
  ModesSpace *space;
  ShiftInvert factor; /* borrowed */
  PetscBool   transposed;
  PetscInt    n, capacity, length; /* states, most of them, numbers of each: size, or 2 size with damping */
  PetscInt    last;                /* the states from here on are those of the last step */
  PetscReal  *state;               /* [capacity][length] */
  PetscInt    n_b;                 /* vectors that it begins with */
  const Vec  *b;                   /* [n_b] in the unknowns of the pencil */
  PetscBool   begun;
  PetscInt   *n_solves; /* counts right-hand sides */
} ModesKrylov;

/* A chain of up to `capacity` states */
PETSC_INTERN PetscErrorCode ModesKrylovCreate(ModesSpace *space, const ShiftInvert *factor, PetscBool transposed,
                                              PetscInt capacity, ModesKrylov *chain);
/* How many real vectors all modes of the last solution have, right and left ones */
PETSC_INTERN PetscErrorCode ModesCountVectors(Modes modes, PetscInt *n);
/* Puts vectors and states of all modes into space and chain */
PETSC_INTERN PetscErrorCode ModesKrylovAddModes(Modes modes, Pencil pencil, ModesKrylov *chain);
/* Leaves the first n states, behind which a chain from other vectors b begins */
PETSC_INTERN PetscErrorCode ModesKrylovRestart(ModesKrylov *chain, PetscInt n, PetscInt n_b, const Vec b[]);
/* One step of both chains, either of which may be empty: it begins with Q0^-1 b of its vectors b. The space grows. */
PETSC_INTERN PetscErrorCode ModesKrylovStep(ModesSpace *space, ModesKrylov *chain[2]);
PETSC_INTERN PetscErrorCode ModesKrylovDestroy(ModesKrylov *chain);
