/* Private to model/: the test whether the cells of a body are swept by a motion */
#pragma once

#include <squeal/model.h>
#include "kernels/element/motion.h"

/* Largest difference of coordinates that are meant to be equal, of the size of the body: rounding alone, since whether
   a rank takes its piece of a body for swept must not show in the forces */
#define LINES_TOLERANCE 1e-12
#define LINES_CORNERS   8

/* The cells of a body, and the nodes that they have */
typedef struct {
  PetscInt   n_nodes, n_cells;
  PetscInt  *vertex;  /* [n_nodes] local vertices from 0 */
  PetscInt  *corners; /* [n_cells][LINES_CORNERS] nodes */
  PetscInt  *part;    /* [n_cells] */
  PetscReal *x;       /* [n_nodes][3], m */
  PetscReal  size;    /* diagonal of the bounding box, m */
} Piece;

/* swept.c - the lines of a body that the motion sweeps, in the coordinates of both, hence without a frame and centre;
   NULL where it does not. Not collective. */
PETSC_INTERN PetscErrorCode SweptCreateLines(const Piece *piece, const Motion *motion, ModelLines **lines);
