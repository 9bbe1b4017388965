/*
   Shape (private to dynamics/) - one complex mode, read from the files of a run of modes and laid on the mesh of this
   run.
*/
#pragma once

#include "base/process/fault.h"
#include <squeal/model.h>

/* Mesh and shape of the file */
typedef struct {
  PetscInt   n_points, n_cells;
  PetscReal *points, *re, *im; /* [n_points][3], m */
  PetscInt  *first, *nodes;    /* [n_cells + 1] where the nodes of a cell begin in nodes */
  PetscReal *centres;          /* [n_cells][3], m */
  PetscReal *height;           /* [n_cells] ascending: places of the centres along `oblique`, m */
  PetscInt  *cell;             /* [n_cells] of each height */
  PetscReal  tolerance;        /* m */
} Shape;

/* Which arrays of which file are asked for, and by which option: for messages */
typedef struct {
  const char *option, *number; /* that name the folder, and the mode */
  const char *made_by;         /* with which a run of modes writes the file */
  const char *dir;             /* folder of the run of modes */
  const char *file;            /* modes.h5, filters.h5 */
  const char *kind;            /* arrays mode_###<kind>_re and _im: "", "_u", "_v" */
  PetscInt    mode;            /* number in modes.csv */
} ShapeSource;

/* start/file.c - lambda = sigma + i omega (1/s) of a mode from modes.csv in the folder, and mesh and shape from the
   file, which the caller frees; what is wrong goes to the fault. Not collective. */
PETSC_INTERN PetscErrorCode ShapeReadTable(const ShapeSource *source, PetscReal lambda[2], Fault *fault);
PETSC_INTERN PetscErrorCode ShapeReadField(const ShapeSource *source, PetscReal omega, Shape *shape, Fault *fault);

/* start/file.c - numbers of the modes that modes.csv in folder dir, named by option, calls unstable; the caller frees
   them. Collective. Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_USER_INPUT for a table without such a column. */
PETSC_INTERN PetscErrorCode ShapeListUnstable(MPI_Comm comm, const ShapeSource *source, PetscInt *n, PetscInt **modes);

/* shape.c - a mode at the local nodes [n_nodes][3] of the model: real and imaginary part, and lambda. Nodes are
   found by position, so that the ranks of the runs may differ. Collective. Errors: PETSC_ERR_FILE_OPEN,
   PETSC_ERR_USER_INPUT for a mode or mesh that does not agree. */
PETSC_INTERN PetscErrorCode ShapeRead(Model model, const ShapeSource *source, PetscReal re[], PetscReal im[],
                                      PetscReal lambda[2]);
