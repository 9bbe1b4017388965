/*
   What several transients of a point say of its amplitude together. The level of each is the mean square of its
   windows. That of n transients differs from that of n others by sqrt(2 / n) times the spread of one, of which there
   are two estimates: between the transients, with Student's t of n - 1, and within them, with the correlation of
   windows one after the other; the larger one counts (batch means: C. Alexopoulos, A. F. Seila, Output data analysis,
   in: Handbook of Simulation, 1998).
*/
#include "map/mapimpl.h"

#define SPREAD_MOST 0.8 /* correlation of windows one after the other */

PetscErrorCode MapSpreadQuantiles(PetscInt n, PetscReal x[], PetscReal quantile[MAP_N_QUANTILES])
{
  static const PetscReal share[MAP_N_QUANTILES] = {0.05, 0.5, 0.95};

  PetscFunctionBeginUser;
  PetscCall(PetscSortReal(n, x));
  for (int k = 0; k < MAP_N_QUANTILES; k++) {
    const PetscReal at = share[k] * (PetscReal)(n - 1);
    const PetscInt  i  = PetscMin((PetscInt)at, PetscMax(n - 2, 0));

    quantile[k] = n > 1 ? x[i] + (at - (PetscReal)i) * (x[i + 1] - x[i]) : n ? x[0] : NAN;
  }
  PetscFunctionReturn(0);
}

/* Student's t of n degrees of freedom, two-sided 95 %; from 13 on that of 13, at most a tenth too large. */
static PetscReal StudentT(PetscInt n)
{
  static const PetscReal t[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179};

  return n < 1 ? NAN : n <= (PetscInt)PETSC_STATIC_ARRAY_LENGTH(t) ? t[n - 1] : 2.16; /* that of 13 */
}

/* t sqrt(2 / n) s, s^2 = sum (x - mean)^2 / (n - 1): what the mean of n others differs by in 5 of 100. */
PetscReal MapSpreadOfMean(PetscInt n, const PetscReal x[])
{
  PetscReal mean = 0, square = 0;

  for (PetscInt i = 0; i < n; i++) mean += x[i] / (PetscReal)n;
  for (PetscInt i = 0; i < n; i++) square += PetscSqr(x[i] - mean);
  return n > 1 ? StudentT(n - 1) * PetscSqrtReal(2 * square / (PetscReal)((n - 1) * n)) : 0;
}

/* Squared standard error of the mean square of a run, from its windows, of which neighbours resemble each other:
   var / n (1 + r) / (1 - r), r their correlation, of which 1 / n is lost with the mean (AR(1)) */
static PetscReal SpreadWithin(PetscInt n_runs, const PetscInt n[], PetscInt stride, const PetscReal rms[],
                              const PetscReal mean[])
{
  PetscReal square = 0, product = 0, r;
  PetscInt  all = 0;

  for (PetscInt k = 0; k < n_runs; k++) {
    const PetscReal *s = &rms[stride * k];

    all += n[k];
    for (PetscInt i = 0; i < n[k]; i++) square += PetscSqr(s[i] * s[i] - mean[k]);
    for (PetscInt i = 1; i < n[k]; i++) product += (s[i] * s[i] - mean[k]) * (s[i - 1] * s[i - 1] - mean[k]);
  }
  if (all == n_runs || !(square > 0)) return 0;
  r = PetscMin(SPREAD_MOST, PetscMax(0, product / square + (PetscReal)n_runs / (PetscReal)all));
  return square / (PetscReal)(all - n_runs) * (PetscReal)n_runs / (PetscReal)all * (1 + r) / (1 - r);
}

/* Relative, of the rms: half that of the mean square. */
PetscReal MapSpreadOfLevel(PetscInt n_runs, const PetscInt n[], PetscInt stride, const PetscReal rms[])
{
  PetscReal mean[1 + MAP_MAX_TWINS] = {0}, all = 0, between, within;
  PetscInt  freedom = 0;

  for (PetscInt k = 0; k < n_runs; k++) {
    freedom += n[k] - 1;
    for (PetscInt i = 0; i < n[k]; i++) mean[k] += PetscSqr(rms[stride * k + i]) / (PetscReal)n[k];
    all += mean[k] / (PetscReal)n_runs;
  }
  between = MapSpreadOfMean(n_runs, mean);
  within =
    StudentT(PetscMax(1, freedom)) * PetscSqrtReal(2 * SpreadWithin(n_runs, n, stride, rms, mean) / (PetscReal)n_runs);
  return 0.5 * PetscMax(between, within) / all;
}
