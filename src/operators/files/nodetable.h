/* Private to operators/: nodes of matrices without a mesh, -operators_nodes */
#pragma once

#include "operators/operatorsimpl.h"

#define NODES_MAX_PARTS 64
#define NODES_MAX_NAME  64

/* A line of the table */
typedef struct {
  PetscInt  unknown, node, direction, part; /* unknown from 0; direction 1 to 3 along x, y, z, else 0 */
  PetscReal x[3];
} NodeRow;

/* All lines, on every rank */
typedef struct {
  PetscInt n, n_parts;
  NodeRow *row;
  char     part[NODES_MAX_PARTS][NODES_MAX_NAME];
} NodeTable;

/* The points as a mesh whose cells are points */
struct _p_Cloud {
  Mesh            mesh; /* a share of the nodes on each rank */
  Vec             values;
  VecScatter      scatter; /* from the unknowns to values, those of the local nodes that there are */
  PetscInt       *at;      /* [length of values] 3 node + direction */
  PetscReal      *x;
  PetscInt       *number, *unknown, *cell_first, *cell_node, *cell_part;
  PetscBool      *owned;
  const Element **element;
  char          **part;
};

/* nodetable.c - reads the table of n_unknowns; the caller frees row. Collective. Errors: PETSC_ERR_FILE_UNEXPECTED with
   the line */
PETSC_INTERN PetscErrorCode NodeTableRead(MPI_Comm comm, const char file[], PetscInt n_unknowns, NodeTable *table);

/* cloud.c - the points of -operators_nodes, once the matrices are there */
PETSC_INTERN PetscErrorCode CloudCreate(Operators operators);
PETSC_INTERN PetscErrorCode CloudDestroy(Operators operators);
