/* For rooms in which motions move nodes: what prescribed displacements d alone do to pairs, m = e . (d_m - d_s) along a
   direction e; nodes of both sides may be on any rank */
#pragma once

#include <squeal/contact.h>

/* A node that a motion moves */
typedef struct {
  PetscInt  number; /* over all ranks */
  PetscReal d[3];   /* m */
} MovedVertex;

/* MovedVerticesGather - those of all ranks, ascending, on every rank, of displacements at the local nodes [nodes][3];
   the caller frees them. Collective. */
PETSC_INTERN PetscErrorCode MovedVerticesGather(MPI_Comm comm, const Mesh *mesh, const PetscReal nodal[], PetscInt *n,
                                                MovedVertex **all);

/* MovedApart - d_m - d_s of a pair, m. Not collective. */
PETSC_INTERN void MovedApart(PetscInt n, const MovedVertex all[], const ContactPair *pair, PetscReal d[3]);
