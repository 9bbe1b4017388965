/*
   Element - a formulation of a cell: its shape, the order of its nodes, and its matrices. The formulations are a table
   (model/element.c); a further shape or formulation is one more row.
*/
#pragma once

#include <petscdmplex.h>
#include <squeal/elasticity.h>

#define ELEMENT_MAX_NODES 20
#define ELEMENT_MAX_DOFS  (3 * ELEMENT_MAX_NODES)

typedef struct {
  const char    *formulation; /* value of -model_element */
  const char    *description; /* for -squeal_view */
  DMPolytopeType shape;
  PetscInt       n_nodes;
  PetscInt       closure_order[ELEMENT_MAX_NODES]; /* element node i is vertex closure_order[i] of the DMPlex closure */

  /* Stiffness (N/m) and consistent mass (kg), row-major [3 n_nodes][3 n_nodes], of corners x[n_nodes][3] (m).
     Returns 0, or 1 when the Jacobian is not positive at some point: then nothing is written. */
  int (*matrices)(const double *x, const Elasticity *material, double *stiffness, double *mass);

  /* Geometric stiffness (N/m), row-major [3 n_nodes][3 n_nodes], of the stress of displacements u[n_nodes][3] (m) of
     corners x; returns as matrices() does. */
  int (*geometric)(const double *x, const Elasticity *material, const double *u, double *stiffness);

  /* Volume (m^3) and the smallest Jacobian over quadrature points and corners relative to the volume of the cell's
     bounding box; not positive means inverted or flat. */
  void (*measure)(const double *x, double *volume, double *min_jacobian);
} Element;

/*@ ElementFind - the row of the table with this shape and formulation, or NULL. Not collective. @*/
const Element *ElementFind(DMPolytopeType shape, const char formulation[]);

/*@ ElementNames - the formulations as "incompatible, full", for messages. Not collective. @*/
const char *ElementNames(void);
