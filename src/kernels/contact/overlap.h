/*
   Area in which two facets lie over each other, seen along the normal of the first in its middle. Each is a fan of
   triangles from its middle to its nodes around it (one triangle where it is one); those of sides that are curved lie
   on the chords of their halves. Two triangles overlap in a convex polygon: one is cut by the lines of the other (I. E.
   Sutherland, G. W. Hodgman, Reentrant polygon clipping, Communications of the ACM 17, 1974). Pure functions; lengths
   in m.
*/
#pragma once

#include "facet.h"
#include "base/algebra/vec3.h"

#define FAN_MOST     8  /* triangles */
#define POLYGON_MOST 64 /* corners of a quadrilateral cut four times, whatever rounding does */

/* Triangles [n][3][2] in a plane */
typedef struct {
  int    n;
  double x[FAN_MOST][3][2];
} FacetFan;

/* Place of facet nodes seen along e[2]: x . e[0], x . e[1] from an origin */
static inline void FanPlace(const double e[3][3], const double origin[3], const double x[3], double at[2])
{
  const double away[3] = {x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]};

  at[0] = Vec3Dot(away, e[0]);
  at[1] = Vec3Dot(away, e[1]);
}

/* Axes in the plane across the normal of a facet in its middle, which is the origin; that normal is the third */
static inline void FanAxes(int n, const double x[][3], double e[3][3], double origin[3])
{
  const FacetShape *shape = FacetShapeOf(n);
  double            b[3];

  FacetTangents(n, x, shape->middle, origin, e[0], b);
  Vec3Cross(e[0], b, e[2]);
  (void)Vec3Normalise(e[2]);
  (void)Vec3Normalise(e[0]);
  Vec3Cross(e[2], e[0], e[1]);
}

/* The fan of a facet, seen along e[2] */
static inline void FanMake(int n, const double x[][3], const double e[3][3], const double origin[3], FacetFan *fan)
{
  const FacetShape *shape   = FacetShapeOf(n);
  const int         corners = shape->n_corners, around = n > corners ? 2 * corners : corners;
  double            at[FAN_MOST][2], middle[2], p[3], a[3], b[3];

  for (int i = 0; i < around; i++) {
    const int node = n > corners ? i / 2 + i % 2 * corners : i;

    FanPlace(e, origin, x[node], at[i]);
  }
  FacetTangents(n, x, shape->middle, p, a, b);
  FanPlace(e, origin, p, middle);
  fan->n = n == 3 ? 1 : around;
  for (int i = 0; i < fan->n; i++)
    for (int d = 0; d < 2; d++) {
      fan->x[i][0][d] = n == 3 ? at[2][d] : middle[d];
      fan->x[i][1][d] = at[i][d];
      fan->x[i][2][d] = at[(i + 1) % around][d];
    }
}

/* Twice the area of a triangle, positive where it goes round counter-clockwise */
static inline double TriangleTwice(const double a[2], const double b[2], const double c[2])
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Area of a fan */
static inline double FanArea(const FacetFan *fan)
{
  double twice = 0;

  for (int i = 0; i < fan->n; i++) twice += fabs(TriangleTwice(fan->x[i][0], fan->x[i][1], fan->x[i][2]));
  return twice / 2;
}

/* Keeps of a polygon what lies left of the line from a to b; returns the number of its corners */
static inline int PolygonCut(int n, double p[][2], const double a[2], const double b[2])
{
  double kept[POLYGON_MOST][2];
  int    m = 0;

  for (int i = 0; i < n; i++) {
    const double *from = p[i], *to = p[(i + 1) % n];
    const double  here = TriangleTwice(a, b, from), there = TriangleTwice(a, b, to);

    if (here >= 0) {
      kept[m][0]   = from[0];
      kept[m++][1] = from[1];
    }
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
      const double s = here / (here - there);

      kept[m][0]   = from[0] + s * (to[0] - from[0]);
      kept[m++][1] = from[1] + s * (to[1] - from[1]);
    }
  }
  for (int i = 0; i < m; i++)
    for (int d = 0; d < 2; d++) p[i][d] = kept[i][d];
  return m;
}

/* Area that two triangles have in common */
static inline double TriangleOverlap(const double x[3][2], const double y[3][2])
{
  const int turn = TriangleTwice(y[0], y[1], y[2]) < 0 ? 2 : 1; /* to the next corner, counter-clockwise */
  double    p[POLYGON_MOST][2], twice = 0;
  int       n = 3;

  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 2; d++) p[i][d] = x[i][d];
  for (int i = 0; i < 3 && n > 2; i++) n = PolygonCut(n, p, y[i * turn % 3], y[(i + 1) * turn % 3]);
  for (int i = 1; i + 1 < n; i++) twice += TriangleTwice(p[0], p[i], p[i + 1]);
  return fabs(twice) / 2;
}

/* Area that two fans have in common */
static inline double FanOverlap(const FacetFan *f, const FacetFan *g)
{
  double area = 0;

  for (int i = 0; i < f->n; i++)
    for (int j = 0; j < g->n; j++) area += TriangleOverlap(f->x[i], g->x[j]);
  return area;
}
