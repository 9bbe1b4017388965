/* Private to modes/: kinds of shapes of a beam- or plate-like solid (solid.c) */
#pragma once

#include <petscsys.h>

/* none: no rule of these tells */
typedef enum {
  SOLID_NONE,
  SOLID_RIGID,
  SOLID_BENDING,
  SOLID_IN_PLANE,
  SOLID_TORSION,
  SOLID_LENGTHWISE,
  SOLID_ACROSS,
  N_SOLID_KINDS
} SolidKind;

#define SOLID_DEGREE 12                       /* of the polynomials along the solid, */
#define SOLID_FIELDS (4 * (SOLID_DEGREE + 1)) /* and the most fields of a kind */

/* A family of displacement fields, and its normal equations */
typedef struct {
  int        n;     /* fields */
  PetscReal *gram;  /* [n][n] kg of nodal mass; then its eigenvectors, */
  PetscReal *value; /* [n] with these eigenvalues */
} SolidFamily;

typedef struct {
  MPI_Comm         comm;
  PetscInt         n_nodes;    /* local ones */
  const PetscReal *x, *mass;   /* [n_nodes][3] m, [n_nodes] kg (borrowed) */
  PetscReal        centre[3];  /* m */
  PetscReal        axis[3][3]; /* principal ones, the longest first */
  PetscReal        half[3];    /* farthest node along each from the centre, m */
  PetscBool        is_long;    /* the rule for a kind other than rigid applies */
  PetscBool        is_even;    /* its section has no thin side: one kind of bending */
  SolidFamily      family[N_SOLID_KINDS];
} SolidFrame;

/* Collective; x and mass must stay */
PETSC_INTERN PetscErrorCode SolidCreate(MPI_Comm comm, PetscInt n_nodes, const PetscReal x[], const PetscReal mass[],
                                        SolidFrame *solid);
/* Adds to energy[N_SOLID_KINDS] what the fields of each kind explain of displacements u[n_nodes][3] by least squares,
   and at SOLID_NONE the whole, kg m^2. Collective */
PETSC_INTERN PetscErrorCode SolidAddEnergies(const SolidFrame *solid, const PetscReal u[], PetscReal energy[]);
/* The kind that such sums tell */
PETSC_INTERN SolidKind      SolidJudge(const PetscReal energy[]);
PETSC_INTERN const char    *SolidKindName(SolidKind kind);
PETSC_INTERN PetscErrorCode SolidDestroy(SolidFrame *solid);
