/* Private to sweep/: branches of a sweep in full, from point to point */
#pragma once

#include "sweep/line.h"

/* A point whose modes are to be found again at the next one */
typedef struct {
  Mat          C;       /* damping of all unknowns there; NULL without */
  BV           vectors; /* [modes.size] orthonormal, of all unknowns */
  ReducedModes modes;   /* in coordinates of these */
  BranchMemory memory;  /* the same */
  PetscInt    *branch;  /* [modes.n] */
  PetscInt     place;   /* of the grid */
  PetscReal    value;   /* of the line's parameter */
} FollowPoint;

/* The point before, and the first one of its line, which the first one of the next line begins at; as {0} */
typedef struct {
  FollowPoint *before, *first;
} Follow;

/* follow.c - branches of place i of the line, whose modes the eigensolver has just found for the pencil. Collective. */
PETSC_INTERN PetscErrorCode FollowTake(Sweep sweep, Pencil pencil, PetscInt i, LinePoints *points, Follow *follow);
PETSC_INTERN PetscErrorCode FollowDestroy(Follow *follow);

/* full/basis.c - the modes that were found, as a line keeps them, with the vectors of the eigensolver; their basis is
   that of a point before (NULL: none), extended. Collective, like all that follow. */
PETSC_INTERN PetscErrorCode FollowRead(Sweep sweep, const FollowPoint *from, const ReducedModes *found,
                                       FollowPoint *point);
/* The same modes in a basis of size vectors, that begins with theirs or, with U [size][their size], is V U */
PETSC_INTERN PetscErrorCode FollowMove(const ReducedModes *modes, PetscInt size, const PetscReal U[], ReducedModes *to);
/* The pencil between the vectors of a point, with the damping of the point as far as parameter 0 is 1, and as far as
   parameter 1 is that of the point before; the point takes a copy of its damping */
PETSC_INTERN PetscErrorCode FollowModel(Pencil pencil, const FollowPoint *from, FollowPoint *point, Reduced *reduced);
PETSC_INTERN PetscErrorCode FollowModelDestroy(Reduced *reduced);
/* full/keep.c - a point behind others in a pack, or out of it into a new one, with its vectors beside it */
PETSC_INTERN PetscErrorCode FollowPointMove(MPI_Comm comm, JournalPack *pack, FollowPoint *point, JournalItem *vectors);

/* keptpoints.c - goes on from what is kept of a sweep in full, or on real modes: all but the places; then place i of a
   line, as long as it is one of these; keeps the sweep after place i. Collective. */
PETSC_INTERN PetscErrorCode SweepResumePlaces(Sweep sweep, Follow *follow);
PETSC_INTERN PetscErrorCode SweepTakePlace(Sweep sweep, PetscInt i, LinePoints *points, PetscBool *taken);
PETSC_INTERN PetscErrorCode SweepKeepPlace(Sweep sweep, PetscInt i, LinePoints *points, Follow *follow);

/* Leaves of the basis what the vectors of the point and its memory span */
PETSC_INTERN PetscErrorCode FollowShrink(FollowPoint *point);
