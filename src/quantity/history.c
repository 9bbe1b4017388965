/*
   What a ramp comes to (ramp.h): h(s) = cos(w s + phase), or a table, its rate and the integral of r h. With a ramp of
   length L and k = pi / L, a smooth one gives

      r cos(w s + p) = cos(w s + p) / 2 - (cos((w + k) s + p) + cos((w - k) s + p)) / 4,   s <= L,

   and a linear one  int s cos(w s + p) ds = s sin(w s + p) / w - int sin(w s + p) ds / w. A table has no ramp but
   its own.
*/
#include "ramp.h"

static double Omega(const Ramp *ramp)
{
  return 2 * RAMP_PI * ramp->frequency;
}

static double Phase(const Ramp *ramp)
{
  return ramp->phase * RAMP_PI / 180;
}

/* The row of a table at or before s, the last but one at most; s >= 0 */
static PetscInt TableRow(const Ramp *ramp, double s)
{
  PetscInt low = 0, high = ramp->n - 1;

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (ramp->time[middle] <= s)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static double TableRate(const Ramp *ramp, PetscInt i)
{
  return (ramp->factor[i + 1] - ramp->factor[i]) / (ramp->time[i + 1] - ramp->time[i]);
}

static double HistoryFactor(const Ramp *ramp, double s)
{
  const PetscInt last = ramp->n - 1;
  PetscInt       i;

  if (!ramp->n) return cos(Omega(ramp) * s + Phase(ramp));
  if (s >= ramp->time[last]) return ramp->factor[last];
  i = TableRow(ramp, s);
  return ramp->factor[i] + TableRate(ramp, i) * (PetscMax(0, s) - ramp->time[i]);
}

static double HistoryRate(const Ramp *ramp, double s)
{
  if (!ramp->n) return -Omega(ramp) * sin(Omega(ramp) * s + Phase(ramp));
  return s < 0 || s >= ramp->time[ramp->n - 1] ? 0 : TableRate(ramp, TableRow(ramp, s));
}

/* int_a^b cos(w s + p) ds, also for w = 0 */
static double CosineArea(double w, double p, double a, double b)
{
  const double half = 0.5 * w * (b - a);

  return (b - a) * cos(0.5 * w * (a + b) + p) * (fabs(half) > 1e-8 ? sin(half) / half : 1);
}

/* int_0^e r(s) cos(w s + p) ds on the ramp, e <= L */
static double RisingArea(const Ramp *ramp, double e)
{
  const double w = Omega(ramp), p = Phase(ramp), L = ramp->length;

  if (!(L > 0)) return 0;
  if (ramp->shape == RAMP_SMOOTH)
    return 0.5 * CosineArea(w, p, 0, e) -
           0.25 * (CosineArea(w + RAMP_PI / L, p, 0, e) + CosineArea(w - RAMP_PI / L, p, 0, e));
  return (e * sin(w * e + p) - CosineArea(w, p - 0.5 * RAMP_PI, 0, e)) / (w * L);
}

static double HistoryIntegral(const Ramp *ramp, double s)
{
  const PetscInt last = ramp->n - 1;
  const double   e    = PetscMin(s, ramp->length);

  if (s <= 0) return 0;
  if (!ramp->n) return RisingArea(ramp, e) + (s > e ? CosineArea(Omega(ramp), Phase(ramp), e, s) : 0);
  if (s >= ramp->time[last]) return ramp->area[last] + ramp->factor[last] * (s - ramp->time[last]);
  const PetscInt i     = TableRow(ramp, s);
  const double   since = s - ramp->time[i];

  return ramp->area[i] + since * (ramp->factor[i] + 0.5 * TableRate(ramp, i) * since);
}

/* Place on the ramp, 0 to 1 */
static double RampPlace(const Ramp *ramp, double t)
{
  const double x = t - ramp->delay;

  return x < 0 ? 0 : x >= ramp->length ? 1 : x / ramp->length;
}

/* r there */
static double RampPart(const Ramp *ramp, double t)
{
  const double x = RampPlace(ramp, t);

  return ramp->shape == RAMP_SMOOTH ? 0.5 * (1 - cos(RAMP_PI * x)) : x;
}

double RampValue(const Ramp *ramp, double t)
{
  const double r = RampPart(ramp, t);

  return RampVaries(ramp) ? r * HistoryFactor(ramp, t - ramp->delay) : r;
}

double RampRate(const Ramp *ramp, double t)
{
  const double s      = t - ramp->delay;
  const double slope  = s < 0 || s >= ramp->length ? 0 : 1 / ramp->length;
  const double rising = ramp->shape == RAMP_SMOOTH ? 0.5 * RAMP_PI * sin(RAMP_PI * RampPlace(ramp, t)) * slope : slope;

  if (!RampVaries(ramp)) return rising;
  return rising * HistoryFactor(ramp, s) + RampPart(ramp, t) * HistoryRate(ramp, s);
}

double RampIntegral(const Ramp *ramp, double t)
{
  const double x      = RampPlace(ramp, t);
  const double rising = ramp->shape == RAMP_SMOOTH ? 0.5 * (x - sin(RAMP_PI * x) / RAMP_PI) : 0.5 * x * x;
  const double after  = t - ramp->delay - ramp->length;

  if (RampVaries(ramp)) return HistoryIntegral(ramp, t - ramp->delay);
  return ramp->length * rising + (after > 0 ? after : 0);
}
