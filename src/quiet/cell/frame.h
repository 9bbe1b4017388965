/*
   Private to quiet/: the reduced model over a cell, in the eigenvectors of its middle. Pure functions: no MPI, no
   options.

      W (A(p) - s B(p)) X = Lambda + E(p) - s (I + B'(p)),   s = lambda damped, s = kappa = -lambda^2 undamped
*/
#pragma once

#include "enclosure.h"
#include "sweep/dense/reduced.h"

typedef struct {
  PetscInt      N;
  PetscBool     damped;
  PetscInt      d;     /* variables */
  PetscComplex *value; /* [N] lambda or kappa of the middle */
  PetscReal    *F;     /* [N * N] by rows: largest |E_kl| at s = value_k over the cell, without E_kk's linear part */
  PetscReal    *B;     /* [N * N] largest |B'_kl| */
  PetscReal    *rest;  /* [N] of the diagonal beyond its linear part */
  PetscComplex *shift; /* [d][N] half width times d E_kk / dt_j */
  PetscReal    *influence; /* [d][N] of a variable on the rows, for the choice where to cut */
} CellFrame;

/* The cell [low, high] of t. Without damping in it the problem of kappa is taken. */
PETSC_INTERN PetscErrorCode CellFrameCreate(const Reduced *reduced, const Cube *cube, const PetscReal low[],
                                            const PetscReal high[], PetscReal scale, CellFrame *frame);
PETSC_INTERN PetscErrorCode CellFrameDestroy(CellFrame *frame);

/* What must not happen, rad/s: growth above the limit in the band; error, relative: of the model's eigenvalues */
typedef struct {
  PetscReal  low, high, error;
  ModesLimit limit;
} CellRegion;

/* certificate.c - whether no eigenvalue is in the region anywhere in the cell; margin, rad/s: how much further growth
   (undamped: half the least gap between neighbours) may go; axis: which variable to cut where it is not shown */
PETSC_INTERN PetscErrorCode CellFrameIsQuiet(const CellFrame *frame, const CellRegion *region, PetscBool *quiet,
                                             PetscReal *margin, PetscInt *axis);
/* Whether one is in it everywhere in the cell */
PETSC_INTERN PetscErrorCode CellFrameIsDangerous(const CellFrame *frame, const CellRegion *region,
                                                 PetscBool *dangerous);
