/* Private to modes/: which free modes of the bodies make up a mode (see components.c) */
#pragma once

#include "modes/modesimpl.h"

/* Parts that share nodes, ties or rigid points are one body */
typedef struct {
  PetscInt  n;
  char    **name;    /* [n] the names of its parts with + between */
  PetscInt *of;      /* [unknowns of this rank] body of each */
  PetscInt *of_part; /* [parts] body of each, -1 for a part without unknowns */
} FreeBodies;

/* Free modes of one frequency, which are any basis of a plane: they have one share */
typedef struct {
  PetscInt  first, n; /* modes of the pencil of the bodies */
  PetscReal omega;    /* rad/s */
  PetscReal mixed;    /* what its shapes are off by, relative */
  PetscBool rigid;
} FreeLevel;

/* A level of one body */
typedef struct {
  PetscInt n, first; /* of its modes that are of this body; before it in the body */
  char     name[32];
} FreeMode;

struct _p_ModesComponents {
  FreeBodies bodies;
  PetscInt   n_levels;
  FreeLevel *level;  /* [levels] by frequency */
  FreeMode  *free;   /* [levels][bodies] */
  PetscReal *own;    /* [free modes][bodies]: phi' M_b phi, which is 1 for the body that moves */
  PetscReal *share;  /* [modes][levels + 1][bodies], the last one of the whole body: by left and right vector */
  PetscReal *energy; /* likewise, of the right vector alone */
  PetscReal *mixed;  /* [modes] what the shape is off by, as in FreeLevel */
};

/* bodies.c - bodies of the unknowns of a pencil whose pairs are open. Collective */
PETSC_INTERN PetscErrorCode FreeBodiesFind(Pencil pencil, FreeBodies *bodies);
/* sums[b] += sum of a_u b_u over the unknowns of body b of this rank; a zero vector is NULL. Not collective */
PETSC_INTERN PetscErrorCode FreeBodiesAddDot(const FreeBodies *bodies, Vec a, Vec b, PetscReal sums[]);
/* names.c - numbers and names of the levels of each body; then new labels of the modes that are named after a part */
PETSC_INTERN PetscErrorCode FreeLevelsName(Modes modes, const Modes free, Mat M, ModesComponents c);
PETSC_INTERN PetscErrorCode ComponentsLabel(Modes modes);
