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
#define CAUSES_BLOCK 16 /* vectors that large matrices are multiplied with at once */

/* Vectors side by side, their real and imaginary parts, and a product with them */
typedef struct {
  PetscInt           n_columns;
  const CauseVector *v;
  PetscInt column[CAUSES_BLOCK]; /* of the real part; that of the imaginary one, where there is one, is next */
  Mat      X, AX;                /* NULL before the first product */
} CauseBlock;

/* Of n vectors, which stay where they are */
PETSC_INTERN PetscErrorCode CauseBlockCreate(PetscInt n, const CauseVector v[], CauseBlock *block);
/* A times all of them, where A is large enough for that to be cheaper than one by one; then the form of vector i, as by
   VectorForm() */
PETSC_INTERN PetscErrorCode CauseBlockMultiply(CauseBlock *block, Mat A, PetscBool *done);
PETSC_INTERN PetscErrorCode CauseBlockForm(const CauseBlock *block, PetscInt i, PetscReal form[2]);
PETSC_INTERN PetscErrorCode CauseBlockDestroy(CauseBlock *block);
/* The vector in the unknowns of the pencil, u = Zr q; NULL where nothing is projected, and the terms of all
   unknowns do. */
PETSC_INTERN PetscErrorCode VectorRestrict(Pencil pencil, const CauseVector *u, CauseVector *q);
PETSC_INTERN PetscErrorCode VectorDestroy(CauseVector *v);
/* product = y' A x, or y' A' x */
PETSC_INTERN PetscErrorCode VectorProduct(const CauseVector *y, Mat A, PetscBool turned, const CauseVector *x,
                                          PetscComplex *product);
