/*
   Distributions by their quantiles:

      normal      x = m + s z
      lognormal   x = exp(mu + v z), v^2 = ln(1 + s^2 / m^2), mu = ln m - v^2 / 2, of mean m and deviation s
      uniform     x = a + u (b - a)
      triangular  F = (x - a)^2 / ((b - a) (c - a)) up to the peak c, 1 - (b - x)^2 / ((b - a) (b - c)) from it on
      table       F straight between its points

   z the standard normal quantile of u. What is cut at a and b takes u from F(a) to F(b) in place of 0 to 1.
*/
#include "distribution.h"

PetscReal NormalProbability(PetscReal z)
{
  return 0.5 * erfc(-z / PetscSqrtReal(2.0));
}

/* M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 26.2.23, within 4.5e-4 in the lower half; then
   steps of Halley, z -= e / (1 + z e / 2), e = (P(z) - u) / p(z), each of which cubes the error. */
PetscReal NormalQuantile(PetscReal u)
{
  const PetscReal half = PetscMin(u, 1 - u), t = PetscSqrtReal(-2 * PetscLogReal(half));
  PetscReal       z;

  if (half <= 0) return u <= 0 ? PETSC_MIN_REAL : PETSC_MAX_REAL;
  z = (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int step = 0; step < 3; step++) {
    const PetscReal e = (NormalProbability(z) - half) * PetscSqrtReal(2 * PETSC_PI) * PetscExpReal(0.5 * z * z);

    z -= e / (1 + 0.5 * z * e);
  }
  return u <= 0.5 ? z : -z;
}

/* Straight lines from one point of a table to the next; x of F, or F of x */
static PetscReal TableInterpolate(PetscInt n, const PetscReal at[], const PetscReal of[], PetscReal a)
{
  PetscInt k = 1;

  while (k < n - 1 && at[k] < a) k++;
  if (a <= at[0]) return of[0];
  if (a >= at[n - 1]) return of[n - 1];
  return of[k - 1] + (a - at[k - 1]) / (at[k] - at[k - 1]) * (of[k] - of[k - 1]);
}

static PetscReal TriangularQuantile(const Distribution *d, PetscReal u)
{
  const PetscReal whole = d->upper - d->lower, left = d->peak - d->lower, right = d->upper - d->peak;

  return u * whole <= left ? d->lower + PetscSqrtReal(u * whole * left)
                           : d->upper - PetscSqrtReal((1 - u) * whole * right);
}

/* mu and v of the logarithm */
static void LognormalLogarithm(const Distribution *d, PetscReal *mu, PetscReal *v)
{
  const PetscReal square = log1p(PetscSqr(d->deviation / d->mean));

  *v  = PetscSqrtReal(square);
  *mu = PetscLogReal(d->mean) - 0.5 * square;
}

/* F(x) of what may be cut, before it is */
static PetscReal UncutProbability(const Distribution *d, PetscReal x)
{
  PetscReal mu, v;

  if (d->kind == DISTRIBUTION_TABLE) return TableInterpolate(d->n, d->value, d->probability, x);
  if (d->kind == DISTRIBUTION_NORMAL) return NormalProbability((x - d->mean) / d->deviation);
  LognormalLogarithm(d, &mu, &v);
  return x > 0 ? NormalProbability((PetscLogReal(x) - mu) / v) : 0;
}

static PetscReal UncutQuantile(const Distribution *d, PetscReal u)
{
  PetscReal mu, v;

  if (d->kind == DISTRIBUTION_TABLE) return TableInterpolate(d->n, d->probability, d->value, u);
  if (d->kind == DISTRIBUTION_NORMAL) return d->mean + d->deviation * NormalQuantile(u);
  LognormalLogarithm(d, &mu, &v);
  return PetscExpReal(mu + v * NormalQuantile(u));
}

PetscReal DistributionQuantile(const Distribution *d, PetscReal u)
{
  PetscReal low = 0, high = 1;

  if (d->kind == DISTRIBUTION_UNIFORM) return d->lower + u * (d->upper - d->lower);
  if (d->kind == DISTRIBUTION_TRIANGULAR) return TriangularQuantile(d, u);
  if (!PetscIsInfReal(d->lower)) low = UncutProbability(d, d->lower);
  if (!PetscIsInfReal(d->upper)) high = UncutProbability(d, d->upper);
  return PetscMin(PetscMax(UncutQuantile(d, low + u * (high - low)), d->lower), d->upper);
}
