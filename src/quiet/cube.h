/*
   Private to the rooms of boxes: the box of the parameters that vary, as the cube t in [-1, 1]^n. A variable moves one
   parameter, or several in step.

      p_k(t) = lower_k + (t + 1) / 2 (upper_k - lower_k)
*/
#pragma once

#include <squeal/pencil.h>

#define CUBE_MAX_VARIABLES 8
#define CUBE_MAX_TEXT      4096

/* What options say of it */
typedef struct {
  char      names[CUBE_MAX_TEXT]; /* "pad_young,inner_mu+outer_mu" */
  PetscReal lower[CUBE_MAX_VARIABLES], upper[CUBE_MAX_VARIABLES], percent[CUBE_MAX_VARIABLES];
  PetscInt  n_lower, n_upper, n_percent;
} CubeOptions;

typedef struct {
  PetscInt   n, n_parameters;
  PetscReal *nominal; /* [n_parameters] the scene's own values (borrowed) */
  char      *name[CUBE_MAX_VARIABLES];
  PetscInt   n_moved[CUBE_MAX_VARIABLES], *moved[CUBE_MAX_VARIABLES]; /* indices of its parameters */
  PetscReal *lower[CUBE_MAX_VARIABLES], *upper[CUBE_MAX_VARIABLES];   /* [n_moved] */
  PetscReal  own[CUBE_MAX_VARIABLES];                                 /* t of the scene's own values */
} Cube;

/* What modes are about: no sliding state, that of the scene everywhere, each point's own */
typedef enum { CUBE_NO_STATE, CUBE_HELD_STATE, CUBE_OWN_STATE } CubeState;

/* What options with that prefix ("quiet") say, of parameters that the operators have; `nominal` of the cube is set.
   Collective.
   Errors: PETSC_ERR_USER_INPUT for names, values and boxes that cannot be. */
PETSC_INTERN PetscErrorCode CubeRead(MPI_Comm comm, Operators operators, CubeState state, const char prefix[],
                                     const CubeOptions *options, Cube *cube);
PETSC_INTERN PetscErrorCode CubeDestroy(Cube *cube);
/* All parameters p of a point t [n] */
PETSC_INTERN void CubePoint(const Cube *cube, const PetscReal t[], PetscReal p[]);
/* Those of the variables alone, the others stay */
PETSC_INTERN void CubeMove(const Cube *cube, const PetscReal t[], PetscReal p[]);
/* The first parameter of variable k at t */
PETSC_INTERN PetscReal CubeValue(const Cube *cube, PetscInt k, PetscReal t);
/* How far a point is from the scene's own values: 0 there, 1 on the faces of the box. And the nearest point of a cell
   [n] to it */
PETSC_INTERN PetscReal CubeDistance(const Cube *cube, const PetscReal t[]);
PETSC_INTERN PetscReal CubeNear(const Cube *cube, const PetscReal low[], const PetscReal high[]);
/* Indices, variables and ends of all parameters that move: [CUBE_MAX_MOVED] each; how many there are */
#define CUBE_MAX_MOVED 64
PETSC_INTERN PetscInt CubeMoved(const Cube *cube, PetscInt parameter[], PetscInt variable[], PetscReal lower[],
                                PetscReal upper[]);
/* The names of all options that vary, with commas: for what a run reads */
PETSC_INTERN PetscErrorCode CubeVaried(const CubeOptions *options, size_t size, char varied[]);
