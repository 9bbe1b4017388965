/* Private to model/: cells that the partition leaves together */
#pragma once

#include <squeal/model.h>

/* Sets of cells of the undistributed mesh, each of which stays on one rank */
typedef struct {
  PetscInt  n, n_cells;
  PetscInt *of_cell; /* [n_cells] set of the cell, -1 when it is alone */
  PetscInt *cost;    /* [n_cells] of a cell, relative to the others */
} Clusters;

/* A swept body that ranks share: slab k, between nodes k and k + 1 of its lines, is cluster first + k */
typedef struct {
  PetscInt    first, n_slabs, cost; /* cost of a slab */
  ModelLines *lines;
} SlabChain;

/* The swept bodies that ranks share, on the rank of the mesh */
typedef struct {
  PetscInt   n;
  SlabChain *chain;
  PetscReal *centre; /* [cells][3] mean of the corners, m */
} Slabs;

/* together.c - makes the cells at the contact a cluster, unless they are more than a rank's share. Collective. */
PETSC_INTERN PetscErrorCode TogetherFind(Model model, PetscInt n_ranks, Clusters *clusters);

/* together.c - flags the cells at the contact; at_contact [cells] on the rank of the mesh */
PETSC_INTERN PetscErrorCode TogetherFlag(Model model, PetscBool at_contact[]);

/* slabs.c - makes the slabs of swept bodies clusters, and bodies that fit on a rank whole ones; the costs of cells.
   Collective. */
PETSC_INTERN PetscErrorCode SlabsFind(Model model, PetscInt n_ranks, Clusters *clusters, Slabs *slabs);
PETSC_INTERN PetscErrorCode SlabsDestroy(Slabs *slabs);

/* slabs.c - deals out the slabs in rows so that all ranks have the same cost, given the ranks [cells] of all other
   cells. Not collective. */
PETSC_INTERN PetscErrorCode SlabsDeal(const Slabs *slabs, const Clusters *clusters, PetscInt n_ranks, PetscInt rank[]);
