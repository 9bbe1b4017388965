/* Private to modes/: groups of ranks, each with the whole matrices, that share the parts of a band */
#pragma once

#include "modesimpl.h"

typedef struct {
  MPI_Comm       comm; /* all ranks */
  PetscInt       n;    /* groups */
  PetscInt       mine; /* the one of this rank */
  PetscSubcomm   ranks;
  PencilMatrices pencil; /* K and M among the ranks of this group */
  Vec            like;   /* a vector among all ranks */
} Groups;

/* All of it is collective on all ranks */
PETSC_INTERN PetscErrorCode GroupsCreate(MPI_Comm comm, PetscInt n, const PencilMatrices *pencil, Groups *groups);
/* Right and left modes of this group's part (NULL where it has none), in modes->right and modes->left_spectrum, with
   vectors among its ranks. An error of any group is raised by all. */
PETSC_INTERN PetscErrorCode GroupsSolve(Modes modes, const Groups *groups, Window *part);
/* What a group found, with vectors among all ranks */
PETSC_INTERN PetscErrorCode GroupsGather(const Groups *groups, PetscInt group, const Spectrum *from, Spectrum *to);
/* A number of a group's on all ranks */
PETSC_INTERN PetscErrorCode GroupsAgree(const Groups *groups, PetscInt group, PetscReal *value);
PETSC_INTERN PetscErrorCode GroupsDestroy(Groups *groups);
