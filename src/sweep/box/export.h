/* Private to sweep/box/: what reduced_model.bin holds (export.c) */
#pragma once

#include "box.h"

/* A power of a variable, one factor of a coefficient */
typedef struct {
  PetscInt  variable, power;
  PetscBool absolute;
} ExportFactor;

/* Parameters that move in step, p_i = ratio_i v, are one variable v: the first of them */
typedef struct {
  PetscInt   n;
  PetscInt  *of;    /* [varied->n] the variable of each parameter, */
  PetscReal *ratio; /* and beside it */
  PetscInt  *first; /* [n] index of v among the varied parameters */
} ExportVariables;

/* Terms with the same monomial of the variables, as one: A, or, of pairs that are open at some points, rows
   A = sum_r closed_r left_r' right_r, right_r of length 1, left_r = weight_r right_r where `along` */
typedef struct {
  OperatorsTermKind kind;
  PetscInt          n_factors;
  ExportFactor      factor[OPERATORS_MAX_FACTORS];
  PetscBool         symmetric, zero;
  PetscReal        *A; /* [n][n] by columns; of a symmetric one, when all are there, its lower triangle */
  PetscInt          n_rows, *group;
  PetscBool         along;
  PetscInt          rows_of; /* an earlier term with the same right rows, -1: its own */
  PetscReal        *left, *right, *weight;
} ExportTerm;

typedef struct {
  PetscInt    n, n_terms;
  ExportTerm *term; /* K, C, M that nothing varies, then the others */
} ExportTerms;

PETSC_INTERN PetscErrorCode ExportVariablesCreate(const Box *box, const BoxVaried *varied, ExportVariables *v);
PETSC_INTERN PetscErrorCode ExportVariablesDestroy(ExportVariables *v);
/* Of the model; `made` is false where a coefficient is no monomial of the variables */
PETSC_INTERN PetscErrorCode ExportTermsCreate(const Box *box, const Reduced *reduced, const BoxVaried *varied,
                                              const ExportVariables *v, ExportTerms *terms, PetscBool *made);
PETSC_INTERN PetscErrorCode ExportTermsDestroy(ExportTerms *terms);
