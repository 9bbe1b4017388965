/*
   DiscGrid - plane grid of an annulus, inner <= r <= outer, of nr rings and ntheta columns, mirror-symmetric in y
   to the last bit.

   Axisymmetric: r_i and theta_j are uniform.
   Patch: nx rings times ny columns coincide with the Cartesian grid of the rectangle |x - centre| <= size[0]/2,
   |y| <= size[1]/2. With X_i the ring's x in and beside the patch, R_i the uniform radii, theta_j the column's angle,
      rho    = v X_i + (1 - v) R_i                                          rings, a part `spread` of the way to uniform
      (x, y) = w (X_i, centre tan theta_j) + (1 - w) rho (cos theta_j, sin theta_j)
   where v falls from 1 to 1 - spread over pi/2 in angle, and w = 1 in the patch falls to 0 at both rims and at three
   times the patch's angle.
   Cell sizes beside the patch grow logistically from the patch's own size h to a limit s:
      ds/dt = s / (1 + (s/h - 1) exp(-k t)), t counted in cells, k such that the cells fill the length available.
   Lengths in m, angles in rad.
*/
#pragma once

#include <math.h>

#define DISC_PI 3.14159265358979323846

/* Largest cells beside the patch over the mean; nearly uniform, since the coarsest cells set the error */
#define DISC_RING_PLATEAU   1.2
#define DISC_COLUMN_PLATEAU 1.02

typedef struct {
  double first, limit, rate; /* h, s and k */
  double scale;              /* removes what the search for k leaves */
} DiscGrading;

typedef struct {
  double      inner, outer;
  int         nr, ntheta;
  int         patch; /* 0: axisymmetric, and what follows is unused */
  double      centre, size[2];
  double      spread; /* 0: rings keep their radii all around; 1: they are uniform away from the patch */
  int         nx, ny;
  int         i0; /* rings inside the patch */
  DiscGrading inward, outward, around;
} DiscGrid;

/* Node s = i - n/2 of n equal cells: exactly antisymmetric about the centre */
static inline double DiscPatchNode(double centre, double size, double s, int n)
{
  return centre + size * (s / n);
}

/* Length of the first t cells */
static inline double DiscGradingAt(const DiscGrading *g, double t)
{
  const double a = g->limit / g->first - 1;

  return g->scale * (g->limit * t + g->limit / g->rate * log((1 + a * exp(-g->rate * t)) / (1 + a)));
}

/* Fills `length` with n cells (n may be a half-integer), the first of size `first`; the largest is at most
   `plateau` times the mean */
static inline DiscGrading DiscGradingFill(double first, double n, double length, double plateau)
{
  const double mean = length / n;
  DiscGrading  g    = {first, mean > first ? mean * plateau : mean / plateau, 0, 1};
  double       lo = 1e-6, hi = 20;

  for (int bisection = 0; bisection < 60; bisection++) {
    g.rate = 0.5 * (lo + hi);
    if ((DiscGradingAt(&g, n) < length) == (mean > first))
      lo = g.rate;
    else
      hi = g.rate;
  }
  g.scale = length / DiscGradingAt(&g, n);
  return g;
}

/* Distributes the rings and columns beside the patch so that neighbouring cells differ as little as possible.
   Valid for nr >= nx + 2, ntheta > ny, and a patch strictly inside the annulus */
static inline void DiscGridGrade(DiscGrid *d)
{
  const double x0 = DiscPatchNode(d->centre, d->size[0], -0.5 * d->nx, d->nx);
  const double x1 = DiscPatchNode(d->centre, d->size[0], 0.5 * d->nx, d->nx);
  const double h = d->size[0] / d->nx, half = atan(0.5 * d->size[1] / d->centre);
  double       best = INFINITY;

  for (int i0 = 1; i0 + d->nx < d->nr; i0++) {
    const DiscGrading in  = DiscGradingFill(h, i0, x0 - d->inner, DISC_RING_PLATEAU);
    const DiscGrading out = DiscGradingFill(h, d->nr - d->nx - i0, d->outer - x1, DISC_RING_PLATEAU);

    if (fmax(in.rate, out.rate) >= best) continue;
    best       = fmax(in.rate, out.rate);
    d->i0      = i0;
    d->inward  = in;
    d->outward = out;
  }
  d->around =
    DiscGradingFill(d->size[1] / d->ny / d->centre, 0.5 * (d->ntheta - d->ny), DISC_PI - half, DISC_COLUMN_PLATEAU);
}

/* From 1 at u <= 0 to 0 at u >= 1 with zero slopes */
static inline double DiscFade(double u)
{
  u = fmin(fmax(u, 0), 1);
  return 1 - u * u * (3 - 2 * u);
}

/* Node of ring line i at t >= 0 columns from y = 0 (t may be a half-integer), uniform mesh; the second quadrant
   mirrors the first */
static inline void DiscGridUniform(const DiscGrid *d, int i, double t, double x[2])
{
  const double radius = d->inner + (d->outer - d->inner) * i / d->nr;
  const int    back   = 4 * t > d->ntheta;
  const double theta  = 2 * DISC_PI * (back ? 0.5 * d->ntheta - t : t) / d->ntheta;

  x[0] = (back ? -1 : 1) * radius * cos(theta);
  x[1] = radius * sin(theta);
}

/* The same with the patch */
static inline void DiscGridBlended(const DiscGrid *d, int i, double t, double x[2])
{
  const double half = atan(0.5 * d->size[1] / d->centre);
  const int    i1 = d->i0 + d->nx, aside = t > 0.5 * d->ny;
  const double y     = DiscPatchNode(0, d->size[1], t, d->ny);
  const double theta = aside ? half + DiscGradingAt(&d->around, t - 0.5 * d->ny) : atan(y / d->centre);
  double       ring, fade = DiscFade((theta - half) / (2 * half));

  if (i < d->i0) {
    const double away = DiscGradingAt(&d->inward, d->i0 - i), x0 = d->centre - 0.5 * d->size[0];
    ring = x0 - away;
    fade *= DiscFade(away / (x0 - d->inner));
  } else if (i > i1) {
    const double away = DiscGradingAt(&d->outward, i - i1), x1 = d->centre + 0.5 * d->size[0];
    ring = x1 + away;
    fade *= DiscFade(away / (d->outer - x1));
  } else
    ring = DiscPatchNode(d->centre, d->size[0], i - d->i0 - 0.5 * d->nx, d->nx);

  const double near   = 1 - d->spread * (1 - DiscFade((theta - half) / (0.5 * DISC_PI)));
  const double radius = near * ring + (1 - near) * (d->inner + (d->outer - d->inner) * i / d->nr);

  x[0] = fade * ring + (1 - fade) * radius * cos(theta);
  x[1] = (1 - fade) * radius * sin(theta);
  if (fade > 0) x[1] += fade * (aside ? d->centre * tan(theta) : y);
  if (2 * t >= d->ntheta) x[1] = 0;
}

/* Node of ring line i = 0..nr on column line j = 0..ntheta-1; the patch begins at j = 0, the uniform mesh at y = 0 */
static inline void DiscGridNode(const DiscGrid *d, int i, int j, double x[2])
{
  double s = d->patch ? j - 0.5 * d->ny : j;

  if (2 * s > d->ntheta) s -= d->ntheta;
  if (d->patch)
    DiscGridBlended(d, i, fabs(s), x);
  else
    DiscGridUniform(d, i, fabs(s), x);
  if (s < 0) x[1] = -x[1];
}
