/*
   Mesh - the part of the mesh that a rank has, as tables. Nodes and cells count from 0 on each rank. A cell is on one
   rank; a node that ranks share is on each of them, and one of them owns it. Nodes of quadratic cells stand at the
   corners, on edges, and where the element has them on faces and inside.
*/
#pragma once

#include <squeal/element.h>

typedef struct {
  PetscInt              n_nodes, n_cells, n_parts;
  const PetscReal      *x;          /* [n_nodes][3] place, m */
  const PetscInt       *number;     /* [n_nodes] global number of the node, those of rank 0 first */
  const PetscBool      *owned;      /* [n_nodes] whether this rank owns it */
  const PetscInt       *unknown;    /* [n_nodes][3] global number of each displacement, -1 where a support fixes it
                                       or a motion prescribes it */
  const PetscReal      *prescribed; /* [n_nodes][3] displacement that a motion prescribes, m, else 0; NULL where none
                                       does */
  const Element *const *element;    /* [n_cells] row of the table of elements */
  const PetscInt       *cell_first; /* [n_cells + 1] where the nodes of a cell begin in cell_node */
  const PetscInt       *cell_node;  /* nodes of the cells, each in the order of its element */
  const PetscInt       *cell_part;  /* [n_cells] index of the part */
  const char *const    *part;       /* [n_parts] names */
  PetscInt              n_own, first_own; /* unknowns of this rank: first_own to first_own + n_own - 1 */
  PetscInt              n_unknowns;       /* of all ranks */
  PetscInt              n_apart;          /* of these that no node has, the last ones, all of the last rank */
} Mesh;

/* How many of the unknowns that no node has are this rank's, its last ones */
static inline PetscInt MeshCountApart(const Mesh *mesh)
{
  return mesh->first_own + mesh->n_own == mesh->n_unknowns ? PetscMin(mesh->n_apart, mesh->n_own) : 0;
}

/* Faces of a surface: node[first[f] .. first[f + 1]) are the local nodes of face f, corners first, counter-clockwise
   seen from outside of the body, then mid-side nodes (after corner i that between corners i and i + 1), then the middle
   one. Their number tells the shape: 3, 6 of triangles, 4, 8, 9 of quadrilaterals (kernels/contact/facet.h) */
typedef struct {
  PetscInt n, *first, *node;
} ModelFaces;

/*@ ModelFacesGet - the nodes of face f and their places x (m), as many as it returns. Not collective. @*/
static inline PetscInt ModelFacesGet(const ModelFaces *faces, const Mesh *mesh, PetscInt f, const PetscInt **node,
                                     PetscReal x[][3])
{
  const PetscInt n = faces->first[f + 1] - faces->first[f];

  *node = &faces->node[faces->first[f]];
  for (PetscInt i = 0; i < 3 * n; i++) x[i / 3][i % 3] = mesh->x[3 * (*node)[i / 3] + i % 3];
  return n;
}
