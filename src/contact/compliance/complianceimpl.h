/* Private to contact/compliance/. All in metres: l = lambda / kappa per pair, v = r less slip0 along the tangents. */
#pragma once

#include "contactcompliance.h"
#include "kernels/coulomb.h"

#include <petscblaslapack.h>

/* Natural map of all pairs at l, v */
typedef struct {
  PetscReal largest; /* of one pair, m */
  PetscReal norm;    /* root of the sum of squares, m */
  PetscReal scale;   /* largest l */
  PetscReal noise;   /* rounding of v at closed pairs */
  PetscInt  worst;   /* pair of `largest` */
} ComplianceMiss;

struct _p_ContactCompliance {
  PetscInt         n;
  const PetscReal *W;
  PetscReal       *kappa;              /* N/m, [n] */
  PetscReal       *mu, *slope, *speed; /* [n] */
  PetscReal        dt, rtol;
  PetscReal       *free;    /* v without forces, [n][3] */
  PetscReal       *l, *v;   /* now, [n][3] */
  PetscReal       *l0, *v0; /* before a step of Newton's method */
  PetscReal       *best;    /* l of the least residual, [n][3] */
  PetscReal       *force;   /* kappa l, [n][3] */
  ContactStatus   *status;  /* [n] */
  CoulombLaw      *law;     /* [n], of closed pairs */
  PetscInt         n_closed, *closed;
  PetscReal        blend;   /* t: (1 - t) W kappa + t I stands for W kappa */
  PetscReal       *A, *rhs; /* [rows][rows] of closed pairs and a border, [rows] */
  PetscBLASInt    *pivot;
  PetscInt         n_room; /* rows that there is room for */
  ComplianceReport report, totals;
};

/* law.c - v at l; its natural map; statuses that l, v ask for and the laws of the closed pairs there */
PETSC_INTERN PetscErrorCode ComplianceMove(ContactCompliance c);
PETSC_INTERN void           ComplianceMeasure(const ContactCompliance c, ComplianceMiss *miss);
PETSC_INTERN PetscBool      ComplianceIsSolved(const ContactCompliance c, const ComplianceMiss *miss);
PETSC_INTERN void           ComplianceChoose(ContactCompliance c);
PETSC_INTERN void           ComplianceLinearise(ContactCompliance c);

/* linear.c - matrix of the closed pairs at the present laws, its factors */
PETSC_INTERN PetscErrorCode ComplianceAssemble(ContactCompliance c, PetscInt border);
PETSC_INTERN PetscErrorCode ComplianceFactor(ContactCompliance c, PetscInt border, PetscBool *singular);
PETSC_INTERN void           ComplianceShift(ContactCompliance c, PetscInt border);
PETSC_INTERN PetscErrorCode ComplianceBackSolve(const ContactCompliance c, PetscInt border);
PETSC_INTERN void           ComplianceTake(ContactCompliance c);

/* newton.c - one step on l, v; iterations, at most max_it; damped = with a line search */
PETSC_INTERN PetscErrorCode ComplianceStep(ContactCompliance c, PetscBool *singular);
PETSC_INTERN PetscErrorCode ComplianceIterate(ContactCompliance c, PetscBool damped, PetscInt max_it,
                                              ComplianceMiss *miss);

/* path.c - from W kappa = I */
PETSC_INTERN PetscErrorCode ComplianceFollow(ContactCompliance c, ComplianceMiss *miss);
