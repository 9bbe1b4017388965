/* Private to operators/causes: products of complex vectors with the matrices of terms (products.c) */
#pragma once

#include "operators/pencilimpl.h"

/* A complex vector, x[1] NULL where it is real, and room for a product */
typedef struct {
  Vec x[2], y;
} CauseVector;

/* re + i im = x^H A x with x = x_r + i x_i: re = x_r'A x_r + x_i'A x_i, im = x_r'A x_i - x_i'A x_r, which is 0 but
   for rounding where A is symmetric */
PETSC_INTERN PetscErrorCode VectorForm(const CauseVector *v, Mat A, PetscReal form[2]);
/* The vector in the unknowns of the pencil, u = Zr q; NULL where nothing is projected, and the terms of all
   unknowns do. */
PETSC_INTERN PetscErrorCode VectorRestrict(Pencil pencil, const CauseVector *u, CauseVector *q);
PETSC_INTERN PetscErrorCode VectorDestroy(CauseVector *v);
/* product = y' A x, or y' A' x */
PETSC_INTERN PetscErrorCode VectorProduct(const CauseVector *y, Mat A, PetscBool turned, const CauseVector *x,
                                          PetscComplex *product);
