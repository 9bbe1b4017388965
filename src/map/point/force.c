/*
   What forces are like: mean, rms about it, largest value, share without force; and their main line, the largest
   magnitude X_k of the spectrum, squares summed over records one after the other, under Hann's window, from four
   periods in a record on, between bins by

      f = (k + d) / (n dt),   d = (2 a - 1) / (a + 1),   a = X_{k+1} / X_k of the larger neighbour

   (exact for one line far from others; M. Gasior, J. L. Gonzalez, AIP Conf. Proc. 732, 2004).
*/
#include "map/mapimpl.h"

/* In a record: below, Hann's window and the mean run into the line. */
#define LEAST_PERIODS  4
#define STEADY_WINDOWS 8 /* at least */

void MapForceMeasure(PetscInt n, const PetscReal f[], MapSample *s)
{
  PetscReal square = 0;

  s->mean = s->rms = s->open = 0;
  s->peak                    = f[0];
  for (PetscInt i = 0; i < n; i++) {
    s->mean += f[i] / (PetscReal)n;
    s->peak = PetscMax(s->peak, f[i]);
    s->open += (f[i] <= 0) / (PetscReal)n;
  }
  for (PetscInt i = 0; i < n; i++) square += PetscSqr(f[i] - s->mean) / (PetscReal)n;
  s->rms = PetscSqrtReal(square);
}

/* sqrt(mean rms^2) over windows, N; *error = its relative standard error, half that of the mean square. */
PetscReal MapForceLevel(PetscInt n, const MapSample s[], PetscReal *error)
{
  PetscReal square = 0, spread = 0;

  for (PetscInt k = 0; k < n; k++) square += PetscSqr(s[k].rms) / (PetscReal)n;
  for (PetscInt k = 0; k < n; k++) spread += PetscSqr(PetscSqr(s[k].rms) - square) / (PetscReal)n;
  *error = n > 1 && square > 0 ? 0.5 * PetscSqrtReal(spread / (PetscReal)(n - 1)) / square : 0;
  return PetscSqrtReal(square);
}

/* |sum_l w_l (f_l - mean) exp(2 pi i k l / n)|, i the imaginary unit, w Hann's window. Cosines go on by rotation,
   so that their rounding grows with n. */
static PetscReal ForceBin(PetscInt n, const PetscReal f[], PetscReal mean, PetscInt k)
{
  const PetscReal step = 2 * PETSC_PI * (PetscReal)k / (PetscReal)n, hann = 2 * PETSC_PI / (PetscReal)n;
  const PetscReal c = PetscCosReal(step), s = PetscSinReal(step), hc = PetscCosReal(hann), hs = PetscSinReal(hann);
  PetscReal       re = 0, im = 0, x = 1, y = 0, u = 1, v = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal w = 0.5 * (1 - u) * (f[i] - mean), t = x * c - y * s, r = u * hc - v * hs;

    re += w * x;
    im += w * y;
    y = x * s + y * c;
    x = t;
    v = u * hs + v * hc;
    u = r;
  }
  return hypot(re, im);
}

/* Root of the sum of squares of bin k over records one after the other */
static PetscReal ForceBins(PetscInt n_records, PetscInt n, const PetscReal f[], PetscReal mean, PetscInt k)
{
  PetscReal square = 0;

  for (PetscInt i = 0; i < n_records; i++) square += PetscSqr(ForceBin(n, &f[n * i], mean, k));
  return PetscSqrtReal(square);
}

/* Frequency, Hz, of the main line of n_records records of n values dt apart; NAN where the largest bin is rounding.
   n^2 / 2 products a record: windows are short. */
PetscReal MapForceLine(PetscInt n_records, PetscInt n, const PetscReal f[], PetscReal dt)
{
  PetscReal largest = 0, side[2], a;
  PetscInt  best    = 0;
  MapSample sample;

  MapForceMeasure(n_records * n, f, &sample);
  for (PetscInt k = LEAST_PERIODS; k < n / 2; k++) {
    const PetscReal here = ForceBins(n_records, n, f, sample.mean, k);

    if (here <= largest) continue;
    largest = here;
    best    = k;
  }
  if (!(largest > 1e-12 * PetscAbsReal(sample.mean) * (PetscReal)n)) return NAN;
  for (int i = 0; i < 2; i++) side[i] = ForceBins(n_records, n, f, sample.mean, best - 1 + 2 * i);
  a = PetscMax(side[0], side[1]) / largest;
  return ((PetscReal)best + (side[1] > side[0] ? 1 : -1) * (2 * a - 1) / (a + 1)) / ((PetscReal)n * dt);
}

/* A cycle: the last windows, all with changes of status, have the rms of the very last one within rtol */
PetscBool MapIsSettled(PetscInt n, const MapSample sample[], PetscReal rtol, PetscReal *error)
{
  const MapSample *s = &sample[n - 1];

  *error = 0;
  if (n < MAP_SETTLED_WINDOWS) return PETSC_FALSE;
  for (PetscInt k = 1; k < MAP_SETTLED_WINDOWS; k++) {
    if (!s[-k].changed || !s->changed || !(s->rms > 0)) return PETSC_FALSE;
    *error = PetscMax(*error, PetscAbsReal(s[-k].rms / s->rms - 1));
  }
  return *error <= rtol ? PETSC_TRUE : PETSC_FALSE;
}

/* Chaos or a beat: the rms of the last half of the windows is known to rtol by its spread, and its two halves agree to
   twice that, about the standard error of their difference */
PetscBool MapIsSteady(PetscInt n, const MapSample sample[], PetscReal rtol, PetscReal *error)
{
  const PetscInt   half = n - n / 2, part = half / 2;
  const MapSample *s = &sample[n / 2];
  PetscReal        unused, level[2];

  *error = 0;
  if (n < STEADY_WINDOWS) return PETSC_FALSE;
  for (PetscInt k = 0; k < half; k++)
    if (!s[k].changed) return PETSC_FALSE;
  (void)MapForceLevel(half, s, error);
  level[0] = MapForceLevel(part, s, &unused);
  level[1] = MapForceLevel(part, &s[half - part], &unused);
  return *error <= rtol && PetscAbsReal(level[0] / level[1] - 1) <= 2 * rtol ? PETSC_TRUE : PETSC_FALSE;
}
