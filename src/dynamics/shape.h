/*
   Shape (private to dynamics/) - one complex mode, read from the files of a run of modes and laid on the mesh of this
   run.
*/
#pragma once

#include "base/fault.h"
#include <squeal/model.h>

/* Mesh and shape of the file */
typedef struct {
  PetscInt   n_nodes; /* of a cell */
  PetscInt   n_points, n_cells;
  PetscReal *points, *re, *im; /* [n_points][3], m */
  PetscInt  *corners;          /* [n_cells][n_nodes] */
  PetscReal *centres;          /* [n_cells][3], m */
  PetscReal *height;           /* [n_cells] ascending: places of the centres along `oblique`, m */
  PetscInt  *cell;             /* [n_cells] of each height */
  PetscReal  tolerance;        /* m */
} Shape;

/* shapefile.c - lambda = sigma + i omega (1/s) of a mode from modes.csv in folder dir, and from modes.h5 mesh and shape,
   which the caller frees; what is wrong goes to the fault. Not collective. */
PETSC_INTERN PetscErrorCode ShapeReadTable(const char dir[], PetscInt mode, PetscReal lambda[2], Fault *fault);
PETSC_INTERN PetscErrorCode ShapeReadField(const char dir[], PetscInt mode, PetscReal omega, Shape *shape,
                                           Fault *fault);

/* shape.c - mode `mode` at the local vertices [n_vertices][3] of the model: real and imaginary part, and lambda. Nodes
   are found by position, so that the ranks of the runs may differ. Collective. Errors: PETSC_ERR_FILE_OPEN,
   PETSC_ERR_USER_INPUT for a mode or mesh that does not agree. */
PETSC_INTERN PetscErrorCode ShapeRead(Model model, const char dir[], PetscInt mode, PetscReal re[], PetscReal im[],
                                      PetscReal lambda[2]);
