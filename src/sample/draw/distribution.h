/*
   Private to sample/: distributions of one variable by their quantile functions, x = F^-1(u). Pure functions: no MPI,
   no options.
*/
#pragma once

#include <petscsys.h>

typedef enum {
  DISTRIBUTION_NORMAL,
  DISTRIBUTION_LOGNORMAL,
  DISTRIBUTION_UNIFORM,
  DISTRIBUTION_TRIANGULAR,
  DISTRIBUTION_TABLE
} DistributionKind;

/* Mean and deviation are those of normal and lognormal x before they are cut; uniform and triangular ones lie between
   lower and upper, all others are cut there, where these are finite */
typedef struct {
  DistributionKind kind;
  PetscReal        mean, deviation, lower, upper, peak;
  PetscInt         n; /* of a table: F is probability[k] at value[k], both ascending, 0 and 1 at the ends, and straight
                         between */
  PetscReal       *value, *probability;
} Distribution;

/* Quantile of the standard normal distribution, and its probability of less than z */
PetscReal NormalQuantile(PetscReal u);
PetscReal NormalProbability(PetscReal z);
/* Quantile of u in (0, 1) */
PetscReal DistributionQuantile(const Distribution *d, PetscReal u);
