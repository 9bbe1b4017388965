/* Private to modes/: which free modes of the bodies make up a mode (see components.c) */
#pragma once

#include "modes/modesimpl.h"

/* Parts that share nodes, ties or rigid points are one body */
typedef struct {
  PetscInt  n;
  char    **name; /* [n] the names of its parts with + between */
  PetscInt *of;   /* [unknowns of this rank] body of each */
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
  PetscReal *share;  /* [modes][levels + 1][bodies], the last one of the whole body: by left and right vector */
  PetscReal *energy; /* likewise, of the right vector alone */
  PetscReal *mixed;  /* [modes] what the shape is off by, as in FreeLevel */
};

/* bodies.c - bodies of the unknowns of a pencil whose pairs are open. Collective */
PETSC_INTERN PetscErrorCode FreeBodiesFind(Pencil pencil, FreeBodies *bodies);
