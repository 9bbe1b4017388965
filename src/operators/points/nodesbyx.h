/* Private to operators/: nodes of this rank in ascending x, for searches by place */
#pragma once

#include <squeal/mesh.h>

typedef struct {
  const Mesh *mesh;
  PetscReal  *x;     /* [n_nodes] ascending */
  PetscInt   *order; /* [n_nodes] their nodes */
} NodesByX;

/* nodesbyx.c - Not collective */
PETSC_INTERN PetscErrorCode NodesByXCreate(const Mesh *mesh, NodesByX *nodes);
/* nodesbyx.c - the first place in the order whose x is not less, n_nodes where there is none */
PETSC_INTERN PetscInt       NodesByXBegin(const NodesByX *nodes, PetscReal x);
PETSC_INTERN PetscErrorCode NodesByXDestroy(NodesByX *nodes);
