/* Private to modes/: the fit of a disc's out-of-plane displacement by harmonics and radial polynomials (see label.c) */
#pragma once

#include <petscsys.h>

#define DISC_HARMONICS   17 /* m = 0..16 */
#define DISC_POLYNOMIALS 5  /* Legendre, degree 0..4 */
#define DISC_TERMS       ((2 * DISC_HARMONICS - 1) * DISC_POLYNOMIALS)

typedef struct {
  MPI_Comm   comm;
  PetscBool  has_contact;
  PetscReal  centre[3], axis[3], e1[3], e2[3]; /* e1 points to the contact */
  PetscReal  r_inner, r_outer;                 /* m */
  PetscReal  size;                             /* radius of gyration, m */
  int        n_harmonics;                      /* of DISC_HARMONICS, those that the mesh resolves */
  PetscInt   n_nodes, n_columns; /* nodes of the disc on this rank; two right-hand sides per mode: re, im */
  PetscInt  *node;               /* their local nodes */
  PetscReal *weight;             /* nodal mass, kg */
  PetscReal *basis;              /* [n_nodes][DISC_TERMS] */
  PetscReal *gram;               /* [DISC_TERMS][DISC_TERMS] */
  PetscReal *fit;                /* [n_columns][DISC_TERMS]: right-hand sides, then coefficients */
} Disc;

/* A part that may be a disc */
typedef struct {
  PetscInt         n_vertices; /* local ones */
  const PetscReal *x, *mass;   /* [n_vertices][3] m, [n_vertices] kg */
  const PetscReal *contact;    /* centre of the contact, m; NULL without */
  const PetscBool *surface;    /* [n_vertices]: on a contact surface; NULL for none */
} DiscPart;

/* is_disc = whether two of the three principal moments of inertia agree within 5 %, so that there is an axis */
PETSC_INTERN PetscErrorCode DiscCreate(MPI_Comm comm, const DiscPart *part, PetscInt n_modes, Disc *disc,
                                       PetscBool *is_disc);
/* Adds the displacements u[local nodes][3] to right-hand side `column`, and their energy on this rank, all and out
   of plane, to energy */
PETSC_INTERN void           DiscProject(Disc *disc, PetscInt column, const PetscReal u[], PetscReal energy[2]);
PETSC_INTERN PetscErrorCode DiscSolve(Disc *disc);
/* P_0 .. P_4 of the radius r mapped to [-1, 1] */
PETSC_INTERN void           DiscLegendre(const Disc *disc, PetscReal r, PetscReal p[DISC_POLYNOMIALS]);
PETSC_INTERN PetscErrorCode DiscDestroy(Disc *disc);
/* label/name.c - "(circles,diameters+)" */
PETSC_INTERN PetscErrorCode DiscName(const Disc *disc, PetscInt mode, char name[], size_t size);
