/* Private: what is estimated from samples of one number. Pure functions: no MPI, no options. */
#pragma once

#include <petscsys.h>

#define N_QUANTILES 5
extern const PetscReal SampleQuantiles[N_QUANTILES]; /* 0.01, 0.05, 0.5, 0.95, 0.99 */

/* Of n values; NaN where there are too few */
typedef struct {
  PetscInt  n;
  PetscReal mean, deviation, quantile[N_QUANTILES], least, most;
} Moments;

/* value [n] is sorted */
PetscErrorCode MomentsFind(PetscInt n, PetscReal value[], Moments *moments);
/* I_x(a, b), the regularised incomplete beta function */
PetscReal BetaProbability(PetscReal a, PetscReal b, PetscReal x);
/* The interval of confidence 0.95 of a probability, of k out of n: lower end for least, upper one for most of them */
void ClopperPearson(PetscInt least, PetscInt most, PetscInt n, PetscReal interval[2]);
