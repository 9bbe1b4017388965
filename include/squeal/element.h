/*
   Element - a formulation of a cell: its shape, its nodes, its matrices and its type in output. The formulations are a
   table (model/element.c); a further element is one more row.

   Nodes have VTK's order: corners, then those on edges, on faces, and inside.
*/
#pragma once

#include <petscdm.h>
#include <squeal/elasticity.h>

#define ELEMENT_MAX_ROWS    16 /* of the table */
#define ELEMENT_MAX_CORNERS 8
#define ELEMENT_MAX_NODES   27
#define ELEMENT_MAX_DOFS    (3 * ELEMENT_MAX_NODES)

struct Solid; /* shape functions and quadrature, kernels/element/solid.h */

typedef struct {
  const char    *formulation; /* value of -model_element; NULL for a shape that has one formulation alone */
  const char    *description; /* for -squeal_view */
  const char    *name;        /* "tet10" */
  const char    *xdmf;        /* TopologyType of XDMF */
  const char    *warning;     /* printed where the element is used, or NULL */
  DMPolytopeType shape;
  int            vtk, xdmf_number; /* types in output; the latter in meshes of several elements */
  PetscInt       n_nodes, n_corners;
  PetscInt       closure_order[ELEMENT_MAX_CORNERS]; /* corner i is vertex closure_order[i] of the DMPlex closure */
  const unsigned char *at; /* [n_nodes] node i stands in the middle of the corners whose bits are set */
  PetscBool row_sums; /* lumped mass: row sums of the consistent one where positive, else its diagonal, scaled (HRZ) */
  const struct Solid *solid;

  /* Stiffness (N/m) and consistent mass (kg), row-major [3 n_nodes][3 n_nodes], of nodes x[n_nodes][3] (m).
     Returns 0, or 1 when the Jacobian is not positive at some point: then nothing is written. */
  int (*matrices)(const struct Solid *solid, const double *x, const Elasticity *material, double *stiffness,
                  double *mass);

  /* Geometric stiffness (N/m), row-major [3 n_nodes][3 n_nodes], of the stress of displacements u[n_nodes][3] (m) of
     nodes x; returns as matrices() does. */
  int (*geometric)(const struct Solid *solid, const double *x, const Elasticity *material, const double *u,
                   double *stiffness);

  /* Volume (m^3) and the smallest Jacobian at the points that the element looks at, relative to that of the cell's
     bounding box; not positive means inverted or flat. */
  void (*measure)(const struct Solid *solid, const double *x, double *volume, double *min_jacobian);
} Element;

/*@ ElementFind - the row of the table with this shape, number of nodes and formulation, or NULL. Not collective. @*/
const Element *ElementFind(DMPolytopeType shape, PetscInt n_nodes, const char formulation[]);

/*@ ElementGet - row i of the table, NULL after the last. Not collective. @*/
const Element *ElementGet(PetscInt i);

/*@ ElementPoint - a cell that is a node, for output of points; no row of the table. Not collective. @*/
const Element *ElementPoint(void);

/*@ ElementIsFormulation - whether some row has this formulation. Not collective. @*/
PetscBool ElementIsFormulation(const char formulation[]);

/*@ ElementFormulations - the formulations as "incompatible, full", for messages. Not collective. @*/
const char *ElementFormulations(void);

/*@
   ElementMatrices - stiffness (N/m) and consistent mass (kg) of an element, and ElementGeometric() the geometric
   stiffness (N/m) of displacements u (m); row-major [3 n_nodes][3 n_nodes], of nodes x [n_nodes][3], m. Not collective.

   Errors: PETSC_ERR_PLIB for a Jacobian that is not positive, which ModelSetUp() refuses.
@*/
PetscErrorCode ElementMatrices(const Element *element, const PetscReal x[], const Elasticity *material,
                               PetscReal stiffness[], PetscReal mass[]);
PetscErrorCode ElementGeometric(const Element *element, const PetscReal x[], const Elasticity *material,
                                const PetscReal u[], PetscReal stiffness[]);

/*@
   ElementLump - lumped mass (kg) of each node, from the consistent mass [3 n_nodes][3 n_nodes] of the element: row
   sums, or where these are not positive at every node the diagonal, scaled to the mass of the element. Not collective.

   E. Hinton, T. Rock, O. C. Zienkiewicz, A note on mass lumping and related processes in the finite element method,
   Earthquake Engineering and Structural Dynamics 4 (1976) 245-249.
@*/
void ElementLump(const Element *element, const PetscReal mass[], PetscReal lumped[]);
