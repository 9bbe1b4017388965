/* Private to sample/: which variables a number depends on. Pure functions: no MPI, no options. */
#pragma once

#include <petscsys.h>

/* Of one variable; standard errors behind. NaN where there is none */
typedef struct {
  PetscReal first, first_error, total, total_error; /* indices of Sobol */
  PetscReal slope, slope_error;                     /* standardised coefficient of the regression */
} VariableIndex;

/* Rows of a design: values [n] at the points A and B, mixed [n_variables][n] those of A with one variable of B; NaN
   where one lacks */
typedef struct {
  PetscInt         n, n_variables;
  const PetscReal *a, *b, *mixed;
} SobolDesign;

/* first and total of all variables; rows that lack a value are left out, n_rows are left */
PetscErrorCode IndicesOfSobol(const SobolDesign *design, VariableIndex index[], PetscInt *n_rows);

/* Points and what is known there */
typedef struct {
  PetscInt         n, n_variables;
  const PetscReal *x, *y; /* [n][n_variables] the variables, [n] the number, NaN where it lacks */
} Regression;

/* slope of all variables by least squares, and the share of the variance of y that the straight line explains */
PetscErrorCode RegressionSlopes(const Regression *regression, VariableIndex index[], PetscReal *r_squared);
