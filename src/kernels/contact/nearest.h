/*
   Point of a facet that is nearest to a point in space. Pure functions; lengths in m.
*/
#pragma once

#include "facet.h"

/* Distance of p from the point at natural coordinates */
static inline double FacetDistance(int n, const double x[][3], const double p[3], const double at[2])
{
  double q[3], a[3], b[3], square = 0;

  FacetTangents(n, x, at, q, a, b);
  for (int d = 0; d < 3; d++) square += (p[d] - q[d]) * (p[d] - q[d]);
  return sqrt(square);
}

/* One Gauss-Newton step; 0 where the tangents are parallel */
static inline int NearestStep(int n, const double x[][3], const double p[3], const double at[2], double next[2])
{
  double q[3], a[3], b[3], aa = 0, ab = 0, bb = 0, ra = 0, rb = 0, det;

  FacetTangents(n, x, at, q, a, b);
  for (int d = 0; d < 3; d++) {
    aa += a[d] * a[d], ab += a[d] * b[d], bb += b[d] * b[d];
    ra += a[d] * (p[d] - q[d]), rb += b[d] * (p[d] - q[d]);
  }
  det = aa * bb - ab * ab;
  if (det <= 0) return 0;
  next[0] = at[0] + (bb * ra - ab * rb) / det;
  next[1] = at[1] + (aa * rb - ab * ra) / det;
  return 1;
}

/* The nearest place on the edge from corner e to the next, by steps along it */
static inline void NearestOnEdge(const FacetShape *shape, const double x[][3], const double p[3], int e, double at[2])
{
  const double *from = shape->node[e], *to = shape->node[(e + 1) % shape->n_corners];
  const double  along[2] = {to[0] - from[0], to[1] - from[1]};
  double        s        = 0.5, q[3], a[3], b[3];

  for (int it = 0; it < 20; it++) {
    const double before = s;
    double       tt = 0, tr = 0;

    for (int d = 0; d < 2; d++) at[d] = from[d] + s * along[d];
    FacetTangents(shape->n, x, at, q, a, b);
    for (int d = 0; d < 3; d++) {
      const double t = along[0] * a[d] + along[1] * b[d];

      tt += t * t, tr += t * (p[d] - q[d]);
    }
    if (!(tt > 0)) return;
    s = fmax(0, fmin(1, s + tr / tt));
    for (int d = 0; d < 2; d++) at[d] = from[d] + s * along[d];
    if (fabs(s - before) < 1e-14) return;
  }
}

/* Point of a facet of any shape nearest to p: where steps end within it, else on its edges */
static inline void NearestOnAny(int n, const double x[][3], const double p[3], double at[2])
{
  const FacetShape *shape = FacetShapeOf(n);
  double            next[2], least = HUGE_VAL;

  for (int d = 0; d < 2; d++) at[d] = shape->middle[d];
  for (int it = 0; it < 20 && NearestStep(n, x, p, at, next); it++) {
    const double step = fabs(next[0] - at[0]) + fabs(next[1] - at[1]);

    for (int d = 0; d < 2; d++) at[d] = fmin(shape->high, fmax(shape->low, next[d]));
    if (step < 1e-14) break;
  }
  if (FacetBeyond(n, at) <= 1e-12) return;
  for (int e = 0; e < shape->n_corners; e++) {
    double distance;

    NearestOnEdge(shape, x, p, e, next);
    distance = FacetDistance(n, x, p, next);
    if (distance >= least) continue;
    least = distance;
    for (int d = 0; d < 2; d++) at[d] = next[d];
  }
}

/* The same with four nodes, by steps that are cut off at the edges */
static inline void NearestOnSquare(const double x[][3], const double p[3], double at[2])
{
  double next[2];

  at[0] = at[1] = 0;
  for (int it = 0; it < 20 && NearestStep(4, x, p, at, next); it++) {
    double step;

    SquareClamp(next);
    step  = fmax(fabs(next[0] - at[0]), fabs(next[1] - at[1]));
    at[0] = next[0];
    at[1] = next[1];
    if (step < 1e-14) break;
  }
}

/* Point of the facet nearest to p; returns the distance (m) and its natural coordinates */
static inline double FacetProject(int n, const double x[][3], const double p[3], double natural[2])
{
  if (n == 4)
    NearestOnSquare(x, p, natural);
  else
    NearestOnAny(n, x, p, natural);
  FacetShapeOf(n)->snap(natural);
  return FacetDistance(n, x, p, natural);
}
