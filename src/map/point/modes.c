/*
   What the eigenvalues lambda = sigma + i omega about the sliding state say of a point: the mode that grows fastest,
   the largest growth over angular frequency, and all modes that grow, with how many of them are beyond the limit of
   what is unstable (modes/growth/state.c). A real lambda above what rounding makes of a rigid mode is divergence, of
   frequency 0; other real ones are overdamped or rigid modes and count for nothing.
*/
#include "map/mapimpl.h"

#define MODES_ROUNDING 1e-6 /* of the highest |lambda|: a real one below is that of a rigid mode */

/* Whether an eigenvalue is a mode: one of each conjugate pair, or divergence */
static PetscBool LambdaIsMode(PetscReal sigma, PetscReal omega, PetscReal highest)
{
  return omega > 0 || (omega == 0 && sigma > MODES_ROUNDING * highest) ? PETSC_TRUE : PETSC_FALSE;
}

/* The largest |lambda|, rad/s */
static PetscReal LambdaHighest(PetscInt n, const PetscReal sigma[], const PetscReal omega[])
{
  PetscReal highest = 0;

  for (PetscInt k = 0; k < n; k++) highest = PetscMax(highest, hypot(sigma[k], omega[k]));
  return highest;
}

void MapModesJudge(PetscInt n, const PetscReal sigma[], const PetscReal omega[], MapFastest *fastest)
{
  const PetscReal highest = LambdaHighest(n, sigma, omega);

  *fastest = (MapFastest){-PETSC_INFINITY, 0, -PETSC_INFINITY};
  for (PetscInt k = 0; k < n; k++) {
    if (!LambdaIsMode(sigma[k], omega[k], highest)) continue;
    fastest->index = PetscMax(fastest->index, sigma[k] / hypot(sigma[k], omega[k]));
    if (sigma[k] <= fastest->growth) continue;
    fastest->growth = sigma[k];
    fastest->freq   = omega[k] / (2 * PETSC_PI);
  }
}

/* The growing modes by insertion, fastest first, as many as a row has room for; n_growing and n_unstable count all. */
void MapModesTake(PetscInt n, const PetscReal sigma[], const PetscReal omega[], const ModesLimit *limit, MapPoint *row)
{
  const PetscReal highest = LambdaHighest(n, sigma, omega);

  row->n_growing = row->n_unstable = 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt i = PetscMin(row->n_growing, MAP_MAX_MODES);

    if (!(sigma[k] > 0) || !LambdaIsMode(sigma[k], omega[k], highest)) continue;
    row->n_growing++;
    row->n_unstable += ModesLimitJudge(limit, sigma[k], omega[k], 0) == MODE_UNSTABLE;
    if (i == MAP_MAX_MODES && sigma[k] <= row->sigma[--i]) continue;
    for (; i > 0 && row->sigma[i - 1] < sigma[k]; i--) {
      row->sigma[i] = row->sigma[i - 1];
      row->omega[i] = row->omega[i - 1];
    }
    row->sigma[i] = sigma[k];
    row->omega[i] = omega[k];
  }
}
