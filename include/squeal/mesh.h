/*
   Mesh - the part of the mesh that a rank has, as tables. Vertices and cells count from 0 on each rank. A cell is on one
   rank; a vertex that ranks share is on each of them, and one of them owns it.
*/
#pragma once

#include <petscsys.h>
#include <petscdmtypes.h>

typedef struct {
  DMPolytopeType     shape;                                 /* of all cells */
  PetscInt           n_vertices, n_cells, n_nodes, n_parts; /* n_nodes: corners of a cell */
  const PetscReal   *x;                                     /* [n_vertices][3] place, m */
  const PetscInt    *number;     /* [n_vertices] global number of the vertex, those of rank 0 first */
  const PetscBool   *owned;      /* [n_vertices] whether this rank owns it */
  const PetscInt    *unknown;    /* [n_vertices][3] global number of each displacement, -1 where a support fixes it
                                   or a motion prescribes it */
  const PetscReal   *prescribed; /* [n_vertices][3] displacement that a motion prescribes, m, else 0; NULL where none
                                    does */
  const PetscInt    *corner;     /* [n_cells][n_nodes] vertices, in the order of the element */
  const PetscInt    *cell_part;  /* [n_cells] index of the part */
  const char *const *part;       /* [n_parts] names */
  PetscInt           n_own, first_own; /* unknowns of this rank: first_own to first_own + n_own - 1 */
  PetscInt           n_unknowns;       /* of all ranks */
} Mesh;
