/*
   Moments and quantiles of samples, and the interval of a probability.

      mean m = sum x / n,   deviation s^2 = sum (x - m)^2 / (n - 1)
      quantile q: straight between the order statistics, x_(h), h = (n - 1) q (R. J. Hyndman, Y. Fan, The American
      Statistician 50, 1996, type 7)

   The interval of C. J. Clopper and E. S. Pearson (Biometrika 26, 1934) of k out of n at confidence 1 - a: its ends are
   the p of which a / 2 of all trials have k or more, and k or fewer,

      I_p(k, n - k + 1) = a / 2   and   I_p(k + 1, n - k) = 1 - a / 2.

   It holds for independent trials; points of a sequence that fill the box evenly vary less, so that there it is wide.
*/
#include "estimate.h"

#define CONFIDENCE 0.95

const PetscReal SampleQuantiles[N_QUANTILES] = {0.01, 0.05, 0.5, 0.95, 0.99};

PetscErrorCode MomentsFind(PetscInt n, PetscReal value[], Moments *m)
{
  PetscReal sum = 0, square = 0;

  PetscFunctionBeginUser;
  *m = (Moments){n, NAN, NAN, {NAN, NAN, NAN, NAN, NAN}, NAN, NAN};
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscSortReal(n, value));
  for (PetscInt i = 0; i < n; i++) sum += value[i];
  m->mean = sum / (PetscReal)n;
  for (PetscInt i = 0; i < n; i++) square += PetscSqr(value[i] - m->mean);
  if (n > 1) m->deviation = PetscSqrtReal(square / (PetscReal)(n - 1));
  for (int q = 0; q < N_QUANTILES; q++) {
    const PetscReal h = (PetscReal)(n - 1) * SampleQuantiles[q];
    const PetscInt  k = PetscMin((PetscInt)h, PetscMax(0, n - 2));

    m->quantile[q] = n > 1 ? value[k] + (h - (PetscReal)k) * (value[k + 1] - value[k]) : value[0];
  }
  m->least = value[0];
  m->most  = value[n - 1];
  PetscFunctionReturn(0);
}

/* The continued fraction of I_x(a, b), Handbook of Mathematical Functions 26.5.8, by the modified method of Lentz */
static PetscReal BetaFraction(PetscReal a, PetscReal b, PetscReal x)
{
  const PetscReal tiny = 1e-300;
  PetscReal       c = 1, d = 1 - (a + b) * x / (a + 1), h;

  d = 1 / (PetscAbsReal(d) < tiny ? tiny : d);
  h = d;
  for (int m = 1; m < 10000; m++) {
    const PetscReal even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const PetscReal odd  = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));

    for (int half = 0; half < 2; half++) {
      const PetscReal term = half ? odd : even;

      d = 1 + term * d, c = 1 + term / c;
      d = 1 / (PetscAbsReal(d) < tiny ? tiny : d);
      if (PetscAbsReal(c) < tiny) c = tiny;
      h *= d * c;
    }
    if (PetscAbsReal(d * c - 1) < PETSC_MACHINE_EPSILON) break;
  }
  return h;
}

PetscReal BetaProbability(PetscReal a, PetscReal b, PetscReal x)
{
  PetscReal front;

  if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
  front = PetscExpReal(lgamma(a + b) - lgamma(a) - lgamma(b) + a * PetscLogReal(x) + b * log1p(-x));
  return x < (a + 1) / (a + b + 2) ? front * BetaFraction(a, b, x) / a : 1 - front * BetaFraction(b, a, 1 - x) / b;
}

/* x of I_x(a, b) = p, by bisection to the last digit: I grows from 0 to 1 */
static PetscReal BetaQuantile(PetscReal a, PetscReal b, PetscReal p)
{
  PetscReal low = 0, high = 1;

  for (int step = 0; step < 200 && high - low > PETSC_MACHINE_EPSILON * high; step++) {
    const PetscReal middle = 0.5 * (low + high);

    if (BetaProbability(a, b, middle) < p)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

void ClopperPearson(PetscInt least, PetscInt most, PetscInt n, PetscReal interval[2])
{
  const PetscReal rest = 0.5 * (1 - CONFIDENCE);

  interval[0] = least > 0 ? BetaQuantile((PetscReal)least, (PetscReal)(n - least + 1), rest) : 0;
  interval[1] = most < n ? BetaQuantile((PetscReal)(most + 1), (PetscReal)(n - most), 1 - rest) : 1;
}
